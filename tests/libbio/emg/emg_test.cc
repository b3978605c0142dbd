#include "bio/emg/emg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include "support/numbers.h"

namespace {

using std::numbers::pi;
using support::nan;
using testing::Contains;
using testing::HasSubstr;
using testing::ThrowsMessage;

// Effort of the made-up signals, 0.1 to 0.9 with a period of 4 s.
double effort(double t) {
  return 0.5 - 0.4 * std::cos(2 * pi * t / 4);
}

// White noise of effort(t) mV times 100 Hz carrier statistics, a 50 Hz line of 2 mV and an offset
// of 5 mV.
bio::Channel rawEmg(const std::string& name, double rate = 2000, double seconds = 8) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> draw(-1, 1);
  bio::Channel out{name, "mV", rate, 0, Eigen::VectorXd(static_cast<Eigen::Index>(rate * seconds))};
  for (Eigen::Index i = 0; i < out.values.size(); ++i) {
    const double t = static_cast<double>(i) / rate;
    out.values[i] = effort(t) * draw(engine) + 2 * std::sin(2 * pi * 50 * t) + 5;
  }
  return out;
}

bio::Channel smooth(const std::string& name) {
  bio::Channel out{name, "", 100, 0, Eigen::VectorXd(801)};
  for (Eigen::Index i = 0; i < 801; ++i) out.values[i] = effort(static_cast<double>(i) / 100);
  return out;
}

bio::Recording recording(const std::vector<bio::Channel>& channels) {
  return {"made_up.csv", bio::RecordingFormat::table, channels, {}, {}};
}

bio::EmgConfig envelopeConfig() {
  bio::EmgConfig out;
  out.signal = bio::EmgSignal::envelope;
  out.electrodes = {{"e", bio::MvcValue{1.0, "given"}, {{"BRA", 1.0}}}};
  return out;
}

// u of one electrode and 1 − u of the other.
TEST(Emg, GivesMusclesWithoutAnElectrodeWhatIsAskedFor) {
  bio::EmgConfig config = envelopeConfig();
  config.electrodes.push_back({"f", bio::MvcValue{1.0, "given"}, {{"TRIlat", 1.0}}});
  config.unrecorded = {{"BRD", {{"e", 1}}, 0.5, 0, {}},
                       {"ANC", {{"e", 1}, {"f", 3}}, 1, 0, {}},
                       {"SUP", {}, 1, 0.05, bio::LatentDeclaration{"SUP", 0.7, 0.5}}};
  bio::Channel other = smooth("f");
  other.values = (1 - other.values.array()).matrix();
  const bio::EmgResult r = bio::excitationsFromEmg(recording({smooth("e"), other}), config);
  EXPECT_THAT(r.muscles, testing::ElementsAre("BRA", "TRIlat", "BRD", "ANC", "SUP"));
  const auto u = r.excitations.col(0).array();
  EXPECT_LT((r.excitations.col(2).array() - 0.5 * u).abs().maxCoeff(), 1e-15);
  EXPECT_LT((r.excitations.col(3).array() - (0.25 * u + 0.75 * (1 - u))).abs().maxCoeff(), 1e-12);
  EXPECT_TRUE((r.excitations.col(4).array() == 0.05).all());
  EXPECT_THAT(r.remarks, Contains(HasSubstr("BRD has no electrode: its excitation is 0.5 of that "
                                            "of electrode 'e'.")));
  EXPECT_THAT(r.remarks, Contains(HasSubstr("the mean of 0.25 of 'e' and 0.75 of 'f'.")));
  EXPECT_THAT(r.remarks, Contains(HasSubstr("a constant 0.05, which a calibration may correct at "
                                            "knots every 0.5 s at most, the log-odds by 0.7")));
  config.unrecorded[0].muscle = "BRA";
  EXPECT_THAT(
      [&] {
        bio::excitationsFromEmg(recording({smooth("e"), other}), config);
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("'BRA': has an electrode")));
}

TEST(Emg, RecoversTheEffortFromNoiseUnderALineAndAnOffset) {
  bio::EmgConfig config;
  config.notch.lines = {50};
  config.envelope.cutoff = 2;
  // uniform noise of variance 1/3 over 1000 Hz, of which 20–450 Hz pass: rms √(0.43/3), mean |x| =
  // √(2/π) rms
  const double full = std::sqrt(2 / pi * 0.43 / 3);
  config.electrodes = {{"biceps", bio::MvcValue{full, "given"}, {{"BIClong", 1.0}}}};
  const bio::EmgResult r = bio::excitationsFromEmg(recording({rawEmg("biceps")}), config);
  EXPECT_NEAR(r.electrodes[0].offset, 5, 0.01);
  EXPECT_EQ(r.time.size(), 1600);
  // a notch of 2 Hz rings for half a second after the ends of the line
  double squares = 0;
  for (Eigen::Index i = 100; i < 1500; ++i) {
    squares += std::pow(r.excitations(i, 0) - effort(r.time[i]), 2);
  }
  EXPECT_LT(std::sqrt(squares / 1400), 0.045);  // measured 0.034
  // without the notch the line stands on everything
  config.notch.lines = {};
  const bio::EmgResult humming = bio::excitationsFromEmg(recording({rawEmg("biceps")}), config);
  EXPECT_GT(humming.excitations.col(0).minCoeff(), 0.5);
}

TEST(Emg, NormalisesByTheValueOrByThePercentileAndSaysHowMuchItClipped) {
  bio::EmgConfig config = envelopeConfig();
  config.electrodes[0].full = bio::MvcValue{0.5, "test"};
  const bio::EmgResult mvc = bio::excitationsFromEmg(recording({smooth("e")}), config);
  EXPECT_NEAR(mvc.excitations(50, 0), effort(0.25) / 0.5, 1e-12);
  EXPECT_NEAR(mvc.electrodes[0].fractionAbove, 0.5, 0.01);
  EXPECT_DOUBLE_EQ(mvc.excitations.maxCoeff(), 1);
  config.electrodes[0].full = bio::OwnPercentile{50};
  const bio::EmgResult own = bio::excitationsFromEmg(recording({smooth("e")}), config);
  EXPECT_NEAR(own.electrodes[0].full, 0.5, 0.01);
  EXPECT_THAT(own.remarks, Contains(HasSubstr("up to a factor")));
  EXPECT_THAT(mvc.remarks, Not(Contains(HasSubstr("up to a factor"))));
}

TEST(Emg, DelaysShapesAndWeighsInThatOrderOfTime) {
  bio::EmgConfig config = envelopeConfig();
  config.delay = 0.06;
  config.shape = -2;
  config.electrodes[0].muscles = {{"BRA", 1.0}, {"BRD", 0.5}};
  const bio::EmgResult r = bio::excitationsFromEmg(recording({smooth("e")}), config);
  EXPECT_THAT(r.muscles, testing::ElementsAre("BRA", "BRD"));
  const double expected = bio::shapedExcitation(effort(1.0 - 0.06), -2);
  EXPECT_NEAR(r.excitations(200, 0), expected, 1e-9);
  EXPECT_NEAR(r.excitations(200, 1), 0.5 * expected, 1e-9);
  // before the delay has passed the first value holds
  EXPECT_NEAR(r.excitations(5, 0), bio::shapedExcitation(effort(0), -2), 1e-12);
}

TEST(Emg, AddsTheElectrodesOfAMuscleAndClipsTheSum) {
  bio::EmgConfig config = envelopeConfig();
  config.electrodes.push_back({"f", bio::MvcValue{1.0, "given"}, {{"BRA", 0.5}, {"BRD", 1.0}}});
  const bio::EmgResult r = bio::excitationsFromEmg(recording({smooth("e"), smooth("f")}), config);
  EXPECT_NEAR(r.excitations(0, 0), 1.5 * effort(0), 1e-12);
  EXPECT_DOUBLE_EQ(r.excitations.col(0).maxCoeff(), 1);
  EXPECT_NEAR(r.excitations.col(1).maxCoeff(), 0.9, 1e-12);
  EXPECT_GT(r.fractionSumAbove, 0.1);
}

TEST(Emg, TakesOnlyTheRowsThatWereAskedFor) {
  bio::EmgConfig config = envelopeConfig();
  config.start = 1.5;
  config.end = 3.0;
  config.outputRate = 100;
  const bio::EmgResult r = bio::excitationsFromEmg(recording({smooth("e")}), config);
  EXPECT_EQ(r.time.size(), 151);
  EXPECT_DOUBLE_EQ(r.time[0], 1.5);
  EXPECT_NEAR(r.time[150], 3.0, 1e-12);
  EXPECT_NEAR(r.excitations(50, 0), effort(2.0), 1e-12);
}

TEST(Emg, SaysFranklyWhatOneElectrodeCannotTell) {
  bio::EmgConfig config = envelopeConfig();
  config.electrodes[0].muscles = {{"BIClong", 1.0}, {"BICshort", 1.0}, {"BRA", 1.0}};
  const bio::EmgResult r = bio::excitationsFromEmg(recording({smooth("e")}), config);
  EXPECT_THAT(r.remarks,
              Contains(HasSubstr("BIClong, BICshort and BRA: they share one time course")));
  EXPECT_THAT(r.remarks, Contains(HasSubstr("co-contraction is not represented")));
}

TEST(Emg, PutsTheMeasuredCoordinateOnTheRows) {
  bio::EmgConfig config = envelopeConfig();
  config.measured = bio::MeasuredOptions{};
  config.measured->channel = "angle";
  bio::Channel angle{"angle", "deg", 50, 0, Eigen::VectorXd::LinSpaced(401, 0, 80)};
  const bio::EmgResult r = bio::excitationsFromEmg(recording({smooth("e"), angle}), config);
  ASSERT_EQ(r.measured_deg.size(), r.time.size());
  EXPECT_NEAR(r.measured_deg[400], 20, 1e-9);
  EXPECT_TRUE(std::isnan(r.measured_deg[401]));
}

TEST(Emg, NamesChannelQuantityAndRuleOfWhatItCannotUse) {
  const auto fails = [](const bio::Recording& rec, const bio::EmgConfig& config,
                        const std::string& text) {
    EXPECT_THAT([&] { bio::excitationsFromEmg(rec, config); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(text)));
  };
  const bio::Recording good = recording({smooth("e"), smooth("f")});
  bio::EmgConfig c = envelopeConfig();
  c.electrodes.clear();
  fails(good, c, "no electrode");
  c = envelopeConfig();
  c.electrodes[0].channel = "x";
  fails(good, c, "no channel 'x'; the file has 'e', 'f'");
  c = envelopeConfig();
  c.electrodes.push_back(c.electrodes[0]);
  fails(good, c, "mapped twice");
  c = envelopeConfig();
  c.electrodes[0].muscles[0].second = 1.5;
  fails(good, c, "weight 1.5");
  c = envelopeConfig();
  c.electrodes[0].muscles.clear();
  fails(good, c, "drives no muscle");
  c = envelopeConfig();
  c.shape = 1;
  fails(good, c, "A = 1");
  c = envelopeConfig();
  c.delay = nan;
  fails(good, c, "delay nan s");
  c = envelopeConfig();
  c.outputRate = 10;
  fails(good, c, "output rate 10 Hz");
  c.outputRate = 1e300;
  fails(good, c, "must have at most 10000000 rows");
  c = envelopeConfig();
  c.end = 9;
  fails(good, c, "to 9 s");
  c = envelopeConfig();
  c.start = 3;
  c.end = 3.001;
  fails(good, c, "fewer than two rows");
  c = envelopeConfig();
  c.electrodes[0].full = bio::MvcValue{nan, "given"};
  fails(good, c, "nan  (maximum");
  c.electrodes[0].full = bio::OwnPercentile{0};
  fails(good, c, "percentile 0");
  bio::Recording silent = good;
  silent.channels[0].values.setZero();
  c.electrodes[0].full = bio::OwnPercentile{99};
  fails(silent, c, "must be > 0");
  bio::Recording gap = good;
  gap.channels[0].values[10] = nan;
  fails(gap, envelopeConfig(), "no value from 0.1000 s");
  bio::Recording brief = good;
  brief.channels[0].values = Eigen::VectorXd::Ones(10).eval();
  fails(brief, envelopeConfig(), "at least one period");
  // raw EMG sampled too slowly for its band
  c = envelopeConfig();
  c.signal = bio::EmgSignal::raw;
  fails(good, c, "channel 'e': upper band edge 450 Hz");
}

}  // namespace
