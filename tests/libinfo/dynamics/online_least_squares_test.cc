#include "info/dynamics/online_least_squares.h"

#include <gmock/gmock.h>

#include "info/information/fisher.h"
#include "info/probability/random_stream.h"
#include "robots/instances.h"

namespace {

using namespace info;
using testing::HasSubstr;

using BothMap = Rk4<MassAndLengthUnknown>;
using LengthMap = Rk4<LengthUnknown>;
constexpr double kStep = 0.01;

double inputAt(std::size_t k) {
  return 2 * std::cos(0.07 * static_cast<double>(k)) + std::sin(0.02 * static_cast<double>(k));
}

/// A recording of the load cell, m = 0.2 kg, ℓ = 0.368 m unless said otherwise.
struct ArmRecording {
  std::vector<Vector<double, 1>> inputs;
  std::vector<double> forces;
};
ArmRecording record(std::size_t count, double noise, double capacity, double mass = 0.2,
                    double length = 0.368, double laterLength = 0) {
  ArmRecording out;
  Rk4<SuspendedMass> map{{}, kStep};
  Vector<double, 4> x = Vector<double, 4>::Zero();
  RandomStream random(11, 0);
  for (std::size_t k = 0; k < count; ++k) {
    const Vector<double, 2> theta(mass, laterLength > 0 && k > count / 2 ? laterLength : length);
    out.inputs.emplace_back(inputAt(k));
    out.forces.push_back(
        std::min(map.g(x, out.inputs.back(), theta)[0] + noise * random.normal(), capacity));
    x = map.step(x, out.inputs.back(), Vector<double, 1>(inputAt(k + 1)), theta);
  }
  return out;
}

const LengthMap kLengthMap{{{}, {0.2, 0}}, kStep};
const BothMap kBothMap{{{}, {0, 0}}, kStep};

std::vector<Parameter> lengthFrom(double start) {
  return {{.name = "length", .unit = "m", .start = start, .lower = 0.05, .upper = 1.5}};
}
std::vector<Parameter> bothFrom(double mass, double length) {
  return {{.name = "mass", .unit = "kg", .start = mass, .lower = 0.01, .upper = 2},
          {.name = "length", .unit = "m", .start = length, .lower = 0.05, .upper = 1.5}};
}

template <class M>
OnlineEstimate<M> feed(OnlineLeastSquares<M>& squares, const ArmRecording& data,
                       std::size_t every = 50) {
  OnlineEstimate<M> last;
  for (std::size_t k = 0; k < data.inputs.size(); ++k) {
    squares.add(data.inputs[k], Vector<double, 1>(data.forces[k]));
    if (k % every == every - 1) last = squares.update();
  }
  return last;
}

TEST(OnlineLeastSquares, FindsMassAndLengthOfExactData) {
  OnlineLeastSquares<BothMap> squares(kBothMap, Vector<double, 4>::Zero(), bothFrom(0.15, 0.45),
                                      {{.sd = 0.1}});
  const ArmRecording data = record(400, 0, 100);
  const auto last = feed(squares, data);
  EXPECT_TRUE(last.converged);
  EXPECT_NEAR(last.parameters[0], 0.2, 1e-7);
  EXPECT_NEAR(last.parameters[1], 0.368, 1e-7);
  // the observer is where the mass is
  const auto run = simulate(Rk4<SuspendedMass>{{}, kStep}, Vector<double, 4>::Zero().eval(),
                            data.inputs, Vector<double, 2>(0.2, 0.368));
  EXPECT_LT((last.x - run.x.back()).norm(), 1e-6);
  EXPECT_EQ(last.samples, 400u);
}

// The second algorithm: the batch estimator of estimate.h on the same noisy data.
TEST(OnlineLeastSquares, AgreesWithTheBatchEstimator) {
  const ArmRecording data = record(300, 0.1, 1e9);
  OnlineLeastSquares<BothMap> squares(kBothMap, Vector<double, 4>::Zero(), bothFrom(0.15, 0.45),
                                      {{.sd = 0.1}});
  const auto online = feed(squares, data);
  Eigen::MatrixXd measured(1, 300);
  for (int k = 0; k < 300; ++k) measured(0, k) = data.forces[std::size_t(k)];
  const LeastSquares batch(
      makePredictor(Rk4<SuspendedMass>{{}, kStep},
                    Experiment<Rk4<SuspendedMass>>{Vector<double, 4>::Zero(), data.inputs,
                                                   stepsEvery(0, 1, 299)}),
      {measured, OutputCovariance(Eigen::MatrixXd::Constant(1, 1, 0.01))}, bothFrom(0.2, 0.37));
  const Estimate whole = estimate(batch);
  ASSERT_TRUE(whole.converged);
  EXPECT_NEAR(online.parameters[0], whole.parameters[0], 1e-7);
  EXPECT_NEAR(online.parameters[1], whole.parameters[1], 1e-7);
  EXPECT_LT((online.covariance - whole.covariance).norm(), 1e-5 * whole.covariance.norm());
  EXPECT_NEAR(online.cost, whole.cost, 1e-6 * whole.cost);
}

TEST(OnlineLeastSquares, GivesTheSensitivityOfItsObserver) {
  const ArmRecording data = record(200, 0, 100);
  const auto at = [&](double length) {
    auto held = lengthFrom(length);
    held[0].lower = held[0].upper = length;
    OnlineLeastSquares<LengthMap> squares(kLengthMap, Vector<double, 4>::Zero(), held,
                                          {{.sd = 0.1}});
    return feed(squares, data);
  };
  const Vector<double, 4> difference = (at(0.3681).x - at(0.3679).x) / 2e-4;
  EXPECT_LT((at(0.368).psi - difference).norm(), 1e-5 * difference.norm());
}

// With clipped data, against the least of independently computed likelihoods on a fine grid.
TEST(OnlineLeastSquares, MaximisesTheLikelihoodOfClippedData) {
  const ArmRecording data = record(300, 0.1, 2.2);
  const ClippedSensor sensor{.sd = 0.1, .upper = 2.2};
  OnlineLeastSquares<LengthMap> squares(kLengthMap, Vector<double, 4>::Zero(), lengthFrom(0.4),
                                        {sensor});
  const auto got = feed(squares, data);
  std::size_t clipped = 0;
  for (double force : data.forces) clipped += force >= 2.2;
  EXPECT_GT(clipped, 40u);
  const auto cost = [&](double length) {
    const Vector<double, 1> theta(length);
    const auto run = simulate(kLengthMap, Vector<double, 4>::Zero().eval(), data.inputs, theta);
    double sum = 0;
    for (std::size_t k = 0; k < data.forces.size(); ++k)
      sum += sampleCost(sensor, data.forces[k], kLengthMap.g(run.x[k], data.inputs[k], theta)[0])
                 .value;
    return sum;
  };
  EXPECT_NEAR(got.cost, cost(got.parameters[0]), 1e-9);
  const double h = 1e-4;
  EXPECT_LT(got.cost, cost(got.parameters[0] + h));
  EXPECT_LT(got.cost, cost(got.parameters[0] - h));
  for (double length = 0.3; length < 0.45; length += 0.002) EXPECT_LE(got.cost, cost(length));
  // taken as measurements, the same data lead elsewhere
  OnlineLeastSquares<LengthMap> naive(kLengthMap, Vector<double, 4>::Zero(), lengthFrom(0.4),
                                      {{.sd = 0.1}});
  const auto wrong = feed(naive, data);
  EXPECT_LT(std::abs(got.parameters[0] - 0.368), 0.2 * std::abs(wrong.parameters[0] - 0.368));
}

TEST(OnlineLeastSquares, FollowsAChangeThroughASlidingWindow) {
  const ArmRecording data = record(1000, 0.005, 100, 0.2, 0.368, 0.42);
  OnlineOptions sliding{.window = 150, .startSd = Eigen::Vector4d(0, 0.5, 0, 3)};
  OnlineLeastSquares<LengthMap> window(kLengthMap, Vector<double, 4>::Zero(), lengthFrom(0.4),
                                       {{.sd = 0.005}}, sliding);
  const auto recent = feed(window, data);
  EXPECT_NEAR(recent.parameters[0], 0.42, 0.005);
  EXPECT_NEAR(recent.parameters[0], 0.42, 4 * std::sqrt(recent.covariance(0, 0)));
  EXPECT_EQ(recent.samples, 1000u);
  OnlineLeastSquares<LengthMap> whole(kLengthMap, Vector<double, 4>::Zero(), lengthFrom(0.4),
                                      {{.sd = 0.005}});
  EXPECT_GT(std::abs(feed(whole, data).parameters[0] - 0.42), 0.01);
}

TEST(OnlineLeastSquares, SlidesWithoutLosingExactData) {
  OnlineOptions sliding{.window = 100, .startSd = Eigen::Vector4d(0, 0.5, 0, 3)};
  OnlineLeastSquares<LengthMap> window(kLengthMap, Vector<double, 4>::Zero(), lengthFrom(0.4),
                                       {{.sd = 0.1}}, sliding);
  EXPECT_NEAR(feed(window, record(600, 0, 100)).parameters[0], 0.368, 1e-4);
}

TEST(OnlineLeastSquares, LeavesOutWhatWasNotMeasuredAndStaysInItsBounds) {
  ArmRecording data = record(200, 0, 100);
  for (std::size_t k = 0; k < 200; k += 3) data.forces[k] = std::nan("");
  OnlineLeastSquares<LengthMap> squares(kLengthMap, Vector<double, 4>::Zero(), lengthFrom(0.4),
                                        {{.sd = 0.1}});
  EXPECT_NEAR(feed(squares, data).parameters[0], 0.368, 1e-7);
  auto bounded = lengthFrom(0.45);
  bounded[0].lower = 0.39;
  OnlineLeastSquares<LengthMap> stopped(kLengthMap, Vector<double, 4>::Zero(), bounded,
                                        {{.sd = 0.1}});
  const auto at = feed(stopped, data);
  EXPECT_EQ(at.parameters[0], 0.39);
  EXPECT_TRUE(at.converged);
}

TEST(OnlineLeastSquares, HoldsThePriorWhereTheDataSayNothing) {
  // at rest the force does not depend on the length
  auto parameters = lengthFrom(0.4);
  parameters[0].prior = GaussianPrior{0.41, 0.03};
  OnlineLeastSquares<LengthMap> squares(kLengthMap, Vector<double, 4>::Zero(), parameters,
                                        {{.sd = 0.1}});
  for (int k = 0; k < 50; ++k) squares.add(Vector<double, 1>(0.0), Vector<double, 1>(1.962));
  const auto at = squares.update();
  EXPECT_NEAR(at.parameters[0], 0.41, 1e-5);
  EXPECT_NEAR(std::sqrt(at.covariance(0, 0)), 0.03, 1e-12);
  OnlineLeastSquares<LengthMap> unknowing(kLengthMap, Vector<double, 4>::Zero(), lengthFrom(0.4),
                                          {{.sd = 0.1}});
  unknowing.add(Vector<double, 1>(0.0), Vector<double, 1>(1.962));
  EXPECT_TRUE(std::isinf(unknowing.update().covariance(0, 0)));
}

TEST(OnlineLeastSquares, NamesTheRuleThatIsBroken) {
  const auto message = [](auto&& make) {
    try {
      make();
      return std::string();
    } catch (const std::exception& e) {
      return std::string(e.what());
    }
  };
  const auto with = [&](std::vector<Parameter> parameters, std::vector<ClippedSensor> sensors,
                        OnlineOptions options = {}) {
    return message([&] {
      OnlineLeastSquares<LengthMap>(kLengthMap, Vector<double, 4>::Zero(), parameters, sensors,
                                    options);
    });
  };
  EXPECT_THAT(with(bothFrom(1, 1), {{.sd = 1}}), HasSubstr("parameters: length is 2"));
  EXPECT_THAT(with(lengthFrom(0.4), {}), HasSubstr("sensors: length is 0"));
  EXPECT_THAT(with(lengthFrom(0.4), {{.sd = -1}}), HasSubstr("deviation: -1"));
  EXPECT_THAT(with(lengthFrom(9), {{.sd = 1}}), HasSubstr("length [m]"));
  EXPECT_THAT(with(lengthFrom(0.4), {{.sd = 1}}, {.window = 1}), HasSubstr("window: 1"));
  EXPECT_THAT(with(lengthFrom(0.4), {{.sd = 1}}, {.window = 10}),
              HasSubstr("deviations of a window's start"));
  EXPECT_THAT(
      with(lengthFrom(0.4), {{.sd = 1}}, {.window = 10, .startSd = Eigen::Vector4d(0, -1, 0, 0)}),
      HasSubstr("start: -1, must be ≥ 0"));
  EXPECT_THAT(with(lengthFrom(0.4), {{.sd = 1}}, {.maxIterations = 0}), HasSubstr("iterations: 0"));
  OnlineLeastSquares<LengthMap> squares(kLengthMap, Vector<double, 4>::Zero(), lengthFrom(0.4),
                                        {{.sd = 1}});
  EXPECT_THAT(message([&] { squares.update(); }), HasSubstr("number of samples is 0"));
  EXPECT_THAT(message([&] { squares.add(Vector<double, 1>(NAN), Vector<double, 1>(1.0)); }),
              HasSubstr("input is not finite"));
}

}  // namespace
