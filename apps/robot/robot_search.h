#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command/command_context.h"
#include "info/design/projected_motion.h"
#include "output/output_folder.h"
#include "output/summary.h"
#include "report/report.h"
#include "robot/robot_trials.h"
#include "robots/laboratory.h"

/// The search for a robot's motion, from the options of the command line to the written result.
namespace app {

/// What `fisherhill robot` optimises, and the initial motion.
struct OptimiseRequest {
  bool pendulum = true;                     ///< else the suspended mass
  bool discrete = false;                    ///< the variational integrator's motion (chapter 5)
  std::optional<double> amplitude, period;  ///< of the initial motion, [m] and [s]
  std::optional<double> perturb;            ///< added to the initial input [unit of the input]
  std::string warmStart;                    ///< a motion_optimised.csv; empty: none
  int trials = 300;

  std::optional<info::InformationWeights> objective;  ///< else the task's own
  std::optional<double> inputWeight;                  ///< R, else the task's own
  std::optional<std::pair<double, double>> limits;    ///< of the input, lower and upper
  std::optional<double> tolerance;                    ///< |DJ·ζ| at which the search ends
  std::optional<int> iterations;                      ///< at most
  int stepsPerSample = 1;                             ///< of the discrete motion

  std::optional<info::RobustRule> robust;      ///< over these values of θ
  std::vector<Eigen::Vector2d> candidates;     ///< empty: θ, and each parameter ±30 %
  std::optional<info::LaboratoryEffects> lab;  ///< simulate both motions in the laboratory
};

using Inputs = std::vector<Eigen::VectorXd>;

/// A motion in columns, from continuous or discrete time.
struct TimedMotion {
  double step;  ///< [s]
  std::vector<Eigen::VectorXd> x;
  Inputs u;
  std::vector<Eigen::MatrixXd> grown;  ///< information up to each time
};

/// λ_min for every set of parameter values, for three motions.
struct RobustOutcome {
  std::vector<Eigen::Vector2d> candidates;
  Eigen::VectorXd initial, nominal, robust;
};

/// A search and its results.
struct Found {
  TimedMotion before, after;
  info::SearchResult search;
  double msPerIteration;
  nlohmann::ordered_json weights;
  std::optional<RobustOutcome> robust;
};

/// Starts a search for these values of θ, from these inputs.
using Projector = std::function<std::unique_ptr<info::ProjectedMotion>(
    const std::vector<Eigen::Vector2d>& theta, const Inputs& start)>;

/// Sets the initial motion (the task's own, another amplitude or period, another motion, or a
/// perturbed one), and the objective, input weight and limits of the design.
/// @param amplitude the task's own [m]
Inputs prepare(const OptimiseRequest& request, const CommandContext& context,
               info::MotionDesign& design, double step, double amplitude);

/// Runs the search; with `robust` also for θ alone, for comparison.
/// @throws std::invalid_argument with advice, if the initial motion has no information
Found find(const OptimiseRequest& request, const Projector& project, const Eigen::Vector2d& theta,
           const info::MotionDesign& design, double step, const Inputs& start,
           const info::SearchOptions& base);

/// Writes motion_initial.csv, motion_optimised.csv and search.json, and adds the course of the
/// search to the summary and the report.
/// @param columns names of the states
void tellSearch(const Found& found, const std::vector<std::string>& columns, Summary& summary,
                Report& report, OutputFolder& folder);

/// `done`, or `answerIsNo` with the reason in the report if there was no progress.
ExitStatus statusOf(const Found& found, Report& report);

}  // namespace app
