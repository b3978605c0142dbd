#include "playback/playback.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "two_links.h"

namespace {

using namespace bio;
using app::Playback;
using app::playbackOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// Two links that swing, and what was measured of them.
struct Swing {
  Model model = fixtures::twoLinks();
  MusculoskeletalSystem system{model, fixtures::twoLinksFree()};
  Trajectory motion = fixtures::twoLinksSwing(21);
  Trial trial;

  void measure(const std::string& coordinate, std::vector<double> times) {
    MeasuredChannel channel;
    channel.what = ofCoordinate(coordinate);
    const auto n = static_cast<Eigen::Index>(times.size());
    channel.times = Eigen::VectorXd::Map(times.data(), n);
    channel.values = Eigen::VectorXd::Constant(n, 0.1);
    trial.measured.push_back(channel);
  }
  std::optional<Playback> play() const {
    return playbackOf("Swing", {{"swing.sto", &trial, {{"simulated", model, system, motion}}}}, {});
  }
};

TEST(Playback, OfAMechanismHasItsSolidsAndNoActivation) {
  const auto playback = Swing().play();
  ASSERT_TRUE(playback);
  EXPECT_EQ(playback->data["largest"], 0);
  EXPECT_EQ(playback->data["models"][0]["bodies"], 3);
  ASSERT_EQ(playback->data["trials"][0]["motions"].size(), 1u);
  EXPECT_EQ(playback->data["trials"][0]["motions"][0]["times"].size(), 21u);
  EXPECT_EQ(playback->data["up"], (std::vector<double>{0, 1, 0}));
  EXPECT_EQ(playback->data["view"], "side");  // it swings about z
  EXPECT_THAT(playback->still,
              HasSubstr("<svg class=\"still\" role=\"img\" aria-label=\"The motion "
                        "from 0 to 2 s: upper_angle between 22.9 and 138 deg"));
  EXPECT_THAT(playback->caption, AllOf(Not(HasSubstr("Muscles")), Not(HasSubstr("ghost"))));
}

TEST(Playback, HasAGhostWhereEveryFreeCoordinateWasMeasured) {
  Swing swing;
  swing.measure("upper_angle", {0, 0.2, 0.4, 0.6, 1.4, 1.6});
  EXPECT_THAT(app::unmeasuredCoordinates(swing.system, swing.trial), ElementsAre("lower_angle"));
  auto playback = swing.play();
  EXPECT_EQ(playback->data["trials"][0]["motions"].size(), 1u);
  EXPECT_THAT(playback->caption,
              HasSubstr("no ghost of the measured posture, since not every free coordinate was "
                        "measured: lower_angle."));
  swing.measure("lower_angle", {0, 0.2, 0.4, 0.6, 1.4, 1.6});
  playback = swing.play();
  ASSERT_EQ(playback->data["trials"][0]["motions"].size(), 2u);
  EXPECT_EQ(playback->data["trials"][0]["motions"][1]["name"], "measured");
  EXPECT_EQ(playback->data["trials"][0]["motions"][1]["isGhost"], true);
  EXPECT_THAT(playback->caption, HasSubstr("ghost is the measured posture"));
}

TEST(Playback, IsThinnedToItsLimit) {
  Swing swing;
  swing.motion = fixtures::twoLinksSwing(1000);
  const auto playback = swing.play();
  EXPECT_EQ(playback->data["trials"][0]["motions"][0]["times"].size(), 120u);
  EXPECT_THAT(playback->caption, HasSubstr("120 moments are drawn exactly"));
}

TEST(Playback, SaysHowManyTrialsItLeavesOut) {
  const Swing swing;
  std::vector<app::PlayedTrial> trials(
      9, {"a.sto", nullptr, {{"simulated", swing.model, swing.system, swing.motion}}});
  const auto playback = playbackOf("Swings", trials, {});
  EXPECT_EQ(playback->data["trials"].size(), app::mostPlayedTrials);
  EXPECT_THAT(playback->caption, HasSubstr("Only the first 6 of 9 trials are here."));
}

TEST(Playback, OfNothingToDrawIsLeftOut) {
  Swing swing;
  EXPECT_FALSE(playbackOf("", {}, {}));
  swing.motion = fixtures::twoLinksSwing(1);
  EXPECT_FALSE(swing.play());
}

}  // namespace
