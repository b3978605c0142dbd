#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "support/replays.h"
#include "support/run_program.h"
#include "support/scratch_folder.h"

// What is found with steps that are too long is told and written, with the reservation.
namespace {

using support::contentOf;
using testing::HasSubstr;

const char* const pendulum =
    "<OpenSimDocument Version=\"40000\"><Model name=\"pendulum\"><gravity>0 -9.81 0</gravity>"
    "<BodySet><objects><Body name=\"arm\"><mass>1</mass><mass_center>0 -0.6 0</mass_center>"
    "<inertia>0 0 0 0 0 0</inertia></Body></objects></BodySet><JointSet><objects><PinJoint "
    "name=\"pivot\"><socket_parent_frame>/ground</socket_parent_frame><socket_child_frame>"
    "/bodyset/arm</socket_child_frame><coordinates><Coordinate name=\"swing\"><range>-3 3</range>"
    "</Coordinate></coordinates></PinJoint></objects></JointSet><ForceSet><objects/></ForceSet>"
    "</Model></OpenSimDocument>";

/// A swing so small that it is that of a linear oscillator, damped by 0.4 N m s/rad.
std::string smallSwing(double from, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise(0, 1e-4);
  const double decay = 0.4 / (2 * 0.36), rate = std::sqrt(9.81 / 0.6 - decay * decay);
  std::string text = "time,swing\n";
  for (int k = 0; k <= 100; ++k) {
    const double t = 0.02 * k;
    const double swing =
        from * std::exp(-decay * t) * (std::cos(rate * t) + decay / rate * std::sin(rate * t));
    text += fmt::format("{:.2f},{:.7f}\n", t, swing + noise(generator));
  }
  return text;
}

TEST(ClosestMatch, OfLongStepsIsWrittenUnderItsOwnName) {
  const support::ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const auto result = support::runFisherHill(
      {"discover", scratch.file("pendulum.osim", pendulum),
       scratch.file("one.csv", smallSwing(0.05, 1)), scratch.file("two.csv", smallSwing(-0.04, 2)),
       "--step", "0.04", "--noise-deg", "0.006", "--out", out});
  EXPECT_EQ(result.status, 1) << result.err;
  EXPECT_THAT(result.out, HasSubstr("use shorter steps. With these steps: "));
  const auto verdict = nlohmann::json::parse(contentOf(out + "/verdict.json"));
  EXPECT_EQ(verdict["verdict"], "numerical");
  EXPECT_EQ(verdict["model"], "closest_match.osim");
  ASSERT_FALSE(verdict["effects"].empty());
  EXPECT_EQ(verdict["effects"][0]["id"], "visc");
  EXPECT_FALSE(std::filesystem::exists(out + "/with_effect.osim"));
  EXPECT_THAT(contentOf(out + "/closest_match.osim"),
              HasSubstr("with the reservation: Halving the time step changes"));
  support::expectReplaysAgree(out + "/closest_match.osim", verdict["trials"], 0.04);
  EXPECT_EQ(support::runFisherHill({"check", out + "/closest_match.osim"}).status, 0);
}

}  // namespace
