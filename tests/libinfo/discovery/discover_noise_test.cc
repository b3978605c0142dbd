#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "info/discovery/likelihood/recorded_noise.h"
#include "info/probability/random_stream.h"

namespace info::discover {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A motion that is known, c·sin 4t with c = 1 uncertain, and noise of the test's own.
class KnownMotion : public DiscoveryProblem {
 public:
  explicit KnownMotion(bool holds = true) : holds_(holds) {
    for (int k = 0; k < 450; ++k) times_.push_back(0.01 * k);
    for (int k = 0; k <= 90; ++k) nodes_.push_back({0.05 * k, 0});
    for (VectorXd& y : measured_) y = outputs(0, VectorXd::Ones(1), {});
  }
  template <class Noise>
  void add(const Noise& noise) {
    for (std::size_t trial = 0; trial < measured_.size(); ++trial) {
      RandomStream random(3, trial);
      measured_[trial] += noise(random, measured_[trial]);
    }
  }
  VectorXd& of(std::size_t trial) { return measured_[trial]; }

  const std::vector<Quantity>& quantities() const override {
    static const std::vector<Quantity> one = {{"c", "", 1, 0, 2, 0.1}};
    return one;
  }
  const std::vector<std::size_t>& nuisances() const override {
    static const std::vector<std::size_t> one = {0};
    return one;
  }
  const std::vector<Candidate>& candidates() const override {
    static const std::vector<Candidate> none;
    return none;
  }
  int numTrials() const override { return 3; }
  std::string trialName(int) const override { return "trial"; }
  const std::vector<double>& times(int) const override { return times_; }
  const VectorXd& measured(int trial) const override {
    return measured_[static_cast<std::size_t>(trial)];
  }
  const std::vector<Node>& nodes(int) const override { return nodes_; }
  Prediction predict(int, const VectorXd& values, const VectorXd&,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override {
    Prediction p;
    p.outputs = outputs(0, values, {});
    const auto n = p.outputs.size();
    p.gamma = p.outputs.replicate(1, static_cast<Eigen::Index>(wanted.size())) / values[0];
    p.speeds = VectorXd::Zero(n);
    if (!latentToo) return p;
    const auto nodes = static_cast<Eigen::Index>(nodes_.size());
    p.byNode = MatrixXd::Zero(n, nodes);
    p.scale = MatrixXd::Ones(nodes, 1);
    p.course = {VectorXd(nodes), VectorXd(nodes)};
    for (Eigen::Index k = 0; k < nodes; ++k) {
      const double phase = 4 * nodes_[static_cast<std::size_t>(k)].time;
      p.course.q[k] = values[0] * std::sin(phase);
      p.course.qDot[k] = 4 * values[0] * std::cos(phase);
    }
    p.courseByNode = MatrixXd::Zero(nodes, nodes);
    return p;
  }
  VectorXd outputs(int, const VectorXd& values, const VectorXd&) const override {
    VectorXd y(static_cast<Eigen::Index>(times_.size()));
    for (Eigen::Index k = 0; k < y.size(); ++k)
      y[k] = values[0] * std::sin(4 * times_[static_cast<std::size_t>(k)]);
    return y;
  }
  std::unique_ptr<DiscoveryProblem> nudged(double) const override {
    return holds_ ? std::make_unique<KnownMotion>(*this) : nullptr;
  }
  MatrixXd inputs(int) const override { return MatrixXd(450, 0); }
  std::vector<std::string> inputNames() const override { return {}; }

 private:
  bool holds_;
  std::vector<double> times_;
  std::vector<Node> nodes_;
  std::vector<VectorXd> measured_{3};
};

constexpr double kSize = 0.01;

VectorXd white(RandomStream& random, const VectorXd& y) {
  VectorXd noise(y.size());
  for (auto& one : noise) one = kSize * random.normal();
  return noise;
}

TEST(RecordedNoise, KeepsEverySampleOfWhiteNoise) {
  KnownMotion data;
  data.add(white);
  const RecordedNoise noise = recordedNoise(data, {0, 1});
  EXPECT_TRUE(noise.usesAll());
  EXPECT_NEAR(noise.sd.value.sd(0), kSize, 0.1 * kSize);
  EXPECT_EQ(noise.quantum, 0);
  ASSERT_EQ(noise.kept.size(), 3u);
  EXPECT_EQ(noise.kept[2].size(), 450u);
}

// Behind a low-pass of second order, 6 Hz: third differences of neighbours show a hundredth of it.
TEST(RecordedNoise, KeepsOneOfSeveralWhereNoiseIsCorrelated) {
  const auto lowPassed = [](RandomStream& random, const VectorXd& y) {
    VectorXd noise(y.size());
    double state = 0, rate = 0;
    const double w = 2 * 3.14159 * 6, h = 0.001;
    for (int k = -2000; k < 10 * y.size(); ++k) {
      rate += h * (w * w * (random.normal() - state) - std::sqrt(2.0) * w * rate);
      state += h * rate;
      if (k >= 0 && k % 10 == 0) noise[k / 10] = state;
    }
    return VectorXd(kSize * noise / std::sqrt(noise.squaredNorm() / static_cast<double>(y.size())));
  };
  KnownMotion data;
  data.add(lowPassed);
  EXPECT_LT(estimateOutputSd(data, {0, 1}).value.sd(0), 0.1 * kSize);
  const RecordedNoise noise = recordedNoise(data, {0, 1});
  EXPECT_GE(noise.spacing, 5);
  EXPECT_LE(noise.spacing, 10);
  EXPECT_NEAR(noise.interval, 0.01 * noise.spacing, 1e-4);
  EXPECT_NEAR(noise.sd.value.sd(0), kSize, 0.25 * kSize);
  EXPECT_NEAR(static_cast<double>(noise.kept[2].size()), 450.0 / noise.spacing, 1);
  // a model that cannot be held gives nothing to compare with
  KnownMotion free(false);
  free.add(lowPassed);
  EXPECT_EQ(recordedNoise(free, {0, 1}).spacing, 1);
}

TEST(RecordedNoise, LeavesOutliersOut) {
  KnownMotion data;
  data.add(white);
  std::size_t put = 0;
  for (std::size_t trial = 0; trial < 3; ++trial)
    for (Eigen::Index k = static_cast<Eigen::Index>(trial) + 10; k < 440; k += 23, ++put)
      data.of(trial)[k] += k % 2 == 0 ? 0.17 : -0.17;
  const RecordedNoise noise = recordedNoise(data, {0, 1});
  EXPECT_EQ(noise.outliers, put);
  EXPECT_EQ(noise.spacing, 1);
  EXPECT_NEAR(noise.sd.value.sd(0), kSize, 0.15 * kSize);
  for (const std::size_t k : noise.kept[1]) EXPECT_TRUE(k % 23 != 11 || k >= 440) << k;
}

// Every fifth sample is no outlier: they say how large the noise is.
TEST(RecordedNoise, LeavesAsManyAsAFifthIn) {
  KnownMotion data;
  data.add(white);
  for (std::size_t trial = 0; trial < 3; ++trial)
    for (Eigen::Index k = 2; k < 450; k += 5) data.of(trial)[k] += k % 2 == 0 ? 0.3 : -0.3;
  EXPECT_EQ(recordedNoise(data, {0, 1}).outliers, 0u);
}

TEST(RecordedNoise, IsNotBelowWhatRoundingMakes) {
  KnownMotion data;
  const double quantum = 0.04;
  for (std::size_t trial = 0; trial < 3; ++trial)
    data.of(trial) = (data.of(trial) / quantum).array().round() * quantum;
  const RecordedNoise noise = recordedNoise(data, {0, 1});
  EXPECT_NEAR(noise.quantum, quantum, 1e-9);
  EXPECT_GE(noise.sd.value.sd(0), quantum / std::sqrt(12.0) * (1 - 1e-9));
  EXPECT_LT(noise.sd.value.sd(0), quantum);
}

}  // namespace
}  // namespace info::discover
