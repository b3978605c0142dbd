#pragma once

#include <Eigen/Dense>
#include <string>
#include <string_view>
#include <vector>

#include "bio/model/model.h"
#include "opensim/xml.h"

/// The parts of the .osim writer; each appends one kind of element below `parent`.
namespace bio::osim {

/// OpenSim 3 nests joints in bodies; OpenSim 4 lists them and names frames by path.
enum class Format { opensim3, opensim4 };

struct Writing {
  const Model& model;
  Format format;
};

Element& append(Element& parent, const char* tag, std::string_view name = {});
void appendText(Element& parent, const char* tag, const std::string& text);
void appendFlag(Element& parent, const char* tag, bool value);
/// Each number as the shortest text that reads back as the same double.
void appendNumber(Element& parent, const char* tag, double value);
void appendNumbers(Element& parent, const char* tag, const std::vector<double>& values);
void appendNumbers(Element& parent, const char* tag, const Eigen::Vector3d& values);
/// Appends `<tag><objects/>…</tag>`, returns its `objects`.
Element& appendSet(const Writing& writing, Element& parent, const char* tag, std::string_view name);

/// `<Class name="name">…</Class>`; without a name if it is empty.
void appendFunction(Element& parent, const Function& function, std::string_view name);
void appendSpline(Element& parent, const SplineFunction& spline, std::string_view name);

void appendBody(const Writing& writing, Element& parent, const Body& body);
void appendWrapObjects(const Writing& writing, Element& body, const std::string& name);
void appendJoint(const Writing& writing, Element& parent, const Joint& joint);
void appendCoupler(const Writing& writing, Element& parent, const CoordinateCoupler& coupler);
void appendPath(const Writing& writing, Element& muscle, const Path& path);
void appendMuscle(const Writing& writing, Element& parent, const Muscle& muscle);
void appendCoordinateForces(const Writing& writing, Element& parent);
void appendBodyForces(const Writing& writing, Element& parent);
/// The element FisherHill; nothing where the model has none.
void appendFitted(const Writing& writing, Element& model);

/// "/bodyset/humerus" or "/ground"
std::string bodyPath(const std::string& body);
/// "/jointset/elbow/elbow_flexion"
std::string coordinatePath(const Model& model, const std::string& coordinate);

/// Fills an empty document with what the model says.
void buildDocument(tinyxml2::XMLDocument& document, const Model& model, Format format);

}  // namespace bio::osim
