#include "bio/design/experiment_design.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numbers>

#include "info/design/design_search.h"
#include "support/numbers.h"
#include "support/scratch_folder.h"
#include "support/shipped_elbow.h"

namespace bio {
namespace {

using fixtures::ShippedElbow;

using support::degree;

/// The first second of a shipped trial, little of everything.
struct Short {
  ShippedElbow elbow;
  SimulationOptions simulation;
  DesignQuestion question;
  DesignLimits limits;
  std::vector<MuscleGroup> groups;

  Short() {
    simulation.duration = 2;  // within the first second of the trial triceps does not wrap
    question.parameters = {elbow.catalogue.find("TRI.radius")};
    question.observed = {{ofCoordinate("elbow_flexion"), 0.5 * degree}};
    limits.coordinates = {{"elbow_flexion", 0, 130 * degree}};
  }
  ExperimentDesign design() const {
    return {elbow.system, elbow.catalogue, elbow.catalogue.nominal(),
            elbow.trial,  simulation,      question,
            limits,       groups,          0.2};
  }
};

DesignSearchSettings quickSearch() {
  DesignSearchSettings settings;
  settings.candidates = 10;
  settings.generations = 4;
  settings.iterations = 1;
  return settings;
}

TEST(ExperimentDesign, LowersTheBoundAndKeepsEveryLimit) {
  Short s;
  s.groups = flexorsAndExtensors(s.elbow.system, s.elbow.catalogue.nominal().start.q);
  ASSERT_EQ(s.groups.size(), 2u);
  const ExperimentDesign design = s.design();
  const DesignResult result = design.search(quickSearch());
  ASSERT_TRUE(result.improved);
  ASSERT_TRUE(std::isfinite(result.before.bound[0]));
  EXPECT_LT(result.after.bound[0], 0.7 * result.before.bound[0]);
  // the tables themselves, not what the search believes
  const Table table = plannedTable(s.elbow.system, result.after.trial);
  const auto column = [&](const std::string& name) -> Eigen::VectorXd {
    return table.values.col(columnIndex(table, name));
  };
  const Eigen::VectorXd t = column("time"), torque = column("elbow_flexion.torque");
  EXPECT_EQ(torque[0], 0);
  EXPECT_LE(torque.cwiseAbs().maxCoeff(), s.limits.coordinates[0].torque);
  for (Eigen::Index k = 1; k < t.size(); ++k) {
    EXPECT_LE(std::abs(torque[k] - torque[k - 1]),
              s.limits.torqueRate * (t[k] - t[k - 1]) * (1 + 1e-9) + 1e-12);
    for (const char* name : {"BRA", "TRIlong"}) {
      const Eigen::VectorXd u = column(name);
      EXPECT_LE(std::abs(u[k] - u[k - 1]),
                s.limits.excitationRate * (t[k] - t[k - 1]) * (1 + 1e-9) + 1e-12);
      EXPECT_LE(u[k], s.limits.largestExcitation);
    }
  }
  EXPECT_EQ(column("BRA"), column("BIClong"));
  ASSERT_EQ(result.after.ranges.size(), 1u);
  EXPECT_GE(result.after.ranges[0].lowest, s.limits.coordinates[0].lower);
  EXPECT_LE(result.after.ranges[0].highest, s.limits.coordinates[0].upper);
}

// Same seed, same bits, whatever the threads.
TEST(ExperimentDesign, IsTheSameWithAnyNumberOfThreads) {
  const Short s;
  const ExperimentDesign design = s.design();
  DesignSearchSettings settings = quickSearch();
  settings.threads = 1;
  const DesignResult one = design.search(settings);
  settings.threads = 3;
  const DesignResult three = design.search(settings);
  EXPECT_EQ(one.after.inputs, three.after.inputs);
  settings.seed = 2;
  EXPECT_NE(one.after.inputs, design.search(settings).after.inputs);
}

TEST(ExperimentDesign, WhatIsWrittenPlaysThePredictedMotion) {
  const Short s;
  const ExperimentDesign design = s.design();
  const DesignResult result = design.search(quickSearch());
  ASSERT_TRUE(result.improved);
  const support::ScratchFolder scratch;
  const auto file = scratch.path() / "design.sto";
  writeTable(plannedTable(s.elbow.system, result.after.trial), file);
  const Trial trial = readTrial(file, s.elbow.model);
  ASSERT_EQ(trial.applied.size(), 1u);
  SimulationOptions options = s.simulation;
  options.externalForce = externalForceOf(trial, s.elbow.system);
  const ExcitationSignal excitation = excitationOf(trial, s.elbow.system);
  const Trajectory motion = simulate(
      s.elbow.system, excitation,
      initialState(s.elbow.system, startCoordinates(trial, s.elbow.system, {}), excitation, 0),
      options);
  EXPECT_LT((motion.q - result.after.motion.q.leftCols(motion.q.cols())).cwiseAbs().maxCoeff(),
            1e-9);
  ASSERT_EQ(trial.measured.size(), 1u);
  EXPECT_LT(compareWithMeasured(s.elbow.system, motion, trial.measured[0]).largest, 1e-9);
}

TEST(ExperimentDesign, BoundIsThatOfTheInformationWithPriors) {
  Short s;
  s.question.nuisance = {s.elbow.catalogue.find("hand.mass"),
                         s.elbow.catalogue.find("BRA.max_isometric_force")};
  s.question.priorSd = Eigen::Vector3d(std::numeric_limits<double>::infinity(), 0.05, 100);
  const DesignedExperiment e = s.design().before();
  Eigen::MatrixXd information =
      e.gamma.transpose() * e.gamma / std::pow(s.question.observed[0].sd, 2);
  information(1, 1) += 1 / (0.05 * 0.05);
  information(2, 2) += 1e-4;
  const Eigen::MatrixXd bound = information.inverse();
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(e.bound[i] / std::sqrt(bound(i, i)), 1, 1e-6) << i;
  }
  // knowing the nuisance parameters can only help
  Short alone;
  EXPECT_LT(alone.design().before().bound[0], e.bound[0]);
}

// The chain from I to φ, the nuisance parameters eliminated, against differences.
TEST(ExperimentDesign, CostFollowsItsGradient) {
  for (const auto which : {info::Optimality::a, info::Optimality::d, info::Optimality::e}) {
    Short s;
    s.question.parameters = s.elbow.catalogue.select({"TRI.radius", "BRD.max_isometric_force"});
    s.question.nuisance = s.elbow.catalogue.select({"hand.mass"});
    s.question.criterion = which;
    const ExperimentDesign design = s.design();
    Eigen::Matrix3d I;
    I << 40, 3, 5, 3, 20, -4, 5, -4, 10;
    const info::InformationCost at = design.cost(I, 1e-9);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j <= i; ++j) {
        Eigen::Matrix3d change = Eigen::Matrix3d::Zero();
        change(i, j) = change(j, i) = 1e-5;
        const double difference =
            (design.cost(I + change, 1e-9).value - design.cost(I - change, 1e-9).value) / 2;
        EXPECT_NEAR(at.dvalue_dI.cwiseProduct(change).sum(), difference, 1e-10) << i << j;
      }
    }
  }
}

TEST(ExperimentDesign, StopsWhenAskedAndKeepsTheBest) {
  const Short s;
  DesignSearchSettings settings = quickSearch();
  std::atomic<int> asked{0};
  settings.progress = [&](double done) {
    EXPECT_GE(done, 0);
    EXPECT_LE(done, 1);
    return ++asked < 30;
  };
  const DesignResult result = s.design().search(settings);
  EXPECT_TRUE(result.stopped);
  EXPECT_LE(result.runs, 34);
  EXPECT_LE(result.after.bound[0], result.before.bound[0]);
}

TEST(ExperimentDesign, RefusesWhatCannotBeMeant) {
  const auto refused = [](const std::function<void(Short&)>& change) {
    Short s;
    change(s);
    EXPECT_THROW(s.design(), std::invalid_argument);
  };
  refused([](Short& s) { s.question.observed[0].sd = 0; });
  refused([](Short& s) { s.question.observed[0].sd = std::nan(""); });
  refused([](Short& s) { s.question.period = 3; });
  refused([](Short& s) { s.question.observed[0].what.object = "pro_sup"; });
  refused([](Short& s) { s.question.observed.clear(); });
  refused([](Short& s) { s.question.observed.push_back(s.question.observed[0]); });
  refused([](Short& s) { s.limits.coordinates[0].coordinate = "pro_sup"; });
  refused([](Short& s) { s.limits.coordinates.push_back(s.limits.coordinates[0]); });
  refused([](Short& s) { s.question.parameters.clear(); });
  refused([](Short& s) { s.question.nuisance = s.question.parameters; });
  refused([](Short& s) { s.limits.coordinates[0].torque = 0; });
  refused([](Short& s) { s.limits.coordinates[0].torque = -1; });
  refused([](Short& s) { s.limits.torqueRate = 0; });
  refused([](Short& s) { s.limits.coordinates[0].upper = s.limits.coordinates[0].lower; });
  refused([](Short& s) { s.limits.coordinates[0].speed = 0; });
  refused([](Short& s) { s.groups = {{"one", {"GLUTmax"}}}; });
  refused([](Short& s) { s.groups = {{"one", {"BRA"}}, {"two", {"BRA"}}}; });
  refused([](Short& s) { s.question.criterion = info::Optimality::conditionNumber; });
}

}  // namespace
}  // namespace bio
