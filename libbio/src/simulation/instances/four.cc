// Skeleton and path kernels for four free coordinates.
#include "bio/path/path_length.h"
#include "bio/skeleton/skeleton_motion.h"

namespace bio {

template void Skeleton::motions<double, 4>(const Eigen::Matrix<double, 4, 1>&,
                                           RigidMotion<double, 4>*) const;
template InertiaJet<4> Skeleton::inertia<4>(const Eigen::Matrix<double, 4, 1>&,
                                            const RigidMotion<double, 4>*) const;
template LengthJet<4> MusclePath::length<4>(const Eigen::Matrix<double, 4, 1>&,
                                            const RigidMotion<double, 4>*,
                                            const Eigen::Matrix<double, 4, 1>*) const;
template std::vector<Eigen::Vector3d> MusclePath::pathPoints<4>(const Eigen::Matrix<double, 4, 1>&,
                                                                const RigidMotion<double, 4>*,
                                                                double) const;

}  // namespace bio
