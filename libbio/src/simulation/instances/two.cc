// Skeleton and path kernels for two free coordinates.
#include "bio/path/path_length.h"
#include "bio/skeleton/skeleton_motion.h"

namespace bio {

template void Skeleton::motions<double, 2>(const Eigen::Matrix<double, 2, 1>&,
                                           RigidMotion<double, 2>*) const;
template InertiaJet<2> Skeleton::inertia<2>(const Eigen::Matrix<double, 2, 1>&,
                                            const RigidMotion<double, 2>*) const;
template LengthJet<2> MusclePath::length<2>(const Eigen::Matrix<double, 2, 1>&,
                                            const RigidMotion<double, 2>*,
                                            const Eigen::Matrix<double, 2, 1>*) const;
template std::vector<Eigen::Vector3d> MusclePath::pathPoints<2>(const Eigen::Matrix<double, 2, 1>&,
                                                                const RigidMotion<double, 2>*,
                                                                double) const;

}  // namespace bio
