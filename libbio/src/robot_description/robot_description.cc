#include "bio/robot_description/robot_description.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <string_view>

#include "bio/tables/file_error.h"
#include "robot_description/read_mjcf.h"
#include "robot_description/read_urdf.h"
#include "tables/text_file.h"

namespace bio {
namespace {

ModelFormat formatCalled(std::string_view root) {
  return root == "OpenSimDocument" ? ModelFormat::openSim
         : root == "robot"         ? ModelFormat::urdf
         : root == "mujoco"        ? ModelFormat::mjcf
                                   : ModelFormat::none;
}

// The name of the first element of a text that begins as XML does; empty if it does not.
std::string_view rootIn(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  for (;;) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == text.npos || text[first] != '<') return {};
    text.remove_prefix(first + 1);
    std::string_view end = ">";
    if (text.starts_with("!--")) {
      end = "-->";
    } else if (!text.starts_with('?') && !text.starts_with('!')) {
      return text.substr(0, text.find_first_of(" \t\r\n/>"));
    }
    const std::size_t last = text.find(end);
    if (last == text.npos) return {};
    text.remove_prefix(last + end.size());
  }
}

std::string countOf(std::size_t number, const char* one, const char* many) {
  return fmt::format("{} {}", number, number == 1 ? one : many);
}

}  // namespace

ModelFormat modelFormat(const tinyxml2::XMLDocument& document) {
  return document.RootElement() ? formatCalled(document.RootElement()->Name()) : ModelFormat::none;
}

ModelFormat modelFormat(const std::filesystem::path& file) {
  return formatCalled(rootIn(readTextFile(file)));
}

Model readRobotDescription(const tinyxml2::XMLDocument& document,
                           const std::filesystem::path& file) {
  const ModelFormat format = modelFormat(document);
  if (format != ModelFormat::urdf && format != ModelFormat::mjcf) {
    throw FileError(
        fmt::format("{}: is no robot description, its root element must be robot "
                    "(URDF) or mujoco (MJCF)",
                    file.string()));
  }
  const robot::Documents documents(document, file);
  const robot::Element& root = *document.RootElement();
  return format == ModelFormat::urdf ? robot::readUrdf(documents, root)
                                     : robot::readMjcf(documents, root);
}

std::vector<std::string> translationOf(const Model& model, ModelFormat format) {
  const bool isUrdf = format == ModelFormat::urdf;
  std::size_t coordinates = 0, massless = 0;
  for (const Joint& joint : model.joints) coordinates += joint.coordinates.size();
  for (const Body& body : model.bodies) massless += body.mass > 0 ? 0 : 1;
  std::size_t springs = 0;
  for (const SpringGeneralizedForce& spring : model.springForces) springs += spring.stiffness != 0;
  std::string first = fmt::format(
      "{} “{}”, translated to {} ({} without mass) and {} of {}, and to {}, {}, {} of dry friction "
      "and {}",
      isUrdf ? "URDF of" : "MJCF of", model.name, countOf(model.bodies.size(), "body", "bodies"),
      massless, countOf(coordinates, "coordinate", "coordinates"),
      countOf(model.joints.size(), "joint", "joints"),
      countOf(model.springForces.size() - springs, "damper", "dampers"),
      countOf(springs, "spring", "springs"),
      countOf(model.expressionForces.size(), "force", "forces"),
      countOf(model.actuators.size(), "motor", "motors"));
  std::string second = fmt::format(
      "gravity {:g} {:g} {:g} m/s²; limits of joints are ranges of "
      "coordinates and exert no force",
      model.gravity.x(), model.gravity.y(), model.gravity.z());
  if (isUrdf) second += "; the root link stands on the ground";
  return {std::move(first), std::move(second)};
}

}  // namespace bio
