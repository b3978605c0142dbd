#include <gtest/gtest.h>

#include <cmath>

#include "info/discovery/discover.h"
#include "info/discovery/likelihood/joint_fit.h"
#include "info/discovery/nonparametric/unknown.h"
#include "support/drawn_oscillator.h"

namespace {

using namespace info::discover;
using Eigen::Index;
using Eigen::VectorXd;
using support::kOutput;
using support::kTime;

// Two trials of the oscillator with a further force f(y_k), which acts on the next sample.
template <class Force>
LinearDisagreement withForce(std::uint64_t seed, const Force& force) {
  LinearDisagreement data(2, 100);
  VectorXd truth = nominalValues(data);
  truth.tail(4) << 0.9, -1.2, -0.7, 2;
  data.draw(seed, truth, kOutput, 0, kTime);
  for (int t = 0; t < 2; ++t) {
    const VectorXd noise = data.measured(t) - data.outputs(t, truth, {});
    VectorXd y = data.outputs(t, truth, {});
    for (Index k = 0; k < y.size(); ++k) y = data.outputs(t, truth, y.unaryExpr(force));
    data.measure(t, y + noise);
  }
  return data;
}

TEST(TimeTie, OfAForceThatBeginsInEveryTrialIsAStep) {
  std::vector<std::vector<double>> times(2);
  std::vector<VectorXd> forces(2);
  for (int trial = 0; trial < 2; ++trial) {
    for (int k = 0; k <= 40; ++k) times[trial].push_back(0.03 * trial + 0.1 * k);
    forces[trial] = VectorXd::NullaryExpr(41, [&](Index k) {
      const double own = 0.1 * std::sin((1 + trial) * 2.3 * static_cast<double>(k));
      return own + (times[trial][static_cast<std::size_t>(k)] > 2.5 ? 1.3 : 0.0);
    });
  }
  const TimeTie tie = timeTie(times, forces);
  EXPECT_GT(tie.share, 0.95);
  EXPECT_NEAR(tie.stepAt, 2.5, 0.1);
  EXPECT_GT(tie.stepShare, 0.95);
  EXPECT_NEAR(tie.before, 0, 0.05);
  EXPECT_NEAR(tie.after, 1.3, 0.05);
}

TEST(TimeTie, OfForcesOfTheirOwnIsWeak) {
  std::vector<double> times;
  std::vector<VectorXd> forces;
  for (int k = 0; k <= 100; ++k) times.push_back(0.05 * k);
  for (const double rate : {2.0, 3.1, 4.7})
    forces.push_back(
        VectorXd::NullaryExpr(101, [&](Index k) { return std::sin(rate * 0.05 * double(k)); }));
  const TimeTie tie = timeTie({times, times, times}, forces);
  EXPECT_LT(tie.share, 0.6);
  EXPECT_LT(tie.stepShare, 0.8);
  EXPECT_EQ(timeTie({times}, {forces[0]}).share, 0);
}

Unknown describedIn(const LinearDisagreement& data, double latent) {
  const Likelihood likelihood(data, {0, 1}, nominalValues(data), kTime);
  const Fit fit = likelihood.fit(makeHypothesis(data, {}, {0, 1}), {kOutput, latent, kTime},
                                 nominalValues(data));
  return describeUnknown(likelihood, fit);
}

TEST(Formula, IsThatOfTheForceThatIsMissing) {
  const Unknown found = describedIn(withForce(1, [](double q) { return -20 * q * q * q; }), 1);
  ASSERT_EQ(found.terms.size(), 1U) << found.formula;
  const SymbolicTerm& term = found.terms[0];
  EXPECT_EQ(term.name, "q³");
  EXPECT_EQ(term.expression, "q^3");
  // nodes are a step apart, so the force at a node is known to a step
  EXPECT_NEAR(term.coefficient, -20, 4 * term.sd + 0.5);
  EXPECT_LT(term.sd, 2);
  EXPECT_TRUE(found.stable);
  EXPECT_GT(found.evidence, 20);
  EXPECT_GT(found.explained, 0.5);
  EXPECT_LE(found.explained, 1);
}

// The oscillator with a force that changes its sign with the speed, in metres or in other units of
// length.
class Scaled : public LinearDisagreement {
 public:
  static constexpr double kSmallSpeed = 0.4;  // [m/s]

  explicit Scaled(double unit)
      : LinearDisagreement(2, 100), quantities_(LinearDisagreement::quantities()) {
    axes_[0].unit = "m";
    axes_[0].smallSpeed = unit * kSmallSpeed;
    scale = MatrixXd::Constant(100, 1, unit);
    VectorXd truth = nominalValues(*this);
    truth.tail(4) << 0.9, -1.2, -0.7, 2;
    draw(1, truth, kOutput, 0, kTime);
    for (int t = 0; t < 2; ++t) {
      const VectorXd noise = measured(t) - outputs(t, truth, {});
      VectorXd y = outputs(t, truth, {});
      for (Index k = 0; k < y.size(); ++k) {
        VectorXd force = VectorXd::Zero(y.size());
        for (Index i = 1; i < y.size(); ++i)
          force[i] = -3 * std::tanh((y[i] - y[i - 1]) / kStep / kSmallSpeed);
        y = outputs(t, truth, force);
      }
      measure(t, unit * (y + noise));
    }
    for (Quantity& quantity : quantities_) {
      quantity.nominal *= unit;
      quantity.sd *= unit;
    }
  }
  const std::vector<Quantity>& quantities() const override { return quantities_; }
  const std::vector<Axis>& axes() const override { return axes_; }

 private:
  std::vector<Quantity> quantities_;
  std::vector<Axis> axes_{1};
};

TEST(Formula, IsTheSameInOtherUnits) {
  const auto described = [](double unit) {
    const Scaled data(unit);
    const Likelihood likelihood(data, {0, 1}, nominalValues(data), kTime);
    return describeUnknown(
        likelihood, likelihood.fit(makeHypothesis(data, {}, {0, 1}), {unit * kOutput, 1, kTime},
                                   nominalValues(data)));
  };
  const Unknown one = described(1), other = described(4);
  ASSERT_FALSE(one.terms.empty());
  ASSERT_EQ(other.terms.size(), one.terms.size()) << one.formula << ", " << other.formula;
  EXPECT_EQ(one.terms[0].expression, "tanh(qdot/0.4)");
  EXPECT_EQ(other.terms[0].expression, "tanh(qdot/1.6)");
  EXPECT_LT(one.terms[0].coefficient, -2);
  EXPECT_NEAR(other.terms[0].coefficient, 4 * one.terms[0].coefficient, 1e-6);
  EXPECT_NEAR(other.evidence, one.evidence, 1e-6);
}

TEST(Formula, IsNoneWhereNothingIsMissing) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Unknown found = describedIn(withForce(seed, [](double) { return 0.0; }), 0.5);
    EXPECT_LT(found.evidence, 5) << found.formula;
    EXPECT_GE(found.evidence, 0);
    EXPECT_EQ(found.terms.empty(), found.evidence == 0);
  }
}

// What a parameter may be is nothing for a formula: the input's gain, here known to nothing.
TEST(Formula, TakesNothingThatAParameterExplains) {
  class Vague : public LinearDisagreement {
   public:
    explicit Vague(LinearDisagreement data)
        : LinearDisagreement(std::move(data)), wide_(LinearDisagreement::quantities()) {
      wide_[0].sd = 50;
    }
    const std::vector<Quantity>& quantities() const override { return wide_; }

   private:
    std::vector<Quantity> wide_;
  };
  LinearDisagreement louder(2, 100);
  VectorXd truth = nominalValues(louder);
  truth[0] = 4;
  louder.draw(5, truth, kOutput, 0, kTime);
  const Unknown strict = describedIn(louder, 0.5), vague = describedIn(Vague(louder), 0.5);
  EXPECT_EQ(strict.terms.at(0).name, "u_u");
  EXPECT_TRUE(strict.terms[0].expression.empty());
  EXPECT_GT(strict.evidence, 20);
  EXPECT_LT(vague.evidence, 5) << vague.formula;
}

// A catalogue of one force that cannot pull; a constant pull is offered as a formula, nothing else.
class Nameless : public LinearDisagreement {
 public:
  Nameless(LinearDisagreement data, bool offers)
      : LinearDisagreement(std::move(data)),
        offers_(offers),
        known_{LinearDisagreement::candidates()[1]} {}
  const std::vector<Candidate>& candidates() const override { return known_; }
  std::unique_ptr<DiscoveryProblem> withFormula(
      std::size_t axis, const std::vector<FormulaTerm>& terms,
      const std::vector<std::size_t>& kept) const override {
    EXPECT_EQ(axis, 0U);
    if (!offers_ || terms.size() > 1) return nullptr;
    EXPECT_EQ(terms[0].expression, "1");
    EXPECT_TRUE(kept.empty());
    auto widened = std::make_unique<Nameless>(*this);
    widened->known_ = {LinearDisagreement::candidates()[0]};
    widened->known_[0].id = "formula";
    widened->known_[0].starts[0][0] = terms[0].start;
    return widened;
  }

 private:
  bool offers_;
  std::vector<Candidate> known_;
};

TEST(Formula, IsRacedWhereTheDataOfferIt) {
  const LinearDisagreement data = withForce(3, [](double) { return -2.0; });
  Options options;
  options.sds = kOutput;
  const Verdict plain = run(Nameless(data, false), options);
  EXPECT_EQ(plain.finding, Finding::unknown) << plain.sentence;
  EXPECT_FALSE(plain.formula);
  const Verdict raced = run(Nameless(data, true), options);
  EXPECT_EQ(raced.finding, Finding::unknown);
  ASSERT_TRUE(raced.formula);
  EXPECT_TRUE(raced.formula->wins);
  EXPECT_GT(raced.formula->logBayesFactor, 20);
  ASSERT_EQ(raced.formula->values.size(), 1U);
  EXPECT_NEAR(raced.formula->values[0], -2, 4 * raced.formula->sds[0]);
  EXPECT_TRUE(raced.formula->after.adequate());
  EXPECT_NE(raced.sentence.find(raced.formula->text + " explains the residual."), std::string::npos)
      << raced.sentence;
}

}  // namespace
