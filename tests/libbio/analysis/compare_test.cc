#include "bio/analysis/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "bio/analysis/coordinate_curve.h"
#include "bio/tables/file_error.h"
#include "support/elbow_model.h"
#include "support/numbers.h"
#include "support/scratch_folder.h"

namespace bio {
namespace {

using ::testing::HasSubstr;

using support::degree;

/// The shipped elbow lifting for a second, excitations every 10 ms.
struct Lift {
  MusculoskeletalSystem system{fixtures::elbowModel(), {{{"elbow_flexion"}, {}}, {}, {}}};
  ExcitationSignal excitation = signal();
  SystemState start = initialState(system, Eigen::VectorXd::Constant(1, 0.7), excitation, 0);

  ExcitationSignal signal() const {
    std::vector<double> times;
    for (int k = 0; k <= 100; ++k) times.push_back(0.01 * k);
    Eigen::MatrixXd u(101, static_cast<Eigen::Index>(system.numMuscles()));
    for (Eigen::Index k = 0; k < u.rows(); ++k) {
      for (Eigen::Index i = 0; i < u.cols(); ++i) {
        const double wave = std::sin(std::numbers::pi * 0.01 * static_cast<double>(k));
        const bool flexor = system.muscles()[static_cast<std::size_t>(i)].name.starts_with("B");
        u(k, i) = 0.03 + (flexor ? 0.2 : 0.05) * wave * wave;
      }
    }
    return {times, u};
  }
};

CompareOptions quickComparison() {
  CompareOptions options;
  options.duration = 1;
  options.steps = {0.0002, 0.003, 0.01};
  options.timings = 1;
  options.stepResolution = 1.1;
  return options;
}

const CompareCell& cellOf(const Comparison& comparison, Integrator integrator, double step) {
  return *std::find_if(comparison.cells.begin(), comparison.cells.end(), [&](const auto& cell) {
    return cell.integrator == integrator && cell.step == step;
  });
}

/// One comparison for every test that looks at it.
const Comparison& comparison() {
  static const Comparison result = [] {
    const Lift lift;
    return compareIntegrators(lift.system, lift.excitation, lift.start, quickComparison());
  }();
  return result;
}

TEST(Compare, TheReferenceIsConverged) {
  const ConvergedReference& reference = comparison().reference;
  ASSERT_TRUE(reference.completed());
  EXPECT_DOUBLE_EQ(reference.relativeTolerance * 10, reference.looserTolerance);
  EXPECT_GT(reference.problem.rms, 0);
  EXPECT_GE(reference.problem.largest, reference.problem.rms);
  EXPECT_LT(reference.floor(), 1e-6 * degree);  // shipped trials: at most 9.3e-8 deg
}

TEST(Compare, EveryIntegratorIsRunAtEveryStepInOrder) {
  const auto& cells = comparison().cells;
  ASSERT_EQ(cells.size(), 12u);
  const CompareOptions options = quickComparison();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    EXPECT_EQ(cells[i].integrator, options.integrators[i / 3]);
    EXPECT_EQ(cells[i].step, options.steps[i % 3]);
  }
}

TEST(Compare, ErrorsAndCostsAreThoseOfTheRun) {
  const Lift lift;
  const CompareCell& cell = cellOf(comparison(), Integrator::variational, 0.01);
  SimulationOptions alone;
  alone.duration = 1;
  alone.step = 0.01;
  const Trajectory motion = simulate(lift.system, lift.excitation, lift.start, alone);
  ASSERT_EQ(cell.outcome, Outcome::completed);
  EXPECT_TRUE(std::isnan(cell.failedAt));
  EXPECT_EQ(cell.energyError, energyError(lift.system, motion));
  EXPECT_EQ(cell.newtonPerStep, static_cast<double>(motion.newtonIterations) / 100);
  EXPECT_GT(cell.wallSeconds, 0);
  // a second way to the error: CVODE with its output at the rows themselves
  alone.integrator = Integrator::cvode;
  const Trajectory reference = simulate(lift.system, lift.excitation, lift.start, alone);
  const Eigen::RowVectorXd difference = motion.q.row(0) - reference.q.row(0);
  const double rms = std::sqrt(difference.squaredNorm() / static_cast<double>(difference.size()));
  EXPECT_NEAR(cell.error.rms, rms, 1e-4 * rms);
  EXPECT_NEAR(cell.error.largest, difference.cwiseAbs().maxCoeff(), 1e-4 * rms);
  EXPECT_LT(cell.error.rms, 0.1 * degree);
}

TEST(Compare, AFailedRunSaysWhenAndWhyAndHasNoError) {
  for (const double step : {0.003, 0.01}) {
    const CompareCell& cell = cellOf(comparison(), Integrator::rungeKutta4, step);
    EXPECT_TRUE(cell.outcome == Outcome::unstable);
    EXPECT_GE(cell.failedAt, 0);
    EXPECT_LT(cell.failedAt, 1);
    EXPECT_THAT(cell.why, HasSubstr("unstable at t ="));
    const bool stopped = cell.time.back() < 1 - 1e-9;
    EXPECT_EQ(std::isnan(cell.error.rms), stopped);
    EXPECT_EQ(std::isnan(cell.energyError), stopped);
    EXPECT_EQ(std::isnan(cell.wallSeconds), stopped);
    if (!stopped) {
      EXPECT_GT(cell.error.rms, quickComparison().usefulError);
    }
  }
}

TEST(Compare, TheVariationalIntegratorIsStableWhereRungeKuttaIsNot) {
  ASSERT_EQ(comparison().limits.size(), 3u);
  const StepLimit& explicitly = comparison().limits[0];
  const StepLimit& variational = comparison().limits[1];
  EXPECT_EQ(explicitly.integrator, Integrator::rungeKutta4);
  EXPECT_EQ(variational.integrator, Integrator::variational);
  EXPECT_LT(explicitly.stable, 0.003);
  EXPECT_GT(explicitly.stable, 0.0002);
  EXPECT_GE(variational.stable, 0.01);
  EXPECT_LE(explicitly.failing / explicitly.stable, 1.1);
  EXPECT_FALSE(explicitly.why.empty());
}

TEST(Compare, TheLimitIsWhereTheAnswerChanges) {
  const Lift lift;
  const StepLimit& limit = comparison().limits[2];  // vi-left: exact error, no failure
  ASSERT_TRUE(limit.failing > limit.stable);
  const auto rms = [&](double step) {
    SimulationOptions alone;
    alone.integrator = Integrator::variationalLeft;
    alone.duration = 1;
    alone.step = step;
    return sd(lift.system, simulate(lift.system, lift.excitation, lift.start, alone),
              comparison().reference.motion)
        .rms;
  };
  EXPECT_LT(rms(limit.stable), quickComparison().usefulError);
  EXPECT_GE(rms(limit.failing), quickComparison().usefulError);
  EXPECT_THAT(limit.why, HasSubstr("deg"));
}

TEST(Compare, ObservedOrdersAreTwoAndOne) {
  ASSERT_EQ(comparison().orders.size(), 3u);
  EXPECT_NEAR(comparison().orders[1].order, 2.0, 0.15);
  EXPECT_NEAR(comparison().orders[2].order, 1.0, 0.15);
  EXPECT_GE(comparison().orders[1].steps.size(), 3u);
}

TEST(Compare, TheOrderIsTheSlopeAboveTheFloor) {
  const std::vector<double> steps = {0.001, 0.002, 0.004, 0.008};
  std::vector<double> errors;
  for (const double step : steps) errors.push_back(7 * std::pow(step, 3));
  EXPECT_NEAR(fitOrder(steps, errors, 0).order, 3, 1e-12);
  // the finest is spoilt and below ten floors: it is left out
  errors[0] = 5e-8;
  const ObservedOrder order = fitOrder(steps, errors, 5.1e-9);
  EXPECT_NEAR(order.order, 3, 1e-12);
  EXPECT_EQ(order.steps, (std::vector<double>{0.002, 0.004, 0.008}));
  // an error just above it counts
  EXPECT_EQ(fitOrder(steps, errors, 4.9e-9).steps.size(), 4u);
  EXPECT_TRUE(std::isnan(fitOrder({0.1, 0.2}, {1, 2}, 0).order));
  EXPECT_THROW(fitOrder({0.1, 0.2}, {1}, 0), std::invalid_argument);
  EXPECT_THROW(fitOrder({0, 0.2}, {1, 2}, 0), std::invalid_argument);
  EXPECT_THROW(fitOrder({std::nan(""), 0.2}, {1, 2}, 0), std::invalid_argument);
}

TEST(Compare, DeviationOfAShiftedMotionIsTheShift) {
  const Lift lift;
  const Trajectory& reference = comparison().reference.motion;
  Trajectory shifted = reference;
  shifted.q.array() += 0.1;
  shifted.q(0, 200) += 0.2;
  const Deviation result = sd(lift.system, shifted, reference);
  const auto n = static_cast<double>(reference.time.size());
  EXPECT_NEAR(result.rms, std::sqrt(((n - 1) * 0.01 + 0.09) / n), 1e-12);
  EXPECT_NEAR(result.largest, 0.3, 1e-12);
  EXPECT_EQ(result.largestAt, reference.time[200]);
  shifted.time.assign(shifted.time.size(), 5.0);
  EXPECT_THROW(sd(lift.system, shifted, reference), std::invalid_argument);
}

TEST(Compare, BrokenRulesAreNamed) {
  const Lift lift;
  const auto fails = [&](auto&& change, const std::string& message) {
    CompareOptions options = quickComparison();
    change(options);
    try {
      compareIntegrators(lift.system, lift.excitation, lift.start, options);
      ADD_FAILURE() << message;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr(message));
    }
  };
  fails([](auto& o) { o.integrators.clear(); }, "integrators: the list is empty");
  fails([](auto& o) { o.integrators.push_back(o.integrators[0]); }, "listed twice");
  fails([](auto& o) { o.steps.clear(); }, "steps: the list is empty");
  fails([](auto& o) { o.steps = {-0.01}; }, "steps: -0.01 s, must be > 0");
  fails([](auto& o) { o.steps = {std::nan("")}; }, "must be > 0");
  fails([](auto& o) { o.steps = {0.02, 0.01}; }, "steps: 0.01 s after 0.02 s, must rise");
  fails([](auto& o) { o.steps = {0.01, 0.01}; }, "must rise");
  fails([](auto& o) { o.steps = {2}; }, "must not exceed the duration");
  fails([](auto& o) { o.timings = 0; }, "timings");
  fails([](auto& o) { o.usefulError = std::nan(""); }, "useful error");
  fails([](auto& o) { o.stepResolution = 1; }, "step resolution");
}

TEST(CoordinateCurve, IsReadFromTheColumnsOfOpenSimAndOthers) {
  const ::support::ScratchFolder scratch;
  Coordinate elbow;
  elbow.name = "elbow_flexion";
  elbow.isRotation = true;
  const auto second = [&](const std::string& name, const std::string& content) {
    return readCoordinate(scratch.file(name, content), elbow).value[1];
  };
  const std::string path = "/jointset/elbow/elbow_flexion/value";
  const std::string header = "states\nversion=1\nnRows=2\nnColumns=2\ninDegrees=";
  EXPECT_EQ(second("a.sto", header + "no\nendheader\ntime\t" + path + "\n0\t0.5\n1\t0.7\n"), 0.7);
  EXPECT_NEAR(second("b.sto", header + "yes\nendheader\ntime\t" + path + "\n0\t5\n1\t90\n"),
              std::numbers::pi / 2, 1e-15);
  EXPECT_NEAR(second("c.csv", "time,elbow_flexion_deg\n0,5\n1,180\n"), std::numbers::pi, 1e-15);
  EXPECT_EQ(second("d.csv", "time,elbow_flexion\n0,5\n1,0.3\n"), 0.3);
  EXPECT_EQ(second("g.csv", "time_s,elbow_flexion_rad,elbow_flexion_speed_rad_s\n0,5,1\n1,0.2,2\n"),
            0.2);
  // OpenSim 3.3: states in radians, and what its analyses print, in degrees
  EXPECT_EQ(
      second("h.sto", header + "no\nendheader\ntime\telbow/elbow_flexion/value\n0\t5\n1\t0.4\n"),
      0.4);
  EXPECT_NEAR(
      second("i.sto",
             "Coordinates\nversion=1\nnRows=2\nnColumns=3\ninDegrees=yes\n\nUnits are S.I. "
             "units (second, meters, Newtons, ...)\nIf the header above contains a line with "
             "'inDegrees', this indicates whether rotational values are in degrees (yes) or "
             "radians (no).\n\nendheader\ntime\tpro_sup\telbow_flexion\n 0.0\t 1.0\t 2.0\n "
             "1.0\t 1.0\t 45.0\n"),
      std::numbers::pi / 4, 1e-15);
  EXPECT_EQ(second("j.sto", header + "yes\nendheader\ntime\telbow_flexion_rad\n0\t5\n1\t0.4\n"),
            0.4);
  EXPECT_THROW(second("e.csv", "time,/jointset/elbow/elbow_flexion/speed\n0,5\n1,0\n"), FileError);
  EXPECT_THROW(second("f.csv", "time,elbow_flexion,elbow_flexion_deg\n0,5,0\n1,0,0\n"), FileError);
}

TEST(CoordinateCurve, DiffersFromAMotionByWhatIsAddedToIt) {
  const Lift lift;
  const Trajectory& motion = comparison().reference.motion;
  CoordinateCurve curve;
  for (std::size_t k = 0; k < motion.time.size(); k += 20) {
    curve.time.push_back(motion.time[k]);
    curve.value.push_back(motion.q(0, static_cast<Eigen::Index>(k)) - 0.05);
  }
  curve.value[3] = std::nan("");
  EXPECT_NEAR(rmsDifference(lift.system, curve, motion, "elbow_flexion"), 0.05, 1e-12);
  EXPECT_THROW(rmsDifference(lift.system, curve, motion, "knee"), std::invalid_argument);
}

}  // namespace
}  // namespace bio
