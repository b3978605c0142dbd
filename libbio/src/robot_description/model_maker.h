#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "bio/model/model.h"
#include "robot_description/description_xml.h"
#include "robot_description/rigid_parts.h"

/// What URDF and MJCF have in common on their way to a model.
namespace bio::robot {

/// A turn about, or a shift along, an axis of the moved body's frame.
struct Motion {
  bool turns = true;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();   ///< a unit vector
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  ///< a point of the axis, in the moved body [m]
  Coordinate coordinate;
  double zero = 0;  ///< where the coordinate displaces nothing [rad] or [m]
};

/// What acts at a coordinate; SI units.
struct JointForces {
  double damping = 0, friction = 0, stiffness = 0, rest = 0;
};

class ModelMaker {
 public:
  explicit ModelMaker(const Documents& documents) : documents_(documents) {}

  /// The name of an element as a model can have it: without '/', spaces, quotes and commas, which
  /// become '_' with a remark; "ground" gets an ending.
  std::string nameOf(const Element& element);
  std::string nameFrom(const Element& element, const std::string& name);
  /// FileError if there is a body or a coordinate of the name.
  void requireNewBody(const Element& element, const std::string& name);
  void requireNewCoordinate(const Element& element, const std::string& name);
  /// No new name will be this one.
  void reserve(const std::string& name) { reserved_.insert(name); }
  /// `wanted`, or with an ending that makes it new among bodies.
  std::string newBodyName(const std::string& wanted);
  std::string newCoordinateName(const std::string& wanted);

  void addBody(const std::string& name, const MassProperties& mass);
  /// Joins a body to its parent. Motions follow each other, each in the frame that those before it
  /// moved. Those that one joint of OpenSim cannot say get massless bodies between.
  /// @param X_PB the body's frame in the parent's, where all motions displace nothing
  /// @param name of the joint; empty: the coordinate's, or PARENT_to_BODY
  void join(const std::string& parent, const Transform& X_PB, const std::string& body,
            const std::vector<Motion>& motions, const std::string& name = {});
  /// Six coordinates NAME_rx … NAME_tz of a body in its parent's frame F: shifts along its axes,
  /// then turns about x, y, z. `start` is where the model's default posture has the body.
  void joinFree(const std::string& parent, const Transform& X_PF, const std::string& body,
                const std::string& name, const Transform& start);
  /// Damping, springs and dry friction; those that are 0 are left out.
  void addForces(const std::string& coordinate, const JointForces& forces);
  void addMotor(const Element& element, const std::string& wanted, const std::string& coordinate,
                double optimalForce);
  void addCoupler(const Element& element, const std::string& dependent,
                  const std::string& independent, const Function& function);

  /// One warning for each `what`, with the names: "not simulated: WHAT (a, b)".
  void isNotSimulated(const std::string& what, const std::string& name);

  Model& model() { return model_; }
  /// The model with its warnings, and the numbers of its parts in words.
  Model finished();

 private:
  struct Named {
    std::set<std::string> names;
    std::map<std::string, const Element*> elements;  ///< of those that the file names
  };
  void requireNew(const Element& element, const char* what, const std::string& name, Named& named);
  void joinGroup(const std::string& parent, const Transform& X_PB, const std::string& body,
                 const std::vector<Motion>& group, const std::string& name);
  std::string newForceName(const std::string& wanted);

  const Documents& documents_;
  Model model_;
  Named bodies_, coordinates_;
  std::set<std::string> joints_, forces_;
  std::set<std::string> coupled_, reserved_;
  std::vector<std::pair<std::string, std::vector<std::string>>> notSimulated_;
};

/// A coordinate of the name: an angle or a shift, as far as OpenSim's default range, ±10, from 0.
Coordinate coordinateCalled(const std::string& name, bool isRotation);

}  // namespace bio::robot
