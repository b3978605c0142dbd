#pragma once

#include <Eigen/Dense>
#include <array>
#include <span>

#include "bio/path/surface/chain.h"

namespace bio {

/// A small motion of a rigid body in G: its point x moves by v + ω × x. Or what is dual to it: the
/// derivatives of a length over v and ω, that is force and moment about G's origin at unit tension,
/// with the sign that the length has.
struct Screw {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< v, or ∂L/∂v
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< ω [rad], or ∂L/∂ω [m]
};

/// A value for each thing that a chain's path hangs on: its ends and the poses of its objects (by
/// their place in the chain). Of motions: how each moves. Of gradients: the derivatives.
struct ChainScrews {
  Eigen::Vector3d P = Eigen::Vector3d::Zero();
  Eigen::Vector3d Q = Eigen::Vector3d::Zero();
  std::array<Screw, maxChain> objects;
};

/// ∂L over the ends and the poses. With t the pieces' directions,
///     ∂L/∂P = −t₀,   ∂L/∂Q = t_m,   ∂L/∂v = t − t′,   ∂L/∂ω = A×t − B×t′
/// for an object whose contacts A, B end the piece t and start t′; 0 for one that is not touched.
ChainScrews chainGradient(const ChainPath& path);

/// The power of a gradient's forces and moments at the motions of what they act on, `count`
/// objects.
double powerOf(const ChainScrews& gradient, const ChainScrews& motion, std::size_t count);

/// Second derivatives of L over the ends [1/m].
struct EndHessian {
  Eigen::Matrix3d PP, PQ, QQ;  ///< PQ: rows P, columns Q
};

/// How a contact shifts over its object, seen from the object.
struct ContactShift {
  double alongA = 0, aside = 0;  ///< of the first contact, α and β [m]
  double turn = 0;               ///< of the direction there, θ [rad]
  double alongB = 0;             ///< of the last contact along the path [m]
};

/// How a taut string gives way: second derivatives of L by the implicit function theorem.
///
/// The equations of solveChain, linearised where they hold, fall apart: shifts along the path do
/// not turn the pieces, so that the (β, θ) of m contacts alone are solved for, 2m numbers, and the
/// matrix is inverted once for any number of motions.
///
/// Domain: ChainPath::isShortest, every touched arc > 0 or = 0, curvature κ ≠ 0 at the contacts. At
/// lift-off second derivatives jump. A path without contacts is a straight line.
class ChainChanges {
 public:
  explicit ChainChanges(const ChainPath& path);

  /// How the contacts (in the path's order) shift as ends and objects move.
  std::array<ContactShift, maxChain> shifts(const ChainScrews& motion) const;

  /// The change of chainGradient, whose origin and axes stay those of G.
  ChainScrews gradientChange(const ChainScrews& motion) const;

  /// Second derivatives over the ends alone: with n, b, d normal, side and length of the first
  /// piece, PP = (1/d)(n nᵀ + (1 − β) b bᵀ), where P moved along b moves the contact by β b.
  EndHessian ends() const;

 private:
  struct PieceChange {
    Eigen::Vector3d t, moment;
  };
  PieceChange pieceChange(std::size_t piece, const ChainScrews& motion,
                          std::span<const ContactShift> shifts) const;
  Eigen::Vector3d startMotion(std::size_t piece, const ChainScrews& motion) const;
  Eigen::Vector3d endMotion(std::size_t piece, const ChainScrews& motion) const;
  double asideAtB(std::size_t contact, const ContactShift& shift) const;

  static constexpr int maxShifts = 2 * maxChain;
  const ChainPath& path_;
  double inverse_[maxShifts][maxShifts];
};

/// ∂L/∂θ of an object's own numbers, and what its changes are made of.
std::array<NumberIntegral, maxSurfaceNumbers> contactNumbers(const ChainObject& object,
                                                             const ChainContact& contact);

/// The change of ∂L/∂θ as the contact shifts.
double numberChange(const NumberIntegral& number, const ContactShift& shift);

}  // namespace bio
