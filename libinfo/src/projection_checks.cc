#include "projection_checks.h"

#include <fmt/format.h>

#include <cmath>

namespace info::detail {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void fillWeight(const char* name, MatrixXd& W, Index size, bool definite) {
  if (W.size() == 0 && !definite) W = MatrixXd::Zero(size, size);
  if (W.rows() != size || W.cols() != size)
    throw std::invalid_argument(
        fmt::format("{}: is {} × {}, rule: {} × {}", name, W.rows(), W.cols(), size, size));
  const double scale = W.cwiseAbs().maxCoeff();
  if (!W.allFinite() || !((W - W.transpose()).cwiseAbs().maxCoeff() <= 1e-12 * scale))
    throw std::domain_error(fmt::format("{}: rule finite and symmetric is broken", name));
  const double least =
      Eigen::SelfAdjointEigenSolver<MatrixXd>(W, Eigen::EigenvaluesOnly).eigenvalues()[0];
  if (definite ? !(least > 0) : !(least >= -1e-12 * scale))
    throw std::domain_error(
        fmt::format("{}: least eigenvalue is {}, rule: {} 0", name, least, definite ? ">" : "≥"));
}

MatrixXd inverseCovariance(const MatrixXd& covariance, Index outputs) {
  MatrixXd checked = covariance;
  fillWeight("output covariance", checked, outputs, true);
  const MatrixXd inverse = checked.llt().solve(MatrixXd::Identity(outputs, outputs));
  return 0.5 * (inverse + inverse.transpose());
}

void checkInputs(const char* name, const std::vector<VectorXd>& inputs, std::size_t count,
                 Index size) {
  if (inputs.size() != count)
    throw std::invalid_argument(
        fmt::format("{}: {} of them, rule: {}", name, inputs.size(), count));
  for (std::size_t k = 0; k < count; ++k)
    if (inputs[k].size() != size || !inputs[k].allFinite())
      throw std::invalid_argument(fmt::format("{}: number {} has {} entries, rule: {}, all finite",
                                              name, k, inputs[k].size(), size));
}

void checkLimits(const InputLimits& limits, Index inputs) {
  if (limits.lower.size() == 0 && limits.upper.size() == 0) return;
  if (limits.lower.size() != inputs || limits.upper.size() != inputs)
    throw std::invalid_argument(fmt::format("input limits: {} lower and {} upper, rule: {} each",
                                            limits.lower.size(), limits.upper.size(), inputs));
  for (Index i = 0; i < inputs; ++i)
    if (!(limits.lower[i] < limits.upper[i]) || !std::isfinite(limits.lower[i]) ||
        !std::isfinite(limits.upper[i]))
      throw std::domain_error(
          fmt::format("limits of input {}: lower {}, upper {}, rule: lower < upper and finite", i,
                      limits.lower[i], limits.upper[i]));
  if (!(limits.weight > 0 && std::isfinite(limits.weight)))
    throw std::domain_error(
        fmt::format("weight of the input limits: {}, rule: > 0 and finite", limits.weight));
}

}  // namespace info::detail
