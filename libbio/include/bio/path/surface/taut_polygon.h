#pragma once

#include <Eigen/Dense>
#include <array>
#include <span>

#include "bio/path/surface/chain.h"

namespace bio {

/// A rough taut string: where Newton's method starts when nothing is known.
///
/// A polygon from P over the hints of the objects to Q, each corner moved to the middle of its
/// neighbours (over-relaxed) and, where that is inside an object, onto its surface: the string
/// shortens without passing through. So it stays on the side of the hints as long as that is a
/// local minimum of the length, and slides off where it is not. Then once more with eighths of the
/// sides near the contacts.
///
/// @param inPlay  which of the objects count
/// @param rounds  over all corners, of either
/// @return for each object how the polygon passes it
std::array<ContactMemory, maxChain> tautPolygon(const Eigen::Vector3d& P, const Eigen::Vector3d& Q,
                                                std::span<const ChainObject> objects,
                                                const std::array<bool, maxChain>& inPlay,
                                                int rounds);

}  // namespace bio
