#include "bio/analysis/opensim_paths.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "bio/model/units.h"
#include "bio/path/opensim_rule.h"
#include "bio/path/path_lengths.h"
#include "bio/path/posture_samples.h"
#include "path/coordinate_sweeps.h"

namespace bio {
namespace {

constexpr int openSimCells = 180;
constexpr double leastOpenSimJump = 1e-5;  // [m]
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// One muscle's length along the first coordinate, ours and by OpenSim's rule.
class BothLengths {
 public:
  BothLengths(const Skeleton& skeleton, const Muscle& muscle, const MusclePath& path)
      : skeleton_(skeleton), path_(path), taut_(skeleton), q_(skeleton.defaultValues()) {
    taut_.add(muscle, path);
  }

  struct At {
    double value, ours, slope, theirs, theirSlope;
    double difference() const { return theirs - ours; }
  };
  At at(double value) {
    q_[0] = value;
    taut_.moveTo(q_);
    const double length = theirs(value);
    try {
      const PathLengths::Along along = taut_.along(0);
      // where the lengths are the same their slopes hardly differ
      const bool isSame = std::abs(length - along.length) < 1e-7;
      return {value, along.length, along.slope, length,
              isSame ? along.slope : theirSlope(value, length)};
    } catch (const std::domain_error&) {  // no taut string
      return {value, nan, nan, length, theirSlope(value, length)};
    }
  }
  /// Change of OpenSim's length between two values beyond the trapezium of its slopes [m]; next to
  /// a jump, where it has none, of ours, or of none.
  static double surprise(const At& a, const At& b) {
    const auto slope = [](const At& x) {
      if (std::isfinite(x.theirSlope)) return x.theirSlope;
      return std::isfinite(x.slope) ? x.slope : 0.0;
    };
    return std::abs(b.theirs - a.theirs - (slope(a) + slope(b)) / 2 * (b.value - a.value));
  }

 private:
  double theirs(double value) const {
    std::vector<double> q(q_.begin(), q_.end());
    q[0] = value;
    return openSimLength(path_.compiled(), postureOf(skeleton_, q)).value_or(nan);
  }
  /// By differences; NaN at a jump or a corner.
  double theirSlope(double value, double length) const {
    constexpr double h = 1e-5, corner = 5e-3;  // [rad], [m/rad]
    const double ahead = (theirs(value + h) - length) / h;
    const double behind = (length - theirs(value - h)) / h;
    return std::abs(ahead - behind) < corner ? (ahead + behind) / 2 : nan;
  }

  const Skeleton& skeleton_;
  const MusclePath& path_;
  PathLengths taut_;
  Eigen::VectorXd q_;
};

/// Whether the model has an ellipsoid for the muscle's path: what can be seen without compiling it.
bool mayTouchEllipsoid(const Model& model, const Muscle& muscle) {
  const auto& wraps = muscle.path.wraps;
  return std::any_of(wraps.begin(), wraps.end(), [&](const PathWrap& wrap) {
    return findWrapObject(model, wrap.wrapObject).shape == WrapShape::ellipsoid;
  });
}

/// Names of a path's ellipsoids; empty if it has a torus, whose rule is not restated.
std::vector<std::string> ellipsoidsOf(const Muscle& muscle, const MusclePath& path) {
  std::set<std::string> names;
  for (const PathSurface& surface : path.compiled().surfaces) {
    if (!surface.general) continue;
    if (!std::holds_alternative<EllipsoidSurface>(*surface.general)) return {};
    names.insert(muscle.path.wraps[surface.wrap].wrapObject);
  }
  return {names.begin(), names.end()};
}

/// Keeps the largest differences.
void keepLarger(const BothLengths::At& here, OpenSimDifference& found) {
  if (std::abs(here.difference()) > std::abs(found.length)) {
    found.length = here.difference();
    found.lengthAt = here.value;
  }
  const double arm = here.slope - here.theirSlope;  // −∂ℓ/∂q
  if (std::abs(arm) > std::abs(found.arm)) {
    found.arm = arm;
    found.armAt = here.value;
  }
}

void addJump(BothLengths& lengths, BothLengths::At low, BothLengths::At high,
             OpenSimDifference& found) {
  while (high.value - low.value > 1e-7) {
    const auto middle = lengths.at(low.value + (high.value - low.value) / 2);
    const bool isBelow = BothLengths::surprise(low, middle) > BothLengths::surprise(middle, high);
    (isBelow ? high : low) = middle;
  }
  const double size = high.theirs - low.theirs;
  if (!(std::abs(size) >= leastOpenSimJump)) return;
  found.jumps.push_back({low.value, size});
  keepLarger(low, found);
  keepLarger(high, found);
}

void compareAlong(BothLengths& lengths, double from, double to, OpenSimDifference& found) {
  bool wasApart = false;
  BothLengths::At left{};
  for (int cell = 0; cell <= openSimCells; ++cell) {
    const auto here = lengths.at(from + (to - from) * cell / openSimCells);
    keepLarger(here, found);
    const bool isApart = std::abs(here.difference()) >= leastOpenSimDifference;
    if (isApart && wasApart) found.apart.back().to = here.value;
    if (isApart && !wasApart) found.apart.push_back({here.value, here.value});
    wasApart = isApart;
    if (cell > 0 && BothLengths::surprise(left, here) > 2 * leastOpenSimJump) {
      addJump(lengths, left, here, found);
    }
    left = here;
  }
}

double shown(double value, bool turns) {
  return value * positionUnit(turns).factor;
}

}  // namespace

std::vector<OpenSimDifference> openSimDifferences(const Model& model, const Skeleton& skeleton,
                                                  const std::vector<std::string>& wrapAsCylinder,
                                                  double from, double to) {
  std::vector<OpenSimDifference> differences;
  PostureSamples postures(model, skeleton);
  const Coordinate& coordinate = skeleton.coordinates().front();
  for (const Muscle& muscle : model.muscles) {
    if (!muscle.enabled || !mayTouchEllipsoid(model, muscle)) continue;
    try {
      const MusclePath path(model, skeleton, muscle, wrapAsCylinder, postures.of(muscle));
      OpenSimDifference found;
      found.ellipsoids = ellipsoidsOf(muscle, path);
      if (!path.moves() || found.ellipsoids.empty()) continue;
      found.muscle = muscle.name;
      found.coordinate = coordinate.name;
      found.turns = coordinate.isRotation;
      BothLengths lengths(skeleton, muscle, path);
      compareAlong(lengths, from, to, found);
      if (!found.apart.empty()) differences.push_back(std::move(found));
    } catch (const std::invalid_argument&) {  // no path to look at
    }
  }
  return differences;
}

std::vector<OpenSimDifference> openSimDifferences(const Model& model) {
  std::vector<OpenSimDifference> all;
  sweepCoordinates(model, 0, [&](const Skeleton& skeleton, double from, double to) {
    const auto found = openSimDifferences(model, skeleton, {}, from, to);
    all.insert(all.end(), found.begin(), found.end());
  });
  return all;
}

std::string describe(const OpenSimDifference& difference) {
  std::vector<std::string> ranges;
  for (const OpenSimDifference::Range& range : difference.apart) {
    const double from = shown(range.from, difference.turns), to = shown(range.to, difference.turns);
    ranges.push_back(from < to ? fmt::format("{:.3g} to {:.3g}", from, to)
                               : fmt::format("{:.3g}", from));
  }
  std::string text = fmt::format(
      "in OpenSim the path of {} over {} differs from the taut string by up to {:.3g} mm, its "
      "moment arm by up to {:.3g} mm, along {} ({:.3g} mm or more at {} {})",
      difference.muscle, fmt::join(difference.ellipsoids, ", "), 1000 * std::abs(difference.length),
      1000 * std::abs(difference.arm), difference.coordinate, 1000 * leastOpenSimDifference,
      fmt::join(ranges, ", "), difference.turns ? "deg" : "mm");
  if (difference.jumps.empty()) return text;
  double largest = 0;
  for (const auto& jump : difference.jumps) largest = std::max(largest, std::abs(jump.size));
  text += difference.jumps.size() == 1 ? fmt::format(", and jumps by {:.3g} mm", 1000 * largest)
                                       : fmt::format(", and jumps {} times, by up to {:.3g} mm",
                                                     difference.jumps.size(), 1000 * largest);
  return text;
}

}  // namespace bio
