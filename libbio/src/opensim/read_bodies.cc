#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "opensim/reading.h"

namespace bio::osim {
namespace {

std::array<double, 6> readInertia(const Source& source, const Element& element) {
  std::array<double, 6> inertia = {};
  if (element.FirstChildElement("inertia_xx")) {
    const std::array<const char*, 6> names = {"inertia_xx", "inertia_yy", "inertia_zz",
                                              "inertia_xy", "inertia_xz", "inertia_yz"};
    for (std::size_t i = 0; i < 6; ++i) {
      inertia[i] = readNumber(source, element, names[i], "kg m²", Rule::finite, 0.0);
    }
  } else {
    const auto read =
        readNumbers(source, element, "inertia", "kg m²", 6, std::vector<double>(6, 0.0));
    std::copy(read.begin(), read.end(), inertia.begin());
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(inertia[i] >= 0)) {
      fail(source, element,
           fmt::format("inertia about {} = {} kg m², must be ≥ 0", "xyz"[i], inertia[i]));
    }
  }
  return inertia;
}

Eigen::Vector3d scaleOf(const Source& source, const Element& element) {
  const auto s =
      readNumbers(source, element, "scale_factors", "1", 3, std::vector<double>{1, 1, 1});
  return {s[0], s[1], s[2]};
}

// Meshes anywhere below the body, in the order of the file; OpenSim 3 scales all of a body, too.
void collectGeometry(const Source& source, const Element& element, const Eigen::Vector3d& scale,
                     Body& body) {
  for (const Element* child : childrenOf(&element)) {
    const std::string_view tag = child->Name();
    if (tag == "mesh_file" || tag == "geometry_file") {
      const std::string file = trimmedText(child);
      if (file.empty()) continue;
      body.geometry.push_back({file, scale.cwiseProduct(scaleOf(source, element))});
    } else if (tag == "VisibleObject") {
      collectGeometry(source, *child, scale.cwiseProduct(scaleOf(source, *child)), body);
    } else if (tag != "Joint") {
      collectGeometry(source, *child, scale, body);
    }
  }
}

}  // namespace

void requireNewName(const Reading& reading, const Element& element, const char* kind,
                    std::map<std::string, int>& names) {
  const auto [found, isNew] = names.emplace(nameOf(reading.source, element), element.GetLineNum());
  if (!isNew) {
    fail(reading.source, element,
         fmt::format("second {} called '{}' (the first is in line {}), names must be unique", kind,
                     found->first, found->second));
  }
}

void readBodies(Reading& reading, const Element& model) {
  const Source& source = reading.source;
  std::map<std::string, int> names;
  for (const Element* element : objectsOf(model, "BodySet")) {
    if (std::string_view(element->Name()) != "Body") {
      fail(source, *element,
           fmt::format("class {} among the bodies, must be Body", element->Name()));
    }
    requireNewName(reading, *element, "body", names);
    if (nameOf(source, *element) == "ground") continue;  // OpenSim 3 lists the ground as a body
    Body body;
    body.name = nameOf(source, *element);
    body.mass = readNumber(source, *element, "mass", "kg", Rule::notNegative);
    const auto c =
        readNumbers(source, *element, "mass_center", "m", 3, std::vector<double>{0, 0, 0});
    body.massCenter = {c[0], c[1], c[2]};
    body.inertia = readInertia(source, *element);
    // as in OpenSim, whatever the file says
    if (!(body.mass > 0)) body.inertia = {};
    collectGeometry(source, *element, Eigen::Vector3d::Ones(), body);
    reading.model.bodies.push_back(std::move(body));
  }
}

}  // namespace bio::osim
