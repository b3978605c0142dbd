#include "bio/calibration/calibrate.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "support/numbers.h"
#include "support/synthetic_elbow.h"

namespace bio {
namespace {

using fixtures::SyntheticElbow;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

using support::degree;

const SyntheticElbow& elbow() {
  static const SyntheticElbow one;
  return one;
}

CalibrationOptions options(std::vector<std::string> names) {
  CalibrationOptions result;
  result.trials.parameters = std::move(names);
  result.priors = false;
  return result;
}

Calibration run(const std::vector<Trial>& trials, const CalibrationOptions& options,
                const std::vector<Trial>& heldOut = {}) {
  const TrialSet training(elbow().model, SyntheticElbow::options(), trials, options.trials);
  if (heldOut.empty()) return calibrate(training, nullptr, options);
  TrialSetOptions others = options.trials;
  others.ownStart = false;
  const TrialSet test(elbow().model, SyntheticElbow::options(), heldOut, others);
  return calibrate(training, &test, options);
}

const std::map<std::string, double> kTruth = {{"hand.mass", 0.7}, {"TRI.radius", 0.0175}};

TEST(Calibrate, FindsTheTruthFromExactMotions) {
  CalibrationOptions asked = options({"hand.mass", "TRI.radius"});
  asked.noise = 0.5 * degree;
  const Calibration found =
      run({elbow().trial("curl_slow", 1.5, kTruth), elbow().trial("curl_fast", 1, kTruth)}, asked);
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(found.parameters[0].value, 0.7, 1e-5);
  EXPECT_NEAR(found.parameters[1].value, 0.0175, 1e-6);
  EXPECT_EQ(findWrapObject(found.calibrated->model, "TRI").radius, found.parameters[1].value);
  EXPECT_EQ(findBody(found.calibrated->model, "hand").mass, found.parameters[0].value);
}

TEST(Calibrate, TellsTheNoiseAndItsOwnUncertainty) {
  const Trial exact = elbow().trial("curl_slow", 2, kTruth, 30, 2);
  const Calibration found =
      run({SyntheticElbow::noisy(exact, 0.5, 1)}, options({"hand.mass", "TRI.radius"}));
  EXPECT_NEAR(found.noise.sd / degree, 0.5, 0.05);
  EXPECT_LT(found.noise.correlationTime, 1.5);
  EXPECT_NEAR(found.reducedChiSquare, 1, 0.01);
  // the bound, from differences of whole simulations at the truth
  const auto motion = [&](double mass, double radius) -> Eigen::VectorXd {
    return elbow()
        .trial("curl_slow", 2, {{"hand.mass", mass}, {"TRI.radius", radius}}, 30, 2)
        .measured[0]
        .values;
  };
  Eigen::MatrixXd gamma(exact.measured[0].values.size(), 2);
  gamma.col(0) = (motion(0.701, 0.0175) - motion(0.699, 0.0175)) / 0.002;
  gamma.col(1) = (motion(0.7, 0.01755) - motion(0.7, 0.01745)) / 0.0001;
  const Eigen::Matrix2d bound =
      (gamma.transpose() * gamma).inverse() * std::pow(found.noise.effective, 2);
  for (std::size_t i = 0; i < 2; ++i) {
    const CalibratedParameter& one = found.parameters[i];
    const auto k = static_cast<Eigen::Index>(i);
    EXPECT_TRUE(one.identifiable);
    EXPECT_NEAR(one.sd / std::sqrt(bound(k, k)), 1, 0.05) << one.asked.name;
    EXPECT_NEAR(one.lower, one.value - 1.959964 * one.sd, 1e-9);
    EXPECT_NEAR(one.upper, one.value + 1.959964 * one.sd, 1e-9);
    EXPECT_LT(std::abs(one.value - kTruth.at(one.asked.name)), 4 * one.sd);
  }
  EXPECT_NEAR(found.correlation(0, 1), bound(0, 1) / std::sqrt(bound(0, 0) * bound(1, 1)), 0.05);
}

TEST(Calibrate, PredictsTrialsHeldOut) {
  const Calibration found =
      run({SyntheticElbow::noisy(elbow().trial("curl_slow", 1.5, kTruth), 0.5, 2)},
          options({"hand.mass", "TRI.radius"}),
          {SyntheticElbow::noisy(elbow().trial("curl_fast", 1.5, kTruth), 0.5, 3)});
  const Eigen::MatrixXd held =
      SyntheticElbow::noisy(elbow().trial("curl_fast", 1.5, kTruth), 0.5, 3)
          .measured[0]
          .values.transpose();
  const auto rms = [&](const Eigen::MatrixXd& y) {
    return (y - held).norm() / std::sqrt(static_cast<double>(y.size())) / degree;
  };
  EXPECT_GT(rms(found.heldOutBefore), 2);
  EXPECT_NEAR(rms(found.heldOutAfter), 0.5, 0.1);  // the noise
}

TEST(Calibrate, EstimatesStartsThatWereMeasuredBadly) {
  Trial shifted = elbow().trial("curl_slow", 1.5, {{"hand.mass", 0.7}}, 30, 2);
  shifted.measured[0].values[0] += 2 * degree;  // where the simulation starts
  CalibrationOptions asked = options({"hand.mass"});
  asked.noise = 0.2 * degree;
  const double without = std::abs(run({shifted}, asked).parameters[0].value - 0.7);
  asked.trials.ownStart = true;
  const Calibration with = run({shifted}, asked);
  EXPECT_LT(std::abs(with.parameters[0].value - 0.7), 0.3 * without);
  ASSERT_EQ(with.parameters.size(), 3u);
  EXPECT_TRUE(with.parameters[1].ofTrial);
  EXPECT_NEAR(with.parameters[1].value / degree, 30, 0.3);
}

// About the hinge only the sum of two inertias acts.
TEST(Calibrate, RefusesAnIntervalForAPairThatCannotBeToldApart) {
  CalibrationOptions asked = options({"hand.inertia.zz", "ulna.inertia.zz"});
  asked.priors = true;
  asked.noise = 0.001 * degree;
  asked.prior["hand.inertia.zz"] = {0.001, 0.01};
  asked.prior["ulna.inertia.zz"] = {0.005, 0.01};
  asked.bounds["hand.inertia.zz"] = {0, 0.1};
  asked.bounds["ulna.inertia.zz"] = {0, 0.1};
  const Calibration found =
      run({elbow().trial("curl_fast", 1.5, {{"hand.inertia.zz", 0.003}, {"hand.mass", 0.5819}})},
          asked);
  ASSERT_TRUE(found.converged);
  for (const CalibratedParameter& one : found.parameters) {
    EXPECT_FALSE(one.identifiable) << one.asked.name;
    EXPECT_TRUE(std::isnan(one.sd));
    EXPECT_TRUE(std::isnan(one.lower));
    EXPECT_LT(one.determinacy.boundAlone, 0.01);
    EXPECT_GT(one.determinacy.bound, 0.01);
  }
  EXPECT_THAT(found.parameters[0].why,
              HasSubstr("hand.inertia.zz is confounded with ulna.inertia.zz"));
  EXPECT_LT(found.correlation(0, 1), -0.99);
}

TEST(Calibrate, SaysThatAParameterRestsOnItsBound) {
  CalibrationOptions asked = options({"hand.mass", "TRI.radius"});
  asked.noise = 0.5 * degree;
  asked.bounds["hand.mass"] = {0.5, 0.698};
  const Calibration found = run({elbow().trial("curl_slow", 1.5, kTruth)}, asked);
  const CalibratedParameter &mass = found.parameters[0], &radius = found.parameters[1];
  EXPECT_EQ(mass.value, 0.698);
  EXPECT_TRUE(mass.atBound);
  EXPECT_FALSE(mass.identifiable);
  EXPECT_TRUE(std::isnan(mass.sd));
  EXPECT_THAT(mass.why, HasSubstr("hand.mass is at its upper bound (0.698 kg)"));
  EXPECT_TRUE(radius.identifiable);
  // with the mass held the radius is as well known as if it were alone
  EXPECT_NEAR(radius.sd, radius.determinacy.boundAlone, 1e-12);
}

TEST(Calibrate, WeighsAPrior) {
  CalibrationOptions asked = options({"hand.mass"});
  asked.noise = 20 * degree;
  const Trial trial = elbow().trial("curl_slow", 1, kTruth);
  const CalibratedParameter free = run({trial}, asked).parameters[0];
  asked.prior["hand.mass"] = {0.6, free.determinacy.bound};
  const CalibratedParameter held = run({trial}, asked).parameters[0];
  EXPECT_NEAR(held.value, 0.5 * (0.6 + free.value), 0.1 * std::abs(free.value - 0.6));
  EXPECT_NEAR(held.determinacy.bound / (held.asked.prior->sd), 1, 0.1);
}

TEST(Calibrate, ARobustLossWithstandsOutliers) {
  Trial trial =
      SyntheticElbow::noisy(elbow().trial("curl_slow", 1.5, {{"hand.mass", 0.7}}, 30, 2), 0.3, 5);
  for (Eigen::Index k = 20; k < trial.measured[0].values.size(); k += 12) {
    trial.measured[0].values[k] += 25 * degree;
  }
  CalibrationOptions asked = options({"hand.mass"});
  asked.trials.initial = {{"elbow_flexion", 30 * degree}};
  const auto error = [&](info::RobustLoss::Kind kind) {
    asked.loss.kind = kind;
    const Calibration found = run({trial}, asked);
    EXPECT_TRUE(found.converged);
    return std::abs(found.parameters[0].value - 0.7);
  };
  const double gaussian = error(info::RobustLoss::Kind::gaussian);
  EXPECT_GT(gaussian, 0.01);
  EXPECT_LT(error(info::RobustLoss::Kind::huber), 0.3 * gaussian);
  EXPECT_LT(error(info::RobustLoss::Kind::student), 0.3 * gaussian);
}

TEST(Calibrate, IntervalsOfProfileAndBootstrapAgreeWithTheFisherMatrix) {
  CalibrationOptions asked = options({"hand.mass", "TRI.radius"});
  asked.profile = {"TRI.radius"};
  asked.bootstrap = 60;
  const Calibration found =
      run({SyntheticElbow::noisy(elbow().trial("curl_slow", 2, kTruth, 30, 2), 0.2, 6)}, asked);
  EXPECT_GE(found.bootstrapConverged, 58);
  const CalibratedParameter &mass = found.parameters[0], &radius = found.parameters[1];
  EXPECT_FALSE(mass.profile);
  ASSERT_TRUE(radius.profile);
  EXPECT_NEAR(radius.profile->lower, radius.lower, 0.3 * radius.sd);
  EXPECT_NEAR(radius.profile->upper, radius.upper, 0.3 * radius.sd);
  EXPECT_NEAR(radius.bootstrapSd / radius.sd, 1, 0.35);
  EXPECT_NEAR(mass.bootstrapSd / mass.sd, 1, 0.35);
  EXPECT_LT(mass.bootstrapLower, mass.bootstrapUpper);
}

// Slow waves that the model cannot make widen the intervals.
TEST(Calibrate, CorrelatedResidualsCountForLess) {
  Trial trial =
      SyntheticElbow::noisy(elbow().trial("curl_slow", 2, {{"hand.mass", 0.7}}, 30, 2), 0.1, 7);
  const CalibratedParameter white = run({trial}, options({"hand.mass"})).parameters[0];
  Eigen::VectorXd& y = trial.measured[0].values;
  for (Eigen::Index k = 1; k < y.size(); ++k) {
    y[k] += 0.5 * degree * std::sin(12 * trial.measured[0].times[k]);
  }
  const Calibration found = run({trial}, options({"hand.mass"}));
  EXPECT_GT(found.noise.correlationTime, 4);
  EXPECT_GT(found.parameters[0].sd, 4 * white.sd);
  EXPECT_NEAR(found.noise.effective, found.noise.sd * std::sqrt(found.noise.correlationTime),
              1e-12);
}

TEST(Calibrate, RefusesBoundsBeyondTheDomainOfANumber) {
  const std::vector<Trial> trials = {elbow().trial("curl_slow", 0.3)};
  const auto fails = [&](const char* name, double lower, double upper, const char* message) {
    CalibrationOptions asked = options({name});
    asked.bounds[name] = {lower, upper};
    EXPECT_THAT([&] { run(trials, asked); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(message)));
  };
  fails("emg.nonlinearity", -8, 0,
        "lower bound of emg.nonlinearity = -8 is outside of its domain: EMG nonlinearity");
  fails("emg.nonlinearity", -1, 7, "upper bound of emg.nonlinearity = 7");
  fails("BRA.max_isometric_force", -3000, 3000, "lower bound of BRA.max_isometric_force = -3000 N");
  fails("BRA.optimal_fiber_length", -1, 1, "lower bound of BRA.optimal_fiber_length = -1 m");
  fails("BRA.pennation_angle", 0, 2, "upper bound of BRA.pennation_angle = 2 rad");
  fails("emg.BRA.gain", -1, 1, "lower bound of emg.BRA.gain = -1");
  fails("hand.mass", -1, 1, "lower bound of hand.mass = -1 kg");
  fails("TRI.radius", -0.01, 0.017, "lower bound of TRI.radius = -0.01 m");
  CalibrationOptions edge = options({"emg.nonlinearity"});
  edge.bounds["emg.nonlinearity"] = {-6, 6};
  edge.noise = 20 * degree;
  EXPECT_EQ(run(trials, edge).failure, "");
}

// The triceps touches its cylinder in flexion only.
TEST(Calibrate, KeepsAParameterWithoutEffectAndSaysSo) {
  CalibrationOptions asked = options({"hand.mass", "TRI.radius"});
  asked.noise = 0.5 * degree;
  const Calibration found = run({elbow().trial("curl_slow", 0.6, kTruth)}, asked);
  EXPECT_TRUE(found.converged);
  EXPECT_TRUE(found.parameters[0].identifiable);
  EXPECT_FALSE(found.parameters[1].identifiable);
  EXPECT_EQ(found.parameters[1].value, 0.016);
  EXPECT_EQ(found.parameters[1].why, "TRI.radius has no effect on the measured angles");
}

TEST(Calibrate, WithoutASimulationSaysWhy) {
  CalibrationOptions asked = options({"hand.mass"});
  asked.trials.simulation.maxIterations = 1;
  asked.trials.simulation.maxHalvings = 0;
  const Calibration found = run({elbow().trial("curl_fast", 0.5)}, asked);
  EXPECT_THAT(found.failure, HasSubstr("curl_fast.sto: the simulation fails at the start values"));
  EXPECT_TRUE(found.parameters.empty());
}

TEST(Calibrate, StopsWhenToldTo) {
  CalibrationOptions asked = options({"hand.mass", "TRI.radius"});
  double last = -1;
  asked.progress = [&](double share) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1);
    last = share;
    return false;
  };
  const Calibration found = run({elbow().trial("curl_slow", 1.5, kTruth)}, asked);
  EXPECT_FALSE(found.complete);
  EXPECT_FALSE(found.converged);
}

TEST(Calibrate, RefusesOptionsThatMakeNoSense) {
  const std::vector<Trial> trials = {elbow().trial("curl_slow", 0.3)};
  const auto fails = [&](const CalibrationOptions& asked, const char* message) {
    EXPECT_THAT([&] { run(trials, asked); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(message)));
  };
  const CalibrationOptions good = options({"hand.mass"});
  CalibrationOptions bad = good;
  bad.noise = 0;
  fails(bad, "noise");
  bad = good;
  bad.starts = 0;
  fails(bad, "starts");
  bad = good;
  bad.bootstrap = 3;
  fails(bad, "bootstrap");
  bad = good;
  bad.confidence = 1;
  fails(bad, "confidence");
  bad = good;
  bad.bounds["hand.mass"] = {1, 2};
  fails(bad, "hand.mass");
  bad = good;
  bad.bounds["TRI.radius"] = {0, 1};
  fails(bad, "bounds of 'TRI.radius': is not among the parameters");
  bad = good;
  bad.prior["hand.mass"] = {0.5, 0};
  fails(bad, "hand.mass");
  bad = good;
  bad.profile = {"TRI.radius"};
  fails(bad, "profile of 'TRI.radius'");
  bad = good;
  bad.loss = {info::RobustLoss::Kind::huber, -1};
  fails(bad, "Huber");
  bad = options({"initial.elbow_flexion"});
  const TrialSet one(elbow().model, SyntheticElbow::options(), trials, bad.trials);
  EXPECT_THROW(calibrate(one, &one, bad), std::invalid_argument);
}

}  // namespace
}  // namespace bio
