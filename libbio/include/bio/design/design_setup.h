#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bio/design/experiment_design.h"
#include "info/estimation/monte_carlo.h"

/// From the words of a question about an experiment to what a search takes.
namespace bio {

/// Parameters of an experiment by name.
struct DesignNames {
  std::vector<std::string> parameters;     ///< of interest: names or patterns
  std::vector<std::string> nuisance = {};  ///< further unknown ones; those of interest are left out
  bool priors = false;  ///< default priors for the parameters of interest as well
  std::map<std::string, double> priorSd = {};  ///< of any of them, in its unit > 0
};

/// Sets parameters, nuisance parameters and priors. Nuisance parameters have their default priors
/// unless another is given, parameters of interest have none.
/// @param question  what is observed, period, criterion
/// @throws std::invalid_argument for unknown names, a prior that is not > 0, or that of another
///   parameter
DesignQuestion designQuestion(const ParameterCatalogue& catalogue, const DesignNames& names,
                              DesignQuestion question);

/// E, A or D. @throws std::invalid_argument for any other letter
info::Optimality optimalityNamed(const std::string& letter);

/// Numbers of free coordinates by name; that of "" holds for all that are not named.
struct GivenLimits {
  std::map<std::string, std::pair<double, double>> range = {};  ///< default: as in the model
  std::map<std::string, double> torque = {{"", 10}};            ///< ≥ 0
  std::map<std::string, double> speed = {{"", 8.7}};            ///< > 0
};

/// Sets the limits of all free coordinates.
/// @throws std::invalid_argument for a name that is not one of them, a torque on a prescribed
///   one, a range that does not rise, or one without a name where several are free
DesignLimits withCoordinates(DesignLimits limits, const MusculoskeletalSystem& system,
                             const GivenLimits& given);

/// All free coordinates as what is observed.
/// @param angle, shift  noise of rotations [rad] and of others [m]
std::vector<ChannelCandidate> freeCoordinates(const MusculoskeletalSystem& system, double angle,
                                              double shift);

/// Groups by name: "flexors" and "extensors" of the first coordinate, "NAME.flexors" and
/// "NAME.extensors" of another, or names of muscles, "BRA+BRD" for two with one excitation.
std::vector<MuscleGroup> muscleGroups(const MusculoskeletalSystem& system, const Eigen::VectorXd& q,
                                      const std::vector<std::string>& names);

/// Simulates and estimates a designed experiment again and again, to confirm the bounds on the
/// parameters of interest. Estimates have no priors and start within 0.05 % of the truth.
/// @param catalogue   of the design
/// @param system      of its system
/// @param simulation  of the design
/// @param options     trials, seed, threads and progress
/// @throws std::invalid_argument for a design with nuisance parameters; what info::monteCarlo
///   throws
info::MonteCarloResult simulatedRepetitions(const ExperimentDesign& design,
                                            const DesignedExperiment& experiment,
                                            const ParameterCatalogue& catalogue,
                                            const SystemOptions& built,
                                            SimulationOptions simulation,
                                            info::MonteCarloOptions options);

}  // namespace bio
