// Which experiments of a dynamometer tell most; end to end in tests/apps/design.
#include "bio/design/dynamometer_plan.h"

#include <gtest/gtest.h>

#include "bio/analysis/replay.h"
#include "bio/tables/trial_table.h"
#include "support/numbers.h"
#include "support/shipped_elbow.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using support::degree;

struct DynamometerElbow {
  static SystemOptions options() {
    SystemOptions options;
    options.skeleton.freeCoordinates = {"elbow_flexion"};
    options.prescribed = {"elbow_flexion"};
    return options;
  }
  Model model = readOsim(fixtures::ShippedElbow::root() + "/models/elbow8.osim");
  MusculoskeletalSystem system{model, options()};

  static DynamometerQuestion question() {
    DynamometerQuestion question;
    question.coordinate = "elbow_flexion";
    question.positions = {0.8, 1.4};
    question.speeds = {1};
    question.efforts = {0.5};
    question.parameters = {"BRA.max_isometric_force", "hand.mass"};
    question.count = 3;
    question.rate = 50;
    return question;
  }
  DynamometerPlan plan(const DynamometerQuestion& asked) const {
    return planOnDynamometer(model, system, options(), SimulationOptions(), asked);
  }
};

TEST(DynamometerPlan, EachExperimentAddsAndNoneIsDoneTwice) {
  const DynamometerElbow elbow;
  const DynamometerPlan plan = elbow.plan(DynamometerElbow::question());
  EXPECT_EQ(plan.candidates, 4 + 2 * 3);  // held: groups × positions; turned both ways: + passive
  ASSERT_EQ(plan.chosen.size(), 3);
  Eigen::VectorXd before(2);
  before << plan.parameters[0].sd, plan.parameters[1].sd;
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_GT(plan.information[n], 0);
    if (n > 0) {
      EXPECT_LE(plan.information[n], plan.information[n - 1] * (1 + 1e-12));
    }
    EXPECT_TRUE((plan.bounds[n].array() <= before.array() * (1 + 1e-12)).all());
    before = plan.bounds[n];
    for (std::size_t m = 0; m < n; ++m) {
      const Eigen::MatrixXd& one = plan.chosen[n].trial.values;
      const Eigen::MatrixXd& other = plan.chosen[m].trial.values;
      EXPECT_FALSE(one.rows() == other.rows() && one == other);
    }
  }
}

TEST(DynamometerPlan, TurnsReachTheirEndWithoutOvershoot) {
  const DynamometerElbow elbow;
  DynamometerQuestion question = DynamometerElbow::question();
  question.positions = {0.8, 0.9001};  // about the shortest turn at 1 rad/s
  question.count = 100;
  for (const DynamometerExperiment& one : elbow.plan(question).chosen) {
    const Eigen::VectorXd angle = one.trial.values.rightCols<1>() / (180 / 3.14159265358979323846);
    EXPECT_GE(angle.minCoeff(), 0.8 - 1e-12);
    EXPECT_LE(angle.maxCoeff(), 0.9001 + 1e-12);
    EXPECT_NEAR(angle[angle.size() - 1], one.to, 1e-12);
  }
}

DynamometerQuestion onlyOf(DynamometerExperiment::Kind kind) {
  DynamometerQuestion question = DynamometerElbow::question();
  question.kinds = {kind};
  question.releases = {10 * degree};
  question.releaseSpeed = 125 * degree;  // 0.16 s: eight samples at 50 Hz
  question.loads = {0.5, 0.9};
  question.count = 100;
  return question;
}

// Flexors shorten when the angle rises, extensors when it falls; the contraction is steady.
TEST(DynamometerPlan, AReleaseLetsTheContractedMusclesShorten) {
  const DynamometerElbow elbow;
  DynamometerQuestion question = onlyOf(DynamometerExperiment::Kind::release);
  question.positions = {5 * degree, 80 * degree};
  const DynamometerPlan plan = elbow.plan(question);
  EXPECT_EQ(plan.candidates, 4);
  EXPECT_EQ(plan.unsuitable, 1);  // extensors, from 5° to −5°: outside the range
  ASSERT_EQ(plan.chosen.size(), 3);
  for (const DynamometerExperiment& one : plan.chosen) {
    const double rises = one.group == "flexors" ? 1 : -1;
    EXPECT_NEAR(one.to - one.from, rises * 10 * degree, 1e-12);
    const Eigen::VectorXd angle = one.trial.values.rightCols<1>() * degree;
    const Eigen::VectorXd speed =
        50 * (angle.tail(angle.size() - 1) - angle.head(angle.size() - 1));
    EXPECT_GE(rises * speed.minCoeff(), rises > 0 ? -1e-12 : 1e-12 - 125 * degree);
    EXPECT_LE(speed.cwiseAbs().maxCoeff(), 125 * degree);
    EXPECT_GT(speed.cwiseAbs().maxCoeff(), 0.9 * 125 * degree);
    EXPECT_NEAR(angle[angle.size() - 1], one.to, 1e-12);
    for (Eigen::Index k = 0; k + 1 < angle.size(); ++k) {
      if (std::abs(speed[k]) < 1e-9) continue;  // while it moves, one group contracts fully
      EXPECT_EQ(one.trial.values.row(k).segment(1, elbow.system.numMuscles()).maxCoeff(),
                one.effort);
    }
  }
}

// The joint is let go against part of what holds it: it moves in the muscles' direction, and the
// trial's own simulation is what the plan predicts.
TEST(DynamometerPlan, AnIsotonicContractionIsTheMotionOfItsOwnTrial) {
  const DynamometerElbow elbow;
  SystemOptions options = DynamometerElbow::options();
  options.prescribed.clear();
  const MusculoskeletalSystem free(elbow.model, options);
  const DynamometerPlan plan = elbow.plan(onlyOf(DynamometerExperiment::Kind::isotonic));
  EXPECT_EQ(plan.candidates, 8);
  ASSERT_GE(plan.chosen.size(), 4);
  EXPECT_EQ(plan.chosen.size() + plan.failed + plan.unsuitable, plan.candidates);
  for (const DynamometerExperiment& one : plan.chosen) {
    const double rises = one.group == "flexors" ? 1 : -1;
    EXPECT_LT(rises * one.torque, 0);
    EXPECT_GT(rises * (one.to - one.from), 1 * degree);
    const Trial trial = trialFrom(one.trial, "isotonic", elbow.model);
    const TrialReplay replay =
        replayTrial(free, trial, SimulationOptions(), beginningOf(trial, elbow.model, free, {}));
    ASSERT_EQ(replay.errors.size(), 1);
    EXPECT_LT(replay.errors[0].second.largest, 1e-9);
    EXPECT_LE(replay.motion.q.maxCoeff(), 2.268928031);
    EXPECT_GE(replay.motion.q.minCoeff(), 0);
    EXPECT_LE(replay.motion.qDot.cwiseAbs().maxCoeff(), 8.7);
  }
}

// With the whole torque that holds it, the joint stays: the torque is that of the isometric moment.
TEST(DynamometerPlan, TheLoadIsAShareOfWhatHoldsTheJoint) {
  const DynamometerElbow elbow;
  DynamometerQuestion question = onlyOf(DynamometerExperiment::Kind::isotonic);
  question.positions = {80 * degree};
  question.speeds = {};
  question.loads = {0.999999};
  for (const DynamometerExperiment& one : elbow.plan(question).chosen) {
    const Eigen::VectorXd angle = one.trial.values.rightCols<1>() * degree;
    const Eigen::Index early = std::min<Eigen::Index>(angle.size(), 6);  // 0.1 s
    EXPECT_LT((angle.head(early).array() - one.from).abs().maxCoeff(), 0.5 * degree) << one.group;
  }
}

// The margin for wrong parameters ends trials early.
TEST(DynamometerPlan, AnIsotonicContractionEndsBeforeTheRangeDoes) {
  const DynamometerElbow elbow;
  DynamometerQuestion question = onlyOf(DynamometerExperiment::Kind::isotonic);
  question.loads = {0.5, 0.6, 0.7, 0.8, 0.9};
  const auto rows = [&](double robustness) {
    question.robustness = robustness;
    Eigen::Index sum = 0;
    for (const DynamometerExperiment& one : elbow.plan(question).chosen) {
      sum += one.trial.values.rows();
      EXPECT_GE(one.trial.values.rows(), 6);  // 0.1 s
    }
    return sum;
  };
  const Eigen::Index sure = rows(0), careful = rows(20);
  EXPECT_LT(careful, sure);
  EXPECT_GT(careful, 0);
  question.fastest = 0.01;
  support::throwsSaying([&] { elbow.plan(question); }, "stays in the coordinate's range");
}

TEST(DynamometerPlan, RefusesListsThatMakeNoSense) {
  const DynamometerElbow elbow;
  const auto refused = [&](auto change, const char* words) {
    DynamometerQuestion question = DynamometerElbow::question();
    change(question);
    support::throwsSaying([&] { elbow.plan(question); }, words);
  };
  refused([](auto& q) { q.positions = {1.4, 0.8}; }, "positions must rise");
  refused([](auto& q) { q.positions = {0.8, 0.8}; }, "positions must rise");
  refused([](auto& q) { q.positions = {}; }, "at least one");
  refused([](auto& q) { q.speeds = {6.1}; }, "fit between the positions");
  refused([](auto& q) { q.speeds = {0.02}; }, "fit between the positions");
  refused([](auto& q) { q.efforts = {0.01}; }, "efforts must be above rest");
  refused([](auto& q) { q.noise = 0; }, "must be > 0");
  refused([](auto& q) { q.angleNoise = 0; }, "must be > 0");
  refused([](auto& q) { q.loads = {1}; }, "below 1");
  refused([](auto& q) { q.rate = 1e9; }, "at most 1e5");
  refused([](auto& q) { q.parameters = {}; }, "no parameter");
  refused([](auto& q) { q.robustness = -1; }, "surprise");
  refused(
      [](auto& q) {
        q.releases = {10 * degree};
        q.releaseSpeed = 130 * degree;
      },
      "at least 8 samples");
  refused([](auto& q) { q.coordinate = "knee"; }, "knee");
}

}  // namespace
}  // namespace bio
