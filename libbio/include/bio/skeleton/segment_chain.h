#pragma once

#include <Eigen/Dense>
#include <vector>

#include "bio/skeleton/articulated_tree.h"

namespace bio {

/// The mobilities between two segments of a tree, in order from one to the other: how a point of
/// the segment `to` moves as seen from the segment `from`.
///
/// Mobilities that both have on their way from the ground do not count; those on the way to `from`
/// count backwards (sign −1, outermost first). In world vectors of the moment, with
/// u_j = σ_j (ω_j × x + s_j) the movement of x by mobility j,
///     ∂_jx = u_j,   ∂_k∂_jx = σ_k ω_k × u_j  (k before j, or j itself)
/// and for j with itself besides σ_j (ω_D × x + s_D), D = ∂S_j/∂q_j. Exact, at every posture.
/// From the ground this is the movement of a point in space.
class SegmentChain {
 public:
  struct Step {
    int mobility;
    int slot;     ///< which of support() moves it
    double sign;  ///< σ
    bool bends;   ///< D ≠ 0 somewhere
  };

  /// The tree is not kept. @throws std::invalid_argument a segment that the tree does not have
  SegmentChain(const ArticulatedTree& tree, int from, int to);

  const std::vector<Step>& steps() const { return steps_; }
  /// Indices of the coordinates that move the one against the other, rising.
  const std::vector<int>& support() const { return support_; }
  /// Makes slots those of a larger, rising support, which must contain support().
  void renumber(const std::vector<int>& larger);

 private:
  std::vector<Step> steps_;
  std::vector<int> support_;
};

/// u_j for every step of a chain, of the point at x in the ground; `moves` has steps().size().
template <class T>
void chainMoves(const SegmentChain& chain, const TreeMotion<T>& motion, const Vec3<T>& x,
                Vec3<T>* moves) {
  for (const SegmentChain::Step& step : chain.steps()) {
    *moves++ = velocityAt(motion.screw[static_cast<std::size_t>(step.mobility)], x) * step.sign;
  }
}

/// Adds f·∂²x/∂q_a∂q_b to `second`, over the slots a, b of a chain.
template <class T, class Second>
void addSecondsAlong(const SegmentChain& chain, const TreeMotion<T>& motion, const Vec3<T>& x,
                     const Vec3<T>* moves, const Vec3<T>& f, Second& second) {
  const auto& steps = chain.steps();
  for (std::size_t j = 0; j < steps.size(); ++j) {
    const Vec3<T>& u = moves[j];
    // f·(ω × u) = ω·(u × f)
    T w[3];
    detail::crossInto(u.data(), f.data(), w);
    const int a = steps[j].slot;
    for (std::size_t k = 0; k <= j; ++k) {
      const auto& S = motion.screw[static_cast<std::size_t>(steps[k].mobility)];
      const T value = (S[0] * w[0] + S[1] * w[1] + S[2] * w[2]) * steps[k].sign;
      const int b = steps[k].slot;
      second(a, b) += value;
      if (k != j) second(b, a) += value;
    }
    if (!steps[j].bends) continue;
    const auto& D = motion.screw1[static_cast<std::size_t>(steps[j].mobility)];
    second(a, a) += f.dot(velocityAt(D, x)) * steps[j].sign;
  }
}

}  // namespace bio
