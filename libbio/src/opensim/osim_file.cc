#include "bio/opensim/osim_file.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <set>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "bio/robot_description/robot_description.h"
#include "bio/tables/file_error.h"
#include "opensim/merge.h"
#include "opensim/read_model.h"
#include "opensim/update.h"
#include "opensim/writing.h"
#include "tables/text_file.h"

namespace bio {
namespace {

/// What the user should know of how a file became the document that the reader knows.
struct Parsed {
  std::vector<std::string> warnings, remarks;
  bool isTranslated = false;  ///< of a robot description
};

Parsed parse(tinyxml2::XMLDocument& document, const std::string& text, const std::string& file) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw FileError(file + ": is empty, must be an OpenSim model");
  }
  if (document.Parse(text.c_str(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw FileError(fmt::format("{}:{}: is not well-formed XML ({})", file, document.ErrorLineNum(),
                                tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID())));
  }
  const ModelFormat format = modelFormat(document);
  if (format == ModelFormat::urdf || format == ModelFormat::mjcf) {
    const Model robot = readRobotDescription(document, file);
    document.Clear();
    osim::buildDocument(document, robot, osim::Format::opensim4);
    return {robot.warnings, robot.remarks, true};
  }
  osim::checkVersion(document, file);
  return {osim::update(document, file), {}, false};
}

std::vector<osim::Element*> elementsIn(osim::Element& parent) {
  std::vector<osim::Element*> children;
  for (auto* child = parent.FirstChildElement(); child; child = child->NextSiblingElement())
    children.push_back(child);
  return children;
}

std::string nameAttribute(const osim::Element& element) {
  const char* name = element.Attribute("name");
  return name ? name : "";
}

/// In every text and coordinate below: "j1/rz" becomes "rz" in its own joint, "/jointset/j1/rz"
/// elsewhere.
void restoreBelow(osim::Element& element, const std::set<std::string>& full, bool inJoint) {
  for (osim::Element* child : elementsIn(element)) {
    const bool isJoint = std::string_view(child->Name()).ends_with("Joint");
    restoreBelow(*child, full, inJoint || isJoint);
  }
  const std::string name = nameAttribute(element);
  if (std::string_view(element.Name()) == "Coordinate" && full.contains(name))
    element.SetAttribute("name", name.substr(name.find('/') + 1).c_str());
  if (element.FirstChildElement()) return;
  const std::string text = osim::trimmedText(&element);
  if (!full.contains(text)) return;
  element.SetText((inJoint ? text.substr(text.find('/') + 1) : "/jointset/" + text).c_str());
}

void collectFull(const osim::Element& element, std::set<std::string>& full) {
  for (const osim::Element* child = element.FirstChildElement(); child;
       child = child->NextSiblingElement())
    collectFull(*child, full);
  const std::string name = nameAttribute(element);
  if (std::string_view(element.Name()) == "Coordinate" && name.find('/') != name.npos)
    full.insert(name);
}

// Coordinates have their own names again, and others refer to them by path.
void restoreNames(tinyxml2::XMLDocument& document) {
  std::set<std::string> full;
  if (document.RootElement()) collectFull(*document.RootElement(), full);
  if (!full.empty()) restoreBelow(*document.RootElement(), full, false);
}

// OpenSim indents with tabs.
class Printer : public tinyxml2::XMLPrinter {
 protected:
  void PrintSpace(int depth) override {
    for (int i = 0; i < depth; ++i) Write("\t");
  }
};

std::string print(const tinyxml2::XMLDocument& document) {
  tinyxml2::XMLDocument written;
  document.DeepCopy(&written);
  restoreNames(written);
  Printer printer;
  written.Print(&printer);
  return printer.CStr();
}

// Reads the text as a reader of the file will, and throws unless that gives the same model.
void checkText(const std::string& text, const tinyxml2::XMLDocument& wanted, osim::Format format,
               const std::string& file) {
  tinyxml2::XMLDocument written, again;
  parse(written, text, file);
  osim::buildDocument(again, osim::readModel(written, file), format);
  const std::string difference =
      osim::firstDifference(*again.RootElement(), *wanted.RootElement(), 1e-12);
  if (!difference.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: the document cannot express the model: {}", file, difference));
  }
}

osim::Format formatOf(const tinyxml2::XMLDocument& document) {
  const osim::Element* model = document.RootElement()->FirstChildElement("Model");
  return model->FirstChildElement("JointSet") ? osim::Format::opensim4 : osim::Format::opensim3;
}

}  // namespace

Model readOsim(const std::filesystem::path& file) {
  tinyxml2::XMLDocument document;
  const Parsed parsed = parse(document, readTextFile(file), file.string());
  Model model = osim::readModel(document, file.string());
  model.warnings.insert(model.warnings.begin(), parsed.warnings.begin(), parsed.warnings.end());
  model.remarks.insert(model.remarks.begin(), parsed.remarks.begin(), parsed.remarks.end());
  return model;
}

void writeOsim(const Model& model, const std::filesystem::path& file) {
  for (const Muscle& muscle : model.muscles) {
    if (!muscle.canBeSimulated()) {
      throw std::invalid_argument(
          fmt::format("muscle '{}' is a {}: only muscles of the classes {} can be written to a "
                      "fresh document",
                      muscle.name, muscle.className, simulatedClasses()));
    }
  }
  for (const Joint& joint : model.joints) {
    for (const Coordinate& coordinate : joint.coordinates) {
      if (!coordinate.isPrescribed() || coordinate.prescribedFunction) continue;
      throw std::invalid_argument(
          fmt::format("coordinate '{}': its prescribed_function is of a class that is not known "
                      "and cannot be written to a fresh document",
                      coordinate.name));
    }
  }
  tinyxml2::XMLDocument document;
  osim::buildDocument(document, model, osim::Format::opensim4);
  const std::string text = print(document);
  checkText(text, document, osim::Format::opensim4, file.string());
  writeTextFile(file, text);
}

std::string rewrittenOsim(const std::filesystem::path& original, const Model& model,
                          const std::string& name) {
  const std::string text = readTextFile(original);
  tinyxml2::XMLDocument document, before, after;
  const bool isTranslated = parse(document, text, original.string()).isTranslated;
  const Model old = osim::readModel(document, original.string());
  const osim::Format format = formatOf(document);
  osim::buildDocument(before, old, format);
  osim::buildDocument(after, model, format);
  if (osim::firstDifference(*before.RootElement(), *after.RootElement(), 0).empty()) {
    return isTranslated ? print(document) : text;
  }
  osim::applyChanges(*document.RootElement(), *before.RootElement(), *after.RootElement());
  std::string changed = print(document);
  checkText(changed, after, format, name);
  return changed;
}

void rewriteOsim(const std::filesystem::path& original, const Model& model,
                 const std::filesystem::path& file) {
  writeTextFile(file, rewrittenOsim(original, model, file.string()));
}

}  // namespace bio
