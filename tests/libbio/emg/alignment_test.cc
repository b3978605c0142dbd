#include "bio/emg/alignment.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "bio/emg/emg_recordings.h"
#include "bio/tables/file_error.h"
#include "emg/spectrum.h"
#include "support/scratch_folder.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// Three bumps of different height and distance, as a person taps thrice.
double taps(double t) {
  const auto bump = [&](double at, double height, double width) {
    return height * std::exp(-0.5 * (t - at) * (t - at) / (width * width));
  };
  return bump(1.3, 1, 0.02) + bump(1.9, 0.7, 0.03) + bump(3.1, 1.2, 0.02);
}

Channel channelOf(double (*signal)(double), double rate, double start, double end, double clock,
                  double noise = 0) {
  Channel out;
  out.name = "taps";
  out.rate = rate;
  out.startTime = start;
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, noise > 0 ? noise : 1);
  const auto count = static_cast<Eigen::Index>((end - start) * rate);
  out.values = Eigen::VectorXd::NullaryExpr(count, [&](Eigen::Index i) {
    const double t = start + static_cast<double>(i) / rate + clock;
    return signal(t) + (noise > 0 ? normal(random) : 0);
  });
  return out;
}

TEST(CorrelationSums, AreTheSumsOverTheOverlap) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(7, 1, 3).cwiseAbs2();
  const Eigen::VectorXd y = Eigen::Vector4d(0.5, -1, 2, 4);
  const Eigen::VectorXd sums = correlationSums(x, y);
  ASSERT_EQ(sums.size(), 10);
  for (Eigen::Index lag = -3; lag <= 6; ++lag) {
    double sum = 0;
    for (Eigen::Index i = 0; i < 4; ++i) {
      if (i + lag >= 0 && i + lag < 7) sum += x[i + lag] * y[i];
    }
    EXPECT_NEAR(sums[lag + 3], sum, 1e-12);
  }
}

TEST(SpectrumOf, SumsUpToTheVarianceAndKnowsTheFrequency) {
  const Eigen::VectorXd wave = Eigen::VectorXd::NullaryExpr(8000, [](Eigen::Index i) {
    return 3 * std::sin(2 * std::numbers::pi * 40 * static_cast<double>(i) / 1000);
  });
  const Spectrum spectrum = spectrumOf(wave, 1000);
  EXPECT_NEAR(spectrum.power.sum(), 4.5, 0.01);
  Eigen::Index peak = 0;
  spectrum.power.maxCoeff(&peak);
  EXPECT_NEAR(static_cast<double>(peak) * spectrum.spacing, 40, spectrum.spacing);
}

// Rates 1000 and 148.1 Hz, noise of a tenth of the taps: within a tenth of the slower interval.
TEST(Alignment, FindsTheOffsetOfTwoClocks) {
  for (const double clock : {-2.345, 0.0, 0.7712, 40.0}) {
    const Channel first = channelOf(taps, 1000, 0, 6, 0, 0.05);
    // its own clock reads `clock` less than the first's
    const Channel other = channelOf(taps, 148.1, -clock, 5 - clock, clock, 0.05);
    const Alignment found = alignmentOf(first, other);
    EXPECT_NEAR(found.offset, clock, 0.1 / 148.1) << clock;
    EXPECT_GT(found.correlation, 0.8);
    EXPECT_LT(found.rival, 0.7);
  }
}

TEST(Alignment, SeesAnEventThatIsUpsideDown) {
  const Channel first = channelOf(taps, 500, 0, 6, 0);
  Channel other = channelOf(taps, 500, 0, 5, 0.25);
  other.values *= -3;
  const Alignment found = alignmentOf(first, other);
  EXPECT_NEAR(found.offset, 0.25, 1e-4);
  EXPECT_NEAR(found.correlation, -1, 0.01);
}

TEST(Alignment, RefusesWhatShowsNoCommonEvent) {
  const Channel first = channelOf(taps, 200, 0, 6, 0);
  Channel noise = channelOf([](double) { return 0.0; }, 200, 0, 6, 0, 1);
  EXPECT_THAT([&] { alignmentOf(first, noise); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("must reach 0.5")));
  Channel still = noise;
  still.values.setConstant(2);
  EXPECT_THAT([&] { alignmentOf(first, still); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("one value throughout")));
  const Channel wave =
      channelOf([](double t) { return std::sin(2 * std::numbers::pi * t); }, 200, 0, 20, 0);
  EXPECT_THAT([&] { alignmentOf(wave, wave); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("and by")));
  EXPECT_NEAR(alignmentOf(wave, wave, {.within = 0.4}).offset, 0, 1e-9);
  Channel later = first;
  later.startTime = 100;
  EXPECT_THAT([&] { alignmentOf(first, later, {.within = 1}); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("do not overlap by half")));
}

// 190 Hz would be seen as 10 Hz in samples at 200 Hz.
TEST(Resampled, FoldsNothingBack) {
  const Channel fast = channelOf(
      [](double t) {
        return std::sin(2 * std::numbers::pi * t) + std::sin(2 * std::numbers::pi * 190 * t);
      },
      2000, 0, 10, 0);
  const Eigen::VectorXd slow = resampled(fast, 200);
  for (Eigen::Index i = 200; i < slow.size() - 200; ++i) {
    EXPECT_NEAR(slow[i], std::sin(2 * std::numbers::pi * static_cast<double>(i) / 200), 2e-3);
  }
}

class JoinedFiles : public testing::Test {
 protected:
  // A table of a burst of EMG-like noise and the taps, and one of the taps and an angle.
  void SetUp() override {
    std::string emg = "time,bic_uV,tap\n", angle = "Time [ms];sync;knee [deg]\n";
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 5000; ++i) {
      const double t = i / 1000.0;
      emg += std::to_string(t) + "," + std::to_string(100 * normal(random)) + "," +
             std::to_string(taps(t)) + "\n";
    }
    for (int i = 0; i < 600; ++i) {
      const double t = i / 120.0;  // this clock started 0.5 s before the first
      std::string row = std::to_string(1000 * t) + ";" + std::to_string(taps(t - 0.5)) + ";" +
                        std::to_string(10 * (t - 0.5)) + "\n";
      std::replace(row.begin(), row.end(), '.', ',');
      angle += row;
    }
    files_ = {folder_.file("emg.csv", emg), folder_.file("angle.csv", angle)};
  }
  EmgConfigFile config(const std::string& recording) const {
    return readEmgConfig(folder_.file("c.toml", recording + R"(
[[electrode]]
channel = "bic_uV"
muscles = ["BIC"]
[measured]
channel = "knee [deg]"
coordinate = "knee"
[[column]]
channel = "sync"
name = "knee.moment"
scale = -2
offset = 1
)"));
  }
  support::ScratchFolder folder_;
  std::vector<std::string> files_;
};

TEST_F(JoinedFiles, BecomeOneTrialOnTheFirstClock) {
  for (const std::string how :
       {"[[recording]]\nmatch = 'sync'\nwith = 'tap'\n", "[[recording]]\noffset_s = -0.5\n"}) {
    const EmgConfigFile file = config(how);
    const JoinedRecordings joined = readRecordings(file, files_);
    ASSERT_EQ(joined.placed.size(), 1);
    EXPECT_NEAR(joined.placed[0].offset, -0.5, 2e-4);
    const EmgResult result =
        excitationsFromEmg(joined.recording, emgConfigFor(file, joined.recording));
    ASSERT_EQ(result.columns.cols(), 1);
    for (Eigen::Index i = 100; i < result.time.size() - 150; i += 37) {
      const double t = result.time[i];
      if (std::isnan(result.measured_deg[i])) continue;
      EXPECT_NEAR(result.measured_deg[i], 10 * t, 2e-3);
      EXPECT_NEAR(result.columns(i, 0), 1 - 2 * taps(t), 0.06);
    }
    EXPECT_GT((!result.columns.array().isNaN()).count(), 400);
  }
}

TEST_F(JoinedFiles, NeedATableEachAndChannelsOfTheirOwn) {
  const auto refused = [&](const std::string& how, const std::string& message) {
    EXPECT_THAT([&] { readRecordings(config(how), files_); },
                testing::ThrowsMessage<FileError>(HasSubstr(message)))
        << how;
  };
  refused("", "2 recordings and 0 tables [[recording]], must be one table for each recording");
  refused("[[recording]]\n", "offset_s");
  refused("[[recording]]\nmatch = 'sync'\n", "with");
  refused("[[recording]]\noffset_s = 1\nmatch = 'sync'\nwith = 'tap'\n",
          "must be alone: match finds the offset");
  refused("[[recording]]\nmatch = 'none'\nwith = 'tap'\n", "c.toml:1: ");
  refused("[[recording]]\nmatch = 'knee [deg]'\nwith = 'bic_uV'\n", "must reach 0.5");
  refused("[[recording]]\noffset_s = 0\n[[recording.channel]]\ncolumn = 'sync'\nname = 'tap'\n",
          "channel 'tap' is in");
}

}  // namespace
}  // namespace bio
