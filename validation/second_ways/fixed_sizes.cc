// Skeleton and path kernels for two to four free coordinates by code of fixed size, where libbio
// simulates an articulated tree.
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
