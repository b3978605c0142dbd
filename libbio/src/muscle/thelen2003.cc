#include "bio/muscle/thelen2003.h"

namespace bio::muscles {
namespace {

// Places among the class's own numbers.
struct ThelenOwn {
  static constexpr std::size_t tendonStrain = 0, passiveStrain = 1, activeWidth = 2,
                               passiveShape = 3, velocityShape = 4;
};
static_assert(Thelen2003Parameters<double>::properties[common::count + ThelenOwn::velocityShape]
                  .name == "Af");
static_assert(Thelen2003Parameters<double>::properties[Thelen2003<double>::minimumActivationPlace]
                  .name == "minimum_activation");

}  // namespace

template <>
void Thelen2003Parameters<double>::requireRules() const {
  requireRanges(*this);
  requireRule(extrapolationThreshold * maxLengtheningForce > 1, "fv_linear_extrap_threshold",
              extrapolationThreshold, "> 1/Flen");
  requireRule(!ignoreTendonCompliance, "ignore_tendon_compliance", 1,
              "false: Thelen2003Muscle has no rigid tendon");
  requireRule(!ignoreActivationDynamics, "ignore_activation_dynamics", 1,
              "false: Thelen2003Muscle always has activation dynamics");
}

template <>
AnyActivation Thelen2003Parameters<double>::activation() const {
  return FirstOrderActivation<double>{activationTime, deactivationTime, minimumActivation};
}

// f_T depends on ε/e_T alone.
template <>
auto Thelen2003<double>::tendonForceInOwn(double strain) const -> Own {
  Own d{};
  d[ThelenOwn::tendonStrain] = -strain / p_.tendonStrainAtMaxForce * tendonForce(strain).slope;
  return d;
}

template <>
auto Thelen2003<double>::activeForceInOwn(double l) const -> Own {
  Own d{};
  const double x = (l - 1) * perWidth_;
  d[ThelenOwn::activeWidth] = x * x * activeForce(l).value;
  return d;
}

// f_PE = (E − 1)/(e^k − 1) with E = exp(k x), x = (l − 1)/e_M
template <>
auto Thelen2003<double>::passiveForceInOwn(double l) const -> Own {
  Own d{};
  if (l <= 1) return d;
  const CurvePoint<double> f = passiveForce(l);
  const double x = (l - 1) / p_.passiveStrainAtMaxForce;
  d[ThelenOwn::passiveStrain] = -x * f.slope;
  d[ThelenOwn::passiveShape] =
      x * (f.value + passiveScale_) - f.value * std::exp(p_.passiveShape) * passiveScale_;
  return d;
}

template <>
auto Thelen2003<double>::forceVelocityInOwn(double v, double a) const -> Own {
  using D = info::Dual<3>;
  const Numbers<D> n{D(numbers_.shape, 3, 0), D(numbers_.lengthening, 3, 1),
                     D(numbers_.threshold, 3, 2)};
  const D f = forceOf<D>(n, branchesOf(n), D(v), D(a)).value;
  Own d{};
  for (int i = 0; i < 3; ++i)
    d[ThelenOwn::velocityShape + static_cast<std::size_t>(i)] = f.derivatives()[i];
  return d;
}

template <>
auto Thelen2003<double>::speedInOwn(double P, double A, double a) const -> Own {
  using D = info::Dual<3>;
  const Numbers<D> n{D(numbers_.shape, 3, 0), D(numbers_.lengthening, 3, 1),
                     D(numbers_.threshold, 3, 2)};
  const D v = speedOf<D>(n, branchesOf(n), D(P), D(A), D(a)).v;
  Own d{};
  for (int i = 0; i < 3; ++i)
    d[ThelenOwn::velocityShape + static_cast<std::size_t>(i)] = v.derivatives()[i];
  return d;
}

}  // namespace bio::muscles
