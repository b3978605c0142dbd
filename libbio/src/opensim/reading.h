#pragma once

#include <Eigen/Dense>
#include <map>
#include <string>

#include "bio/model/model.h"
#include "opensim/xml.h"

/// The parts of the .osim reader; each reads one kind of element into Reading::model.
namespace bio::osim {

/// A frame of the file: fixed to a body ("ground" for the ground).
struct BodyFrame {
  std::string body;
  FramePlacement placement;  ///< in the body
};

/// A PhysicalOffsetFrame element and the absolute path of what holds it.
struct OffsetFrame {
  const Element* element;
  std::string ownerPath;
};

struct Reading {
  Source source;
  Model model;
  std::vector<OffsetFrame> offsetFrames;    ///< in the order of the file
  std::map<std::string, BodyFrame> frames;  ///< by absolute path, e.g. /bodyset/humerus
};

/// Placement of frame B in A's parent, B given in A. Exact where either is the identity.
FramePlacement compose(const FramePlacement& a, const FramePlacement& b);

// Functions

/// The function that is property `property` of the object: `<property><Class>…` or
/// `<Class name="property">…`; null if absent.
const Element* findFunction(const Element& object, const char* property);
/// Constant, LinearFunction, SimmSpline, NaturalCubicSpline (with a warning),
/// PiecewiseLinearFunction, PolynomialFunction, Sine, MultiplierFunction; FileError for other
/// classes.
Function readFunction(Reading& reading, const Element& function);
/// Whether it is of one of these classes.
bool isReadableFunction(const Element& function);
/// A SimmSpline's points; a knot that repeats the one before it is dropped with a remark.
SplineFunction readSpline(Reading& reading, const Element& function);

// Skeleton

void readBodies(Reading& reading, const Element& model);
/// Registers every offset frame: in bodies, joints, the ground, component sets and other frames.
void readFrames(Reading& reading, const Element& model);
/// The frame a socket names, relative to the object at `ownerPath` or absolute.
BodyFrame resolveFrame(const Reading& reading, const Element& owner, const std::string& ownerPath,
                       const char* socket);
void readJoints(Reading& reading, const Element& model);
void readConstraints(Reading& reading, const Element& model);

/// FileError unless the model has that coordinate. An OpenSim 4 path is cut to its last part.
std::string readCoordinateName(const Reading& reading, const Element& object, const char* property);

// Forces

void readWrapObjects(Reading& reading, const Element& model);
/// A GeometryPath or a FunctionBasedPath.
Path readPath(Reading& reading, const Element& force);
Path readFunctionPath(Reading& reading, const Element& force, const Element& path);
void readForces(Reading& reading, const Element& model);
/// PointToPointSpring, BushingForce, Ligament, PathSpring, Blankevoort1991Ligament,
/// PrescribedForce, CoordinateActuator; false for another class.
bool readBodyForce(Reading& reading, const Element& element, std::map<std::string, int>& names);
Muscle readMuscle(Reading& reading, const Element& element);

/// A marker whose body the model does not have is left out, with a remark.
void readMarkers(Reading& reading, const Element& model);

/// The element FisherHill.
void readFitted(Reading& reading, const Element& model);

/// False when `isDisabled` is true or `appliesForce` is false.
bool isEnabled(const Reading& reading, const Element& force);

/// FileError when `names` already holds the element's name; the message calls it a `kind`.
void requireNewName(const Reading& reading, const Element& element, const char* kind,
                    std::map<std::string, int>& names);

}  // namespace bio::osim
