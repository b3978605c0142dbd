#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bio/analysis/replay.h"
#include "bio/observation/channel_information.h"
#include "bio/observation/parameter_information.h"
#include "bio/observation/trial_predictor.h"
#include "bio/tables/trial.h"
#include "info/estimation/profile_likelihood.h"
#include "info/probability/global_sensitivity.h"

/// The study of `fisherhill sensitivity`: how parameters move what is measured of trials, locally,
/// over a range and along a profile, and what the measurement tells of them.
namespace bio {

/// A trial, ready to be simulated with other parameters.
struct StudiedTrial {
  std::string file;              ///< for messages
  ParameterCatalogue catalogue;  ///< with the trial's initial state
  RecordedTrial recorded;
  std::vector<double> times;  ///< at which something is measured [s]
};

/// The trial from its first row to its last, sampled when the system's first coordinate was
/// measured; if it was not, at every step.
/// @param simulation  integrator, step and progress
/// @throws std::invalid_argument what excitationOf, externalForceOf and prescribedMotionOf throw
StudiedTrial studiedTrial(const Trial& trial, const Model& model,
                          const MusculoskeletalSystem& system, const StartPoint& start,
                          SimulationOptions simulation);

/// Channels by the names that they have as columns of a trial, with the noise of their samples.
/// @param named  (name, standard deviation in unitOf() > 0) each
/// @throws std::invalid_argument for what cannot be measured of the system, or a noise that is not
///   > 0
std::vector<ChannelCandidate> observedChannels(
    const std::vector<std::pair<std::string, double>>& named, const Model& model,
    const MusculoskeletalSystem& system);

/// The measured quantities, and the parameters.
struct SensitivityQuestion {
  SystemOptions system;
  std::string coordinate;                       ///< free; measured if `observed` is empty
  double noise = 0.017453292519943295;          ///< of the coordinate [rad] or [m] > 0
  std::vector<ChannelCandidate> observed = {};  ///< measured instead of the coordinate
  std::vector<std::size_t> selection = {};      ///< of the first trial's catalogue
};

/// What is measured of the trial: the coordinate, or channel after channel.
std::vector<ObservedSeries> observedSeries(const StudiedTrial& trial,
                                           const SensitivityQuestion& question);

/// From parameters to what is measured of the trial.
/// @throws std::invalid_argument what TrialPredictor throws
TrialPredictor predictorOf(const StudiedTrial& trial, const SensitivityQuestion& question);
std::vector<TrialPredictor> predictorsOf(const std::vector<StudiedTrial>& trials,
                                         const SensitivityQuestion& question);

/// Near the model's values.
struct LocalSensitivity {
  std::vector<TrialPredictor::Linearised> trials;  ///< what is measured and dy/dθ, in their units
  /// Information of all trials. With SensitivityQuestion::observed, sensitivities are in standard
  /// deviations of the noise.
  ParameterInformation information;
};
/// @param progress  called with the fraction of the trials that are done
/// @throws std::invalid_argument for no trial, a simulation that does not reach the end of one, a
///   noise that is not > 0
LocalSensitivity localSensitivity(const std::vector<StudiedTrial>& trials,
                                  const SensitivityQuestion& question,
                                  const std::function<void(double)>& progress = {});

/// usualChannels() without what is observed already.
std::vector<ChannelCandidate> furtherChannels(const MusculoskeletalSystem& system,
                                              const SensitivityQuestion& question);
/// Gains of each further channel beside what is observed, at the same times.
/// @param system    of question.system
/// @param known  from localSensitivity()
std::vector<ChannelGain> furtherGains(const std::vector<StudiedTrial>& trials,
                                      const MusculoskeletalSystem& system,
                                      const SensitivityQuestion& question,
                                      const ParameterInformation& before);
/// Whether channelGains() would take longer than a second or two.
bool gainsTakeLong(std::size_t parameters, std::size_t channels);

/// One value of a swept parameter.
struct SweepRun {
  double value;
  Trajectory motion;
  double rms = 0;      ///< RMS difference of the first coordinate from the model's own motion
  double largest = 0;  ///< largest difference [rad] or [m]
};
struct Sweep {
  ModelParameter parameter;
  Trajectory nominal;
  std::vector<SweepRun> runs;
};
/// @throws std::invalid_argument for a value outside the parameter's bounds, saying why
void requireWithinBounds(const ModelParameter& parameter, const std::vector<double>& values);
/// The trial's motion with the parameter at each value, all others as in the model.
/// @param index  of the catalogue
/// @throws what requireWithinBounds(), MusculoskeletalSystem and simulate() throw
Sweep parameterSweep(const StudiedTrial& trial, const SystemOptions& options, std::size_t index,
                     const std::vector<double>& values,
                     const std::function<void(double)>& progress = {});

/// Profile likelihood of a parameter.
struct ProfileFinding {
  info::Parameter parameter;
  info::Profile profile;
  /// Whether the data bound the parameter within the values tried.
  bool boundedBelow() const;
  bool boundedAbove() const;
};
/// How much worse the best fit to the model's own motion becomes as a parameter is held elsewhere:
/// at thirteen values within three joint bounds.
/// @param question  of a coordinate
/// @param held      place of the parameter in the selection
/// @param goOn      asked after each iteration of an estimate; false ends it
ProfileFinding likelihoodProfile(const std::vector<StudiedTrial>& trials,
                                 const SensitivityQuestion& question, Eigen::Index held,
                                 const std::function<bool()>& goOn = {});

/// A parameter's place in the selection.
/// @throws std::invalid_argument for an unknown name, or one that is not in it
Eigen::Index indexInSelection(const std::vector<std::size_t>& selection,
                              const ParameterCatalogue& catalogue, const std::string& name);

/// Sobol's points have at most twice so many dimensions.
inline constexpr std::size_t mostGlobalParameters = 32;

struct GlobalQuestion {
  bool morris = true, sobol = true;  ///< what is computed
  double unit = 1;                   ///< factor of what is measured
  info::EnsembleOptions ensemble = {};
};
/// Global sensitivity of the same parameters.
struct GlobalFinding {
  std::optional<info::MorrisResult> morris;
  std::optional<info::SobolResult> sobol;
  /// Runs that did not reach the end and were left out.
  int undefined() const;
};
/// Each parameter even over its value ± √3 prior standard deviations, within its bounds.
/// @throws std::invalid_argument for no or more than mostGlobalParameters parameters, fewer than
///   two samples
GlobalFinding globalSensitivity(const std::vector<StudiedTrial>& trials,
                                const SensitivityQuestion& question, const GlobalQuestion& global);

}  // namespace bio
