#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "generator/hill_muscle.h"
#include "generator/wrapped_path.h"

namespace hidden {

/// A rigid body, in the posture elbow_flexion = 0; all body axes are the ground's there.
struct Body {
  std::string name;
  double mass = 0;                                    ///< [kg]
  Vec centre = Vec::Zero();                           ///< mass centre in the ground [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about it [kg m²]
};

/// A point of a path, in the ground at elbow_flexion = 0.
struct PathPoint {
  Vec place = Vec::Zero();
  bool onForearm = false;
  bool conditional = false;
  double from = 0, to = 0;  ///< where a conditional point is active [rad]
};

/// A muscle's path. One span crosses the elbow; `cylinder` is the one it may wrap, −1 for none.
/// Other spans are straight and keep their lengths.
struct Path {
  std::vector<PathPoint> points;
  int cylinder = -1;
};

struct Cylinders {
  std::vector<std::string> names;
  std::vector<Cylinder> shapes;
};

/// All that the true elbow is made of: one hinge, what turns about it, eight muscles and their
/// paths. The upper arm and all other joints are held at 0.
struct ElbowNumbers {
  Vec gravity = Vec::Zero();   ///< [m/s²]
  Vec hinge = Vec::Zero();     ///< a point of the axis in the ground [m]
  Vec axis = Vec::UnitZ();     ///< unit, flexion positive
  Vec shoulder = Vec::Zero();  ///< origin of the upper arm in the ground [m]
  std::vector<Body> forearm;   ///< every body beyond the elbow
  Vec hand = Vec::Zero();      ///< mass centre of the hand at 0 [m]
  std::vector<HillMuscle> muscles;
  std::vector<Path> paths;  ///< one per muscle
  Cylinders cylinders;
};

/// Reads the numbers out of an .osim document of the kind of models/elbow8.osim. Its own small
/// reader, for that kind alone: frames without turns, all coordinates at 0, cylinders only.
/// @throws std::runtime_error where the document is of another kind
ElbowNumbers readElbow(const std::filesystem::path& file);

/// The document with one muscle switched off (appliesForce = false).
/// @throws std::runtime_error where it cannot be read or has no such muscle
std::string withoutMuscle(const std::filesystem::path& file, const std::string& muscle);

}  // namespace hidden
