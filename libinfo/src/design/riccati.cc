#include "info/design/riccati.h"

#include <cmath>

#include "design/riccati_checks.h"

namespace info {
namespace {

using namespace detail;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The backward sweep; with `cost`, the affine part as well.
struct Sweep {
  std::vector<MatrixXd> K;
  std::vector<VectorXd> feedforward;
};

Sweep sweepBack(const LinearSequence& system, const QuadraticWeights& weights, const CheckedLq& c,
                const LinearCost* cost) {
  Sweep out;
  out.K.resize(c.steps);
  if (cost) out.feedforward.resize(c.steps);
  const auto withExtra = [&](MatrixXd Q, std::size_t k) {
    for (const NodeWeight& extra : weights.extra)
      if (extra.node == k) Q += extra.Q;
    return Q;
  };
  MatrixXd P = withExtra(c.Qf, c.steps), PA(c.n, c.n), PB(c.n, c.m), H(c.m, c.m), G(c.m, c.n);
  VectorXd r = cost ? cost->a[c.steps] : VectorXd();
  for (std::size_t k = c.steps; k-- > 0;) {
    const MatrixXd &A = system.A[k], &B = system.B[k];
    PA.noalias() = P * A;
    PB.noalias() = P * B;
    H = weights.R;
    H.noalias() += B.transpose() * PB;
    G = c.S;
    G.noalias() += B.transpose() * PA;
    const Eigen::LLT<MatrixXd> solver(H);
    if (solver.info() != Eigen::Success) checkRiccati(H * std::nan(""), k);
    out.K[k] = solver.solve(G);
    if (cost) {
      VectorXd h = cost->b[k];
      h.noalias() += B.transpose() * r;
      out.feedforward[k] = solver.solve(h);
      VectorXd next = cost->a[k];
      next.noalias() += A.transpose() * r;
      next.noalias() -= out.K[k].transpose() * h;
      r.swap(next);
    }
    P = withExtra(weights.Q, k);
    P.noalias() += A.transpose() * PA;
    P.noalias() -= out.K[k].transpose() * G;
    P = (0.5 * (P + P.transpose())).eval();
    checkRiccati(P, k);
  }
  return out;
}

}  // namespace

std::vector<MatrixXd> lqrGains(const LinearSequence& system, const QuadraticWeights& weights) {
  return sweepBack(system, weights, checkLq(system, weights, false), nullptr).K;
}

AffineLqSolution affineLq(const LinearSequence& system, const LinearCost& cost,
                          const QuadraticWeights& weights) {
  const CheckedLq c = checkLq(system, weights, false);
  checkLinearCost(cost, c, c.steps);
  const Sweep sweep = sweepBack(system, weights, c, &cost);
  AffineLqSolution out{{VectorXd::Zero(c.n)}, {}, 0};
  for (std::size_t k = 0; k < c.steps; ++k) {
    const VectorXd& z = out.z.back();
    out.v.push_back(-sweep.K[k] * z - sweep.feedforward[k]);
    out.slope += cost.a[k].dot(z) + cost.b[k].dot(out.v[k]);
    VectorXd next = system.A[k] * z;
    next.noalias() += system.B[k] * out.v[k];
    out.z.push_back(std::move(next));
  }
  out.slope += cost.a[c.steps].dot(out.z.back());
  return out;
}

}  // namespace info
