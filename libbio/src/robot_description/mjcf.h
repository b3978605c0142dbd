#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "robot_description/model_maker.h"

/// The parts of the MJCF reader.
namespace bio::robot {

/// The attributes of <compiler>, <option> and <flag> that matter.
struct MjcfSettings {
  double angle = 0;  ///< [rad] of one unit of angles
  std::string eulerOrder = "xyz";
  bool limitsFromRanges = true;  ///< autolimits
  std::string inertiaFromGeoms = "auto";
  std::array<double, 2> inertiaGroups = {0, 5};
  double leastMass = 0, leastInertia = 0;  ///< [kg], [kg m²]
  double totalMass = -1;                   ///< [kg]; not positive: as it comes out
  bool balancesInertia = false;
  Eigen::Vector3d gravity = {0, 0, -9.81};  ///< [m/s²]
  std::set<std::string> disabled;           ///< flags
  bool has(const char* effect) const;       ///< false where it or all constraints are disabled
};

/// The classes of <default>, each with what it inherits.
class MjcfDefaults {
 public:
  explicit MjcfDefaults(const Documents& documents) : documents_(documents) {}
  void read(const Element& top);
  /// The element's own attribute, else that of its class (or `childClass`) and of those above it,
  /// from elements of one of the tags; null if there is none.
  const char* find(const Element& element, const std::string& childClass,
                   const std::vector<const char*>& tags, const char* attribute) const;
  void requireClass(const Element& element, const std::string& name) const;

 private:
  struct Class {
    std::string parent;  ///< empty: none
    std::vector<const Element*> elements;
  };
  void readClass(const Element& element, const std::string& name, const std::string& parent);

  const Documents& documents_;
  std::map<std::string, Class> classes_;
};

/// An element with the defaults that apply to it.
class MjcfElement {
 public:
  MjcfElement(const Documents& documents, const MjcfDefaults& defaults, const Element& element,
              std::string childClass, std::vector<const char*> tags)
      : documents_(documents),
        defaults_(defaults),
        element_(element),
        childClass_(std::move(childClass)),
        tags_(std::move(tags)) {}
  const Element& element() const { return element_; }
  bool has(const char* attribute) const { return find(attribute) != nullptr; }
  std::string text(const char* attribute, const char* fallback) const;
  double number(const char* attribute, Rule rule, double fallback) const;
  std::vector<double> numbers(const char* attribute) const;
  Eigen::Vector3d vector(const char* attribute, const Eigen::Vector3d& fallback) const;
  /// Place and turn: pos, and one of quat, axisangle, xyaxes, zaxis and euler.
  Transform placement(const MjcfSettings& settings) const;

 private:
  const char* find(const char* attribute) const {
    return defaults_.find(element_, childClass_, tags_, attribute);
  }
  Eigen::Matrix3d turn(const MjcfSettings& settings, const char* attribute) const;

  const Documents& documents_;
  const MjcfDefaults& defaults_;
  const Element& element_;
  std::string childClass_;
  std::vector<const char*> tags_;
};

struct MjcfJoint {
  std::string coordinate;  ///< empty: a ball or free joint
  double reference = 0;    ///< where the model's default posture has it
};

/// A body's children, out of all frames.
struct MjcfChild {
  const Element* element;
  Transform X;             ///< of the frame that it stands in
  std::string childClass;  ///< that applies to it
};

class MjcfReading {
 public:
  MjcfReading(const Documents& documents, const Element& root)
      : documents_(documents), root_(root), defaults_(documents), maker_(documents) {}
  Model run();

 private:
  // Settings
  void readSettings();
  void readCompiler(const Element& compiler);
  void readOption(const Element& option);

  // Bodies
  void reserveNames(const Element& owner);
  void readWorld(const Element& world);
  void collect(const Element& owner, const Transform& X, const std::string& childClass,
               std::vector<MjcfChild>& children) const;
  void readBody(const MjcfChild& child, const std::string& parent, bool moves);
  MassProperties massOf(const Element& body, const std::vector<MjcfChild>& parts, bool moves);
  MassProperties bounded(MassProperties mass) const;
  void scaleMasses();

  // Joints
  std::vector<Motion> readJoints(const Element& body, const std::string& bodyName,
                                 const std::vector<MjcfChild>& joints);
  void readHinge(const MjcfElement& joint, const std::string& name, bool turns,
                 std::vector<Motion>& motions);
  void readBall(const MjcfElement& joint, const std::string& name, std::vector<Motion>& motions);
  void warnOfUnscaled(const MjcfElement& joint, const std::string& name);
  std::string jointName(const Element& joint, const std::string& bodyName);

  // Geoms
  MassProperties massOfGeom(const MjcfElement& geom, const Element& body, const Transform& X) const;

  // What acts
  void readForces();
  void readActuator(const Element& actuator);
  void readEquality(const Element& equality);
  void warnOfContacts();
  MjcfElement with(const MjcfChild& child, std::vector<const char*> tags) const {
    return {documents_, defaults_, *child.element, child.childClass, std::move(tags)};
  }

  const Documents& documents_;
  const Element& root_;
  MjcfSettings settings_;
  MjcfDefaults defaults_;
  ModelMaker maker_;
  std::map<std::string, MjcfJoint> joints_;       ///< by name in the file
  std::size_t touching_ = 0, touchingMoves_ = 0;  ///< geoms that may touch
};

}  // namespace bio::robot
