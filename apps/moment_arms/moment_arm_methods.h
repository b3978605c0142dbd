#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "bio/analysis/fit_paths.h"
#include "bio/analysis/path_postures.h"
#include "bio/model/model.h"
#include "moment_arms/fit_command.h"
#include "moment_arms/path_jumps.h"
#include "output/methods.h"

namespace app {

/// What is to be said of muscle–tendon lengths and moment arms over one coordinate's range.
/// @param shown  its values, in `unit`
void sayMomentArms(const bio::Model& model, const bio::PathSample& sample,
                   const std::string& coordinate, const Eigen::VectorXd& shown,
                   const std::string& unit, Methods& methods);

/// That OpenSim's lengths were computed, too, and differ.
void sayOpenSimDifferences(const std::vector<bio::OpenSimDifference>& differences,
                           Methods& methods);

/// What is to be said of lengths in given postures.
void sayPostures(const bio::Model& model, const bio::PathPostures& paths, Methods& methods);

/// What is to be said of polynomials in place of paths.
void sayPathFits(const bio::Model& model, const std::vector<bio::MuscleFit>& fits,
                 const FitRequest& request, Methods& methods);

}  // namespace app
