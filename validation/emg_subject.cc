#include "emg_subject.h"

#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace validation {
namespace {

struct MuscleNumbers {
  double& maxIsometricForce;
  double& tendonSlackLength;
};

MuscleNumbers numbersOf(bio::Muscle& muscle) {
  if (muscle.schutte) return {muscle.schutte->maxIsometricForce, muscle.schutte->tendonSlackLength};
  return std::visit(
      [](auto& hill) {
        return MuscleNumbers{hill.maxIsometricForce, hill.tendonSlackLength};
      },
      muscle.hill.value());
}

bio::WrapObject& cylinderOf(bio::Model& model) {
  for (bio::WrapObject& object : model.wrapObjects) {
    if (object.name == "TRI") return object;
  }
  throw std::invalid_argument("the model has no wrapping object 'TRI'");
}

}  // namespace

bio::Model subjectOf(bio::Model model) {
  const std::map<std::string, double> strength = {{"TRIlong", 1.10},  {"TRIlat", 1.10},
                                                  {"TRImed", 1.10},   {"BIClong", 0.90},
                                                  {"BICshort", 0.90}, {"BRD", 1.05}};
  for (bio::Muscle& muscle : model.muscles) {
    const MuscleNumbers numbers = numbersOf(muscle);
    if (const auto factor = strength.find(muscle.name); factor != strength.end())
      numbers.maxIsometricForce *= factor->second;
    numbers.tendonSlackLength *= 1.01;
  }
  cylinderOf(model).radius = 0.0175;
  const std::set<std::string> forearm = {"ulna", "radius", "forearm"};
  for (bio::Body& body : model.bodies) {
    if (!forearm.contains(body.name)) continue;
    body.mass *= 1.05;
    for (double& moment : body.inertia) moment *= 1.05;
  }
  return dampedArmOf(std::move(model), 0.1);
}

bio::Model dampedArmOf(bio::Model model, double viscosity) {
  bio::SpringGeneralizedForce damper;
  damper.name = "subject_damping";
  damper.coordinate = "elbow_flexion";
  damper.viscosity = viscosity;
  model.springForces.push_back(damper);
  return model;
}

}  // namespace validation
