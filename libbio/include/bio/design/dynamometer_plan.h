#pragma once

#include <string>
#include <vector>

#include "bio/parameters/parameters.h"
#include "bio/simulation/simulate.h"
#include "bio/tables/table_file.h"

namespace bio {

/// Courses of the experiments that are considered.
namespace dynamometer {
/// Of a contraction [s]: how long the muscles rest before, rise, are held, and what follows.
inline constexpr double rest = 0.5, ramp = 0.3, hold = 2, after = 0.4;
inline constexpr double speedUp = 0.1;     ///< [s] in which a turn reaches its speed, and ends
inline constexpr double longestTurn = 20;  ///< [s]
inline constexpr double excitationAtRest = 0.01;

/// Whether a turn is long enough for its speed to be reached, and ends in time.
/// @param length  [rad] or [m]
/// @param speed   [rad/s] or [m/s]
constexpr bool turnFits(double length, double speed) {
  return length >= speed * speedUp && length <= speed * longestTurn;
}
}  // namespace dynamometer

/// An experiment that a dynamometer can do: it holds or turns the joint, and the moment is
/// measured.
struct DynamometerExperiment {
  enum class Kind { isometric, isokinetic, passive } kind;
  double from = 0, to = 0;  ///< coordinate at begin and end [rad] or [m]
  double speed = 0;         ///< > 0, of the turn; 0: held
  std::string group;        ///< muscles that contract; empty: none
  double effort = 0;        ///< their excitation, 0 to 1
  /// The trial without a moment: time, muscles, coordinate.
  Table trial = {};
  Eigen::MatrixXd fisher = {};  ///< of the moment about the numbers; empty: cannot be simulated
};

struct DynamometerQuestion {
  std::string coordinate;
  std::vector<double> positions;  ///< held at [rad] or [m], rising; turns join the ends
  std::vector<double> speeds;     ///< of turns > 0, each with turnFits()
  std::vector<double> efforts;    ///< excitations, excitationAtRest to 1
  std::vector<std::string> parameters, nuisance;  ///< names or patterns (ParameterCatalogue)
  int count = 4;                                  ///< experiments to choose
  double noise = 0.5;                             ///< of a sample of the moment [N·m] or [N] > 0
  double rate = 100;                              ///< samples of it per second
  int threads = 1;
};

/// What one experiment after the other adds.
struct DynamometerPlan {
  std::vector<ModelParameter> parameters;
  std::size_t candidates = 0, failed = 0;
  std::vector<DynamometerExperiment> chosen;
  std::vector<double> information;      ///< ½ log det ratio that each adds [nats]
  std::vector<Eigen::VectorXd> bounds;  ///< √diag (I + Λ)⁻¹ of the parameters after each
};

/// Ranks all experiments of the lists by what the measured moment tells of the parameters: one
/// after the other, each the one that adds most to what the ones before tell, none twice, since its
/// error of the model would be the same again. Flexors and extensors contract in turn. Nuisance
/// parameters are unknown as well; all have their default priors.
/// @param arm      in which the coordinate is prescribed, and nothing is free
/// @param options  that it was made with
/// @throws std::invalid_argument unknown coordinate or parameters; std::runtime_error if none of
/// the
///   experiments can be simulated
DynamometerPlan planOnDynamometer(const Model& model, const MusculoskeletalSystem& arm,
                                  const SystemOptions& options, const SimulationOptions& simulation,
                                  const DynamometerQuestion& question);

}  // namespace bio
