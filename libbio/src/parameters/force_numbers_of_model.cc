#include <algorithm>
#include <array>
#include <cmath>

#include "parameters/parameter_collector.h"

// Numbers of forces on bodies and of actuators: where they are in a model, OpenSim's names, and how
// well they are known beforehand.

namespace bio {
namespace {

using ForceKind = ForceNumberTarget::Kind;

constexpr const char* axes[] = {"x", "y", "z"};

/// A number that is not negative by its nature, within ten times and known to a half of its size;
/// `size` stands in for one that is 0.
ForceNumberRule positive(std::string name, const char* unit, const char* meaning, double value,
                         double size, double lower = 0) {
  const double spread = std::max(value, size);
  return {std::move(name), unit, meaning, lower * value, 10 * spread, 0.5 * spread};
}

/// A length without force.
ForceNumberRule restingLength(std::string name, const char* meaning, double value) {
  if (value > 0) return {std::move(name), "m", meaning, 0.5 * value, 2 * value, 0.05 * value};
  return {std::move(name), "m", meaning, 0, 0.1, 0.01};
}

struct BushingPart {
  const char* name;
  const char* unit;
  const char* meaning;
  Eigen::Vector3d BushingForce::*member;
};
constexpr std::array bushingParts{
    BushingPart{"rotational_stiffness", "N m/rad", "stiffness of the bushing about an axis",
                &BushingForce::rotationalStiffness},
    BushingPart{"translational_stiffness", "N/m", "stiffness of the bushing along an axis",
                &BushingForce::translationalStiffness},
    BushingPart{"rotational_damping", "N m s/rad", "damping of the bushing about an axis",
                &BushingForce::rotationalDamping},
    BushingPart{"translational_damping", "N s/m", "damping of the bushing along an axis",
                &BushingForce::translationalDamping}};

/// Null: a law of this kind has no such number.
double ElasticPath::*elasticMember(ElasticPathKind kind, int number) {
  constexpr double ElasticPath::*members[] = {&ElasticPath::restLength, &ElasticPath::scale,
                                              &ElasticPath::damping,
                                              &ElasticPath::transitionStrain};
  const int last = kind == ElasticPathKind::ligament ? ForceNumberTarget::pathScale
                   : kind == ElasticPathKind::spring ? ForceNumberTarget::pathDamping
                                                     : ForceNumberTarget::pathTransitionStrain;
  return number <= last ? members[number] : nullptr;
}

ForceNumberRule elasticRule(const ElasticPath& path, int number) {
  const double ElasticPath::*member = elasticMember(path.kind, number);
  if (!member) return {};
  const double value = path.*member;
  const bool isBlankevoort = path.kind == ElasticPathKind::blankevoort1991;
  const bool isSpring = path.kind == ElasticPathKind::spring;
  switch (number) {
    case ForceNumberTarget::pathRestLength:
      return restingLength(isBlankevoort ? "slack_length" : "resting_length",
                           "length at which it begins to pull", value);
    case ForceNumberTarget::pathScale:
      if (isBlankevoort) {
        return positive("linear_stiffness", "N", "force per strain", value, 1e-6, 0.1);
      }
      if (isSpring) return positive("stiffness", "N/m", "stiffness", value, 1e-6, 0.1);
      return positive("pcsa_force", "N", "factor on the force–length curve", value, 1e-6, 0.1);
    case ForceNumberTarget::pathDamping:
      if (isSpring) {
        return positive("dissipation", "s/m", "damping as a share of the tension", value, 1e-6);
      }
      return positive("damping_coefficient", "N s", "damping while it lengthens", value, 1e-6);
    default:
      return {"transition_strain", "",        "strain from which the force is linear",
              0.2 * value,         5 * value, 0.3 * value};
  }
}

}  // namespace

int numForceNumbers(ForceKind kind) {
  constexpr int counts[] = {2, 12, 4, 1};
  return counts[static_cast<int>(kind)];
}

double* forceNumber(Model& model, const ForceNumberTarget& target) {
  switch (target.kind) {
    case ForceKind::pointSpring: {
      PointToPointSpring& spring = model.pointSprings[target.force];
      return target.number == ForceNumberTarget::springStiffness ? &spring.stiffness
                                                                 : &spring.restLength;
    }
    case ForceKind::bushing: {
      const BushingPart& part = bushingParts[static_cast<std::size_t>(target.number / 3)];
      return &(model.bushings[target.force].*part.member)[target.number % 3];
    }
    case ForceKind::elasticPath: {
      ElasticPath& path = model.elasticPaths[target.force];
      return &(path.*elasticMember(path.kind, target.number));
    }
    case ForceKind::actuator:
      break;
  }
  return &model.actuators[target.force].optimalForce;
}

double forceNumber(const Model& model, const ForceNumberTarget& target) {
  return *forceNumber(const_cast<Model&>(model), target);  // read only
}

ForceNumberRule forceNumberRule(const Model& model, const ForceNumberTarget& target) {
  switch (target.kind) {
    case ForceKind::pointSpring: {
      const PointToPointSpring& spring = model.pointSprings[target.force];
      if (target.number == ForceNumberTarget::springRestLength) {
        return restingLength("rest_length", "length without force", spring.restLength);
      }
      return positive("stiffness", "N/m", "stiffness of the spring", spring.stiffness, 1e-6);
    }
    case ForceKind::bushing: {
      const BushingPart& part = bushingParts[static_cast<std::size_t>(target.number / 3)];
      const Eigen::Vector3d& all = model.bushings[target.force].*part.member;
      const int axis = target.number % 3;
      return positive(std::string(part.name) + "." + axes[axis], part.unit, part.meaning, all[axis],
                      std::max(all.maxCoeff(), 1e-6));
    }
    case ForceKind::elasticPath:
      return elasticRule(model.elasticPaths[target.force], target.number);
    case ForceKind::actuator:
      break;
  }
  const CoordinateActuator& actuator = model.actuators[target.force];
  const double value = actuator.optimalForce;
  const double size = std::max(std::abs(value), 1e-6);
  const bool turns = findCoordinate(model, actuator.coordinate).isRotation;
  return {"optimal_force",
          turns ? "N m" : "N",
          "force at a control of 1",
          value > 0 ? 0.1 * value : value - 10 * size,
          value < 0 ? 0.1 * value : value + 10 * size,
          0.3 * size};
}

}  // namespace bio
