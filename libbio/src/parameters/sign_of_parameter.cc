#include "bio/parameters/sign_of_parameter.h"

namespace bio {
namespace {

struct CannotBeNegative {
  bool operator()(const MuscleTarget&) const { return true; }
  bool operator()(const MuscleNumberTarget&) const { return true; }
  bool operator()(const ForceNumberTarget&) const { return true; }
  bool operator()(const WrapTarget& target) const { return target.isSize(); }
  bool operator()(const BodyTarget& target) const {
    return target.quantity == BodyTarget::Quantity::mass;
  }
  bool operator()(const LimitForceTarget& target) const {
    return target.quantity != LimitForceTarget::Quantity::upperLimit &&
           target.quantity != LimitForceTarget::Quantity::lowerLimit;
  }
  bool operator()(const SpringForceTarget& target) const {
    return target.quantity == SpringForceTarget::Quantity::viscosity;
  }
  bool operator()(const auto&) const { return false; }
};

}  // namespace

bool cannotBeNegative(const ModelParameter& parameter) {
  return parameter.lower >= 0 && std::visit(CannotBeNegative{}, parameter.targets.front());
}

}  // namespace bio
