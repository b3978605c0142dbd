// Muscle–tendon lengths of a model against a table of OpenSim's own:
//     posture_tables MODEL.osim POSTURES.csv
// The table has a column for each coordinate; NAME.length_m, NAME.wrapped (wrap objects touched,
// joined by |; - for none) and NAME.dlength_d.COORDINATE for each path. Prints a table of our
// length less OpenSim's, by what OpenSim's path touches. A taut string over the same objects is no
// longer than any other path past them, so each row in which ours is longer than OpenSim's by more
// than 1e-6 m is examined:
//   shorter than its points  OpenSim's length is below that of straight lines through the points
//   through an object        it is below that of the taut string over one of the objects alone
//   sum of chords            OpenSim adds chords of about 1 mm, and ours added so is not longer
//   tangent cylinder         OpenSim takes a torus for the cylinder that touches its ring
// Other rows are printed. Ends with 1 if those are more than 2 % of all rows, if any of a path that
// touches nothing or a sphere is off by 2e-6 m, or if a path has no length.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include "bio/opensim/osim_file.h"
#include "bio/path/path_length.h"
#include "posture_table.h"

namespace {

using validation::PostureTable;
using validation::readPostures;
using validation::split;

struct Deviations {
  int rows = 0, longer = 0;
  double most = 0, least = 0, squares = 0;  // ours less OpenSim's [m]
};

// A posture of the free coordinates.
template <int N>
struct MovedSkeleton {
  Eigen::Matrix<double, N, 1> q;
  std::vector<bio::RigidMotion<double, N>> moved;

  MovedSkeleton(const bio::Skeleton& skeleton, const PostureTable& table, std::size_t row)
      : moved(skeleton.numSegments()) {
    for (int i = 0; i < N; ++i) {
      const std::string& name = skeleton.coordinates()[static_cast<std::size_t>(i)].name;
      q[i] = std::stod(*table.find(row, name));
    }
    skeleton.motions<double, N>(q, moved.data());
  }
};

// By how much the arcs of a path are longer than their chords, of 1 mm or a little more.
template <int N>
double lossOfChords(const bio::CompiledPath& path, const MovedSkeleton<N>& at) {
  constexpr double chord = 1e-3;
  double loss = 0;
  unsigned used = 0;
  for (const bio::PathSpan& span : bio::activeVariant(path, at.q).moving) {
    if (span.chain < 0) continue;
    const bio::PathChain& chain = path.chains[static_cast<std::size_t>(span.chain)];
    const auto end = [&](std::size_t node) {
      const bio::PathNode& n = path.nodes[node];
      return bio::detail::spanEnd<double, N>(path, n, n.p_S, at.q, at.moved.data()).jet.value;
    };
    const auto X_GC = bio::detail::chainInGround<N>(path, chain, at.moved.data());
    const bio::PlacedChain placed = bio::placeChain(path, chain, X_GC);
    const bio::ChainPath taut =
        bio::tautChain(path, chain, placed, X_GC, end(span.a), end(span.b), used);
    for (std::size_t i = 0; i < static_cast<std::size_t>(taut.numContacts); ++i) {
      const bio::ChainContact& contact = taut.contacts[i];
      const bio::ChainObject& object = placed.objects[static_cast<std::size_t>(contact.object)];
      const Eigen::Vector3d A = object.intoFrame(contact.A);
      const Eigen::Vector3d u = object.R_GS.transpose() * contact.atA.u;
      const int n = std::max(1, static_cast<int>((contact.B - contact.A).norm() / chord));
      Eigen::Vector3d from = A;
      loss += contact.arc;
      for (int k = 1; k <= n; ++k) {
        const Eigen::Vector3d to = bio::shootGeodesic(object.surface, A, u, contact.arc * k / n).x;
        loss -= (to - from).norm();
        from = to;
      }
    }
  }
  return loss;
}

// The same for a path over one ellipsoid with equal axes, which is a sphere here.
template <int N>
double lossOnSphere(const bio::MusclePath& path, const MovedSkeleton<N>& at) {
  if (path.compiled().surfaces.size() != 1 || !path.compiled().surfaces[0].isSphere) return 0;
  const auto lengthWith = [&](double step) {
    const auto points = path.pathPoints<N>(at.q, at.moved.data(), step);
    double length = 0;
    for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
    return length;
  };
  return path.length<N>(at.q, at.moved.data()).length -
         lengthWith(1e-3 / path.compiled().surfaces[0].radius);
}

class Comparison {
 public:
  Comparison(const bio::Model& model, PostureTable table)
      : model_(model), table_(std::move(table)) {
    for (const bio::Joint& joint : model.joints) {
      for (const bio::Coordinate& c : joint.coordinates) {
        const bool isInTable =
            std::find(table_.columns.begin(), table_.columns.end(), c.name) != table_.columns.end();
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
      switch (std::min<std::size_t>(coordinates.size(), 4)) {
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
    fmt::print(
        "| touched in OpenSim | rows | ours longer by > 1e-6 m | most | least | RMS [mm] |\n");
    fmt::print("|---|---|---|---|---|---|\n");
    int rows = 0;
    for (const auto& [name, d] : classes_) {
      fmt::print("| {} | {} | {} | {:.6f} | {:.6f} | {:.6f} |\n", name, d.rows, d.longer,
                 1000 * d.most, 1000 * d.least, 1000 * std::sqrt(d.squares / d.rows));
      rows += d.rows;
    }
    for (const auto& [why, count] : explained_) fmt::print("{}: {} rows\n", why, count);
    fmt::print("not explained: {} of {} rows\nfailed: {}\n", unexplained_, rows, failed_);
    fmt::print("nothing or a sphere, off by 2e-6 m and not explained: {}\n", wrong_);
    holds = holds && wrong_ == 0 && unexplained_ <= 0.02 * rows && rows > 0;
    return holds;
  }

 private:
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
          for (std::size_t at = row; at < last; ++at) compare<N>(at, *muscle, path, skeleton);
        } catch (const std::exception& e) {
          fmt::print("from row {}: {}: {}\n", row, muscle->name, e.what());
          ++failed_;
        }
      }
    }
  }

  std::string kindOf(const std::vector<std::string>& objects) const {
    if (objects.empty()) return "nothing";
    std::string kind;
    for (const std::string& name : objects) {
      const bio::WrapObject& object = findWrapObject(model_, name);
      if (object.shape == bio::WrapShape::torus) return "a torus, or one of several";
      if (object.shape == bio::WrapShape::ellipsoid) {
        kind = "an ellipsoid, or several with one";
      } else if (kind.empty()) {
        kind = object.shape == bio::WrapShape::cylinder ? "a cylinder" : "a sphere";
      } else if (kind != "an ellipsoid, or several with one") {
        kind = "several cylinders or spheres";
      }
    }
    return kind;
  }

  template <int N>
  void compare(std::size_t row, const bio::Muscle& muscle, const bio::MusclePath& path,
               const bio::Skeleton& skeleton) {
    const double theirs = std::stod(*table_.find(row, muscle.name + ".length_m"));
    const std::string& touched = *table_.find(row, muscle.name + ".wrapped");
    const auto objects = touched == "-" ? std::vector<std::string>{} : split(touched, '|');
    const MovedSkeleton<N> at(skeleton, table_, row);
    const double deviation = path.length<N>(at.q, at.moved.data()).length - theirs;
    const std::string kind = kindOf(objects);
    Deviations& d = classes_[kind];
    ++d.rows;
    d.most = std::max(d.most, deviation);
    d.least = std::min(d.least, deviation);
    d.squares += deviation * deviation;
    const bool isExact = kind == "nothing" || kind == "a sphere";
    if (isExact && deviation < -2e-6) {
      ++wrong_;
      tell(row, muscle, touched, deviation, "");
    }
    if (!(deviation > 1e-6)) return;
    ++d.longer;
    const std::string why = explanation<N>(muscle, path, skeleton, at, theirs, kind);
    if (!why.empty()) {
      ++explained_[why];
      return;
    }
    ++unexplained_;
    if (isExact && deviation > 2e-6) ++wrong_;
    tell(row, muscle, touched, deviation, ": not explained");
  }

  // Why OpenSim's path is shorter than a taut string; empty: unknown.
  template <int N>
  std::string explanation(const bio::Muscle& muscle, const bio::MusclePath& path,
                          const bio::Skeleton& skeleton, const MovedSkeleton<N>& at, double theirs,
                          const std::string& kind) {
    const double ours = path.length<N>(at.q, at.moved.data()).length;
    const double loss = lossOfChords<N>(path.compiled(), at) + lossOnSphere<N>(path, at);
    if (ours - loss < theirs + 1e-6) return "sum of chords";
    const auto longest = [&](const std::vector<bio::PathWrap>& wraps) {
      bio::Muscle other = muscle;
      other.path.wraps = wraps;
      const bio::MusclePath alone(model_, skeleton, other, {});
      return alone.length<N>(at.q, at.moved.data()).length;
    };
    if (longest({}) > theirs + 1e-6) return "shorter than its points";
    if (muscle.path.wraps.size() > 1) {
      for (const bio::PathWrap& wrap : muscle.path.wraps) {
        if (longest({wrap}) > theirs + 1e-6) return "through an object";
      }
    }
    return kind.starts_with("a torus") ? "tangent cylinder" : "";
  }

  void tell(std::size_t row, const bio::Muscle& muscle, const std::string& touched,
            double deviation, const std::string& what) const {
    fmt::print("row {}: {} over {}: {:+.4f} mm{}\n", row, muscle.name, touched, 1000 * deviation,
               what);
  }

  const bio::Model& model_;
  PostureTable table_;
  std::vector<std::string> coordinates_;
  std::map<std::string, Deviations> classes_;
  std::map<std::string, int> explained_;
  int failed_ = 0, unexplained_ = 0, wrong_ = 0;
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
