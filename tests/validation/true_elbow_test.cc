#include "generator/true_elbow.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "generator/hidden_effects.h"
#include "generator/stiff_solver.h"

namespace hidden {
namespace {

const ElbowNumbers& shipped() {
  static const ElbowNumbers numbers =
      readElbow(std::string(FISHERHILL_SOURCE_DIR) + "/models/elbow8.osim");
  return numbers;
}

// An effort with every muscle at its own pace.
Recording effort(double seconds) {
  Recording recording;
  for (int k = 0; k <= static_cast<int>(seconds / 0.02 + 0.5); ++k) {
    const double t = 0.02 * k;
    recording.times.push_back(t);
    std::array<double, 8> u{};
    for (std::size_t i = 0; i < 8; ++i) {
      const double own = static_cast<double>(i);
      u[i] = (i < 4 ? 0.02 : 0.05) * (1 + 0.8 * std::sin((2 + 0.4 * own) * t + own));
    }
    recording.emg.push_back(u);
  }
  return recording;
}

// Kinetic and potential energy body by body, from velocities and heights.
double energy(const ElbowNumbers& numbers, double q, double w) {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(q, numbers.axis).toRotationMatrix();
  double sum = 0;
  for (const Body& body : numbers.forearm) {
    const Vec r = R * (body.centre - numbers.hinge);
    const Vec omega = w * numbers.axis;
    const Vec velocity = omega.cross(r);
    sum += body.mass * velocity.squaredNorm() / 2 +
           omega.dot(R * body.inertia * R.transpose() * omega) / 2 -
           body.mass * numbers.gravity.dot(r);
  }
  return sum;
}

Truth with(const std::string& id, double size) {
  Truth truth;
  truth.numbers = shipped();
  RandomNumbers random(1, 1);
  const EffectRow& row = hiddenEffect(id);
  row.apply(truth, row.amplitude(size), random);
  return truth;
}

TEST(TrueElbow, GainsTheEnergyThatMusclesAndHiddenTorquesPutIn) {
  const Recording recording = effort(1.0);
  for (const EffectRow& row : hiddenEffects()) {
    const Truth truth = with(row.id, 1);
    const TrueElbow elbow(truth.numbers, truth.chain, truth.extras, true);
    StiffSolver solver(elbow, recording, elbow.start(recording, 70 * degree), 1e-9);
    const double before = energy(truth.numbers, 70 * degree, 0);
    const Eigen::VectorXd y = solver.advanceTo(1.0);
    const double work = y[elbow.size() - 2] + y[elbow.size() - 1];
    EXPECT_GT(std::abs(y[elbow.size() - 2]), 0.05) << row.id;  // [J], so that it says something
    EXPECT_NEAR(energy(truth.numbers, y[0], y[1]) - before, work, 1e-6) << row.id;
  }
}

TEST(TrueElbow, DissipativeEffectsTakeEnergyOut) {
  for (const char* id : {"visc", "coulomb", "stribeck", "drag", "powerdamp", "angledamping"}) {
    const Truth truth = with(id, 1);
    const TrueElbow elbow(truth.numbers, truth.chain, truth.extras);
    for (const double w : {-3.0, -0.1, -0.001, 0.001, 0.1, 3.0}) {
      EXPECT_LT(elbow.extraTorque(0, 1.0, w, 0) * w, 0) << id << " at " << w;
    }
  }
}

TEST(TrueElbow, MomentArmsAreTheSlopesOfLengths) {
  for (const double wider : {0.0, 0.003}) {
    ElbowNumbers numbers = shipped();
    for (Cylinder& c : numbers.cylinders.shapes) c.radius += wider;
    const TrueElbow elbow(numbers, {}, {});
    int wrapped = 0;
    for (Eigen::Index i = 0; i < TrueElbow::muscles; ++i) {
      for (double q = 0.5 * degree; q < 130 * degree; q += 1.37 * degree) {
        constexpr double h = 1e-6;
        const auto at = elbow.arm(i, q), after = elbow.arm(i, q + h), before = elbow.arm(i, q - h);
        if (at.wraps != after.wraps || at.wraps != before.wraps) continue;
        wrapped += at.wraps;
        EXPECT_NEAR(at.slope, (after.length - before.length) / (2 * h), 1e-8)
            << elbow.numbers().muscles[static_cast<std::size_t>(i)].name << " " << q / degree;
      }
    }
    EXPECT_GT(wrapped, 100);
  }
}

TEST(TrueElbow, WrappedPathsAreTautStringsRoundTheCylinder) {
  // The shortest of many broken lines over the surface, by brute force in the two contact angles.
  Cylinder c;
  c.radius = 0.02, c.halfLength = 0.05;
  const Vec P(0.05, 0.01, 0.0), Q(-0.04, 0.015, 0.03);
  const SpanLength span = around(c, 1, P, Q);
  ASSERT_TRUE(span.wraps);
  double shortest = 1;
  for (double a = 0; a < std::numbers::pi; a += 0.004) {
    for (double b = a; b < std::numbers::pi; b += 0.004) {
      const Vec A(c.radius * std::cos(a), c.radius * std::sin(a), 0);
      const Vec B(c.radius * std::cos(b), c.radius * std::sin(b), 0);
      const double before = (A - P).head<2>().norm(), after = (Q - B).head<2>().norm();
      // neither chord may cut the cylinder
      if (A.head<2>().dot(P.head<2>() - A.head<2>()) < 0) continue;
      if (B.head<2>().dot(Q.head<2>() - B.head<2>()) < 0) continue;
      const double flat = before + c.radius * (b - a) + after;
      shortest = std::min(shortest, std::hypot(flat, Q.z() - P.z()));
    }
  }
  EXPECT_NEAR(span.length, shortest, 1e-6);
  EXPECT_GE(shortest, span.length - 1e-12);
}

TEST(ForceCurve, IsTheCubicWhereThePointsAreOfOne) {
  const auto cubic = [](double x) { return 1 + x * (2 - x * (3 - 0.5 * x)); };
  std::vector<double> x = {-1, -0.3, 0, 0.7, 1.1, 2.5}, y;
  for (const double knot : x) y.push_back(cubic(knot));
  const ForceCurve curve(x, y);
  for (double at = -1; at < 2.5; at += 0.01) EXPECT_NEAR(curve.at(at), cubic(at), 1e-12);
  EXPECT_TRUE(std::isnan(curve.at(std::nan(""))));
  EXPECT_THROW(ForceCurve({0, 1, 0.5, 2}, {0, 0, 0, 0}), std::invalid_argument);
}

TEST(ForceCurve, IsFlatWhereAPointStandsTwice) {
  const ForceCurve curve({0, 1, 1.5, 1.5, 2, 3}, {0, 0.2, 1, 1, 2, 2});
  EXPECT_NEAR((curve.at(1.5 + 1e-5) - curve.at(1.5)) / 1e-5, 0, 1e-3);
  EXPECT_NEAR((curve.at(1.5) - curve.at(1.5 - 1e-5)) / 1e-5, 0, 1e-3);
}

TEST(TrueElbow, FibreVelocityBalancesTheForces) {
  // equations.md, section 1, evaluated from the outside
  const HillMuscle& m = shipped().muscles[0];
  const double constant = 0.15, sigma = 0.13 * 0.15 / 1.15;
  int shortens = 0, lengthens = 0;
  for (const double activation : {0.02, 0.3, 1.0}) {
    for (double strain = 0.002; strain < 0.05; strain += 0.003) {
      const double fibre = 1.02 * m.fibreLength;
      const double cosine =
          std::sqrt(1 - std::pow(m.fibreLength * std::sin(m.pennation) / fibre, 2));
      const double length = fibre * cosine + m.slackLength * (1 + strain);
      const double v = m.fibreVelocity(activation, fibre, length) * m.timeScale / m.fibreLength;
      const double fv = v < -1   ? 0
                        : v <= 0 ? constant * (1 + v) / (constant - v)
                                 : (1.4 * v + sigma) / (v + sigma);
      const double force =
          m.maxForce * (activation * m.active.at(1.02) * fv + m.passive.at(1.02) + m.damping * v) *
          cosine;
      EXPECT_NEAR(force, m.tendonForce(fibre, length), 1e-9 * m.maxForce);
      ++(v < 0 ? shortens : lengthens);
    }
  }
  EXPECT_GT(shortens, 5);
  EXPECT_GT(lengthens, 5);
}

TEST(TrueElbow, RestsWhereNoFibreMoves) {
  const TrueElbow elbow(shipped(), {}, {});
  const Recording recording = effort(0.1);
  const Eigen::VectorXd y = elbow.start(recording, 1.0);
  Eigen::VectorXd rate(elbow.size());
  elbow.rate(recording, 0, y.data(), rate.data());
  EXPECT_LT(rate.tail(8).cwiseAbs().maxCoeff(), 1e-9);  // [m/s]
  EXPECT_EQ(rate[0], 0);
}

TEST(TrueElbow, EffectsWithoutSizeChangeNothing) {
  const Recording recording = effort(0.4);
  const auto endOf = [&](const ElbowNumbers& numbers) {
    const TrueElbow plain(numbers, {}, {});
    StiffSolver solver(plain, recording, plain.start(recording, 1.0), 1e-8);
    return solver.advanceTo(0.4)[0];
  };
  const double whole = endOf(shipped());
  for (const EffectRow& row : hiddenEffects()) {
    double q = whole;
    if (!row.leftOut.empty()) {
      ElbowNumbers lacking = shipped();
      for (HillMuscle& m : lacking.muscles) {
        if (m.name == row.leftOut) m.maxForce = 0;
      }
      q = endOf(lacking);
      EXPECT_GT(std::abs(q - whole), 0.1);
    }
    const Truth truth = with(row.id, 0);
    const TrueElbow elbow(truth.numbers, truth.chain, truth.extras);
    StiffSolver other(elbow, recording, elbow.start(recording, 1.0), 1e-8);
    // a muscle without force may be driven in another way, so that the solver's steps differ
    EXPECT_NEAR(other.advanceTo(0.4)[0], q, row.leftOut.empty() ? 1e-12 : 1e-6) << row.id;
  }
}

TEST(TrueElbow, TheInputChainDoesWhatTheTableSays) {
  Recording recording;
  recording.times = {0, 1};
  recording.emg = {{0.1, 0.1, 0.1, 0.1, 0.2, 0.4, 0.1, 0.1},
                   {0.3, 0.3, 0.3, 0.3, 0.4, 0.6, 0.3, 0.3}};
  const auto at = [&](const std::string& id, double size, double t) {
    const Truth truth = with(id, size);
    return TrueElbow(truth.numbers, truth.chain, truth.extras).excitation(recording, t);
  };
  EXPECT_NEAR(at("delay", 1, 0.54)[0], 0.2, 1e-12);
  EXPECT_NEAR(at("delay", 1, 0.03)[0], 0.1, 1e-12);
  EXPECT_NEAR(at("offset", 1, 0.5)[7], 0.19, 1e-12);
  EXPECT_NEAR(at("gain_TRI", 1, 0.5)[2], 0.2 * (1 - 0.4), 1e-12);
  EXPECT_NEAR(at("gain_TRI", 1, 0.5)[3], 0.2, 1e-12);
  EXPECT_NEAR(at("crosstalk_BIC_TRI", 1, 0)[0], 0.1 - 0.06 * 0.3, 1e-12);
  EXPECT_NEAR(at("crosstalk_BIC_TRI", 1, 0)[4], 0.2, 1e-12);
  EXPECT_NEAR(at("shape", 1, 0.5)[0], std::expm1(-0.3) / std::expm1(-1.5), 1e-12);
}

TEST(TrueElbow, LimitsAreOpenSimsCoordinateLimitForce) {
  const Truth truth = with("limit", 1);
  const TrueElbow elbow(truth.numbers, truth.chain, truth.extras);
  EXPECT_EQ(elbow.extraTorque(0, 70 * degree, 1, 0), 0);
  // half of the transition: the quintic step is ½ there
  EXPECT_NEAR(elbow.extraTorque(0, 105 * degree, 0, 0), -7.0 * 0.5 * 15 * degree, 1e-12);
  EXPECT_NEAR(elbow.extraTorque(0, 25 * degree, 0, 0), 7.0 * 0.5 * 15 * degree, 1e-12);
  EXPECT_NEAR(elbow.extraTorque(0, 0, 0, 0), 7.0 * 40 * degree, 1e-12);
}

TEST(TrueElbow, TiltIsGravityTurnedAboutTheHinge) {
  const Truth truth = with("tilt", 1);
  const TrueElbow elbow(truth.numbers, truth.chain, truth.extras);
  ElbowNumbers turnedNumbers = shipped();
  turnedNumbers.gravity = turned(shipped().gravity, shipped().axis, -0.12);
  const TrueElbow other(turnedNumbers, {}, {});
  for (const double q : {0.3, 1.0, 2.0}) {
    EXPECT_NEAR(elbow.extraTorque(0, q, 0, 0) + elbow.gravityMoment(q), other.gravityMoment(q),
                1e-12);
  }
}

}  // namespace
}  // namespace hidden
