#include "info/design/design_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "info/design/bounded_profiles.h"
#include "info/design/cma_es.h"
#include "info/information/optimality.h"

namespace info {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd box(const VectorXd& x) {
  return x.cwiseMax(-1.0).cwiseMin(1.0);
}

/// I grows towards x = (0.5, 1): the second limit is met.
DesignProblem problem() {
  DesignProblem p;
  p.run = [](const VectorXd& x) {
    DesignOutcome outcome;
    outcome.possible = true;
    outcome.information = MatrixXd::Identity(2, 2);
    outcome.information(0, 0) = 3 - std::pow(x[0] - 0.5, 2);
    outcome.information(1, 1) = 4 + x[1];
    outcome.penalty = 0.1 * x[0] * x[0];
    return outcome;
  };
  p.project = box;
  p.cost = [](const MatrixXd& I, double tolerance) {
    const Criterion c = criterion(Optimality::d, I, tolerance);
    return InformationCost{-c.value, -c.dvalue_dI};
  };
  return p;
}

TEST(DesignSearch, GradientIsThatOfCostAndPenalty) {
  const VectorXd x = Eigen::Vector2d(-0.3, 0.2);
  const DesignSearch search(problem(), x);
  const VectorXd g = search.gradient(1e-9);
  const double I0 = 3 - std::pow(-0.8, 2);
  EXPECT_NEAR(g[0], 2 * -0.8 / I0 + 0.2 * -0.3, 1e-4);
  EXPECT_NEAR(g[1], -1 / 4.2, 1e-4);
}

TEST(DesignSearch, FindsTheBestExperimentWithinTheLimits) {
  DesignSearch one(problem(), Eigen::Vector2d(-0.9, -0.9));
  SearchOptions options;
  options.slopeTolerance = 1e-9;
  const SearchResult result = search(one, options);
  EXPECT_TRUE(result.converged) << describe(result.why);
  EXPECT_DOUBLE_EQ(one.x()[1], 1);
  // 2(x − ½)/(3 − (x − ½)²) + 0.2 x = 0
  const double x = one.x()[0];
  EXPECT_NEAR(2 * (x - 0.5) / (3 - (x - 0.5) * (x - 0.5)) + 0.2 * x, 0, 1e-4);
  EXPECT_LT(result.costs.back(), result.costs.front());
}

TEST(DesignSearch, DoesNotStartFromAnImpossibleExperiment) {
  DesignProblem p = problem();
  p.run = [](const VectorXd&) { return DesignOutcome{}; };
  EXPECT_THROW(DesignSearch(p, VectorXd::Zero(2)), std::domain_error);
}

TEST(DesignSearch, StopsWhereItIs) {
  DesignSearchOptions stopped;
  stopped.stop = [] { return true; };
  DesignSearch one(problem(), VectorXd::Zero(2), stopped);
  EXPECT_EQ(one.findDirection(1e-9).slope, 0);
}

BoundedProfiles profiles() {
  return {{0, 1, 2, 4}, {{-10, 10, 5, 0.0}, {0, 1, 0.25, {}}}};
}

TEST(BoundedProfiles, ProjectionIsTheNearestPointThatKeepsTheLimits) {
  const BoundedProfiles p = profiles();
  VectorXd x(8);
  x << 3, -2, 0.9, -0.4, 1.5, -1, 0.2, 0.8;
  const VectorXd z = p.project(x);
  EXPECT_LE(p.excess(z), 1e-12);
  EXPECT_GT(p.excess(x), 0.5);
  EXPECT_LT((p.project(z) - z).norm(), 1e-9);
  // nearest: (x − z)·(y − z) ≤ 0 for every y that keeps them
  for (int i = 0; i < 200; ++i) {
    VectorXd y(8);
    for (int k = 0; k < 8; ++k) y[k] = 2 * std::sin(1.7 * i + 2.3 * k * k);
    EXPECT_LE((x - z).dot(p.project(y) - z), 1e-6);
  }
}

TEST(BoundedProfiles, ValuesKeepLimitsAndRates) {
  const BoundedProfiles p = profiles();
  VectorXd x(8);
  x << 0, 5, -5, 5, 3, -3, 3, -3;
  std::vector<double> times;
  for (int k = 0; k <= 400; ++k) times.push_back(0.01 * k);
  const MatrixXd u = p.values(p.project(x), times);
  EXPECT_EQ(u(0, 0), 0);
  EXPECT_LE(u.col(0).cwiseAbs().maxCoeff(), 10);
  EXPECT_GE(u.col(1).minCoeff(), 0);
  EXPECT_LE(u.col(1).maxCoeff(), 1);
  const MatrixXd rate = (u.bottomRows(400) - u.topRows(400)) / 0.01;
  EXPECT_LE(rate.col(0).cwiseAbs().maxCoeff(), 5 * (1 + 1e-9));
  EXPECT_LE(rate.col(1).cwiseAbs().maxCoeff(), 0.25 * (1 + 1e-9));
  EXPECT_GT(rate.col(0).cwiseAbs().maxCoeff(), 4.9);
  // and back
  const VectorXd z = p.project(x);
  EXPECT_LT((p.coefficients(p.values(z, p.knots())) - z).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(BoundedProfiles, RefusesImpossibleLimits) {
  EXPECT_THROW(BoundedProfiles({0}, {}), std::invalid_argument);
  EXPECT_THROW(BoundedProfiles({0, 0}, {}), std::invalid_argument);
  EXPECT_THROW(BoundedProfiles({0, 1}, {{1, 1, 1, {}}}), std::invalid_argument);
  EXPECT_THROW(BoundedProfiles({0, 1}, {{0, 1, 0, {}}}), std::invalid_argument);
  EXPECT_THROW(BoundedProfiles({0, 1}, {{0, 1, std::nan(""), {}}}), std::invalid_argument);
  EXPECT_THROW(BoundedProfiles({0, 1}, {{0, 1, 1, 2.0}}), std::invalid_argument);
}

TEST(Evolution, FindsTheMinimumOfAnIllScaledBowl) {
  const auto bowl = [](const VectorXd& x) {
    double sum = 0;
    for (int i = 0; i < 6; ++i) sum += std::pow(10, i / 2.0) * std::pow(x[i] - 0.1 * i, 2);
    return sum;
  };
  EvolutionOptions options;
  options.generations = 250;
  const EvolutionResult r = evolve(bowl, box, VectorXd::Constant(6, -0.8), options);
  EXPECT_LT(r.cost, 1e-8);
  EXPECT_EQ(r.evaluations, 1 + 250 * 9);
  EXPECT_LT(r.cost, r.costs.front());
}

TEST(Evolution, KeepsToTheSetAndPassesOverWhatIsImpossible) {
  const auto cost = [](const VectorXd& x) {
    return x[0] < -0.5 ? std::nan("") : (x - VectorXd::Constant(3, 2)).squaredNorm();
  };
  EvolutionOptions options;
  options.generations = 80;
  const EvolutionResult r = evolve(cost, box, VectorXd::Zero(3), options);
  EXPECT_LT((r.x - VectorXd::Ones(3)).norm(), 1e-6);
  options.threads = 3;
  EXPECT_EQ(evolve(cost, box, VectorXd::Zero(3), options).x, r.x);
}

TEST(Evolution, RefusesNothingToDo) {
  const auto cost = [](const VectorXd&) { return 0.0; };
  EXPECT_THROW(evolve(cost, box, VectorXd(0)), std::invalid_argument);
  EvolutionOptions options;
  options.spread = 0;
  EXPECT_THROW(evolve(cost, box, VectorXd::Zero(1), options), std::invalid_argument);
}

}  // namespace
}  // namespace info
