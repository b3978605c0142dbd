#include "design/riccati_checks.h"

#include <fmt/format.h>

#include <stdexcept>

#include "info/information/symmetric_eigen.h"

namespace info::detail {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Symmetric, and positive definite or semidefinite up to rounding; NaN fails.
void checkWeight(const char* name, const MatrixXd& W, Index size, bool definite) {
  if (W.rows() != size || W.cols() != size)
    throw std::invalid_argument(fmt::format("weight {}: is {} × {}, must be {} × {}", name,
                                            W.rows(), W.cols(), size, size));
  if (size == 0) return;
  const double scale = W.cwiseAbs().maxCoeff();
  if (!W.allFinite() || !((W - W.transpose()).cwiseAbs().maxCoeff() <= 1e-12 * scale))
    throw std::domain_error(fmt::format("weight {}: must be finite and symmetric", name));
  const double least = symmetricEigenvalues(W)[0];
  if (definite ? !(least > 0) : !(least >= -1e-12 * scale))
    throw std::domain_error(fmt::format("weight {}: least eigenvalue is {}, must be {} 0", name,
                                        least, definite ? ">" : "≥"));
}

}  // namespace

CheckedLq checkLq(const LinearSequence& system, const QuadraticWeights& weights, bool continuous) {
  if (system.A.empty() || system.A.size() != system.B.size() || (continuous && system.A.size() < 2))
    throw std::invalid_argument(
        fmt::format("linear system: {} A and {} B, must be as many of each, ≥ {}", system.A.size(),
                    system.B.size(), continuous ? 2 : 1));
  CheckedLq c{system.A[0].rows(), system.B[0].cols(), system.A.size() - (continuous ? 1 : 0),
              weights.S, weights.Qf};
  for (std::size_t k = 0; k < system.A.size(); ++k)
    if (system.A[k].rows() != c.n || system.A[k].cols() != c.n || system.B[k].rows() != c.n ||
        system.B[k].cols() != c.m)
      throw std::invalid_argument(
          fmt::format("linear system: sizes at node {} must be those of node 0", k));
  checkWeight("Q", weights.Q, c.n, false);
  checkWeight("R", weights.R, c.m, true);
  if (c.S.size() == 0) c.S = MatrixXd::Zero(c.m, c.n);
  if (c.S.rows() != c.m || c.S.cols() != c.n || (continuous && !c.S.isZero(0)))
    throw std::invalid_argument("weight S: must be m × n, and absent in continuous time");
  if (c.Qf.size() == 0) c.Qf = continuous ? MatrixXd::Zero(c.n, c.n).eval() : weights.Q;
  checkWeight("Qf", c.Qf, c.n, false);
  for (const NodeWeight& extra : weights.extra) {
    checkWeight("Q of a node", extra.Q, c.n, false);
    if (extra.node > c.steps || continuous)
      throw std::invalid_argument(
          fmt::format("weight of node {}: node must be at most {}, and absent in continuous time",
                      extra.node, c.steps));
  }
  return c;
}

void checkLinearCost(const LinearCost& cost, const CheckedLq& c, std::size_t inputs) {
  if (cost.a.size() != c.steps + 1 || cost.b.size() != inputs)
    throw std::invalid_argument(fmt::format("linear cost: {} a and {} b, must be {} and {}",
                                            cost.a.size(), cost.b.size(), c.steps + 1, inputs));
  for (const VectorXd& a : cost.a)
    if (a.size() != c.n)
      throw std::invalid_argument("linear cost: length of a must be the number of states");
  for (const VectorXd& b : cost.b)
    if (b.size() != c.m)
      throw std::invalid_argument("linear cost: length of b must be the number of inputs");
}

void checkRiccati(const MatrixXd& P, std::size_t k) {
  if (!P.allFinite())
    throw std::domain_error(fmt::format("Riccati equation: no finite solution at node {}", k));
}

}  // namespace info::detail
