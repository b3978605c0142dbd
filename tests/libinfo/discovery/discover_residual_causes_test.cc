#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

#include "info/discovery/judgement/adequacy.h"
#include "info/discovery/judgement/localise.h"
#include "info/discovery/judgement/separation.h"
#include "info/probability/random_stream.h"
#include "support/drawn_oscillator.h"

namespace {

using namespace info::discover;
using Eigen::Index;
using Eigen::VectorXd;
using support::drawn;
using support::kLatent;
using support::kOutput;
using support::kTime;

// Whatever the nuisances are, scores of the map are N(0, 1) if nothing is missing.
TEST(Localise, ScoresAreStandardNormalWhenNothingIsMissing) {
  double sum = 0, squares = 0, count = 0;
  int significant = 0, inadequate = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    info::RandomStream random(seed, 77);
    const LinearDisagreement data = drawn(seed, 0, 1 + 0.2 * random.normal());
    const Likelihood likelihood(data, {0, 1}, nominalValues(data), kTime);
    const Fit fit = likelihood.fit(makeHypothesis(data, {}, {0, 1}), {kOutput, kLatent, kTime},
                                   nominalValues(data));
    const Localisation map = localise(likelihood, fit, fit, {0.5, 4, 1, 0.05});
    for (const Score& s : map.times) {
      sum += s.z;
      squares += s.z * s.z;
      ++count;
      significant += s.significant;
    }
    inadequate += adequacy(likelihood, fit, {}).adequate() ? 0 : 1;
  }
  // each cause has 3 nats by chance in less than e⁻³ of all cases; seen of the acceleration: 2 of
  // 1600
  EXPECT_LE(inadequate, 1);
  // 40 × about 34 scores, neighbours correlated
  EXPECT_NEAR(sum / count, 0, 0.1);
  EXPECT_NEAR(squares / count, 1, 0.12);
  EXPECT_LT(significant, 20);
}

// Parameters that were fitted leave correlations in white noise; they must not count as missing.
TEST(Adequacy, FindsWhiteNoiseWhiteThoughParametersWereFitted) {
  double sum = 0;
  int small = 0;
  constexpr int kSets = 200;
  for (std::uint64_t seed = 0; seed < kSets; ++seed) {
    info::RandomStream random(seed, 78);
    LinearDisagreement data(5, 40);
    VectorXd truth = nominalValues(data);
    truth[0] += 0.2 * random.normal();
    for (Index i = 4; i < truth.size(); ++i) truth[i] = 0.3 * random.normal();
    data.draw(seed, truth, 0.01 * kOutput, 0, kTime);
    const std::vector<int> trials = {0, 1, 2, 3, 4};
    const Likelihood likelihood(data, trials, nominalValues(data), kTime);
    const Fit fit = likelihood.fit(makeHypothesis(data, {}, trials), {0.01 * kOutput, 0, kTime},
                                   nominalValues(data));
    AdequacyOptions options;
    options.lags = 8;
    const double probability = adequacy(likelihood, fit, options).ljungBoxProbability;
    sum += probability;
    small += probability < 0.05;
  }
  EXPECT_NEAR(sum / kSets, 0.5, 3 * 0.29 / std::sqrt(kSets));
  EXPECT_LT(small, 22);
}

TEST(Adequacy, SeesAForceThatTheModelLacks) {
  const LinearDisagreement data = drawn(1, 3, 1);
  const Likelihood likelihood(data, {0, 1}, nominalValues(data), kTime);
  const Fit base = likelihood.fit(makeHypothesis(data, {}, {0, 1}), {kOutput, kLatent, kTime},
                                  nominalValues(data));
  EXPECT_FALSE(adequacy(likelihood, base, {}).adequate());
  const Fit push = likelihood.fit(makeHypothesis(data, {0}, {0, 1}), {kOutput, kLatent, kTime},
                                  nominalValues(data));
  EXPECT_TRUE(adequacy(likelihood, push, {}).adequate());
}

Eigen::MatrixXd correlation(Index n) {
  Eigen::MatrixXd K(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j)
      K(i, j) = latentCorrelation(LinearDisagreement::kStep * std::abs(static_cast<double>(i - j)),
                                  kTime, 0);
  return K;
}

// The evidence as it is defined: y ~ N(y0, S) against N(y0, S + s²DKDᵀ) for the best s, over all
// samples of both trials at once.
double fieldEvidence(const LinearDisagreement& data, const Fit& fit) {
  const Index n = data.measured(0).size();
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(2 * n, 2 * n), D = S;
  VectorXd e(2 * n), q(2 * n), qDot(2 * n);
  for (int t = 0; t < 2; ++t) {
    const auto p = data.predict(t, fit.values, {}, {}, true);
    D.block(t * n, t * n, n, n) = p.byNode;
    e.segment(t * n, n) = data.measured(t) - data.outputs(t, nominalValues(data), {});
    const VectorXd latent = kLatent * Eigen::MatrixXd(correlation(n).llt().matrixL()) *
                            fit.eta[static_cast<std::size_t>(t)];
    const auto course = data.predict(t, fit.values, latent, {}, true).course;
    q.segment(t * n, n) = course.q;
    qDot.segment(t * n, n) = course.qDot;
    S.block(t * n, t * n, n, n) =
        kLatent * kLatent * p.byNode * correlation(n) * p.byNode.transpose();
  }
  S.diagonal().array() += kOutput * kOutput;
  for (const FreeQuantity& free : fit.hypothesis.free) {
    VectorXd column(2 * n);
    for (int t = 0; t < 2; ++t)
      column.segment(t * n, n) = data.predict(t, fit.values, {}, {free.quantity}, false).gamma;
    S += free.sd * free.sd * column * column.transpose();
  }
  for (VectorXd* x : {&q, &qDot}) {
    x->array() -= x->mean();
    *x /= std::sqrt(x->squaredNorm() / static_cast<double>(x->size()));
  }
  Eigen::MatrixXd K(2 * n, 2 * n);
  for (Index i = 0; i < 2 * n; ++i)
    for (Index j = 0; j < 2 * n; ++j)
      K(i, j) = std::exp(-0.5 * (std::pow(q[i] - q[j], 2) + std::pow(qDot[i] - qDot[j], 2)));
  const Eigen::MatrixXd field = D * K * D.transpose();
  const auto logDensity = [&](double variance) {
    const Eigen::LLT<Eigen::MatrixXd> factor(S + variance * field);
    return -0.5 * factor.matrixL().solve(e).squaredNorm() -
           Eigen::MatrixXd(factor.matrixL()).diagonal().array().log().sum();
  };
  double best = -HUGE_VAL;
  for (double variance = 1e-5; variance < 1e4; variance *= 1.5)
    best = std::max(best, logDensity(variance) - logDensity(0));
  return best;
}

// As drawn(), with a force of its own.
LinearDisagreement driven(std::uint64_t seed,
                          const std::function<double(double x, Index k)>& force) {
  LinearDisagreement data = drawn(seed, 0, 1);
  for (int t = 0; t < 2; ++t) {
    VectorXd d = VectorXd::Zero(data.measured(t).size());
    for (Index k = 0; k < d.size(); ++k)  // y_k depends on forces before it only
      d[k] = force(data.outputs(t, nominalValues(data), d)[k], k);
    data.measure(t, data.measured(t) + data.outputs(t, nominalValues(data), d) -
                        data.outputs(t, nominalValues(data), {}));
  }
  return data;
}

// One that comes and goes, as a muscle does, and one of constant size.
Eigen::MatrixXd twoChannels(const LinearDisagreement& data) {
  const Index n = data.measured(0).size();
  Eigen::MatrixXd scale = Eigen::MatrixXd::Ones(n, 2);
  for (Index k = 0; k < n; ++k) scale(k, 0) = 1 + std::sin(0.17 * static_cast<double>(k));
  return scale;
}

ResidualEvidence remainderOf(const LinearDisagreement& data, Fit* fitted = nullptr) {
  const Likelihood likelihood(data, {0, 1}, nominalValues(data), kTime);
  const Fit fit = likelihood.fit(makeHypothesis(data, {}, {0, 1}), {kOutput, kLatent, kTime},
                                 nominalValues(data));
  if (fitted != nullptr) *fitted = fit;
  return residualEvidence(likelihood, fit);
}

TEST(Remainder, HasTheEvidenceOfAGaussianProcessOverTheState) {
  for (const double size : {2.0, 4.0, 8.0}) {
    const LinearDisagreement data =
        driven(11, [&](double x, Index) { return size * std::tanh(4 * x); });
    Fit fit;
    const double found = remainderOf(data, &fit).of(Cause::state) + std::log(5.0);
    const double exact = fieldEvidence(data, fit);
    EXPECT_GT(exact, 0.5);
    // five sizes instead of many, fifteen directions instead of all
    EXPECT_LT(found, exact + 0.05) << size;
    EXPECT_GT(found, exact - 1 - 5e-4 * exact) << size;
  }
}

TEST(Remainder, IsSeldomFoundWhereThereIsNone) {
  // Bayes factors of e² by chance: less than e⁻² of the time
  std::map<Cause, int> found;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    LinearDisagreement data = drawn(seed, 0, 1);
    data.scale = twoChannels(data);
    data.tellsSpeeds = true;
    const ResidualEvidence evidence = remainderOf(data);
    for (const Cause cause : kCauses) found[cause] += evidence.of(cause) > 2;
  }
  for (const Cause cause : kCauses) EXPECT_LE(found[cause], 3) << name(cause);
}

// A latent force makes accelerations, and is no inertia for that: the more of it there is, the more
// of the motion's acceleration is its own.
TEST(Remainder, OfALargeLatentForceDoesNotFollowTheAccelerationThatItMakes) {
  int found = 0;
  double sum = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    LinearDisagreement data(2, 80);
    data.tellsSpeeds = true;
    data.draw(seed, nominalValues(data), kOutput / 10, 10 * kLatent, kTime);
    const Likelihood likelihood(data, {0, 1}, nominalValues(data), kTime);
    const Fit fit = likelihood.fit(makeHypothesis(data, {}, {0, 1}),
                                   {kOutput / 10, 10 * kLatent, kTime}, nominalValues(data));
    const double nats = residualEvidence(likelihood, fit).of(Cause::acceleration);
    found += nats > 2;
    sum += nats;
  }
  EXPECT_LE(found, 3);
  EXPECT_LT(sum / 40, 0);
}

TEST(Remainder, OfAnInputThatComesLateFollowsTheInputs) {
  const LinearDisagreement data = driven(12, [&](double, Index k) {
    return k < 4 ? 0.0 : 2.5 * std::sin(0.3 * static_cast<double>(k - 4));
  });
  const ResidualEvidence evidence = remainderOf(data);
  EXPECT_GT(evidence.of(Cause::inputs), 5);
  EXPECT_EQ(evidence.strongest(), Cause::inputs);
}

// A mass that the model lacks pulls against every acceleration.
TEST(Remainder, OfAMassFollowsTheAcceleration) {
  LinearDisagreement data = drawn(13, 0, 1);
  data.tellsSpeeds = true;
  VectorXd start = nominalValues(data);  // a swing beside the driven motion
  start.tail(4) << 0.5, -1, -0.4, 1.5;
  for (int t = 0; t < 2; ++t) {
    const VectorXd noise = data.measured(t) - data.outputs(t, nominalValues(data), {});
    VectorXd d = VectorXd::Zero(noise.size());
    for (Index k = 2; k < d.size(); ++k) {  // y_k depends on forces before it only
      const VectorXd y = data.outputs(t, start, d);
      d[k] = -0.3 * (y[k] - 2 * y[k - 1] + y[k - 2]) /
             (LinearDisagreement::kStep * LinearDisagreement::kStep);
    }
    data.measure(t, data.outputs(t, start, d) + noise);
  }
  const ResidualEvidence evidence = remainderOf(data);
  EXPECT_GT(evidence.of(Cause::acceleration), 5);
}

TEST(Remainder, OfASensorThatIsNotStraightFollowsTheSensor) {
  LinearDisagreement data = drawn(14, 0, 1);
  for (int t = 0; t < 2; ++t) {
    const VectorXd y = data.measured(t);
    data.measure(t, y + 20 * y.cwiseAbs2());
  }
  const ResidualEvidence evidence = remainderOf(data);
  EXPECT_EQ(evidence.strongest(), Cause::sensor);
  // without the square half of that is found; smooth forces would explain 78 nats of it
  EXPECT_GT(evidence.of(Cause::sensor), 200);
}

// A lever whose length changes with the position, of the first of two channels.
TEST(Remainder, OfALeverThatChangesFollowsTheMoments) {
  const Eigen::MatrixXd scale = twoChannels(drawn(15, 0, 1));
  LinearDisagreement data = driven(15, [&](double x, Index k) { return 5 * x * scale(k, 0); });
  data.scale = scale;
  EXPECT_GT(remainderOf(data).of(Cause::moments), 5);
  data.scale.resize(0, 0);
  EXPECT_EQ(remainderOf(data).of(Cause::moments), 0);  // nothing is known of them
}

// What the outputs of a planned trial are expected to be under a hypothesis that was fitted: mean
// and covariance, written out for the oscillator.
struct Expected {
  VectorXd mean;
  Eigen::MatrixXd covariance;
};
Expected expectedOutputs(const LinearDisagreement& planned, const Fit& fit) {
  Expected expected;
  VectorXd values = nominalValues(planned);
  values.head(4) = fit.values.head(4);
  expected.mean = planned.outputs(0, values, {});
  const Index n = expected.mean.size();
  expected.covariance = kOutput * kOutput * Eigen::MatrixXd::Identity(n, n);
  for (std::size_t start : {4, 5}) {
    const VectorXd column = 0.3 * planned.predict(0, values, {}, {start}, false).gamma;
    expected.covariance += column * column.transpose();
  }
  for (std::size_t i = 0; i < fit.hypothesis.free.size(); ++i)
    for (std::size_t j = 0; j < fit.hypothesis.free.size(); ++j) {
      const FreeQuantity &a = fit.hypothesis.free[i], &b = fit.hypothesis.free[j];
      if (a.quantity >= 4 || b.quantity >= 4) continue;
      expected.covariance += fit.covariance(static_cast<Index>(i), static_cast<Index>(j)) * a.sd *
                             b.sd * planned.predict(0, values, {}, {a.quantity}, false).gamma *
                             planned.predict(0, values, {}, {b.quantity}, false).gamma.transpose();
    }
  return expected;
}

TEST(ExpectedSeparation, IsWhatIsLeftOfTheDifferenceAndBelowTheDivergence) {
  LinearDisagreement data(2, 30);
  VectorXd truth = nominalValues(data);
  truth[1] = 1;
  data.draw(3, truth, kOutput, 0, kTime);
  const Likelihood likelihood(data, {0, 1}, nominalValues(data), kTime);
  const auto fitted = [&](const std::vector<std::size_t>& effects) {
    return likelihood.fit(makeHypothesis(data, effects, {0, 1}), {kOutput, 0, kTime},
                          nominalValues(data), {}, {50, 1e-9});
  };
  const Fit push = fitted({0}), base = fitted({});
  const LinearDisagreement planned(1, 50);
  const double found = expectedSeparation(planned, data, push, base);
  const Expected a = expectedOutputs(planned, push), b = expectedOutputs(planned, base);
  const VectorXd difference = a.mean - b.mean;
  // noise and start are common, so they are in the sum once
  Eigen::MatrixXd S = a.covariance + b.covariance;
  S -= expectedOutputs(planned, likelihood.fit(startsOnly(data, {0, 1}), {kOutput, 0, kTime},
                                               nominalValues(data)))
           .covariance;
  EXPECT_NEAR(found, 0.5 * difference.dot(S.llt().solve(difference)), 1e-6 * found);
  EXPECT_GT(found, 5);
  // Kullback and Leibler's divergence, the expected log Bayes factor of linear models
  const Eigen::MatrixXd ratio = b.covariance.llt().solve(a.covariance);
  const double divergence =
      0.5 * (difference.dot(b.covariance.llt().solve(difference)) + ratio.trace() -
             static_cast<double>(difference.size()) - std::log(ratio.determinant()));
  EXPECT_LT(found, divergence);
  EXPECT_GT(found, 0.2 * divergence);
  EXPECT_NEAR(expectedSeparation(planned, data, push, push), 0, 1e-12);
}

TEST(ExpectedSeparation, GrowsWithTheTrial) {
  const LinearDisagreement data = drawn(5, 2, 1.1);
  const Likelihood likelihood(data, {0, 1}, nominalValues(data), kTime);
  const auto fitted = [&](std::size_t effect) {
    return likelihood.fit(makeHypothesis(data, {effect}, {0, 1}), {kOutput, kLatent, kTime},
                          nominalValues(data));
  };
  const Fit push = fitted(0), bias = fitted(2);
  const LinearDisagreement planned(1, 50), longer(1, 100);
  EXPECT_GT(expectedSeparation(longer, data, push, bias),
            expectedSeparation(planned, data, push, bias));
}

}  // namespace
