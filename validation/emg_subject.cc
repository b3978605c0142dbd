#include "emg_subject.h"

#include <map>
#include <stdexcept>

namespace validation {
namespace {

template <class Item>
Item& named(std::vector<Item>& items, const std::string& name) {
  for (Item& item : items) {
    if (item.name == name) return item;
  }
  throw std::invalid_argument("the model has no '" + name + "'");
}

}  // namespace

bio::Model subjectOf(bio::Model model) {
  const std::map<std::string, double> strength = {{"TRIlong", 1.10},  {"TRIlat", 1.10},
                                                  {"TRImed", 1.10},   {"BIClong", 0.90},
                                                  {"BICshort", 0.90}, {"BRD", 1.05}};
  for (const auto& [muscle, factor] : strength) {
    named(model.muscles, muscle).schutte.value().maxIsometricForce *= factor;
  }
  for (bio::Muscle& muscle : model.muscles) muscle.schutte.value().tendonSlackLength *= 1.01;
  named(model.wrapObjects, "TRI").radius = 0.0175;
  for (const char* name : {"ulna", "radius"}) {
    bio::Body& body = named(model.bodies, name);
    body.mass *= 1.05;
    for (double& moment : body.inertia) moment *= 1.05;
  }
  bio::SpringGeneralizedForce damper;
  damper.name = "subject_damping";
  damper.coordinate = "elbow_flexion";
  damper.viscosity = 0.1;
  model.springForces.push_back(damper);
  return model;
}

}  // namespace validation
