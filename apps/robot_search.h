#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_context.h"
#include "info/projected_motion.h"
#include "info/systems/laboratory.h"
#include "output_folder.h"
#include "report.h"
#include "robot_trials.h"
#include "summary.h"

/// The search for a robot's motion: from the command line's wishes to a motion found, written down.
namespace app {

/// What `fisherhill robot` optimises, and from where.
struct OptimiseRequest {
  bool pendulum = true;                     ///< else the suspended mass
  bool discrete = false;                    ///< the variational integrator's motion (chapter 5)
  std::optional<double> amplitude, period;  ///< of the start, [m] and [s]
  std::optional<double> perturb;            ///< added to the start's input [unit of the input]
  std::string warmStart;                    ///< a motion_optimised.csv; empty: none
  int trials = 300;

  std::optional<info::InformationWeights> objective;  ///< else the task's own
  std::optional<double> inputWeight;                  ///< R, else the task's own
  std::optional<std::pair<double, double>> limits;    ///< of the input, lower and upper
  std::optional<double> tolerance;                    ///< |DJ·ζ| at which the search ends
  std::optional<int> iterations;                      ///< at most
  int stepsPerSample = 1;                             ///< of the discrete motion

  std::optional<info::CandidateRule> robust;   ///< over these values of θ
  std::vector<Eigen::Vector2d> candidates;     ///< empty: θ, and each parameter ±30 %
  std::optional<info::LaboratoryEffects> lab;  ///< run both motions in the laboratory
};

using Inputs = std::vector<Eigen::VectorXd>;

/// A motion in columns, whichever way of time it came from.
struct TimedMotion {
  double step;  ///< [s]
  std::vector<Eigen::VectorXd> x;
  Inputs u;
  std::vector<Eigen::MatrixXd> grown;  ///< information up to each time
};

/// λ_min at every candidate, of three motions.
struct RobustOutcome {
  std::vector<Eigen::Vector2d> candidates;
  Eigen::VectorXd initial, nominal, robust;
};

/// A search with all that is told about it.
struct Found {
  TimedMotion before, after;
  info::SearchResult search;
  double msPerIteration;
  nlohmann::ordered_json weights;
  std::optional<RobustOutcome> robust;
};

/// Begins a search for these values of θ, from these inputs.
using Projector = std::function<std::unique_ptr<info::ProjectedMotion>(
    const std::vector<Eigen::Vector2d>& theta, const Inputs& start)>;

/// The start: the task's own, another amplitude or period, another motion, a little perturbed; and
/// the wishes about objective, input and limits put into the design.
/// @param amplitude the task's own [m]
Inputs prepare(const OptimiseRequest& request, const CommandContext& context,
               info::MotionDesign& design, double step, double amplitude);

/// Searches; with `robust` also for θ alone, to compare.
/// @throws std::invalid_argument with advice where the start tells nothing
Found find(const OptimiseRequest& request, const Projector& project, const Eigen::Vector2d& theta,
           const info::MotionDesign& design, double step, const Inputs& start,
           const info::SearchOptions& base);

/// motion_initial.csv, motion_optimised.csv and search.json; how the search went, in the summary
/// and the report.
/// @param columns names of the states
void tellSearch(const Found& found, const std::vector<std::string>& columns, Summary& summary,
                Report& report, OutputFolder& folder);

/// Done, or "no" with the figures if nothing was gained.
ExitStatus statusOf(const Found& found, Report& report);

}  // namespace app
