#include "bio/analysis/path_postures.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <sstream>

#include "bio/path/posture_samples.h"
#include "bio/path/tree_path.h"
#include "bio/tables/file_error.h"
#include "tables/recording_layouts.h"
#include "tables/text_file.h"

namespace bio {
namespace {

/// All paths that can be compiled.
std::vector<MusclePath> compileAll(const Model& model, const Skeleton& skeleton,
                                   const std::vector<std::string>& wrapAsCylinder,
                                   PathPostures& result) {
  std::vector<MusclePath> paths;
  PostureSamples samples(model, skeleton);
  for (const Muscle& muscle : model.muscles) {
    if (!muscle.enabled) continue;
    try {
      paths.emplace_back(model, skeleton, muscle, wrapAsCylinder, samples.of(muscle));
    } catch (const UnsupportedWrap& e) {
      result.warnings.push_back(fmt::format("{}: the muscle is left out", e.what()));
      continue;
    }
    const MusclePath& path = paths.back();
    result.muscles.push_back(muscle.name);
    result.notes.insert(result.notes.end(), path.notes().begin(), path.notes().end());
    result.warnings.insert(result.warnings.end(), path.warnings().begin(), path.warnings().end());
  }
  return paths;
}

}  // namespace

PostureTable readPostures(const std::filesystem::path& file, const Model& model) {
  std::vector<std::string> lines;
  std::istringstream text(readTextFile(file));
  for (std::string line; std::getline(text, line);) lines.push_back(std::move(line));
  const auto fail = [&](std::size_t line, const std::string& message) {
    throw FileError(fmt::format("{}:{}: {}", file.string(), line + 1, message));
  };
  const auto isBlank = [](const std::string& line) {
    return line.find_first_not_of(" \t\r") == std::string::npos;
  };
  std::size_t header = 0;
  while (header < lines.size() && isBlank(lines[header])) ++header;
  if (header == lines.size()) throw FileError(fmt::format("{}: no header line", file.string()));
  const std::vector<std::string> names = cellsOf(lines[header], ',');
  PostureTable table;
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < names.size(); ++c) {
    if (!coordinateOrNull(model, names[c])) {
      table.ignored.push_back(names[c]);
      continue;
    }
    if (std::find(table.coordinates.begin(), table.coordinates.end(), names[c]) !=
        table.coordinates.end()) {
      fail(header, fmt::format("column '{}' is given twice", names[c]));
    }
    table.coordinates.push_back(names[c]);
    columns.push_back(c);
  }
  if (columns.empty()) fail(header, "no column is named like a coordinate of the model");

  std::vector<std::vector<double>> rows;
  for (std::size_t k = header + 1; k < lines.size(); ++k) {
    if (isBlank(lines[k])) continue;
    const std::vector<std::string> cells = cellsOf(lines[k], ',');
    if (cells.size() != names.size()) {
      fail(k, fmt::format("{} cells, must be {}", cells.size(), names.size()));
    }
    std::vector<double> row;
    for (const std::size_t c : columns) {
      row.push_back(finiteNumber(file.string(), k + 1, names[c], cells[c]));
    }
    rows.push_back(std::move(row));
  }
  if (rows.empty()) throw FileError(fmt::format("{}: no row", file.string()));
  table.values.resize(static_cast<Eigen::Index>(rows.size()),
                      static_cast<Eigen::Index>(columns.size()));
  for (Eigen::Index k = 0; k < table.values.rows(); ++k) {
    for (Eigen::Index c = 0; c < table.values.cols(); ++c) {
      table.values(k, c) = rows[static_cast<std::size_t>(k)][static_cast<std::size_t>(c)];
    }
  }
  return table;
}

PathPostures pathsAt(const Model& model, const PostureTable& postures,
                     const std::map<std::string, double>& locked,
                     const std::vector<std::string>& wrapAsCylinder) {
  SkeletonOptions options;
  options.freeCoordinates = postures.coordinates;
  options.lockedValues = locked;
  options.asTree = true;
  const Skeleton skeleton(model, options);
  PathPostures result;
  result.coordinates = postures.coordinates;
  const std::vector<MusclePath> paths = compileAll(model, skeleton, wrapAsCylinder, result);
  TreePaths lengths(skeleton);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    lengths.add(findMuscle(model, result.muscles[i]), paths[i]);
  }

  const Eigen::Index numPostures = postures.values.rows();
  const auto numMuscles = static_cast<Eigen::Index>(paths.size());
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  result.length = Eigen::MatrixXd::Constant(numPostures, numMuscles, nan);
  result.slope.assign(paths.size(),
                      Eigen::MatrixXd::Constant(numPostures, postures.values.cols(), nan));
  result.touched.assign(
      paths.size(), std::vector<std::vector<std::string>>(static_cast<std::size_t>(numPostures)));
  for (Eigen::Index k = 0; k < numPostures; ++k) {
    const Eigen::VectorXd q = postures.values.row(k);
    const Posture posture = postureOf(skeleton, {q.begin(), q.end()});
    lengths.moveTo(q);
    for (std::size_t i = 0; i < paths.size(); ++i) {
      try {
        const LengthJet<Eigen::Dynamic>& length = lengths.length(i);
        result.length(k, static_cast<Eigen::Index>(i)) = length.length;
        result.slope[i].row(k) = length.dL_dq;
        const Muscle& muscle = findMuscle(model, result.muscles[i]);
        for (const std::size_t wrap : paths[i].touchedWraps(posture)) {
          result.touched[i][static_cast<std::size_t>(k)].push_back(
              muscle.path.wraps[wrap].wrapObject);
        }
      } catch (const std::domain_error& e) {
        result.warnings.push_back(
            fmt::format("posture {}: {}: {}", k + 1, result.muscles[i], e.what()));
      }
    }
  }
  return result;
}

}  // namespace bio
