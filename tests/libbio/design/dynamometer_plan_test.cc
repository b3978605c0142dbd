// Which experiments of a dynamometer tell most; end to end in tests/apps/design.
#include "bio/design/dynamometer_plan.h"

#include <gtest/gtest.h>

#include "support/shipped_elbow.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

struct DynamometerElbow {
  static SystemOptions options() {
    SystemOptions options;
    options.skeleton.freeCoordinates = {"elbow_flexion"};
    options.prescribed = {"elbow_flexion"};
    return options;
  }
  Model model = readOsim(fixtures::ShippedElbow::root() + "/models/elbow8.osim");
  MusculoskeletalSystem arm{model, options()};

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
    return planOnDynamometer(model, arm, options(), SimulationOptions(), asked);
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
    if (n > 0) EXPECT_LE(plan.information[n], plan.information[n - 1] * (1 + 1e-12));
    EXPECT_TRUE((plan.bounds[n].array() <= before.array() * (1 + 1e-12)).all());
    before = plan.bounds[n];
    for (std::size_t m = 0; m < n; ++m) {
      EXPECT_FALSE(plan.chosen[n].trial.values == plan.chosen[m].trial.values);
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
  refused([](auto& q) { q.coordinate = "knee"; }, "knee");
}

}  // namespace
}  // namespace bio
