#include "view/picture.h"

#include <fmt/format.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkUnsignedCharArray.h>

#include <cstring>
#include <stdexcept>

namespace bio::view {

Image imageOf(vtkRenderWindow* window, int width, int height) {
  const int* size = window->GetSize();
  Image image{width, height, {}};
  if (size[0] != width || size[1] != height) {
    throw std::runtime_error(
        fmt::format("a picture of {}x{} pixels cannot be drawn on this display", width, height));
  }
  vtkNew<vtkUnsignedCharArray> pixels;
  window->GetPixelData(0, 0, width - 1, height - 1, 0, pixels);
  const auto row = 3 * static_cast<std::size_t>(width);
  image.rgb.resize(row * static_cast<std::size_t>(height));
  if (static_cast<std::size_t>(pixels->GetNumberOfValues()) != image.rgb.size()) {
    throw std::runtime_error("the picture could not be read back from the display");
  }
  // VTK's first row is the lowest.
  for (std::size_t r = 0; r < static_cast<std::size_t>(height); ++r) {
    const std::size_t from = static_cast<std::size_t>(height) - 1 - r;
    std::memcpy(image.rgb.data() + r * row, pixels->GetPointer(0) + from * row, row);
  }
  return image;
}

}  // namespace bio::view
