// Derivatives of every muscle class in states and numbers, each against dual numbers carried
// through the law and against differences of the law.
#include <gtest/gtest.h>

#include "bio/muscle/fibre_rest.h"
#include "bio/muscle/muscle_sensitivity.h"
#include "support/finite_difference.h"
#include "support/muscle_cases.h"

namespace bio::muscles {
namespace {

using support::centralDifference;
using support::MuscleState;
using support::relativeError;

template <class Class>
class MuscleDerivatives : public testing::Test {
 public:
  using Shape = typename Class::template Shape<double>;
  using Muscle = HillMuscle<Shape>;
  using Parameters = typename Shape::Parameters;
  static constexpr std::size_t numbers = Parameters::count;

  /// A muscle in dual numbers, one direction per number.
  template <class P>
  static auto inDuals(const P& p) {
    using D = info::Dual<static_cast<int>(numbers)>;
    auto q = inNumbers<Class::template Parameters, D>(p);
    for (std::size_t i = 0; i < numbers; ++i) {
      q.at(q, i) = D(q.at(q, i).value(), static_cast<int>(numbers), static_cast<int>(i));
    }
    return HillMuscle<typename Class::template Shape<D>>(q);
  }

  /// f(muscle) as a function of one of the muscle's numbers.
  template <class F>
  static double byNumber(const Parameters& p, std::size_t i, const F& f) {
    const double x = Parameters::at(p, i);
    const auto of = [&](double value) {
      Parameters q = p;
      Parameters::at(q, i) = value;
      return f(Muscle(q));
    };
    // a curve whose number is 0 may not have it below
    if (x == 0) return (4 * of(1e-5) - of(2e-5) - 3 * of(0)) / 2e-5;
    return centralDifference(of, x, 3e-6 * std::abs(x));
  }

  /// Numbers that the law does not follow in the fibre or at their present value: switched off by
  /// the class (damping below its threshold), or with a step in it.
  static bool isSwitch(const Parameters& p, std::size_t i) {
    return Parameters::properties[i].name == "fiber_damping" && Parameters::at(p, i) == 0 &&
           std::string_view(Shape::className) == "Millard2012EquilibriumMuscle";
  }

  template <class F>
  static void forEach(const F& f, int count = 48) {
    for (const Parameters& p : Class::numbers()) {
      const Muscle muscle(p);
      for (const MuscleState& s : support::muscleStates(muscle, count, 7)) {
        f(p, muscle, s);
      }
    }
  }
  /// The same over fewer states, with the muscle in dual numbers.
  template <class F>
  static void forEachWithDuals(bool rigid, const F& f);
};

template <class Class>
template <class F>
void MuscleDerivatives<Class>::forEachWithDuals(bool rigid, const F& f) {
  for (Parameters p : Class::numbers()) {
    const auto states = support::muscleStates(Muscle(p), 16, 7);
    p.ignoreTendonCompliance = rigid;
    const Muscle muscle(p);
    const auto dual = inDuals(p);
    for (const MuscleState& s : states) f(p, muscle, s, dual);
  }
}

using ShapeClasses =
    testing::Types<support::ThelenClass, support::MillardClass, support::DeGrooteClass>;
TYPED_TEST_SUITE(MuscleDerivatives, ShapeClasses);

TYPED_TEST(MuscleDerivatives, OfTheFibreRateInItsStateAreThoseOfDualNumbersAndDifferences) {
  double byDual = 0, byDifference = 0;
  this->forEach([&](const auto&, const auto& m, const MuscleState& s) {
    using D = info::Dual<3>;
    const auto r = m.fibreRate(s.activation, s.fibreLength, s.pathLength);
    const auto d =
        m.fibreRate(D(s.activation, 3, 0), D(s.fibreLength, 3, 1), D(s.pathLength, 3, 2));
    const Eigen::Vector3d V(r.dV_dActivation, r.dV_dFibreLength, r.dV_dPathLength);
    const Eigen::Vector3d F(0, r.dF_dFibreLength, r.dF_dPathLength);
    EXPECT_NEAR(d.fibreVelocity.value(), r.fibreVelocity, 1e-12 * (1 + std::abs(r.fibreVelocity)));
    for (int i = 0; i < 3; ++i) {
      byDual = std::max({byDual, relativeError(V[i], d.fibreVelocity.derivatives()[i], 1),
                         relativeError(F[i], d.tendonForce.derivatives()[i], 1000)});
      const auto along = [&](double h) {
        const double x[] = {i == 0 ? h : 0, i == 1 ? h : 0, i == 2 ? h : 0};
        return m.fibreRate(s.activation + x[0], s.fibreLength + x[1], s.pathLength + x[2]);
      };
      const double h = i == 0 ? 1e-5 : 1e-7;
      const double dV = centralDifference([&](double x) { return along(x).fibreVelocity; }, 0, h);
      const double dF = centralDifference([&](double x) { return along(x).tendonForce; }, 0, h);
      byDifference =
          std::max({byDifference, relativeError(V[i], dV, 1), relativeError(F[i], dF, 1000)});
    }
  });
  EXPECT_LT(byDual, 1e-9);
  EXPECT_LT(byDifference, 1e-6);
  std::printf("state: dual %.1e, difference %.1e\n", byDual, byDifference);
}

TYPED_TEST(MuscleDerivatives, OfTheFibreRateInEveryNumberAreThoseOfDualNumbersAndDifferences) {
  double byDual = 0, byDifference = 0;
  this->forEachWithDuals(false, [&](const auto& p, const auto& m, const MuscleState& s,
                                    const auto& inDuals) {
    const auto d = fibreRateInNumbers(m, s.activation, s.fibreLength, s.pathLength);
    const auto dual = inDuals.fibreRate(s.activation, s.fibreLength, s.pathLength);
    for (std::size_t i = 0; i < this->numbers; ++i) {
      const auto k = static_cast<int>(i);
      byDual =
          std::max({byDual, relativeError(d.equation[i], dual.fibreVelocity.derivatives()[k], 1),
                    relativeError(d.tendonForce[i], dual.tendonForce.derivatives()[k], 1000)});
      if (this->isSwitch(p, i)) continue;
      const double dV = this->byNumber(p, i, [&](const auto& q) {
        return q.fibreRate(s.activation, s.fibreLength, s.pathLength).fibreVelocity;
      });
      const double dF = this->byNumber(p, i, [&](const auto& q) {
        return q.fibreRate(s.activation, s.fibreLength, s.pathLength).tendonForce;
      });
      const double error =
          std::max(relativeError(d.equation[i], dV, 1), relativeError(d.tendonForce[i], dF, 1000));
      EXPECT_LT(error, 1e-6) << p.properties[i].name << " " << d.equation[i] << " " << dV;
      byDifference = std::max(byDifference, error);
    }
  });
  EXPECT_LT(byDual, 1e-9);
  std::printf("numbers: dual %.1e, difference %.1e\n", byDual, byDifference);
}

TYPED_TEST(MuscleDerivatives, OfTheForceBalanceAreThoseOfDualNumbersAndDifferences) {
  double byDual = 0, byDifference = 0;
  this->forEachWithDuals(false, [&](const auto& p, const auto& m, const MuscleState& s,
                                    const auto& inDuals) {
    using D = info::Dual<4>;
    const double v = s.fibreVelocity * 0.8;
    const auto r = m.fibreBalance(s.activation, s.fibreLength, s.pathLength, v);
    const auto state = m.fibreBalance(D(s.activation, 4, 0), D(s.fibreLength, 4, 1),
                                      D(s.pathLength, 4, 2), D(v, 4, 3));
    const Eigen::Vector4d R(r.dR_dActivation, r.dR_dFibreLength, r.dR_dPathLength,
                            r.dR_dFibreVelocity);
    for (int i = 0; i < 4; ++i) {
      byDual = std::max(byDual, relativeError(R[i], state.residual.derivatives()[i], 1));
    }
    byDual =
        std::max({byDual, relativeError(r.dF_dFibreLength, state.tendonForce.derivatives()[1], 1e3),
                  relativeError(r.dF_dPathLength, state.tendonForce.derivatives()[2], 1e3)});
    const auto d = fibreBalanceInNumbers(m, s.activation, s.fibreLength, s.pathLength, v);
    const auto dual = inDuals.fibreBalance(s.activation, s.fibreLength, s.pathLength, v);
    for (std::size_t i = 0; i < this->numbers; ++i) {
      byDual = std::max(byDual, relativeError(d.equation[i],
                                              dual.residual.derivatives()[static_cast<int>(i)], 1));
      if (this->isSwitch(p, i)) continue;
      const double dR = this->byNumber(p, i, [&](const auto& q) {
        return q.fibreBalance(s.activation, s.fibreLength, s.pathLength, v).residual;
      });
      EXPECT_LT(relativeError(d.equation[i], dR, 1), 1e-6) << p.properties[i].name;
      byDifference = std::max(byDifference, relativeError(d.equation[i], dR, 1));
    }
  });
  EXPECT_LT(byDual, 1e-9);
  std::printf("balance: dual %.1e, difference %.1e\n", byDual, byDifference);
}

TYPED_TEST(MuscleDerivatives, OfTheRigidForceAreThoseOfDualNumbersAndDifferences) {
  double byDual = 0, byDifference = 0;
  this->forEachWithDuals(true, [&](const auto& p, const auto& m, const MuscleState& s,
                                   const auto& inDuals) {
    using D = info::Dual<3>;
    const auto r = m.rigidRate(s.activation, s.pathLength, s.pathSpeed);
    const auto state =
        m.rigidRate(D(s.activation, 3, 0), D(s.pathLength, 3, 1), D(s.pathSpeed, 3, 2));
    const Eigen::Vector3d F(r.dF_dActivation, r.dF_dPathLength, r.dF_dPathSpeed);
    for (int i = 0; i < 3; ++i) {
      byDual = std::max(byDual, relativeError(F[i], state.tendonForce.derivatives()[i], 1e3));
    }
    const auto d = rigidForceInNumbers(m, s.activation, s.pathLength, s.pathSpeed);
    const auto dual = inDuals.rigidRate(s.activation, s.pathLength, s.pathSpeed);
    for (std::size_t i = 0; i < this->numbers; ++i) {
      byDual = std::max(
          byDual, relativeError(d[i], dual.tendonForce.derivatives()[static_cast<int>(i)], 1e3));
      if (this->isSwitch(p, i)) continue;
      const double dF = this->byNumber(p, i, [&](const auto& q) {
        return q.rigidRate(s.activation, s.pathLength, s.pathSpeed).tendonForce;
      });
      EXPECT_LT(relativeError(d[i], dF, 1e3), 1e-6) << p.properties[i].name;
      byDifference = std::max(byDifference, relativeError(d[i], dF, 1e3));
    }
  });
  EXPECT_LT(byDual, 1e-9);
  std::printf("rigid: dual %.1e, difference %.1e\n", byDual, byDifference);
}

TYPED_TEST(MuscleDerivatives, OfTheRestAreDifferencesOfTheRest) {
  double worst = 0;
  int used = 0;
  this->forEach(
      [&](const auto& p, const auto& m, const MuscleState& s) {
        const FibreRest rest = restingFibre(m, s.activation, s.pathLength);
        if (rest.why != FibreRest::Why::found || rest.count != 1) return;
        ++used;
        const auto d = restDerivatives(m, s.activation, s.pathLength, rest);
        const double a = centralDifference(
            [&](double x) { return restingFibre(m, x, s.pathLength).fibreLength; }, s.activation,
            1e-4);
        const double L = centralDifference(
            [&](double x) { return restingFibre(m, s.activation, x).fibreLength; }, s.pathLength,
            1e-5);
        worst = std::max({worst, relativeError(d.dl_dActivation, a, 0.1),
                          relativeError(d.dl_dPathLength, L, 1)});
        for (std::size_t i = 0; i < this->numbers; ++i) {
          if (this->isSwitch(p, i)) continue;
          const double number = this->byNumber(p, i, [&](const auto& q) {
            return restingFibre(q, s.activation, s.pathLength).fibreLength;
          });
          EXPECT_LT(relativeError(d.dl_dNumber[i], number, 0.1), 1e-6) << p.properties[i].name;
          worst = std::max(worst, relativeError(d.dl_dNumber[i], number, 0.1));
        }
      },
      6);
  EXPECT_GT(used, 5);
  EXPECT_LT(worst, 1e-6);
  std::printf("rest: difference %.1e over %d\n", worst, used);
}

// A shape whose curves are scaled as the derivatives in the scales mean it.
template <class Inner>
class Scaled : public Inner {
 public:
  using Inner::Inner;
  static inline std::array<double, scales::count> s{1, 1, 1, 1};
  CurvePoint<double> tendonForce(double strain) const {
    CurvePoint<double> f = Inner::tendonForce(strain / s[scales::tendonStrain]);
    f.slope /= s[scales::tendonStrain];
    return f;
  }
  CurvePoint<double> activeForce(double l) const {
    CurvePoint<double> f = Inner::activeForce(1 + (l - 1) / s[scales::activeWidth]);
    f.value *= s[scales::activeForce];
    return f;
  }
  CurvePoint<double> passiveForce(double l) const {
    CurvePoint<double> f = Inner::passiveForce(l);
    f.value *= s[scales::passiveForce];
    return f;
  }
};

TYPED_TEST(MuscleDerivatives, InTheScalesOfTheCurvesAreDifferencesOfScaledCurves) {
  using Plain = typename TestFixture::Shape;
  double worst = 0;
  this->forEach([&](const auto& p, const auto& m, const MuscleState& s) {
    const auto d = fibreRateInNumbers(m, s.activation, s.fibreLength, s.pathLength);
    const HillMuscle<Scaled<Plain>> scaled(p);
    for (std::size_t k = 0; k < scales::count; ++k) {
      const auto at = [&](double x) {
        Scaled<Plain>::s[k] = x;
        const auto r = scaled.fibreRate(s.activation, s.fibreLength, s.pathLength);
        Scaled<Plain>::s[k] = 1;
        return r;
      };
      const double dV = centralDifference([&](double x) { return at(x).fibreVelocity; }, 1, 1e-5);
      const double dF = centralDifference([&](double x) { return at(x).tendonForce; }, 1, 1e-5);
      worst = std::max({worst, relativeError(d.equation[this->numbers + k], dV, 1),
                        relativeError(d.tendonForce[this->numbers + k], dF, 1000)});
    }
  });
  EXPECT_LT(worst, 1e-6);
  std::printf("scales: difference %.1e\n", worst);
}

// Where the activation acts as the class's least, results follow that number and not the state.
TYPED_TEST(MuscleDerivatives, BelowTheLeastActivationAreInThatNumber) {
  using Plain = typename TestFixture::Shape;
  for (const auto& p : TypeParam::numbers()) {
    const typename TestFixture::Muscle m(p);
    const double L = 0.98 * p.optimalFibreLength + 1.01 * p.tendonSlackLength;
    const double a = 0.5 * m.shape().minimumActivation();
    const auto r = m.fibreRate(a, p.optimalFibreLength, L);
    EXPECT_EQ(r.dV_dActivation, 0);
    EXPECT_EQ(
        r.fibreVelocity,
        m.fibreRate(m.shape().minimumActivation() * 1.0, p.optimalFibreLength, L).fibreVelocity);
    const auto d = fibreRateInNumbers(m, a, p.optimalFibreLength, L);
    constexpr std::size_t place = Plain::minimumActivationPlace;
    if constexpr (place < Plain::Parameters::count) {
      const double dV = this->byNumber(p, place, [&](const auto& q) {
        return q.fibreRate(a, p.optimalFibreLength, L).fibreVelocity;
      });
      EXPECT_LT(relativeError(d.equation[place], dV, 1), 1e-6) << d.equation[place] << " " << dV;
      EXPECT_NE(dV, 0);
    }
  }
}

}  // namespace
}  // namespace bio::muscles
