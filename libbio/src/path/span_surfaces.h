#pragma once

// Which wrap objects the spans of a path may touch, and how they pass them; not public.

#include <cstddef>
#include <utility>
#include <vector>

#include "bio/path/compiled_path.h"
#include "path/surface/wrap_candidate.h"

namespace bio {

/// Decides by sampled postures. `bits` are the conditions on points that hold in a variant; only
/// postures in which exactly these hold count for it. The path has its nodes, conditions and
/// surfaces before the first question.
class SpanSurfaces {
 public:
  SpanSurfaces(const CompiledPath& path, const std::vector<Posture>& postures)
      : path_(path), postures_(postures) {}

  /// Gives a surface to the spans of a variant that may touch it.
  void assign(const CandidateWrap& wrap, PathVariant& variant, std::size_t bits) const;

  /// Whether a span touches more than one of its surfaces in some posture.
  bool touchesSeveral(const PathSpan& span, std::size_t bits) const;

  /// Whether a posture has exactly the conditions of these bits.
  bool occurs(std::size_t bits, const Posture& posture) const;

 private:
  // A span and a wrap that might touch.
  struct Encounter {
    std::size_t span = 0;
    bool moves = false;
    bool penetrates = false;
    double lengthChange = 0;    // of a span that must pass on the other side but meets nothing
    std::size_t decidedIn = 0;  // the posture that tells the way
    SpanSurface way;
  };

  bool inRange(const CandidateWrap& wrap, const PathSpan& span) const;
  bool movesAgainst(const CandidateWrap& wrap, const PathSpan& span) const;
  std::pair<Vec3<double>, Vec3<double>> ends(const CandidateWrap& wrap, const PathSpan& span,
                                             const Posture& posture) const;
  SpanSurface wayRound(std::size_t index, const Vec3<double>& P, const Vec3<double>& Q) const;
  bool passesWrongSide(const CandidateWrap& wrap, const PathSpan& span, Encounter& encounter) const;
  bool bendsRound(const PathSurface& surface, const Vec3<double>& P, const Vec3<double>& Q,
                  Encounter& encounter) const;
  void keepContinuous(const CandidateWrap& wrap, const PathSpan& span, std::size_t bits,
                      Encounter& encounter) const;
  static void give(const Encounter& encounter, PathVariant& variant);

  const CompiledPath& path_;
  const std::vector<Posture>& postures_;
};

}  // namespace bio
