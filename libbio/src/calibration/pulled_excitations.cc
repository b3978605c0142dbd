#include "bio/calibration/pulled_excitations.h"

#include <cmath>

namespace bio {

double PulledExcitation::rms() const {
  return std::sqrt(z.squaredNorm() / static_cast<double>(z.size()));
}

std::vector<PulledExcitation> pulledExcitations(const TrialSet& training,
                                                const Calibration& calibration) {
  std::vector<PulledExcitation> all;
  if (calibration.parameters.empty()) return all;
  const Eigen::VectorXd theta = calibration.values();
  for (const TrialSet::Latent& one : training.latent()) {
    const auto n = static_cast<Eigen::Index>(one.knots.size());
    LatentExcitation latent{one.knots, theta.segment(static_cast<Eigen::Index>(one.first), n),
                            one.declared.sd};
    const auto times = Eigen::VectorXd::Map(one.knots.data(), n);
    PulledExcitation pulled{
        training.trials()[one.trial].file, one.declared,      one.knots, one.atKnots, {},
        latent.values / latent.sd,         Eigen::VectorXd(n)};
    for (Eigen::Index k = 0; k < n; ++k) {
      pulled.sd[k] = calibration.parameters[one.first + static_cast<std::size_t>(k)].sd;
    }
    pulled.fitted = withLatent(times, one.atKnots.transpose(), latent).transpose();
    all.push_back(std::move(pulled));
  }
  return all;
}

}  // namespace bio
