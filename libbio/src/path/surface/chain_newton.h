#pragma once

#include <array>
#include <span>

#include "bio/path/surface/chain.h"

namespace bio::detail {

/// A touched object while its contact is looked for; x, u in the object's frame.
struct ContactGuess {
  int object = 0;
  Eigen::Vector3d x, u;
  double arc = 0;
};

/// The objects that are touched at present.
struct ContactGuesses {
  int count = 0;
  std::array<ContactGuess, maxChain> each;
};

/// Solves A x = b for n ≤ 4·maxChain unknowns by elimination with row exchanges; x over b.
/// @return false if A is singular
inline constexpr int maxUnknowns = 4 * maxChain;
struct LinearSystem {
  int n = 0;
  double A[maxUnknowns][maxUnknowns];
  double b[maxUnknowns];
};
bool solveInPlace(LinearSystem& system);

/// Newton's method for the contacts of all touched objects. Writes contacts, pieces and
/// numContacts of `path`, and the guesses it ends with.
/// A last step of less than 3e-9 (of radii of curvature and pieces) does not walk ellipsoids and
/// tori again: contacts and directions are then right to its square, a, r and with them second
/// derivatives to 3e-9.
/// @return whether the equations hold to 1e-12, or to where rounding ends
bool solveContacts(const Eigen::Vector3d& P, const Eigen::Vector3d& Q,
                   std::span<const ChainObject> objects, ContactGuesses& guesses, ChainPath& path);

}  // namespace bio::detail
