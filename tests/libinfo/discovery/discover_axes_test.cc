#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>

#include "info/discovery/discover.h"
#include "info/discovery/likelihood/joint_fit.h"
#include "info/probability/random_stream.h"

namespace info::discover {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kStep = 0.05, kOutput = 0.003, kTime = 0.1, kLag = 0.04;
constexpr int kSamples = 60;

// Two masses, each on a spring and a damper, with a spring between them: two axes, and both
// positions are measured. What is missing is a force on the second that follows its position.
class TwoMasses : public DiscoveryProblem {
 public:
  explicit TwoMasses(double between = 2, int numTrials = 2) : between_(between) {
    quantities_ = {{"shove", "N", 0, 0, 50, 1}};
    Candidate shove;
    shove.id = shove.name = "shove";
    shove.sentence = "a push on the first mass";
    shove.quantities = {0};
    shove.sds = {1};
    shove.starts = {VectorXd::Constant(1, 0.1)};
    candidates_ = {shove};
    for (int t = 0; t < numTrials; ++t)
      for (const char* name : {"q0", "q1", "v0", "v1"}) {
        nuisances_.push_back(quantities_.size());
        quantities_.push_back({name + std::to_string(t), "", 0, -50, 50, 1, false, t});
      }
    for (std::size_t axis = 0; axis < 2; ++axis)
      for (int k = 0; k < kSamples; ++k) nodes_.push_back({kStep * k, axis});
    for (int k = 0; k < kSamples; ++k)
      for (int output = 0; output < 2; ++output) {
        times_.push_back(kStep * k);
        outputs_.push_back(output);
      }
    scale = MatrixXd::Zero(2 * kSamples, 2);
    scale.col(0).head(kSamples).setOnes();
    scale.col(1).tail(kSamples).setOnes();
    measured_.assign(static_cast<std::size_t>(numTrials), VectorXd::Zero(2 * kSamples));
  }
  /// Measurements under a force on the second mass, a function of time, position and speed.
  template <class Force>
  void draw(const Force& force) {
    for (int t = 0; t < numTrials(); ++t) {
      RandomStream random(7, static_cast<std::uint64_t>(t));
      VectorXd values = VectorXd::Zero(static_cast<Index>(quantities_.size()));
      values.segment(1 + 4 * t, 4) << 0.3, 0.8 - 0.5 * t, 0, 0.4;
      const MatrixXd x = states(t, values, {}, force);
      VectorXd& y = measured_[static_cast<std::size_t>(t)];
      for (Index i = 0; i < y.size(); ++i) y[i] = x(i / 2, i % 2) + kOutput * random.normal();
    }
  }

  const std::vector<Quantity>& quantities() const override { return quantities_; }
  const std::vector<std::size_t>& nuisances() const override { return nuisances_; }
  const std::vector<Candidate>& candidates() const override { return candidates_; }
  int numTrials() const override { return static_cast<int>(measured_.size()); }
  std::string trialName(int trial) const override { return "trial " + std::to_string(trial); }
  const std::vector<double>& times(int) const override { return times_; }
  const std::vector<int>& outputOfSample(int) const override { return outputs_; }
  const VectorXd& measured(int trial) const override {
    return measured_[static_cast<std::size_t>(trial)];
  }
  const std::vector<Axis>& axes() const override {
    static const std::vector<Axis> two = {{"first", "m", "N"}, {"second", "m", "N"}};
    return two;
  }
  const std::vector<Node>& nodes(int) const override { return nodes_; }
  double latentLag() const override { return kLag; }
  Prediction predict(int trial, const VectorXd& values, const VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override {
    const auto free = [](double, double, double) { return 0.0; };
    Prediction p;
    p.outputs = outputs(trial, values, latent);
    p.speeds = VectorXd::Zero(p.outputs.size());
    p.gamma.resize(p.outputs.size(), static_cast<Index>(wanted.size()));
    const double h = 1e-5;
    for (std::size_t j = 0; j < wanted.size(); ++j) {
      VectorXd more = values, less = values;
      more[static_cast<Index>(wanted[j])] += h;
      less[static_cast<Index>(wanted[j])] -= h;
      p.gamma.col(static_cast<Index>(j)) =
          (outputs(trial, more, latent) - outputs(trial, less, latent)) / (2 * h);
    }
    if (!latentToo) return p;
    p.scale = scale;
    const MatrixXd x = states(trial, values, latent, free);
    p.course = {x.leftCols(2).reshaped(), x.rightCols(2).reshaped()};
    const auto n = static_cast<Index>(nodes_.size());
    p.byNode.resize(p.outputs.size(), n);
    p.courseByNode.resize(n, n);
    for (Index j = 0; j < n; ++j) {
      VectorXd more = latent.size() == 0 ? VectorXd(VectorXd::Zero(n)) : latent, less = more;
      more[j] += h;
      less[j] -= h;
      const MatrixXd change =
          (states(trial, values, more, free) - states(trial, values, less, free)) / (2 * h);
      p.byNode.col(j) = change.leftCols(2).transpose().reshaped();
      p.courseByNode.col(j) = change.leftCols(2).reshaped();
    }
    return p;
  }
  VectorXd outputs(int trial, const VectorXd& values, const VectorXd& latent) const override {
    const auto free = [](double, double, double) { return 0.0; };
    return states(trial, values, latent, free).leftCols(2).transpose().reshaped();
  }
  MatrixXd inputs(int) const override { return MatrixXd(2 * kSamples, 0); }
  std::vector<std::string> inputNames() const override { return {}; }
  std::unique_ptr<DiscoveryProblem> withFormula(
      std::size_t axis, const std::vector<FormulaTerm>& terms,
      const std::vector<std::size_t>& kept) const override {
    auto widened = std::make_unique<TwoMasses>(*this);
    widened->axis_ = axis;
    widened->formula_ = terms;
    widened->formulaAt_ = static_cast<Index>(quantities_.size());
    widened->candidates_.clear();
    for (const std::size_t c : kept) widened->candidates_.push_back(candidates_[c]);
    Candidate formula;
    formula.id = formula.name = "formula";
    VectorXd starts(static_cast<Index>(terms.size()));
    for (std::size_t k = 0; k < terms.size(); ++k) {
      formula.quantities.push_back(widened->quantities_.size());
      formula.sds.push_back(terms[k].sd);
      starts[static_cast<Index>(k)] = terms[k].start;
      const double most = 20 * terms[k].sd;
      widened->quantities_.push_back({"term" + std::to_string(k), "", 0, -most, most, terms[k].sd});
    }
    formula.starts = {starts};
    widened->candidates_.push_back(formula);
    return widened;
  }

  MatrixXd scale;  // of the latent force: nodes × channels

 private:
  static double valueOf(const std::string& expression, double q, double w) {
    double a = 0, b = 1;
    int power = 1;
    const char* text = expression.c_str();
    if (std::sscanf(text, "((q%lf)/%lf)^%d", &a, &b, &power) == 3)
      return std::pow((q + a) / b, power);
    if (std::sscanf(text, "qdot/%lf", &a) == 1) return w / a;
    if (std::sscanf(text, "qdot*abs(qdot)/%lf", &a) == 1) return w * std::abs(w) / a;
    if (std::sscanf(text, "tanh(qdot/%lf)", &a) == 1) return std::tanh(w / a);
    if (std::sscanf(text, "q^%d", &power) == 1) return std::pow(q, power);
    return expression == "q" ? q : expression == "qdot" ? w : 1;
  }
  // Rows q0, q1, v0, v1, a step a row.
  template <class Force>
  MatrixXd states(int trial, const VectorXd& values, const VectorXd& latent,
                  const Force& force) const {
    MatrixXd all(kSamples, 4);
    Eigen::Vector4d x = values.segment<4>(1 + 4 * trial);
    for (Index k = 0; k < kSamples; ++k) {
      all.row(k) = x.transpose();
      const double pull = between_ * (x[1] - x[0]);
      Eigen::Vector2d f(values[0] - 8 * x[0] - x[2] + pull, -6 * x[1] - 0.8 * x[3] - pull);
      f[1] += force(kStep * static_cast<double>(k), x[1], x[3]);
      if (latent.size() != 0) f += Eigen::Vector2d(latent[k], latent[kSamples + k]);
      double sum = 0;
      const Index own = static_cast<Index>(axis_);
      for (std::size_t i = 0; i < formula_.size(); ++i)
        sum += (i == 0 ? 1 : values[formulaAt_ + static_cast<Index>(i)]) *
               valueOf(formula_[i].expression, x[own], x[2 + own]);
      if (!formula_.empty()) f[own] += values[formulaAt_] * sum;
      x.tail<2>() += kStep * f;
      x.head<2>() += kStep * x.tail<2>();
    }
    return all;
  }

  double between_;
  std::size_t axis_ = 0;
  std::vector<FormulaTerm> formula_;
  Index formulaAt_ = 0;
  std::vector<Quantity> quantities_;
  std::vector<std::size_t> nuisances_;
  std::vector<Candidate> candidates_;
  std::vector<double> times_;
  std::vector<int> outputs_;
  std::vector<Node> nodes_;
  std::vector<VectorXd> measured_;
};

Noise noiseOf(double latent) {
  return {Whitening(VectorXd::Constant(2, kOutput)), latent, kTime};
}

Fit fitted(const Likelihood& likelihood, double latent) {
  const DiscoveryProblem& data = likelihood.data();
  return likelihood.fit(makeHypothesis(data, {}, likelihood.trials()), noiseOf(latent),
                        nominalValues(data));
}

TEST(Axes, PriorCovarianceOfTheirForcesIsTheFormula) {
  TwoMasses data(2, 1);
  RandomStream random(1, 0);
  data.scale.resize(2 * kSamples, 3);
  for (double& g : data.scale.reshaped()) g = 0.2 + random.uniform();
  const Likelihood likelihood(data, {0}, nominalValues(data), kTime);
  const double size = 0.7;
  Fit fit;
  fit.noise = noiseOf(size);
  const Index n = 2 * kSamples;
  MatrixXd root(n, n);
  for (Index k = 0; k < n; ++k) {
    fit.eta = {VectorXd::Unit(n, k)};
    root.col(k) = likelihood.force(0, fit);
  }
  const MatrixXd covariance = root * root.transpose();
  for (Index a = 0; a < n; ++a)
    for (Index b = 0; b < n; ++b) {
      const double interval = kStep * static_cast<double>(std::abs(a % kSamples - b % kSamples));
      const double correlation =
          (kTime * std::exp(-interval / kTime) - kLag * std::exp(-interval / kLag)) /
          (kTime - kLag);
      const double expected = size * size * data.scale.row(a).dot(data.scale.row(b)) * correlation;
      EXPECT_NEAR(covariance(a, b), expected, 1e-10) << a << ' ' << b;
    }
}

TEST(Axes, AChannelThatActsOnBothCouplesTheirForces) {
  TwoMasses data(0, 1);  // they do not feel each other
  data.draw([](double, double, double) { return 0.0; });
  VectorXd measured = data.measured(0);
  class FirstOnly : public TwoMasses {
   public:
    explicit FirstOnly(const TwoMasses& of) : TwoMasses(of), half_(of.measured(0)) {
      for (Index k = 0; k < kSamples; ++k) {
        half_[2 * k] += 0.05 * std::sin(0.4 * static_cast<double>(k));  // asks for a force
        half_[2 * k + 1] = 0;                                           // at rest
      }
    }
    const VectorXd& measured(int) const override { return half_; }

   private:
    VectorXd half_;
  };
  const auto forces = [&](const MatrixXd& scale, double second) {
    FirstOnly own(data);
    own.scale = scale;
    const Likelihood likelihood(own, {0}, nominalValues(own), kTime);
    const Fit fit = likelihood.fit(
        makeHypothesis(own, {}, {0}),
        {Whitening(VectorXd(Eigen::Vector2d(kOutput, second))), 1.0, kTime}, nominalValues(own));
    const VectorXd d = likelihood.force(0, fit);
    return std::pair<VectorXd, VectorXd>(d.head(kSamples), d.tail(kSamples));
  };
  // the second mass is hardly measured
  const auto [apart, unknown] = forces(data.scale, 1e6);
  EXPECT_GT(apart.norm(), 1);
  EXPECT_LT(unknown.norm(), 1e-6 * apart.norm());
  MatrixXd common = MatrixXd::Constant(2 * kSamples, 1, 1);
  common.bottomRows(kSamples).setConstant(-0.5);
  MatrixXd scale(2 * kSamples, 3);
  scale << common, 1e-3 * data.scale;
  const auto [one, other] = forces(scale, 1e6);
  EXPECT_GT(one.norm(), 1);
  EXPECT_LT((other + 0.5 * one).norm(), 1e-4 * one.norm());
}

TEST(Axes, AForceIsLocalisedOnItsOwn) {
  TwoMasses data;
  data.draw([](double t, double, double) { return t > 1 && t < 1.5 ? 1.0 : 0.0; });
  const Likelihood likelihood(data, {0, 1}, nominalValues(data), kTime);
  const Localisation map =
      localise(likelihood, fitted(likelihood, 0.05), fitted(likelihood, 1), {});
  const Score* best[3] = {};
  std::size_t hats[2] = {}, cells[2] = {};
  for (const Score& one : map.times) {
    ++hats[one.axis];
    if (!best[0] || std::abs(one.z) > std::abs(best[0]->z)) best[0] = &one;
    if (one.axis == 0) {
      EXPECT_LT(std::abs(one.z), 4) << one.from;
    }
  }
  for (const Score& one : map.cells) ++cells[one.axis];
  EXPECT_EQ(hats[0], hats[1]);
  EXPECT_GT(std::min(cells[0], cells[1]), 5U);
  EXPECT_EQ(best[0]->axis, 1U);
  EXPECT_GT(best[0]->z, 10);
  EXPECT_GT(best[0]->to, 1);
  EXPECT_LT(best[0]->from, 1.5);
  EXPECT_EQ(describeUnknown(likelihood, fitted(likelihood, 1)).axis, 1U);
}

// Cells are those of the positions of their axis: each visits a range of its own.
TEST(Axes, MapsOverPositionAndSpeedAreThoseOfTheAxis) {
  TwoMasses data;
  data.draw([](double, double, double) { return 0.0; });
  const Likelihood likelihood(data, {0, 1}, nominalValues(data), kTime);
  const Localisation map =
      localise(likelihood, fitted(likelihood, 0.05), fitted(likelihood, 1), {});
  double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
  for (const Score& one : map.cells) {
    low[one.axis] = std::min(low[one.axis], one.lowerQ);
    high[one.axis] = std::max(high[one.axis], one.upperQ);
  }
  for (int axis = 0; axis < 2; ++axis) {
    double least = 1e9, most = -1e9;
    for (int t = 0; t < 2; ++t)
      for (Index i = axis; i < data.measured(t).size(); i += 2) {
        least = std::min(least, data.measured(t)[i]);
        most = std::max(most, data.measured(t)[i]);
      }
    EXPECT_NEAR(low[axis], least, 5 * kOutput) << axis;
    EXPECT_NEAR(high[axis], most, 5 * kOutput) << axis;
  }
}

TEST(Axes, AnUnknownForceIsToldWithItsAxis) {
  TwoMasses data;
  data.draw([](double, double q, double) { return -8 * q * q * q; });
  Options options;
  options.sds = Whitening(VectorXd::Constant(2, kOutput));
  const Verdict v = run(data, options);
  EXPECT_EQ(v.finding, Finding::unknown) << v.sentence;
  ASSERT_TRUE(v.unknown);
  EXPECT_EQ(v.unknown->axis, 1U);
  ASSERT_FALSE(v.unknown->terms.empty());
  EXPECT_EQ(v.unknown->terms[0].name, "q³") << v.unknown->formula;
  ASSERT_TRUE(v.formula);
  EXPECT_EQ(v.formula->axis, 1U);
  ASSERT_TRUE(v.nonparametric);
  EXPECT_EQ(v.nonparametric->axis, 1U);
  EXPECT_EQ(v.nonparametric->follows, NonparametricForce::Follows::position);
  EXPECT_NE(v.sentence.find(" on second"), std::string::npos) << v.sentence;
}

TEST(Axes, NodesMustBeThoseOfEachInTurn) {
  class Shuffled : public TwoMasses {
   public:
    Shuffled() : nodes_(TwoMasses::nodes(0)) { std::swap(nodes_[3], nodes_[kSamples + 3]); }
    const std::vector<Node>& nodes(int) const override { return nodes_; }

   private:
    std::vector<Node> nodes_;
  };
  const Shuffled data;
  EXPECT_THROW(Likelihood(data, {0}, nominalValues(data), kTime), std::invalid_argument);
}

}  // namespace
}  // namespace info::discover
