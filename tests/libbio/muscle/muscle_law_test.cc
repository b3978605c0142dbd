// What holds for every muscle class: laws of the Hill structure, rests, powers, rules of the
// numbers, and the list of classes.
#include <gtest/gtest.h>

#include "bio/muscle/fibre_rest.h"
#include "bio/muscle/muscle_forces.h"
#include "support/muscle_cases.h"
#include "support/numbers.h"
#include "support/throws_saying.h"

namespace bio::muscles {
namespace {

using support::MuscleState;

static_assert(HillShape<Thelen2003<double>>);
static_assert(HillShape<Millard2012<double>>);
static_assert(HillShape<DeGrooteFregly2016<double>>);
static_assert(HillShape<RigidTendon<double>>);

template <class Class>
class MuscleLaw : public testing::Test {
 public:
  using Muscle = HillMuscle<typename Class::template Shape<double>>;
  template <class F>
  static void forEach(const F& f) {
    for (const auto& p : Class::numbers()) {
      const Muscle muscle(p);
      for (const MuscleState& s : support::muscleStates(muscle, 64, 11)) f(muscle, s);
    }
  }
};
using LawClasses =
    testing::Types<support::ThelenClass, support::MillardClass, support::DeGrooteClass>;
TYPED_TEST_SUITE(MuscleLaw, LawClasses);

TYPED_TEST(MuscleLaw, MovesAtTheVelocityThatBalancesItsForces) {
  double worst = 0, force = 0;
  this->forEach([&](const auto& m, const MuscleState& s) {
    const auto r = m.fibreRate(s.activation, s.fibreLength, s.pathLength);
    const auto b = m.fibreBalance(s.activation, s.fibreLength, s.pathLength, r.fibreVelocity);
    worst = std::max(worst, std::abs(b.residual));
    force = std::max(force, std::abs(b.tendonForce - r.tendonForce));
    // along the curve of balance both forms say the same: V_x = −R_x/R_v
    const double per = -1 / b.dR_dFibreVelocity;
    EXPECT_NEAR(r.dV_dFibreLength, b.dR_dFibreLength * per,
                1e-9 * (1 + std::abs(r.dV_dFibreLength)));
    EXPECT_NEAR(r.dV_dPathLength, b.dR_dPathLength * per, 1e-9 * (1 + std::abs(r.dV_dPathLength)));
    EXPECT_NEAR(r.dV_dActivation, b.dR_dActivation * per, 1e-9 * (1 + std::abs(r.dV_dActivation)));
  });
  EXPECT_LT(worst, 1e-13);
  EXPECT_EQ(force, 0);
  std::printf("residual at the velocity: %.1e F0\n", worst);
}

TYPED_TEST(MuscleLaw, GivesItsPathThePowerOfItsParts) {
  double worst = 0;
  this->forEach([&](const auto& m, const MuscleState& s) {
    const auto r = m.fibreRate(s.activation, s.fibreLength, s.pathLength);
    const MuscleForces f =
        muscleForces(m, s.activation, s.fibreLength, s.pathLength, r.fibreVelocity, s.pathSpeed);
    const double parts = f.activePower + f.passivePower + f.dampingPower + f.tendonPower;
    const double scale = 1 + std::abs(f.activePower) + std::abs(f.tendonPower);
    worst = std::max(worst, std::abs(f.muscleTendonPower - parts) / scale);
    EXPECT_GE(f.dampingPower, 0);
  });
  EXPECT_LT(worst, 1e-12);
}

// An elastic tendon ever stiffer comes to the force of a rigid one.
TYPED_TEST(MuscleLaw, WithARigidTendonIsTheSameLawAtTheLengthThePathGives) {
  for (auto p : TypeParam::numbers()) {
    p.ignoreTendonCompliance = true;
    const typename TestFixture::Muscle rigid(p);
    const double L = p.tendonSlackLength + 0.9 * p.optimalFibreLength;
    for (double speed : {-0.2, 0.0, 0.15}) {
      const RigidRate<double> r = rigid.rigidRate(0.6, L, speed);
      const double w = rigid.thickness(), along = L - p.tendonSlackLength;
      EXPECT_NEAR(r.fibreLength, std::sqrt(along * along + w * w), 1e-16);
      // the fibre's share of the balance: what fibreBalance has without its tendon
      const auto b = rigid.fibreBalance(0.6, r.fibreLength, L, r.fibreVelocity);
      EXPECT_NEAR(r.tendonForce, p.maxIsometricForce * b.residual + b.tendonForce, 1e-9);
      const MuscleForces f = muscleForces(rigid, 0.6, r.fibreLength, L, r.fibreVelocity, speed);
      EXPECT_NEAR(f.tendonForce, r.tendonForce, 1e-9);
      EXPECT_NEAR(f.tendonPower, 0, 1e-9);
    }
    const RigidRate<double> slack = rigid.rigidRate(0.6, 0.9 * p.tendonSlackLength, 0.1);
    EXPECT_EQ(slack.tendonForce, 0);
    EXPECT_EQ(slack.dF_dPathLength, 0);
    EXPECT_EQ(slack.fibreLength, rigid.thickness());
  }
}

TYPED_TEST(MuscleLaw, RestsWhereItsVelocityIsNothing) {
  int found = 0;
  this->forEach([&](const auto& m, const MuscleState& s) {
    const FibreRest rest = restingFibre(m, s.activation, s.pathLength);
    if (rest.why != FibreRest::Why::found) return;
    ++found;
    const auto r = m.fibreRate(s.activation, rest.fibreLength, s.pathLength);
    EXPECT_NEAR(r.fibreVelocity, 0, 1e-9 * m.speedScale());
    EXPECT_NEAR(r.tendonForce, rest.tendonForce, 1e-9);
    EXPECT_LT(r.dV_dFibreLength, 0);  // stable
  });
  EXPECT_GT(found, 100);
}

TYPED_TEST(MuscleLaw, SaysWhyAFibreDoesNotRest) {
  const typename TestFixture::Muscle m(TypeParam::numbers()[0]);
  const FibreRest rest = restingFibre(m, 0.5, 0.9 * m.parameters().tendonSlackLength);
  if (holdsFibre<typename TestFixture::Muscle::Shape> && m.shortestFibre() > 0) {
    EXPECT_EQ(rest.why, FibreRest::Why::held);
    EXPECT_EQ(rest.fibreLength, m.shortestFibre());
    EXPECT_EQ(rest.tendonForce, 0);
  } else {
    EXPECT_EQ(rest.why, FibreRest::Why::tendonTooShort);
    EXPECT_TRUE(std::isnan(rest.fibreLength));
  }
  support::throwsSaying([&] { restingFibre(m, support::nan, 0.3); }, "activation is nan");
  support::throwsSaying([&] { restingFibre(m, 0.5, support::nan); }, "path length is nan m");
}

TYPED_TEST(MuscleLaw, IsNotANumberForAFibreShorterThanItsThickness) {
  const typename TestFixture::Muscle m(TypeParam::numbers()[0]);
  const auto r = m.fibreRate(0.5, 0.99 * m.thickness(), 0.3);
  EXPECT_TRUE(std::isnan(r.fibreVelocity));
  EXPECT_TRUE(std::isnan(m.fibreBalance(0.5, 0.99 * m.thickness(), 0.3, 0.0).residual));
}

TYPED_TEST(MuscleLaw, ActsWithItsLeastActivationBelowIt) {
  const typename TestFixture::Muscle m(TypeParam::numbers()[0]);
  const double least = m.shape().minimumActivation();
  EXPECT_GT(least, 0);
  const double L = 0.31, l = 0.1;
  EXPECT_EQ(m.fibreRate(0.0, l, L).fibreVelocity, m.fibreRate(least, l, L).fibreVelocity);
  EXPECT_EQ(m.fibreRate(0.0, l, L).dV_dActivation, 0);
}

// Every number outside its range is refused by its name, NaN among them.
TYPED_TEST(MuscleLaw, RefusesEveryNumberOutsideItsRange) {
  using P = typename TestFixture::Muscle::Parameters;
  P good = TypeParam::numbers()[0];
  EXPECT_NO_THROW(good.requireRules());
  for (std::size_t i = 0; i < P::count; ++i) {
    const MuscleProperty& property = P::properties[i];
    const std::string name(property.name);
    P bad = good;
    P::at(bad, i) = support::nan;
    support::throwsSaying([&] { bad.requireRules(); }, name.c_str());
    if (std::isfinite(property.range.low)) {
      P::at(bad, i) = property.range.low - (property.range.withLow ? 1e-3 : 0);
      support::throwsSaying([&] { bad.requireRules(); }, name.c_str());
    }
    if (std::isfinite(property.range.high)) {
      P::at(bad, i) = property.range.high + (property.range.withHigh ? 1e-3 : 0);
      support::throwsSaying([&] { bad.requireRules(); }, name.c_str());
    }
  }
}

TYPED_TEST(MuscleLaw, HasNumbersInTheOrderOfItsProperties) {
  using P = typename TestFixture::Muscle::Parameters;
  P p;
  EXPECT_EQ(&P::at(p, placeOf<P>("max_isometric_force")), &p.maxIsometricForce);
  EXPECT_EQ(&P::at(p, placeOf<P>("max_contraction_velocity")), &p.maxContractionVelocity);
  EXPECT_EQ(&P::at(p, placeOf<P>("activation_time_constant")), &p.activationTime);
  EXPECT_EQ(&P::at(p, placeOf<P>("deactivation_time_constant")), &p.deactivationTime);
  EXPECT_EQ(placeOf<P>("no such number"), P::count);
  for (std::size_t i = 0; i < P::count; ++i) EXPECT_EQ(placeOf<P>(P::properties[i].name), i);
}

TEST(MuscleRules, BetweenNumbersAreKept) {
  Thelen2003Parameters<double> thelen;
  thelen.extrapolationThreshold = 0.7;
  support::throwsSaying([&] { thelen.requireRules(); }, "must be > 1/Flen");
  thelen = {};
  thelen.ignoreTendonCompliance = true;
  support::throwsSaying([&] { thelen.requireRules(); }, "has no rigid tendon");
  const auto refuses = [](auto change, const char* words) {
    Millard2012Parameters<double> p;
    change(p);
    support::throwsSaying([&] { p.requireRules(); }, words);
  };
  refuses([](auto& p) { p.minActiveLength = 0.8; }, "min_norm_active_fiber_length is 0.8");
  refuses([](auto& p) { p.transitionLength = 1.1; }, "transition_norm_fiber_length is 1.1");
  refuses([](auto& p) { p.shallowSlope = 4; }, "shallow_ascending_slope is 4");
  refuses([](auto& p) { p.passiveUnitStrain = -0.1; }, "> strain_at_zero_force");
  refuses([](auto& p) { p.passiveShapeIsGiven = true, p.passiveUnitStiffness = 1; },
          "FiberForceLengthCurve/stiffness_at_one_norm_force is 1");
  refuses([](auto& p) { p.passiveShapeIsGiven = true, p.passiveLowStiffness = 2; },
          "stiffness_at_low_force is 2");
  refuses([](auto& p) { p.tendonShapeIsGiven = true, p.tendonUnitStiffness = 10; },
          "TendonForceLengthCurve/stiffness_at_one_norm_force is 10");
  refuses([](auto& p) { p.concentricSlope = 0.3; }, "concentric_slope_at_vmax is 0.3");
  refuses([](auto& p) { p.eccentricSlope = 0.2; }, "eccentric_slope_at_vmax is 0.2");
  refuses([](auto& p) { p.eccentricNearSlope = 0.5; }, "eccentric_slope_near_vmax is 0.5");
  refuses([](auto& p) { p.fibreDamping = 0, p.minimumActivation = 0; },
          "minimum_activation is 0, must be >= 0.01 without damping");
}

TEST(MuscleClassList, FindsClassesByOpenSimsName) {
  for (const char* name :
       {"Thelen2003Muscle", "Millard2012EquilibriumMuscle", "DeGrooteFregly2016Muscle"}) {
    const AnyParameters p = MuscleClasses::defaultsOf(name);
    std::visit(
        [&](const auto& m) {
          EXPECT_EQ(std::decay_t<decltype(m.shape())>::className, name);
          EXPECT_EQ(m.perFibre(), 10);
        },
        compile(p));
  }
  support::throwsSaying([] { MuscleClasses::defaultsOf("NoMuscle"); }, "NoMuscle is not known");
  AnyParameters broken = MuscleClasses::defaultsOf("Millard2012EquilibriumMuscle");
  std::get<Millard2012Parameters<double>>(broken).tendonSlackLength = -1;
  support::throwsSaying([&] { compile(broken); }, "tendon_slack_length is -1 m, must be > 0");
}

TEST(MuscleClassList, GivesEachClassItsActivation) {
  AnyParameters millard = MuscleClasses::defaultsOf("Millard2012EquilibriumMuscle");
  const auto law = [](const AnyParameters& p) {
    return std::visit([](const auto& q) { return q.activation(); }, p);
  };
  EXPECT_EQ(std::get<FirstOrderActivation<double>>(law(millard)).deactivationTime, 0.04);
  std::get<Millard2012Parameters<double>>(millard).ignoreActivationDynamics = true;
  EXPECT_EQ(std::get<DirectActivation>(law(millard)).least, 0.01);
  const AnyParameters deGroote = MuscleClasses::defaultsOf("DeGrooteFregly2016Muscle");
  EXPECT_EQ(std::get<SmoothActivation<double>>(activationOf(deGroote)).smoothing, 0.1);
}

// Values of a prototype in another language: ℓ̇ [m/s] and F_T [N] of a muscle of 1000 N, and its
// rests.
TEST(MuscleReference, MovesAndRestsAsThePrototype) {
  const auto reference = [](auto p) {
    p.pennation = support::degree * 10;
    return p;
  };
  const HillMuscle<Thelen2003<double>> thelen(reference(Thelen2003Parameters<double>()));
  const HillMuscle<Millard2012<double>> millard(reference(Millard2012Parameters<double>()));
  const HillMuscle<DeGrooteFregly2016<double>> deGroote(
      reference(DeGrooteFregly2016Parameters<double>()));
  const auto expect = [](const auto& m, double a, double l, double L, double V, double F) {
    const auto r = m.fibreRate(a, l, L);
    EXPECT_NEAR(r.fibreVelocity, V, 2e-13 * (1 + std::abs(V)) * (std::abs(V) > 10 ? 10 : 1));
    EXPECT_NEAR(r.tendonForce, F, 1e-10);
  };
  expect(millard, 0.5, 0.10, 0.305, 0.0216214634190217, 543.321831170858);
  expect(millard, 0.3, 0.12, 0.33, 8.22457923257908, 1205.2749855174);
  expect(millard, 0.01, 0.08, 0.279, 0.221297865822819, 32.444408872106);
  expect(thelen, 0.5, 0.10, 0.305, 0.234903380673544, 683.137826156432);
  expect(thelen, 0.3, 0.12, 0.33, 7.56037832589934, 1698.24055740082);
  expect(deGroote, 1, 0.09, 0.295, -0.221222282983477, 479.710681416315);
  expect(deGroote, 0.05, 0.10, 0.302, 115.143804621311, 180.599014049269);
  const auto rests = [](const auto& m, double a, double L, double l, double F) {
    const FibreRest rest = restingFibre(m, a, L);
    EXPECT_NEAR(rest.fibreLength, l, 1e-14);
    EXPECT_NEAR(rest.tendonForce, F, 1e-9);
  };
  rests(millard, 0.5, 0.30, 0.0955013883273131, 490.210826502672);
  rests(thelen, 1, 0.31, 0.103534863636278, 985.391994515398);
  rests(deGroote, 0.01, 0.33, 0.128486016692337, 127.226162848843);
  const auto rigid = [](const auto& m, double a, double L, double speed, double F) {
    EXPECT_NEAR(m.rigidRate(a, L, speed).tendonForce, F, 1e-10);
  };
  auto stiff = reference(Millard2012Parameters<double>());
  stiff.ignoreTendonCompliance = true;
  rigid(HillMuscle<Millard2012<double>>(stiff), 0.5, 0.3, -0.1, 300.322989989961);
  rigid(HillMuscle<Millard2012<double>>(stiff), 0.2, 0.32, 0.3, 291.471591743832);
  rigid(deGroote, 0.5, 0.3, -0.1, 389.078350826933);
}

}  // namespace
}  // namespace bio::muscles
