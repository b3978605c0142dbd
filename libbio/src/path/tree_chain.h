#pragma once

#include "bio/path/path_chain.h"
#include "bio/path/surface/chain_change.h"
#include "bio/path/tree_path.h"

namespace bio {

/// A chain of surfaces over an articulated tree, pulled taut; all in the ground.
struct TautTreeChain {
  ChainPlacements X_GC;
  PlacedChain placed;
  ChainPath taut;
};

/// @param used  bits of the surfaces that other spans use; those touched are added
/// @throws std::domain_error if no taut string is found
TautTreeChain tautTreeChain(const CompiledPath& path, const TreePath::OverChain& over,
                            const TreeMotion<double>& motion, const Vec3<double>& P,
                            const Vec3<double>& Q, unsigned& used);

/// Movements of ends and objects by each coordinate of the support, as the carrier sees them, into
/// work.slotMoves: those of P, of Q, then linear and angular ones of each object.
void fillChainMotions(const TreePath::OverChain& over, const TreeMotion<double>& motion,
                      const Vec3<double>& P, const Vec3<double>& Q, SupportedLength<double>& work);

/// Movements by coordinate `slot` of the support.
ChainScrews chainMotionOf(const TreePath::OverChain& over, const SupportedLength<double>& work,
                          std::size_t slot);

/// Adds a span over a chain with its first and second derivatives. False, and nothing added, if it
/// touches nothing.
bool addTreeChain(const CompiledPath& path, const TreePath::OverChain& over,
                  const TreeMotion<double>& motion, const Vec3<double>& P, const Vec3<double>& Q,
                  unsigned& used, SupportedLength<double>& work);

}  // namespace bio
