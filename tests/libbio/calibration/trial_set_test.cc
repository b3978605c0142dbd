#include "bio/calibration/trial_set.h"

#include <gmock/gmock.h>

#include "bio/analysis/replay.h"
#include "support/synthetic_elbow.h"

namespace bio {
namespace {

using fixtures::SyntheticElbow;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const SyntheticElbow& subject() {
  static const SyntheticElbow one;
  return one;
}

TrialSet set(std::vector<std::string> names, std::vector<Trial> trials, bool ownStart = false) {
  TrialSetOptions options;
  options.parameters = std::move(names);
  options.ownStart = ownStart;
  options.simulation.newtonTolerance = 1e-12;
  return {subject().model, SyntheticElbow::options(), std::move(trials), options};
}

// Two trials of different length, three common parameters, two of each trial's own.
TEST(TrialSet, SensitivitiesAreDerivativesOfTheOutputs) {
  const TrialSet trials = set(
      {"TRI.radius", "hand.mass", "emg.BRA.gain"},
      {subject().trial("curl_slow", 1.5, {}, 30), subject().trial("curl_fast", 0.6, {}, 50)}, true);
  ASSERT_EQ(trials.numParameters(), 7u);
  EXPECT_EQ(trials.numCommon(), 3u);
  const auto& parameters = trials.parameters();
  EXPECT_EQ(parameters[3].name, "trial1.initial.elbow_flexion");
  EXPECT_EQ(parameters[6].name, "trial2.initial.elbow_flexion.speed");
  EXPECT_TRUE(parameters[3].prior);
  EXPECT_FALSE(parameters[0].prior);
  Eigen::VectorXd theta(7);
  for (std::size_t i = 0; i < 7; ++i) theta[static_cast<Eigen::Index>(i)] = parameters[i].start;
  theta[1] *= 1.1;
  theta[6] = 0.3;
  const info::Predictor predictor = trials.predictor();
  const info::Prediction at = predictor.withSensitivities(theta);
  EXPECT_EQ(at.outputs, predictor.outputs(theta));
  for (Eigen::Index i = 0; i < 7; ++i) {
    const double h = 1e-4 * trials.priorSds()[i];
    Eigen::VectorXd up = theta, down = theta;
    up[i] += h;
    down[i] -= h;
    const Eigen::VectorXd difference =
        ((predictor.outputs(up) - predictor.outputs(down)) / (2 * h)).transpose();
    const double scale = difference.cwiseAbs().maxCoeff();
    EXPECT_LT((at.gamma.col(i) - difference).cwiseAbs().maxCoeff(), 1e-4 * scale)
        << parameters[static_cast<std::size_t>(i)].name;
  }
  // one trial's start is nothing to the other
  const auto first = trials.series()[0].values.size();
  EXPECT_TRUE((at.gamma.col(3).tail(at.gamma.rows() - first).array() == 0).all());
  EXPECT_TRUE((at.gamma.col(5).head(first).array() == 0).all());
}

TEST(TrialSet, ASpeedAtTheStartIsAsUncertainAsTheRecordingShows) {
  std::vector<Trial> list = {subject().trial("curl_slow", 1.0, {}, 100),
                             subject().trial("curl_slow", 1.0, {}, 100)};
  MeasuredChannel& moving = list[1].measured.front();
  moving.values = (0.6 + 1.9 * (moving.times.array() - moving.times[0])).matrix();
  TrialSetOptions options;
  options.parameters = {"hand.mass"};
  options.ownStart = true;
  const TrialSet trials(subject().model, SyntheticElbow::options(), list, options);
  std::map<std::string, double> sds;
  for (const info::Parameter& one : trials.parameters()) sds[one.name] = one.prior->sd;
  EXPECT_EQ(sds.at("trial1.initial.elbow_flexion.speed"), 0.1);
  EXPECT_NEAR(sds.at("trial2.initial.elbow_flexion.speed"), 1.9, 0.01);
}

// Trials of different length have different knots; one trial has none.
TEST(TrialSet, KnotsOfLatentExcitationsBelongToTheirTrials) {
  std::vector<Trial> list = {subject().trial("curl_slow", 1.0, {}, 30),
                             subject().trial("curl_slow", 0.4, {}, 30),
                             subject().trial("curl_fast", 0.6, {}, 50)};
  list[0].latent = {{"BRA", 0.8, 0.5}};
  list[2].latent = {{"BRA", 0.8, 0.2}, {"BRD", 1.5, 0.6}};
  TrialSetOptions options;
  options.parameters = {"hand.mass", "emg.*"};
  options.ownStart = true;
  options.latent = true;
  options.simulation.newtonTolerance = 1e-12;
  const TrialSet trials(subject().model, SyntheticElbow::options(), list, options);
  const auto common = static_cast<Eigen::Index>(trials.numCommon());
  ASSERT_EQ(common, 1 + 8 + 2);  // mass, gains, delay and shape
  ASSERT_EQ(trials.numParameters(), trials.numCommon() + (2 + 3) + 2 + (2 + 4 + 2));
  const auto& parameters = trials.parameters();
  EXPECT_EQ(parameters[13].name, "trial1.emg.BRA.latent1");
  EXPECT_EQ(parameters.back().name, "trial3.emg.BRD.latent2");
  EXPECT_EQ(parameters[13].prior->sd, 0.8);
  ASSERT_EQ(trials.latent().size(), 3u);
  EXPECT_EQ(trials.latent()[0].first, 13u);
  EXPECT_EQ(trials.latent()[2].first, parameters.size() - 2);
  EXPECT_NEAR(trials.latent()[0].atKnots[1],
              excitationAt(list[0], 2, 0.5 * (list[0].times[0] + 1.0)), 0.3);
  Eigen::VectorXd theta(static_cast<Eigen::Index>(parameters.size()));
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    theta[i] = parameters[static_cast<std::size_t>(i)].start;
    if (i >= common) theta[i] += 0.02 * static_cast<double>(i % 5);
  }
  theta[common - 1] = -0.5;  // the shape: at 0 it is at its bound
  EXPECT_EQ(trials.mappingAt(2, theta).latent.at("BRD").values[1], theta[theta.size() - 1]);
  EXPECT_TRUE(trials.mappingAt(1, theta).latent.empty());
  const info::Predictor predictor = trials.predictor();
  const info::Prediction at = predictor.withSensitivities(theta);
  const auto cost = trials.leastSquares(theta, {0.01});
  for (Eigen::Index i = common; i < theta.size(); ++i) {
    const double h = 1e-4;
    Eigen::VectorXd up = theta, down = theta;
    up[i] += h;
    down[i] -= h;
    const Eigen::VectorXd difference =
        ((predictor.outputs(up) - predictor.outputs(down)) / (2 * h)).transpose();
    EXPECT_LT((at.gamma.col(i) - difference).cwiseAbs().maxCoeff(),
              1e-4 * difference.cwiseAbs().maxCoeff() + 1e-9)
        << parameters[static_cast<std::size_t>(i)].name;
  }
  // the adjoint sums up the same
  const Eigen::VectorXd gradient =
      at.gamma.transpose() * (at.outputs - trials.measured()).transpose() / 1e-4;
  EXPECT_LT((cost.gradient - gradient).cwiseAbs().maxCoeff(),
            1e-7 * gradient.cwiseAbs().maxCoeff());
  // unless they are asked for, the trials stand as they are
  options.latent = false;
  const TrialSet plain(subject().model, SyntheticElbow::options(), list, options);
  EXPECT_EQ(plain.numParameters(), plain.numCommon() + 6);
  list[0].latent = {{"DELT", 1, 0.5}};
  options.latent = true;
  EXPECT_THAT([&] { TrialSet(subject().model, SyntheticElbow::options(), list, options); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("curl_slow.sto: latent excitation of "
                                                             "'DELT'")));
}

// The same comparison as `fisherhill replay` makes.
TEST(TrialSet, MeasuresErrorsAsReplayDoes) {
  const Trial trial = subject().trial("curl_slow", 1.0, {{"hand.mass", 0.8}}, 30, 3);
  const TrialSet trials = set({"hand.mass"}, {trial});
  const Eigen::MatrixXd y =
      trials.predictor().outputs(Eigen::VectorXd::Constant(1, trials.parameters()[0].start));
  const ExcitationSignal signal = excitationOf(trial, subject().system);
  SimulationOptions simulation;
  simulation.duration = 1.0;
  simulation.newtonTolerance = 1e-12;
  const Trajectory motion = simulate(
      subject().system, signal,
      initialState(subject().system, startCoordinates(trial, subject().system, {}), signal, 0.0),
      simulation);
  const double rms = compareWithMeasured(subject().system, motion, trial.measured[0]).rms;
  EXPECT_GT(rms, 0.01);
  EXPECT_NEAR(std::sqrt(trials.meanSquare(y)), rms, 1e-12);
  EXPECT_NEAR(std::sqrt(trials.meanSquare(y, 0)), rms, 1e-12);
}

TEST(TrialSet, GivesNothingWhereThereIsNoSimulation) {
  const TrialSet trials = set({"BRA.max_isometric_force"}, {subject().trial("curl_slow", 0.5)});
  EXPECT_EQ(trials.failure(0, Eigen::VectorXd::Constant(1, 900)), "");
  const Eigen::VectorXd impossible = Eigen::VectorXd::Constant(1, -5);
  EXPECT_TRUE(trials.predictor().outputs(impossible).array().isNaN().all());
  EXPECT_TRUE(trials.predictor().withSensitivities(impossible).gamma.array().isNaN().all());
  EXPECT_THAT(trials.failure(0, impossible), HasSubstr("BRA"));
}

TEST(ObservedTimes, AreThoseOfTheMeasurementElseEqualSteps) {
  const Trial trial = subject().trial("curl_slow", 0.3);
  const Eigen::VectorXd& measured = trial.measured.front().times;
  EXPECT_EQ(observedTimes(trial, "elbow_flexion", 0.1),
            std::vector<double>(measured.begin(), measured.end()));
  const double begin = trial.times[0];
  EXPECT_EQ(observedTimes(trial, "pro_sup", 0.1),
            (std::vector<double>{begin, begin + 0.1, begin + 2 * 0.1, begin + 3 * 0.1}));
}

TEST(TrialSet, RefusesWhatCannotBeEstimatedFrom) {
  const Trial good = subject().trial("curl_slow", 0.3);
  Trial unmeasured = good;
  unmeasured.measured.clear();
  const auto fails = [](auto make, const char* message) {
    EXPECT_THAT(make, ThrowsMessage<std::invalid_argument>(HasSubstr(message)));
  };
  fails([&] { set({"hand.mass"}, {}); }, "no trial");
  fails([&] { set({}, {good}); }, "no parameter is given");
  fails(
      [&] {
        set({"hand.mass"}, {good, unmeasured});
      },
      "curl_slow.sto: no measured column of a free coordinate (elbow_flexion)");
  Trial pushed = good;
  pushed.applied.push_back({"shoulder_elv", Eigen::VectorXd::Zero(good.times.size())});
  fails([&] { set({"hand.mass"}, {pushed}); }, "acts on 'shoulder_elv', which is not free");
  fails([&] { set({"hand.mas"}, {good}); }, "no parameter is called 'hand.mas'");
  fails([&] { set({"hand.mass", "hand.mass"}, {good}); }, "'hand.mass' is given twice");
  fails([&] { set({"emg.gain", "emg.BRA.gain"}, {good}); }, "set the same value");
  fails([&] { set({"initial.elbow_flexion"}, {good, good}); }, "differs between trials");
}

}  // namespace
}  // namespace bio
