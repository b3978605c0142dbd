#include "design/design_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bio/design/design_setup.h"
#include "bio/model/units.h"
#include "options/observed_channels.h"
#include "options/trial_input.h"

namespace app {
namespace {

std::vector<std::string> givenOf(const std::vector<const CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) {
    if (option->count() > 0) names.push_back(option->get_name());
  }
  return names;
}

/// NAME and the rest of "NAME=rest"; without a name "".
std::pair<std::string, std::string> named(const std::string& text) {
  const auto at = text.rfind('=');
  if (at == std::string::npos) return {"", text};
  return {text.substr(0, at), text.substr(at + 1)};
}

/// By name, each once.
template <class Value, class Parse>
std::map<std::string, Value> byNameOf(const char* option, const std::vector<std::string>& texts,
                                      const Parse& parse) {
  std::map<std::string, Value> all;
  for (const std::string& text : texts) {
    const auto [name, value] = named(text);
    try {
      if (!all.emplace(name, parse(value)).second) {
        throw std::invalid_argument(fmt::format("'{}' is given twice", text));
      }
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}: {}", option, error.what()));
    }
  }
  return all;
}

/// Largest torques by coordinate.
std::map<std::string, double> torquesOf(const DesignOptions& typed) {
  if (typed.torque.empty()) return bio::GivenLimits{}.torque;
  return byNameOf<double>("--torque", typed.torque, [](const std::string& text) {
    const double torque = parseNumber(text);
    if (torque < 0) throw std::invalid_argument(fmt::format("{} N·m, must be ≥ 0", torque));
    return torque;
  });
}

/// Options that would have no effect beside --dynamometer.
void refuseOptionsOfSearch(const DesignOptions& typed) {
  if (const std::vector<std::string> given = givenOf(typed.ofSearch); !given.empty()) {
    throw std::invalid_argument(
        fmt::format("{} cannot be combined with --dynamometer: no search from a trial is made",
                    fmt::join(given, ", ")));
  }
  if (considers(typed.dynamometer, bio::DynamometerExperiment::Kind::isotonic)) return;
  if (const std::vector<std::string> given = givenOf(typed.ofAngle); !given.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: the angle is measured in isotonic experiments only, which --kinds leaves "
                    "out",
                    fmt::join(given, ", ")));
  }
}

/// The question: effects or parameters, and the criterion.
void addQuestion(CLI::App& options, DesignOptions& typed) {
  options
      .add_option("TRIAL", typed.trial,
                  "baseline trial to improve on: excitations, duration, initial state; required "
                  "unless --dynamometer is given")
      ->check(CLI::ExistingFile)
      ->type_name("");
  const auto names = [&](const std::string& name, std::vector<std::string>& target,
                         const std::string& description) {
    return options.add_option(name, target, description)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("NAMES");
  };
  names("--parameters", typed.parameters,
        "parameters of interest; sensitivity --list-parameters lists the choices");
  names("--separate", typed.separate,
        "instead of --parameters: two effects of discover's catalogue, by id; find the experiment "
        "that best discriminates between them, given the default uncertainty of every parameter");
  options
      .add_option("--size", typed.sizes,
                  "with --separate: assumed size of an effect, in its unit; default: its prior "
                  "standard deviation")
      ->type_name("ID=SIZE")
      ->allow_extra_args(false);
  names("--nuisance", typed.nuisance,
        "further unknown parameters, with their default priors; the bounds take them into account");
  options.add_flag("--priors", typed.priors, "use the default priors for the --parameters as well");
  options
      .add_option("--prior", typed.givenPriors,
                  "prior standard deviation of a parameter, in its unit; may be repeated")
      ->type_name("NAME=DEVIATION")
      ->allow_extra_args(false);
  options
      .add_option("--criterion", typed.criterion,
                  "design criterion, parameters scaled by their default prior standard "
                  "deviations; E: minimise the largest variance of any combination; A: the sum "
                  "of variances; D: the volume of the confidence ellipsoid")
      ->check(CLI::IsMember({"E", "A", "D"}))
      ->capture_default_str();
}

/// The observed channels and the inputs that a search may change, with their limits.
void addPlan(CLI::App& options, DesignOptions& typed) {
  const auto number = [&](const std::string& name, double& target, const std::string& unit,
                          const std::string& description) {
    options.add_option(name, target, description)->type_name(unit)->capture_default_str();
  };
  number("--noise", typed.noise_deg, "DEGREES",
         "standard deviation of the measured angles (of a shift: in mm)");
  options
      .add_option("--observe", typed.observe,
                  "what is measured, with the standard deviation of its noise, instead of all free "
                  "coordinates: elbow_flexion=0.5deg, elbow_flexion.moment=0.5, "
                  "BRA.fiber_length=0.001, …; may be repeated")
      ->delimiter(',')
      ->type_name("NAME=SD")
      ->allow_extra_args(false);
  number("--rate", typed.rate_Hz, "HZ", "measurement rate");
  options
      .add_option("--torque", typed.torque,
                  "largest external torque on every free coordinate, or on one: 10, "
                  "elbow_flexion=10; may be repeated; 0: none; default: 10")
      ->type_name("[NAME=]NM")
      ->allow_extra_args(false);
  number("--torque-rate", typed.limits.torqueRate, "NM/S", "how fast it may change");
  options
      .add_option("--excite", typed.excite,
                  "muscles whose excitations are designed: flexors, extensors (of the first "
                  "coordinate; of another: NAME.flexors), or names; BRA+BRD share one excitation")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("GROUPS");
  number("--excitation-max", typed.limits.largestExcitation, "0-1",
         "largest excitation of a group");
  number("--excitation-rate", typed.limits.excitationRate, "1/S", "how fast it may change");
  options
      .add_option("--range", typed.range,
                  "range to which a free coordinate is limited: 10deg,120deg, or, where several "
                  "are free, elbow_flexion=10deg,120deg; may be repeated; default: as in the model")
      ->type_name("[NAME=]LOW,HIGH")
      ->allow_extra_args(false);
  number("--speed", typed.speed_deg, "DEG/S",
         "largest speed of the coordinates (of a shift: in mm/s)");
  number("--surprise", typed.limits.robustness, "K",
         "respect the range even if the parameters are K prior standard deviations off");
  number("--knots", typed.knots, "SECONDS",
         "interval between the knots of the piecewise linear inputs");
}

/// The effort of the search.
void addSearch(CLI::App& options, DesignOptions& typed) {
  const auto count = [&](const std::string& name, int& target, const std::string& description) {
    options.add_option(name, target, description)
        ->check(CLI::Range(0, 1000000))
        ->type_name("N")
        ->capture_default_str();
  };
  count("--candidates", typed.settings.candidates, "number of random initial designs");
  count("--generations", typed.settings.generations,
        "generations of the evolution strategy that starts from the best of them");
  count("--iterations", typed.settings.iterations, "iterations of the final gradient search");
  count("--monte-carlo", typed.monteCarlo,
        "number of simulated and estimated repetitions of the designed experiment, to confirm "
        "the bounds");
}

}  // namespace

void addDesignOptions(CLI::App& options, DesignOptions& typed) {
  addModelArgument(options, typed.model);
  addQuestion(options, typed);
  addPlan(options, typed);
  addSearch(options, typed);
  addDynamometerOptions(options, typed.dynamometer);
  addSimulationOptions(options, typed.simulation);
  addPrescribing(options, typed.simulation);
  for (const char* name :
       {"--observe",     "--prescribe",   "--separate",       "--size",
        "--priors",      "--prior",       "--criterion",      "--torque",
        "--torque-rate", "--excite",      "--excitation-max", "--excitation-rate",
        "--range",       "--knots",       "--candidates",     "--generations",
        "--iterations",  "--monte-carlo", "--initial",        "--ignore-extra"}) {
    typed.ofSearch.push_back(options.get_option(name));
  }
  typed.noise = options.get_option("--noise");
  for (const char* name : {"--torque", "--torque-rate", "--range", "--speed"}) {
    typed.ofMotion.push_back(options.get_option(name));
  }
  for (const char* name : {"--noise", "--speed", "--surprise"}) {
    typed.ofAngle.push_back(options.get_option(name));
  }
}

void checkDesignOptions(const DesignOptions& typed) {
  if (typed.trial.empty() == typed.dynamometer.coordinate.empty()) {
    throw std::invalid_argument("either TRIAL or --dynamometer is required, and not both");
  }
  if (typed.trial.empty()) refuseOptionsOfSearch(typed);
  if (typed.parameters.empty() == typed.separate.empty()) {
    throw std::invalid_argument(
        "either --parameters or --separate is required, and not both (see --help)");
  }
  if (!typed.observe.empty() && typed.noise->count() > 0) {
    throw std::invalid_argument(
        "--noise cannot be combined with --observe, where every NAME=SD has its own");
  }
  if (!typed.separate.empty() && typed.separate.size() != 2) {
    throw std::invalid_argument(
        fmt::format("--separate: {} effects, must be two", typed.separate.size()));
  }
  if (!typed.sizes.empty() && typed.separate.empty()) {
    throw std::invalid_argument("--size requires --separate");
  }
  if (!typed.separate.empty() && (!typed.nuisance.empty() || typed.priors ||
                                  !typed.givenPriors.empty() || typed.monteCarlo > 0)) {
    throw std::invalid_argument(
        "--nuisance, --priors, --prior and --monte-carlo cannot be combined with --separate");
  }
  const auto positive = [](const char* name, double value, const char* unit) {
    if (!(value > 0 && std::isfinite(value))) {
      throw std::invalid_argument(fmt::format("{}: {} {}, must be > 0", name, value, unit));
    }
  };
  positive("--noise", typed.noise_deg, "deg");
  positive("--rate", typed.rate_Hz, "Hz");
  positive("--torque-rate", typed.limits.torqueRate, "N·m/s");
  positive("--excitation-rate", typed.limits.excitationRate, "1/s");
  positive("--speed", typed.speed_deg, "deg/s");
  positive("--knots", typed.knots, "s");
  if (!(typed.limits.robustness >= 0 && std::isfinite(typed.limits.robustness))) {
    throw std::invalid_argument(
        fmt::format("--surprise: {}, must be ≥ 0", typed.limits.robustness));
  }
  if (!(typed.limits.largestExcitation > typed.limits.leastExcitation &&
        typed.limits.largestExcitation <= 1)) {
    throw std::invalid_argument(fmt::format("--excitation-max: {}, must be above {} and at most 1",
                                            typed.limits.largestExcitation,
                                            typed.limits.leastExcitation));
  }
  const std::map<std::string, double> torques = torquesOf(typed);
  const bool isPushed = std::any_of(torques.begin(), torques.end(),
                                    [](const auto& torque) { return torque.second > 0; });
  if (!isPushed && typed.excite.empty()) {
    throw std::invalid_argument("--torque 0 without --excite leaves nothing to change");
  }
  if (!typed.simulation.isVariational()) {
    throw std::invalid_argument(fmt::format(
        "--integrator {}: must be vi-adaptive, vi or vi-left, which alone have sensitivities",
        typed.simulation.integrator));
  }
  if (typed.monteCarlo > 0 && !typed.nuisance.empty()) {
    throw std::invalid_argument("--monte-carlo cannot be combined with --nuisance");
  }
}

bio::DesignLimits designLimits(const DesignOptions& typed,
                               const bio::MusculoskeletalSystem& system) {
  bio::GivenLimits given;
  given.torque = torquesOf(typed);
  for (const bio::Coordinate& coordinate : system.skeleton().coordinates()) {
    given.speed[coordinate.name] =
        typed.speed_deg * (coordinate.isRotation ? bio::radiansPerDegree : 1e-3);
  }
  for (const int prescribed : system.prescribed()) {
    given.speed.erase(system.skeleton().coordinates()[static_cast<std::size_t>(prescribed)].name);
  }
  given.range =
      byNameOf<std::pair<double, double>>("--range", typed.range, [](const std::string& text) {
        const auto comma = text.find(',');
        if (comma == std::string::npos) {
          throw std::invalid_argument(fmt::format("'{}' must be LOW,HIGH", text));
        }
        return std::pair(parseAngle(text.substr(0, comma)), parseAngle(text.substr(comma + 1)));
      });
  bio::DesignLimits limits = bio::withCoordinates(typed.limits, system, given);
  if (const auto names = givenOf(typed.ofMotion); limits.coordinates.empty() && !names.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: no coordinate is free to move", fmt::join(names, ", ")));
  }
  return limits;
}

std::vector<bio::ChannelCandidate> designOutputs(const DesignOptions& typed,
                                                 const bio::Model& model,
                                                 const bio::MusculoskeletalSystem& system) {
  if (!typed.observe.empty()) return readObserved(typed.observe, model, system);
  const auto observed =
      bio::freeCoordinates(system, typed.noise_deg * bio::radiansPerDegree, typed.noise_deg / 1000);
  if (!observed.empty()) return observed;
  throw std::invalid_argument(
      "no coordinate is free to be observed: --observe must name what is measured");
}

}  // namespace app
