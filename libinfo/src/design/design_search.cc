#include "info/design/design_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "info/parallel_for.h"

namespace info {

using Eigen::Index;
using Eigen::VectorXd;

namespace {
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double unitTolerance = 1e-9;
}  // namespace

DesignSearch::DesignSearch(DesignProblem problem, const VectorXd& start,
                           DesignSearchOptions options)
    : problem_(std::move(problem)), options_(std::move(options)), x_(problem_.project(start)) {
  at_ = problem_.run(x_);
  if (!at_.possible)
    throw std::domain_error("the search must start from an experiment that respects its limits");
  cost_ = problem_.cost(at_.information, unitTolerance).value + at_.penalty;
}

double DesignSearch::costOf(const DesignOutcome& outcome) const {
  if (!outcome.possible || !outcome.information.allFinite()) return infinite;
  try {
    const double cost = problem_.cost(outcome.information, unitTolerance).value + outcome.penalty;
    return std::isfinite(cost) ? cost : infinite;
  } catch (const std::domain_error&) {
    return infinite;
  }
}

VectorXd DesignSearch::gradient(double repeatedTolerance) const {
  const InformationCost at = problem_.cost(at_.information, repeatedTolerance);
  VectorXd gradient = VectorXd::Zero(x_.size());
  parallelFor(static_cast<int>(x_.size()), options_.threads, [&](int i) {
    if (stopped()) return;
    // towards the middle first; the other way if there is no such experiment
    const double inward = x_[i] > 0 ? -options_.difference : options_.difference;
    for (const double delta : {inward, -inward}) {
      VectorXd moved = x_;
      moved[i] += delta;
      const DesignOutcome there = problem_.run(moved);
      if (!there.possible || !there.information.allFinite()) continue;
      gradient[i] = (at.dvalue_dI.cwiseProduct(there.information - at_.information).sum() +
                     there.penalty - at_.penalty) /
                    delta;
      return;
    }
  });
  return gradient;
}

SearchProblem::Direction DesignSearch::findDirection(double repeatedTolerance) {
  gradient_ = gradient(repeatedTolerance);
  const double steepest = gradient_.cwiseAbs().maxCoeff();
  if (stopped() || !(steepest > 0)) {
    direction_ = VectorXd::Zero(x_.size());
    return {0, 0};
  }
  // at first, the steepest input moves by a quarter of its half range
  double length = 0.25 / steepest;
  if (previousX_.size() == x_.size()) {
    const VectorXd s = x_ - previousX_;
    const VectorXd y = gradient_ - previousGradient_;
    const double curvature = s.dot(y);
    length = curvature > 0 ? s.squaredNorm() / curvature : 4 * length;
    length = std::clamp(length, 0.01 / steepest, 4 / steepest);
  }
  direction_ = problem_.project(x_ - length * gradient_) - x_;
  return {gradient_.dot(direction_), direction_.cwiseAbs().maxCoeff()};
}

double DesignSearch::trial(double step) {
  if (stopped()) return infinite;
  trialX_ = x_ + step * direction_;
  trialAt_ = problem_.run(trialX_);
  trialCost_ = costOf(trialAt_);
  return trialCost_;
}

void DesignSearch::accept() {
  previousX_ = std::move(x_);
  previousGradient_ = gradient_;
  x_ = trialX_;
  at_ = std::move(trialAt_);
  cost_ = trialCost_;
}

}  // namespace info
