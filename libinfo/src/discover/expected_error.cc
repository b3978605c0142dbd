#include "info/discover/expected_error.h"

#include <cmath>
#include <stdexcept>

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// A root of the covariance of what belongs to no trial.
struct Uncertain {
  std::vector<std::size_t> quantities;
  MatrixXd root;  // in the quantities' units
};

Uncertain uncertainOf(const Fit& fit, const Disagreement& data) {
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
  // those at a bound have no deviation, so it is semidefinite
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(covariance);
  const VectorXd sizes = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  const Eigen::Map<const VectorXd> scale(slopes.data(), static_cast<Index>(slopes.size()));
  uncertain.root = scale.asDiagonal() * solver.eigenvectors() * sizes.asDiagonal();
  return uncertain;
}

}  // namespace

double expectedError(const Likelihood& held, const Fit& starts, const Fit& fit) {
  if (starts.eta.size() != held.trials().size())
    throw std::invalid_argument("expected error: the starts must be those of the held-out trials");
  const Uncertain uncertain = uncertainOf(fit, held.data());
  Fit scattered = starts;  // where inputs scatter, about nothing
  scattered.noise.latent = fit.noise.latent;
  const double variance = fit.noise.output * fit.noise.output;
  double squares = 0;
  for (std::size_t t = 0; t < held.trials().size(); ++t) {
    if (fit.noise.latent > 0)
      scattered.eta[t] =
          VectorXd::Zero(static_cast<Index>(held.data().latentTimes(held.trials()[t]).size()));
    const Likelihood::Linear l =
        held.linearise(t, scattered, starts.values, uncertain.quantities, false);
    const MatrixXd& S = l.gamma;
    const auto inner =
        MatrixXd(S.transpose() * S + variance * MatrixXd::Identity(S.cols(), S.cols())).llt();
    const auto left = [&](const MatrixXd& moved) {  // after the starts have followed
      return (moved - S * inner.solve(S.transpose() * moved)).squaredNorm();
    };
    const Index n = l.residuals.size();
    if (uncertain.root.size() != 0) squares += left(l.extra * uncertain.root);
    if (l.latent.cols() != 0) squares += left(l.latent);
    squares += left(S) + variance * left(MatrixXd::Identity(n, n));
  }
  return std::sqrt(squares / static_cast<double>(held.samples()));
}

}  // namespace info::discover
