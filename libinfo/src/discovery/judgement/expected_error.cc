#include "info/discovery/judgement/expected_error.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include "info/probability/quadratic_form.h"

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// A square root of the covariance of the parameters common to all trials.
struct Uncertain {
  std::vector<std::size_t> quantities;
  MatrixXd root;  // in the units of the quantities
};

Uncertain uncertainOf(const Fit& fit, const DiscoveryProblem& data) {
  Uncertain uncertain;
  std::vector<Index> places;
  std::vector<double> slopes;
  for (std::size_t i = 0; i < fit.hypothesis.free.size(); ++i) {
    const FreeQuantity& q = fit.hypothesis.free[i];
    if (data.quantities()[q.quantity].trial >= 0) continue;
    uncertain.quantities.push_back(q.quantity);
    places.push_back(static_cast<Index>(i));
    slopes.push_back(q.slope(fit.xi[static_cast<Index>(i)]));
  }
  const MatrixXd covariance = fit.covariance(places, places);
  if (covariance.size() == 0) return uncertain;
  // parameters at a bound have no variance, so it is semidefinite
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(covariance);
  const VectorXd sizes = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  const Eigen::Map<const VectorXd> scale(slopes.data(), static_cast<Index>(slopes.size()));
  uncertain.root = scale.asDiagonal() * solver.eigenvectors() * sizes.asDiagonal();
  return uncertain;
}

}  // namespace

double ExpectedError::probability(double error) const {
  return tailOfSquares(variances, error * error * static_cast<double>(variances.size()));
}

ExpectedError expectedError(const Likelihood& held, const Fit& starts, const Fit& fit) {
  if (starts.eta.size() != held.trials().size())
    throw std::invalid_argument("expected error: the starts must be those of the held-out trials");
  const Uncertain uncertain = uncertainOf(fit, held.data());
  const Index samples = held.samples();
  // sources of the error: parameters in all trials, initial states and inputs in each trial
  // separately
  std::vector<Likelihood::Linear> trials;
  Index columns = uncertain.root.cols();
  Fit scattered = starts;  // about zero latent force
  scattered.noise.latent = fit.noise.latent;
  for (std::size_t t = 0; t < held.trials().size(); ++t) {
    if (fit.noise.latent > 0)
      scattered.eta[t] =
          VectorXd::Zero(static_cast<Index>(held.data().nodes(held.trials()[t]).size()));
    trials.push_back(held.linearise(t, scattered, starts.values, uncertain.quantities, false));
    columns += trials.back().latent.cols() + trials.back().gamma.cols();
  }
  // both in standard deviations of the outputs
  MatrixXd moved = MatrixXd::Zero(samples, columns);  // by sources N(0, 1)
  MatrixXd P = MatrixXd::Identity(samples, samples);  // after the fit of the initial states
  Index row = 0, column = uncertain.root.cols();
  for (const Likelihood::Linear& l : trials) {
    const Index n = l.residuals.size();
    const MatrixXd& S = l.gamma;
    MatrixXd inner = S.transpose() * S;
    inner.diagonal().array() += 1;
    const MatrixXd own = MatrixXd::Identity(n, n) - S * inner.llt().solve(MatrixXd(S.transpose()));
    P.block(row, row, n, n) = own;
    if (uncertain.root.size() != 0)
      moved.block(row, 0, n, uncertain.root.cols()) = own * (l.extra * uncertain.root);
    moved.block(row, column, n, S.cols()) = own * S;
    column += S.cols();
    if (l.latent.cols() != 0) moved.block(row, column, n, l.latent.cols()) = own * l.latent;
    column += l.latent.cols();
    row += n;
  }
  const double first = fit.noise.output.sd(0);  // errors are told in its unit
  const MatrixXd covariance = first * first * (moved * moved.transpose() + P * P.transpose());
  ExpectedError expected;
  expected.variances = Eigen::SelfAdjointEigenSolver<MatrixXd>(covariance, Eigen::EigenvaluesOnly)
                           .eigenvalues()
                           .cwiseMax(0);
  expected.rms = std::sqrt(expected.variances.sum() / static_cast<double>(samples));
  return expected;
}

}  // namespace info::discover
