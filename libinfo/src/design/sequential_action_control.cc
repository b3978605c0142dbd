#include "info/design/sequential_action_control.h"

#include <fmt/format.h>

#include <stdexcept>

#include "design/projection_checks.h"

namespace info {

std::string describe(ActionEnd why) {
  switch (why) {
    case ActionEnd::acts:
      return "acts";
    case ActionEnd::noGradient:
      return "no input would change the cost to first order";
    case ActionEnd::noImprovement:
      return "no duration lowers the cost";
    case ActionEnd::notFinite:
      return "the predicted motion does not stay finite";
  }
  return "unknown";
}

void checkActionOptions(const ActionOptions& options) {
  const auto rule = [](const char* name, double value, bool good, const char* text) {
    if (!good || !std::isfinite(value))
      throw std::domain_error(
          fmt::format("action control, {}: {}, must be {} and finite", name, value, text));
  };
  const ActionOptions& o = options;
  rule("horizon [s]", o.horizon, o.horizon > 0, "> 0");
  rule("step [s]", o.step, o.step > 0 && o.step <= o.horizon, "> 0, ≤ horizon");
  rule("descent rate [1/s]", o.descentRate, o.descentRate < 0, "< 0");
  rule("first duration [s]", o.firstDuration, o.firstDuration > 0 && o.firstDuration <= o.horizon,
       "> 0, ≤ horizon");
  rule("halvings", o.maxHalvings, o.maxHalvings >= 0, "≥ 0");
  rule("improvement", o.improvement, o.improvement >= 0 && o.improvement < 1, "in [0, 1)");
  rule("waiting exponent", o.waitingExponent, o.waitingExponent > 0, "> 0");
}

namespace detail {

void checkActionLimits(const Eigen::Ref<const Eigen::VectorXd>& lower,
                       const Eigen::Ref<const Eigen::VectorXd>& upper) {
  for (Eigen::Index i = 0; i < lower.size(); ++i)
    if (!(lower[i] < 0 && 0 < upper[i]))
      throw std::domain_error(fmt::format(
          "action control, limits of input {}: {} to {}, must satisfy lower < 0 < upper", i,
          lower[i], upper[i]));
}

void checkActionWeights(const Eigen::MatrixXd& inverseCovariance, const Eigen::VectorXd& scale,
                        double epsilon, const Eigen::MatrixXd& stateWeight,
                        const Eigen::MatrixXd& inputWeight) {
  const auto weight = [](const char* name, Eigen::MatrixXd W, bool definite) {
    fillWeight(name, W, W.rows(), definite);
  };
  weight("action control, inverse covariance", inverseCovariance, true);
  weight("action control, state weight Q", stateWeight, false);
  weight("action control, input weight R", inputWeight, true);
  for (double s : scale)
    if (!(s > 0 && std::isfinite(s)))
      throw std::domain_error(
          fmt::format("action control, scale of a parameter: {}, must be > 0 and finite", s));
  if (!(epsilon > 0 && std::isfinite(epsilon)))
    throw std::domain_error(
        fmt::format("action control, epsilon: {}, must be > 0 and finite (without it the cost is "
                    "infinite at rest)",
                    epsilon));
}

}  // namespace detail
}  // namespace info
