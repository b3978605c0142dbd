#include "bio/emg/filter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

namespace {

using bio::Filter;
using bio::Passes;
using std::numbers::pi;
constexpr double fs = 1000;

double w(double f) {
  return std::tan(pi * f / fs);
}
double butterworth(double omega, int n) {
  return 1 / std::sqrt(1 + std::pow(omega * omega, n));
}
// H at a frequency [Hz] of one pass: z = exp(2πi f/fs).
std::complex<double> frequencyResponse(const Filter& filter, double frequency) {
  const std::complex<double> inverse = std::polar(1.0, -2 * pi * frequency / filter.sampleRate);
  std::complex<double> out = 1;
  for (const bio::SecondOrderSection& s : filter.sections) {
    out *= (s.b0 + inverse * (s.b1 + inverse * s.b2)) / (1.0 + inverse * (s.a1 + inverse * s.a2));
  }
  return out;
}
double gain(const Filter& filter, double f) {
  return std::abs(frequencyResponse(filter, f));
}
double dB(double g) {
  return 20 * std::log10(g);
}

Eigen::VectorXd sine(double f, Eigen::Index n, double phase = 0) {
  return Eigen::VectorXd::NullaryExpr(n, [&](Eigen::Index i) {
    return std::sin(2 * pi * f * static_cast<double>(i) / fs + phase);
  });
}

Eigen::VectorXd noise(Eigen::Index n, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> draw(-1, 1);
  return Eigen::VectorXd::NullaryExpr(n, [&](Eigen::Index) { return draw(engine); });
}

std::string messageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

// The analog prototype's closed form, read at the prewarped frequency, is the digital gain exactly.
TEST(Butterworth, HasTheClosedFormGainOfItsPrototypeAtEveryFrequencyAndOrder) {
  for (int n = 1; n <= 10; ++n) {
    const Filter low = bio::butterworthLowPass(n, 80, fs);
    const Filter pass = bio::butterworthBandPass(n, 40, 200, fs);
    const Filter stop = bio::butterworthBandStop(n, 40, 200, fs);
    for (double f = 1.5; f < 500; f += 7.25) {
      const double band = (w(f) * w(f) - w(40) * w(200)) / ((w(200) - w(40)) * w(f));
      // measured 7e-15
      EXPECT_NEAR(gain(low, f), butterworth(w(f) / w(80), n), 1e-13) << n << ' ' << f;
      EXPECT_NEAR(gain(pass, f), butterworth(band, n), 1e-13) << n << ' ' << f;
      EXPECT_NEAR(gain(stop, f), butterworth(1 / band, n), 1e-13) << n << ' ' << f;
    }
  }
}

TEST(Butterworth, LosesThreeDecibelsAtItsEdgesAfterTheStatedNumberOfPasses) {
  const double half = std::sqrt(0.5);
  for (int n = 1; n <= 10; ++n) {
    for (const Passes passes : {Passes::once, Passes::forwardAndBackward}) {
      const double power = passes == Passes::once ? 1 : 2;
      const Filter low = bio::butterworthLowPass(n, 6, fs, passes);
      const Filter pass = bio::butterworthBandPass(n, 20, 450, fs, passes);
      const Filter stop = bio::butterworthBandStop(n, 48, 52, fs, passes);
      EXPECT_NEAR(std::pow(gain(low, 6), power), half, 1e-8);
      for (double edge : {20.0, 450.0}) EXPECT_NEAR(std::pow(gain(pass, edge), power), half, 1e-8);
      for (double edge : {48.0, 52.0}) EXPECT_NEAR(std::pow(gain(stop, edge), power), half, 1e-8);
    }
  }
}

// 20·n dB per decade far in the stop-band, n from the order (prewarped frequencies).
TEST(Butterworth, FallsByItsOrderInTheStopBand) {
  for (int n = 1; n <= 6; ++n) {
    const Filter low = bio::butterworthLowPass(n, 5, fs);
    const double decades = std::log10(w(400) / w(100));
    EXPECT_NEAR((dB(gain(low, 100)) - dB(gain(low, 400))) / decades, 20.0 * n, 0.05 * n);
  }
}

TEST(Butterworth, BlocksTheMiddleOfANotchAndIsFlatAwayFromIt) {
  const Filter notch = bio::butterworthBandStop(2, 49, 51, fs);
  const double centre = fs / pi * std::atan(std::sqrt(w(49) * w(51)));
  EXPECT_LT(gain(notch, centre), 1e-10);
  EXPECT_NEAR(gain(notch, 30), 1, 1e-4);
  EXPECT_NEAR(gain(notch, 70), 1, 1e-4);
}

// Hand-computed: order 1 at fs/4 is (1 + z⁻¹)/2; order 2 at fs/4 is (1 + z⁻¹)²/((2+√2) + (2−√2)
// z⁻²).
TEST(Butterworth, HasTheCoefficientsWorkedOutByHandAtAQuarterOfTheRate) {
  const bio::SecondOrderSection one = bio::butterworthLowPass(1, 250, fs).sections.at(0);
  EXPECT_NEAR(one.b0, 0.5, 1e-15);
  EXPECT_NEAR(one.b1, 0.5, 1e-15);
  EXPECT_NEAR(one.a1, 0, 1e-15);
  const bio::SecondOrderSection two = bio::butterworthLowPass(2, 250, fs).sections.at(0);
  EXPECT_NEAR(two.b0, 1 / (2 + std::sqrt(2)), 1e-15);
  EXPECT_NEAR(two.b1, 2 / (2 + std::sqrt(2)), 1e-15);
  EXPECT_NEAR(two.a1, 0, 1e-15);
  EXPECT_NEAR(two.a2, (2 - std::sqrt(2)) / (2 + std::sqrt(2)), 1e-15);
}

TEST(Butterworth, IsStableUpToTheHighestOrderAndTheNarrowestUsualBand) {
  for (const Filter& filter :
       {bio::butterworthLowPass(10, 0.5, 2000), bio::butterworthBandPass(10, 1, 999, 2000),
        bio::butterworthBandStop(10, 49.9, 50.1, 2000)}) {
    for (const bio::SecondOrderSection& s : filter.sections) {
      EXPECT_LT(std::abs(s.a2), 1);
      EXPECT_LT(std::abs(s.a1), 1 + s.a2);
    }
  }
}

TEST(Butterworth, NamesOrderEdgeOrRateThatBreaksItsRule) {
  using testing::HasSubstr;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THAT(messageOf([] { bio::butterworthLowPass(0, 10, fs); }), HasSubstr("order 0"));
  EXPECT_THAT(messageOf([] { bio::butterworthLowPass(11, 10, fs); }), HasSubstr("order 11"));
  EXPECT_THAT(messageOf([] { bio::butterworthLowPass(2, 500, fs); }), HasSubstr("500 Hz"));
  EXPECT_THAT(messageOf([] { bio::butterworthLowPass(2, 0, fs); }), HasSubstr("0 Hz"));
  EXPECT_THAT(messageOf([&] { bio::butterworthLowPass(2, nan, fs); }), HasSubstr("nan Hz"));
  EXPECT_THAT(messageOf([&] { bio::butterworthLowPass(2, 10, nan); }),
              HasSubstr("sample rate nan"));
  EXPECT_THAT(messageOf([&] { bio::butterworthLowPass(2, 10, infinity); }),
              HasSubstr("sample rate inf"));
  EXPECT_THAT(messageOf([] { bio::butterworthBandPass(2, 20, 600, fs); }),
              HasSubstr("upper band edge 600 Hz"));
  EXPECT_THAT(messageOf([] { bio::butterworthBandStop(2, -1, 60, fs); }),
              HasSubstr("lower band edge -1 Hz"));
  EXPECT_THAT(messageOf([] { bio::butterworthBandStop(2, 60, 50, fs); }),
              HasSubstr("from 60 Hz to 50 Hz"));
}

TEST(FilterZeroPhase, PassesAConstantWithoutATransient) {
  const Eigen::VectorXd constant = Eigen::VectorXd::Constant(50, -3.25);
  for (const bio::Reflection reflection : {bio::Reflection::odd, bio::Reflection::even}) {
    const Eigen::VectorXd low =
        bio::filterZeroPhase(bio::butterworthLowPass(5, 3, fs), constant, reflection);
    EXPECT_LT((low - constant).cwiseAbs().maxCoeff(), 1e-9);
    const Eigen::VectorXd band =
        bio::filterZeroPhase(bio::butterworthBandPass(3, 3, 40, fs), constant, reflection);
    EXPECT_LT(band.cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(FilterZeroPhase, ScalesASineByTheSquaredGainAndDoesNotMoveIt) {
  for (const Filter& filter :
       {bio::butterworthLowPass(2, 20, fs), bio::butterworthLowPass(3, 20, fs),
        bio::butterworthBandPass(2, 10, 60, fs), bio::butterworthBandStop(2, 18, 24, fs)}) {
    const double g = gain(filter, 15);
    const Eigen::VectorXd y = bio::filterZeroPhase(filter, sine(15, 6000));
    EXPECT_LT((y - g * g * sine(15, 6000)).segment(2000, 2000).cwiseAbs().maxCoeff(), 1e-6);
  }
}

// Odd reflection continues a straight line: nothing happens at the ends.
TEST(FilterZeroPhase, LeavesAStraightLineAsItIsUpToBothEnds) {
  const Eigen::VectorXd line = Eigen::VectorXd::LinSpaced(4000, -2, 5);
  const Eigen::VectorXd y = bio::filterZeroPhase(bio::butterworthLowPass(4, 5, fs), line);
  EXPECT_LT((y - line).cwiseAbs().maxCoeff(), 1e-5);  // measured 4e-8
}

// Even reflection continues a level: what alternates about 1 comes out as 1, also at the ends,
// where odd reflection would hold on to the single end value.
TEST(FilterZeroPhase, HoldsTheLevelOfARestlessSignalAtItsEndsWhenReflectedEvenly) {
  const Eigen::VectorXd restless =
      Eigen::VectorXd::NullaryExpr(3000, [](Eigen::Index i) { return i % 2 == 0 ? 0.0 : 2.0; });
  const Filter low = bio::butterworthLowPass(2, 5, fs);
  const Eigen::VectorXd even = bio::filterZeroPhase(low, restless, bio::Reflection::even);
  EXPECT_LT((even.array() - 1).abs().maxCoeff(), 0.02);
  const Eigen::VectorXd odd = bio::filterZeroPhase(low, restless, bio::Reflection::odd);
  EXPECT_LT(odd[0], 0.1);
}

TEST(FilterZeroPhase, TreatsAReversedSignalAsTheReverseOfTheSignal) {
  const Eigen::VectorXd x = noise(5000, 1);
  for (const Filter& filter :
       {bio::butterworthLowPass(4, 6, fs), bio::butterworthBandPass(4, 20, 450, fs)}) {
    const Eigen::VectorXd y = bio::filterZeroPhase(filter, x);
    const Eigen::VectorXd back = bio::filterZeroPhase(filter, x.reverse()).reverse();
    // what is left is the filter's memory, cut at 1e-6 beyond the ends: measured 4e-7
    EXPECT_LT((y - back).cwiseAbs().maxCoeff(), 1e-5);
    EXPECT_GT(y.cwiseAbs().maxCoeff(), 0.05);
  }
}

TEST(FilterZeroPhase, IsLinear) {
  const Filter filter = bio::butterworthBandPass(2, 20, 200, fs);
  const Eigen::VectorXd a = noise(800, 2);
  const Eigen::VectorXd b = noise(800, 3);
  const Eigen::VectorXd sum = bio::filterZeroPhase(filter, 2 * a - 3 * b);
  EXPECT_LT((sum - 2 * bio::filterZeroPhase(filter, a) + 3 * bio::filterZeroPhase(filter, b))
                .cwiseAbs()
                .maxCoeff(),
            1e-11);
}

TEST(FilterZeroPhase, NamesTheSampleThatIsNotFiniteAndTheSignalThatIsTooShort) {
  using testing::HasSubstr;
  const Filter filter = bio::butterworthLowPass(4, 10, fs);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(100);
  x[17] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(messageOf([&] { bio::filterZeroPhase(filter, x); }), HasSubstr("sample 17"));
  EXPECT_THAT(messageOf([&] { bio::filterZeroPhase(filter, Eigen::VectorXd::Zero(12)); }),
              testing::AllOf(HasSubstr("12 samples"), HasSubstr("at least 13")));
  EXPECT_THAT(messageOf([&] { bio::filterZeroPhase(filter, Eigen::VectorXd()); }),
              HasSubstr("0 samples"));
}

}  // namespace
