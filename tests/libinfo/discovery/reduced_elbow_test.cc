#include "reduced/reduced_elbow.h"

#include <gtest/gtest.h>

#include "info/discovery/likelihood/hypothesis.h"
#include "reduced/reduced_quantities.h"
#include "reduced/reduced_truth.h"

namespace {

using Eigen::Index;
using Eigen::VectorXd;
using reduced::Elbow;

reduced::Recipe plain() {
  reduced::Recipe recipe;
  recipe.nuisances = false;
  recipe.outputNoise = 0;
  recipe.trials = 1;
  recipe.seconds = 2;
  return recipe;
}

// Everything present at once, so that every derivative has something to say.
VectorXd busy(const Elbow& elbow) {
  VectorXd v = info::discover::nominalValues(elbow);
  using namespace reduced;
  v[kViscous] = 0.05;
  v[kCoulomb] = 0.05;
  v[kStribeck] = 0.03;
  v[kDrag] = 0.01;
  v[kStiffness] = 0.2;
  v[kLimit] = 0.05;
  v[kPayload] = 0.1;
  v[kTilt] = 0.05;
  v[kConstant] = 0.1;
  v[kHandForce] = 0.3;
  v[kFatigue] = 0.1;
  v[kDelay] = 0.0043;
  v[kShape] = -0.3;
  v[kTriFromBic] = 0.02;
  v[kBicFromTri] = 0.03;
  v[kWrapBic] = 0.001;
  v[kWrapTri] = -0.001;
  v[kBias] = 0.02;
  v[kGain] = 0.03;
  v[kClock] = 0.0037;
  v[kShared + 1] = 0.1;
  return v;
}

TEST(ReducedElbow, FollowsTheIndependentTruthWithEveryEffect) {
  // largest errors seen: 0.0006° without friction, 0.012° with it; the noise is 0.5°
  for (const char* effect :
       {"none",    "visc",    "coulomb", "stribeck",  "drag",    "stiffness", "limit",
        "payload", "tilt",    "const",   "handforce", "fatigue", "delay",     "shape",
        "tri<bic", "bic<tri", "wrapBIC", "wrapTRI",   "bias",    "gain",      "clock"}) {
    reduced::Recipe recipe = plain();
    const std::string id = effect;
    if (id != "none") recipe.effects = {{id, reduced::fullSize(id)}};
    const Elbow elbow(reduced::record(recipe, 5));
    VectorXd v = info::discover::nominalValues(elbow);
    v[reduced::kStribeckSpeed] = 0.4;
    v[reduced::kLimitFlexed] = 2.0;
    v[reduced::kLimitExtended] = 0.5;
    v[reduced::kFatigueTime] = 0.4;
    for (const auto& c : elbow.candidates())
      if (c.id == id) v[static_cast<Index>(c.quantities[0])] = reduced::fullSize(id);
    const double error = (elbow.outputs(0, v, {}) - elbow.measured(0)).cwiseAbs().maxCoeff();
    EXPECT_LT(error * 57.29578, 0.02) << id;
    if (id != "none") {  // and without it, not
      const VectorXd base = info::discover::nominalValues(elbow);
      const double excess = (elbow.outputs(0, base, {}) - elbow.measured(0)).cwiseAbs().maxCoeff();
      EXPECT_GT(excess * 57.29578, 0.5) << id;
    }
  }
}

TEST(ReducedElbow, DerivativesMatchDifferences) {
  const Elbow elbow(reduced::record(plain(), 6));
  const VectorXd v = busy(elbow);
  VectorXd d = VectorXd::Zero(static_cast<Index>(elbow.nodes(0).size()));
  d[7] = 0.2;
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < elbow.quantities().size(); ++i) all.push_back(i);
  const auto p = elbow.predict(0, v, d, all, true);
  EXPECT_EQ(p.outputs, elbow.outputs(0, v, d));
  for (std::size_t i : all) {
    const auto k = static_cast<Index>(i);
    const double h = 1e-5 * elbow.quantities()[i].sd *
                     (elbow.quantities()[i].logarithmic ? elbow.quantities()[i].nominal : 1);
    VectorXd up = v, down = v;
    up[k] += h;
    down[k] -= h;
    const VectorXd difference = (elbow.outputs(0, up, d) - elbow.outputs(0, down, d)) / (2 * h);
    EXPECT_GT(p.gamma.col(k).norm(), 0) << elbow.quantities()[i].name;
    EXPECT_LT((p.gamma.col(k) - difference).norm(), 2e-4 * difference.norm() + 1e-9)
        << elbow.quantities()[i].name;
  }
  for (const Index node : {Index(0), Index(7), Index(20)}) {
    VectorXd up = d, down = d;
    up[node] += 1e-5;
    down[node] -= 1e-5;
    const VectorXd difference = (elbow.outputs(0, v, up) - elbow.outputs(0, v, down)) / 2e-5;
    EXPECT_LT((p.byNode.col(node) - difference).norm(), 1e-5 * difference.norm()) << node;
    const VectorXd moved = (elbow.predict(0, v, up, {}, true).course.q -
                            elbow.predict(0, v, down, {}, true).course.q) /
                           2e-5;
    EXPECT_GT(moved.norm(), 0) << node;
    EXPECT_LT((p.courseByNode.col(node) - moved).norm(), 1e-5 * moved.norm()) << node;
  }
}

// Every kind of term that discovery makes, one of them with an exponent of 0.
TEST(ReducedElbow, FormulasHaveTheirDerivativesAndVanishWithTheirAmplitude) {
  const Elbow elbow(reduced::record(plain(), 8));
  std::vector<info::discover::FormulaTerm> terms;
  for (const char* expression :
       {"((q-1.3)/0.4)^3", "((q+0.2)/2)^2", "1", "q", "q^2", "((q-1.3)/0.4)^0", "qdot", "qdot/1.5",
        "qdot*abs(qdot)", "qdot*abs(qdot)/2.5", "qdot^3", "tanh(qdot/0.05)", "q*qdot", "sin(q)",
        "cos(q)"})
    terms.push_back({expression, terms.empty() ? 0.05 : 0.3, 0.1});
  const auto widened = elbow.withFormula(0, terms, {0, 5});
  ASSERT_TRUE(widened);
  ASSERT_EQ(widened->candidates().size(), 3U);
  EXPECT_EQ(widened->candidates()[1].id, elbow.candidates()[5].id);
  const auto& formula = widened->candidates().back();
  EXPECT_EQ(formula.id, "formula");
  ASSERT_EQ(formula.quantities.size(), terms.size());

  VectorXd v = info::discover::nominalValues(*widened);
  const VectorXd base = widened->outputs(0, v, {});
  EXPECT_EQ(base, elbow.outputs(0, info::discover::nominalValues(elbow), {}));
  for (std::size_t k = 1; k < terms.size(); ++k)
    v[static_cast<Index>(formula.quantities[k])] = terms[k].start;
  EXPECT_EQ(widened->outputs(0, v, {}), base);
  v[static_cast<Index>(formula.quantities[0])] = terms[0].start;
  const auto p = widened->predict(0, v, {}, formula.quantities, false);
  EXPECT_EQ(p.outputs, widened->outputs(0, v, {}));
  EXPECT_GT((p.outputs - base).norm(), 1e-2);
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const auto at = static_cast<Index>(formula.quantities[k]);
    const double h = 1e-5;
    VectorXd up = v, down = v;
    up[at] += h;
    down[at] -= h;
    const VectorXd difference =
        (widened->outputs(0, up, {}) - widened->outputs(0, down, {})) / (2 * h);
    EXPECT_GT(difference.norm(), 0) << terms[k].expression;
    EXPECT_LT((p.gamma.col(static_cast<Index>(k)) - difference).norm(), 2e-4 * difference.norm())
        << terms[k].expression;
  }
  for (const char* strange : {"q^2 + 1", "exp(q)", "", "((q-1.3)/0.4)^3)"})
    EXPECT_FALSE(elbow.withFormula(0, {{strange, 1, 1}}, {})) << strange;
}

TEST(ReducedElbow, EffectsOfZeroAmplitudeChangeNothing) {
  const Elbow elbow(reduced::record(plain(), 7));
  const VectorXd base = info::discover::nominalValues(elbow);
  const VectorXd y = elbow.outputs(0, base, {});
  for (const auto& c : elbow.candidates()) {
    VectorXd v = base;
    for (std::size_t i = 1; i < c.quantities.size(); ++i)
      v[static_cast<Index>(c.quantities[i])] = c.starts.back()[static_cast<Index>(i)];
    EXPECT_EQ(elbow.outputs(0, v, {}), y) << c.id;
  }
}

}  // namespace
