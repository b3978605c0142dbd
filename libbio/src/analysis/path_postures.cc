#include "bio/analysis/path_postures.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <sstream>

#include "bio/path/path_lengths.h"
#include "bio/path/posture_samples.h"
#include "bio/path/tree_path.h"
#include "bio/tables/file_error.h"
#include "model/listed_names.h"
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

/// A table of texts.
struct Cells {
  std::vector<std::string> names;
  std::size_t header = 0;  // its line
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> lines;
};

Cells readCells(const std::filesystem::path& file) {
  std::vector<std::string> lines;
  std::istringstream text(readTextFile(file));
  for (std::string line; std::getline(text, line);) lines.push_back(std::move(line));
  const auto isBlank = [](const std::string& line) {
    return line.find_first_not_of(" \t\r") == std::string::npos;
  };
  Cells cells;
  while (cells.header < lines.size() && isBlank(lines[cells.header])) ++cells.header;
  if (cells.header == lines.size()) {
    throw FileError(fmt::format("{}: no header line", file.string()));
  }
  cells.names = cellsOf(lines[cells.header], ',');
  for (std::size_t k = cells.header + 1; k < lines.size(); ++k) {
    if (isBlank(lines[k])) continue;
    cells.rows.push_back(cellsOf(lines[k], ','));
    cells.lines.push_back(k);
    if (cells.rows.back().size() != cells.names.size()) {
      throw FileError(fmt::format("{}:{}: {} cells, must be {}", file.string(), k + 1,
                                  cells.rows.back().size(), cells.names.size()));
    }
  }
  return cells;
}

PostureTable postureTable(const Cells& cells, const std::string& file, const Model& model) {
  const auto fail = [&](std::size_t line, const std::string& message) {
    throw FileError(fmt::format("{}:{}: {}", file, line + 1, message));
  };
  const std::vector<std::string>& names = cells.names;
  PostureTable table;
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < names.size(); ++c) {
    if (!coordinateOrNull(model, names[c])) {
      table.ignored.push_back(names[c]);
      continue;
    }
    if (std::find(table.coordinates.begin(), table.coordinates.end(), names[c]) !=
        table.coordinates.end()) {
      fail(cells.header, fmt::format("column '{}' is given twice", names[c]));
    }
    table.coordinates.push_back(names[c]);
    columns.push_back(c);
  }
  if (columns.empty()) fail(cells.header, "no column is named like a coordinate of the model");
  if (cells.rows.empty()) throw FileError(fmt::format("{}: no row", file));
  table.values.resize(static_cast<Eigen::Index>(cells.rows.size()),
                      static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < cells.rows.size(); ++k) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::size_t c = columns[i];
      table.values(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) =
          finiteNumber(file, cells.lines[k] + 1, names[c], cells.rows[k][c]);
    }
  }
  return table;
}

}  // namespace

PostureTable readPostures(const std::filesystem::path& file, const Model& model) {
  return postureTable(readCells(file), file.string(), model);
}

LengthTable readLengths(const std::filesystem::path& file, const Model& model) {
  const Cells cells = readCells(file);
  LengthTable table;
  table.postures = postureTable(cells, file.string(), model);
  const auto columnOf = [&](const std::string& name) {
    return std::find(cells.names.begin(), cells.names.end(), name) - cells.names.begin();
  };
  const auto numColumns = static_cast<std::ptrdiff_t>(cells.names.size());
  const auto read = [&](std::ptrdiff_t column) {
    const auto c = static_cast<std::size_t>(column);
    Eigen::VectorXd values(table.postures.values.rows());
    for (std::size_t k = 0; k < cells.rows.size(); ++k) {
      const std::string& cell = cells.rows[k][c];
      const bool isMissing = cell.empty() || cell == "nan" || cell == "NaN";
      values[static_cast<Eigen::Index>(k)] =
          isMissing ? std::numeric_limits<double>::quiet_NaN()
                    : finiteNumber(file.string(), cells.lines[k] + 1, cells.names[c], cell);
    }
    return values;
  };
  for (const Muscle& muscle : model.muscles) {
    const std::ptrdiff_t length = columnOf(muscle.name + ".length_m");
    if (length == numColumns) continue;
    table.muscles.push_back(muscle.name);
    table.length.conservativeResize(table.postures.values.rows(),
                                    static_cast<Eigen::Index>(table.muscles.size()));
    table.length.rightCols(1) = read(length);
    Eigen::MatrixXd slope(table.postures.values.rows(), 0);
    for (const std::string& coordinate : table.postures.coordinates) {
      const std::ptrdiff_t column = columnOf(muscle.name + ".dlength_d." + coordinate);
      if (column == numColumns) break;
      slope.conservativeResize(Eigen::NoChange, slope.cols() + 1);
      slope.rightCols(1) = read(column);
    }
    const bool isWhole =
        slope.cols() == static_cast<Eigen::Index>(table.postures.coordinates.size()) &&
        !slope.hasNaN();
    table.slope.push_back(isWhole ? slope : Eigen::MatrixXd());
    std::erase_if(table.postures.ignored,
                  [&](const std::string& name) { return name.starts_with(muscle.name + "."); });
  }
  if (table.muscles.empty()) {
    throw FileError(
        fmt::format("{}:{}: no column is named MUSCLE.length_m with a muscle of the model",
                    file.string(), cells.header + 1));
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
  result.notes = adviceOnCylinders(wrapAsCylinder);
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

PathSample samplePaths(const Model& model, const Skeleton& skeleton,
                       const std::vector<std::string>& wrapAsCylinder,
                       const Eigen::VectorXd& values) {
  std::vector<MusclePath> paths;
  std::vector<std::string> unmoved;
  PostureSamples postures(model, skeleton);
  PathSample sample;
  sample.value = values;
  sample.notes = adviceOnCylinders(wrapAsCylinder);
  for (const Muscle& muscle : model.muscles) {
    if (!muscle.enabled) continue;
    std::optional<MusclePath> compiled;
    try {
      compiled.emplace(model, skeleton, muscle, wrapAsCylinder, postures.of(muscle));
    } catch (const UnsupportedWrap& e) {
      sample.warnings.push_back(fmt::format("{}: the muscle is left out", e.what()));
      continue;
    }
    MusclePath& path = *compiled;
    sample.warnings.insert(sample.warnings.end(), path.warnings().begin(), path.warnings().end());
    if (!path.moves()) {
      unmoved.push_back(muscle.name);
      continue;
    }
    sample.notes.insert(sample.notes.end(), path.notes().begin(), path.notes().end());
    sample.muscles.push_back(muscle.name);
    paths.push_back(std::move(path));
  }
  for (std::string& note : unmovedMuscles(unmoved)) sample.notes.push_back(std::move(note));
  const auto n = static_cast<Eigen::Index>(paths.size());
  sample.length.resize(values.size(), n);
  sample.momentArm.resize(values.size(), n);
  sample.momentArmSlope.resize(values.size(), n);
  sample.wrapped.resize(values.size(), n);
  PathLengths lengths(skeleton);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    lengths.add(findMuscle(model, sample.muscles[i]), paths[i]);
  }
  Eigen::VectorXd q = skeleton.defaultValues();
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    q[0] = values[k];
    lengths.moveTo(q);
    for (Eigen::Index i = 0; i < n; ++i) {
      const PathLengths::Along along = lengths.along(static_cast<std::size_t>(i));
      sample.length(k, i) = along.length;
      sample.momentArm(k, i) = -along.slope;
      sample.momentArmSlope(k, i) = -along.curvature;
      sample.wrapped(k, i) = along.wrapped ? 1 : 0;
    }
  }
  return sample;
}

}  // namespace bio
