#pragma once

class vtkTextProperty;

namespace bio::view {

/// Dark letters in Debian's DejaVu Sans; VTK's own stand-in for Arial has round square brackets.
void setFont(vtkTextProperty* letters, bool bold);

}  // namespace bio::view
