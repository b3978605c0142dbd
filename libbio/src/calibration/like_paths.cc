#include "calibration/like_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bio/analysis/path_postures.h"

namespace bio {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int mostPoints = 6, mostPostures = 24, gridPoints = 41, goldenSteps = 20;
constexpr double likeness = 5e-3;  ///< RMS difference of lengths [m]

/// Measured values of the coordinates at moments spread over the trials, for pathsAt; empty unless
/// all trials measure the same coordinates.
PostureTable measuredPostures(const TrialSet& trials) {
  PostureTable table;
  std::vector<std::vector<const MeasuredSeries*>> byTrial(trials.trials().size());
  for (const MeasuredSeries& series : trials.series()) {
    if (series.what.kind == Observable::Kind::coordinate) byTrial[series.trial].push_back(&series);
  }
  std::vector<VectorXd> rows;
  const auto each = std::max<Index>(2, mostPostures / std::ssize(byTrial));
  for (const auto& measured : byTrial) {
    const bool isAlike = std::ranges::equal(
        measured, byTrial.front(),
        [](const auto* a, const auto* b) { return a->what.object == b->what.object; });
    if (!isAlike || measured.empty()) return {};
    const Index count = measured.front()->values.size();
    for (Index k = 0; k < std::min(each, count); ++k) {
      VectorXd row(std::ssize(measured));
      for (std::size_t c = 0; c < measured.size(); ++c) {
        const VectorXd& values = measured[c]->values;
        row[static_cast<Index>(c)] = values[k * (values.size() - 1) / std::max<Index>(1, each - 1)];
      }
      rows.push_back(std::move(row));
    }
  }
  for (const MeasuredSeries* series : byTrial.front())
    table.coordinates.push_back(series->what.object);
  table.values.resize(std::ssize(rows), std::ssize(table.coordinates));
  for (std::size_t k = 0; k < rows.size(); ++k) table.values.row(static_cast<Index>(k)) = rows[k];
  return table;
}

/// Lengths of one muscle as a function of one number of the model.
class LengthsOf {
 public:
  LengthsOf(const TrialSet& trials, const PostureTable& postures, const VectorXd& estimate,
            Index place, std::size_t muscle)
      : trials_(trials),
        postures_(postures),
        common_(estimate.head(static_cast<Index>(trials.numCommon()))),
        place_(place),
        muscle_(muscle),
        here_(at(estimate[place])) {}

  /// RMS difference from the lengths at the estimate [m]; infinite where there is no path.
  double distance(double value) const {
    const VectorXd there = at(value);
    if (there.size() != here_.size() || !there.allFinite() || !here_.allFinite() ||
        here_.size() == 0) {
      return std::numeric_limits<double>::infinity();
    }
    return std::sqrt((there - here_).squaredNorm() / static_cast<double>(here_.size()));
  }

 private:
  VectorXd at(double value) const {
    VectorXd theta = common_;
    theta[place_] = value;
    try {
      Model model = trials_.catalogue().at(trials_.selection(), theta).model;
      for (std::size_t i = 0; i < model.muscles.size(); ++i) {
        model.muscles[i].enabled = i == muscle_;
      }
      const PathPostures paths = pathsAt(model, postures_, trials_.options().skeleton.lockedValues,
                                         trials_.options().wrapAsCylinder);
      return paths.length.cols() == 1 ? VectorXd(paths.length.col(0)) : VectorXd();
    } catch (const std::invalid_argument&) {
      return {};
    }
  }

  const TrialSet& trials_;
  const PostureTable& postures_;
  VectorXd common_;
  Index place_;
  std::size_t muscle_;
  VectorXd here_;
};

struct LikeValue {
  double value;
  double distance;  ///< [m]
};

/// The minimum between two values, by the golden section.
LikeValue nearestBetween(const LengthsOf& lengths, double low, double high) {
  const double golden = (std::sqrt(5) - 1) / 2;
  double a = high - golden * (high - low), b = low + golden * (high - low);
  double atA = lengths.distance(a), atB = lengths.distance(b);
  for (int i = 0; i < goldenSteps; ++i) {
    if (atA < atB) {
      high = b, b = a, atB = atA;
      a = high - golden * (high - low);
      atA = lengths.distance(a);
    } else {
      low = a, a = b, atA = atB;
      b = low + golden * (high - low);
      atB = lengths.distance(b);
    }
  }
  return atA < atB ? LikeValue{a, atA} : LikeValue{b, atB};
}

/// Lowest minimum between the bounds, but for the one at `estimate`.
std::optional<double> likeValue(const LengthsOf& lengths, const info::Parameter& parameter,
                                double estimate) {
  const double spacing = (parameter.upper - parameter.lower) / (gridPoints - 1);
  if (!(spacing > 0 && std::isfinite(spacing))) return {};
  std::vector<double> distance;
  for (int k = 0; k < gridPoints; ++k) {
    distance.push_back(lengths.distance(parameter.lower + k * spacing));
  }
  std::optional<double> best;
  double least = likeness;
  for (std::size_t k = 1; k + 1 < distance.size(); ++k) {
    const bool isLowest = distance[k] < distance[k - 1] && distance[k] <= distance[k + 1];
    const double middle = parameter.lower + static_cast<double>(k) * spacing;
    if (!isLowest || std::abs(middle - estimate) <= spacing) continue;
    const LikeValue found = nearestBetween(lengths, middle - spacing, middle + spacing);
    if (found.distance >= least) continue;
    least = found.distance;
    best = found.value;
  }
  return best;
}

}  // namespace

std::vector<VectorXd> startsAtLikePaths(const TrialSet& trials,
                                        const std::vector<info::Parameter>& parameters,
                                        const VectorXd& estimate) {
  std::vector<VectorXd> starts;
  PostureTable postures;
  int looked = 0;
  for (std::size_t i = 0; i < trials.numCommon() && looked < mostPoints; ++i) {
    const ModelParameter& parameter = trials.catalogue().parameters()[trials.selection()[i]];
    const auto* point = std::get_if<PointTarget>(&parameter.targets.front());
    if (!point || parameter.targets.size() > 1) continue;
    if (++looked == 1) postures = measuredPostures(trials);
    if (postures.values.size() == 0) return {};
    const auto place = static_cast<Index>(i);
    const LengthsOf lengths(trials, postures, estimate, place, point->muscle);
    if (const auto value = likeValue(lengths, parameters[i], estimate[place])) {
      starts.push_back(estimate);
      starts.back()[place] = *value;
    }
  }
  return starts;
}

}  // namespace bio
