#pragma once

namespace support {

/// df/dx by the five-point central stencil, error O(h⁴).
template <class F>
double centralDifference(const F& f, double x, double h) {
  return (8 * (f(x + h) - f(x - h)) - (f(x + 2 * h) - f(x - 2 * h))) / (12 * h);
}

}  // namespace support
