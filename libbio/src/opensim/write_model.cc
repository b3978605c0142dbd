#include "opensim/writing.h"

namespace bio::osim {

namespace {

void appendMarkers(const Writing& writing, Element& top) {
  if (writing.model.markers.empty()) return;
  const bool is4 = writing.format == Format::opensim4;
  Element& markers = appendSet(writing, top, "MarkerSet", "markerset");
  for (const Marker& marker : writing.model.markers) {
    Element& element = append(markers, "Marker", marker.name);
    if (is4) {
      appendText(element, "socket_parent_frame", bodyPath(marker.body));
    } else {
      appendText(element, "body", marker.body);
    }
    appendNumbers(element, "location", marker.location);
  }
}

}  // namespace

void buildDocument(tinyxml2::XMLDocument& document, const Model& model, Format format) {
  const Writing writing{model, format};
  const bool is4 = format == Format::opensim4;
  document.InsertEndChild(document.NewDeclaration());
  Element* root = document.NewElement("OpenSimDocument");
  document.InsertEndChild(root);
  root->SetAttribute("Version", is4 ? "40000" : "30000");

  Element& top = append(*root, "Model", model.name);
  if (is4) appendWrapObjects(writing, append(top, "Ground", "ground"), "ground");
  appendNumbers(top, "gravity", model.gravity);
  appendText(top, "credits", model.credits);
  appendText(top, "publications", model.publications);
  appendText(top, "length_units", "meters");
  appendText(top, "force_units", "N");
  Element& bodies = appendSet(writing, top, "BodySet", "bodyset");
  if (!is4) {
    Body ground;
    ground.name = "ground";
    appendBody(writing, bodies, ground);
  }
  for (const Body& body : model.bodies) appendBody(writing, bodies, body);
  if (is4) {
    Element& joints = append(append(top, "JointSet", "jointset"), "objects");
    for (const Joint& joint : model.joints) appendJoint(writing, joints, joint);
  }
  Element& constraints = appendSet(writing, top, "ConstraintSet", "constraintset");
  for (const CoordinateCoupler& coupler : model.couplers) {
    appendCoupler(writing, constraints, coupler);
  }
  Element& forces = appendSet(writing, top, "ForceSet", "forceset");
  for (const Muscle& muscle : model.muscles) appendMuscle(writing, forces, muscle);
  appendCoordinateForces(writing, forces);
  appendMarkers(writing, top);
  appendBodyForces(writing, forces);
  appendFitted(writing, top);
}

}  // namespace bio::osim
