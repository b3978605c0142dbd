#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bio/path/path.h"
#include "bio/path/surface/opensim_ellipsoid.h"

namespace bio {

/// How OpenSim's length of a path differs from ours in one posture.
struct OpenSimDifference {
  double length = 0;              ///< OpenSim's less ours [m], by openSimEllipsoid
  std::vector<std::size_t> over;  ///< of Path::wraps, the ellipsoids in question
  /// What the path touches there that is not restated: several objects on one span, a torus.
  bool hasOthers = false;
};

/// Span by span: a span over one ellipsoid is taken as OpenSim takes it, the first that an
/// ellipsoid cuts; all others as they are. Not restated are several objects on one span, tori, and
/// OpenSim's helices over cylinders (at most 0.4 mm in nine published models).
OpenSimDifference openSimDifference(const MusclePath& path, const Posture& posture,
                                    ArcLength measure);

/// How OpenSim's path of a muscle differs from ours over a range of one coordinate.
struct OpenSimDeparture {
  std::string muscle, coordinate;
  bool turns = true;                ///< the coordinate is an angle
  std::vector<std::string> over;    ///< ellipsoids
  double length = 0, lengthAt = 0;  ///< the largest difference [m] and where [rad] or [m]
  double arm = 0, armAt = 0;        ///< the same of −∂ℓ/∂q [m/rad]
  /// The largest jump of OpenSim's length where ours does not jump [m]; 0: none of 0.1 mm.
  double jump = 0, jumpAt = 0;
  bool hasOthers = false;  ///< several objects on one span, or a torus: not restated
};

/// For the enabled muscles over ellipsoids, tori or several objects that a skeleton's first
/// coordinate moves, in 181 postures with the other coordinates at their defaults; those that
/// differ by less than 10 µm everywhere and touch nothing else are left out. Lengths are those of
/// the plane sections, not of chords; slopes are differences, on the side without a jump.
/// @param from, to  of the coordinate, rising [rad] or [m]
std::vector<OpenSimDeparture> openSimDepartures(const Model& model, const Skeleton& skeleton,
                                                const std::vector<std::string>& wrapAsCylinder,
                                                double from, double to);

/// The same for every coordinate that is neither locked nor coupled over its range, one at a time.
/// Coordinates with a range of more than 2π rad or 2 m are left out.
std::vector<OpenSimDeparture> openSimDepartures(const Model& model);

/// "over hh OpenSim's path is a plane section: its length differs by up to 1.3 mm (at q = 60 deg),
/// its moment arm by up to 0.9 mm (at q = 75 deg)"
std::string describe(const OpenSimDeparture& departure);

}  // namespace bio
