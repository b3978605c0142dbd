#include "info/riccati.h"

#include <fmt/format.h>

#include <stdexcept>

namespace info {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Symmetric, and positive definite or semidefinite up to rounding; NaN fails.
void checkWeight(const char* name, const MatrixXd& W, Index size, bool definite) {
  if (W.rows() != size || W.cols() != size)
    throw std::invalid_argument(
        fmt::format("weight {}: is {} × {}, rule: {} × {}", name, W.rows(), W.cols(), size, size));
  if (size == 0) return;
  const double scale = W.cwiseAbs().maxCoeff();
  if (!W.allFinite() || !((W - W.transpose()).cwiseAbs().maxCoeff() <= 1e-12 * scale))
    throw std::domain_error(fmt::format("weight {}: rule finite and symmetric is broken", name));
  const double least =
      Eigen::SelfAdjointEigenSolver<MatrixXd>(W, Eigen::EigenvaluesOnly).eigenvalues()[0];
  if (definite ? !(least > 0) : !(least >= -1e-12 * scale))
    throw std::domain_error(fmt::format("weight {}: least eigenvalue is {}, rule: {} 0", name,
                                        least, definite ? ">" : "≥"));
}

struct Checked {
  Index n, m;
  std::size_t steps;
  MatrixXd S, Qf;
};

Checked check(const LinearSequence& system, const QuadraticWeights& weights, bool continuous) {
  if (system.A.empty() || system.A.size() != system.B.size() || (continuous && system.A.size() < 2))
    throw std::invalid_argument(fmt::format("linear system: {} A and {} B, rule: equal and ≥ {}",
                                            system.A.size(), system.B.size(), continuous ? 2 : 1));
  Checked c{system.A[0].rows(), system.B[0].cols(), system.A.size() - (continuous ? 1 : 0),
            weights.S, weights.Qf};
  for (std::size_t k = 0; k < system.A.size(); ++k)
    if (system.A[k].rows() != c.n || system.A[k].cols() != c.n || system.B[k].rows() != c.n ||
        system.B[k].cols() != c.m)
      throw std::invalid_argument(fmt::format("linear system: sizes change at node {}", k));
  checkWeight("Q", weights.Q, c.n, false);
  checkWeight("R", weights.R, c.m, true);
  if (c.S.size() == 0) c.S = MatrixXd::Zero(c.m, c.n);
  if (c.S.rows() != c.m || c.S.cols() != c.n || (continuous && !c.S.isZero(0)))
    throw std::invalid_argument("weight S: rule m × n, and none in continuous time");
  if (c.Qf.size() == 0) c.Qf = continuous ? MatrixXd::Zero(c.n, c.n).eval() : weights.Q;
  checkWeight("Qf", c.Qf, c.n, false);
  return c;
}

void checkCost(const LinearCost& cost, const Checked& c, std::size_t inputs) {
  if (cost.a.size() != c.steps + 1 || cost.b.size() != inputs)
    throw std::invalid_argument(fmt::format("linear cost: {} a and {} b, rule: {} and {}",
                                            cost.a.size(), cost.b.size(), c.steps + 1, inputs));
  for (const VectorXd& a : cost.a)
    if (a.size() != c.n) throw std::invalid_argument("linear cost: a has the wrong length");
  for (const VectorXd& b : cost.b)
    if (b.size() != c.m) throw std::invalid_argument("linear cost: b has the wrong length");
}

void checkFinite(const MatrixXd& P, std::size_t k) {
  if (!P.allFinite())
    throw std::domain_error(fmt::format("Riccati equation: no finite solution at node {}", k));
}

// The backward sweep; with `cost`, the affine part as well.
struct Sweep {
  std::vector<MatrixXd> K;
  std::vector<VectorXd> feedforward;
};

Sweep sweepBack(const LinearSequence& system, const QuadraticWeights& weights, const Checked& c,
                const LinearCost* cost) {
  Sweep out;
  out.K.resize(c.steps);
  if (cost) out.feedforward.resize(c.steps);
  MatrixXd P = c.Qf, PA(c.n, c.n), PB(c.n, c.m), H(c.m, c.m), G(c.m, c.n);
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
    if (solver.info() != Eigen::Success) checkFinite(H * std::nan(""), k);
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
    P = weights.Q;
    P.noalias() += A.transpose() * PA;
    P.noalias() -= out.K[k].transpose() * G;
    P = (0.5 * (P + P.transpose())).eval();
    checkFinite(P, k);
  }
  return out;
}

}  // namespace

std::vector<MatrixXd> lqrGains(const LinearSequence& system, const QuadraticWeights& weights) {
  return sweepBack(system, weights, check(system, weights, false), nullptr).K;
}

AffineLqSolution affineLq(const LinearSequence& system, const LinearCost& cost,
                          const QuadraticWeights& weights) {
  const Checked c = check(system, weights, false);
  checkCost(cost, c, c.steps);
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

namespace {

// P(t), K(t) and, with `cost`, r(t) at the nodes.
struct ContinuousSweep {
  std::vector<MatrixXd> K;
  std::vector<VectorXd> feedforward;  // R⁻¹(Bᵀr + b)
};

ContinuousSweep sweepBackContinuously(const LinearSequence& system, double step,
                                      const QuadraticWeights& weights, const Checked& c,
                                      const LinearCost* cost) {
  if (!(step > 0 && std::isfinite(step)))
    throw std::domain_error(fmt::format("step between nodes: {} s, rule: > 0 and finite", step));
  const MatrixXd inverseR = weights.R.llt().solve(MatrixXd::Identity(c.m, c.m));
  MatrixXd PA(c.n, c.n), PB(c.n, c.m);
  // −Ṗ and −ṙ
  const auto rates = [&](const MatrixXd& A, const MatrixXd& B, const VectorXd& a, const VectorXd& b,
                         const MatrixXd& P, const VectorXd& r, MatrixXd& dP, VectorXd& dr) {
    PA.noalias() = P * A;
    PB.noalias() = P * B;
    dP = weights.Q + PA + PA.transpose();
    dP.noalias() -= (PB * inverseR) * PB.transpose();
    if (cost) {
      dr = a;
      dr.noalias() += A.transpose() * r;
      dr.noalias() -= PB * (inverseR * (B.transpose() * r + b));
    }
  };
  ContinuousSweep out;
  out.K.resize(c.steps + 1);
  if (cost) out.feedforward.resize(c.steps + 1);
  MatrixXd P = c.Qf;
  VectorXd r = cost ? VectorXd::Zero(c.n).eval() : VectorXd();
  const VectorXd none;
  const auto keep = [&](std::size_t k) {
    out.K[k] = inverseR * system.B[k].transpose() * P;
    if (cost) out.feedforward[k] = inverseR * (system.B[k].transpose() * r + cost->b[k]);
  };
  keep(c.steps);
  MatrixXd k1, k2, k3, k4;
  VectorXd s1, s2, s3, s4;
  for (std::size_t k = c.steps; k-- > 0;) {
    const MatrixXd A = 0.5 * (system.A[k] + system.A[k + 1]);
    const MatrixXd B = 0.5 * (system.B[k] + system.B[k + 1]);
    const VectorXd a = cost ? VectorXd(0.5 * (cost->a[k] + cost->a[k + 1])) : none;
    const VectorXd b = cost ? VectorXd(0.5 * (cost->b[k] + cost->b[k + 1])) : none;
    const VectorXd &a0 = cost ? cost->a[k] : none, &a1 = cost ? cost->a[k + 1] : none;
    const VectorXd &b0 = cost ? cost->b[k] : none, &b1 = cost ? cost->b[k + 1] : none;
    const double half = 0.5 * step, sixth = step / 6;
    rates(system.A[k + 1], system.B[k + 1], a1, b1, P, r, k1, s1);
    rates(A, B, a, b, P + half * k1, cost ? VectorXd(r + half * s1) : none, k2, s2);
    rates(A, B, a, b, P + half * k2, cost ? VectorXd(r + half * s2) : none, k3, s3);
    rates(system.A[k], system.B[k], a0, b0, P + step * k3, cost ? VectorXd(r + step * s3) : none,
          k4, s4);
    P += sixth * (k1 + 2 * k2 + 2 * k3 + k4);
    if (cost) r += sixth * (s1 + 2 * s2 + 2 * s3 + s4);
    checkFinite(P, k);
    keep(k);
  }
  return out;
}

}  // namespace

std::vector<MatrixXd> continuousLqrGains(const LinearSequence& system, double step,
                                         const QuadraticWeights& weights) {
  return sweepBackContinuously(system, step, weights, check(system, weights, true), nullptr).K;
}

AffineLqSolution continuousAffineLq(const LinearSequence& system, double step,
                                    const LinearCost& cost, const QuadraticWeights& weights) {
  const Checked c = check(system, weights, true);
  checkCost(cost, c, c.steps + 1);
  const ContinuousSweep sweep = sweepBackContinuously(system, step, weights, c, &cost);
  AffineLqSolution out{{VectorXd::Zero(c.n)}, {}, 0};
  const auto input = [&](std::size_t k, const VectorXd& z) {
    return VectorXd(-sweep.K[k] * z - sweep.feedforward[k]);
  };
  for (std::size_t k = 0;; ++k) {
    const VectorXd& z = out.z[k];
    out.v.push_back(input(k, z));
    const double weight = k == 0 || k == c.steps ? 0.5 * step : step;
    out.slope += weight * (cost.a[k].dot(z) + cost.b[k].dot(out.v[k]));
    if (k == c.steps) return out;
    // the closed loop, its input linear between nodes like everything else
    const MatrixXd A = 0.5 * (system.A[k] + system.A[k + 1]);
    const MatrixXd B = 0.5 * (system.B[k] + system.B[k + 1]);
    const MatrixXd K = 0.5 * (sweep.K[k] + sweep.K[k + 1]);
    const VectorXd forward = 0.5 * (sweep.feedforward[k] + sweep.feedforward[k + 1]);
    const auto rate = [&](const VectorXd& at) { return VectorXd(A * at - B * (K * at + forward)); };
    const VectorXd k1 = system.A[k] * z + system.B[k] * out.v[k];
    const VectorXd k2 = rate(z + 0.5 * step * k1), k3 = rate(z + 0.5 * step * k2);
    const VectorXd last = z + step * k3;
    const VectorXd k4 = system.A[k + 1] * last + system.B[k + 1] * input(k + 1, last);
    out.z.push_back(z + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4));
  }
}

}  // namespace info
