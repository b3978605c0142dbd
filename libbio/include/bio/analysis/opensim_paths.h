#pragma once

#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/skeleton/skeleton.h"

namespace bio {

/// Where OpenSim's path of a muscle over ellipsoids differs from the taut string along one
/// coordinate, by OpenSim's rule restated (opensim_rule.h). Differences are OpenSim's less ours.
struct OpenSimDifference {
  std::string muscle, coordinate;
  bool turns = true;                    ///< the coordinate is an angle
  std::vector<std::string> ellipsoids;  ///< of the path
  double length = 0;                    ///< largest difference of the lengths [m]
  double lengthAt = 0;                  ///< value of the coordinate there [rad] or [m]
  double arm = 0;    ///< largest of the moment arms −∂ℓ/∂q [m/rad] or [1]
  double armAt = 0;  ///< value of the coordinate there [rad] or [m]
  struct Range {
    double from, to;
  };
  std::vector<Range> apart;  ///< where the lengths differ by leastOpenSimDifference or more
  struct Jump {
    double at, size;  ///< of the coordinate [rad] or [m]; of OpenSim's length [m]
  };
  std::vector<Jump> jumps;  ///< jumps of OpenSim's length by 1e-5 m or more
};

/// Least difference of two lengths that is reported [m].
inline constexpr double leastOpenSimDifference = 1e-4;

/// The muscles that a skeleton's first coordinate moves, the other free coordinates at their
/// defaults, whose lengths differ by leastOpenSimDifference or more somewhere in the range, in
/// steps of a 180th of it. Enabled muscles with an ellipsoid and no torus are compared; ellipsoids
/// in wrapAsCylinder are cylinders.
/// @param from, to  of the coordinate, rising [rad] or [m]
std::vector<OpenSimDifference> openSimDifferences(const Model& model, const Skeleton& skeleton,
                                                  const std::vector<std::string>& wrapAsCylinder,
                                                  double from, double to);

/// Differences along every coordinate that is not locked or coupled, one at a time, over its range;
/// a range of more than 2π rad or 2 m is reduced to that width about the default.
std::vector<OpenSimDifference> openSimDifferences(const Model& model);

/// "in OpenSim the path of TRIlong over TRIlonghh differs from the taut string by up to 5.04 mm, its
/// moment arm by up to 15.3 mm, along r_shoulder_elev (0.1 mm or more at 48 to 144 deg), and
/// jumps 4 times, by up to 5.04 mm"
std::string describe(const OpenSimDifference& difference);

}  // namespace bio
