#pragma once

// What a touched object of a chain does to a path's parameter gradient; not public.

#include "bio/path/compiled_path.h"
#include "bio/path/path_gradient.h"
#include "bio/path/surface/chain_change.h"

namespace bio {

/// A touched object with the force and moment on it. `Wrap` is a PathGradient's OfWrap.
class TouchedObject {
 public:
  /// @param R_GB  of the body that the object belongs to
  /// @param turnAxes  of rotations of the object in its body, in the object's frame
  /// @param wrench  chainGradient of the object, about the ground's origin
  TouchedObject(const PathSurface& surface, const Placement<double>& X_GC,
                const Eigen::Matrix3d& R_GB, const Eigen::Matrix3d& turnAxes,
                const ChainObject& object, const ChainContact& contact, const Screw& wrench)
      : firstNumber_(surface.general ? wrap_rows::numbers : wrap_rows::radius),
        X_GC_(X_GC),
        intoBody_(R_GB.transpose()),
        intoTurns_(turnAxes.transpose() * X_GC.R.transpose()),
        wrench_(wrench),
        moment_(wrench.angular - X_GC.p.cross(wrench.linear)),
        numNumbers_(numNumbersOf(object.surface)),
        numbers_(contactNumbers(object, contact)) {}

  /// ∂ℓ/∂θ into column 0: of its own numbers, its place in the body and its rotation there.
  template <class Wrap>
  void addTo(Wrap& wrap) const {
    for (int n = 0; n < numNumbers_; ++n) {
      wrap(firstNumber_ + n, 0) += numbers_[static_cast<std::size_t>(n)].length;
    }
    wrap.template block<3, 1>(wrap_rows::translation, 0) += intoBody_ * wrench_.linear;
    wrap.template block<3, 1>(wrap_rows::rotation, 0) += intoTurns_ * moment_;
  }

  /// Their change with a coordinate into its column; force and moment in axes that move with the
  /// object.
  /// @param changed  change of the wrench, whose axes stay
  /// @param motion  of the object
  template <class Wrap>
  void addChangeTo(Wrap& wrap, Eigen::Index column, const ContactShift& shift, const Screw& changed,
                   const Screw& motion) const {
    for (int n = 0; n < numNumbers_; ++n) {
      wrap(firstNumber_ + n, column) += numberChange(numbers_[static_cast<std::size_t>(n)], shift);
    }
    const Eigen::Vector3d originMoves = motion.linear + motion.angular.cross(X_GC_.p);
    const Eigen::Vector3d moment =
        changed.angular - X_GC_.p.cross(changed.linear) - originMoves.cross(wrench_.linear);
    wrap.template block<3, 1>(wrap_rows::translation, column) +=
        intoBody_ * (changed.linear - motion.angular.cross(wrench_.linear));
    wrap.template block<3, 1>(wrap_rows::rotation, column) +=
        intoTurns_ * (moment - motion.angular.cross(moment_));
  }

 private:
  int firstNumber_;  ///< row
  Placement<double> X_GC_;
  Eigen::Matrix3d intoBody_, intoTurns_;
  Screw wrench_;
  Eigen::Vector3d moment_;  ///< about the object's own origin
  int numNumbers_;
  std::array<NumberIntegral, maxSurfaceNumbers> numbers_;
};

}  // namespace bio
