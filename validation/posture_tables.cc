// Muscle–tendon lengths of a model against a table of OpenSim's own:
//     posture_tables MODEL.osim POSTURES.csv
// The table has a column for each coordinate, and NAME.length_m and NAME.wrapped for each path
// (wrap objects touched, joined by |; - for none). Paths are compared in three classes: nothing or
// only cylinders and spheres touched (OpenSim is a geodesic or, over cylinders, nearly one), an
// ellipsoid or a torus touched (OpenSim's path is a plane section, which is no shorter than the
// geodesic), and several objects touched at once. Prints a table and each row in which our path
// is longer than OpenSim's by more than 1e-6 m. Ends with 1 if those are more than 2 % of the rows
// of a class with ellipsoids, or if a length of the first class is off by 2e-6 m.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "bio/opensim/osim_file.h"
#include "bio/path/path_length.h"

namespace {

struct PostureTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;

  const std::string* find(std::size_t row, const std::string& column) const {
    const auto at = std::find(columns.begin(), columns.end(), column);
    if (at == columns.end()) return nullptr;
    return &rows[row][static_cast<std::size_t>(at - columns.begin())];
  }
};

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(line);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

PostureTable readPostures(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file);
  PostureTable table;
  std::string line;
  std::getline(in, line);
  table.columns = split(line, ',');
  while (std::getline(in, line)) table.rows.push_back(split(line, ','));
  return table;
}

struct Deviations {
  int rows = 0, longer = 0;
  double mostLonger = 0, mostShorter = 0;  // ours less OpenSim's [m]
};

class Comparison {
 public:
  Comparison(const bio::Model& model, PostureTable table)
      : model_(model), table_(std::move(table)) {
    for (const bio::Joint& joint : model.joints) {
      for (const bio::Coordinate& c : joint.coordinates) {
        const bool isInTable = std::find(table_.columns.begin(), table_.columns.end(), c.name) !=
                               table_.columns.end();
        if (isInTable) coordinates_.push_back(c.name);
      }
    }
  }

  void run() {
    if (coordinates_.empty()) throw std::runtime_error("no column is a coordinate of the model");
    std::map<std::vector<std::string>, std::vector<const bio::Muscle*>> groups;
    for (const bio::Muscle& muscle : model_.muscles) {
      if (table_.find(0, muscle.name + ".length_m") == nullptr) continue;
      groups[coordinatesOf(muscle)].push_back(&muscle);
    }
    for (const auto& [coordinates, muscles] : groups) {
      switch (std::min<std::size_t>(coordinates.size(), bio::maxFreeCoordinates)) {
        case 1:
          runFree<1>(coordinates, muscles);
          break;
        case 2:
          runFree<2>(coordinates, muscles);
          break;
        case 3:
          runFree<3>(coordinates, muscles);
          break;
        default:
          runFree<4>(coordinates, muscles);
      }
    }
  }

  bool report() const {
    bool holds = failed_ == 0;
    fmt::print("| touched in OpenSim | rows | ours longer by > 1e-6 m | longest | shortest [mm] |\n");
    fmt::print("|---|---|---|---|---|\n");
    for (const auto& [name, d] : classes_) {
      fmt::print("| {} | {} | {} | {:.6f} | {:.6f} |\n", name, d.rows, d.longer,
                 1000 * d.mostLonger, 1000 * d.mostShorter);
      if (name == bent) holds = holds && d.longer <= 0.02 * d.rows;
      if (name == none) holds = holds && std::max(d.mostLonger, -d.mostShorter) < 2e-6;
    }
    fmt::print("failed: {}\n", failed_);
    return holds;
  }

 private:
  static constexpr const char* none = "nothing, or one cylinder or sphere a span";
  static constexpr const char* bent = "an ellipsoid or a torus";
  static constexpr const char* several = "several objects, no ellipsoid";

  // Those that change the muscle's length somewhere in the table.
  std::vector<std::string> coordinatesOf(const bio::Muscle& muscle) const {
    constexpr double noise = 1e-8;  // of the table's differences [m/rad]
    std::vector<std::string> moving;
    for (const std::string& name : coordinates_) {
      for (std::size_t row = 0; row < table_.rows.size(); ++row) {
        const std::string* slope = table_.find(row, muscle.name + ".dlength_d." + name);
        if (slope == nullptr || !(std::abs(std::stod(*slope)) > noise)) continue;
        moving.push_back(name);
        break;
      }
    }
    if (moving.empty()) moving.push_back(coordinates_.front());
    return moving;
  }

  // The first N of the muscles' coordinates are free; others stay where the row has them.
  template <int N>
  void runFree(const std::vector<std::string>& coordinates,
               const std::vector<const bio::Muscle*>& muscles) {
    const bool allFree = coordinates.size() == N;
    for (std::size_t row = 0; row < table_.rows.size(); row += allFree ? table_.rows.size() : 1) {
      bio::SkeletonOptions options;
      for (std::size_t i = 0; i < coordinates.size(); ++i) {
        if (i < N) {
          options.freeCoordinates.push_back(coordinates[i]);
        } else {
          options.lockedValues[coordinates[i]] = std::stod(*table_.find(row, coordinates[i]));
        }
      }
      const bio::Skeleton skeleton(model_, options);
      const auto postures = bio::samplePostures(skeleton);
      for (const bio::Muscle* muscle : muscles) {
        try {
          const bio::MusclePath path(model_, skeleton, *muscle, {}, postures);
          const std::size_t last = allFree ? table_.rows.size() : row + 1;
          for (std::size_t at = row; at < last; ++at) {
            add(at, *muscle, lengthIn<N>(at, skeleton, path));
          }
        } catch (const std::exception& e) {
          fmt::print("from row {}: {}: {}\n", row, muscle->name, e.what());
          ++failed_;
        }
      }
    }
  }

  template <int N>
  double lengthIn(std::size_t row, const bio::Skeleton& skeleton, const bio::MusclePath& path) {
    Eigen::Matrix<double, N, 1> q;
    for (int i = 0; i < N; ++i) {
      const std::string& name = skeleton.coordinates()[static_cast<std::size_t>(i)].name;
      q[i] = std::stod(*table_.find(row, name));
    }
    std::vector<bio::RigidMotion<double, N>> moved(skeleton.numSegments());
    skeleton.motions<double, N>(q, moved.data());
    return path.length<N>(q, moved.data()).length;
  }

  void add(std::size_t row, const bio::Muscle& muscle, double length) {
    const double deviation = length - std::stod(*table_.find(row, muscle.name + ".length_m"));
    const std::string& touched = *table_.find(row, muscle.name + ".wrapped");
    const auto objects = touched == "-" ? std::vector<std::string>{} : split(touched, '|');
    bool isBent = false;
    for (const std::string& name : objects) {
      const bio::WrapShape shape = findWrapObject(model_, name).shape;
      isBent = isBent || shape == bio::WrapShape::ellipsoid || shape == bio::WrapShape::torus;
    }
    const char* kind = isBent ? bent : objects.size() > 1 ? several : none;
    Deviations& d = classes_[kind];
    ++d.rows;
    d.mostLonger = std::max(d.mostLonger, deviation);
    d.mostShorter = std::min(d.mostShorter, deviation);
    if (deviation > 1e-6) ++d.longer;
    if (deviation > 1e-6 || deviation < (kind == none ? -2e-6 : -1e-3)) {
      fmt::print("row {}: {} over {}: {:+.4f} mm\n", row, muscle.name, touched, 1000 * deviation);
    }
  }

  const bio::Model& model_;
  PostureTable table_;
  std::vector<std::string> coordinates_;
  std::map<std::string, Deviations> classes_;
  int failed_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: posture_tables MODEL.osim POSTURES.csv\n");
    return 2;
  }
  try {
    const bio::Model model = bio::readOsim(argv[1]);
    Comparison comparison(model, readPostures(argv[2]));
    comparison.run();
    return comparison.report() ? 0 : 1;
  } catch (const std::exception& e) {
    fmt::print(stderr, "posture_tables: {}\n", e.what());
    return 2;
  }
}
