#include "generator/elbow_numbers.h"

#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>

namespace hidden {
namespace {

using Element = tinyxml2::XMLElement;

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error("elbow document: " + what);
}

const Element& child(const Element& parent, const char* name) {
  const Element* found = parent.FirstChildElement(name);
  if (!found) fail(std::string("no <") + name + "> in <" + parent.Name() + ">");
  return *found;
}

std::string text(const Element& parent, const char* name) {
  const char* content = child(parent, name).GetText();
  return content ? content : "";
}

std::string nameOf(const Element& element) {
  const char* name = element.Attribute("name");
  return name ? name : "";
}

std::vector<double> numbers(const std::string& words) {
  std::istringstream stream(words);
  std::vector<double> values;
  for (double value; stream >> value;) values.push_back(value);
  return values;
}

double number(const Element& parent, const char* name) {
  const auto values = numbers(text(parent, name));
  if (values.size() != 1) fail(std::string("<") + name + "> must hold one number");
  return values[0];
}

Vec vector(const Element& parent, const char* name) {
  const auto v = numbers(text(parent, name));
  if (v.size() != 3) fail(std::string("<") + name + "> must hold three numbers");
  return {v[0], v[1], v[2]};
}

template <class Use>
void forEach(const Element& set, Use&& use) {
  for (auto* e = child(set, "objects").FirstChildElement(); e; e = e->NextSiblingElement()) use(*e);
}

std::string lastWord(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

// The curve through 2 (line) or 3 points (parabola; a broken line if so named), at 0.
double curveAtZero(const Element& location) {
  const Element* curve = location.FirstChildElement();
  if (!curve) fail("a moving point without a function");
  const auto x = numbers(text(*curve, "x")), y = numbers(text(*curve, "y"));
  if (x.size() != y.size() || x.size() < 2 || x.size() > 3) fail("a moving point's function");
  if (std::string(curve->Name()) == "PiecewiseLinearFunction") {
    const std::size_t i = x.size() == 3 && x[1] <= 0 ? 1 : 0;
    return y[i] - x[i] * (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
  }
  double value = 0;  // Lagrange
  for (std::size_t i = 0; i < x.size(); ++i) {
    double weight = y[i];
    for (std::size_t k = 0; k < x.size(); ++k) {
      if (k != i) weight *= (0 - x[k]) / (x[i] - x[k]);
    }
    value += weight;
  }
  return value;
}

ForceCurve curve(const Element& muscle, const char* name) {
  for (auto* e = muscle.FirstChildElement("SimmSpline"); e;
       e = e->NextSiblingElement("SimmSpline")) {
    if (nameOf(*e) == name) return {numbers(text(*e, "x")), numbers(text(*e, "y"))};
  }
  fail(std::string("no curve ") + name);
}

class Reader {
 public:
  explicit Reader(const Element& model) : model_(model) {}

  ElbowNumbers read() {
    elbow_.gravity = vector(model_, "gravity");
    origin_["ground"] = Vec::Zero();
    forEach(child(model_, "JointSet"), [&](const Element& e) { readJoint(e); });
    forEach(child(model_, "BodySet"), [&](const Element& e) { readBody(e); });
    forEach(child(model_, "ForceSet"), [&](const Element& e) {
      if (std::string(e.Name()) == "Schutte1993Muscle_Deprecated") readMuscle(e);
    });
    return std::move(elbow_);
  }

 private:
  void readJoint(const Element& joint) {
    std::string bodies[2];
    Vec offsets[2];
    const char* sockets[2] = {"socket_parent_frame", "socket_child_frame"};
    for (int i = 0; i < 2; ++i) {
      const std::string wanted = lastWord(text(joint, sockets[i]));
      for (auto* f = child(joint, "frames").FirstChildElement(); f; f = f->NextSiblingElement()) {
        if (nameOf(*f) != wanted) continue;
        bodies[i] = lastWord(text(*f, "socket_parent"));
        offsets[i] = vector(*f, "translation");
        if (vector(*f, "orientation").norm() > 0) fail("a turned joint frame");
      }
      if (bodies[i].empty()) fail("joint " + nameOf(joint) + " without its frames");
    }
    if (!origin_.count(bodies[0])) fail("joints must come from the ground outwards");
    const auto& coordinates = child(joint, "coordinates");
    for (auto* c = coordinates.FirstChildElement(); c; c = c->NextSiblingElement()) {
      if (number(*c, "default_value") != 0) fail("coordinate " + nameOf(*c) + " is not at 0");
    }
    origin_[bodies[1]] = origin_[bodies[0]] + offsets[0] - offsets[1];
    if (forearm_.count(bodies[0])) forearm_.insert(bodies[1]);
    if (nameOf(joint) == "elbow") {
      elbow_.hinge = origin_[bodies[0]] + offsets[0];
      elbow_.shoulder = origin_[bodies[0]];
      elbow_.axis = vector(*child(joint, "SpatialTransform").FirstChildElement(), "axis");
      elbow_.axis.normalize();
      forearm_.insert(bodies[1]);
    }
  }

  void readBody(const Element& element) {
    const std::string name = nameOf(element);
    const Vec origin = origin_.at(name);
    if (forearm_.count(name)) {
      Body body;
      body.name = name;
      body.mass = number(element, "mass");
      body.centre = origin + vector(element, "mass_center");
      const auto i = numbers(text(element, "inertia"));
      body.inertia << i.at(0), i.at(3), i.at(4), i.at(3), i.at(1), i.at(5), i.at(4), i.at(5),
          i.at(2);
      if (name == "hand") elbow_.hand = body.centre;
      elbow_.forearm.push_back(body);
    }
    forEach(child(element, "WrapObjectSet"), [&](const Element& w) {
      if (std::string(w.Name()) != "WrapCylinder" || name != "humerus") fail("a wrap object");
      const Vec turn = vector(w, "xyz_body_rotation");
      const Eigen::Matrix3d R =
          (Eigen::AngleAxisd(turn[0], Vec::UnitX()) * Eigen::AngleAxisd(turn[1], Vec::UnitY()) *
           Eigen::AngleAxisd(turn[2], Vec::UnitZ()))
              .toRotationMatrix();
      Cylinder c;
      c.centre = origin + vector(w, "translation");
      c.x = R.col(0), c.y = R.col(1), c.z = R.col(2);
      c.radius = number(w, "radius");
      c.halfLength = number(w, "length") / 2;
      c.onPlusX = text(w, "quadrant") == "x";
      if (!c.onPlusX && text(w, "quadrant") != "all") fail("a wrap object's quadrant");
      elbow_.cylinders.names.push_back(nameOf(w));
      elbow_.cylinders.shapes.push_back(c);
    });
  }

  PathPoint readPoint(const Element& element) const {
    const std::string kind = element.Name();
    const std::string body = lastWord(text(element, "socket_parent_frame"));
    PathPoint point;
    point.onForearm = forearm_.count(body) > 0;
    if (kind == "MovingPathPoint") {
      point.place = {curveAtZero(child(element, "x_location")),
                     curveAtZero(child(element, "y_location")),
                     curveAtZero(child(element, "z_location"))};
    } else {
      point.place = vector(element, "location");
    }
    point.place += origin_.at(body);
    if (kind == "ConditionalPathPoint") {
      const auto range = numbers(text(element, "range"));
      point.conditional = true;
      point.from = range.at(0), point.to = range.at(1);
    }
    return point;
  }

  void readMuscle(const Element& element) {
    HillMuscle m;
    m.name = nameOf(element);
    m.maxForce = number(element, "max_isometric_force");
    m.fibreLength = number(element, "optimal_fiber_length");
    m.slackLength = number(element, "tendon_slack_length");
    m.pennation = number(element, "pennation_angle_at_optimal");
    m.timeScale = number(element, "time_scale");
    m.activation1 = number(element, "activation1");
    m.activation2 = number(element, "activation2");
    m.damping = number(element, "damping");
    m.tendon = curve(element, "tendon_force_length_curve");
    m.active = curve(element, "active_force_length_curve");
    m.passive = curve(element, "passive_force_length_curve");
    elbow_.muscles.push_back(m);

    const Element& geometry = child(element, "GeometryPath");
    Path path;
    forEach(child(geometry, "PathPointSet"),
            [&](const Element& p) { path.points.push_back(readPoint(p)); });
    forEach(child(geometry, "PathWrapSet"), [&](const Element& w) {
      // 1-based; it must be the span that crosses the elbow
      const auto range = numbers(text(w, "range"));
      const auto first = static_cast<std::size_t>(range.at(0)) - 1;
      if (range.at(1) != range.at(0) + 1 || first + 1 >= path.points.size() ||
          path.points[first].onForearm == path.points[first + 1].onForearm) {
        fail("muscle " + m.name + " wraps where it does not cross the elbow");
      }
      const auto& names = elbow_.cylinders.names;
      for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == text(w, "wrap_object")) path.cylinder = static_cast<int>(i);
      }
      if (path.cylinder < 0) fail("muscle " + m.name + " wraps an unknown object");
    });
    elbow_.paths.push_back(path);
  }

  const Element& model_;
  ElbowNumbers elbow_;
  std::map<std::string, Vec> origin_;  // of each body in the ground, at 0
  std::set<std::string> forearm_;
};

}  // namespace

ElbowNumbers readElbow(const std::filesystem::path& file) {
  tinyxml2::XMLDocument document;
  if (document.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS) {
    throw std::runtime_error(file.string() + ": cannot be read");
  }
  const Element* root = document.FirstChildElement("OpenSimDocument");
  if (!root) fail("no <OpenSimDocument> in " + file.string());
  return Reader(child(*root, "Model")).read();
}

std::string withoutMuscle(const std::filesystem::path& file, const std::string& muscle) {
  tinyxml2::XMLDocument document;
  if (document.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS) {
    throw std::runtime_error(file.string() + ": cannot be read");
  }
  Element* element = document.RootElement()->FirstChildElement("Model");
  for (const char* name : {"ForceSet", "objects", "Schutte1993Muscle_Deprecated"}) {
    element = element ? element->FirstChildElement(name) : nullptr;
  }
  while (element && nameOf(*element) != muscle) element = element->NextSiblingElement();
  Element* flag = element ? element->FirstChildElement("appliesForce") : nullptr;
  if (!flag) fail("no muscle " + muscle + " that can be switched off");
  flag->SetText("false");
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace hidden
