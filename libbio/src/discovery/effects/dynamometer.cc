#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "discovery/effects/effects.h"

// What the lever of a dynamometer adds to the moment that it records while it moves a limb (Winter,
// Wells & Orr 1981; Herzog 1988). Priors: levers and pads of some kilograms, 0.1 to 0.4 m from the
// axis; judgements.

namespace bio::discover {
namespace {

bool isOnADynamometer(const EncompassingModel& model, const MovingCoordinate& at) {
  return model.system().isPrescribed(at.index) && at.coordinate.isRotation;
}

}  // namespace

void addLeverWeight(EncompassingModel& model, const MovingCoordinate& at) {
  if (!isOnADynamometer(model, at)) return;
  constexpr double pi = std::numbers::pi;
  // an angle of any size has others a turn away, so that none of interest is at a bound
  addExpression(model, at,
                {"lever_weight",
                 "weight of the dynamometer's lever",
                 "The recorded moment contains the weight of the dynamometer's lever.",
                 "w*cos(q-r)",
                 {"w", "r"},
                 {amplitude("lever_weight.torque", "N m", 0, 30, 3),
                  shape("lever_weight.angle", "rad", 0, -2 * pi, 2 * pi, pi / std::sqrt(3.0))},
                 {{0.5, 0}, {0.5, pi / 2}, {0.5, -pi / 2}, {0.5, pi}}});
}

// As an inertia alike about all axes of the nearest body that is moved: its reaction is −I·q̈.
void addLeverInertia(EncompassingModel& model, const MovingCoordinate& at) {
  if (!isOnADynamometer(model, at) || at.axis.isZero()) return;
  std::vector<Meaning::Part> parts;
  for (const char* component : {".inertia.xx", ".inertia.yy", ".inertia.zz"}) {
    for (const Meaning::Part& part : model.numbers(at.movedBodies.front() + component))
      parts.push_back(part);
  }
  const std::size_t I =
      model.add(amplitude(model.idAt(at, "lever_inertia.inertia"), "kg m^2", 0, 3, 0.1),
                {Meaning::Kind::shift, parts});
  model.add(candidateAt(model, at, "lever_inertia", "inertia of the dynamometer's lever",
                        "The recorded moment contains the inertia of the dynamometer's lever.", {I},
                        {{0.03}}));
}

}  // namespace bio::discover
