#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bio/opensim/external_loads.h"
#include "bio/tables/file_error.h"
#include "bio/tables/table_file.h"
#include "opensim/xml.h"
#include "tables/text_file.h"

namespace bio {
namespace {

using osim::Element;
using osim::Source;

const Element& findLoads(const tinyxml2::XMLDocument& document, const Source& source) {
  const Element* root = document.RootElement();
  const Element* loads = root ? root->FirstChildElement("ExternalLoads") : nullptr;
  if (!loads) {
    throw FileError(source.file + ": holds no ExternalLoads in an OpenSimDocument, must hold them");
  }
  return *loads;
}

std::string frameName(const Source& source, const Element& force, const char* property,
                      const Model& model) {
  std::string name = osim::readText(source, force, property, "ground");
  name = name.substr(name.find_last_of('/') + 1);
  if (name.empty()) name = "ground";
  const bool isBody = std::any_of(model.bodies.begin(), model.bodies.end(),
                                  [&](const Body& body) { return body.name == name; });
  if (!isBody && name != "ground") {
    osim::fail(source, force,
               fmt::format("{} = '{}', must name a body of the model", property, name),
               force.FirstChildElement(property));
  }
  return name;
}

/// The three columns that begin with what the property says; empty if it is.
std::vector<Eigen::Index> columnsOf(const Source& source, const Element& force,
                                    const char* property, const Table& table,
                                    const std::string& data) {
  const std::string prefix = osim::readText(source, force, property, "");
  std::vector<Eigen::Index> columns;
  if (prefix.empty() || prefix == "Unassigned") return columns;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (table.columns[c].starts_with(prefix)) columns.push_back(static_cast<Eigen::Index>(c));
  }
  if (columns.size() != 3) {
    osim::fail(source, force,
               fmt::format("{} = '{}': {} columns of '{}' begin with it, must be 3", property,
                           prefix, columns.size(), data),
               force.FirstChildElement(property));
  }
  return columns;
}

BodyLoad readLoad(const Source& source, const Element& force, const Model& model,
                  const Table& table, const std::string& data) {
  BodyLoad load;
  load.name = osim::nameOf(source, force);
  load.enabled = osim::readFlag(source, force, "appliesForce", true) &&
                 !osim::readFlag(source, force, "isDisabled", false);
  load.body = frameName(source, force, "applied_to_body", model);
  if (load.body == "ground") {
    osim::fail(source, force, "applied_to_body = 'ground', must name a body of the model",
               force.FirstChildElement("applied_to_body"));
  }
  load.forceFrame = frameName(source, force, "force_expressed_in_body", model);
  load.pointFrame = frameName(source, force, "point_expressed_in_body", model);
  const auto forces = columnsOf(source, force, "force_identifier", table, data);
  const auto points = columnsOf(source, force, "point_identifier", table, data);
  const auto torques = columnsOf(source, force, "torque_identifier", table, data);
  if (forces.empty() && torques.empty()) {
    osim::fail(source, force, "has neither force_identifier nor torque_identifier, must have one");
  }
  if (points.empty()) load.pointFrame = load.body;
  const Eigen::VectorXd times = timesOf(table);
  load.times.assign(times.begin(), times.end());
  for (Eigen::Index k = 0; k < times.size(); ++k) {
    std::array<double, 9> row{};
    std::size_t first = 0;
    for (const auto& columns : {forces, points, torques}) {
      for (std::size_t i = 0; i < columns.size(); ++i) {
        const double number = table.values(k, columns[i]);
        if (!std::isfinite(number)) {
          throw FileError(fmt::format("{}: column '{}' = {} at time {} s, must be finite", data,
                                      table.columns[static_cast<std::size_t>(columns[i])], number,
                                      times[k]));
        }
        row[first + i] = number;
      }
      first += 3;
    }
    load.rows.push_back(row);
  }
  return load;
}

}  // namespace

std::vector<BodyLoad> readExternalLoads(const std::filesystem::path& file, const Model& model,
                                        std::vector<std::string>& warnings) {
  Source source{file.string(), {}};
  tinyxml2::XMLDocument document;
  const std::string text = readTextFile(file);
  if (document.Parse(text.c_str(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw FileError(fmt::format("{}:{}: is not well-formed XML ({})", source.file,
                                document.ErrorLineNum(),
                                tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID())));
  }
  const Element& loads = findLoads(document, source);
  const std::string named = osim::readText(source, loads, "datafile", "");
  if (named.empty()) osim::fail(source, loads, "datafile is missing, must name a .sto or .mot");
  std::filesystem::path data(named);
  if (data.is_relative()) data = file.parent_path() / data;
  const Table table = readTable(data);
  const std::string kinematics =
      osim::readText(source, loads, "external_loads_model_kinematics_file", "");
  if (!kinematics.empty() && kinematics != "Unassigned") {
    warnings.push_back(fmt::format(
        "{}: external_loads_model_kinematics_file is not used: points are read as they stand",
        source.file));
  }
  std::vector<BodyLoad> read;
  for (const Element* force : osim::childrenOf(loads.FirstChildElement("objects"))) {
    if (std::string_view(force->Name()) != "ExternalForce") {
      osim::fail(source, *force, "must be an ExternalForce");
    }
    read.push_back(readLoad(source, *force, model, table, data.string()));
  }
  if (read.empty()) osim::fail(source, loads, "holds no ExternalForce, must hold one");
  return read;
}

void requireLoadsCover(const std::vector<BodyLoad>& loads, double begin, double end) {
  for (const BodyLoad& load : loads) {
    if (!load.enabled || load.times.size() < 2) continue;
    const double margin = 1e-9 * (end - begin);
    if (load.times.front() > begin + margin || load.times.back() < end - margin) {
      throw std::invalid_argument(
          fmt::format("external load '{}': its data are from {} to {} s, must cover the trial's {} "
                      "to {} s",
                      load.name, load.times.front(), load.times.back(), begin, end));
    }
  }
}

}  // namespace bio
