#pragma once

#include <vector>

#include "bio/review/model_review.h"
#include "bio/skeleton/skeleton.h"
#include "bio/tables/trial.h"

namespace bio {

/// Lists unusual properties of a trial.
///
/// Errors: a measured angle beyond 2π rad and outside its coordinate's range (degrees). Warnings: a
/// measured angle beyond 4π rad that the range allows; rows 0.5 s apart or more over a minute or
/// more (milliseconds?); else rows further apart than 0.1 s between which an excitation changes,
/// since a straight line between them is not what a muscle was given; a measured series that was
/// interpolated to more rows (interpolationFactor). Unusual: unequal sampling (an interval more
/// than 1 % off the median one); rows usually further apart than 0.1 s, with constant excitations;
/// excitations that are 0 or 1 throughout, or that jump by more than 0.5 between rows; a measured
/// angle jumping by more than 0.5 rad between neighbours; a measured coordinate outside its range
/// in the model; measurements that begin more than 0.1 s after the excitations; an external torque
/// or force above 50 N·m or N, 0 throughout, or jumping by more than 5 between rows.
std::vector<Remark> reviewTrial(const Trial& trial, const Model& model);

/// Reason why a measured series cannot be used, or is too short for its noise to be distinguished
/// from the motion: fewer than `fewest` values, one value throughout, two values throughout
/// (resolution of the sensor). Empty if it can be used.
std::string whyNotUsable(const MeasuredChannel& motion, Eigen::Index fewest = 20);

/// @throws std::invalid_argument naming the file, for a series that cannot be used (whyNotUsable)
void requireUsable(const std::string& file, const MeasuredChannel& motion,
                   Eigen::Index fewest = 20);

/// A line for each measured coordinate that is not compared, because it was locked at another value
/// or is coupled to another coordinate.
/// @throws std::invalid_argument for a measured coordinate that is neither free nor named in
///   `options.lockedValues`, unless all its measured values are within 0.1° or 0.1 mm of its
///   default; and what Skeleton throws
std::vector<std::string> heldRemarks(const Trial& trial, const Model& model,
                                     const SkeletonOptions& options);

}  // namespace bio
