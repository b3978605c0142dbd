// Where OpenSim's path over an ellipsoid differs from the taut string, muscle by muscle:
//     opensim_differences MODEL.osim POSTURES.csv
// The table is that of posture_tables.cc. For each muscle that may go over an ellipsoid, two
// tables:
//   by OpenSim's own postures: the largest differences of length and of moment arms (slopes of the
//   length), and how near OpenSim's rule restated (bio/path/opensim_rule.h) comes to OpenSim's
//   length by the rule restated, over each coordinate's range, the others at their defaults: the
//   largest differences, where the lengths are 0.1 mm apart or more, and jumps of OpenSim's length
//   and ours
// Differences are OpenSim's less ours. Ends with 1 if less than four fifths of OpenSim's lengths
// (those of paths without a torus) are met to 1e-5 m by its rule restated, with 77 if a file is not
// there.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "bio/opensim/osim_file.h"
#include "bio/path/opensim_rule.h"
#include "bio/path/path.h"
#include "bio/path/posture_samples.h"
#include "bio/path/tree_path.h"
#include "posture_table.h"

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double apart = 1e-4;  // [m]

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
  double theirs() const { return theirsAt(q_); }
  /// NaN at a jump.
  double theirSlope(int coordinate) const {
    constexpr double h = 1e-5, corner = 5e-3;  // [rad], [m/rad]
    Eigen::VectorXd above = q_, below = q_;
    above[coordinate] += h;
    below[coordinate] -= h;
    const double here = theirs();
    const double ahead = (theirsAt(above) - here) / h, behind = (here - theirsAt(below)) / h;
    return std::abs(ahead - behind) < corner ? (ahead + behind) / 2
                                             : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  double theirsAt(const Eigen::VectorXd& q) const {
    const bio::Posture posture =
        bio::postureOf(skeleton_, std::vector<double>(q.data(), q.data() + q.size()));
    return bio::openSimLength(path_.compiled(), posture)
        .value_or(std::numeric_limits<double>::quiet_NaN());
  }
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

  void byRanges() {
    fmt::print(
        "\n| muscle | coordinate | length, by the rule restated [mm] | moment arm [mm] | 0.1 mm "
        "apart [deg] | OpenSim's jumps [mm] | ours [mm] |\n|---|---|---|---|---|---|---|\n");
    forEach([&](const bio::Muscle& muscle, Lengths& lengths) {
      if (std::isnan(lengths.theirs())) return;
      for (const int i : bio::pathSupport(model_, skeleton_, muscle))
        alongRange(muscle, lengths, i);
    });
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

  // Where a length jumps between two values that its slope does not join.
  struct Sample {
    double at, theirs, ours, slope;
  };
  Sample sample(Lengths& lengths, int i, double value) const {
    Eigen::VectorXd q = skeleton_.defaultValues();
    q[i] = value;
    lengths.moveTo(q);
    try {
      const auto& ours = lengths.ours();
      return {value, lengths.theirs(), ours.length, ours.dL_dq[i]};
    } catch (const std::domain_error&) {  // no taut string
      constexpr double nan = std::numeric_limits<double>::quiet_NaN();
      return {value, nan, nan, nan};
    }
  }
  template <class Of>
  std::string jumps(Lengths& lengths, int i, const std::vector<Sample>& samples,
                    const Of& of) const {
    std::string found;
    for (std::size_t k = 1; k < samples.size(); ++k) {
      Sample low = samples[k - 1], high = samples[k];
      const auto rise = [&](const Sample& a, const Sample& b) {
        return std::abs(of(b) - of(a) - 0.5 * (a.slope + b.slope) * (b.at - a.at));
      };
      if (!(rise(low, high) > 0.2 * apart)) continue;
      while (high.at - low.at > 1e-7) {
        const Sample middle = sample(lengths, i, 0.5 * (low.at + high.at));
        (rise(low, middle) > rise(middle, high) ? high : low) = middle;
      }
      const double size = of(high) - of(low);
      if (std::abs(size) < 0.2 * apart) continue;
      found += fmt::format("{}{:+.2f} at {:.1f}°", found.empty() ? "" : ", ", 1000 * size,
                           low.at / degree);
    }
    return found.empty() ? "–" : found;
  }

  void alongRange(const bio::Muscle& muscle, Lengths& lengths, int i) const {
    const bio::Coordinate& c = coordinate(i);
    const int n =
        std::max(1, static_cast<int>(std::ceil((c.rangeMax - c.rangeMin) / (0.2 * degree))));
    std::vector<Sample> samples;
    double length = 0, arm = 0, from = 0, to = 0;
    bool isApart = false;
    std::string ranges;
    const auto close = [&] {
      if (isApart) {
        ranges += fmt::format("{}{:.0f} to {:.0f}", ranges.empty() ? "" : ", ", from / degree,
                              to / degree);
      }
      isApart = false;
    };
    for (int k = 0; k <= n; ++k) {
      samples.push_back(sample(lengths, i, c.rangeMin + (c.rangeMax - c.rangeMin) * k / n));
      const Sample& s = samples.back();
      keepLarger(s.theirs - s.ours, length);
      keepLarger(s.slope - lengths.theirSlope(i), arm);
      if (!(std::abs(s.theirs - s.ours) >= apart)) {
        close();
        continue;
      }
      if (!isApart) from = s.at;
      to = s.at;
      isApart = true;
    }
    close();
    if (std::abs(length) < 1e-5) return;
    fmt::print("| {} | {} | {:+.3f} | {:+.2f} | {} | {} | {} |\n", muscle.name, c.name,
               1000 * length, 1000 * arm, ranges.empty() ? "–" : ranges,
               jumps(lengths, i, samples, [](const Sample& s) { return s.theirs; }),
               jumps(lengths, i, samples, [](const Sample& s) { return s.ours; }));
    std::fflush(stdout);
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
  for (const char* file : {argv[1], argv[2]}) {
    if (std::filesystem::exists(file)) continue;
    fmt::print("opensim_differences: skipped, there is no {}\n", file);
    return 77;
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
