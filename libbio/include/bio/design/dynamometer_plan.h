#pragma once

#include <string>
#include <vector>

#include "bio/parameters/parameters.h"
#include "bio/simulation/simulate.h"
#include "bio/tables/table_file.h"

namespace bio {

/// Courses of the experiments that are considered.
namespace dynamometer {
/// Times of a contraction [s]: rest before it, its rise, its hold, and what follows.
inline constexpr double rest = 0.5, ramp = 0.3, hold = 2, after = 0.4;
/// Times of a quick release [s]: how long the contraction is held before and after it.
inline constexpr double beforeRelease = 1, afterRelease = 1;
/// Times of an isotonic contraction [s]: how long the angle is measured at most, and at least.
inline constexpr double longestIsotonic = 1, shortestIsotonic = 0.1;
inline constexpr double speedUp = 0.1;     ///< [s] in which a turn reaches its speed, and ends
inline constexpr double longestTurn = 20;  ///< [s]
inline constexpr double excitationAtRest = 0.01;

/// Whether a turn is long enough for its speed to be reached, and ends in time.
/// @param length  [rad] or [m]
/// @param speed   [rad/s] or [m/s]
constexpr bool turnFits(double length, double speed) {
  return length >= speed * speedUp && length <= speed * longestTurn;
}

/// How long a quick release takes [s]: its speed rises and falls as a squared sine.
/// @param length  [rad] or [m]
/// @param speed   the largest, in the middle [rad/s] or [m/s]
constexpr double releaseTime(double length, double speed) {
  return 2 * length / speed;
}
/// Whether at least eight samples fall into a release.
/// @param rate  samples per second
constexpr bool releaseIsSampled(double length, double speed, double rate) {
  return releaseTime(length, speed) * rate >= 8 - 1e-9;
}
}  // namespace dynamometer

/// An experiment that a dynamometer can do.
///
///     isometric   holds the joint, muscles contract                        the moment is measured
///     isokinetic  turns the joint at constant speed, muscles contract      the moment is measured
///     passive     turns it, muscles relaxed                                the moment is measured
///     release     holds the joint, lets it move a short way fast in the
///                 direction in which the contracted muscles shorten, and
///                 holds it again                                           the moment is measured
///     isotonic    holds the joint until the muscles' moment is steady,
///                 then lets it go against a constant torque, smaller than
///                 that moment                                              the angle is measured
///
/// The trial of an isotonic contraction begins where the joint is let go: at rest, with steady
/// activations and fibres. It ends before the coordinate would leave its range.
struct DynamometerExperiment {
  enum class Kind { isometric, isokinetic, passive, release, isotonic } kind;
  /// Coordinate at begin and end [rad] or [m]; isotonic: the end as predicted.
  double from = 0, to = 0;
  double speed = 0;        ///< > 0, of the turn; of a release the largest; 0: held, or free
  std::string group = {};  ///< muscles that contract; empty: none
  double effort = 0;       ///< their excitation, 0 to 1
  double load = 0;         ///< isotonic: the torque over that which holds the joint, 0 to 1
  double torque = 0;       ///< isotonic: on the coordinate, in its direction [N·m] or [N]
  /// The trial: time, muscles, coordinate. Isotonic: the torque, too, and the coordinate as
  /// predicted; else without the moment.
  Table trial = {};
  Eigen::MatrixXd fisher = {};  ///< of what is measured about the numbers; empty: not simulated

  bool measuresAngle() const { return kind == Kind::isotonic; }
};

struct DynamometerQuestion {
  using Kind = DynamometerExperiment::Kind;
  std::string coordinate;
  std::vector<Kind> kinds = {Kind::isometric, Kind::isokinetic, Kind::passive, Kind::release,
                             Kind::isotonic};  ///< that are considered
  std::vector<double> positions;  ///< held at [rad] or [m], rising; turns join the ends
  std::vector<double> speeds;     ///< of turns > 0, each with turnFits()
  std::vector<double> efforts;    ///< excitations, excitationAtRest to 1
  std::vector<double> releases;   ///< lengths of releases > 0 [rad] or [m], from each position
  double releaseSpeed = 0;        ///< their largest speed, with releaseIsSampled()
  std::vector<double> loads;      ///< of isotonic contractions, of what holds the joint, 0 to 1
  std::vector<std::string> parameters, nuisance;  ///< names or patterns (ParameterCatalogue)
  int count = 4;                                  ///< experiments to choose
  double noise = 0.5;                             ///< of a sample of the moment [N·m] or [N] > 0
  double angleNoise = 0.01;  ///< of a sample of the coordinate [rad] or [m] > 0
  double rate = 100;         ///< samples per second
  /// Isotonic contractions: the joint is free within the coordinate's range and up to this speed
  /// [rad/s] or [m/s], even if the parameters are off by `robustness` prior standard deviations, to
  /// first order (as DesignLimits says).
  double fastest = 8.7, robustness = 0.5;
  int threads = 1;
};

/// Experiments chosen one after the other, and what each adds.
struct DynamometerPlan {
  std::vector<ModelParameter> parameters;
  std::size_t candidates = 0, failed = 0;
  /// Candidates that would leave the coordinate's range or are too fast within 0.1 s of being let
  /// go, or whose muscles do not carry the limb.
  std::size_t unsuitable = 0;
  std::vector<DynamometerExperiment> chosen;
  std::vector<double> information;      ///< ½ log det ratio that each adds [nats]
  std::vector<Eigen::VectorXd> bounds;  ///< √diag (I + Λ)⁻¹ of the parameters after each
};

/// Ranks all experiments of the lists by what the measured moment or angle tells of the parameters:
/// one after the other, each the one that adds most to what the ones before tell, none twice, since
/// its error of the model would be the same again. Flexors and extensors contract in turn. Nuisance
/// parameters are unknown as well; all have their default priors.
/// @param system      in which the coordinate is prescribed, and nothing is free
/// @param options  that it was made with
/// @throws std::invalid_argument unknown coordinate or parameters, lists out of their range, a
///   coordinate that cannot be free although isotonic contractions are considered;
///   std::runtime_error if none of the experiments can be simulated
DynamometerPlan planOnDynamometer(const Model& model, const MusculoskeletalSystem& system,
                                  const SystemOptions& options, const SimulationOptions& simulation,
                                  const DynamometerQuestion& question);

}  // namespace bio
