#include "simulation/tree_rates.h"

#include "bio/skeleton/tree_energy_bodies.h"
#include "bio/skeleton/tree_motion.h"

namespace bio::stepping {

TreeRates::TreeRates(const ArticulatedTree& tree)
    : tree_(&tree), motion_(tree.newMotion<Dual>()), energy_(tree) {
  const int n = tree.numCoordinates();
  q_.assign(static_cast<std::size_t>(n), Dual(0.0));
  v_ = q_;
  massRate_.setZero(n, n);
  momentumRate_.setZero(n, n);
}

void TreeRates::evaluate(const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  for (Eigen::Index k = 0; k < q.size(); ++k) {
    Dual at(q[k]);
    at.derivatives()[0] = v[k];
    q_[static_cast<std::size_t>(k)] = at;
    v_[static_cast<std::size_t>(k)] = Dual(v[k]);
  }
  tree_->place(q_.data(), motion_);
  const EnergyDerivatives<Eigen::Dynamic, Dual>& e = energy_.evaluate(motion_, v_.data());
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      massRate_(i, j) = e.T_vv(i, j).derivatives()[0];
      momentumRate_(i, j) = e.T_vq(i, j).derivatives()[0];
    }
  }
}

}  // namespace bio::stepping
