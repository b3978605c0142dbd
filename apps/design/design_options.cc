#include "design/design_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <stdexcept>

#include "options/trial_input.h"

namespace app {
namespace {

std::vector<std::string> givenOf(const std::vector<const CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* one : options) {
    if (one->count() > 0) names.push_back(one->get_name());
  }
  return names;
}

/// Refuses options that would have no effect beside --dynamometer.
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

}  // namespace

void addDesignOptions(CLI::App& options, DesignOptions& typed) {
  addModelArgument(options, typed.model);
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
  const auto number = [&](const std::string& name, double& target, const std::string& unit,
                          const std::string& description) {
    options.add_option(name, target, description)->type_name(unit)->capture_default_str();
  };
  number("--noise", typed.noise_deg, "DEGREES",
         "standard deviation of the measured angle (of a shift: in mm)");
  number("--rate", typed.rate_Hz, "HZ", "measurement rate");
  number("--torque", typed.limits.torque, "NM", "largest external torque; 0: none");
  number("--torque-rate", typed.limits.torqueRate, "NM/S", "how fast it may change");
  names("--excite", typed.excite,
        "muscles whose excitations are designed: flexors, extensors, or names; BRA+BRD share one "
        "excitation")
      ->type_name("GROUPS");
  number("--excitation-max", typed.limits.largestExcitation, "0-1",
         "largest excitation of a group");
  number("--excitation-rate", typed.limits.excitationRate, "1/S", "how fast it may change");
  options
      .add_option("--range", typed.range,
                  "range to which the coordinate is limited, as 10deg,120deg; default: its range "
                  "in the model")
      ->delimiter(',')
      ->expected(2)
      ->type_name("LOW,HIGH");
  number("--speed", typed.speed_deg, "DEG/S",
         "largest speed of the coordinate (of a shift: in mm/s)");
  number("--surprise", typed.limits.surprise, "K",
         "respect the range even if the parameters are K prior standard deviations off");
  number("--knots", typed.knots, "SECONDS",
         "interval between the knots of the piecewise linear inputs");
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
  addDynamometerOptions(options, typed.dynamometer);
  addSimulationOptions(options, typed.simulation);
  for (const char* name :
       {"--separate", "--size", "--priors", "--prior", "--criterion", "--torque", "--torque-rate",
        "--excite", "--excitation-max", "--excitation-rate", "--range", "--knots", "--candidates",
        "--generations", "--iterations", "--monte-carlo", "--initial", "--ignore-extra"}) {
    typed.ofSearch.push_back(options.get_option(name));
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
  if (!(typed.limits.torque >= 0 && std::isfinite(typed.limits.torque))) {
    throw std::invalid_argument(fmt::format("--torque: {} N·m, must be ≥ 0", typed.limits.torque));
  }
  if (!(typed.limits.surprise >= 0 && std::isfinite(typed.limits.surprise))) {
    throw std::invalid_argument(fmt::format("--surprise: {}, must be ≥ 0", typed.limits.surprise));
  }
  if (!(typed.limits.largestExcitation > typed.limits.leastExcitation &&
        typed.limits.largestExcitation <= 1)) {
    throw std::invalid_argument(fmt::format("--excitation-max: {}, must be above {} and at most 1",
                                            typed.limits.largestExcitation,
                                            typed.limits.leastExcitation));
  }
  if (typed.limits.torque == 0 && typed.excite.empty()) {
    throw std::invalid_argument("--torque 0 without --excite leaves nothing to change");
  }
  if (!typed.simulation.integrator.starts_with("vi")) {
    throw std::invalid_argument(
        fmt::format("--integrator {}: must be vi or vi-left, which alone have sensitivities",
                    typed.simulation.integrator));
  }
  if (typed.monteCarlo > 0 && !typed.nuisance.empty()) {
    throw std::invalid_argument("--monte-carlo cannot be combined with --nuisance");
  }
}

}  // namespace app
