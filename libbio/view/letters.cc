#include "view/letters.h"

#include <vtkTextProperty.h>

#include <filesystem>
#include <string>

namespace bio::view {

void setFont(vtkTextProperty* letters, bool bold) {
  const std::string file =
      std::string("/usr/share/fonts/truetype/dejavu/DejaVuSans") + (bold ? "-Bold.ttf" : ".ttf");
  letters->SetFontFamilyToArial();
  letters->SetBold(bold);
  letters->ItalicOff();
  letters->ShadowOff();
  letters->SetColor(0.1, 0.1, 0.12);
  if (std::filesystem::exists(file)) {
    letters->SetFontFamily(VTK_FONT_FILE);
    letters->SetFontFile(file.c_str());
  }
}

}  // namespace bio::view
