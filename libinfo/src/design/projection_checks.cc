#include "design/projection_checks.h"

#include <fmt/format.h>

#include <cmath>

#include "info/information/symmetric_eigen.h"

namespace info::detail {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void fillWeight(const char* name, MatrixXd& W, Index size, bool definite) {
  if (W.size() == 0 && !definite) W = MatrixXd::Zero(size, size);
  if (W.rows() != size || W.cols() != size)
    throw std::invalid_argument(
        fmt::format("{}: is {} × {}, must be {} × {}", name, W.rows(), W.cols(), size, size));
  const double scale = W.cwiseAbs().maxCoeff();
  if (!W.allFinite() || !((W - W.transpose()).cwiseAbs().maxCoeff() <= 1e-12 * scale))
    throw std::domain_error(fmt::format("{}: must be finite and symmetric", name));
  const double least = symmetricEigenvalues(W)[0];
  if (definite ? !(least > 0) : !(least >= -1e-12 * scale))
    throw std::domain_error(
        fmt::format("{}: least eigenvalue is {}, must be {} 0", name, least, definite ? ">" : "≥"));
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
        fmt::format("{}: {} of them, must be {}", name, inputs.size(), count));
  for (std::size_t k = 0; k < count; ++k)
    if (inputs[k].size() != size || !inputs[k].allFinite())
      throw std::invalid_argument(fmt::format(
          "{}: number {} has {} entries, must be {}, all finite", name, k, inputs[k].size(), size));
}

namespace {

// lower < upper for each input, weight > 0.
void checkLimits(const InputLimits& limits, Index inputs) {
  if (limits.lower.size() == 0 && limits.upper.size() == 0) return;
  if (limits.lower.size() != inputs || limits.upper.size() != inputs)
    throw std::invalid_argument(fmt::format("input limits: {} lower and {} upper, must be {} each",
                                            limits.lower.size(), limits.upper.size(), inputs));
  for (Index i = 0; i < inputs; ++i)
    if (!(limits.lower[i] < limits.upper[i]) || !std::isfinite(limits.lower[i]) ||
        !std::isfinite(limits.upper[i]))
      throw std::domain_error(
          fmt::format("limits of input {}: lower {}, upper {}, must be finite with lower < upper",
                      i, limits.lower[i], limits.upper[i]));
  if (!(limits.weight > 0 && std::isfinite(limits.weight)))
    throw std::domain_error(
        fmt::format("weight of the input limits: {}, must be > 0 and finite", limits.weight));
}

}  // namespace

MatrixXd overCandidates(const MatrixXd& W, const CandidateSizes& sizes, Index more, Index p) {
  const Index n = sizes.n, all = n * sizes.count, size = all + more + all * p;
  MatrixXd out = MatrixXd::Zero(size, size);
  std::vector<Index> place(static_cast<std::size_t>(W.rows()));
  for (Index s = 0; s < sizes.count; ++s) {
    for (Index i = 0; i < W.rows(); ++i) {
      const Index ofPsi = i - n - more;
      place[std::size_t(i)] = i < n          ? s * n + i
                              : i < n + more ? all + i - n
                                             : all + more + ofPsi / n * all + s * n + ofPsi % n;
    }
    for (Index i = 0; i < W.rows(); ++i)
      for (Index j = 0; j < W.cols(); ++j)
        out(place[std::size_t(i)], place[std::size_t(j)]) += W(i, j) / sizes.count;
  }
  return out;
}

void prepareDesign(MotionDesign& c, const CandidateSizes& sizes, Index more) {
  const Index n = sizes.n, m = sizes.m;
  if (c.desiredInput.size() < 2)
    throw std::invalid_argument(
        fmt::format("desired inputs: {} of them, must be ≥ 2", c.desiredInput.size()));
  requireLength("x0", c.x0.size(), n);
  checkInputs("desired inputs", c.desiredInput, c.desiredInput.size(), m);
  checkLimits(c.limits, m);
  fillWeight("state weight Q", c.stateWeight, n, false);
  fillWeight("input weight R", c.inputWeight, m, false);
  fillWeight("model's state weight", c.modelState, n + more + n * sizes.p, false);
  fillWeight("model's input weight", c.modelInput, m, true);
  fillWeight("gain's state weight", c.gainState, n + more, false);
  fillWeight("gain's input weight", c.gainInput, m, true);
  c.x0 = c.x0.replicate(sizes.count, 1).eval();
  c.stateWeight = overCandidates(c.stateWeight, sizes, 0, 0);
  c.modelState = overCandidates(c.modelState, sizes, more, sizes.p);
  c.gainState = overCandidates(c.gainState, sizes, more, 0);
}

}  // namespace info::detail
