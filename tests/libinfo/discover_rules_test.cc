#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>

#include "info/discover/decide.h"
#include "info/discover/separation.h"
#include "info/discover/shorter_steps.h"
#include "info/random_stream.h"
#include "support/linear_disagreement.h"

namespace {

using namespace info::discover;
using Eigen::Index;
using Eigen::VectorXd;

// Made-up evidence over three structures and a parameter.
std::vector<Candidate> catalogue() {
  std::vector<Candidate> all(4);
  const char* ids[] = {"a", "b", "c", "p"};
  for (std::size_t i = 0; i < 4; ++i) {
    all[i].id = all[i].name = ids[i];
    all[i].quantities = {i};
    all[i].deviations = {1};
  }
  all[2].equivalents = {"b"};
  all[3].kind = EffectKind::parameter;
  return all;
}
Judgement raced(std::vector<std::pair<std::vector<std::size_t>, double>> table,
                std::vector<std::size_t> chosen) {
  Judgement judgement;
  judgement.raced.emplace_back();
  for (auto& [effects, evidence] : table) {
    Finalist f;
    f.effects = effects;
    f.logEvidence = evidence;
    judgement.raced.push_back(f);
  }
  judgement.chosen = std::move(chosen);
  return judgement;
}

TEST(Decide, SaysNoneWhenTheBaseFitsAndNothingEarnedItsPlace) {
  const Decision d = decide(catalogue(), raced({{{0}, 3.0}}, {}), {});
  EXPECT_EQ(d.finding, Finding::none);
  EXPECT_TRUE(d.effects.empty());
}

TEST(Decide, SaysUnknownWhenTheBaseDoesNotFitAndNothingEarnedItsPlace) {
  Judgement j = raced({{{0}, 3.0}}, {});
  j.before.white = false;
  EXPECT_EQ(decide(catalogue(), j, {}).finding, Finding::unknown);
  j.before.white = true;
  j.latentBefore = 0.2;
  EXPECT_EQ(decide(catalogue(), j, {}).finding, Finding::unknown);
  j.latentBefore = 0;
  j.strangeBefore = true;
  EXPECT_EQ(decide(catalogue(), j, {}).finding, Finding::unknown);
}

TEST(Decide, SaysParameterWhenOneIsOffByMoreThanItsTolerance) {
  Judgement j = raced({{{0}, 3.0}}, {});
  j.surprise = 3.2;
  EXPECT_EQ(decide(catalogue(), j, {}).finding, Finding::parameter);
  EXPECT_EQ(decide(catalogue(), raced({{{3}, 9.0}, {{0}, 2.0}}, {3}), {}).finding,
            Finding::parameter);
}

TEST(Decide, NamesALeaderWithoutRivals) {
  const Decision d = decide(catalogue(), raced({{{0}, 30.0}, {{1}, 20.0}, {{3}, 10}}, {0}), {});
  EXPECT_EQ(d.finding, Finding::named);
  ASSERT_EQ(d.effects.size(), 1U);
  EXPECT_EQ(d.effects[0].candidate, 0U);
  EXPECT_DOUBLE_EQ(d.effects[0].logBayesFactor, 30);
  EXPECT_NEAR(d.probability, 1 / (1 + std::exp(-10.0) + std::exp(-20.0) + 4 * std::exp(-30.0)),
              1e-12);
}

TEST(Decide, CallsRivalsWithinTheClassAndDeclaredEquivalentsAmbiguous) {
  const Decision near = decide(catalogue(), raced({{{0}, 30.0}, {{1}, 26.0}}, {0}), {});
  EXPECT_EQ(near.finding, Finding::ambiguous);
  EXPECT_EQ(near.effects[0].equals, (std::vector<std::size_t>{0, 1}));
  EXPECT_FALSE(near.effects[0].exact);
  const Decision exact = decide(catalogue(), raced({{{2}, 30.0}, {{1}, 5.0}}, {2}), {});
  EXPECT_EQ(exact.finding, Finding::ambiguous);
  EXPECT_TRUE(exact.effects[0].exact);
}

TEST(Decide, ComparesEachOfSeveralEffectsInItsPlace) {
  const Decision d = decide(
      catalogue(), raced({{{0}, 30.0}, {{1}, 12.0}, {{0, 1}, 50.0}, {{0, 3}, 47.0}}, {0, 1}), {});
  EXPECT_EQ(d.finding, Finding::ambiguous);
  EXPECT_EQ(d.effects[0].equals, (std::vector<std::size_t>{0}));
  EXPECT_EQ(d.effects[1].equals, (std::vector<std::size_t>{1, 3}));
  EXPECT_DOUBLE_EQ(d.effects[0].logBayesFactor, 38);
}

TEST(Decide, CallsALeaderASurrogateWhereSomethingIsLeft) {
  for (int what = 0; what < 6; ++what) {
    Judgement j = raced({{{0}, 30.0}}, {0});
    if (what == 0) j.after.white = false;
    if (what == 1) j.after.independent = false;
    if (what == 2) j.latentAfter = 0.2;
    if (what == 3) j.heldOutWorse = true;
    if (what == 4) j.strangeAfter = true;
    if (what == 5) j.after.causeless = false;
    const Decision d = decide(catalogue(), j, {});
    EXPECT_EQ(d.finding, Finding::unknown) << what;
    EXPECT_TRUE(d.surrogate);
    EXPECT_EQ(d.effects.size(), 1U);
    EXPECT_EQ(d.probability, 0);
  }
}

TEST(Decide, LetsInnovationsOfTheWrongSizeVetoTheProbability) {
  Judgement j = raced({{{0}, 30.0}}, {0});
  j.after.sized = false;
  const Decision d = decide(catalogue(), j, {});
  EXPECT_EQ(d.finding, Finding::named);
  EXPECT_TRUE(d.vetoed);
  EXPECT_EQ(d.probability, 0);
}

TEST(Adequacy, KnowsTheChiSquareDistribution) {
  EXPECT_NEAR(chiSquareTail(31.41043284423092, 20), 0.05, 1e-10);
  EXPECT_NEAR(chiSquareTail(10.82756617078829, 1), 0.001, 1e-10);
  // Wilson and Hilferty's approximation
  const double a = 2 / (9 * 1300.0);
  EXPECT_NEAR(chiSquareQuantile(0.001, 1300), 1300 * std::pow(1 - a + 3.090232 * std::sqrt(a), 3),
              0.05);
}

TEST(Gap, IsClosedByWhatIsLeftAboveTheFloor) {
  Gap gap{10, 5, 2, 1, 100, {}, {}};
  closeGap(gap);
  EXPECT_DOUBLE_EQ(*gap.closedFromCalibrated, 1 - 3.0 / 24);
  EXPECT_DOUBLE_EQ(*gap.closedFromNominal, 1 - 3.0 / 99);
  gap.calibrated = 1.02;
  closeGap(gap);
  EXPECT_FALSE(gap.closedFromCalibrated);
}

TEST(BenjaminiHochberg, KeepsTheRightOnes) {
  std::vector<Score> scores(4);
  // p = 0.0027, 0.0164, 0.0455, 0.317; thresholds 0.0125, 0.025, 0.0375, 0.05
  scores[0].z = 2;
  scores[1].z = -3;
  scores[2].z = 1;
  scores[3].z = 2.4;
  benjaminiHochberg(scores, 0.05);
  EXPECT_FALSE(scores[0].significant);
  EXPECT_TRUE(scores[1].significant);
  EXPECT_FALSE(scores[2].significant);
  EXPECT_TRUE(scores[3].significant);
}

constexpr double kOutput = 0.02, kLatent = 0.3, kTime = 0.1;

LinearDisagreement drawn(std::uint64_t seed, double push, double gain) {
  LinearDisagreement data(2, 80);
  VectorXd truth = nominalValues(data);
  truth[0] = gain;
  truth[1] = push;
  data.draw(seed, truth, kOutput, kLatent, kTime);
  return data;
}

// Whatever the nuisances are, scores of the map are N(0, 1) if nothing is missing.
TEST(Localise, ScoresAreStandardNormalWhenNothingIsMissing) {
  double sum = 0, squares = 0, count = 0;
  int significant = 0;
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
    const Adequacy tests = adequacy(likelihood, fit, {});
    EXPECT_TRUE(tests.adequate()) << seed;
  }
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

// What the engine is told of drawn().
Options optionsOfDrawn() {
  Options options;
  options.outputDeviation = kOutput;
  options.latentScale = 1;
  options.latentTime = kTime;
  options.latentTolerance = 0.6;
  return options;
}

TEST(Discover, FindsTheForceOnALinearOscillator) {
  const LinearDisagreement data = drawn(5, 2, 1.1);
  Options options = optionsOfDrawn();
  int calls = 0;
  options.progress = [&](const Progress& p) {
    EXPECT_GE(p.fraction, 0);
    EXPECT_LE(p.fraction, 1);
    return ++calls > 0;
  };
  const Verdict v = run(data, options);
  EXPECT_EQ(v.reached, Stage::finished);
  EXPECT_GT(calls, 5);
  ASSERT_EQ(v.effects.size(), 1U);
  // push and shove are the same force; the one-sided prior is worth log 2
  EXPECT_EQ(v.finding, Finding::ambiguous);
  EXPECT_NEAR(v.effects[0].estimates[0].value, 2, 4 * v.effects[0].estimates[0].deviation);
  EXPECT_NEAR(v.latentSizeAfter, kLatent, 0.1);

  // the band about the simulation: the model is linear, so a deviation more moves it by dy/dA·σ_A
  const Estimate& push = v.effects[0].estimates[0];
  Eigen::VectorXd values = v.values;
  values[static_cast<Eigen::Index>(push.quantity)] += push.deviation;
  const Eigen::VectorXd moved = data.outputs(0, values, {}) - data.outputs(0, v.values, {});
  const Eigen::VectorXd expected = (moved.array().square() + kOutput * kOutput).sqrt();
  EXPECT_NEAR((predictedDeviation(data, v, 0) - expected).cwiseAbs().maxCoeff(), 0, 1e-12);
  EXPECT_GT(moved.cwiseAbs().maxCoeff(), 0.1 * kOutput);
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
  VectorXd e(2 * n), q(2 * n);
  for (int t = 0; t < 2; ++t) {
    const auto p = data.predict(t, fit.values, {}, {}, true);
    D.block(t * n, t * n, n, n) = p.latentGamma;
    e.segment(t * n, n) = data.measured(t) - data.outputs(t, nominalValues(data), {});
    q.segment(t * n, n) = data.outputs(t, fit.values,
                                       kLatent * Eigen::MatrixXd(correlation(n).llt().matrixL()) *
                                           fit.eta[static_cast<std::size_t>(t)]);
    S.block(t * n, t * n, n, n) =
        kLatent * kLatent * p.latentGamma * correlation(n) * p.latentGamma.transpose();
  }
  S.diagonal().array() += kOutput * kOutput;
  for (const FreeQuantity& free : fit.hypothesis.free) {
    VectorXd column(2 * n);
    for (int t = 0; t < 2; ++t)
      column.segment(t * n, n) = data.predict(t, fit.values, {}, {free.quantity}, false).gamma;
    S += free.deviation * free.deviation * column * column.transpose();
  }
  q.array() -= q.mean();
  q /= std::sqrt(q.squaredNorm() / static_cast<double>(q.size()));
  Eigen::MatrixXd K(2 * n, 2 * n);
  for (Index i = 0; i < 2 * n; ++i)
    for (Index j = 0; j < 2 * n; ++j) K(i, j) = std::exp(-0.5 * (q[i] - q[j]) * (q[i] - q[j]));
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

RemainderEvidence remainderOf(const LinearDisagreement& data, Fit* fitted = nullptr) {
  const Likelihood likelihood(data, {0, 1}, nominalValues(data), kTime);
  const Fit fit = likelihood.fit(makeHypothesis(data, {}, {0, 1}), {kOutput, kLatent, kTime},
                                 nominalValues(data));
  if (fitted != nullptr) *fitted = fit;
  return remainderEvidence(likelihood, fit);
}

TEST(Remainder, HasTheEvidenceOfAGaussianProcessOverTheState) {
  for (const double size : {2.0, 4.0, 8.0}) {
    const LinearDisagreement data =
        driven(11, [&](double x, Index) { return size * std::tanh(4 * x); });
    Fit fit;
    const double found = remainderOf(data, &fit).ofState + std::log(5.0);
    const double exact = fieldEvidence(data, fit);
    EXPECT_GT(exact, 0.5);
    // five sizes instead of many
    EXPECT_LT(found, exact + 0.05) << size;
    EXPECT_GT(found, exact - 1) << size;
  }
}

TEST(Remainder, IsSeldomFoundWhereThereIsNone) {
  int ofState = 0, ofInputs = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const RemainderEvidence evidence = remainderOf(drawn(seed, 0, 1));
    ofState += evidence.ofState > 2;
    ofInputs += evidence.ofInputs > 2;
  }
  // Bayes factors of e² by chance: less than e⁻² of the time
  EXPECT_LE(ofState, 3);
  EXPECT_LE(ofInputs, 3);
}

TEST(Remainder, OfAnInputThatComesLateFollowsTheInputs) {
  const LinearDisagreement data = driven(12, [&](double, Index k) {
    return k < 4 ? 0.0 : 2.5 * std::sin(0.3 * static_cast<double>(k - 4));
  });
  EXPECT_GT(remainderOf(data).ofInputs, 5);
}

TEST(Discover, FindsATrialStrangeThatWasHeldOutAndIsOfAnotherModel) {
  LinearDisagreement data(3, 80);
  VectorXd truth = nominalValues(data);
  data.draw(4, truth, kOutput, 0, kTime);
  Options options;
  options.outputDeviation = kOutput;
  options.latentScale = 1;
  options.latentTime = kTime;
  options.heldOut = {2};
  const Verdict same = run(data, options);
  EXPECT_EQ(same.finding, Finding::none);
  EXPECT_NEAR(same.heldOutBefore.value().meanSquare, 1, 0.5);
  truth[1] = 1;
  LinearDisagreement other(3, 80);
  other.draw(4, truth, kOutput, 0, kTime);
  data.measure(2, other.measured(2));
  const Verdict strange = run(data, options);
  EXPECT_EQ(strange.finding, Finding::unknown);
  EXPECT_GT(strange.heldOutBefore.value().meanSquare, strange.heldOutBefore->highest);
}

TEST(Discover, StartsFromADraft) {
  const LinearDisagreement data = drawn(5, 2, 1.1);
  const Options options = optionsOfDrawn();
  Draft draft;
  const Verdict first = run(data, options, &draft);
  ASSERT_NE(draft, nullptr);
  const Verdict again = run(data, options, &draft);
  EXPECT_LT(again.fits, first.fits);
  EXPECT_EQ(again.finding, first.finding);
  ASSERT_EQ(again.effects.size(), 1U);
  EXPECT_NEAR(again.effects[0].estimates[0].value, first.effects[0].estimates[0].value,
              0.1 * first.effects[0].estimates[0].deviation);
  EXPECT_NEAR(again.effects[0].logBayesFactor, first.effects[0].logBayesFactor, 0.2);
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
      expected.covariance += fit.covariance(static_cast<Index>(i), static_cast<Index>(j)) *
                             a.deviation * b.deviation *
                             planned.predict(0, values, {}, {a.quantity}, false).gamma *
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
  const VectorXd nothing = VectorXd::Zero(static_cast<Index>(planned.quantities().size()));
  const double found = expectedSeparation(planned, nothing, data, push, base);
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
  EXPECT_NEAR(expectedSeparation(planned, nothing, data, push, push), 0, 1e-12);
}

TEST(ExpectedSeparation, ChangesWithWhatTheExperimenterChanges) {
  const LinearDisagreement data = drawn(5, 2, 1.1);
  const Likelihood likelihood(data, {0, 1}, nominalValues(data), kTime);
  const auto fitted = [&](std::size_t effect) {
    return likelihood.fit(makeHypothesis(data, {effect}, {0, 1}), {kOutput, kLatent, kTime},
                          nominalValues(data));
  };
  const Fit push = fitted(0), bias = fitted(2);
  const LinearDisagreement planned(1, 50), longer(1, 100);
  VectorXd known = VectorXd::Zero(static_cast<Index>(planned.quantities().size()));
  const double one = expectedSeparation(planned, known, data, push, bias);
  EXPECT_GT(expectedSeparation(longer, known, data, push, bias), one);
  // a known change that both have moves both alike: the model is linear
  known[1] = 3;
  EXPECT_NEAR(expectedSeparation(planned, known, data, push, bias), one, 1e-6 * one);
  EXPECT_THROW(expectedSeparation(planned, VectorXd::Zero(2), data, push, bias),
               std::invalid_argument);
}

// As drawn(), but what is pushed cannot be simulated, or nothing can.
class Fragile : public LinearDisagreement {
 public:
  Fragile(LinearDisagreement data, bool always)
      : LinearDisagreement(std::move(data)), always_(always) {}
  Prediction predict(int trial, const VectorXd& values, const VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override {
    Prediction p = LinearDisagreement::predict(trial, values, latent, wanted, latentToo);
    if (fails(values)) p.outputs.setConstant(std::nan(""));
    return p;
  }
  VectorXd outputs(int trial, const VectorXd& values, const VectorXd& latent) const override {
    VectorXd y = LinearDisagreement::outputs(trial, values, latent);
    if (fails(values)) y.setConstant(std::nan(""));
    return y;
  }

 private:
  bool fails(const VectorXd& values) const { return always_ || values[2] != 0; }
  bool always_;
};

TEST(Discover, GoesOnWithoutACandidateThatCannotBeSimulated) {
  const Verdict v = run(Fragile(drawn(5, 2, 1.1), false), optionsOfDrawn());
  EXPECT_EQ(v.reached, Stage::finished);
  ASSERT_EQ(v.effects.size(), 1U);
  EXPECT_EQ(v.effects[0].candidate, 0U);
  for (const Finalist& f : v.finalists) EXPECT_TRUE(std::isfinite(f.logEvidence));
}

TEST(Discover, SaysThatTheModelCannotBeSimulated) {
  Options options;
  options.outputDeviation = kOutput;
  EXPECT_THROW(run(Fragile(drawn(5, 2, 1.1), true), options), std::domain_error);
}

TEST(Discover, StopsWhenToldTo) {
  const LinearDisagreement data = drawn(5, 2, 1.1);
  Options options;
  options.outputDeviation = kOutput;
  options.progress = [](const Progress& p) { return p.stage < Stage::race; };
  const Verdict v = run(data, options);
  EXPECT_EQ(v.reached, Stage::localise);
  EXPECT_EQ(v.base.size(), static_cast<Index>(data.quantities().size()));
}

// As drawn(), with a simulation that changes by `error` deviations of σ_y at half the step.
class Coarse : public LinearDisagreement {
 public:
  Coarse(LinearDisagreement data, double error)
      : LinearDisagreement(std::move(data)), error_(error) {}
  VectorXd refinedOutputs(int trial, const VectorXd& values) const override {
    return outputs(trial, values, {}).array() + error_ * kOutput;
  }

 private:
  double error_;
};

TEST(RunAtShorterSteps, HalvesTheStepUntilItNoLongerMattersOrIsTooShort) {
  std::optional<Coarse> data;
  std::vector<double> steps;
  // of second order: 0.4 deviations at 0.02, 0.1 at 0.01
  const auto attempt = [&](double step) {
    steps.push_back(step);
    data.emplace(drawn(5, 2, 1.1), 1000 * step * step);
    Options options;
    options.outputDeviation = kOutput;
    return Attempt{*data, options};
  };
  const SteppedVerdict found = runAtShorterSteps(attempt, 0.04, 0.003);
  EXPECT_EQ(steps, (std::vector<double>{0.04, 0.02, 0.01}));
  EXPECT_EQ(found.step, 0.01);
  EXPECT_NE(found.verdict.finding, Finding::numerical);
  EXPECT_NEAR(found.verdict.numericalError, 0.1, 1e-9);
  EXPECT_EQ(found.options.outputDeviation, kOutput);

  steps.clear();
  const SteppedVerdict tooShort = runAtShorterSteps(attempt, 0.04, 0.03);
  EXPECT_EQ(steps, (std::vector<double>{0.04, 0.02}));
  EXPECT_EQ(tooShort.verdict.finding, Finding::numerical);

  steps.clear();
  EXPECT_EQ(runAtShorterSteps(attempt, 0.04, HUGE_VAL).verdict.finding, Finding::numerical);
  EXPECT_EQ(steps.size(), 1U);
}

}  // namespace
