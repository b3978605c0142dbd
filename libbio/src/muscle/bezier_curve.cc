#include "bio/muscle/bezier_curve.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace bio::muscles {

void requireOpenCorner(double chord, double leftLeg, double rightLeg, double x0, double x1) {
  if (!(chord > leftLeg && chord > rightLeg)) {
    throw std::invalid_argument(
        fmt::format("the section of a curve from {} to {} turns back: its end tangents must meet "
                    "nearer to each end than the other end is",
                    x0, x1));
  }
}

double bezierPlace(const std::array<double, 6>& x, double target, double start) {
  double low = 0, high = 1;
  double u = start >= 0 && start <= 1 ? start : 0.5;
  for (int k = 0; k < 100; ++k) {
    const CurvePoint<double> p = quintic(x, u);
    (p.value > target ? high : low) = u;
    double next = u + halleyStep(p, target);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    const double step = next - u;
    u = next;
    // the error left is about 50·step³
    if (!(std::abs(step) > 1e-6)) break;
  }
  return u;
}

}  // namespace bio::muscles
