#include "info/estimation/estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "info/information/identifiability.h"
#include "info/information/symmetric_eigen.h"
#include "info/probability/marginal.h"

namespace info {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void check(const EstimateOptions& options, const LeastSquares& problem) {
  const auto rule = [](bool ok, const char* quantity, double value, const char* text) {
    if (!ok)
      throw std::invalid_argument(
          fmt::format("estimate option {} = {} must be {}", quantity, value, text));
  };
  const auto within = [](double x) { return x > 0 && x < 1; };
  rule(options.maxIterations >= 0, "maxIterations", options.maxIterations, "≥ 0");
  rule(options.gradientTolerance >= 0, "gradientTolerance", options.gradientTolerance, "≥ 0");
  rule(options.decrementTolerance >= 0, "decrementTolerance", options.decrementTolerance, "≥ 0");
  rule(options.kinkTolerance >= 0, "kinkTolerance", options.kinkTolerance, "≥ 0");
  rule(options.costTolerance >= 0, "costTolerance", options.costTolerance, "≥ 0");
  rule(within(options.armijoSlope), "armijoSlope", options.armijoSlope, "between 0 and 1");
  rule(within(options.armijoShrink), "armijoShrink", options.armijoShrink, "between 0 and 1");
  rule(within(options.confidence), "confidence", options.confidence, "between 0 and 1");
  if (options.method == Method::newtonRaphson && !problem.hasCurvature())
    throw std::invalid_argument("Newton–Raphson requires a predictor with second derivatives");
}

class Estimator {
 public:
  Estimator(const LeastSquares& problem, const EstimateOptions& options, const VectorXd& start)
      : problem_(problem), options_(options), theta_(start) {
    check(options, problem);
    const auto& parameters = problem.parameters();
    if (start.size() != static_cast<Index>(parameters.size()))
      throw std::invalid_argument(fmt::format("estimate: {} start values for {} parameters",
                                              start.size(), parameters.size()));
    lower_.resize(start.size());
    upper_.resize(start.size());
    for (Index i = 0; i < start.size(); ++i) {
      const Parameter& parameter = parameters[static_cast<std::size_t>(i)];
      lower_[i] = parameter.lower;
      upper_[i] = parameter.upper;
      if (!(start[i] >= lower_[i] && start[i] <= upper_[i]))
        throw std::invalid_argument(
            fmt::format("parameter {}: start {} must be within its bounds {} … {}",
                        label(parameter), start[i], lower_[i], upper_[i]));
    }
    at_ = linearise(theta_);
    if (!std::isfinite(at_.cost)) {
      const auto& why = problem.predictor().whyUndefined;
      const std::string reason = why ? why(theta_) : "";
      throw std::domain_error(fmt::format("estimate: the prediction at the start is not finite{}{}",
                                          reason.empty() ? "" : ": ", reason));
    }
    for (Index i = 0; i < start.size(); ++i)
      if (lower_[i] < upper_[i] && !(at_.information(i, i) > 0))
        throw std::domain_error(
            fmt::format("zero information about parameter {}: at {} it affects no predicted "
                        "sample; give it a prior, fix it, or measure another output",
                        label(parameters[static_cast<std::size_t>(i)]), start[i]));
    record();
  }

  Estimate run() {
    while (true) {
      free_.clear();
      for (Index i = 0; i < theta_.size(); ++i)
        if (lower_[i] < upper_[i] && !(theta_[i] <= lower_[i] && at_.gradient[i] > 0) &&
            !(theta_[i] >= upper_[i] && at_.gradient[i] < 0))
          free_.push_back(i);
      if (options_.costTolerance > 0 && at_.cost <= options_.costTolerance)
        return finish(Termination::costSmall);
      if (scaledGradient() <= options_.gradientTolerance) return finish(Termination::gradientSmall);

      // the full step of the method, and what it promises
      VectorXd direction = VectorXd::Zero(theta_.size());
      if (options_.method == Method::gradientDescent) {
        direction(free_) = -at_.gradient(free_);
      } else {
        const auto step = solve();
        if (step) {
          direction(free_) = *step;
          if (-0.5 * at_.gradient.dot(direction) <= options_.decrementTolerance)
            return finish(Termination::decrementSmall);
        } else if (options_.method != Method::levenbergMarquardt) {
          return finish(Termination::singular);
        }
      }
      if (result_.iterations >= options_.maxIterations) return finish(Termination::iterationLimit);

      const VectorXd before = theta_;
      const Taken taken =
          options_.method == Method::levenbergMarquardt ? damped() : backtrack(direction);
      if (taken != Taken::step && 0.5 * std::pow(scaledGradient(), 2) <= 1e-14 * at_.cost)
        return finish(Termination::roundingReached);
      if (taken != Taken::step && scaledGradient() <= options_.kinkTolerance)
        return finish(Termination::kinkReached);
      if (taken == Taken::none) return finish(Termination::noDescent);
      if (taken == Taken::still || theta_ == before) return finish(Termination::stepSmall);
      ++result_.iterations;
      record();
      if (options_.progress && !options_.progress({result_.iterations, at_.cost, theta_}))
        return finish(Termination::stopped);
    }
  }

 private:
  enum class Taken { step, still, none };

  LeastSquares::Linearised linearise(const VectorXd& theta) {
    ++result_.evaluations;
    return problem_.linearise(theta);
  }

  void record() {
    result_.costHistory.push_back(at_.cost);
    result_.parameterHistory.push_back(theta_);
  }

  double scaledGradient() const {
    double largest = 0;
    for (Index i : free_)
      largest = std::max(largest, std::abs(at_.gradient[i]) /
                                      std::sqrt(std::max(at_.information(i, i),
                                                         std::numeric_limits<double>::min())));
    return largest;
  }

  // −H⁻¹g of the free parameters, H scaled to a unit diagonal of the information; nothing if
  // singular.
  std::optional<VectorXd> solve() {
    const VectorXd scale = at_.information.diagonal()(free_)
                               .cwiseSqrt()
                               .cwiseMax(std::numeric_limits<double>::min())
                               .cwiseInverse();
    MatrixXd hessian = at_.information;
    if (options_.method == Method::newtonRaphson) hessian = problem_.hessian(theta_, at_);
    const auto eigen =
        symmetricEigen(scale.asDiagonal() * hessian(free_, free_) * scale.asDiagonal());
    VectorXd lambda = eigen.values;
    if (lambda.minCoeff() < 0 && options_.method == Method::newtonRaphson) {
      ++result_.indefiniteHessians;
      lambda = lambda.cwiseAbs();
    }
    if (!(lambda.minCoeff() > 1e-14 * lambda.maxCoeff())) return std::nullopt;
    return -(scale.asDiagonal() *
             (eigen.vectors * (eigen.vectors.transpose() * scale.asDiagonal() * at_.gradient(free_))
                                  .cwiseQuotient(lambda)));
  }

  VectorXd project(const VectorXd& theta) const { return theta.cwiseMax(lower_).cwiseMin(upper_); }

  // Armijo's rule along the projected direction.
  Taken backtrack(const VectorXd& direction) {
    const bool isDescent = options_.method == Method::gradientDescent;
    double gamma = isDescent ? std::min(1.0, 4 * gamma_) : 1.0;
    for (;; gamma *= options_.armijoShrink) {
      const VectorXd trial = project(theta_ + gamma * direction);
      if (trial == theta_) return Taken::still;
      const double promised = -at_.gradient.dot(trial - theta_);
      ++result_.evaluations;
      const double cost = problem_.cost(trial);
      if (cost <= at_.cost - options_.armijoSlope * promised && promised > 0) {
        LeastSquares::Linearised next = linearise(trial);
        if (std::isfinite(next.cost)) {
          gamma_ = gamma;
          theta_ = trial;
          at_ = std::move(next);
          return Taken::step;
        }
      }
      if (gamma < 1e-30) return Taken::none;
    }
  }

  // One accepted step of Levenberg–Marquardt on the free parameters.
  Taken damped() {
    const MatrixXd hessian = at_.information(free_, free_);
    const VectorXd diagonal = hessian.diagonal();
    for (; lambda_ < 1e20; lambda_ *= growth_, growth_ *= 2) {
      MatrixXd left = hessian;
      left.diagonal() += lambda_ * diagonal;
      VectorXd step = VectorXd::Zero(theta_.size());
      step(free_) = -left.ldlt().solve(at_.gradient(free_));
      const VectorXd trial = project(theta_ + step);
      const VectorXd moved = trial - theta_;
      if ((moved.array() == 0).all()) return Taken::still;
      const double promised = -at_.gradient.dot(moved) - 0.5 * moved.dot(at_.information * moved);
      if (!(promised > 0)) continue;
      LeastSquares::Linearised next = linearise(trial);
      const double ratio = (at_.cost - next.cost) / promised;
      if (!(ratio > 1e-4)) continue;
      lambda_ = std::max(1e-16, lambda_ * std::max(1.0 / 3, 1 - std::pow(2 * ratio - 1, 3)));
      growth_ = 2;
      theta_ = trial;
      at_ = std::move(next);
      return Taken::step;
    }
    lambda_ = 1e-3;
    return Taken::none;
  }

  Estimate finish(Termination why) {
    result_.why = why;
    result_.converged = why == Termination::gradientSmall || why == Termination::decrementSmall ||
                        why == Termination::costSmall || why == Termination::roundingReached ||
                        why == Termination::kinkReached;
    result_.parameters = theta_;
    result_.cost = at_.cost;
    result_.gradient = at_.gradient;
    result_.information = at_.information;
    const auto& parameters = problem_.parameters();

    // of those not held fixed; what the data do not determine has no covariance
    const Index p = theta_.size();
    std::vector<Index> open;
    std::vector<Parameter> names;
    for (Index i = 0; i < p; ++i)
      if (lower_[i] < upper_[i]) {
        open.push_back(i);
        names.push_back(parameters[static_cast<std::size_t>(i)]);
      }
    result_.covariance = MatrixXd::Zero(p, p);
    if (!open.empty()) {
      const auto report =
          identifiability(at_.information(open, open), names, ParameterScale::linear);
      MatrixXd covariance =
          report.correlation.array() * (report.sd * report.sd.transpose()).array();
      covariance.diagonal() = report.sd.cwiseAbs2();
      result_.covariance(open, open) = covariance;
    }
    const double z = normalQuantile(options_.confidence);
    result_.intervals.resize(p, 2);
    Index priors = 0;
    for (Index i = 0; i < p; ++i) {
      priors += parameters[static_cast<std::size_t>(i)].prior.has_value();
      const double sd = std::sqrt(result_.covariance(i, i));
      result_.intervals(i, 0) = std::max(lower_[i], theta_[i] - z * sd);
      result_.intervals(i, 1) = std::min(upper_[i], theta_[i] + z * sd);
      result_.atBound.push_back(theta_[i] <= lower_[i] || theta_[i] >= upper_[i]);
    }
    const Index freedom = problem_.observations() - static_cast<Index>(open.size()) + priors;
    result_.reducedChiSquare = freedom > 0 ? 2 * at_.cost / static_cast<double>(freedom)
                                           : std::numeric_limits<double>::quiet_NaN();
    return result_;
  }

  const LeastSquares& problem_;
  const EstimateOptions& options_;
  VectorXd theta_, lower_, upper_;
  LeastSquares::Linearised at_;
  std::vector<Index> free_;
  double gamma_ = 1;
  double lambda_ = 1e-3, growth_ = 2;
  Estimate result_;
};

}  // namespace

std::string describe(Termination why) {
  switch (why) {
    case Termination::gradientSmall:
      return "converged: the gradient vanishes";
    case Termination::decrementSmall:
      return "converged: a further step would change nothing";
    case Termination::costSmall:
      return "converged: the cost is as small as asked for";
    case Termination::roundingReached:
      return "converged: the cost changes by rounding only";
    case Termination::kinkReached:
      return "converged: at a kink of the cost, from which every step leads up";
    case Termination::stepSmall:
      return "stopped: the parameters no longer change";
    case Termination::noDescent:
      return "stopped: no step lowers the cost";
    case Termination::singular:
      return "stopped: a combination of parameters has no information";
    case Termination::iterationLimit:
      return "stopped: iteration limit reached";
    case Termination::stopped:
      return "stopped by the caller";
  }
  return "unknown";
}

double normalQuantile(double confidence) {
  if (!(confidence > 0 && confidence < 1))
    throw std::invalid_argument(fmt::format("confidence {} must be between 0 and 1", confidence));
  return -standardNormalQuantile((1 - confidence) / 2);
}

Estimate estimate(const LeastSquares& problem, const VectorXd& start,
                  const EstimateOptions& options) {
  return Estimator(problem, options, start).run();
}

Estimate estimate(const LeastSquares& problem, const EstimateOptions& options) {
  return estimate(problem, problem.start(), options);
}

std::optional<Estimate> estimateIfDefined(const LeastSquares& problem, const VectorXd& start,
                                          const EstimateOptions& options) {
  try {
    return estimate(problem, start, options);
  } catch (const std::domain_error&) {
    return {};
  }
}

}  // namespace info
