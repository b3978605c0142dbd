#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "info/discovery/discover.h"
#include "info/discovery/likelihood/joint_fit.h"
#include "support/linear_problem.h"

namespace {

using namespace info::discover;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kOutput = 0.02, kLatent = 0.7, kTime = 0.11, kTruth = 1.2;

// The quantity "gain" is the damping of the mass: what pushes it comes from the latent force alone,
// and its size and its damping are told from the same motion. What is seen of the position x is
// x + bent·x².
class Damped : public LinearDisagreement {
 public:
  Damped(int samples, double bent) : LinearDisagreement(1, samples), bent_(bent) {}
  VectorXd outputs(int, const VectorXd& values, const VectorXd& latent) const override {
    const VectorXd x = position(values, latent);
    return x + bent_ * x.cwiseAbs2();
  }
  Prediction predict(int trial, const VectorXd& values, const VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override {
    Prediction p = LinearDisagreement::predict(trial, values, latent, {}, latentToo);
    const VectorXd slope = VectorXd::Ones(p.outputs.size()) + 2 * bent_ * position(values, latent);
    VectorXd still = VectorXd::Zero(values.size());
    still[0] = values[0];
    for (Index k = 0; k < p.byNode.cols(); ++k)
      p.byNode.col(k) = slope.cwiseProduct(position(still, VectorXd::Unit(p.byNode.cols(), k)));
    p.gamma.resize(p.outputs.size(), static_cast<Index>(wanted.size()));
    for (std::size_t j = 0; j < wanted.size(); ++j) {
      const double h = 1e-4;
      VectorXd more = values, less = values;
      more[static_cast<Index>(wanted[j])] += h;
      less[static_cast<Index>(wanted[j])] -= h;
      p.gamma.col(static_cast<Index>(j)) =
          (outputs(trial, more, latent) - outputs(trial, less, latent)) / (2 * h);
    }
    return p;
  }

 private:
  VectorXd position(VectorXd values, const VectorXd& latent) const {
    LinearDisagreement spring = *this;
    spring.F(1, 1) = 1 - values[0] * kStep;
    values[0] = 0;
    return spring.outputs(0, values, latent);
  }
  double bent_;
};

Damped drawn(std::uint64_t seed, double bent) {
  Damped data(120, bent);
  VectorXd truth = nominalValues(data);
  truth[0] = kTruth;
  data.draw(seed, truth, kOutput, kLatent, kTime);
  return data;
}

const FitOptions kExact{60, 1e-10, {}};

Fit jointFit(const Likelihood& likelihood, const DiscoveryProblem& data) {
  return likelihood.fit(makeHypothesis(data, {}, {0}), {kOutput, kLatent, kTime},
                        nominalValues(data), {}, kExact);
}

// −log of the probability of damping and start, with the outputs' covariance written out: the
// latent force does not appear in it. The most probable start is that of a linear regression.
double surprise(const Damped& data, double damping) {
  const auto n = static_cast<Index>(data.times(0).size());
  VectorXd values = VectorXd::Zero(static_cast<Index>(data.quantities().size()));
  values[0] = damping;
  MatrixXd response(n, n), X(n, 2);
  for (Index k = 0; k < n; ++k) response.col(k) = data.outputs(0, values, VectorXd::Unit(n, k));
  for (Index i = 0; i < 2; ++i) {
    values[4 + i] = 1;
    X.col(i) = data.outputs(0, values, {});
    values[4 + i] = 0;
  }
  MatrixXd K(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j)
      K(i, j) = kLatent * kLatent *
                std::exp(-std::abs(static_cast<double>(i - j)) * Damped::kStep / kTime);
  MatrixXd S = response * K * response.transpose();
  S.diagonal().array() += kOutput * kOutput;
  const Eigen::LLT<MatrixXd> factor(S);
  const VectorXd& y = data.measured(0);
  const MatrixXd prior = MatrixXd::Identity(2, 2) / (0.3 * 0.3);
  const VectorXd start =
      (X.transpose() * factor.solve(X) + prior).llt().solve(X.transpose() * factor.solve(y));
  const VectorXd e = y - X * start;
  const MatrixXd L = factor.matrixL();
  return 0.5 * e.dot(factor.solve(e)) + L.diagonal().array().log().sum() +
         0.5 * start.squaredNorm() / (0.3 * 0.3) + 0.5 * std::pow((damping - 1) / 0.2, 2);
}

// Where a function of the damping is least, by thirds.
template <typename Function>
double least(const Function& function) {
  double low = -0.5, high = 3;
  while (high - low > 1e-5) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (function(a) < function(b))
      high = b;
    else
      low = a;
  }
  return 0.5 * (low + high);
}

TEST(MarginalFit, HasTheParametersThatAreMostProbableByThemselves) {
  for (const std::uint64_t seed : {3, 4, 5}) {
    const Damped data = drawn(seed, 0);
    const Likelihood likelihood(data, {0}, nominalValues(data), kTime);
    const Fit joint = jointFit(likelihood, data),
              marginal = likelihood.marginal(likelihood.marginal(joint));
    const double truth = least([&](double damping) { return surprise(data, damping); });
    EXPECT_NEAR(marginal.values[0], truth, 0.1 * marginal.sd(0)) << seed;
    EXPECT_GT(truth - joint.values[0], 0.3 * joint.sd(0)) << seed;
    EXPECT_GT(marginal.logEvidence, joint.logEvidence);
    EXPECT_GT(marginal.cost, joint.cost);
  }
}

// Where the response to latent forces depends on these forces themselves: beside the evidence of
// the latent forces alone, at one damping after another.
TEST(MarginalFit, FollowsTheLatentForcesWhereTheResponseBends) {
  for (const std::uint64_t seed : {3, 4, 5}) {
    const Damped data = drawn(seed, 1.5);
    const Likelihood likelihood(data, {0}, nominalValues(data), kTime);
    const Noise noise{kOutput, kLatent, kTime};
    Hypothesis damping = makeHypothesis(data, {}, {0}), nothing;
    damping.free.resize(1);
    ASSERT_EQ(damping.free[0].quantity, 0u);
    const Fit joint = likelihood.fit(damping, noise, nominalValues(data), {}, kExact);
    const double truth = least([&](double value) {
      VectorXd values = nominalValues(data);
      values[0] = value;
      return 0.5 * std::pow((value - 1) / 0.2, 2) -
             likelihood.fit(nothing, noise, values, joint.eta, kExact).logEvidence;
    });
    const Fit marginal = likelihood.marginal(likelihood.marginal(joint));
    EXPECT_NEAR(marginal.values[0], truth, 0.03 * marginal.sd(0)) << seed;
    EXPECT_GT(std::abs(truth - joint.values[0]), 0.3 * joint.sd(0)) << seed;
  }
}

// Each with its own noise, the errors in deviations are centred and of size 1; those of the joint
// fits are not.
TEST(MarginalFit, IsNotBiasedTowardsTooLittleDamping) {
  constexpr int kDraws = 100;
  double joint = 0, marginal = 0, squares = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    Damped data(120, 0);
    info::RandomStream random(17, static_cast<std::uint64_t>(draw));
    VectorXd truth = nominalValues(data);
    for (const Index i : {0, 4, 5})
      truth[i] += data.quantities()[static_cast<std::size_t>(i)].sd * random.normal();
    data.draw(500 + static_cast<std::uint64_t>(draw), truth, kOutput, kLatent, kTime);
    const Likelihood likelihood(data, {0}, nominalValues(data), kTime);
    const Fit all = jointFit(likelihood, data), own = likelihood.marginal(likelihood.marginal(all));
    joint += (all.values[0] - truth[0]) / all.sd(0) / kDraws;
    const double error = (own.values[0] - truth[0]) / own.sd(0);
    marginal += error / kDraws;
    squares += error * error / kDraws;
  }
  EXPECT_LT(joint, -0.3);         // -0.40
  EXPECT_NEAR(marginal, 0, 0.2);  // a mean of 100: 0.1 either way
  EXPECT_NEAR(squares, 1, 0.4);
}

TEST(MarginalFit, IsWhatAVerdictEstimatesWith) {
  const Damped data = drawn(3, 0);
  Options options;
  options.sds = kOutput;
  options.latentTime = kTime;
  options.latentScale = 1;
  options.latentTolerance = 2;
  const Verdict verdict = run(data, options);
  EXPECT_EQ(verdict.finding, Finding::none);
  const Estimate& damping = verdict.calibration.at(0);
  const Likelihood likelihood(data, {0}, nominalValues(data), kTime);
  const Fit joint =
      likelihood.fit(makeHypothesis(data, {}, {0}), {kOutput, verdict.latentSizeAfter, kTime},
                     nominalValues(data), {}, kExact);
  const Fit marginal = likelihood.marginal(likelihood.marginal(joint));
  EXPECT_NEAR(damping.value, marginal.values[0], 0.03 * damping.sd);
  EXPECT_GT(damping.value - joint.values[0], 0.2 * damping.sd);
}

TEST(MarginalFit, IsTheFitItselfWhereNothingChangesTheResponseToLatentForces) {
  LinearDisagreement data(1, 60);
  VectorXd truth = nominalValues(data);
  data.draw(3, truth, kOutput, kLatent, kTime);
  const Likelihood likelihood(data, {0}, truth, kTime);
  const Fit joint =
      likelihood.fit(makeHypothesis(data, {0}, {0}), {kOutput, kLatent, kTime}, truth, {}, kExact);
  const Fit same = likelihood.marginal(joint);
  EXPECT_LT((same.xi - joint.xi).norm(), 1e-5);
  EXPECT_NEAR(same.logEvidence, joint.logEvidence, 1e-6);
  const Fit still = likelihood.fit(makeHypothesis(data, {0}, {0}), {kOutput, 0, kTime}, truth);
  EXPECT_EQ(likelihood.marginal(still).xi, still.xi);
}

// What answers a latent force five times as strongly from a value on, as a motion does that nearly
// falls over: its slope leads far away.
class Kinked : public LinearDisagreement {
 public:
  using LinearDisagreement::LinearDisagreement;
  Prediction predict(int trial, const VectorXd& values, const VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override {
    Prediction p = LinearDisagreement::predict(trial, values, latent, wanted, latentToo);
    if (values[0] > from) p.byNode *= 5;
    return p;
  }
  double from = HUGE_VAL;
};

TEST(MarginalFit, IsTheFitItselfWhereItWouldBeLedAstray) {
  Kinked data(1, 60);
  const VectorXd truth = nominalValues(data);
  data.draw(4, truth, kOutput, kLatent, kTime);
  const Likelihood likelihood(data, {0}, truth, kTime);
  const Fit joint =
      likelihood.fit(makeHypothesis(data, {}, {0}), {kOutput, kLatent, kTime}, truth, {}, kExact);
  data.from = joint.values[0] + 1e-9;
  const Fit same = likelihood.marginal(joint);
  EXPECT_EQ(same.xi, joint.xi);
  EXPECT_EQ(same.logEvidence, joint.logEvidence);
}

}  // namespace
