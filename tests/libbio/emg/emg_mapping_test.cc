#include "bio/emg/emg_mapping.h"

#include <gtest/gtest.h>

#include "bio/emg/emg_stages.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

const std::vector<std::string> muscles = {"A", "B"};

ExcitationSignal signal() {
  Eigen::MatrixXd u(3, 2);
  u << 0.1, 0.2, 0.5, 0.9, 0.3, 0.0;
  return {{0, 1, 2}, u};
}

Eigen::Vector2d at(const ExcitationSignal& s, double t) {
  Eigen::Vector2d u;
  std::size_t hint = 0;
  s.at(t, hint, u);
  return u;
}

TEST(EmgMapping, DoesNothingByDefault) {
  const ExcitationSignal driven = drivenExcitation(signal(), muscles, {});
  for (const double t : {0.0, 0.3, 1.0, 1.7, 2.0}) EXPECT_EQ(at(driven, t), at(signal(), t));
}

TEST(EmgMapping, DelaysShapesAndScales) {
  const EmgMapping mapping{{{"B", 0.5}}, 0.25, -2};
  const ExcitationSignal driven = drivenExcitation(signal(), muscles, mapping);
  EXPECT_NEAR(at(driven, 1.25)[0], shapedExcitation(0.5, -2), 1e-15);
  EXPECT_NEAR(at(driven, 1.25)[1], 0.5 * shapedExcitation(0.9, -2), 1e-15);
}

TEST(EmgMapping, HoldsExcitationsAtOne) {
  const ExcitationSignal driven = drivenExcitation(signal(), muscles, {{{"B", 3}}, 0, 0});
  EXPECT_EQ(at(driven, 1)[1], 1);
  EXPECT_EQ(emgDerivatives(signal(), muscles, {{{"B", 3}}, 0, 0}).gain(1, 1), 0);
}

TEST(EmgMapping, DerivativesMatchDifferencesOnBothSidesOfTheSeries) {
  for (const double A : {-2.5, -0.02, -0.0099, -1e-5, 0.0}) {
    const auto rows = [&](double gain, double shape) {
      const ExcitationSignal driven =
          drivenExcitation(signal(), muscles, {{{"A", gain}}, 0, shape});
      Eigen::MatrixXd u(2, 3);
      for (int k = 0; k < 3; ++k) u.col(k) = at(driven, k);
      return u;
    };
    const double h = 1e-5;
    const EmgDerivatives d = emgDerivatives(signal(), muscles, {{{"A", 0.8}}, 0, A});
    const Eigen::MatrixXd gain = (rows(0.8 + h, A) - rows(0.8 - h, A)) / (2 * h);
    const Eigen::MatrixXd shape = (rows(0.8, A + h) - rows(0.8, A - h)) / (2 * h);
    EXPECT_LT((d.gain.row(0) - gain.row(0)).cwiseAbs().maxCoeff(), 1e-9) << A;
    EXPECT_LT((d.nonlinearity - shape).cwiseAbs().maxCoeff(), 1e-9) << A;
  }
}

/// sin(πt) over 1 s at 100 Hz, cut off at a level.
Eigen::RowVectorXd clippedWave(double level, Eigen::VectorXd& times) {
  times = Eigen::VectorXd::LinSpaced(101, 0, 1);
  return (M_PI * times.array()).sin().min(level).matrix().transpose();
}

TEST(EmgMapping, AFlatTopLacksNearlyWhatWasCutOffAWave) {
  Eigen::VectorXd times;
  for (const double level : {0.5, 0.7, 0.9}) {
    const Eigen::RowVectorXd lacking = flatTops(times, clippedWave(level, times));
    EXPECT_NEAR(lacking.maxCoeff(), 1 - level, 0.15 * (1 - level)) << level;
    EXPECT_EQ(lacking[10], 0);
    EXPECT_NEAR(lacking[50 - 7], lacking[50 + 7], 1e-12);  // as the wave
  }
}

TEST(EmgMapping, AFlatTopAtAnEndGoesOnWithItsOneSlope) {
  Eigen::VectorXd times;
  const Eigen::RowVectorXd wave = clippedWave(0.7, times);
  const Eigen::RowVectorXd first = flatTops(times.tail(51), wave.tail(51));
  const Eigen::RowVectorXd second = flatTops(times.head(51), wave.head(51));
  EXPECT_NEAR((first - second.reverse()).cwiseAbs().maxCoeff(), 0, 1e-12);
  EXPECT_NEAR(second[50], 0.3, 0.06);
}

TEST(EmgMapping, RecordsThatDoNotSaturateLackNothing) {
  Eigen::VectorXd times;
  EXPECT_EQ(flatTops(times, clippedWave(1.5, times)).maxCoeff(), 0);
  EXPECT_EQ(flatTops(times, Eigen::RowVectorXd::Constant(101, 0.2)).maxCoeff(), 0);
  EXPECT_EQ(flatTops(times, Eigen::RowVectorXd::Zero(101)).maxCoeff(), 0);
  EXPECT_EQ(flatTops({}, {}).size(), 0);
}

TEST(EmgMapping, ASaturatedRecordIsFilledUpWithDerivatives) {
  Eigen::VectorXd times;
  Eigen::MatrixXd u(101, 2);
  u.col(0) = clippedWave(0.6, times).transpose();
  u.col(1).setConstant(0.1);
  const ExcitationSignal record({times.data(), times.data() + times.size()}, u);
  const auto filled = [&](double size) {
    return drivenExcitation(record, muscles, {.gain = {{"A", 0.8}}, .saturation = {{"A", size}}});
  };
  EXPECT_NEAR(at(filled(1), 0.5)[0], 0.8, 0.05);
  EXPECT_EQ(at(filled(1), 0.1), at(filled(0), 0.1));
  const EmgDerivatives d =
      emgDerivatives(record, muscles, {.gain = {{"A", 0.8}}, .saturation = {{"A", 0.5}}});
  const double h = 1e-5;
  for (const int k : {10, 41, 50, 55}) {
    const double slope = (at(filled(0.5 + h), times[k]) - at(filled(0.5 - h), times[k]))[0];
    EXPECT_NEAR(d.signal(0, k) * flatTops(times, d.rows.row(0))[k], slope / (2 * h), 1e-9) << k;
  }
}

TEST(EmgMapping, FatigueTakesTheShareThatTheWorkDoneHasUsedUp) {
  EmgMapping mapping;
  mapping.fatigue = 0.4;
  mapping.fatigueTime = 0.7;
  const ExcitationSignal driven = drivenExcitation(signal(), muscles, mapping);
  EXPECT_EQ(at(driven, 0), at(signal(), 0));
  EXPECT_NEAR(at(driven, 1)[0], 0.5 * (1 - 0.4 * (1 - std::exp(-0.3 / 0.7))), 1e-15);
  EXPECT_NEAR(at(driven, 2)[0], 0.3 * (1 - 0.4 * (1 - std::exp(-0.7 / 0.7))), 1e-15);
}

TEST(EmgMapping, DerivativesOfTiredMusclesMatchDifferences) {
  const auto rows = [](double gain, double A, double o, double share, double time) {
    EmgMapping mapping{{{"A", gain}}, 0, A, {{"A", o}}};
    mapping.fatigue = share;
    mapping.fatigueTime = time;
    const ExcitationSignal driven = drivenExcitation(signal(), muscles, mapping);
    Eigen::RowVectorXd u(3);
    for (int k = 0; k < 3; ++k) u[k] = at(driven, k)[0];
    return u;
  };
  EmgMapping mapping{{{"A", 0.8}}, 0, -1, {{"A", 0.01}}};
  mapping.fatigue = 0.4;
  mapping.fatigueTime = 0.7;
  const EmgDerivatives d = emgDerivatives(signal(), muscles, mapping);
  const double h = 1e-5;
  const auto difference = [&](double g, double A, double o, double s, double t) {
    return Eigen::RowVectorXd((rows(0.8 + g, -1 + A, 0.01 + o, 0.4 + s, 0.7 + t) -
                               rows(0.8 - g, -1 - A, 0.01 - o, 0.4 - s, 0.7 - t)) /
                              (2 * h));
  };
  const auto error = [](const Eigen::RowVectorXd& a, const Eigen::RowVectorXd& b) {
    return (a - b).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(error(d.tired(0, d.gain.row(0)), difference(h, 0, 0, 0, 0)), 1e-9);
  EXPECT_LT(error(d.tired(0, d.nonlinearity.row(0)), difference(0, h, 0, 0, 0)), 1e-9);
  EXPECT_LT(error(d.tired(0, -d.signal.row(0)), difference(0, 0, h, 0, 0)), 1e-9);
  EXPECT_LT(error(d.fatigue.row(0), difference(0, 0, 0, h, 0)), 1e-9);
  EXPECT_LT(error(d.fatigueTime.row(0), difference(0, 0, 0, 0, h)), 1e-9);
}

TEST(EmgMapping, RefusesWhatBreaksItsRules) {
  const auto refused = [](const EmgMapping& mapping, const char* words) {
    support::throwsSaying([&] { drivenExcitation(signal(), muscles, mapping); }, words);
  };
  refused({{{"C", 1}}, 0, 0}, "EMG gain of 'C': no such muscle moves");
  refused({{{"A", -1}}, 0, 0}, "EMG gain of 'A' = -1, must be ≥ 0");
  refused({{}, std::nan(""), 0}, "EMG delay = nan s, must be finite");
  refused({{}, 0, std::nan("")}, "EMG nonlinearity = nan, must be −6 to 6");
  EmgMapping tired;
  tired.fatigue = 1.1;
  refused(tired, "EMG fatigue φ = 1.1, must be −1 to 1");
  tired.fatigue = 0.1;
  tired.fatigueTime = 0;
  refused(tired, "T = 0 s, must be > 0");
}

}  // namespace
}  // namespace bio
