#include <gtest/gtest.h>

#include <cmath>

#include "bio/simulation/simulate.h"
#include "libbio/simulation/arm_of_seven.h"
#include "libbio/simulation/jacobian_check.h"
#include "simulation/system_dynamics.h"
#include "support/allocations.h"

namespace bio {
namespace {

using fixtures::ArmOfSeven;

SimulationOptions stepsOf(Integrator integrator, double step, double duration) {
  SimulationOptions o;
  o.integrator = integrator;
  o.step = step;
  o.duration = duration;
  return o;
}

Trajectory played(const ArmOfSeven& c, const SimulationOptions& o) {
  Trajectory motion = simulate(c.system, c.excitation, c.start, o);
  EXPECT_EQ(motion.outcome, Outcome::completed) << motion.why;
  return motion;
}

Trajectory tightCvode(const ArmOfSeven& c, double rows, double duration) {
  SimulationOptions o = stepsOf(Integrator::cvode, rows, duration);
  o.relativeTolerance = 1e-11;
  o.absoluteTolerance = 1e-13;
  return played(c, o);
}

/// Largest distance at the rows of b, which has fewer.
double apart(const Trajectory& a, const Trajectory& b) {
  const auto every = (a.q.cols() - 1) / (b.q.cols() - 1);
  double largest = 0;
  for (Eigen::Index k = 0; k < b.q.cols(); ++k) {
    largest = std::max(largest, (a.q.col(k * every) - b.q.col(k)).cwiseAbs().maxCoeff());
  }
  return largest;
}

TEST(ManyCoordinates, IntegratorsAgreeOnAnArmOfSeven) {
  const ArmOfSeven c;
  const Trajectory reference = tightCvode(c, 0.05, 1);
  const Eigen::VectorXd range = reference.q.rowwise().maxCoeff() - reference.q.rowwise().minCoeff();
  EXPECT_GT(range[0], 0.3);           // the elbow moves,
  EXPECT_GT(range.minCoeff(), 0.01);  // and so does everything else
  EXPECT_LT(apart(played(c, stepsOf(Integrator::rungeKutta4, 1e-4, 1)), reference), 1e-5);
  EXPECT_LT(apart(played(c, stepsOf(Integrator::variational, 1e-3, 1)), reference), 1e-4);
}

// Where some of a function's coordinates are locked, too.
TEST(ManyCoordinates, IntegratorsAgreeOverLengthFunctions) {
  const Model model = ArmOfSeven::modelWithFunctions();
  ASSERT_TRUE(findMuscle(model, "BRD").path.function);
  ASSERT_TRUE(findMuscle(model, "BIClong").path.function);
  for (const auto& free : {ArmOfSeven::coordinates(), std::vector<std::string>{"elbow_flexion"},
                           std::vector<std::string>{"elbow_flexion", "pro_sup"}}) {
    const ArmOfSeven c(0.3, free, false, model);
    const Trajectory reference = tightCvode(c, 0.05, 0.3);
    // fibres meet corners of their curves between the ends of steps
    EXPECT_LT(apart(played(c, stepsOf(Integrator::rungeKutta4, 1e-4, 0.3)), reference), 5e-6);
    EXPECT_LT(apart(played(c, stepsOf(Integrator::variational, 1e-3, 0.3)), reference), 1e-4);
    EXPECT_LT(energyError(c.system, played(c, stepsOf(Integrator::rungeKutta4, 1e-4, 0.3))), 1e-6);
    const ArmOfSeven byPoints(0.3, free);
    EXPECT_LT(apart(tightCvode(byPoints, 0.05, 0.3), reference), 0.05);
  }
}

/// The five muscles with which this motion is smooth: with biceps or anconeus, too, it meets
/// corners between the ends of steps, and the errors are no clean power of the step.
Model smoothlyMoved() {
  Model model = ArmOfSeven::heldModel();
  for (Muscle& muscle : model.muscles) {
    muscle.enabled = !muscle.name.starts_with("BIC") && muscle.name != "ANC";
  }
  return model;
}

double rootMeanSquare(const Trajectory& a, const Trajectory& b) {
  const auto every = (a.q.cols() - 1) / (b.q.cols() - 1);
  double sum = 0;
  for (Eigen::Index k = 0; k < b.q.cols(); ++k) {
    sum += (a.q.col(k * every) - b.q.col(k)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(b.q.size()));
}

TEST(ManyCoordinates, TheVariationalSchemeIsOfSecondOrder) {
  const ArmOfSeven c(1, ArmOfSeven::coordinates(), false, smoothlyMoved());
  const Trajectory reference = tightCvode(c, 0.05, 1);
  std::vector<double> errors;
  for (const double step : {0.005, 0.0025, 0.00125}) {
    errors.push_back(
        rootMeanSquare(played(c, stepsOf(Integrator::variational, step, 1)), reference));
  }
  std::printf("  errors %.3g, %.3g, %.3g rad\n", errors[0], errors[1], errors[2]);
  EXPECT_NEAR(std::log2(errors[0] / errors[2]) / 2, 2.0, 0.1);
}

TEST(ManyCoordinates, EnergyErrorFallsWithTheSquareOfTheStep) {
  const ArmOfSeven c;
  const auto error = [&](Integrator integrator, double step) {
    return energyError(c.system, played(c, stepsOf(integrator, step, 1)));
  };
  EXPECT_LT(error(Integrator::rungeKutta4, 1e-4), 1e-6);
  const double coarse = error(Integrator::variational, 0.005);
  const double fine = error(Integrator::variational, 0.00125);
  std::printf("  energy error %.3g, %.3g\n", coarse, fine);
  EXPECT_NEAR(std::log2(coarse / fine) / 2, 2.0, 0.2);
}

TEST(ManyCoordinates, JacobianMatchesCentralDifferences) {
  const ArmOfSeven c;
  stepping::SystemDynamics<Eigen::Dynamic> dynamics(c.system, c.excitation);
  Eigen::VectorXd y = dynamics.pack(c.start);
  const auto n = static_cast<Eigen::Index>(c.system.numMuscles());
  y.segment(7, 7) << 1.3, -0.4, 0.8, -0.6, 1.1, 0.7, -0.9;
  y.tail(n) *= 1.001;  // away from the kink at fibre speed 0
  fixtures::expectJacobianOfDifferences(dynamics, 0.533, y);
}

TEST(ManyCoordinates, NothingIsAllocatedInAStep) {
  const ArmOfSeven c;
  for (const Integrator integrator :
       {Integrator::variational, Integrator::variationalLeft, Integrator::rungeKutta4}) {
    const double step = integrator == Integrator::rungeKutta4 ? 1e-4 : 0.005;
    const auto count = [&](double duration) {
      const long before = support::allocations();
      played(c, stepsOf(integrator, step, duration));
      return support::allocations() - before;
    };
    count(0.1);
    EXPECT_EQ(count(0.2), count(0.9));
  }
}

// Two ways of the same skeleton and paths: code of fixed size, and the tree.
TEST(ManyCoordinates, OneAsATreeMovesAsItDoesWithout) {
  const std::vector<std::string> free{ArmOfSeven::coordinates().front()};
  const ArmOfSeven fixed(1, free), tree(1, free, true);
  ASSERT_FALSE(fixed.system.tree());
  ASSERT_TRUE(tree.system.tree());
  for (const Integrator integrator :
       {Integrator::variational, Integrator::variationalLeft, Integrator::rungeKutta4}) {
    const SimulationOptions o =
        stepsOf(integrator, integrator == Integrator::rungeKutta4 ? 2e-4 : 0.005, 0.5);
    EXPECT_LT(apart(played(fixed, o), played(tree, o)), 1e-10);
  }
  EXPECT_LT(apart(tightCvode(fixed, 0.05, 0.5), tightCvode(tree, 0.05, 0.5)), 1e-8);
}

// Two to four: the tree's lengths and energies against code of fixed size.
template <int N>
void expectKernelsAgree() {
  const std::vector<std::string> all = ArmOfSeven::coordinates();
  const ArmOfSeven c(1, {all.begin(), all.begin() + N});
  ASSERT_TRUE(c.system.tree());
  SystemConfiguration<N> fixed(c.system);
  SystemConfiguration<Eigen::Dynamic> tree(c.system);
  const Eigen::VectorXd from = c.start.q;
  for (int k = 0; k < 5; ++k) {
    const Eigen::VectorXd q = from + 0.1 * k * Eigen::VectorXd::LinSpaced(N, -1, 2);
    const Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(N, 3, -1 - k);
    fixed.moveTo(q);
    tree.moveTo(q);
    const auto& a = fixed.energy(v);
    const auto& b = tree.energy(v);
    EXPECT_LT((a.T_vv - b.T_vv).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LT((a.T_q - b.T_q).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((a.T_vq - b.T_vq).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((a.T_qq - b.T_qq).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_LT((a.V_q - b.V_q).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((a.V_qq - b.V_qq).cwiseAbs().maxCoeff(), 1e-12);
    for (std::size_t i = 0; i < c.system.numMuscles(); ++i) {
      EXPECT_NEAR(fixed.length(i).length, tree.length(i).length, 1e-14);
      EXPECT_LT((fixed.length(i).dL_dq - tree.length(i).dL_dq).cwiseAbs().maxCoeff(), 1e-13);
      for (int r = 0; r < N; ++r) {
        for (int s = 0; s < N; ++s) {
          EXPECT_NEAR(fixed.length(i).d2L_dq2(r, s), tree.length(i).secondIn(r, s), 1e-11);
        }
      }
    }
  }
}

TEST(ManyCoordinates, TwoToFourHaveTheKernelsOfCodeOfFixedSize) {
  expectKernelsAgree<2>();
  expectKernelsAgree<3>();
  expectKernelsAgree<4>();
}

}  // namespace
}  // namespace bio
