#include "bio/analysis/fit_paths.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "bio/path/length_jumps.h"
#include "bio/path/posture_samples.h"
#include "bio/path/tree_path.h"

namespace bio {
namespace {

/// Postures of some coordinates over their ranges, one row each.
Eigen::MatrixXd rangesOf(const std::vector<Coordinate>& coordinates, std::size_t count,
                         bool atEnds) {
  const std::size_t d = coordinates.size();
  const std::size_t corners = atEnds ? std::size_t{1} << d : 0;
  Eigen::MatrixXd q(static_cast<Eigen::Index>(count + corners), static_cast<Eigen::Index>(d));
  constexpr double primes[] = {2, 3, 5, 7, 11, 13};
  for (std::size_t i = 0; i < d; ++i) {
    const Coordinate& c = coordinates[i];
    const double wide = c.isRotation ? std::numbers::pi : 1.0;
    const double low = std::max(c.rangeMin, c.defaultValue - wide);
    const double high = std::min(c.rangeMax, c.defaultValue + wide);
    const auto column = static_cast<Eigen::Index>(i);
    for (std::size_t k = 0; k < count; ++k) {
      // evenly spread, one list between the values of the other
      const double step = d == 1 ? 1 / static_cast<double>(count) : std::sqrt(primes[i]);
      const double x = (static_cast<double>(k) + (atEnds ? 0.5 : 0.25)) * step;
      const double part = x - std::floor(x);
      const double dense = (1 - std::cos(std::numbers::pi * part)) / 2;
      q(static_cast<Eigen::Index>(k), column) = low + (high - low) * (atEnds ? part : dense);
    }
    for (std::size_t k = 0; k < corners; ++k) {
      q(static_cast<Eigen::Index>(count + k), column) = ((k >> i) & 1u) != 0 ? high : low;
    }
  }
  return q;
}

/// Our lengths of one path.
class PathSampler {
 public:
  PathSampler(const Model& model, const Skeleton& skeleton, const Muscle& muscle,
              const std::vector<std::string>& wrapAsCylinder, PostureSamples& postures)
      : skeleton_(skeleton),
        path_(model, skeleton, muscle, wrapAsCylinder, postures.of(muscle)),
        lengths_(skeleton) {
    lengths_.add(muscle, path_);
    lengths_.moveTo(skeleton.defaultValues());
    support_ = lengths_.length(0).support;
  }

  bool moves() const { return path_.moves() && !support_.empty(); }
  const std::vector<int>& support() const { return support_; }

  /// Without postures in which there is no taut string.
  SampledPath sample(std::size_t count, bool atEnds) {
    std::vector<Coordinate> coordinates;
    SampledPath path;
    for (const int k : support_) {
      coordinates.push_back(skeleton_.coordinates()[static_cast<std::size_t>(k)]);
      path.coordinates.push_back(coordinates.back().name);
    }
    path.q = rangesOf(coordinates, count, atEnds);
    path.length.resize(path.q.rows());
    path.slope.resize(path.q.rows(), path.q.cols());
    Eigen::VectorXd q = skeleton_.defaultValues();
    Eigen::Index used = 0;
    for (Eigen::Index k = 0; k < path.q.rows(); ++k) {
      for (std::size_t i = 0; i < support_.size(); ++i) {
        q[support_[i]] = path.q(k, static_cast<Eigen::Index>(i));
      }
      lengths_.moveTo(q);
      try {
        const LengthJet<Eigen::Dynamic>& at = lengths_.length(0);
        path.q.row(used) = path.q.row(k).eval();
        path.length[used] = at.length;
        for (std::size_t i = 0; i < support_.size(); ++i) {
          path.slope(used, static_cast<Eigen::Index>(i)) = at.dL_dq[support_[i]];
        }
        ++used;
      } catch (const std::domain_error&) {
        ++lost_;
      }
    }
    path.q.conservativeResize(used, Eigen::NoChange);
    path.length.conservativeResize(used);
    path.slope.conservativeResize(used, Eigen::NoChange);
    return path;
  }
  int lost() const { return lost_; }

 private:
  const Skeleton& skeleton_;
  MusclePath path_;
  TreePaths lengths_;
  std::vector<int> support_;
  int lost_ = 0;
};

std::string millimetres(double length) {
  return fmt::format("{:.3g} mm", 1000 * length);
}

/// Why a fit is not good enough, with the first jump of the length if it has one.
std::string reason(const Model& model, const std::string& muscle, const PathFit& fit) {
  std::string text =
      fmt::format("off by up to {} at the best order", millimetres(fit.length.largest));
  for (const std::string& name : fit.function.coordinates) {
    const Coordinate& c = findCoordinate(model, name);
    try {
      const Skeleton skeleton(model, {.freeCoordinates = {name}, .lockedValues = {}});
      for (const LengthJump& jump : lengthJumps(model, skeleton, {}, c.rangeMin, c.rangeMax)) {
        if (jump.muscle == muscle) return text + "; " + describe(jump);
      }
    } catch (const std::invalid_argument&) {  // the coordinate alone cannot be free
    }
  }
  return text;
}

MuscleFit fitted(const Model& model, const std::string& muscle, const SampledPath& path,
                 const SampledPath& held, const PathFitOptions& options) {
  MuscleFit result{muscle, {}, {}};
  try {
    result.fit = fitPolynomial(path, held, options);
  } catch (const std::invalid_argument& error) {
    result.whyNot = error.what();
    return result;
  }
  if (!result.fit->meetsTolerance) result.whyNot = reason(model, muscle, *result.fit);
  return result;
}

bool isWanted(const std::vector<std::string>& wanted, const std::string& muscle) {
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), muscle) != wanted.end();
}

/// The table's rows that have a length of the muscle, those to fit and every fifth to judge.
void splitRows(const LengthTable& table, std::size_t muscle,
               const std::vector<Eigen::Index>& columns, SampledPath& fit, SampledPath& held) {
  const auto at = static_cast<Eigen::Index>(muscle);
  const Eigen::MatrixXd& slope = table.slope[muscle];
  std::vector<Eigen::Index> rows[2];
  for (Eigen::Index k = 0; k < table.length.rows(); ++k) {
    if (!std::isnan(table.length(k, at))) rows[k % 5 == 4 ? 1 : 0].push_back(k);
  }
  for (SampledPath* part : {&fit, &held}) {
    const std::vector<Eigen::Index>& mine = rows[part == &held ? 1 : 0];
    part->q = table.postures.values(mine, columns);
    part->length = table.length(mine, at);
    if (slope.rows() > 0) part->slope = slope(mine, columns);
    for (const Eigen::Index c : columns) {
      part->coordinates.push_back(table.postures.coordinates[static_cast<std::size_t>(c)]);
    }
  }
}

}  // namespace

std::vector<MuscleFit> fitPaths(const Model& model, const SkeletonOptions& options,
                                const std::vector<std::string>& wrapAsCylinder,
                                const std::vector<std::string>& muscles,
                                const PathFitOptions& fitOptions) {
  for (const std::string& name : muscles) findMuscle(model, name);
  SkeletonOptions asTree = options;
  asTree.asTree = true;
  const Skeleton skeleton(model, asTree);
  PostureSamples postures(model, skeleton);
  std::vector<MuscleFit> fits;
  for (const Muscle& muscle : model.muscles) {
    if (!muscle.enabled || !isWanted(muscles, muscle.name)) continue;
    try {
      PathSampler sampler(model, skeleton, muscle, wrapAsCylinder, postures);
      if (!sampler.moves()) {
        if (!muscles.empty()) fits.push_back({muscle.name, {}, "no free coordinate moves it"});
        continue;
      }
      const auto d = static_cast<int>(sampler.support().size());
      const auto terms = MultivariatePolynomial::numTerms(d, fitOptions.maxOrder);
      const std::size_t count = std::clamp<std::size_t>(2 * terms.value_or(1000), 400, 3000);
      if (d > MultivariatePolynomial::maxDimension) {
        fits.push_back({muscle.name,
                        {},
                        fmt::format("{} coordinates change it, at most {} can", d,
                                    MultivariatePolynomial::maxDimension)});
        continue;
      }
      const SampledPath path = sampler.sample(count, false);
      const SampledPath held = sampler.sample(count / 2, true);
      fits.push_back(fitted(model, muscle.name, path, held, fitOptions));
      if (sampler.lost() > 0 && fits.back().whyNot.empty()) {
        fits.back().whyNot =
            fmt::format("no taut string in {} of {} postures", sampler.lost(), count + count / 2);
      }
    } catch (const UnsupportedWrap& error) {
      fits.push_back({muscle.name, {}, error.what()});
    } catch (const std::domain_error& error) {  // in the default posture
      fits.push_back({muscle.name, {}, error.what()});
    }
  }
  return fits;
}

std::vector<MuscleFit> fitPathsToTable(const Model& model, const SkeletonOptions& options,
                                       const LengthTable& table,
                                       const std::vector<std::string>& muscles,
                                       const PathFitOptions& fitOptions) {
  for (const std::string& name : muscles) findMuscle(model, name);
  SkeletonOptions asTree = options;
  asTree.asTree = true;
  asTree.freeCoordinates = table.postures.coordinates;
  const Skeleton skeleton(model, asTree);
  std::vector<MuscleFit> fits;
  for (const std::string& name : muscles) {
    if (std::find(table.muscles.begin(), table.muscles.end(), name) == table.muscles.end()) {
      fits.push_back({name, {}, "the table has no lengths of it"});
    }
  }
  for (std::size_t m = 0; m < table.muscles.size(); ++m) {
    const std::string& name = table.muscles[m];
    if (!isWanted(muscles, name)) continue;
    std::vector<Eigen::Index> columns;
    for (const int k : pathSupport(model, skeleton, findMuscle(model, name))) {
      const std::string& coordinate = skeleton.coordinates()[static_cast<std::size_t>(k)].name;
      const auto& all = table.postures.coordinates;
      columns.push_back(std::find(all.begin(), all.end(), coordinate) - all.begin());
    }
    if (columns.empty()) {
      fits.push_back({name, {}, "no coordinate of the table moves it"});
      continue;
    }
    SampledPath path, held;
    splitRows(table, m, columns, path, held);
    fits.push_back(fitted(model, name, path, held, fitOptions));
  }
  return fits;
}

Model withFittedPaths(Model model, const std::vector<MuscleFit>& fits) {
  for (const MuscleFit& fit : fits) {
    if (!fit.fit || !fit.whyNot.empty()) continue;
    for (Muscle& muscle : model.muscles) {
      if (muscle.name != fit.muscle) continue;
      muscle.path = {};
      muscle.path.function = fit.fit->function;
    }
  }
  return model;
}

}  // namespace bio
