#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bio/discovery/predicted_experiments.h"
#include "info/discovery/discover.h"
#include "info/discovery/likelihood/fitted_numbers.h"
#include "output/summary.h"
#include "report/report.h"

namespace app {

/// A measured output as the report shows it.
struct ShownOutput {
  std::string name;  ///< e.g. "elbow_flexion"
  std::string unit;  ///< e.g. "deg"
  double scale = 1;  ///< factor from internal values to shown ones
};

/// A coordinate on which a latent force may act, as the report shows it.
struct ShownAxis {
  std::string name;       ///< e.g. "elbow_flexion"
  std::string unit;       ///< e.g. "deg"
  double scale = 1;       ///< factor from internal values to shown ones
  std::string position;   ///< "angle", or "position" of one that slides
  std::string force;      ///< the latent force: "Torque [N·m]"
  std::string forceUnit;  ///< "N·m"
  bool isTorque = false;  ///< the force on it; false: a force or an acceleration
  std::size_t place = 0;  ///< in EffectSize::moments
  /// Suffix of names in verdict.json: "_deg" or "_m".
  std::string end() const { return "_" + unit; }
};

/// Words and units of the report, for one kind of system.
struct DiscoverWording {
  std::vector<ShownOutput> outputs;  ///< by DiscoveryProblem::outputOfSample
  std::vector<ShownAxis> axes;       ///< by DiscoveryProblem::axes
  double unit = 1;                   ///< factor from internal RMS errors to shown ones
  std::string errorUnit;  ///< their unit; "sd" if there are several outputs, whose errors are in
                          ///< standard deviations of their noise
  std::string errorEnd;   ///< suffix of names in verdict.json: "_deg", "_m", "_N", …, or "_sd"
  std::string ofForce;    ///< unit of the latent force's size: "fraction of the muscles' moments"
  std::string push;       ///< disturbance that a score tests: "a push"
  std::string inputs, input;                   ///< "muscles", "muscle"
  std::string commands;                        ///< the inputs: "excitations"
  bool hasMap = true;                          ///< false: no score map over an axis and its rate
  std::map<std::string, std::string> present;  ///< effects that the model already has, and where
  /// Name in verdict.json of a quantity that is the time of a change: "starts_at_s", "ends_at_s".
  std::map<std::size_t, std::string> times;

  bool isInNoise() const { return errorEnd == "_sd"; }
  /// ", NAME" where there are several axes.
  std::string named(std::size_t axis) const {
    return axes.size() > 1 ? ", " + axes[axis].name : "";
  }
};

struct WrittenDiscovery;

/// The findings with their inputs.
struct DiscoverFindings {
  const std::string& modelFile;
  const std::vector<std::string>& trialFiles;  ///< those held out last
  const info::discover::DiscoveryProblem& data;
  const DiscoverWording& wording;
  const info::discover::Options& options;
  const info::discover::Verdict& verdict;
  const std::string& nextExperiment;
  const std::vector<bio::discover::PredictedExperiment>& predictedExperiments;
  double wallSeconds;       ///< of the search
  double processorSeconds;  ///< of the search, which has one thread
  const std::vector<info::discover::FittedNumber>& fitted;
  const WrittenDiscovery* written = nullptr;  ///< for musculoskeletal models
  double step = 0;                            ///< time step of the final search [s]
  std::vector<Figure> excitations = {};       ///< of the first trial fitted and the first held out
  std::optional<Playback> playback = {};      ///< of a model with bodies to draw
};

/// Variable that a non-parametric force follows: "angle", or "position" of what slides, or "speed".
std::string followedBy(const DiscoverFindings& findings,
                       const info::discover::NonparametricForce& force);

/// How the verdict was reached.
void sayDiscovery(const DiscoverFindings& findings, Methods& methods);

/// Sets the values of summary.json.
void tellFindings(const DiscoverFindings& findings, Summary& summary);

/// verdict.json as docs/schemas/verdict.schema.json describes it.
nlohmann::ordered_json verdictJson(const DiscoverFindings& findings);

/// "named", or "ambiguous", "parameter", "none", "unknown", "numerical"; "stopped" if the search
/// did not reach its end.
std::string verdictWord(const info::discover::Verdict& verdict);

}  // namespace app
