// Where OpenSim's path over an ellipsoid differs from the taut string, muscle by muscle:
//     opensim_differences MODEL.osim POSTURES.csv
// The table is that of posture_tables.cc. Two tables of the muscles that may go over an ellipsoid.
// By OpenSim's own postures: the largest differences of length and of moment arms (slopes of the
// length), and how near OpenSim's rule restated (bio/path/opensim_rule.h) comes to its length.
// Over each coordinate's range, the others at their defaults: what bio/analysis/opensim_paths.h
// finds by that rule, beside our own jumps.
// Differences are OpenSim's less ours. Ends with 1 if less than four fifths of OpenSim's lengths
// (those of paths without a torus) are met to 1e-5 m by its rule restated.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "bio/analysis/opensim_paths.h"
#include "bio/opensim/osim_file.h"
#include "bio/path/length_jumps.h"
#include "bio/path/opensim_rule.h"
#include "bio/path/path.h"
#include "bio/path/posture_samples.h"
#include "bio/path/tree_path.h"
#include "posture_table.h"

namespace {

constexpr double degree = std::numbers::pi / 180;

using validation::PostureTable;

/// Length and slopes of one muscle, ours and by OpenSim's rule.
class Lengths {
 public:
  Lengths(const bio::Model& model, const bio::Skeleton& skeleton, const bio::Muscle& muscle,
          const std::vector<bio::Posture>& postures)
      : skeleton_(skeleton),
        path_(model, skeleton, muscle, {}, postures),
        taut_(skeleton),
        q_(skeleton.defaultValues()) {
    taut_.add(muscle, path_);
  }
  void moveTo(const Eigen::VectorXd& q) {
    q_ = q;
    taut_.moveTo(q);
  }
  /// @throws std::domain_error if there is no taut string
  const bio::LengthJet<Eigen::Dynamic>& ours() { return taut_.length(0); }
  /// NaN if the path has a torus.
  double theirs() const {
    const bio::Posture posture =
        bio::postureOf(skeleton_, std::vector<double>(q_.data(), q_.data() + q_.size()));
    return bio::openSimLength(path_.compiled(), posture)
        .value_or(std::numeric_limits<double>::quiet_NaN());
  }

 private:
  const bio::Skeleton& skeleton_;
  bio::MusclePath path_;
  bio::TreePaths taut_;
  Eigen::VectorXd q_;
};

void keepLarger(double value, double& largest) {
  if (std::abs(value) > std::abs(largest)) largest = value;
}

std::string objectsOf(const bio::Model& model, const bio::Muscle& muscle) {
  std::string names;
  for (const bio::PathWrap& wrap : muscle.path.wraps) {
    if (findWrapObject(model, wrap.wrapObject).shape != bio::WrapShape::ellipsoid) continue;
    names += (names.empty() ? "" : ", ") + wrap.wrapObject;
  }
  return names;
}

class Differences {
 public:
  Differences(const bio::Model& model, PostureTable table)
      : model_(model), table_(std::move(table)), skeleton_(model, options()) {}

  /// @return the share of OpenSim's lengths that its rule restated meets
  double byPostures() {
    int met = 0, all = 0;
    fmt::print(
        "| muscle | ellipsoids | OpenSim's length less ours, of {} postures [mm] | slopes [mm/rad] "
        "| of the rule restated: median, largest error [mm] |\n|---|---|---|---|---|\n",
        table_.rows.size());
    forEach([&](const bio::Muscle& muscle, Lengths& lengths) {
      double length = 0, arm = 0;
      std::vector<double> errors;
      for (std::size_t row = 0; row < table_.rows.size(); ++row) {
        Eigen::VectorXd q(skeleton_.numCoordinates());
        for (int i = 0; i < q.size(); ++i) q[i] = table_.number(row, coordinate(i).name);
        lengths.moveTo(q);
        const double theirs = table_.number(row, muscle.name + ".length_m");
        keepLarger(theirs - lengths.ours().length, length);
        for (int i = 0; i < q.size(); ++i) {
          const std::string column = muscle.name + ".dlength_d." + coordinate(i).name;
          keepLarger(table_.number(row, column) - lengths.ours().dL_dq[i], arm);
        }
        errors.push_back(std::abs(lengths.theirs() - theirs));
      }
      std::sort(errors.begin(), errors.end());
      fmt::print("| {} | {} | {:.3f} | {:.2f} | ", muscle.name, objectsOf(model_, muscle),
                 1000 * length, 1000 * arm);
      if (std::isnan(lengths.theirs())) {
        fmt::print("a torus |\n");
      } else {
        fmt::print("{:.4f}, {:.4f} |\n", 1000 * errors[errors.size() / 2], 1000 * errors.back());
        for (const double error : errors) met += error < 1e-5 ? 1 : 0;
        all += static_cast<int>(errors.size());
      }
    });
    fmt::print("\nmet to 1e-5 m: {} of {} lengths\n", met, all);
    return all > 0 ? static_cast<double>(met) / all : 0;
  }

  void byRanges() const {
    fmt::print(
        "\n| muscle | coordinate | length, by the rule restated [mm] | moment arm [mm] | 0.1 mm "
        "apart [deg] | OpenSim's jumps [mm] | ours [mm] |\n|---|---|---|---|---|---|---|\n");
    const auto ours = bio::lengthJumps(model_, 0);
    for (const bio::OpenSimDifference& one : bio::openSimDifferences(model_)) {
      std::string apart, jumps, ourJumps;
      for (const auto& range : one.apart) {
        apart += fmt::format("{}{:.0f} to {:.0f}", apart.empty() ? "" : ", ", range.from / degree,
                             range.to / degree);
      }
      for (const auto& jump : one.jumps) addJump(jumps, jump.size, jump.at);
      for (const bio::LengthJump& jump : ours) {
        if (jump.muscle != one.muscle || jump.coordinate != one.coordinate) continue;
        addJump(ourJumps, jump.size, jump.value);
      }
      fmt::print("| {} | {} | {:+.3f} | {:+.2f} | {} | {} | {} |\n", one.muscle, one.coordinate,
                 1000 * one.length, 1000 * one.arm, apart, jumps.empty() ? "–" : jumps,
                 ourJumps.empty() ? "–" : ourJumps);
    }
  }

 private:
  const bio::Coordinate& coordinate(int i) const {
    return skeleton_.coordinates()[static_cast<std::size_t>(i)];
  }
  bio::SkeletonOptions options() const {
    bio::SkeletonOptions options;
    options.asTree = true;
    for (const bio::Joint& joint : model_.joints) {
      for (const bio::Coordinate& c : joint.coordinates) {
        if (table_.has(c.name)) options.freeCoordinates.push_back(c.name);
      }
    }
    return options;
  }
  template <class Work>
  void forEach(const Work& work) {
    bio::PostureSamples postures(model_, skeleton_);
    for (const bio::Muscle& muscle : model_.muscles) {
      if (!table_.has(muscle.name + ".length_m") || objectsOf(model_, muscle).empty()) continue;
      Lengths lengths(model_, skeleton_, muscle, postures.of(muscle));
      work(muscle, lengths);
    }
  }

  static void addJump(std::string& list, double size, double at) {
    list += fmt::format("{}{:+.2f} at {:.1f}°", list.empty() ? "" : ", ", 1000 * size, at / degree);
  }

  const bio::Model& model_;
  PostureTable table_;
  bio::Skeleton skeleton_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: opensim_differences MODEL.osim POSTURES.csv\n");
    return 2;
  }
  try {
    const bio::Model model = bio::readOsim(argv[1]);
    Differences differences(model, validation::readPostures(argv[2]));
    const double met = differences.byPostures();
    differences.byRanges();
    return met >= 0.8 ? 0 : 1;
  } catch (const std::exception& e) {
    fmt::print(stderr, "opensim_differences: {}\n", e.what());
    return 2;
  }
}
