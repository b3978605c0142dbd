#include "path/chain_compiler.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "bio/path/surface/way.h"
#include "path/path_reach.h"

namespace bio {
namespace {

constexpr std::size_t numOrderPostures = 6;
constexpr double sameLength = 1e-9;  // [m]
// How far beyond an object's middle a contact may slip, of its extent. Measured: without a limit 11
// of 500 lengths of MoBL_ARMS wind up, by 1 to 78 mm; with 0 TRIlong of arm26 jumps by 1.9 mm, with
// this by 0.04 mm.
constexpr double mostBeyond = 0.7;

// How far a sphere, cylinder or ellipsoid reaches along a direction of its frame.
double extentAlong(const Surface& surface, const Vec3<double>& direction) {
  if (const auto* ellipsoid = std::get_if<EllipsoidSurface>(&surface)) {
    return ellipsoid->semiAxes().cwiseProduct(direction).norm();
  }
  return sizeOf(surface);
}

// The ends and the members' placements in one posture, in the ground.
struct ChainPosture {
  Vec3<double> P, Q;
  ChainPlacements X_GC;
};

class ChainCompiler {
 public:
  ChainCompiler(const CompiledPath& path, const PathSpan& span,
                const std::vector<const Posture*>& postures)
      : path_(path), span_(span) {
    if (span.surfaces.size() > maxChain) {
      throw UnsupportedWrap(fmt::format("{} wrap objects lie on one span, at most {} are supported",
                                        span.surfaces.size(), maxChain));
    }
    chain_.count = static_cast<int>(span.surfaces.size());
    for (std::size_t j = 0; j < span.surfaces.size(); ++j) {
      chain_.members[j].surface = span.surfaces[j].surface;
      chain_.inOneSegment =
          chain_.inOneSegment && path.surfaces[span.surfaces[j].surface].segment ==
                                     path.surfaces[span.surfaces[0].surface].segment;
    }
    // evenly from near the default to far
    const std::size_t kept = std::min(postures.size(), maxChainStarts);
    for (std::size_t i = 0; i < kept; ++i) {
      postures_.push_back(postures[i * postures.size() / kept]);
    }
  }

  CompiledChain compile() {
    for (std::size_t j = 0; j < size(); ++j) chain_.members[j].hint = hintFor(j);
    const std::size_t first = order();
    follow(first);
    result_.chain = std::move(chain_);
    return std::move(result_);
  }

 private:
  std::size_t size() const { return static_cast<std::size_t>(chain_.count); }
  const PathSurface& surface(std::size_t member) const {
    return path_.surfaces[chain_.members[member].surface];
  }

  ChainPosture at(const Posture& posture) const {
    ChainPosture here;
    here.P = nodePosition(path_, path_.nodes[span_.a], posture);
    here.Q = nodePosition(path_, path_.nodes[span_.b], posture);
    here.X_GC = placementsIn(posture, path_, chain_);
    return here;
  }

  std::pair<Vec3<double>, Vec3<double>> endsSeen(std::size_t member, const Posture& posture) const {
    const PathSurface& s = surface(member);
    const auto seen = [&](std::size_t node) {
      return seenFrom(posture, s.segment, s.X_SC, nodePosition(path_, path_.nodes[node], posture));
    };
    return {seen(span_.a), seen(span_.b)};
  }

  // From the nearest posture in which the chord reaches it.
  Vec3<double> hintFor(std::size_t member) const {
    for (const Posture* posture : postures_) {
      const auto [P, Q] = endsSeen(member, *posture);
      if (closestApproach(surface(member), P, Q) < 1.02) return hintIn(member, *posture);
    }
    return hintIn(member, *postures_.front());
  }

  Vec3<double> hintIn(std::size_t member, const Posture& posture) const {
    const auto [P, Q] = endsSeen(member, posture);
    const PathSurface& s = surface(member);
    if (s.general) {
      if (s.quadrant == WrapQuadrant::all) return hintOfShortest(*s.general, P, Q);
      return hintTowards(*s.general, directionOf(s.quadrant), P, Q);
    }
    // the middle of the way of the object alone
    if (s.isSphere) {
      const double sign = sphereWay(s.quadrant, P, Q) == Way::shorter ? 1 : -1;
      return sign * s.radius * (P.normalized() + Q.normalized()).normalized();
    }
    const Side side = cylinderSide(s.quadrant, P, Q);
    const double sign = side == Side::counterclockwise ? 1 : -1;
    const Eigen::AngleAxisd half(sign * angleRound(side, P, Q) / 2, Vec3<double>::UnitZ());
    Vec3<double> hint = half * Vec3<double>(P.x(), P.y(), 0).normalized() * s.radius;
    hint.z() = std::clamp((P.z() + Q.z()) / 2, -s.halfLength, s.halfLength);
    return hint;
  }

  // How many members the chord cuts.
  int numCut(const Posture& posture) const {
    int cut = 0;
    for (std::size_t j = 0; j < size(); ++j) {
      const auto [P, Q] = endsSeen(j, posture);
      if (closestApproach(surface(j), P, Q) < 1) ++cut;
    }
    return cut;
  }

  static bool passesThroughNone(const ChainPath& taut, const PlacedChain& placed) {
    for (std::size_t j = 0; j < placed.count; ++j) {
      if (taut.passing[j] == Passing::endInside) continue;
      const ChainObject& object = placed.objects[j];
      for (std::size_t i = 0; i <= static_cast<std::size_t>(taut.numContacts); ++i) {
        const LowestPoint lowest =
            lowestOnSegment(object.surface, object.intoFrame(taut.pieces[i].from),
                            object.intoFrame(taut.pieces[i].to));
        if (lowest.height < -1e-6 * sizeOf(object.surface)) return false;
      }
    }
    return true;
  }

  // Arranges the members. Returns the posture in which that was decided.
  std::size_t order() {
    int most = 0;
    std::vector<std::size_t> deciding;
    for (std::size_t i = 0; i < postures_.size(); ++i) {
      const int cut = numCut(*postures_[i]);
      if (cut > most) {
        most = cut;
        deciding.clear();
      }
      if (cut == most && most > 0 && deciding.size() < numOrderPostures) deciding.push_back(i);
    }
    if (deciding.empty()) deciding.push_back(0);
    if (size() < 2) return deciding.front();
    std::array<std::size_t, maxChain> permutation;
    const auto last = permutation.begin() + chain_.count;
    std::iota(permutation.begin(), last, std::size_t{0});
    const auto members = chain_.members;
    auto best = members;
    int bestFound = -1;
    double bestLength = 0;
    do {
      for (std::size_t j = 0; j < size(); ++j) chain_.members[j] = members[permutation[j]];
      int found = 0;
      double length = 0;
      // where the order makes no difference, that of the file stays, whatever the rounding
      const auto isShorter = [&] {
        return length < bestLength - sameLength * static_cast<double>(found);
      };
      for (std::size_t d = 0; d < deciding.size(); ++d) {
        // no more of an order that can no longer be the best
        const int atMost = found + static_cast<int>(deciding.size() - d);
        if (atMost < bestFound || (atMost == bestFound && !isShorter())) break;
        const ChainPosture here = at(*postures_[deciding[d]]);
        const PlacedChain placed = placeChain(path_, chain_, here.X_GC);
        ChainMemory memory;
        const ChainPath taut = solveChain(here.P, here.Q, placed.all(), memory);
        if (taut.event == ChainEvent::notFound || !passesThroughNone(taut, placed)) continue;
        ++found;
        length += taut.length;
      }
      if (found > bestFound || (found == bestFound && isShorter())) {
        bestFound = found;
        bestLength = length;
        best = chain_.members;
      }
    } while (std::next_permutation(permutation.begin(), last));
    chain_.members = best;
    return deciding.front();
  }

  // A path in one posture, and where the search for it ended.
  struct Found {
    ChainPath taut;
    ChainMemory memory;
  };
  static Found search(const ChainPosture& here, const PlacedChain& placed,
                      const ChainMemory& from) {
    Found found;
    found.memory = from;
    found.taut = solveChain(here.P, here.Q, placed.all(), found.memory);
    return found;
  }

  // The ways in a posture as if it were the only one.
  Found decidedHere(const ChainPosture& here, PlacedChain placed) const {
    const Found first = search(here, placed, {});
    const bool holds = isFound(first) && passesThroughNone(first.taut, placed);
    for (std::size_t j = 0; j < placed.count; ++j) {
      ChainObject& object = placed.objects[j];
      const Vec3<double> P = object.intoFrame(here.P), Q = object.intoFrame(here.Q);
      if (isInside(object.surface, P) || isInside(object.surface, Q)) continue;
      object.hint = hintHere(j, object.surface, P, Q);
    }
    const Found second = search(here, placed, {});
    if (!isFound(second) || !passesThroughNone(second.taut, placed)) return first;
    return !holds || second.taut.length < first.taut.length ? second : first;
  }

  // On the named side of the chord, of "all" where the surface is nearest to it.
  Vec3<double> hintHere(std::size_t member, const Surface& shape, const Vec3<double>& P,
                        const Vec3<double>& Q) const {
    const WrapQuadrant quadrant = surface(member).quadrant;
    Vec3<double> side = directionOf(quadrant);
    if (quadrant == WrapQuadrant::all) {
      const Vec3<double> deepest = lowestOnSegment(shape, P, Q).point;
      side = std::visit([&](const auto& each) { return each.gradient(deepest); }, shape);
    }
    if (!(side.norm() > 0)) return chain_.members[member].hint;
    return hintTowards(shape, side, P, Q);
  }

  static bool isFound(const Found& found) { return found.taut.event != ChainEvent::notFound; }

  // Whether a path that was followed has not wound itself out of what its objects' quadrants mean:
  // the middle of each contact lies on the named side or not far beyond the object's middle.
  bool keepsItsSides(const Found& followed, const PlacedChain& placed) const {
    for (std::size_t i = 0; i < static_cast<std::size_t>(followed.taut.numContacts); ++i) {
      const ChainContact& contact = followed.taut.contacts[i];
      const auto j = static_cast<std::size_t>(contact.object);
      const ChainObject& object = placed.objects[j];
      const WrapQuadrant quadrant = surface(j).quadrant;
      if (std::holds_alternative<TorusSurface>(object.surface) || quadrant == WrapQuadrant::all) {
        continue;
      }
      const Vec3<double> middle =
          shootGeodesic(object.surface, object.intoFrame(contact.A),
                        object.R_GS.transpose() * contact.atA.u, contact.arc / 2)
              .x;
      const Vec3<double> side = directionOf(quadrant);
      if (side.dot(middle) < -mostBeyond * extentAlong(object.surface, side)) return false;
    }
    return followed.taut.isShortest;
  }

  Found decide(const ChainPosture& here, const ChainMemory* known) const {
    const PlacedChain placed = placeChain(path_, chain_, here.X_GC);
    if (known == nullptr) return decidedHere(here, placed);
    const Found followed = search(here, placed, *known);
    if (isFound(followed) && keepsItsSides(followed, placed)) return followed;
    const Found anew = decidedHere(here, placed);
    return isFound(anew) ? anew : followed;
  }

  // From the first posture to all others, each on from the nearest one known.
  void follow(std::size_t first) {
    const std::size_t n = postures_.size();
    std::vector<ChainPosture> here;
    std::vector<ChainEnds> ends;
    for (const Posture* posture : postures_) {
      here.push_back(at(*posture));
      ends.push_back(chainEnds(size(), here.back().X_GC, here.back().P, here.back().Q));
    }
    struct Followed {
      Found found = {};
      const ChainMemory* from = nullptr;  ///< of the nearest posture with a path
      double distance = std::numeric_limits<double>::infinity();  ///< to that posture
      bool isDone = false, isKept = false;
    };
    std::vector<Followed> followed(n);
    for (std::size_t count = 0, next = first; count < n; ++count) {
      Followed& now = followed[next];
      now.isDone = true;
      now.found = decide(here[next], now.from);
      now.isKept = isFound(now.found);
      ++result_.numPostures;
      if (!now.isKept) ++result_.numNotFound;
      noteInside(now.found.taut);
      double nearest = std::numeric_limits<double>::infinity();
      std::size_t following = n;
      for (std::size_t i = 0; i < n; ++i) {
        Followed& other = followed[i];
        if (other.isDone) continue;
        double d = 0;
        for (std::size_t k = 0; k < 6 * size(); ++k) {
          d += (ends[i][k] - ends[next][k]) * (ends[i][k] - ends[next][k]);
        }
        if (now.isKept && d < other.distance) {
          other.distance = d;
          other.from = &now.found.memory;
        }
        if (other.distance <= nearest) {
          nearest = other.distance;
          following = i;
        }
      }
      next = following;
    }
    if (result_.numNotFound == result_.numPostures) {
      throw UnsupportedWrap("no taut string is found over its wrap objects");
    }
    std::vector<ChainStarts::Known> kept;
    for (std::size_t i = 0; i < n; ++i) {
      if (!followed[i].isKept) continue;
      const Found& found = followed[i].found;
      kept.push_back({here[i].X_GC, here[i].P, here[i].Q, found.taut, found.memory});
    }
    chain_.starts = std::make_shared<const ChainStarts>(size(), chain_.inOneSegment, kept);
  }

  void noteInside(const ChainPath& taut) {
    for (std::size_t j = 0; j < size(); ++j) {
      if (taut.passing[j] != Passing::endInside) continue;
      const std::size_t inside = chain_.members[j].surface;
      auto& known = result_.endInside;
      if (std::find(known.begin(), known.end(), inside) == known.end()) known.push_back(inside);
    }
  }

  const CompiledPath& path_;
  const PathSpan& span_;
  std::vector<const Posture*> postures_;
  PathChain chain_;
  CompiledChain result_;
};

}  // namespace

CompiledChain compileChain(const CompiledPath& path, const PathSpan& span,
                           const std::vector<const Posture*>& postures) {
  return ChainCompiler(path, span, postures).compile();
}

}  // namespace bio
