#include "info/design/projected_motion.h"

#include <cmath>
#include <limits>

namespace info {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

ProjectedMotion::ProjectedMotion(ExtendedOutput output, int candidates, const MotionDesign& design,
                                 MatrixXd inverseNoise)
    : output_(std::move(output)),
      candidates_(candidates),
      weights_(design.information),
      rule_(design.candidateRule),
      inverseNoise_(std::move(inverseNoise)) {}

MatrixXd ProjectedMotion::informationOf(const MatrixXd& gamma, int candidate) const {
  const Index h = inverseNoise_.rows();
  const auto rows = gamma.middleRows(candidate * h, h);
  const MatrixXd information = rows.transpose() * (inverseNoise_ * rows);
  return 0.5 * (information + information.transpose());
}

ProjectedMotion::Evaluated ProjectedMotion::evaluate(const Motion& motion) const {
  const Index p = motion.psi.front().cols();
  std::vector<MatrixXd> information(std::size_t(candidates_), MatrixXd::Zero(p, p));
  for (std::size_t k = 0; k < motion.x.size(); ++k) {
    if (share(k) == 0) continue;
    const MatrixXd gamma = output_.gamma(motion.x[k], motion.psi[k], motion.u[k]);
    for (int s = 0; s < candidates_; ++s)
      information[std::size_t(s)] += share(k) * informationOf(gamma, s);
  }
  const double phi = candidatesCost(rule_, weights_, information, 1e-9).value;
  return {tracking(motion) + phi, std::move(information)};
}

std::vector<MatrixXd> ProjectedMotion::informationOverTime() const {
  const Index p = motion_.psi.front().cols();
  std::vector<MatrixXd> grown;
  MatrixXd sum = MatrixXd::Zero(p, p);
  for (std::size_t k = 0; k < motion_.x.size(); ++k) {
    if (share(k) != 0)
      sum += share(k) * informationOf(output_.gamma(motion_.x[k], motion_.psi[k], motion_.u[k]), 0);
    grown.push_back(sum);
  }
  return grown;
}

std::vector<MatrixXd> ProjectedMotion::informationSlopes(double repeatedTolerance) const {
  return candidatesCost(rule_, weights_, current_.information, repeatedTolerance).dvalue_dI;
}

ExtendedOutput::Gradient ProjectedMotion::outputSlope(std::size_t k,
                                                      const std::vector<MatrixXd>& slopes) const {
  const VectorXd &x = motion_.x[k], &u = motion_.u[k];
  const MatrixXd& psi = motion_.psi[k];
  // dφ = Σ_s 2⟨Σ⁻¹ Γ_s dφ/dI_s, dΓ_s⟩
  const MatrixXd gamma = output_.gamma(x, psi, u);
  const Index h = inverseNoise_.rows();
  MatrixXd P(gamma.rows(), gamma.cols());
  for (Index s = 0; s < candidates_; ++s)
    P.middleRows(s * h, h) =
        2 * inverseNoise_ * gamma.middleRows(s * h, h) * slopes[std::size_t(s)];
  return output_.gradient(x, psi, u, P);
}

void ProjectedMotion::begin(Motion motion) {
  motion_ = std::move(motion);
  current_ = evaluate(motion_);
}

ProjectedMotion::Direction ProjectedMotion::follow(AffineLqSolution zeta) {
  z_ = std::move(zeta.z);
  v_ = std::move(zeta.v);
  Direction out{zeta.slope, 0};
  for (const VectorXd& v : v_) out.largestMove = std::max(out.largestMove, v.cwiseAbs().maxCoeff());
  return out;
}

double ProjectedMotion::trial(double step) {
  constexpr double none = std::numeric_limits<double>::infinity();
  if (!project(step, tried_)) return none;
  try {
    triedEvaluated_ = evaluate(tried_);
  } catch (const NoInformation&) {
    return none;
  }
  return triedEvaluated_.cost;
}

void ProjectedMotion::accept() {
  std::swap(motion_, tried_);
  std::swap(current_, triedEvaluated_);
}

}  // namespace info
