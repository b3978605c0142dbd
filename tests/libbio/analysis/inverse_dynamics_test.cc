#include "bio/analysis/inverse_dynamics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libbio/simulation/arm_of_seven.h"
#include "second_ways/simbody_tree.h"
#include "support/arm_models.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using fixtures::ArmOfSeven;

// A shoulder and an elbow whose joint also slides; q = (lift, flex) swings.
struct Chain {
  Chain() : model(fixtures::threeLinkArm()) {
    model.springForces.push_back({"hold", "flex", 2, 0.1, 0.3});
  }
  MusculoskeletalSystem system() const { return {model, {{{"lift", "flex"}, {}}, {}, {}}}; }
  static Vector2d q(double t) {
    return {0.3 + 0.5 * std::sin(3 * t), 0.5 + 0.4 * std::sin(5 * t + 1)};
  }
  static Vector2d qDot(double t) { return {1.5 * std::cos(3 * t), 2 * std::cos(5 * t + 1)}; }
  static Vector2d qDotDot(double t) { return {-4.5 * std::sin(3 * t), -10 * std::sin(5 * t + 1)}; }
  // Samples of the swing at intervals of d, and what keeps it up.
  Trajectory kept(double d) const {
    std::vector<double> times;
    for (int k = 0; k * d < 1 + d / 2; ++k) times.push_back(k * d);
    MatrixXd samples(2, static_cast<Index>(times.size()));
    for (Index k = 0; k < samples.cols(); ++k) samples.col(k) = q(static_cast<double>(k) * d);
    SimulationOptions options;
    options.step = d;
    return inverseDynamics(system(), {times, MatrixXd(samples.cols(), 0)}, times, samples, options);
  }
  // Lagrange's equations with the mass matrix and gravity of Simbody, ∂M by differences.
  Vector2d bySimbody(double t) const {
    const SimbodyTree tree(model);
    const auto at = [&](const Vector2d& x) {
      return tree.reducedTo({"lift", "flex"}, {{"lift", x[0]}, {"flex", x[1]}});
    };
    const Vector2d x = q(t), v = qDot(t);
    Vector2d force = at(x).massMatrix * qDotDot(t) - at(x).gravityForce;
    for (int k = 0; k < 2; ++k) {
      const Vector2d d = 1e-5 * Vector2d::Unit(k);
      const Eigen::Matrix2d M_k = (at(x + d).massMatrix - at(x - d).massMatrix) / 2e-5;
      force += v[k] * M_k * v - v.dot(M_k * v) / 2 * Vector2d::Unit(k);
    }
    force[1] += 2 * (x[1] - 0.1) + 0.3 * v[1];
    return force;
  }

  Model model;
};

// Of second order in the interval of the samples, q̈ included, up to both ends.
TEST(InverseDynamics, OfAChainAreLagrangesEquationsWithSimbodysMassMatrix) {
  const Chain chain;
  std::vector<double> errors;
  double largest = 0;
  for (const double d : {0.02, 0.01, 0.005}) {
    const Trajectory kept = chain.kept(d);
    ASSERT_EQ(kept.outcome, Outcome::completed) << kept.why;
    errors.push_back(0);
    for (const double t : {0.0, 0.12, 0.3, 0.5, 0.66, 0.9, 1.0}) {
      const Vector2d expected = chain.bySimbody(t);
      const Vector2d found = kept.reaction.col(std::lround(t / d));
      largest = std::max(largest, expected.cwiseAbs().maxCoeff());
      errors.back() = std::max(errors.back(), (found - expected).cwiseAbs().maxCoeff());
    }
  }
  std::printf("  errors %.3g %.3g %.3g N m of %.3g\n", errors[0], errors[1], errors[2], largest);
  EXPECT_LT(errors[2], 1e-3);
  EXPECT_NEAR(std::log2(errors[0] / errors[2]) / 2, 2.0, 0.3);
}

// Shoulder and elbow with muscles, pushed from outside.
struct Pushed {
  static constexpr double duration = 0.4;
  Pushed() : c(duration, {"elbow_flexion", "shoulder_elv"}) {}
  static Vector2d push(double t) { return {2 * std::sin(8 * t), 3 - 5 * t}; }
  // What muscles and gravity do with this push.
  SimulationOptions options(double step) const {
    SimulationOptions o;
    o.duration = duration;
    o.step = step;
    std::vector<double> times;
    for (int k = 0; k <= 400; ++k) times.push_back(duration * k / 400.0);
    MatrixXd values(401, 2);
    for (Index k = 0; k <= 400; ++k)
      values.row(k) = push(times[static_cast<std::size_t>(k)]).transpose();
    o.externalForce = {times, values};
    return o;
  }
  Trajectory moved(double step) const {
    return simulate(c.system, c.excitation, c.start, options(step));
  }
  Trajectory kept(const Trajectory& motion, SimulationOptions o) const {
    return inverseDynamics({c.model, c.options}, c.excitation, motion.time, motion.q, std::move(o));
  }

  ArmOfSeven c;
};

// A simulation turned round: what is left out of the forces is what keeps its motion, and the
// fibres are those of the simulation. Of second order between the kinks of q̈, where a fibre turns,
// of first order there and at both ends.
TEST(InverseDynamics, FindTheForceThatMadeAMotion) {
  const Pushed pushed;
  std::vector<double> errors;
  for (const double step : {0.004, 0.002, 0.001}) {
    const Trajectory motion = pushed.moved(step);
    ASSERT_EQ(motion.outcome, Outcome::completed) << motion.why;
    SimulationOptions without;
    without.step = step;
    const Trajectory kept = pushed.kept(motion, without);
    ASSERT_EQ(kept.reaction.cols(), motion.q.cols());
    EXPECT_LT((kept.fibreLength - motion.fibreLength).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_LT((kept.q - motion.q).cwiseAbs().maxCoeff(), 1e-14);
    errors.push_back(0);
    for (Index k = 0; k < motion.q.cols(); ++k) {
      const double t = motion.time[static_cast<std::size_t>(k)];
      const double e = (kept.reaction.col(k) - Pushed::push(t)).cwiseAbs().maxCoeff();
      EXPECT_LT(e, 10 * step) << t;
      if (k % std::lround(0.04 / step) == 0 && t > 0.1 && t < 0.35)
        errors.back() = std::max(errors.back(), e);
    }
  }
  std::printf("  errors %.3g %.3g %.3g N m\n", errors[0], errors[1], errors[2]);
  EXPECT_LT(errors[2], 0.002);
  EXPECT_NEAR(std::log2(errors[0] / errors[2]) / 2, 2.0, 0.3);
}

TEST(InverseDynamics, CountTheExternalForceAsTheSystems) {
  const Pushed pushed;
  const Trajectory motion = pushed.moved(0.001);
  const Trajectory kept = pushed.kept(motion, pushed.options(0.001));
  EXPECT_LT(kept.reaction.cwiseAbs().maxCoeff(), 0.02);
}

TEST(InverseDynamics, RefuseAMotionThatDoesNotFit) {
  const Chain chain;
  const ExcitationSignal none({0, 1}, MatrixXd(2, 0));
  const auto refuses = [&](const std::vector<double>& times, const MatrixXd& q, const char* why) {
    support::throwsSaying([&] { inverseDynamics(chain.system(), none, times, q); }, why);
  };
  refuses({0, 1}, MatrixXd::Zero(1, 2), "must be 2 × the number of times");
  refuses({0, 1}, MatrixXd::Zero(2, 3), "must be 2 × the number of times");
  refuses({0}, MatrixXd::Zero(2, 1), "at least 2");
  refuses({0, 0}, MatrixXd::Zero(2, 2), "times must rise");
  refuses({0, 1}, MatrixXd::Constant(2, 2, NAN), "must be finite");
}

}  // namespace
}  // namespace bio
