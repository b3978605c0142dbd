#include "bio/muscle/activation/activation.h"

namespace bio {
namespace {

ActivationStep throughScalarType(const SchutteActivation<double>& law, double u0, double u1,
                                 double a0, double h) {
  using D = info::Dual<7>;
  const SchutteActivation<D> dynamics{D(law.timeScale, 7, 4), D(law.activation1, 7, 5),
                                      D(law.activation2, 7, 6)};
  const D end = stepActivation(dynamics, D(u0, 7, 0), D(u1, 7, 1), D(a0, 7, 2), D(h, 7, 3));
  return {end.value(), end.derivatives()};
}

}  // namespace

ActivationStep stepActivationWithDerivatives(const SchutteActivation<double>& law, double u0,
                                             double u1, double a0, double h) {
  if (!(h > 0)) return throughScalarType(law, u0, u1, a0, h);
  // detail::lagAfter, step by step
  const double slope = (u1 - u0) / h;
  const double e0 = u0 - a0;
  const bool rising = e0 > 0 || (e0 == 0 && slope >= 0);
  const double middle = u0 + slope * h * 0.5;
  const double k = law.rateConstant(middle, rising);
  const double steady = slope / k;
  const double x = k * h;
  const double decay = std::exp(-x);
  const double growth = (k - law.rateConstant(u0, rising)) * 2.0;
  double e1 = steady + (e0 - steady) * decay;
  // ∂e₁ in the intermediate values, backwards
  double by_steady = 1 - decay, by_decay = e0 - steady, by_growth = 0, by_x = 0, by_k = 0;
  if (growth != 0 && x != 0) {
    const double bracket = x - 2.0 + (x + 2.0) * decay;
    const double share = 1 / (2.0 * k * x);
    const double corrected = steady * growth * bracket * share;
    e1 -= corrected;
    by_steady -= growth * bracket * share;
    by_decay -= steady * growth * share * (x + 2.0);
    by_growth = -steady * bracket * share;
    by_x = -steady * growth * share * (1 + decay) + corrected / x;
    by_k = corrected / k;
  }
  if (rising ? !(e1 >= 0) : !(e1 <= 0)) return throughScalarType(law, u0, u1, a0, h);
  by_x -= decay * by_decay;
  by_k += h * by_x - steady / k * by_steady;
  double by_h = k * by_x;
  double by_slope = by_steady / k;
  const double perScale = 1 / law.timeScale;
  double by_timeScale = -k * perScale * by_k;
  const double by_activation2 = perScale * by_k;
  double by_start = 0, by_activation1 = 0;
  if (rising) {  // k = (c₁(u₀ + u′h/2) + c₂)/t_s, growth = c₁u′h/t_s
    const double c = law.activation1 * perScale;
    by_start = c * by_k;
    by_slope += c * h * (by_k / 2 + by_growth);
    by_h += c * slope * (by_k / 2 + by_growth);
    by_activation1 = perScale * (middle * by_k + slope * h * by_growth);
    by_timeScale -= growth * perScale * by_growth;
  }
  ActivationStep step;
  step.value = u1 - e1;
  step.d << by_slope / h - by_start - decay, 1 - by_slope / h, decay, by_slope * slope / h - by_h,
      -by_timeScale, -by_activation1, -by_activation2;
  return step;
}

}  // namespace bio
