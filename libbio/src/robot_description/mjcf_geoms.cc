#include <fmt/format.h>

#include <cmath>

#include "robot_description/mjcf.h"

namespace bio::robot {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

struct Solid {
  double volume = 0;  ///< [m³]
  MassProperties (*of)(double mass, const Vector3d& sizes) = nullptr;
};

// By MuJoCo's sizes: radius and half length, half sizes or semi-axes.
Solid solidOf(const std::string& type, const Vector3d& s) {
  if (type == "sphere") {
    return {4 * M_PI / 3 * s.x() * s.x() * s.x(), [](double mass, const Vector3d& size) {
              return ellipsoid(mass, Vector3d::Constant(size.x()));
            }};
  }
  if (type == "ellipsoid") return {4 * M_PI / 3 * s.prod(), ellipsoid};
  if (type == "box") return {8 * s.prod(), box};
  const double tube = 2 * M_PI * s.x() * s.x() * s.y();
  if (type == "cylinder") {
    return {tube,
            [](double mass, const Vector3d& size) { return cylinder(mass, size.x(), size.y()); }};
  }
  return {tube + 4 * M_PI / 3 * s.x() * s.x() * s.x(),
          [](double mass, const Vector3d& size) { return capsule(mass, size.x(), size.y()); }};
}

std::size_t numSizes(const std::string& type) {
  return type == "sphere" ? 1 : type == "capsule" || type == "cylinder" ? 2 : 3;
}

}  // namespace

MassProperties MjcfReading::massOfGeom(const MjcfElement& geom, const Element& body,
                                       const Transform& X) const {
  const Element& element = geom.element();
  const auto group = geom.number("group", Rule::finite, 0);
  if (group < settings_.inertiaGroups[0] || group > settings_.inertiaGroups[1]) return {};
  const std::string type = geom.text("type", geom.has("mesh") ? "mesh" : "sphere");
  if (type == "plane" || type == "hfield") return {};
  const double density = geom.number("density", Rule::notNegative, 1000);
  const double given = geom.number("mass", Rule::notNegative, -1);
  if (given == 0 || (given < 0 && density == 0)) return {};
  static const std::set<std::string> solids{"sphere", "capsule", "cylinder", "box", "ellipsoid"};
  if (!solids.contains(type) || geom.has("mesh")) {
    documents_.fail(
        body, fmt::format("its mass would be that of {} of type {} in line {}, which "
                          "is not read: give it an <inertial>",
                          label(element), geom.has("mesh") ? "mesh" : type, element.GetLineNum()));
  }
  if (geom.text("shellinertia", "false") == "true") {
    documents_.fail(element, "shellinertia = true, must be false: its mass fills it");
  }
  Transform placed = geom.placement(settings_);
  std::vector<double> sizes = geom.numbers("size");
  if (geom.has("fromto") && type != "sphere") {
    const auto ends = geom.numbers("fromto");
    if (ends.size() != 6) documents_.fail(element, "fromto must have 6 numbers");
    const Vector3d from(ends[0], ends[1], ends[2]), to(ends[3], ends[4], ends[5]);
    if (!((from - to).norm() > 0)) documents_.fail(element, "fromto has no length, must have one");
    placed = {carryingZTo(from - to), (from + to) / 2};
    const std::size_t last = numSizes(type) - 1;
    sizes.resize(std::min(sizes.size(), last));
    if (sizes.size() == last) sizes.push_back((from - to).norm() / 2);
  }
  if (sizes.size() < numSizes(type)) {
    documents_.fail(element, fmt::format("size has {} numbers, a {} must have {}", sizes.size(),
                                         type, numSizes(type)));
  }
  Vector3d size = Vector3d::Zero();
  for (std::size_t i = 0; i < numSizes(type); ++i) {
    size[static_cast<Eigen::Index>(i)] =
        documents_.ruled(element, "size", sizes[i], Rule::positive);
  }
  const Solid solid = solidOf(type, size);
  return solid.of(given > 0 ? given : density * solid.volume, size).placed(X * placed);
}

}  // namespace bio::robot
