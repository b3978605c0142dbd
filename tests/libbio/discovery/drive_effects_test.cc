// Effects of drives on a pendulum without muscles that a motor moves.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "bio/discovery/repaired.h"
#include "bio/discovery/workflow.h"
#include "bio/tables/trial_table.h"
#include "info/discovery/discover.h"
#include "info/discovery/likelihood/hypothesis.h"
#include "libbio/discovery/driven_swing.h"
#include "libbio/discovery/effect_cases.h"

namespace bio::discover {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr const char* driveIds[] = {"drive_gain", "drive_delay", "drive_lag", "drive_saturation"};

const info::discover::Candidate& driveCandidate(const MusculoskeletalProblem& data,
                                                const std::string& id) {
  for (const auto& one : data.candidates())
    if (one.id == id) return one;
  throw std::invalid_argument("no candidate " + id);
}

struct DrivenCase {
  explicit DrivenCase(std::vector<Trial> trials, double optimalForce = 0)
      : model(drivenPendulum()) {
    if (optimalForce != 0) model.actuators.push_back({"motor", "swing", optimalForce, true});
    MusculoskeletalProblemOptions options;
    options.simulation.step = 0.005;
    options.simulation.newtonTolerance = 1e-12;
    data = std::make_unique<MusculoskeletalProblem>(model, drivenOptions(), "swing",
                                                    std::move(trials), options);
    values = info::discover::nominalValues(*data);
  }
  void put(const std::string& id, std::vector<double> numbers) {
    const auto& quantities = driveCandidate(*data, id).quantities;
    ASSERT_EQ(quantities.size(), numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i)
      values[static_cast<Index>(quantities[i])] = numbers[i];
  }
  double error(const std::string& id) const {
    const auto& quantities = driveCandidate(*data, id).quantities;
    const auto at = data->predict(0, values, {}, quantities, false);
    double worst = 0;
    for (std::size_t i = 0; i < quantities.size(); ++i)
      worst = std::max(worst, effect_cases::problem(
                                  at.gamma.col(static_cast<Index>(i)),
                                  [&](double step) {
                                    VectorXd moved = values;
                                    moved[static_cast<Index>(quantities[i])] += step;
                                    return data->outputs(0, moved, {});
                                  },
                                  data->quantities()[quantities[i]].sd));
    return worst;
  }

  Model model;
  std::unique_ptr<MusculoskeletalProblem> data;
  VectorXd values;
};

std::vector<std::string> offeredIds(const MusculoskeletalProblem& data) {
  std::vector<std::string> ids;
  for (const auto& one : data.candidates()) ids.push_back(one.id);
  return ids;
}

// Commands 1, 2, 4, 4 at 0, 1, 2, 3 s.
TEST(DriveLaw, ShapesACommand) {
  const VectorXd times = VectorXd::LinSpaced(4, 0, 3), command = Eigen::Vector4d(1, 2, 4, 4);
  const DrivenCourse same = drivenCourse(times, command, {});
  EXPECT_EQ(same.times, (std::vector<double>{0, 1, 2, 3}));
  EXPECT_EQ(same.values, command);
  const DrivenCourse late = drivenCourse(times, command, {.delay = 0.5});
  EXPECT_EQ(late.times, (std::vector<double>{0, 0.5, 1.5, 2.5, 3}));
  EXPECT_EQ(late.values, (VectorXd(5) << 1, 1, 2, 4, 4).finished());
  EXPECT_EQ(late.inDelay, (VectorXd(4) << 0, -1, -2, 0).finished());
  const DrivenCourse lagging = drivenCourse(times, command, {.gain = 2, .lag = 0.5});
  // of a ramp behind a lag T: t − T + T e^{−t/T}
  EXPECT_NEAR(lagging.values[1], 2 * (1 + 1 - 0.5 + 0.5 * std::exp(-2)), 1e-12);
  const DrivenCourse full = drivenCourse(times, command, {.share = 1, .limit = 3});
  EXPECT_EQ(full.values, Eigen::Vector4d(1, 2, 3, 3));
  const DrivenCourse half = drivenCourse(times, -command, {.share = 0.5, .limit = 3});
  EXPECT_EQ(half.values, Eigen::Vector4d(-1, -2, -3.5, -3.5));
  // on the corner it is rounded
  EXPECT_NEAR(drivenCourse(times, command, {.share = 1, .limit = 4}).values[3], 4 - 0.05, 1e-12);
}

// 0.06 s later than one row is, but for rounding, another row.
TEST(DriveLaw, RowsThatAreTheSameButForRoundingAreOne) {
  Trial trial = drivenSwing(9, {}, 1);
  trial.sha256 = "abc";
  const Trial late = withDrives(trial, {{"swing", {.delay = 0.06}}});
  EXPECT_EQ(late.times.size(), trial.times.size());
  EXPECT_EQ(withDrives(trial, {{"swing", {.delay = 0.05}}}).times.size(),
            2 * trial.times.size() - 3);
  EXPECT_NEAR(late.applied[0].values[20], trial.applied[0].values[17], 1e-9);
  EXPECT_EQ(late.sha256, "");
  EXPECT_EQ(late.excitations.rows(), late.times.size());
}

TEST(DriveLaw, DerivativesMatchDifferences) {
  const VectorXd times = VectorXd::LinSpaced(4, 0, 3), command = Eigen::Vector4d(1, -2, 4, 3.1);
  const DriveLaw law{1.3, 0.25, 0.4, 0.7, 3};
  const DrivenCourse at = drivenCourse(times, command, law);
  const auto compare = [&](double DriveLaw::*number, const VectorXd& slope) {
    constexpr double h = 1e-6;
    DriveLaw above = law, below = law;
    above.*number += h;
    below.*number -= h;
    const VectorXd difference =
        (drivenCourse(times, command, above).values - drivenCourse(times, command, below).values) /
        (2 * h);
    EXPECT_LT((slope - difference).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_GT(slope.cwiseAbs().maxCoeff(), 0.01);
  };
  compare(&DriveLaw::gain, at.inGain);
  compare(&DriveLaw::lag, at.inLag);
  compare(&DriveLaw::share, at.inShare);
  compare(&DriveLaw::limit, at.inLimit);
}

TEST(DriveEffects, AreOfferedWhereATrialDrivesAndThoseOfMusclesAreNot) {
  const DrivenCase driven({drivenSwing(1, {}, 0.5)});
  const auto ids = offeredIds(*driven.data);
  for (const char* id : driveIds) EXPECT_THAT(ids, Contains(id));
  for (const char* id : {"fatigue", "delay", "shape"}) EXPECT_THAT(ids, Not(Contains(id)));
  for (const auto& one : driven.data->candidates()) {
    for (const char* word : {"limb", "EMG", "muscle", "tissue"}) {
      EXPECT_THAT(one.name, Not(HasSubstr(word)));
      EXPECT_THAT(one.sentence, Not(HasSubstr(word)));
    }
    for (const std::string& other : one.equivalents) EXPECT_THAT(ids, Contains(other));
  }
  Trial still = drivenSwing(1, {}, 0.5);
  still.applied.front().values.setConstant(0.4);
  for (const Trial& trial : {still, freeSwing(0.5, 1, viscous)}) {
    const DrivenCase held({trial});
    for (const char* id : driveIds) EXPECT_THAT(offeredIds(*held.data), Not(Contains(id)));
  }
}

TEST(DriveEffects, ChangeNothingWhereTheyAreAbsent) {
  DrivenCase driven({drivenSwing(2, {}, 1)});
  const VectorXd base = driven.data->outputs(0, driven.values, {});
  const VectorXd nominal = driven.values;
  for (const char* id : driveIds) {
    driven.values = nominal;
    const auto& one = driveCandidate(*driven.data, id);
    for (std::size_t i = 1; i < one.quantities.size(); ++i)
      driven.values[static_cast<Index>(one.quantities[i])] = one.starts.back()[1];
    EXPECT_EQ(driven.data->outputs(0, driven.values, {}), base) << id;
    EXPECT_EQ(driven.data->predict(0, driven.values, {}, one.quantities, true).outputs, base) << id;
  }
}

TEST(DriveEffects, DerivativesMatchDifferencesOfWholeSimulations) {
  for (const double optimalForce : {0.0, 2.5}) {
    DrivenCase driven({drivenSwing(3, {}, 1, optimalForce)}, optimalForce);
    const double most = driven.data->encompassing().drives().at(0).command.largest;
    // together, so that each sees the others
    driven.put("drive_gain", {1.3});
    driven.put("drive_delay", {0.0131});
    driven.put("drive_lag", {0.04});
    driven.put("drive_saturation", {0.6, 0.5 * most});
    for (const char* id : driveIds) EXPECT_LT(driven.error(id), 2e-4) << id << " " << optimalForce;
  }
}

TEST(DriveEffects, HaveTheRightSlopesWhereTheyAreAbsent) {
  const DrivenCase driven({drivenSwing(4, {}, 1)});
  for (const char* id : {"drive_gain", "drive_saturation"}) EXPECT_LT(driven.error(id), 2e-4) << id;
  // these have one side only
  for (const char* id : {"drive_delay", "drive_lag"}) {
    const std::size_t q = driveCandidate(*driven.data, id).quantities.front();
    const VectorXd slope = driven.data->predict(0, driven.values, {}, {q}, false).gamma;
    VectorXd moved = driven.values;
    constexpr double h = 1e-6;
    moved[static_cast<Index>(q)] = h;
    const VectorXd difference =
        (driven.data->outputs(0, moved, {}) - driven.data->outputs(0, driven.values, {})) / h;
    EXPECT_LT((slope - difference).norm(), 1e-3 * slope.norm()) << id;
  }
}

// The same motion by the torque's factor, by commands that are so much larger, and by an actuator
// that is so much stronger.
TEST(DriveEffects, AGainIsAStrongerActuator) {
  const Trial trial = drivenSwing(5, {}, 1);
  DrivenCase torque({trial}), motor({drivenSwing(5, {}, 1, 2.5)}, 2.5);
  Trial larger = trial;
  larger.applied.front().values *= 1.4;
  const VectorXd expected = DrivenCase({larger}).data->outputs(0, torque.values, {});
  torque.put("drive_gain", {1.4});
  motor.put("drive_gain", {1.4});
  EXPECT_LT((torque.data->outputs(0, torque.values, {}) - expected).norm(), 1e-12);
  EXPECT_LT((motor.data->outputs(0, motor.values, {}) - expected).norm(), 1e-10);
  const auto slopes = [](const DrivenCase& one) {
    return one.data
        ->predict(0, one.values, {}, driveCandidate(*one.data, "drive_gain").quantities, false)
        .gamma;
  };
  EXPECT_LT((slopes(torque) - slopes(motor)).norm(), 1e-9 * slopes(torque).norm());
  const Augmented stronger = augmentedModel(
      motor.data->encompassing(),
      motor.values.head(static_cast<Index>(motor.data->encompassing().quantities().size())));
  EXPECT_DOUBLE_EQ(stronger.model.actuators.front().optimalForce, 1.4 * 2.5);
  EXPECT_TRUE(stronger.drives.empty());
}

TEST(DriveEffects, RepairedModelsReplayTheirTrialsAsFitted) {
  for (const double optimalForce : {0.0, 2.5}) {
    for (const char* id : driveIds) {
      DrivenCase driven(
          {drivenSwing(6, {}, 1.5, optimalForce), drivenSwing(7, {}, 1.5, optimalForce)},
          optimalForce);
      const auto& one = driveCandidate(*driven.data, id);
      // a delay for which corners fall on rows, but for rounding
      driven.put(id, std::string(id) == "drive_delay"
                         ? std::vector<double>{0.06}
                         : std::vector<double>(one.starts[0].begin(), one.starts[0].end()));
      for (const std::size_t q : driven.data->nuisances()) {
        const auto& quantity = driven.data->quantities()[q];
        driven.values[static_cast<Index>(q)] += quantity.logarithmic ? 0.02 : 0.2 * quantity.sd;
      }
      info::discover::Verdict verdict;
      verdict.values = driven.values;
      verdict.sds = 0.002;
      const Repaired repaired = repairedModel(*driven.data, verdict, {1}, {}, {"a test", {}});
      const bool isOfModel = optimalForce != 0 && std::string(id) == "drive_gain";
      for (const RepairedTrial& trial : repaired.trials) {
        EXPECT_EQ(trial.driven.has_value(), !isOfModel) << id;
        EXPECT_NEAR(trial.after, trial.fitted, 1e-9) << id << " " << optimalForce;
        EXPECT_GT(std::abs(trial.nominal - trial.after), 1e-4) << id;
        if (!trial.driven) continue;
        EXPECT_THAT(trial.driven->columns, Contains(optimalForce != 0 ? "motor" : "swing.torque"));
        // as the program reads it
        const support::ScratchFolder folder;
        writeTable(*trial.driven, folder / "driven.sto");
        const Model& model = repaired.added.model;
        const Trial read = readTrial(folder / "driven.sto", model);
        const MusculoskeletalSystem system(model, drivenOptions());
        SimulationOptions simulation;
        simulation.step = 0.005;
        TrialBeginning start = beginningOf(read, model, system, {});
        start.point.q[0] = trial.starts[0].value;
        start.point.qDot[0] = trial.starts[0].speed;
        EXPECT_NEAR(replayTrial(system, read, simulation, start).errors.at(0).second.rms,
                    trial.after, 1e-6)
            << id;
      }
    }
  }
}

TEST(DriveEffects, ACommandNeedsACoordinateInQuestion) {
  EXPECT_THROW(encompassingModel(drivenPendulum(), drivenOptions(), "swing",
                                 {.drives = std::vector<DriveCommand>{{"elbow", 1, {}}}}),
               std::invalid_argument);
}

TEST(DriveEffects, SlopesOfAnExternalForceAreChecked) {
  const DrivenCase driven({drivenSwing(8, {}, 0.5)});
  const MusculoskeletalSystem system(driven.model, drivenOptions());
  ParameterCatalogue::Setting setting{driven.model, {}, {}, {}};
  setting.start = {VectorXd::Zero(1), VectorXd::Zero(1)};
  const ExcitationSignal none({0}, Eigen::MatrixXd::Zero(1, 0));
  const VectorXd one = VectorXd::Ones(1);
  const auto slope = [&](const ExternalSlope& given) {
    SensitivityOptions options;
    options.simulation.duration = 0.1;
    options.externalSlopes = {given};
    return simulateWithSensitivities(system, setting, {{}}, none, options).q[0](10, 0);
  };
  // of a constant torque
  EXPECT_GT(slope({0, 0, {0, 1}, one, one}), 0.001);
  EXPECT_THROW(slope({1, 0, {0, 1}, one, one}), std::invalid_argument);
  EXPECT_THROW(slope({0, 1, {0, 1}, one, one}), std::invalid_argument);
  EXPECT_THROW(slope({0, 0, {0, 0}, one, one}), std::invalid_argument);
  EXPECT_THROW(slope({0, 0, {0}, {}, {}}), std::invalid_argument);
  EXPECT_THROW(slope({0, 0, {0, 1, 2}, one, one}), std::invalid_argument);
}

/// The ids of a search's finding with those that may stand in their place, and the estimates.
struct FoundDrive {
  std::vector<std::string> named, inClass;
  std::vector<double> values, sds;
  std::string sentence;
};

FoundDrive foundDrive(const MotorError& error, unsigned seed) {
  const DrivenCase driven(
      {drivenSwing(seed, error), drivenSwing(seed + 1, error), drivenSwing(seed + 2, error)});
  info::discover::Options search;
  search.heldOut = {2};
  const info::discover::Verdict verdict = info::discover::run(*driven.data, search);
  FoundDrive found;
  found.sentence = verdict.sentence;
  for (const auto& effect : verdict.effects) {
    found.named.push_back(driven.data->candidates()[effect.candidate].id);
    for (const std::size_t c : effect.equals)
      found.inClass.push_back(driven.data->candidates()[c].id);
    for (const auto& estimate : effect.estimates) {
      found.values.push_back(estimate.value);
      found.sds.push_back(estimate.sd);
    }
  }
  return found;
}

// With a damper that is known, a torque's factor is not the mass's.
TEST(DriveEffects, AGainIsNamed) {
  const FoundDrive found = foundDrive({.gain = 1.3}, 11);
  ASSERT_THAT(found.named, testing::ElementsAre("drive_gain")) << found.sentence;
  EXPECT_NEAR(found.values[0], 1.3, 3 * found.sds[0]);
  EXPECT_LT(found.sds[0], 0.1);
}

TEST(DriveEffects, ADelayIsNamed) {
  const FoundDrive found = foundDrive({.delay = 0.035}, 21);
  ASSERT_THAT(found.inClass, Contains("drive_delay")) << found.sentence;
  ASSERT_THAT(found.named, testing::ElementsAre("drive_delay")) << found.sentence;
  EXPECT_NEAR(found.values[0], 0.035, 3 * found.sds[0]);
}

TEST(DriveEffects, ALagIsNamed) {
  const FoundDrive found = foundDrive({.lag = 0.06}, 31);
  ASSERT_THAT(found.named, testing::ElementsAre("drive_lag")) << found.sentence;
  EXPECT_NEAR(found.values[0], 0.06, 3 * found.sds[0]);
}

TEST(DriveEffects, ASaturationIsNamed) {
  const FoundDrive found = foundDrive({.limit = 1.2}, 41);
  ASSERT_THAT(found.named, testing::ElementsAre("drive_saturation")) << found.sentence;
  EXPECT_NEAR(found.values[0], 1, 3 * found.sds[0]);
  EXPECT_NEAR(found.values[1], 1.2, std::max(0.05, 3 * found.sds[1]));
}

TEST(DriveEffects, NothingIsNamedOfAMotorThatDoesAsItIsTold) {
  const FoundDrive found = foundDrive({}, 51);
  EXPECT_TRUE(found.named.empty()) << found.sentence;
}

}  // namespace
}  // namespace bio::discover
