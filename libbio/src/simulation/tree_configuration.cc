#include "bio/simulation/tree_configuration.h"

#include <limits>
#include <stdexcept>

#include "bio/skeleton/tree_motion.h"

namespace bio {
namespace {

const Skeleton& skeletonWithTree(const MusculoskeletalSystem& system) {
  if (!system.tree()) throw std::invalid_argument("the system's skeleton is not a tree");
  return system.skeleton();
}

}  // namespace

SystemConfiguration<Eigen::Dynamic>::SystemConfiguration(const MusculoskeletalSystem& system)
    : system_(&system),
      places_(skeletonWithTree(system)),
      motion_(system.tree()->newMotion<double>()),
      energy_(*system.tree()),
      q_(system.skeleton().defaultValues()),
      still_(Vector::Zero(q_.size())) {
  for (std::size_t i = 0; i < system.numPaths(); ++i) {
    work_.push_back(system.treePath(i).newWork());
    lengths_.push_back(system.treePath(i).newLength(system.skeleton().numCoordinates()));
  }
}

void SystemConfiguration<Eigen::Dynamic>::moveTo(const Vector& q) {
  moveSkeletonTo(q);
  for (std::size_t i = 0; i < lengths_.size(); ++i) {
    try {
      system_->treePath(i).evaluate(system_->path(i).compiled(), q_, holds_ ? held_ : q_, motion_,
                                    work_[i], lengths_[i]);
    } catch (const std::domain_error&) {  // no taut string: an iteration sees a failed step
      lengths_[i].length = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

void SystemConfiguration<Eigen::Dynamic>::moveSkeletonTo(const Vector& q) {
  q_ = q;
  system_->tree()->place(q_.data(), motion_);
  evaluated_ = nullptr;
}

void SystemConfiguration<Eigen::Dynamic>::shift(const Vector& d) {
  q_ += d;
  system_->tree()->place(q_.data(), motion_);
  evaluated_ = nullptr;
  for (LengthJet<Eigen::Dynamic>& path : lengths_) {
    const std::vector<int>& support = path.support;
    for (std::size_t a = 0; a < support.size(); ++a) {
      double change = 0;
      for (std::size_t b = 0; b < support.size(); ++b) {
        change +=
            path.second(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) * d[support[b]];
      }
      path.length += d[support[a]] * (path.dL_dq[support[a]] + change / 2);
      path.dL_dq[support[a]] += change;
    }
  }
}

const EnergyDerivatives<Eigen::Dynamic>& SystemConfiguration<Eigen::Dynamic>::energy(
    const Vector& v) {
  evaluated_ = &energy_.evaluate(motion_, v.data());
  return *evaluated_;
}

const EnergyDerivatives<Eigen::Dynamic>& SystemConfiguration<Eigen::Dynamic>::known() {
  return evaluated_ ? *evaluated_ : energy(still_);
}

Placement<double> SystemConfiguration<Eigen::Dynamic>::placement(std::size_t segment) const {
  return motion_.segments[static_cast<std::size_t>(places_.segmentOf(segment))] *
         places_.offsetOf(segment);
}

// Everything beyond a mobility turns and shifts with its screw.
Placement<double> SystemConfiguration<Eigen::Dynamic>::change(std::size_t segment,
                                                              int coordinate) const {
  const Placement<double> X = placement(segment);
  Placement<double> sum{Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero()};
  const ArticulatedTree& tree = *system_->tree();
  for (int m = tree.mobilityOf(places_.segmentOf(segment)); m >= 0;) {
    const Mobility& mobility = tree.mobilities()[static_cast<std::size_t>(m)];
    if (mobility.coordinate == coordinate) {
      const SpatialVector<double>& S = motion_.screw[static_cast<std::size_t>(m)];
      const Eigen::Vector3d turn(S[0], S[1], S[2]);
      for (int i = 0; i < 3; ++i) sum.R.col(i) += turn.cross(X.R.col(i));
      sum.p += velocityAt(S, X.p);
    }
    m = mobility.parent;
  }
  return sum;
}

}  // namespace bio
