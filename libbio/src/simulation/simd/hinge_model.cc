#include "simulation/simd/hinge_model.h"

#include <algorithm>

#include "bio/path/path_length.h"
#include "simulation/simd/lane_law.h"

namespace bio::lanes {
namespace {

using Motion = RigidMotion<double, 1>;
using End = detail::SpanEnd<double, 1>;
using Angle = Eigen::Matrix<double, 1, 1>;

/// From place and derivatives at q = 0.
Turning<Single> turningPoint(const End& end) {
  Turning<Single> point{};
  for (int i = 0; i < 3; ++i) {
    point.middle[i] = end.jet.value[i];
    if (end.fixed) continue;
    point.middle[i] += end.jet.second[0][i];
    point.along[i] = -end.jet.second[0][i];
    point.across[i] = end.jet.first[0][i];
  }
  return point;
}

class HingeCompiler {
 public:
  explicit HingeCompiler(const MusculoskeletalSystem& system)
      : system_(&system), moved_(system.skeleton().numSegments()) {}

  std::optional<HingeModel<Single>> compile() {
    const Skeleton& skeleton = system_->skeleton();
    if (skeleton.numCoordinates() != 1 || !skeleton.hasConstantInertia()) return {};
    if (!system_->bodyForces().empty() || !system_->elasticPaths().empty()) return {};
    skeleton.motions<double, 1>(zero_, moved_.data());
    if (moved_[1].first[0].R.isZero(0)) return {};  // a slider
    const InertiaJet<1> inertia = skeleton.inertia<1>(zero_, moved_.data());
    out_.mass = inertia.massMatrix(0, 0);
    out_.gravityCosine = -inertia.d2V(0, 0);
    out_.gravitySine = inertia.dV[0];
    out_.hasForces = !system_->coordinateForces().empty();
    out_.forces[0] = &system_->coordinateForces();
    for (const SystemMuscle& muscle : system_->muscles()) {
      if (!add(muscle)) return {};
    }
    return std::move(out_);
  }

 private:
  bool add(const SystemMuscle& given) {
    LaneMuscle<Single> muscle{};
    muscle.of[0] = &given.muscle;
    muscle.hasFibreState = given.muscle.hasFibreState();
    muscle.perFibre = given.muscle.perFibre();
    const CompiledPath& path = given.path.compiled();
    if (path.function) return false;
    muscle.firstCondition = static_cast<int>(out_.conditions.size());
    muscle.numConditions = static_cast<int>(path.conditions.size());
    muscle.firstVariant = static_cast<int>(out_.variants.size());
    for (const CompiledCondition& c : path.conditions) {
      if (c.source.freeIndex != 0 || !c.source.coupling.isIdentity()) return false;
      out_.conditions.push_back({c.lower - conditionMargin, c.upper + conditionMargin});
    }
    if (path.surfaces.size() > maxCylinders) return false;
    for (const PathVariant& variant : path.variants) {
      out_.variants.push_back({variant.fixedLength, static_cast<int>(out_.spans.size()),
                               static_cast<int>(variant.moving.size())});
      for (const PathSpan& span : variant.moving) {
        if (!add(path, span)) return false;
      }
    }
    out_.muscles.push_back(muscle);
    return true;
  }

  bool add(const CompiledPath& path, const PathSpan& span) {
    const PathNode& a = path.nodes[span.a];
    const PathNode& b = path.nodes[span.b];
    if (a.motion >= 0 || b.motion >= 0) return false;
    const End P = detail::spanEnd<double, 1>(path, a, a.p_S, zero_, moved_.data());
    const End Q = detail::spanEnd<double, 1>(path, b, b.p_S, zero_, moved_.data());
    const Turning<Single> from = turningPoint(P);
    const Turning<Single> to = turningPoint(Q);
    // |Q − P|²: what turns of the difference is as long in all directions of its plane
    LaneSpan<Single> line{};
    for (int i = 0; i < 3; ++i) {
      const double middle = to.middle[i] - from.middle[i];
      const double along = to.along[i] - from.along[i];
      const double across = to.across[i] - from.across[i];
      line.constant += middle * middle + (along * along + across * across) / 2;
      line.cosine += 2 * middle * along;
      line.sine += 2 * middle * across;
    }
    line.firstCylinder = static_cast<int>(out_.cylinders.size());
    line.numCylinders = static_cast<int>(span.surfaces.size());
    out_.spans.push_back(line);
    for (const SpanSurface& way : span.surfaces) {
      const PathSurface& surface = path.surfaces[way.surface];
      if (surface.isSphere) return false;
      const End p_CP = detail::seenFromSurface(surface, moved_.data(), P);
      const End p_CQ = detail::seenFromSurface(surface, moved_.data(), Q);
      out_.cylinders.push_back({static_cast<int>(way.surface),
                                {p_CP.fixed, p_CQ.fixed},
                                way.side == Side::counterclockwise ? 1.0 : -1.0,
                                surface.radius,
                                surface.halfLength,
                                way.slip.cosine,
                                way.slip.sine,
                                {turningPoint(p_CP), turningPoint(p_CQ)}});
    }
    return true;
  }

  const MusculoskeletalSystem* system_;
  const Angle zero_{0.0};
  std::vector<Motion> moved_;
  HingeModel<Single> out_;
};

// Every number of a list's element into a lane
// -----------------------------------------------------

template <class Of>
void put(LaneMuscle<Of>& to, int lane, const LaneMuscle<Single>& from) {
  to.of[lane] = from.of[0];
  to.perFibre[lane] = from.perFibre;
}

template <class Of>
void put(Condition<Of>& to, int lane, const Condition<Single>& from) {
  to.lower[lane] = from.lower;
  to.upper[lane] = from.upper;
}

template <class Of>
void put(Variant<Of>& to, int lane, const Variant<Single>& from) {
  to.fixedLength[lane] = from.fixedLength;
}

template <class Of>
void put(LaneSpan<Of>& to, int lane, const LaneSpan<Single>& from) {
  to.constant[lane] = from.constant;
  to.cosine[lane] = from.cosine;
  to.sine[lane] = from.sine;
}

template <class Of>
void put(Cylinder<Of>& to, int lane, const Cylinder<Single>& from) {
  to.side[lane] = from.side;
  to.radius[lane] = from.radius;
  to.halfLength[lane] = from.halfLength;
  to.slipCosine[lane] = from.slipCosine;
  to.slipSine[lane] = from.slipSine;
  for (int end = 0; end < 2; ++end) {
    for (int i = 0; i < 3; ++i) {
      to.ends[end].middle[i][lane] = from.ends[end].middle[i];
      to.ends[end].along[i][lane] = from.ends[end].along[i];
      to.ends[end].across[i][lane] = from.ends[end].across[i];
    }
  }
}

template <class A, class B>
void putAll(std::vector<A>& to, int lane, const std::vector<B>& from) {
  for (std::size_t i = 0; i < to.size(); ++i) put(to[i], lane, from[i]);
}

template <class A, class Same>
bool match(const std::vector<A>& a, const std::vector<A>& b, Same same) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

}  // namespace

std::optional<HingeModel<Single>> hingeModel(const MusculoskeletalSystem& system) {
  if (!system.prescribed().empty()) return {};
  return HingeCompiler(system).compile();
}

bool sameStructure(const HingeModel<Single>& a, const HingeModel<Single>& b) {
  return a.hasForces == b.hasForces && a.conditions.size() == b.conditions.size() &&
         match(a.muscles, b.muscles,
               [](const LaneMuscle<Single>& x, const LaneMuscle<Single>& y) {
                 return sameForm(*x.of[0], *y.of[0]) && x.numConditions == y.numConditions &&
                        x.firstVariant == y.firstVariant;
               }) &&
         match(a.variants, b.variants,
               [](const Variant<Single>& x, const Variant<Single>& y) {
                 return x.numSpans == y.numSpans;
               }) &&
         match(a.spans, b.spans,
               [](const LaneSpan<Single>& x, const LaneSpan<Single>& y) {
                 return x.numCylinders == y.numCylinders;
               }) &&
         match(a.cylinders, b.cylinders, [](const Cylinder<Single>& x, const Cylinder<Single>& y) {
           return x.surface == y.surface && x.fixed[0] == y.fixed[0] && x.fixed[1] == y.fixed[1];
         });
}

template <class Of>
HingeModel<Of> lanesFor(const HingeModel<Single>& system) {
  const typename Of::Number none{};
  HingeModel<Of> lanes;
  lanes.hasForces = system.hasForces;
  for (const LaneMuscle<Single>& m : system.muscles) {
    LaneMuscle<Of> muscle{};
    muscle.hasFibreState = m.hasFibreState;
    muscle.firstCondition = m.firstCondition;
    muscle.numConditions = m.numConditions;
    muscle.firstVariant = m.firstVariant;
    lanes.muscles.push_back(muscle);
  }
  lanes.conditions.resize(system.conditions.size());
  for (const Variant<Single>& v : system.variants) {
    lanes.variants.push_back({none, v.firstSpan, v.numSpans});
  }
  for (const LaneSpan<Single>& s : system.spans) {
    lanes.spans.push_back({none, none, none, s.firstCylinder, s.numCylinders});
  }
  for (const Cylinder<Single>& c : system.cylinders) {
    Cylinder<Of> cylinder{};
    cylinder.surface = c.surface;
    cylinder.fixed[0] = c.fixed[0];
    cylinder.fixed[1] = c.fixed[1];
    lanes.cylinders.push_back(cylinder);
  }
  return lanes;
}

template <class Of>
void setLane(HingeModel<Of>& lanes, int lane, const HingeModel<Single>& system) {
  putAll(lanes.muscles, lane, system.muscles);
  putAll(lanes.conditions, lane, system.conditions);
  putAll(lanes.variants, lane, system.variants);
  putAll(lanes.spans, lane, system.spans);
  putAll(lanes.cylinders, lane, system.cylinders);
  lanes.mass[lane] = system.mass;
  lanes.gravityCosine[lane] = system.gravityCosine;
  lanes.gravitySine[lane] = system.gravitySine;
  lanes.forces[lane] = system.forces[0];
}

template HingeModel<Lanes<4>> lanesFor(const HingeModel<Single>&);
template HingeModel<Lanes<8>> lanesFor(const HingeModel<Single>&);
template void setLane(HingeModel<Lanes<4>>&, int, const HingeModel<Single>&);
template void setLane(HingeModel<Lanes<8>>&, int, const HingeModel<Single>&);

}  // namespace bio::lanes
