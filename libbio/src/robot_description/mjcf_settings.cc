#include <fmt/format.h>

#include <cmath>

#include "bio/model/units.h"
#include "robot_description/mjcf.h"

namespace bio::robot {
namespace {

constexpr const char* mainClass = "main";

bool readBool(const Documents& documents, const Element& element, const char* attribute) {
  const std::string text = textOf(element, attribute);
  if (text != "true" && text != "false") {
    documents.fail(element, fmt::format("{} = '{}', must be true or false", attribute, text));
  }
  return text == "true";
}

}  // namespace

bool MjcfSettings::has(const char* effect) const {
  return !disabled.contains(effect);
}

void MjcfReading::readSettings() {
  settings_.angle = radiansPerDegree;
  for (const Element* child : documents_.childrenOf(root_)) {
    const std::string_view tag = child->Name();
    if (tag == "compiler") readCompiler(*child);
    if (tag == "option") readOption(*child);
    if (tag == "default") defaults_.read(*child);
  }
}

void MjcfReading::readCompiler(const Element& compiler) {
  const auto text = [&](const char* name) { return textOf(compiler, name); };
  if (compiler.Attribute("angle")) {
    if (text("angle") != "degree" && text("angle") != "radian") {
      documents_.fail(compiler,
                      fmt::format("angle = '{}', must be degree or radian", text("angle")));
    }
    settings_.angle = text("angle") == "degree" ? radiansPerDegree : 1.0;
  }
  if (compiler.Attribute("coordinate") && text("coordinate") != "local") {
    documents_.fail(compiler, fmt::format("coordinate = '{}', must be local", text("coordinate")));
  }
  if (compiler.Attribute("eulerseq")) {
    settings_.eulerOrder = text("eulerseq");
    if (settings_.eulerOrder.size() != 3 ||
        settings_.eulerOrder.find_first_not_of("xyzXYZ") != std::string::npos) {
      documents_.fail(compiler, fmt::format("eulerseq = '{}', must be three letters of xyzXYZ",
                                            settings_.eulerOrder));
    }
  }
  if (compiler.Attribute("autolimits"))
    settings_.limitsFromRanges = readBool(documents_, compiler, "autolimits");
  if (compiler.Attribute("balanceinertia"))
    settings_.balancesInertia = readBool(documents_, compiler, "balanceinertia");
  if (compiler.Attribute("inertiafromgeom")) {
    settings_.inertiaFromGeoms = text("inertiafromgeom");
    if (settings_.inertiaFromGeoms != "auto") readBool(documents_, compiler, "inertiafromgeom");
  }
  if (const char* groups = compiler.Attribute("inertiagrouprange")) {
    const auto range = documents_.numbers(compiler, "inertiagrouprange", groups, 2);
    settings_.inertiaGroups = {range[0], range[1]};
  }
  settings_.leastMass =
      documents_.number(compiler, "boundmass", Rule::notNegative, settings_.leastMass);
  settings_.leastInertia =
      documents_.number(compiler, "boundinertia", Rule::notNegative, settings_.leastInertia);
  settings_.totalMass =
      documents_.number(compiler, "settotalmass", Rule::finite, settings_.totalMass);
}

void MjcfReading::readOption(const Element& option) {
  if (const char* gravity = option.Attribute("gravity")) {
    const auto g = documents_.numbers(option, "gravity", gravity, 3);
    settings_.gravity = {g[0], g[1], g[2]};
    if (constexpr double most = 1e4; !(settings_.gravity.stableNorm() <= most)) {
      documents_.fail(option, fmt::format("gravity = {}, must be at most {} m/s²", gravity, most));
    }
  }
  for (const char* medium : {"density", "viscosity"}) {
    if (documents_.number(option, medium, Rule::notNegative, 0.0) > 0)
      maker_.isNotSimulated("a medium's resistance", fmt::format("option {}", medium));
  }
  for (const Element* flag : documents_.childrenOf(option, "flag")) {
    for (auto each = flag->FirstAttribute(); each; each = each->Next()) {
      if (std::string_view(each->Value()) == "disable") settings_.disabled.insert(each->Name());
    }
  }
  const auto alsoDisables = [&](const char* one, std::initializer_list<const char*> others) {
    if (!settings_.disabled.contains(one)) return;
    for (const char* other : others) settings_.disabled.insert(other);
  };
  alsoDisables("constraint", {"contact", "limit", "frictionloss", "equality"});
  alsoDisables("passive", {"spring", "damper"});
}

void MjcfDefaults::read(const Element& top) {
  readClass(top, mainClass, "");
}

void MjcfDefaults::readClass(const Element& element, const std::string& name,
                             const std::string& parent) {
  const auto [found, isNew] = classes_.emplace(name, Class{parent, {}});
  if (!isNew && !parent.empty()) {
    documents_.fail(element, fmt::format("is a second default class '{}'", name));
  }
  found->second.elements.push_back(&element);
  for (const Element* child : documents_.childrenOf(element, "default")) {
    const std::string own = textOf(*child, "class");
    if (own.empty()) documents_.fail(*child, "has no class, must have one inside a <default>");
    if (own == mainClass) documents_.fail(*child, "is called 'main' inside a <default>");
    readClass(*child, own, name);
  }
}

void MjcfDefaults::requireClass(const Element& element, const std::string& name) const {
  if (name.empty() || name == mainClass || classes_.contains(name)) return;
  // the outermost class may have a name of its own
  const auto main = classes_.find(mainClass);
  if (main != classes_.end()) {
    for (const Element* top : main->second.elements) {
      if (textOf(*top, "class") == name) return;
    }
  }
  documents_.fail(element, fmt::format("class = '{}', must name a <default> of the file", name));
}

const char* MjcfDefaults::find(const Element& element, const std::string& childClass,
                               const std::vector<const char*>& tags, const char* attribute) const {
  if (const char* own = element.Attribute(attribute)) return own;
  std::string name = textOf(element, "class");
  requireClass(element, name);
  if (name.empty()) name = childClass;
  auto at = classes_.find(name);
  if (at == classes_.end()) at = classes_.find(mainClass);
  while (at != classes_.end()) {
    const auto& elements = at->second.elements;
    for (auto each = elements.rbegin(); each != elements.rend(); ++each) {
      const char* last = nullptr;
      for (const Element* settings : documents_.childrenOf(**each)) {
        for (const char* tag : tags) {
          const char* value = settings->Attribute(attribute);
          if (value && std::string_view(tag) == settings->Name()) last = value;
        }
      }
      if (last) return last;
    }
    if (at->second.parent.empty()) return nullptr;
    at = classes_.find(at->second.parent);
  }
  return nullptr;
}

}  // namespace bio::robot
