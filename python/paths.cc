#include <fmt/format.h>

#include <stdexcept>

#include "arguments/columns.h"
#include "arguments/file_name.h"
#include "bio/analysis/fit_paths.h"
#include "docstrings.h"
#include "interruptible.h"
#include "systems.h"

namespace python {
namespace {

/// Columns [rad] or [m] by coordinate, of one length.
bio::PostureTable posturesOf(const bio::Model& model, const py::object& postures) {
  const bio::Table given = tableOf(postures, "postures");
  if (given.columns.empty()) throw std::invalid_argument("postures: no coordinate is given");
  std::map<std::string, Eigen::Index> columns;  // in the order of names
  for (const std::string& name : given.columns) columns.emplace(name, std::ssize(columns));
  bio::PostureTable table;
  table.values.resize(given.values.rows(), given.values.cols());
  for (const auto& [name, column] : columns) {
    bio::findCoordinate(model, name);
    const auto values = given.values.col(column);
    if (values.size() == 0 || !values.allFinite()) {
      throw std::invalid_argument(fmt::format(
          "postures: column '{}' must have at least one row, and finite values only", name));
    }
    table.values.col(std::ssize(table.coordinates)) = values;
    table.coordinates.push_back(name);
  }
  return table;
}

py::object momentArms(const bio::Model& model, const py::object& postures,
                      const std::map<std::string, double>& lock,
                      const std::vector<std::string>& wrapAsCylinder) {
  const bio::PostureTable table = posturesOf(model, postures);
  bio::PathPostures paths;
  interruptible(
      [&](const std::atomic<bool>&) { paths = bio::pathsAt(model, table, lock, wrapAsCylinder); });
  py::dict arms;
  for (std::size_t c = 0; c < paths.coordinates.size(); ++c) {
    Eigen::MatrixXd ofCoordinate(paths.length.rows(), paths.length.cols());
    for (std::size_t m = 0; m < paths.muscles.size(); ++m) {
      ofCoordinate.col(static_cast<Eigen::Index>(m)) =
          -paths.slope[m].col(static_cast<Eigen::Index>(c));
    }
    arms[paths.coordinates[c].c_str()] = ofCoordinate;
  }
  py::dict touched;
  for (std::size_t m = 0; m < paths.muscles.size(); ++m) {
    touched[paths.muscles[m].c_str()] = paths.touched[m];
  }
  return tableResult("MomentArmsResult", "muscles"_a = paths.muscles, "length"_a = paths.length,
                     "moment_arm"_a = arms, "touched"_a = touched, "notes"_a = paths.notes,
                     "warnings"_a = paths.warnings);
}

py::object fitOf(const bio::MuscleFit& fit) {
  std::vector<std::string> coordinates;
  py::object order = py::none(), error = py::none(), armError = py::none();
  if (fit.fit) {
    coordinates = fit.fit->function.coordinates;
    order = py::cast(std::get<bio::MultivariatePolynomial>(fit.fit->function.length).order);
    error = py::cast(fit.fit->length.largest);
    armError = py::cast(fit.fit->arm.largest);
  }
  return results("written"_a = fit.whyNot.empty(), "why_not"_a = fit.whyNot,
                 "coordinates"_a = coordinates, "order"_a = order, "length_error"_a = error,
                 "moment_arm_error"_a = armError);
}

py::object fitPaths(const bio::Model& model, const std::vector<std::string>& muscles,
                    double tolerance, int order, const FileName& table, const Names& coordinate,
                    const std::map<std::string, double>& lock,
                    const std::vector<std::string>& wrapAsCylinder) {
  std::optional<bio::LengthTable> lengths;
  if (!table.text.empty()) {
    if (coordinate != Names(std::vector<std::string>())) {
      throw std::invalid_argument("coordinate: with a table its coordinates are free");
    }
    lengths = bio::readLengths(table.text, model);
  }
  SystemChoice choice;
  if (lengths) {
    choice.coordinates = lengths->postures.coordinates;
    choice.locks = lock;
  } else {
    choice = systemChoice(model, {}, coordinate, lock, "vi", {});
  }
  const bio::SkeletonOptions skeleton = choice.systemOptions().skeleton;
  const bio::PathFitOptions options{tolerance, order};
  std::vector<bio::MuscleFit> fits;
  interruptible([&](const std::atomic<bool>&) {
    fits = lengths ? bio::fitPathsToTable(model, skeleton, *lengths, muscles, options)
                   : bio::fitPaths(model, skeleton, wrapAsCylinder, muscles, options);
  });
  if (fits.empty()) {
    throw std::invalid_argument(
        fmt::format("no muscle is moved by '{}'",
                    choice.coordinates.empty() ? std::string() : choice.coordinates[0]));
  }
  py::dict all;
  for (const bio::MuscleFit& fit : fits) all[fit.muscle.c_str()] = fitOf(fit);
  return results("model"_a = bio::withFittedPaths(model, fits), "fits"_a = all);
}

}  // namespace

void definePaths(py::module_& module) {
  module.def("moment_arms", &momentArms, "model"_a, "postures"_a, py::kw_only(),
             "lock"_a = std::map<std::string, double>(),
             "wrap_as_cylinder"_a = std::vector<std::string>(), docstrings::moment_arms);
  module.def("fit_paths", &fitPaths, "model"_a, py::kw_only(),
             "muscles"_a = std::vector<std::string>(), "tolerance"_a = 1e-4, "order"_a = 9,
             "table"_a = "", "coordinate"_a = std::vector<std::string>(),
             "lock"_a = std::map<std::string, double>(),
             "wrap_as_cylinder"_a = std::vector<std::string>(), docstrings::fit_paths);
}

}  // namespace python
