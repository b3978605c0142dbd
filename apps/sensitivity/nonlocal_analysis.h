#pragma once

#include <string>
#include <vector>

#include "bio/calibration/trial_predictor.h"
#include "command/command.h"
#include "sensitivity/sensitivity_report.h"

namespace app {

/// How much worse the best fit to the model's own motion becomes as a parameter is held elsewhere,
/// within three joint bounds.
/// @param held   its place in the selection
/// @param noise  standard deviation of the observed coordinate [rad] or [m]
ProfileFinding likelihoodProfile(const std::vector<bio::TrialPredictor>& experiments,
                                 const bio::ParameterCatalogue& catalogue,
                                 const std::vector<std::size_t>& selection, Eigen::Index held,
                                 double noise);

struct GlobalQuestion {
  std::string method;  ///< morris, sobol or both
  int samples;
  double shown;  ///< factor of the observation's unit
};

/// Each parameter even over its value ± √3 prior deviations, within its bounds.
GlobalFinding globalSensitivity(const std::vector<bio::TrialPredictor>& experiments,
                                const bio::ParameterCatalogue& catalogue,
                                const std::vector<std::size_t>& selection,
                                const GlobalQuestion& question, const CommandContext& context);

}  // namespace app
