// Skeleton and path kernels for one free coordinate.
#include "bio/path/path_length.h"
#include "bio/skeleton/skeleton_motion.h"

namespace bio {

template void Skeleton::motions<double, 1>(const Eigen::Matrix<double, 1, 1>&,
                                           RigidMotion<double, 1>*) const;
template InertiaJet<1> Skeleton::inertia<1>(const Eigen::Matrix<double, 1, 1>&,
                                            const RigidMotion<double, 1>*) const;
template LengthJet<1> MusclePath::length<1>(const Eigen::Matrix<double, 1, 1>&,
                                            const RigidMotion<double, 1>*,
                                            const Eigen::Matrix<double, 1, 1>*) const;
template std::vector<Eigen::Vector3d> MusclePath::pathPoints<1>(const Eigen::Matrix<double, 1, 1>&,
                                                                const RigidMotion<double, 1>*,
                                                                double) const;

}  // namespace bio
