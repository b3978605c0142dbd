#pragma once

#include <cmath>
#include <type_traits>

#include "support/random_chains.h"

/// Random motions of a chain's ends and objects, for differences.
namespace support {

inline bio::ChainScrews randomMotion(RandomChains& random) {
  bio::ChainScrews motion;
  motion.P = random.direction();
  motion.Q = random.direction();
  for (bio::Screw& screw : motion.objects) {
    screw.linear = random.direction();
    screw.angular = 10 * random.direction();
  }
  return motion;
}

// The chain after `share` of a motion.
inline RandomChain moved(RandomChain chain, const bio::ChainScrews& motion, double share) {
  chain.P += share * motion.P;
  chain.Q += share * motion.Q;
  for (std::size_t j = 0; j < chain.objects.size(); ++j) {
    const bio::Screw& screw = motion.objects[j];
    const double turn = screw.angular.norm();
    const Eigen::Matrix3d R =
        Eigen::AngleAxis<double>(turn * share, screw.angular / turn).toRotationMatrix();
    bio::ChainObject& object = chain.objects[j];
    object.R_GS = R * object.R_GS;
    object.p_GS = R * object.p_GS + share * screw.linear;
  }
  return chain;
}

inline double along(const bio::ChainScrews& gradient, const bio::ChainScrews& motion) {
  double sum = gradient.P.dot(motion.P) + gradient.Q.dot(motion.Q);
  for (std::size_t j = 0; j < bio::maxChain; ++j) {
    sum += gradient.objects[j].linear.dot(motion.objects[j].linear) +
           gradient.objects[j].angular.dot(motion.objects[j].angular);
  }
  return sum;
}

// All numbers of a set of screws.
inline Eigen::Matrix<double, 6 + 6 * bio::maxChain, 1> flat(const bio::ChainScrews& screws) {
  Eigen::Matrix<double, 6 + 6 * bio::maxChain, 1> all;
  all.head<3>() = screws.P;
  all.segment<3>(3) = screws.Q;
  for (int j = 0; j < bio::maxChain; ++j) {
    all.segment<3>(6 + 6 * j) = screws.objects[static_cast<std::size_t>(j)].linear;
    all.segment<3>(9 + 6 * j) = screws.objects[static_cast<std::size_t>(j)].angular;
  }
  return all;
}

// Not so near lift-off or an end that a difference would see the other side.
inline bool isWellInside(const bio::ChainPath& path) {
  if (path.event != bio::ChainEvent::none || !path.isShortest || path.numContacts == 0)
    return false;
  for (int i = 0; i <= path.numContacts; ++i) {
    const auto si = static_cast<std::size_t>(i);
    if (path.pieces[si].length < 5e-3) return false;
    if (i < path.numContacts && path.contacts[si].arc < 2e-3) return false;
  }
  return true;
}

// f along the motion or number, by a five-point difference.
template <class F>
auto difference(const F& f, double h) {
  const auto a = f(h), b = f(-h), c = f(2 * h), d = f(-2 * h);
  return std::remove_cv_t<decltype(a)>((8 * (a - b) - (c - d)) / (12 * h));
}

}  // namespace support
