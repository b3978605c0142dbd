#include "opensim/read_model.h"

#include <fmt/format.h>

#include <string_view>

#include "bio/tables/file_error.h"
#include "opensim/reading.h"

namespace bio::osim {
namespace {

const Element& findModel(const tinyxml2::XMLDocument& document, const Source& source) {
  const Element* root = document.RootElement();
  const Element* model = root->FirstChildElement("Model");
  if (!model) fail(source, *root, "holds no Model, must hold one");
  for (const Element* set : childrenOf(model)) {
    if (set->Attribute("file")) {
      fail(source, *set,
           fmt::format("is kept in another file ('{}'), must be in this one",
                       set->Attribute("file")));
    }
  }
  return *model;
}

void checkUnits(Reading& reading, const Element& model) {
  const std::string lengths = readText(reading.source, model, "length_units", "meters");
  const std::string forces = readText(reading.source, model, "force_units", "N");
  if (lengths != "meters" && lengths != "m") {
    reading.model.warnings.push_back(
        fmt::format("length_units = '{}' is ignored: lengths are read as metres", lengths));
  }
  if (forces != "N" && forces != "newtons") {
    reading.model.warnings.push_back(
        fmt::format("force_units = '{}' is ignored: forces are read as newtons", forces));
  }
}

// A coupler says how its dependent coordinate moves.
void warnOfPrescribedAndCoupled(Reading& reading) {
  for (const CoordinateCoupler& coupler : reading.model.couplers) {
    const Coordinate* dependent = coordinateOrNull(reading.model, coupler.dependent);
    if (!dependent || !dependent->isPrescribed()) continue;
    reading.model.warnings.push_back(
        fmt::format("coordinate '{}' is prescribed and follows '{}' (coupler '{}'): it follows",
                    coupler.dependent, coupler.independent, coupler.name));
  }
}

}  // namespace

void checkVersion(const tinyxml2::XMLDocument& document, const std::string& file) {
  const Source source{file, {}};
  const Element* root = document.RootElement();
  if (!root) throw FileError(file + ": holds no XML element, must be an OpenSim model");
  if (std::string_view(root->Name()) != "OpenSimDocument") {
    fail(source, *root,
         fmt::format("root element is {}, must be OpenSimDocument, robot (URDF) or mujoco (MJCF)",
                     root->Name()));
  }
  const char* text = root->Attribute("Version");
  const int version = root->IntAttribute("Version", 0);
  // OpenSim 1.9.1 writes 10901; a 1.09 is read as 1.
  if (version == 1 || (version >= 10000 && version < 20000)) {
    fail(source, *root,
         fmt::format("Version = '{}', a file of OpenSim 1 is too old: open it once in OpenSim (3.3 "
                     "or newer) and save it",
                     text));
  }
  if (version < 20000) {
    fail(source, *root, fmt::format("Version = '{}', must be 20000 or more", text ? text : ""));
  }
}

Model readModel(const tinyxml2::XMLDocument& document, const std::string& file) {
  Reading reading;
  reading.source.file = file;
  const Element& model = findModel(document, reading.source);
  for (const Element* object : childrenOf(model.FirstChildElement("defaults"))) {
    reading.source.defaults.emplace(object->Name(), object);
  }
  if (const char* name = model.Attribute("name")) reading.model.name = name;
  reading.model.credits = readText(reading.source, model, "credits", "");
  reading.model.publications = readText(reading.source, model, "publications", "");
  const auto g =
      readNumbers(reading.source, model, "gravity", "m/s²", 3, std::vector<double>{0, -9.80665, 0});
  reading.model.gravity = {g[0], g[1], g[2]};
  if (constexpr double most = 1e4; !(reading.model.gravity.stableNorm() <= most)) {
    fail(reading.source, model,
         fmt::format("gravity = ({}, {}, {}) m/s², must be at most {} m/s²", g[0], g[1], g[2],
                     most));
  }
  checkUnits(reading, model);
  readBodies(reading, model);
  readFrames(reading, model);
  readJoints(reading, model);
  readConstraints(reading, model);
  warnOfPrescribedAndCoupled(reading);
  readWrapObjects(reading, model);
  readForces(reading, model);
  readMarkers(reading, model);
  readFitted(reading, model);
  return std::move(reading.model);
}

}  // namespace bio::osim
