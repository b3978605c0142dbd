#pragma once

#include <string>
#include <vector>

#include "report/report.h"

namespace app {

struct AxisTick {
  double value = 0;
  std::string label =
      {};  ///< "2.5", "−10", "3·10^−7"; empty between the powers of a logarithmic axis
};

/// Lowest and highest value that an axis shows.
struct AxisRange {
  double low = 0, high = 1;  ///< low < high; > 0 on a logarithmic axis
};

/// The range of an axis that is to show these values, with a margin.
/// @param margin  share of the span on both sides, ≥ 0; a logarithmic axis takes it of the powers
AxisRange rangeOf(const std::vector<double>& values, AxisScale scale, double margin);

/// At round numbers, rising. All labels of a linear axis have as many decimals.
/// @param most  about as many labels, ≥ 2
std::vector<AxisTick> ticksOf(const AxisRange& range, AxisScale scale, int most);

}  // namespace app
