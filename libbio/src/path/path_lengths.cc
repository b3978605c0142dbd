#include "bio/path/path_lengths.h"

#include <fmt/format.h>

#include <stdexcept>

namespace bio {

PathLengths::PathLengths(const Skeleton& skeleton) : skeleton_(&skeleton) {
  if (skeleton.tree()) {
    onTree_.emplace(skeleton);
  } else {
    moved_.resize(skeleton.numSegments());
  }
}

void PathLengths::add(const Muscle& muscle, const MusclePath& path) {
  if (onTree_) onTree_->add(muscle, path);
  paths_.push_back(&path);
  names_.push_back(muscle.name);
}

void PathLengths::moveTo(const Eigen::VectorXd& q) {
  at_ = q;
  if (onTree_) return onTree_->moveTo(q);
  q_ = q;
  skeleton_->motions<double, 1>(q_, moved_.data());
}

PathLengths::Along PathLengths::along(std::size_t path) {
  try {
    return evaluate(path);
  } catch (const std::domain_error& e) {
    throw std::domain_error(fmt::format("muscle '{}': {}; at {}", names_[path], e.what(),
                                        describePosture(*skeleton_, at_)));
  }
}

PathLengths::Along PathLengths::evaluate(std::size_t path) {
  if (onTree_) {
    const LengthJet<Eigen::Dynamic>& jet = onTree_->length(path);
    return {jet.length, jet.dL_dq[0], jet.secondIn(0, 0), jet.wrapped};
  }
  const LengthJet<1> jet = paths_[path]->length<1>(q_, moved_.data());
  return {jet.length, jet.dL_dq[0], jet.d2L_dq2(0, 0), jet.wrapped};
}

}  // namespace bio
