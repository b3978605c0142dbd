#include "bio/emg/emg_stages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "support/numbers.h"

namespace {

using std::numbers::pi;
using testing::HasSubstr;
using testing::ThrowsMessage;
constexpr double rate = 1000;
using support::nan;

Eigen::VectorXd sineAt(double f, Eigen::Index n) {
  return Eigen::VectorXd::NullaryExpr(
      n, [&](Eigen::Index i) { return std::sin(2 * pi * f * static_cast<double>(i) / rate); });
}

double amplitude(const Eigen::VectorXd& x) {
  const Eigen::Index n = x.size();
  return std::sqrt(2 * x.segment(n / 3, n / 3).squaredNorm() / static_cast<double>(n / 3));
}

TEST(EmgStages, BandPassKeepsTheBandAndHalvesThePowerAtItsEdges) {
  const bio::BandPassOptions options{.low = 20, .high = 400, .order = 2};
  EXPECT_NEAR(amplitude(bio::bandPassed(sineAt(100, 9000), rate, options)), 1, 1e-3);
  EXPECT_NEAR(amplitude(bio::bandPassed(sineAt(20, 9000), rate, options)), std::sqrt(0.5), 1e-3);
  EXPECT_NEAR(amplitude(bio::bandPassed(sineAt(400, 9000), rate, options)), std::sqrt(0.5), 1e-3);
  EXPECT_LT(amplitude(bio::bandPassed(sineAt(2, 9000), rate, options)), 1e-3);
}

TEST(EmgStages, NotchCutsTheLineAndAsManyMultiplesAsAskedFor) {
  const bio::NotchOptions two{.lines = {60}, .harmonics = 2, .width = 4, .order = 2};
  EXPECT_LT(amplitude(bio::notched(sineAt(60, 12000), rate, two)), 0.01);
  EXPECT_LT(amplitude(bio::notched(sineAt(120, 12000), rate, two)), 0.01);
  EXPECT_NEAR(amplitude(bio::notched(sineAt(180, 12000), rate, two)), 1, 1e-3);
  EXPECT_NEAR(amplitude(bio::notched(sineAt(62, 12000), rate, two)), std::sqrt(0.5), 0.01);
  // multiples above half the rate are left out, the line itself is not
  const bio::NotchOptions many{.lines = {60}, .harmonics = 50, .width = 4, .order = 2};
  EXPECT_LT(amplitude(bio::notched(sineAt(480, 12000), rate, many)), 0.01);
  EXPECT_THAT([] { bio::notched(sineAt(60, 100), rate, {.lines = {600}}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("599 Hz")));
  EXPECT_THAT([] { bio::notched(sineAt(60, 100), rate, {.lines = {60}, .harmonics = 0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("harmonics 0")));
  EXPECT_THAT([] { bio::notched(sineAt(60, 100), rate, {.lines = {60}, .width = nan}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("width nan")));
}

// The mean of a rectified sine is 2/π.
TEST(EmgStages, EnvelopeOfARectifiedSineIsTwoOverPi) {
  const Eigen::VectorXd e =
      bio::envelope(sineAt(90, 9000).cwiseAbs(), rate, {.cutoff = 3, .order = 2});
  EXPECT_NEAR(e[4500], 2 / pi, 1e-3);
}

TEST(EmgStages, PercentileIsExactAtTheSortedValuesAndLinearBetween) {
  const Eigen::VectorXd x = Eigen::Vector<double, 5>(40, 0, 30, 10, 20);
  EXPECT_DOUBLE_EQ(bio::percentile(x, 0), 0);
  EXPECT_DOUBLE_EQ(bio::percentile(x, 50), 20);
  EXPECT_DOUBLE_EQ(bio::percentile(x, 60), 24);
  EXPECT_DOUBLE_EQ(bio::percentile(x, 100), 40);
  EXPECT_THROW(bio::percentile(x, 101), std::domain_error);
  EXPECT_THROW(bio::percentile(x, nan), std::domain_error);
  EXPECT_THROW(bio::percentile(Eigen::VectorXd(), 50), std::domain_error);
}

TEST(EmgStages, ClippingCountsWhatItChanges) {
  const bio::Clipped c = bio::clippedToUnit(Eigen::Vector4d(-0.5, 0.25, 1, 2.5));
  EXPECT_EQ(c.values, Eigen::Vector4d(0, 0.25, 1, 1));
  EXPECT_DOUBLE_EQ(c.fractionBelow, 0.25);
  EXPECT_DOUBLE_EQ(c.fractionAbove, 0.25);
}

TEST(ShapedExcitation, KeepsItsEndsAndRaisesWeakSignals) {
  for (const double a : {-3.0, -1.5, -1e-3, -1e-8, 0.0}) {
    EXPECT_DOUBLE_EQ(bio::shapedExcitation(0, a), 0);
    EXPECT_DOUBLE_EQ(bio::shapedExcitation(1, a), 1);
  }
  // (e^{-1} − 1)/(e^{-2} − 1) = 1/(1 + e^{-1})
  EXPECT_NEAR(bio::shapedExcitation(0.5, -2), 1 / (1 + std::exp(-1)), 1e-15);
}

TEST(ShapedExcitation, ApproachesTheIdentitySmoothlyAsItsFactorVanishes) {
  EXPECT_DOUBLE_EQ(bio::shapedExcitation(0.3, 0), 0.3);
  // the series and the exponentials meet at −1e-6: measured jump 5e-17
  const double above = bio::shapedExcitation(0.3, -0.99999e-6);
  const double below = bio::shapedExcitation(0.3, -1.00001e-6);
  EXPECT_NEAR(below - above, 0.5 * 0.3 * 0.7 * 2e-11, 1e-14);
}

TEST(ShapedExcitation, RefusesWhatIsOutsideItsDomain) {
  EXPECT_THAT([] { bio::shapedExcitation(0.5, -3.5); },
              ThrowsMessage<std::domain_error>(HasSubstr("A = -3.5")));
  EXPECT_THROW(bio::shapedExcitation(0.5, 0.1), std::domain_error);
  EXPECT_THROW(bio::shapedExcitation(0.5, nan), std::domain_error);
  EXPECT_THROW(bio::shapedExcitation(nan, -1), std::domain_error);
  EXPECT_THROW(bio::shapedExcitation(1.01, -1), std::domain_error);
}

TEST(SampledAt, IsLinearBetweenSamplesAndHoldsTheEnds) {
  const Eigen::Vector3d x(1, 3, 2);
  const Eigen::VectorXd y =
      bio::sampledAt(x, 10, 5, Eigen::Vector<double, 6>(0, 5, 5.05, 5.1, 5.175, 9));
  const Eigen::Vector<double, 6> expected(1, 1, 2, 3, 2.25, 2);
  EXPECT_LT((y - expected).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(CheckWithoutGaps, NamesChannelTimeAndLengthOfTheGap) {
  bio::Channel channel{"biceps", "mV", 100, 2, Eigen::VectorXd::Zero(50)};
  EXPECT_NO_THROW(bio::checkWithoutGaps(channel));
  channel.values.segment(30, 4).setConstant(nan);
  EXPECT_THAT([&] { bio::checkWithoutGaps(channel); },
              ThrowsMessage<std::invalid_argument>(testing::AllOf(
                  HasSubstr("'biceps'"), HasSubstr("2.3000 s"), HasSubstr("4 samples"))));
  channel.values = Eigen::VectorXd::Zero(1);
  EXPECT_THAT([&] { bio::checkWithoutGaps(channel); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("1 samples")));
}

}  // namespace
