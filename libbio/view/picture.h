#pragma once

#include <string>

#include "view/film_writer.h"

class vtkRenderWindow;

namespace bio::view {

/// The picture in a window.
/// @throws std::runtime_error if the display did not give the window its size
Image imageOf(vtkRenderWindow* window, int width, int height);

}  // namespace bio::view
