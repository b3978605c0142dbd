// The experiment that tells most about the triceps' wrap radius: ten times the shipped trial's
// knowledge, confirmed by 200 simulated experiments.

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "bio/analysis/replay.h"
#include "bio/design/experiment_design.h"
#include "bio/observation/trial_predictor.h"
#include "bio/opensim/osim_file.h"
#include "info/estimation/monte_carlo.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: design_elbow MODEL TRIAL\n");
    return 2;
  }
  constexpr double degree = std::numbers::pi / 180;
  const bio::Model model = bio::readOsim(argv[1]);
  const bio::SystemOptions systemOptions{{{"elbow_flexion"}, {}}, {}, {}};
  const bio::MusculoskeletalSystem system(model, systemOptions);
  const bio::Trial trial = bio::readTrial(argv[2], model);
  const bio::ParameterCatalogue catalogue(model, system,
                                          {bio::startCoordinates(trial, system, {}), {}});
  bio::SimulationOptions simulation;
  simulation.startTime = trial.times[0];
  simulation.duration = trial.times[trial.times.size() - 1] - trial.times[0];

  bio::DesignQuestion question;
  const double noise = 0.5 * degree;
  question.observed = {{bio::ofCoordinate("elbow_flexion"), noise}};
  question.parameters = {catalogue.find("TRI.radius")};
  bio::DesignLimits limits;
  limits.coordinates = {{"elbow_flexion", 0, 130 * degree}};
  const bio::ExperimentDesign design(system, catalogue, catalogue.nominal(), trial, simulation,
                                     question, limits, {}, 0.3);
  bio::DesignSearchSettings settings;
  settings.generations = 80;
  settings.iterations = 0;
  const bio::DesignResult result = design.search(settings);
  const double before = result.before.bound[0], after = result.after.bound[0];
  fmt::print("bound on TRI.radius: {:.4g} mm before, {:.4g} mm after, factor {:.3g} ({} runs)\n",
             before * 1e3, after * 1e3, before / after, result.runs);
  fmt::print("angle {:.1f} to {:.1f} deg, torque to {:.3g} N m, {:.3g} N m/s\n",
             result.after.ranges[0].lowest / degree, result.after.ranges[0].highest / degree,
             design.inputs().largestTorque(result.after.trial, "elbow_flexion"),
             design.inputs().largestTorqueRate(result.after.trial, "elbow_flexion"));

  // The estimator's experiment is built anew from what the design says.
  simulation.externalForce = bio::externalForceOf(result.after.trial, system);
  const bio::TrialPredictor experiment(
      catalogue, systemOptions, bio::excitationOf(result.after.trial, system), "elbow_flexion",
      {result.after.measuredTimes.begin(), result.after.measuredTimes.end()}, question.parameters,
      simulation);
  info::MonteCarloOptions options;
  options.trials = 200;
  options.startSpread = 0.0005;
  options.estimate.decrementTolerance = 1e-6;
  const info::MonteCarloResult simulated =
      info::monteCarlo(experiment.predictor(), catalogue.values(question.parameters),
                       info::OutputCovariance(Eigen::MatrixXd::Constant(1, 1, noise * noise)),
                       catalogue.asEstimated(question.parameters, false), options);
  const double sd = std::sqrt(simulated.covariance(0, 0));
  fmt::print("{} simulated experiments, {} converged: deviation {:.4g} mm, {:.3g} of the bound\n",
             options.trials, simulated.converged, sd * 1e3, sd / after);

  const bool lowers = result.improved && design.keepsLimits(result.after) && before / after >= 10;
  const bool confirmed = simulated.converged >= 195 && std::abs(sd / after - 1) < 0.3;
  fmt::print("{}\n", lowers && confirmed ? "passed" : "FAILED");
  return lowers && confirmed ? 0 : 1;
}
