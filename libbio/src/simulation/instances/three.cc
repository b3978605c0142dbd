// Skeleton and path kernels for three free coordinates.
#include "bio/path/path_length.h"
#include "bio/skeleton/skeleton_motion.h"

namespace bio {

template void Skeleton::motions<double, 3>(const Eigen::Matrix<double, 3, 1>&,
                                           RigidMotion<double, 3>*) const;
template InertiaJet<3> Skeleton::inertia<3>(const Eigen::Matrix<double, 3, 1>&,
                                            const RigidMotion<double, 3>*) const;
template LengthJet<3> MusclePath::length<3>(const Eigen::Matrix<double, 3, 1>&,
                                            const RigidMotion<double, 3>*,
                                            const Eigen::Matrix<double, 3, 1>*) const;
template std::vector<Eigen::Vector3d> MusclePath::pathPoints<3>(const Eigen::Matrix<double, 3, 1>&,
                                                                const RigidMotion<double, 3>*,
                                                                double) const;

}  // namespace bio
