#pragma once

#include "report.h"

namespace app {

/// Parts of a long curve, of each of which the extremes are drawn.
inline constexpr std::size_t thinnedParts = 2000;

/// What a screen can show of a long curve: of each of thinnedParts equal parts of its points the
/// lowest, the highest and the first gap; the curve as it is where it is short, a path, or its x
/// turn back.
Series thinned(const Series& series);

}  // namespace app
