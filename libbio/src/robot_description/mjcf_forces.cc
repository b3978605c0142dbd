#include <fmt/format.h>

#include <cmath>

#include "robot_description/mjcf.h"

namespace bio::robot {
namespace {

// Σ a_i (x − x₀)^i, highest power of x first
std::vector<double> shifted(const std::vector<double>& a, double x0) {
  std::vector<double> rising(a.size(), 0.0), power{1};  // of (x − x₀)^i, lowest power first
  for (const double factor : a) {
    for (std::size_t k = 0; k < power.size(); ++k) rising[k] += factor * power[k];
    std::vector<double> next(power.size() + 1, 0.0);
    for (std::size_t k = 0; k < power.size(); ++k) {
      next[k + 1] += power[k];
      next[k] -= x0 * power[k];
    }
    power = std::move(next);
  }
  return {rising.rbegin(), rising.rend()};
}

std::string nameOr(const Element& element) {
  return element.Attribute("name") ? textOf(element, "name")
                                   : fmt::format("line {}", element.GetLineNum());
}

}  // namespace

void MjcfReading::readForces() {
  for (const Element* section : documents_.childrenOf(root_)) {
    const std::string_view tag = section->Name();
    if (tag == "actuator" && settings_.has("actuation")) {
      for (const Element* each : documents_.childrenOf(*section)) readActuator(*each);
    }
    if (tag == "equality" && settings_.has("equality")) {
      for (const Element* each : documents_.childrenOf(*section)) readEquality(*each);
    }
    if (tag == "tendon") {
      for (const Element* each : documents_.childrenOf(*section))
        maker_.isNotSimulated("tendons", nameOr(*each));
    }
    if (tag == "contact") touching_ += 2 * documents_.childrenOf(*section, "pair").size();
    if (tag == "deformable" && section->FirstChildElement())
      maker_.isNotSimulated("deformable parts", nameOr(*section));
  }
}

void MjcfReading::readActuator(const Element& actuator) {
  const std::string_view tag = actuator.Name();
  const MjcfElement given(documents_, defaults_, actuator, {},
                          {"general", "motor", "position", "velocity"});
  const std::string at = given.text("joint", given.text("jointinparent", "").c_str());
  if (tag != "motor" && tag != "general") {
    maker_.isNotSimulated("servos and other actuators than motors", nameOr(actuator));
    return;
  }
  if (at.empty()) {
    maker_.isNotSimulated("motors at no joint", nameOr(actuator));
    return;
  }
  const auto joint = joints_.find(at);
  if (joint == joints_.end()) {
    documents_.fail(actuator, fmt::format("joint = '{}', must name a joint of the model", at));
  }
  if (joint->second.coordinate.empty()) {
    maker_.isNotSimulated("motors at ball and free joints", nameOr(actuator));
    return;
  }
  double gain = 1;
  if (tag == "general") {
    const MjcfElement own(documents_, defaults_, actuator, {}, {"general"});
    if (own.text("dyntype", "none") != "none" || own.text("gaintype", "fixed") != "fixed" ||
        own.text("biastype", "none") != "none") {
      maker_.isNotSimulated("servos and other actuators than motors", nameOr(actuator));
      return;
    }
    const auto gains = own.numbers("gainprm");
    if (!gains.empty()) gain = gains.front();
  }
  const auto gear = given.numbers("gear");
  const std::string& coordinate = joint->second.coordinate;
  maker_.addMotor(actuator,
                  actuator.Attribute("name") ? maker_.nameOf(actuator) : coordinate + "_motor",
                  coordinate, gain * (gear.empty() ? 1.0 : gear.front()));
}

void MjcfReading::readEquality(const Element& equality) {
  const MjcfElement given(documents_, defaults_, equality, {}, {"equality"});
  if (given.text("active", "true") == "false") return;
  if (std::string_view(equality.Name()) != "joint") {
    maker_.isNotSimulated("constraints", fmt::format("{} {}", equality.Name(), nameOr(equality)));
    return;
  }
  const auto find = [&](const char* attribute) -> const MjcfJoint& {
    const auto joint = joints_.find(textOf(equality, attribute));
    if (joint == joints_.end() || joint->second.coordinate.empty()) {
      documents_.fail(equality, fmt::format("{} = '{}', must name a hinge or a slide", attribute,
                                            textOf(equality, attribute)));
    }
    return joint->second;
  };
  std::vector<double> a = given.numbers("polycoef");
  if (a.size() > 5) documents_.fail(equality, "polycoef must have 5 numbers or fewer");
  for (std::size_t i = a.size(); i < 5; ++i) a.push_back(i == 1 ? 1 : 0);
  const MjcfJoint& dependent = find("joint1");
  a[0] += dependent.reference;
  if (!equality.Attribute("joint2")) {
    for (Joint& joint : maker_.model().joints) {
      for (Coordinate& coordinate : joint.coordinates) {
        if (coordinate.name != dependent.coordinate) continue;
        coordinate.locked = true;
        coordinate.defaultValue = a[0];
      }
    }
    return;
  }
  const MjcfJoint& independent = find("joint2");
  if (dependent.coordinate == independent.coordinate) {
    documents_.fail(equality, "couples a joint to itself, must name two joints");
  }
  const std::vector<double> c = shifted(a, independent.reference);
  Function function{1, PolynomialFunction{c}};
  if (a[2] == 0 && a[3] == 0 && a[4] == 0) function.shape = LinearFunction{c[3], c[4]};
  maker_.addCoupler(equality, dependent.coordinate, independent.coordinate, function);
}

void MjcfReading::warnOfContacts() {
  if (touching_ < 2 || touchingMoves_ == 0 || !settings_.has("contact")) return;
  maker_.isNotSimulated("contacts", fmt::format("{} geoms may touch", touching_));
}

}  // namespace bio::robot
