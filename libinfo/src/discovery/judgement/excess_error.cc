#include "info/discovery/judgement/excess_error.h"

namespace info::discover {

void explainExcess(ExcessError& gap) {
  const double floor = gap.floor * gap.floor, after = gap.after * gap.after - floor;
  const auto closed = [&](double before) -> std::optional<double> {
    if (before * before < 1.2 * floor) return std::nullopt;
    return 1 - after / (before * before - floor);
  };
  gap.closedFromCalibrated = closed(gap.calibrated);
  gap.closedFromNominal = closed(gap.nominal);
}

}  // namespace info::discover
