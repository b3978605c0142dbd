#include "bio/emg/channel_review.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "bio/emg/emg_stages.h"
#include "bio/emg/filter.h"

namespace bio {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double rate = 2000;

Eigen::VectorXd noise(Eigen::Index count, unsigned seed, double sd = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, sd);
  return Eigen::VectorXd::NullaryExpr(count, [&](Eigen::Index) { return normal(random); });
}

// White noise in the band of an EMG, in bursts.
Channel emg(const std::string& name, unsigned seed) {
  Eigen::VectorXd values = bandPassed(noise(20000, seed, 100), rate, {.low = 20, .high = 450});
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values[i] *= 0.1 + std::abs(std::sin(2e-4 * static_cast<double>(i)));
  }
  return {name, "uV", rate, 0, values};
}

// A reach of 90° with white noise of 0.3°.
Channel angle(const std::string& name, double atRate = 200) {
  Channel out{name, "deg", atRate, 0, noise(static_cast<Eigen::Index>(10 * atRate), 5, 0.3)};
  for (Eigen::Index i = 0; i < out.values.size(); ++i) {
    out.values[i] += 45 * (1 - std::cos(0.8 * static_cast<double>(i) / atRate));
  }
  return out;
}

std::vector<std::string> review(const std::vector<Channel>& electrodes,
                                const std::vector<Channel>& measured = {}) {
  std::vector<ReviewedChannel> all;
  for (const Channel& channel : electrodes) all.push_back({&channel, ChannelUse::rawEmg});
  for (const Channel& channel : measured) all.push_back({&channel, ChannelUse::measured});
  return reviewChannels(all);
}

TEST(ChannelReview, HasNothingToSayOnGoodChannels) {
  EXPECT_THAT(review({emg("a", 1), emg("b", 2)}, {angle("q")}), IsEmpty());
}

TEST(ChannelReview, SeesClippedChannels) {
  Channel clipped = emg("a", 1);
  clipped.values = clipped.values.cwiseMax(-40.0).cwiseMin(40.0);
  EXPECT_THAT(review({clipped}),
              ElementsAre(HasSubstr("'a' looks clipped"), HasSubstr("at -40 uV")));
  Channel stop = angle("q");
  stop.values = stop.values.cwiseMin(60.0);
  EXPECT_THAT(review({}, {stop}), ElementsAre(HasSubstr("exclude them with clip_above")));
}

// An angle of 0.1° resolution that rests at its largest and smallest value.
TEST(ChannelReview, TakesRestForNoClipping) {
  Channel rest = angle("q");
  for (Eigen::Index i = 0; i < rest.values.size(); ++i) {
    const double phase = std::clamp(static_cast<double>(i) / 1000 - 0.5, 0.0, 1.0);
    rest.values[i] = std::round(450 * (1 - std::cos(std::numbers::pi * phase))) / 10;
  }
  for (const std::string& line : review({}, {rest})) {
    EXPECT_THAT(line, testing::Not(HasSubstr("clipped")));
  }
}

TEST(ChannelReview, SeesDeadChannels) {
  Channel dead = emg("a", 1);
  dead.values.setConstant(3);
  EXPECT_THAT(review({dead}),
              ElementsAre("Channel 'a' looks dead: it has only 1 different value."));
  Channel faint = emg("a", 1);
  faint.values *= 0.001;
  EXPECT_THAT(review({faint, emg("b", 2), emg("c", 3)}), ElementsAre(HasSubstr("'a' looks dead")));
}

TEST(ChannelReview, SeesEnvelopesAndRectifiedSignals) {
  Channel envelopeOf = emg("a", 1);
  envelopeOf.values = envelope(envelopeOf.values.cwiseAbs(), rate, {.cutoff = 6});
  EXPECT_THAT(review({envelopeOf}), ElementsAre(HasSubstr("looks like no raw EMG")));
  Channel rectified = emg("a", 1);
  rectified.values = rectified.values.cwiseAbs();
  EXPECT_THAT(review({rectified}), ElementsAre(HasSubstr("looks rectified")));
}

// The words tell the cut-off within a factor of 1.5.
TEST(ChannelReview, SeesLowPassedChannelsAndTheirCutOff) {
  for (const double cutoff : {6.0, 10.0, 20.0}) {
    Channel smooth = angle("q");
    smooth.values = filterZeroPhase(
        butterworthLowPass(2, cutoff, smooth.rate, Passes::forwardAndBackward), smooth.values);
    const std::vector<std::string> found = review({}, {smooth});
    ASSERT_EQ(found.size(), 1) << cutoff;
    const double told = std::stod(found[0].substr(found[0].find("about ") + 6));
    EXPECT_GT(told, cutoff / 1.5);
    EXPECT_LT(told, cutoff * 1.5);
  }
  Channel smooth = emg("a", 1);
  smooth.values =
      filterZeroPhase(butterworthLowPass(4, 100, rate, Passes::forwardAndBackward), smooth.values);
  EXPECT_THAT(review({smooth}), ElementsAre(HasSubstr("already low-passed at about")));
}

TEST(ChannelReview, SeesSwappedAndDoubledChannels) {
  const Channel burst = emg("knee", 4);
  EXPECT_THAT(review({angle("biceps", rate)}, {burst}),
              testing::Contains(HasSubstr("Channels 'biceps' and 'knee' look swapped")));
  Channel same = emg("b", 1);
  same.values *= -2;
  EXPECT_THAT(review({emg("a", 1), same}),
              ElementsAre(HasSubstr("'a' and 'b' show the same signal with opposite signs")));
}

}  // namespace
}  // namespace bio
