#include "bio/path/tree_path.h"

#include <algorithm>
#include <set>

#include "bio/skeleton/tree_motion.h"
#include "path/tree_chain.h"

namespace bio {
namespace {

/// Makes slots of coordinates.
void renumberSlots(std::vector<int>& slots, const std::vector<int>& support) {
  for (int& slot : slots) {
    const auto at = std::lower_bound(support.begin(), support.end(), slot);
    slot = static_cast<int>(at - support.begin());
  }
}

/// A straight span, as one of point_path.h.
void addStraight(const TreePath::Piece& piece, const TreeMotion<double>& motion,
                 const Vec3<double>& a, const Vec3<double>& b, SupportedLength<double>& out) {
  const Vec3<double> apart = b - a;
  const double length = apart.norm();
  out.length += length;
  const auto& steps = piece.chain.steps();
  if (steps.empty()) return;
  const double perLength = 1 / length;
  const Vec3<double> t = apart * perLength;
  chainMoves(piece.chain, motion, b, out.moves.data());
  Vec3<double>* u = out.slotMoves.data();
  for (const int slot : piece.slots) u[slot].setZero();
  for (std::size_t j = 0; j < steps.size(); ++j) u[steps[j].slot] += out.moves[j];
  for (const int i : piece.slots) {
    const double along = t.dot(u[i]);
    out.first[i] += along;
    u[i] -= t * along;  // what is left lies across the span
  }
  for (const int i : piece.slots) {
    for (const int j : piece.slots) out.second(i, j) += u[i].dot(u[j]) * perLength;
  }
  addSecondsAlong(piece.chain, motion, b, out.moves.data(), t, out.second);
}

/// @param chainOf  makes the chain from one segment of the tree to another
template <class ChainOf>
TreePath::OverChain overChainOf(const CompiledPath& path, const PathSpan& span,
                                const TreePlaces& places, const Station& from, const Station& to,
                                const ChainOf& chainOf) {
  const PathChain& chain = path.chains[static_cast<std::size_t>(span.chain)];
  const std::size_t first = path.surfaces[chain.members[0].surface].segment;
  const int carrier = places.segmentOf(first);
  TreePath::OverChain over{static_cast<std::size_t>(span.chain),
                           carrier,
                           places.offsetOf(first),
                           {},
                           chainOf(carrier, from.segment),
                           chainOf(carrier, to.segment)};
  for (std::size_t j = 0; j < static_cast<std::size_t>(chain.count); ++j) {
    const PathSurface& surface = path.surfaces[chain.members[j].surface];
    const int segment = places.segmentOf(surface.segment);
    over.members.push_back(
        {segment, places.offsetOf(surface.segment) * surface.X_SC, chainOf(carrier, segment)});
  }
  return over;
}

}  // namespace

double LengthJet<Eigen::Dynamic, double>::secondIn(int i, int j) const {
  const auto slotOfCoordinate = [&](int k) {
    const auto at = std::lower_bound(support.begin(), support.end(), k);
    return at != support.end() && *at == k ? static_cast<Eigen::Index>(at - support.begin()) : -1;
  };
  const Eigen::Index a = slotOfCoordinate(i), b = slotOfCoordinate(j);
  return a < 0 || b < 0 ? 0 : second(a, b);
}

TreePlaces::TreePlaces(const Skeleton& skeleton) {
  const ArticulatedTree& tree = *skeleton.tree();
  for (const Segment& segment : skeleton.segments()) {
    const BodyPlacement& inTree = tree.placeOf(segment.name);
    const BodyPlacement& inSkeleton = skeleton.placeOf(segment.name);
    places_.push_back({static_cast<int>(inTree.segment), inTree.X_SB * inverse(inSkeleton.X_SB)});
  }
}

Station TreePlaces::station(std::size_t segment, const Vec3<double>& p_S) const {
  const Place& place = places_[segment];
  return {place.segment, place.X_TS.R * p_S + place.X_TS.p};
}

TreePath::TreePath(ArticulatedTree& tree, const Skeleton& skeleton, const Muscle& muscle,
                   const CompiledPath& path) {
  const TreePlaces places(skeleton);
  std::vector<Station> stations;
  for (const PathNode& node : path.nodes) {
    if (node.motion < 0) {
      stations.push_back(places.station(node.segment, node.p_S));
      continue;
    }
    const PathPoint& point = muscle.path.points[node.point];
    stations.push_back({tree.addMovingPoint(point.body, *point.motion), Vec3<double>::Zero()});
  }
  std::set<int> support;
  const auto chainOf = [&](int from, int to) -> SegmentChain {
    SegmentChain chain(tree, from, to);
    support.insert(chain.support().begin(), chain.support().end());
    return chain;
  };
  for (const PathVariant& variant : path.variants) {
    std::vector<Piece> pieces;
    for (const PathSpan& span : variant.moving) {
      const Station &from = stations[span.a], &to = stations[span.b];
      SegmentChain chain = chainOf(from.segment, to.segment);
      Piece piece{span.a, span.b, from, to, chain, chain.support(), {}, {}};
      if (span.chain >= 0) piece.overChain = overChainOf(path, span, places, from, to, chainOf);
      for (const SpanSurface& way : span.surfaces) {
        const PathSurface& surface = path.surfaces[way.surface];
        const int segment = places.segmentOf(surface.segment);
        piece.surfaces.push_back({way, segment, places.offsetOf(surface.segment) * surface.X_SC,
                                  chainOf(segment, from.segment), chainOf(segment, to.segment)});
      }
      pieces.push_back(std::move(piece));
    }
    variants_.push_back(std::move(pieces));
  }
  if (path.function)
    support.insert(path.function->support().begin(), path.function->support().end());
  support_.assign(support.begin(), support.end());
  for (auto& pieces : variants_) {
    for (Piece& piece : pieces) {
      renumberSlots(piece.slots, support_);
      piece.chain.renumber(support_);
      for (OverSurface& over : piece.surfaces) {
        over.toP.renumber(support_);
        over.toQ.renumber(support_);
      }
      if (!piece.overChain) continue;
      piece.overChain->toP.renumber(support_);
      piece.overChain->toQ.renumber(support_);
      for (auto& member : piece.overChain->members) member.chain.renumber(support_);
    }
  }
}

SupportedLength<double> TreePath::newWork() const {
  SupportedLength<double> work;
  const auto k = static_cast<Eigen::Index>(support_.size());
  work.first.setZero(k);
  work.second.setZero(k, k);
  std::size_t steps = 0, moving = 2;
  for (const auto& pieces : variants_) {
    for (const Piece& piece : pieces) {
      steps = std::max(steps, piece.chain.steps().size());
      if (const auto& over = piece.overChain) {
        moving = std::max(moving, 2 + 2 * over->members.size());
        steps = std::max(steps, over->toP.steps().size() + over->toQ.steps().size());
        for (const auto& member : over->members) {
          steps = std::max(steps, member.chain.steps().size());
        }
      }
      for (const OverSurface& over : piece.surfaces) {
        steps = std::max(steps, over.toP.steps().size() + over.toQ.steps().size());
      }
    }
  }
  work.moves.resize(steps);
  work.slotMoves.resize(moving * support_.size());
  return work;
}

LengthJet<Eigen::Dynamic> TreePath::newLength(int numCoordinates) const {
  const auto k = static_cast<Eigen::Index>(support_.size());
  return {0, Eigen::VectorXd::Zero(numCoordinates), support_, Eigen::MatrixXd::Zero(k, k), false};
}

detail::SpanOverSurface detail::spanOverSurface(const CompiledPath& path,
                                                const TreePath::Piece& piece,
                                                const TreeMotion<double>& motion,
                                                const Vec3<double>& p_GP, const Vec3<double>& p_GQ,
                                                unsigned& used) {
  SpanOverSurface found;
  for (const TreePath::OverSurface& over : piece.surfaces) {
    const unsigned bit = 1u << over.way.surface;
    if ((used & bit) != 0) continue;
    const PathSurface& surface = path.surfaces[over.way.surface];
    found.X_GC = motion.segments[static_cast<std::size_t>(over.segment)] * over.X_SC;
    found.p_CP = found.X_GC.R.transpose() * (p_GP - found.X_GC.p);
    found.p_CQ = found.X_GC.R.transpose() * (p_GQ - found.X_GC.p);
    if (surfaceIsOutOfPlay(surface, surface.radius, over.way, found.p_CP, found.p_CQ)) continue;
    found.span =
        surface.isSphere
            ? wrapSphereToSecondOrder(surface.radius, over.way.way, found.p_CP, found.p_CQ)
            : wrapCylinderToSecondOrder(surface.radius, over.way.side, found.p_CP, found.p_CQ);
    if (!found.span.span.touches) continue;
    used |= bit;
    found.over = &over;
    return found;
  }
  return found;
}

void TreePath::evaluate(const CompiledPath& path, const Eigen::VectorXd& q,
                        const Eigen::VectorXd& conditionsAt, const TreeMotion<double>& motion,
                        SupportedLength<double>& work, LengthJet<Eigen::Dynamic>& out) const {
  if (path.function) {
    const LengthFunction::Value at = path.function->at(q.data());
    out.length = at.length;
    out.wrapped = false;
    for (std::size_t i = 0; i < support_.size(); ++i) {
      out.dL_dq[support_[i]] = at.first[i];
      for (std::size_t j = 0; j < support_.size(); ++j) {
        out.second(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = at.second[i][j];
      }
    }
    return;
  }
  const PathVariant& variant = activeVariant(path, conditionsAt);
  const auto index = static_cast<std::size_t>(&variant - path.variants.data());
  work.length = variant.fixedLength;
  work.first.setZero();
  work.second.setZero();
  out.wrapped = false;
  unsigned used = 0;
  for (const Piece& piece : variants_[index]) {
    const Vec3<double> P = stationInGround(motion, piece.from);
    const Vec3<double> Q = stationInGround(motion, piece.to);
    if (piece.overChain) {
      if (addTreeChain(path, *piece.overChain, motion, P, Q, used, work)) {
        out.wrapped = true;
      } else {
        addStraight(piece, motion, P, Q, work);
      }
      continue;
    }
    const detail::SpanOverSurface s = detail::spanOverSurface(path, piece, motion, P, Q, used);
    if (s.over) {
      addSpan(s.span, s.X_GC, s.over->toP, P, s.over->toQ, Q, motion, work);
      out.wrapped = true;
    } else {
      addStraight(piece, motion, P, Q, work);
    }
  }
  out.length = work.length;
  out.second = work.second;
  for (std::size_t i = 0; i < support_.size(); ++i) {
    out.dL_dq[support_[i]] = work.first[static_cast<Eigen::Index>(i)];
  }
}

void TreePaths::add(const Muscle& muscle, const MusclePath& path) {
  compiled_.push_back(&path);
  paths_.emplace_back(tree_, *skeleton_, muscle, path.compiled());
  work_.push_back(paths_.back().newWork());
  lengths_.push_back(paths_.back().newLength(tree_.numCoordinates()));
  motion_.reset();
}

void TreePaths::moveTo(const Eigen::VectorXd& q) {
  if (!motion_) motion_ = tree_.newMotion<double>();
  q_ = q;
  tree_.place(q.data(), *motion_);
}

const LengthJet<Eigen::Dynamic>& TreePaths::length(std::size_t index) {
  paths_[index].evaluate(compiled_[index]->compiled(), q_, q_, *motion_, work_[index],
                         lengths_[index]);
  return lengths_[index];
}

}  // namespace bio
