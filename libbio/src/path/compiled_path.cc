#include "bio/path/compiled_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "path/chain_compiler.h"
#include "path/path_reach.h"
#include "path/span_surfaces.h"
#include "path/surface/wrap_candidate.h"

namespace bio {
namespace {

constexpr std::size_t maxConditions = 6;

class Compiler {
 public:
  Compiler(const Model& model, const Skeleton& skeleton, const Muscle& muscle,
           const std::vector<std::string>& wrapAsCylinder, const std::vector<Posture>& postures)
      : model_(model),
        skeleton_(skeleton),
        muscle_(muscle),
        wrapAsCylinder_(wrapAsCylinder),
        postures_(postures) {}

  CompiledPath compile() {
    if (muscle_.path.function) {
      path_.function.emplace(*muscle_.path.function, skeleton_);
      path_.variants.emplace_back();
      return std::move(path_);
    }
    for (std::size_t i = 0; i < muscle_.path.points.size(); ++i) addNode(i);
    for (std::size_t i = 0; i < muscle_.path.wraps.size(); ++i) addWrap(i);
    const std::size_t numVariants = std::size_t{1} << path_.conditions.size();
    for (std::size_t bits = 0; bits < numVariants; ++bits) addVariant(bits);
    for (const CandidateWrap& wrap : wraps_) noteUnreached(wrap);
    return std::move(path_);
  }

 private:
  // A note once, however many variants it holds for.
  void note(const std::string& text) {
    const std::string line = fmt::format("{}: {}", muscle_.name, text);
    if (std::find(path_.notes.begin(), path_.notes.end(), line) == path_.notes.end()) {
      path_.notes.push_back(line);
    }
  }

  void addNode(std::size_t index) {
    const PathPoint& point = muscle_.path.points[index];
    const BodyPlacement& place = skeleton_.placeOf(point.body);
    PathNode node;
    node.point = index;
    node.segment = place.segment;
    node.X_SB = place.X_SB;
    Vec3<double> location = point.location;
    if (point.motion) {
      CompiledPointMotion motion;
      bool isFixed = true;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::string& coordinate = point.motion->coordinate[i];
        if (!coordinate.empty()) motion.source[i] = skeleton_.sourceOf(coordinate);
        motion.location.emplace_back(point.motion->location[i]);
        isFixed = isFixed && motion.source[i].freeIndex < 0;
        location[static_cast<Eigen::Index>(i)] =
            motion.location[i].evaluate(motion.source[i].value).value;
      }
      if (!isFixed) {
        node.motion = static_cast<int>(path_.motions.size());
        path_.motions.push_back(std::move(motion));
      }
    }
    node.p_S = place.X_SB.R * location + place.X_SB.p;
    if (point.condition) {
      const CompiledCondition condition{skeleton_.sourceOf(point.condition->coordinate),
                                        point.condition->lower, point.condition->upper};
      if (condition.source.freeIndex < 0) {
        if (!isActive(condition, condition.source.value)) return;
      } else {
        node.condition = conditionIndex(*point.condition, condition);
      }
    }
    path_.nodes.push_back(std::move(node));
  }

  int conditionIndex(const PointCondition& given, const CompiledCondition& condition) {
    for (std::size_t i = 0; i < conditionKeys_.size(); ++i) {
      const PointCondition& known = conditionKeys_[i];
      if (known.coordinate == given.coordinate && known.lower == given.lower &&
          known.upper == given.upper) {
        return static_cast<int>(i);
      }
    }
    if (conditionKeys_.size() == maxConditions) {
      throw std::invalid_argument(
          fmt::format("muscle '{}' has more than {} different conditions on its points",
                      muscle_.name, maxConditions));
    }
    conditionKeys_.push_back(given);
    path_.conditions.push_back(condition);
    return static_cast<int>(conditionKeys_.size()) - 1;
  }

  void addWrap(std::size_t index) {
    const PathWrap& wrap = muscle_.path.wraps[index];
    const WrapObject& object = findWrapObject(model_, wrap.wrapObject);
    if (!object.active) return;
    const int numPoints = static_cast<int>(muscle_.path.points.size());
    const int first = wrap.firstPoint < 1 ? 1 : wrap.firstPoint;
    const int last = wrap.lastPoint < 1 ? numPoints : std::min(wrap.lastPoint, numPoints);
    if (first >= last) return;
    CandidateWrap candidate =
        candidateWrap(object, skeleton_.placeOf(object.body), index, wrapAsCylinder_);
    candidate.firstPoint = static_cast<std::size_t>(first - 1);
    candidate.lastPoint = static_cast<std::size_t>(last - 1);
    candidate.surface = path_.surfaces.size();
    path_.surfaces.push_back(candidate.shape);
    if (path_.surfaces.size() > 32) {
      throw std::invalid_argument(
          fmt::format("muscle '{}' has more than 32 wrap objects", muscle_.name));
    }
    wraps_.push_back(std::move(candidate));
  }

  // The path with the conditional points whose bits are set.
  void addVariant(std::size_t bits) {
    PathVariant variant;
    std::vector<std::size_t> active;
    for (std::size_t i = 0; i < path_.nodes.size(); ++i) {
      const int condition = path_.nodes[i].condition;
      if (condition < 0 || ((bits >> condition) & 1) != 0) active.push_back(i);
    }
    if (active.size() < 2) {
      throw std::invalid_argument(
          fmt::format("muscle '{}' has {} active points in some posture, must have at least 2",
                      muscle_.name, active.size()));
    }
    for (std::size_t i = 0; i + 1 < active.size(); ++i) {
      PathSpan span{active[i], active[i + 1], false, {}};
      const PathNode& a = path_.nodes[span.a];
      const PathNode& b = path_.nodes[span.b];
      span.moves = a.segment != b.segment || a.motion >= 0 || b.motion >= 0;
      variant.all.push_back(span);
    }
    for (const CandidateWrap& wrap : wraps_) surfaces_.assign(wrap, variant, bits);
    for (PathSpan& span : variant.all) chainUp(span, bits);
    // the spans that stay: their length, once and for all
    const Posture& posture = postures_.front();
    for (const PathSpan& span : variant.all) {
      if (span.moves) {
        variant.moving.push_back(span);
      } else {
        variant.fixedLength += fixedLength(span, posture);
      }
    }
    path_.variants.push_back(std::move(variant));
  }

  std::string pointName(std::size_t node) const {
    return muscle_.path.points[path_.nodes[node].point].name;
  }

  // Surfaces without a closed form, and those that a span touches at once, are solved together.
  void chainUp(PathSpan& span, std::size_t bits) {
    const bool isGeneral = std::any_of(
        span.surfaces.begin(), span.surfaces.end(),
        [&](const SpanSurface& way) { return path_.surfaces[way.surface].general.has_value(); });
    if (!isGeneral && !surfaces_.touchesSeveral(span, bits)) return;
    std::vector<const Posture*> occurring;
    for (const Posture& posture : postures_) {
      if (surfaces_.occurs(bits, posture)) occurring.push_back(&posture);
    }
    if (!span.moves || occurring.empty()) occurring = {&postures_.front()};
    try {
      CompiledChain compiled = compileChain(path_, span, occurring);
      tellOfChain(span, compiled);
      span.chain = static_cast<int>(path_.chains.size());
      path_.chains.push_back(std::move(compiled.chain));
    } catch (const UnsupportedWrap& e) {
      throw UnsupportedWrap(fmt::format("muscle '{}', between its points '{}' and '{}': {}",
                                        muscle_.name, pointName(span.a), pointName(span.b),
                                        e.what()));
    }
  }

  void noteUnreached(const CandidateWrap& wrap) {
    if (!wrap.shape.general) return;
    for (const PathVariant& variant : path_.variants) {
      for (const PathSpan& span : variant.all) {
        for (const SpanSurface& way : span.surfaces) {
          if (way.surface == wrap.surface) return;
        }
      }
    }
    const bool isTorus = std::holds_alternative<TorusSurface>(*wrap.shape.general);
    note(fmt::format("the {} '{}' is ignored: no span reaches it", isTorus ? "torus" : "ellipsoid",
                     wrap.name));
  }

  void tellOfChain(const PathSpan& span, const CompiledChain& compiled) {
    const std::string where =
        fmt::format("between its points '{}' and '{}'", pointName(span.a), pointName(span.b));
    for (const std::size_t surface : compiled.endInside) {
      note(
          fmt::format("{} an end lies inside the wrap object '{}' in some posture, in which the "
                      "object is passed by",
                      where, muscle_.path.wraps[path_.surfaces[surface].wrap].wrapObject));
    }
    if (compiled.numNotFound == 0) return;
    path_.warnings.push_back(fmt::format("muscle '{}' has no taut string {} in {} of {} postures",
                                         muscle_.name, where, compiled.numNotFound,
                                         compiled.numPostures));
  }

  double fixedLength(const PathSpan& span, const Posture& posture) const {
    const Vec3<double> P = nodePosition(path_, path_.nodes[span.a], posture);
    const Vec3<double> Q = nodePosition(path_, path_.nodes[span.b], posture);
    if (span.surfaces.empty()) return (Q - P).norm();
    if (span.chain >= 0) {
      const PathChain& chain = path_.chains[static_cast<std::size_t>(span.chain)];
      const auto place = [&](const Vec3<double>& p_G) {
        return seenFrom(posture, path_.nodes[span.a].segment, {}, p_G);
      };
      unsigned used = 0;
      return spanOver(path_, chain, place(P), place(Q), used).span.length;
    }
    const SpanSurface& way = span.surfaces.front();
    const PathSurface& surface = path_.surfaces[way.surface];
    const Vec3<double> p_CP = seenFrom(posture, surface.segment, surface.X_SC, P);
    const Vec3<double> p_CQ = seenFrom(posture, surface.segment, surface.X_SC, Q);
    if (surfaceIsOutOfPlay(surface, surface.radius, way, p_CP, p_CQ)) return (Q - P).norm();
    return surface.isSphere ? wrapSphere(surface.radius, way.way, p_CP, p_CQ).length
                            : wrapCylinder(surface.radius, way.side, p_CP, p_CQ).length;
  }

  const Model& model_;
  const Skeleton& skeleton_;
  const Muscle& muscle_;
  const std::vector<std::string>& wrapAsCylinder_;
  const std::vector<Posture>& postures_;
  std::vector<PointCondition> conditionKeys_;
  std::vector<CandidateWrap> wraps_;
  CompiledPath path_;
  SpanSurfaces surfaces_{path_, postures_};
};

}  // namespace

std::vector<std::string> adviceOnCylinders(const std::vector<std::string>& wrapAsCylinder) {
  std::vector<std::string> advice;
  for (const std::string& name : wrapAsCylinder) {
    advice.push_back(fmt::format(
        "wrap object '{}' is taken for a cylinder, as asked; without --wrap-as-cylinder "
        "its paths are exact taut strings over the ellipsoid",
        name));
  }
  return advice;
}

CompiledPath compilePath(const Model& model, const Skeleton& skeleton, const Muscle& muscle,
                         const std::vector<std::string>& wrapAsCylinder,
                         const std::vector<Posture>& postures) {
  for (const std::string& name : wrapAsCylinder) findWrapObject(model, name);
  return Compiler(model, skeleton, muscle, wrapAsCylinder, postures).compile();
}

}  // namespace bio
