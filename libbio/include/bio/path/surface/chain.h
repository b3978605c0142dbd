#pragma once

#include <Eigen/Dense>
#include <array>
#include <span>

#include "bio/path/surface/geodesic.h"

namespace bio {

/// How many surfaces a span of a path can pass.
inline constexpr int maxChain = 4;

/// A surface that a path passes, placed in the frame G in which the path's ends are given.
struct ChainObject {
  Surface surface;
  Eigen::Matrix3d R_GS = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_GS = Eigen::Vector3d::Zero();
  /// Near the surface, in its frame S: the side on which a path goes round whose way is not known
  /// from its last posture; bio/path/surface/way.h finds one.
  Eigen::Vector3d hint = Eigen::Vector3d::UnitX();

  Eigen::Vector3d intoFrame(const Eigen::Vector3d& p_G) const {
    return R_GS.transpose() * (p_G - p_GS);
  }
  Eigen::Vector3d outOfFrame(const Eigen::Vector3d& p_S) const { return R_GS * p_S + p_GS; }
};

/// How the path passes one of the objects.
enum class Passing {
  clear,     ///< straight, without touching it
  touching,  ///< over its surface
  endInside  ///< an end of the path lies inside: the object is left out
};

/// Memory of an object from one posture to the next, in its frame S.
struct ContactMemory {
  Passing passing = Passing::clear;
  Eigen::Vector3d p_SA = Eigen::Vector3d::Zero();  ///< first contact
  Eigen::Vector3d u_SA = Eigen::Vector3d::Zero();  ///< direction there
  double arc = 0;                                  ///< length on the surface [m]
};

/// Where the next posture's search starts. Without it (`known` false) the hints decide the way.
struct ChainMemory {
  bool known = false;
  std::array<ContactMemory, maxChain> contacts;
};

/// Event in a search that was not a plain continuation of the last posture's path.
enum class ChainEvent {
  none,       ///< found from the memory, or the first of its kind
  jumped,     ///< the remembered way has ended, or the posture has leapt: another may be followed
  cutsAgain,  ///< a straight piece cuts a touched torus elsewhere: it must stand twice in the chain
  notFound,   ///< no path satisfies the equations to the tolerance: the result is not valid
};

/// A touched object's part of the path; vectors in G.
struct ChainContact {
  int object = 0;                               ///< its place among the objects
  Eigen::Vector3d A, B;                         ///< first and last contact
  SurfaceFrame atA, atB;                        ///< u along the path
  double arc = 0;                               ///< geodesic length s from A to B [m] ≥ 0
  double a = 1, aSlope = 0, r = 0, rSlope = 1;  ///< at B, as in GeodesicPoint
};

/// A straight piece; piece i lies before contact i, the last after the last contact. Vectors in G.
struct ChainPiece {
  Eigen::Vector3d from, to;
  Eigen::Vector3d t;  ///< unit, along the path
  double length;      ///< [m]
};

/// The taut string from P to Q over a chain of surfaces.
struct ChainPath {
  double length = 0;  ///< L [m]
  int numContacts = 0;
  std::array<ChainContact, maxChain> contacts;  ///< the objects that are touched, in order
  std::array<ChainPiece, maxChain + 1> pieces;  ///< numContacts + 1 of them
  std::array<Passing, maxChain> passing{};      ///< of each object
  ChainEvent event = ChainEvent::none;
  int iterations = 0;      ///< Newton's, of all tries together
  bool isShortest = true;  ///< among its neighbours: no conjugate point, it does not slip sideways

  const Eigen::Vector3d& tangentP() const { return pieces[0].t; }
  const Eigen::Vector3d& tangentQ() const {
    return pieces[static_cast<std::size_t>(numContacts)].t;
  }
};

/// The taut string from P to Q over surfaces that it passes in the order given.
///
/// Straight pieces and geodesics that meet without a corner. Of each touched object the contact's
/// place (α along, β aside), its direction θ and its length σ are unknown; with n, b the normal and
/// the side at the first (A) and the last contact (B), t the straight pieces' directions,
///     n_A·t = b_A·t = 0,   n_B·t′ = b_B·t′ = 0
/// are solved together for all of them by Newton's method. Its matrix is exact: the end of a
/// geodesic follows the start by the Jacobi fields of GeodesicPoint, the frames turn by II. (θ
/// follows from b_A·t = 0, which leaves three unknowns an object; together they keep the matrix
/// block tridiagonal.) An object is left where σ < 0 (the string lifts off) and touched where the
/// others' straight piece cuts it; L is C¹ there, C∞ elsewhere.
///
/// The search starts from the memory, which is brought up to date, or from a relaxed polygon
/// through the hints (bio/path/surface/taut_polygon.h). The result depends on the memory only
/// through which of several local geodesics it is, and to rounding.
///
/// Domain: the contact with one object is one arc; a torus that a path touches over one rim and
/// under the other stands twice in the chain (ChainEvent::cutsAgain tells). Ends inside an object:
/// Passing::endInside. Source of the idea of solving a chain by natural variations: Scholz,
/// Sherman, Stavness, Delp, Kecskeméthy, Multibody System Dynamics 36 (2016) 195. Departures:
/// Gaussian curvature from g alone, no quaternion frames, touch and lift-off as above,
/// extrapolation instead of Runge–Kutta.
///
/// Allocates nothing.
/// @param leftOut  bits of the objects that are as if they were not there (Passing::clear)
/// @throws std::invalid_argument for more than maxChain objects
ChainPath solveChain(const Eigen::Vector3d& P, const Eigen::Vector3d& Q,
                     std::span<const ChainObject> objects, ChainMemory& memory,
                     unsigned leftOut = 0);

}  // namespace bio
