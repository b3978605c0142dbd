#include "bio/path/opensim_difference.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <stdexcept>

#include "bio/path/posture_samples.h"
#include "path/path_reach.h"

namespace bio {
namespace {

constexpr int numSampled = 181;
constexpr double leastDifference = 1e-5, leastOpenSimJump = 1e-4;  // [m]

bool mayDiffer(const Model& model, const Muscle& muscle) {
  int objects = 0;
  bool isOdd = false;
  for (const PathWrap& wrap : muscle.path.wraps) {
    const WrapObject& object = findWrapObject(model, wrap.wrapObject);
    if (!object.active) continue;
    ++objects;
    isOdd = isOdd || object.shape == WrapShape::ellipsoid || object.shape == WrapShape::torus;
  }
  return isOdd || objects > 1;
}

/// OpenSim's length less ours along one coordinate.
class DifferenceAlong {
 public:
  DifferenceAlong(const Skeleton& skeleton, const MusclePath& path)
      : skeleton_(skeleton), path_(path) {
    const Eigen::VectorXd q = skeleton.defaultValues();
    q_.assign(q.begin(), q.end());
  }

  /// NaN where there is no taut string.
  double at(double value) {
    q_[0] = value;
    try {
      const OpenSimDifference d =
          openSimDifference(path_, postureOf(skeleton_, q_), ArcLength::exact);
      over_.insert(d.over.begin(), d.over.end());
      hasOthers_ = hasOthers_ || d.hasOthers;
      return d.length;
    } catch (const std::domain_error&) {
      return std::numeric_limits<double>::quiet_NaN();
    }
  }

  void sample(double from, double to, OpenSimDeparture& result) {
    const double step = (to - from) / (numSampled - 1);
    double before = std::numeric_limits<double>::quiet_NaN();
    for (int k = 0; k < numSampled; ++k) {
      const double q = from + k * step, d = at(q);
      if (std::abs(d) > std::abs(result.length)) {
        result.length = d;
        result.lengthAt = q;
      }
      if (std::isfinite(d)) compareArm(q, d, step / 8, result);
      if (std::abs(d - before) > leastOpenSimJump) findJump(q - step, before, q, d, result);
      before = d;
    }
  }

  const std::set<std::size_t>& over() const { return over_; }
  bool hasOthers() const { return hasOthers_; }

 private:
  void compareArm(double q, double d, double h, OpenSimDeparture& result) {
    const double forward = (at(q + h) - d) / h, backward = (d - at(q - h)) / h;
    const double slope = std::abs(forward) < std::abs(backward) ? forward : backward;
    if (!(std::abs(slope) > std::abs(result.arm))) return;
    result.arm = -slope;
    result.armAt = q;
  }

  // Into the half with the larger change, until only a jump is left.
  void findJump(double low, double atLow, double high, double atHigh, OpenSimDeparture& result) {
    for (int halving = 0; halving < 30 && std::abs(atHigh - atLow) > leastOpenSimJump; ++halving) {
      const double middle = (low + high) / 2, atMiddle = at(middle);
      if (std::abs(atMiddle - atLow) > std::abs(atHigh - atMiddle)) {
        high = middle;
        atHigh = atMiddle;
      } else {
        low = middle;
        atLow = atMiddle;
      }
    }
    if (!(std::abs(atHigh - atLow) > std::max(leastOpenSimJump, std::abs(result.jump)))) return;
    result.jump = atHigh - atLow;
    result.jumpAt = (low + high) / 2;
  }

  const Skeleton& skeleton_;
  const MusclePath& path_;
  std::vector<double> q_;
  std::set<std::size_t> over_;
  bool hasOthers_ = false;
};

}  // namespace

OpenSimDifference openSimDifference(const MusclePath& path, const Posture& posture,
                                    ArcLength measure) {
  OpenSimDifference difference;
  const CompiledPath& compiled = path.compiled();
  if (compiled.function) return difference;
  const PathVariant& variant =
      activeVariant(compiled, Eigen::Map<const Eigen::VectorXd>(
                                  posture.q.data(), static_cast<Eigen::Index>(posture.q.size())));
  unsigned used = 0, usedByOpenSim = 0;
  for (const PathSpan& span : variant.all) {
    if (span.chain < 0) continue;
    const PathChain& chain = compiled.chains[static_cast<std::size_t>(span.chain)];
    const Vec3<double> P = nodePosition(compiled, compiled.nodes[span.a], posture);
    const Vec3<double> Q = nodePosition(compiled, compiled.nodes[span.b], posture);
    const ChainPlacements X_GC = placementsIn(posture, compiled, chain);
    const PlacedChain placed = placeChain(compiled, chain, X_GC);
    const ChainPath taut = tautChain(compiled, chain, placed, X_GC, P, Q, used);
    if (taut.numContacts > 1) difference.hasOthers = true;
    if (taut.numContacts > 1 || chain.count > 1 + taut.numContacts) continue;
    const auto member =
        static_cast<std::size_t>(taut.numContacts == 1 ? taut.contacts[0].object : 0);
    const std::size_t index = chain.members[member].surface;
    const PathSurface& surface = compiled.surfaces[index];
    if (!surface.general || ((usedByOpenSim >> index) & 1u) != 0) continue;
    const auto* ellipsoid = std::get_if<EllipsoidSurface>(&*surface.general);
    if (!ellipsoid) {
      difference.hasOthers = difference.hasOthers || taut.numContacts == 1;
      continue;
    }
    const Vec3<double> p_CP = X_GC[member].R.transpose() * (P - X_GC[member].p);
    const Vec3<double> p_CQ = X_GC[member].R.transpose() * (Q - X_GC[member].p);
    const OpenSimSpan theirs =
        openSimEllipsoid(ellipsoid->semiAxes(), surface.quadrant, p_CP, p_CQ, measure);
    if (theirs.touches) usedByOpenSim |= 1u << index;
    if (!theirs.touches && taut.numContacts == 0) continue;
    const double ours = taut.numContacts == 0 ? (Q - P).norm() : taut.length;
    difference.length += theirs.length - ours;
    difference.over.push_back(surface.wrap);
  }
  return difference;
}

std::vector<OpenSimDeparture> openSimDepartures(const Model& model, const Skeleton& skeleton,
                                                const std::vector<std::string>& wrapAsCylinder,
                                                double from, double to) {
  std::vector<OpenSimDeparture> all;
  PostureSamples postures(model, skeleton);
  const Coordinate& coordinate = skeleton.coordinates().front();
  for (const Muscle& muscle : model.muscles) {
    if (!muscle.enabled || !mayDiffer(model, muscle)) continue;
    try {
      const MusclePath path(model, skeleton, muscle, wrapAsCylinder, postures.of(muscle));
      if (!path.moves()) continue;
      OpenSimDeparture one;
      one.muscle = muscle.name;
      one.coordinate = coordinate.name;
      one.turns = coordinate.isRotation;
      DifferenceAlong along(skeleton, path);
      along.sample(from, to, one);
      one.hasOthers = along.hasOthers();
      if (std::abs(one.length) < leastDifference && !one.hasOthers) continue;
      for (const std::size_t wrap : along.over()) {
        one.over.push_back(muscle.path.wraps[wrap].wrapObject);
      }
      all.push_back(std::move(one));
    } catch (const std::invalid_argument&) {  // no path to look at
    }
  }
  return all;
}

std::vector<OpenSimDeparture> openSimDepartures(const Model& model) {
  std::set<std::string> dependent;
  for (const auto& constraint : model.couplers) dependent.insert(constraint.dependent);
  std::vector<OpenSimDeparture> all;
  for (const Joint& joint : model.joints) {
    for (const Coordinate& c : joint.coordinates) {
      const double widest = c.isRotation ? 2 * std::numbers::pi : 2.0;
      const double range = c.rangeMax - c.rangeMin;
      if (c.locked || dependent.count(c.name) > 0 || !(range > 0 && range <= widest)) continue;
      try {
        const Skeleton skeleton(model, {.freeCoordinates = {c.name}, .lockedValues = {}});
        const auto found = openSimDepartures(model, skeleton, {}, c.rangeMin, c.rangeMax);
        all.insert(all.end(), found.begin(), found.end());
      } catch (const std::invalid_argument&) {  // nothing that could be simulated
      }
    }
  }
  return all;
}

std::string describe(const OpenSimDeparture& departure) {
  const auto where = [&](double at) {
    const double shown = departure.turns ? at * 180 / std::numbers::pi : at;
    return fmt::format("at {} = {:.4g} {}", departure.coordinate, shown + 0.0,
                       departure.turns ? "deg" : "m");
  };
  const auto size = [](double length) { return fmt::format("{:.2g} mm", 1000 * std::abs(length)); };
  std::string text;
  if (std::abs(departure.length) >= leastDifference) {
    text = fmt::format(
        "over {} OpenSim's path is a plane section: its length differs by up to {} ({}), the slope "
        "of its length by up to {} ({})",
        fmt::join(departure.over, ", "), size(departure.length), where(departure.lengthAt),
        size(departure.arm) + (departure.turns ? "/rad" : "/m"), where(departure.armAt));
    if (departure.jump != 0) {
      text += fmt::format("; OpenSim's length jumps by {} {}", size(departure.jump),
                          where(departure.jumpAt));
    }
  }
  if (departure.hasOthers) {
    text += text.empty() ? "" : "; ";
    text +=
        "OpenSim's path over several objects at once or a torus may differ, which is not computed";
  }
  return text;
}

}  // namespace bio
