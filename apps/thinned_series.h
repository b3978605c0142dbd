#pragma once

#include "report.h"

namespace app {

/// What a screen can show of a long curve: of each of 2000 equal parts of its points the lowest,
/// the highest and the first gap; the curve as it is where it is short, a path, or its x turn back.
Series thinned(const Series& series);

}  // namespace app
