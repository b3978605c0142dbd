#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bio/analysis/path_postures.h"
#include "bio/model/model.h"
#include "bio/path/path_fit.h"
#include "bio/skeleton/skeleton.h"

namespace bio {

/// Outcome of the fit of one muscle's path.
struct MuscleFit {
  std::string muscle;
  std::optional<PathFit> fit;
  std::string whyNot;  ///< empty: the fit is within the tolerance
};

/// Polynomials in place of paths (fitPolynomial), each over the free coordinates that change it and
/// their ranges: 400 postures or twice as many as it can have terms, denser towards the ends of the
/// ranges, and half as many others with all corners to judge it. Locked coordinates stay where they
/// are, so the polynomial holds for these values only.
/// @param muscles  names; empty: all that are enabled and move
/// @throws std::invalid_argument what Skeleton and MusclePath throw, an unknown muscle
std::vector<MuscleFit> fitPaths(const Model& model, const SkeletonOptions& options,
                                const std::vector<std::string>& wrapAsCylinder,
                                const std::vector<std::string>& muscles,
                                const PathFitOptions& fitOptions);

/// Polynomials for lengths of a table, which must vary all coordinates that can change the path;
/// every fifth posture only judges it.
/// @param muscles  names; empty: all of the table
std::vector<MuscleFit> fitPathsToTable(const Model& model, const SkeletonOptions& options,
                                       const LengthTable& table,
                                       const std::vector<std::string>& muscles,
                                       const PathFitOptions& fitOptions);

/// The model with the polynomials that are within the tolerance.
Model withFittedPaths(Model model, const std::vector<MuscleFit>& fits);

}  // namespace bio
