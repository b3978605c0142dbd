#pragma once

#include "report/report.h"

namespace app {

/// Number of intervals of a long curve whose extremes are drawn.
inline constexpr std::size_t thinnedParts = 2000;

/// Reduces a long curve for display: from each of thinnedParts equal parts the lowest and highest
/// points and the first gap. A short curve, a path, or a curve whose x decreases somewhere is
/// returned unchanged.
Series thinned(const Series& series);

}  // namespace app
