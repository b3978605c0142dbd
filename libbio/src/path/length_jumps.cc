#include "bio/path/length_jumps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "bio/model/units.h"
#include "bio/path/path_lengths.h"
#include "bio/path/posture_samples.h"
#include "path/coordinate_sweeps.h"

namespace bio {
namespace {

constexpr int jumpCells = 720;
constexpr double leastJump = 1e-5;     // [m]
constexpr double suspectJump = 1e-6;   // a kink at lift-off is less than a tenth of it in a cell
constexpr double leastArmJump = 1e-3;  // [m/rad]

/// The length of one muscle along the first coordinate.
class LengthAlong {
 public:
  LengthAlong(const Skeleton& skeleton, const Muscle& muscle, const MusclePath& path)
      : path_(path),
        lengths_(skeleton),
        q_(skeleton.defaultValues()),
        rangeMin_(skeleton.coordinates().front().rangeMin),
        rangeMax_(skeleton.coordinates().front().rangeMax) {
    lengths_.add(muscle, path);
  }

  struct At {
    double value, length, slope;
  };
  /// NaN where the path cannot be computed.
  At at(double value) {
    q_[0] = value;
    lengths_.moveTo(q_);
    try {
      const PathLengths::Along along = lengths_.along(0);
      return {value, along.length, along.slope};
    } catch (const std::domain_error&) {
      constexpr double nan = std::numeric_limits<double>::quiet_NaN();
      return {value, nan, nan};
    }
  }

  /// Change of the length between two values beyond the trapezium of its slopes [m].
  static double surprise(const At& a, const At& b) {
    return std::abs(b.length - a.length - (a.slope + b.slope) / 2 * (b.value - a.value));
  }

  /// Adds the jumps between two values.
  void search(double from, double to, const LengthJump& named, std::vector<LengthJump>& jumps) {
    At left = at(from);
    for (int cell = 1; cell <= jumpCells; ++cell) {
      const At right = at(from + (to - from) * cell / jumpCells);
      if (surprise(left, right) > suspectJump) {
        narrow(left, right, named, jumps);
      } else if (std::abs(right.slope - left.slope) > leastArmJump / 2) {
        narrowArm(left, right, named, jumps);
      }
      left = right;
    }
  }

 private:
  // Into the half that surprises more, until nothing smooth is left between.
  void narrow(At low, At high, const LengthJump& named, std::vector<LengthJump>& jumps) {
    while (high.value - low.value > 1e-10) {
      const At middle = at(low.value + (high.value - low.value) / 2);
      (surprise(low, middle) > surprise(middle, high) ? high : low) = middle;
    }
    if (!(std::abs(high.length - low.length) >= leastJump)) {
      if (std::abs(high.slope - low.slope) >= leastArmJump) add(low, high, named, jumps);
      return;
    }
    add(low, high, named, jumps);
  }

  // The same for the slope alone.
  void narrowArm(At low, At high, const LengthJump& named, std::vector<LengthJump>& jumps) {
    while (high.value - low.value > 1e-10 && std::abs(high.slope - low.slope) >= leastArmJump / 2) {
      const At middle = at(low.value + (high.value - low.value) / 2);
      const bool isBelow = std::abs(middle.slope - low.slope) > std::abs(high.slope - middle.slope);
      (isBelow ? high : low) = middle;
    }
    if (std::abs(high.slope - low.slope) >= leastArmJump) add(low, high, named, jumps);
  }

  void add(const At& low, const At& high, const LengthJump& named, std::vector<LengthJump>& jumps) {
    LengthJump jump = named;
    jump.value = low.value + (high.value - low.value) / 2;
    jump.size = high.length - low.length;
    jump.arm = low.slope - high.slope;
    const bool isArmOnly = std::abs(jump.size) < leastJump;
    if (isArmOnly &&
        (std::abs(jump.value - rangeMin_) < 1e-6 || std::abs(jump.value - rangeMax_) < 1e-6)) {
      return;
    }
    for (const PathSwitch& s : path_.switches()) {
      jump.conditional = jump.conditional ||
                         (s.freeIndex == 0 && s.distance(low.value) * s.distance(high.value) <= 0);
    }
    jumps.push_back(jump);
  }

  const MusclePath& path_;
  PathLengths lengths_;
  Eigen::VectorXd q_;
  double rangeMin_, rangeMax_;
};

}  // namespace

std::vector<LengthJump> lengthJumps(const Model& model, const Skeleton& skeleton,
                                    const std::vector<std::string>& wrapAsCylinder, double from,
                                    double to) {
  std::vector<LengthJump> jumps;
  PostureSamples postures(model, skeleton);
  const Coordinate& coordinate = skeleton.coordinates().front();
  for (const Muscle& muscle : model.muscles) {
    if (!muscle.enabled) continue;
    try {
      const MusclePath path(model, skeleton, muscle, wrapAsCylinder, postures.of(muscle));
      if (!path.moves()) continue;
      LengthJump named;
      named.muscle = muscle.name;
      named.coordinate = coordinate.name;
      named.turns = coordinate.isRotation;
      LengthAlong(skeleton, muscle, path).search(from, to, named, jumps);
    } catch (const std::invalid_argument&) {  // no path to look at
    }
  }
  return jumps;
}

std::vector<LengthJump> lengthJumps(const Model& model, double beyond) {
  std::vector<LengthJump> all;
  sweepCoordinates(model, beyond, [&](const Skeleton& skeleton, double from, double to) {
    const auto found = lengthJumps(model, skeleton, {}, from, to);
    all.insert(all.end(), found.begin(), found.end());
  });
  return all;
}

std::string describe(const LengthJump& jump) {
  const double value = jump.turns ? jump.value * degreesPerRadian : jump.value;
  // a border of a condition is a little beyond its round value
  const double shown = std::abs(value) < 5e-3 ? 0 : value;
  const bool isArmOnly = std::abs(jump.size) < leastJump;
  std::string text = fmt::format("the {} of {} jumps by {:.3g} mm at {} = {:.4g} {} ({})",
                                 isArmOnly ? "moment arm" : "length", jump.muscle,
                                 1000 * std::abs(isArmOnly ? jump.arm : jump.size), jump.coordinate,
                                 shown, jump.turns ? "deg" : "m",
                                 jump.conditional ? "a conditional point"
                                 : isArmOnly      ? "a path point or its way round a wrap object"
                                                  : "its way round a wrap object");
  if (!isArmOnly && std::abs(jump.arm) >= leastArmJump) {
    text += fmt::format(" and its moment arm by {:.3g} mm", 1000 * std::abs(jump.arm));
  }
  return text;
}

}  // namespace bio
