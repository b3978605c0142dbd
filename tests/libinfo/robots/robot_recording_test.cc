#include "robots/robot_recording.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "support/throws_saying.h"

namespace {

using info::robot::Channel;
using info::robot::RecordedTable;
using info::robot::Trial;
using support::throwsSaying;

const std::vector<Channel> twoAngles = {{"link1", "rad"}, {"link2", "rad"}};
const std::vector<Channel> oneForce = {{"force", "N"}};
constexpr double kHalfTurn = 180;  // [deg]

RecordedTable recorded(std::vector<std::string> columns, const Eigen::MatrixXd& values) {
  return {"trial", std::move(columns), values, false};
}

/// Refuses columns that mean nothing.
Trial trialFrom(const RecordedTable& table, const std::vector<Channel>& channels) {
  return info::robot::recordingOf(table, channels, [](const std::string& column) {
    throw std::runtime_error("unknown: " + column);
  });
}

TEST(RobotRecording, TakesAnglesInEitherUnitAndLeavesOutWhatWasPlanned) {
  Eigen::MatrixXd values(2, 5);
  values << 0, 1, kHalfTurn, 0.5, 7,  //
      0.1, 2, std::nan(""), 0.6, 7;
  const Trial trial = trialFrom(
      recorded({"time_s", "input", "link1_deg", "link2_rad", "cart_m"}, values), twoAngles);
  EXPECT_THAT(trial.times, testing::ElementsAre(0, 0.1));
  EXPECT_THAT(trial.acceleration, testing::ElementsAre(1, 2));
  EXPECT_NEAR(trial.measured(0, 0), std::numbers::pi, 1e-15);
  EXPECT_TRUE(std::isnan(trial.measured(1, 0)));
  EXPECT_EQ(trial.measured(1, 1), 0.6);
}

TEST(RobotRecording, TakesTheUnitOfTheWholeTableForANameWithoutOne) {
  Eigen::MatrixXd values(2, 4);
  values << 0, 1, 9, 9, 0.1, 2, 9, 9;
  RecordedTable table = recorded({"time", "input", "link1", "link2_rad"}, values);
  EXPECT_EQ(trialFrom(table, twoAngles).measured(0, 0), 9);
  table.inDegrees = true;
  EXPECT_NEAR(trialFrom(table, twoAngles).measured(0, 0), std::numbers::pi / 20, 1e-15);
  EXPECT_EQ(trialFrom(table, twoAngles).measured(0, 1), 9);
}

TEST(RobotRecording, NamesColumnsThatMeanNothing) {
  Eigen::MatrixXd values(2, 4);
  values << 0, 1, 2, 3, 0.1, 1, 2, 3;
  const RecordedTable table = recorded({"time", "input", "force_N", "colour"}, values);
  throwsSaying([&] { trialFrom(table, oneForce); }, "unknown: colour");
  std::vector<std::string> unknown;
  const Trial trial = info::robot::recordingOf(
      table, oneForce, [&](const std::string& column) { unknown.push_back(column); });
  EXPECT_EQ(trial.measured(1, 0), 2);
  EXPECT_THAT(unknown, testing::ElementsAre("colour"));
}

TEST(RobotRecording, SaysWhichRuleATableBreaks) {
  const Eigen::MatrixXd values = Eigen::MatrixXd::Ones(2, 4);
  const auto refused = [&](const std::vector<std::string>& columns, const Eigen::MatrixXd& of,
                           const std::vector<Channel>& channels, const char* words) {
    throwsSaying([&] { trialFrom(recorded(columns, of), channels); }, words);
  };
  const Eigen::MatrixXd three = values.leftCols(3);
  refused({"input", "force_N"}, three.leftCols(2), oneForce, "trial: has no column time");
  refused({"time", "force_N"}, three.leftCols(2), oneForce, "has no column input");
  refused({"time", "input"}, three.leftCols(2), oneForce, "has no column force_N");
  refused({"time", "input", "link1_rad"}, three, twoAngles, "has no column link2_deg (or _rad)");
  refused({"time", "input", "force", "force_N"}, values, oneForce,
          "columns force and force_N have the same meaning");
  refused({"time", "input", "force_N"}, three.topRows(1), oneForce, "holds 1 row");
  refused({"time", "input", "link1", "link2"}, 21 * values, twoAngles, "degrees are called");
  Eigen::MatrixXd gap = three;
  gap(1, 1) = std::nan("");
  refused({"time", "input", "force_N"}, gap, oneForce, "column input: row 2 is empty");
}

}  // namespace
