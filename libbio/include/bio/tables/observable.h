#pragma once

#include <Eigen/Dense>
#include <string>
#include <utility>

#include "bio/model/model.h"

namespace bio {

/// A quantity of a motion that can be measured, as a column of a trial names it:
///
///     NAME            coordinate                           [rad] or [m]
///     NAME.speed      its rate                             [rad/s] or [m/s]
///     NAME.moment     what the limb exerts, at a prescribed or locked coordinate, on that which
///                     holds or drives it (a dynamometer's reading); positive where it would raise
///                     the coordinate; the weight and inertia of all that moves are part of it
///                                                          [N·m] or [N]
///     BODY.MARKER.x   position of a marker in the ground   [m]
///     MUSCLE.fiber_length, MUSCLE.pennation, MUSCLE.tendon_force, MUSCLE.activation
///                                                          [m], [rad], [N], 0 to 1
///
/// Pennation is the angle α between fibres and tendon, sin α = ℓ0 sin α0/ℓ, in every class.
struct Observable {
  enum class Kind {
    coordinate,
    speed,
    moment,
    marker,
    fibreLength,
    pennation,
    tendonForce,
    activation
  };
  Kind kind = Kind::coordinate;
  std::string object;  ///< coordinate, muscle, or BODY.MARKER
  int axis = 0;        ///< of a marker: 0 x, 1 y, 2 z of the ground
  bool isCoordinate() const { return kind == Kind::coordinate; }
  friend bool operator==(const Observable&, const Observable&) = default;
};

/// A coordinate itself.
inline Observable ofCoordinate(std::string name) {
  return {Observable::Kind::coordinate, std::move(name), 0};
}

/// The column's name.
std::string nameOf(const Observable& observable);

/// "rad", "m", "rad/s", "m/s", "N·m" or "N"; empty for an activation.
/// @throws std::invalid_argument for a coordinate that the model does not have
std::string unitOf(const Observable& observable, const Model& model);

/// The observable that a column's name stands for, other than a coordinate.
/// @returns whether there is one
bool readObservable(const std::string& column, const Model& model, Observable& found);

/// The observable that a name stands for, a coordinate among them.
/// @throws std::invalid_argument for a name of nothing that can be measured of the model
Observable observableNamed(const std::string& name, const Model& model);

/// A measured course; possibly sampled less often than the excitations.
struct MeasuredChannel {
  Observable what;
  Eigen::VectorXd times;   ///< [s] strictly rising, a subset of the trial's
  Eigen::VectorXd values;  ///< finite, in unitOf()
};

}  // namespace bio
