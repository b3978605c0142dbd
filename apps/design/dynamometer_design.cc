#include "design/dynamometer_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/angle_unit.h"
#include "output/output_folder.h"
#include "output/result.h"

namespace app {
namespace {

double quantityOf(const std::string& text, bool turns, const char* option) {
  try {
    return turns ? parseAngle(text) : parseNumber(text);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", option, error.what()));
  }
}

/// Sorted, each once.
void makeDistinct(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// The lists of the options in radians (or metres) and shares.
void addLists(const DynamometerOptions& options, const bio::Coordinate& coordinate,
              bio::DynamometerQuestion& question) {
  const bool turns = coordinate.isRotation;
  for (const std::string& text : options.angles) {
    question.positions.push_back(quantityOf(text, turns, "--angles"));
    const double angle = question.positions.back();
    if (!(angle >= coordinate.rangeMin && angle <= coordinate.rangeMax)) {
      throw std::invalid_argument(fmt::format(
          "--angles: {} is outside the range of '{}', {:.4g} "
          "to {:.4g} {}",
          text, coordinate.name, coordinate.rangeMin, coordinate.rangeMax, turns ? "rad" : "m"));
    }
  }
  if (question.positions.empty()) {  // four over the middle four fifths of the range
    const double width = coordinate.rangeMax - coordinate.rangeMin;
    for (int k = 0; k < 4; ++k) {
      question.positions.push_back(coordinate.rangeMin + width * (0.1 + 0.8 * k / 3));
    }
  }
  makeDistinct(question.positions);
  const double width = question.positions.back() - question.positions.front();
  for (const std::string& text : options.speeds) {
    question.speeds.push_back(quantityOf(text, turns, "--speeds"));
    if (!(question.speeds.back() > 0)) {
      throw std::invalid_argument(fmt::format("--speeds: {}, must be > 0", text));
    }
    if (!bio::dynamometer::turnFits(width, question.speeds.back())) {
      throw std::invalid_argument(fmt::format(
          "--speeds: {}: turns go from the first to the last of --angles and take from {} to {} s, "
          "these would take {:.3g} s",
          text, bio::dynamometer::speedUp, bio::dynamometer::longestTurn,
          width / question.speeds.back()));
    }
  }
  if (question.speeds.empty()) {
    for (const double speed : {30.0, 120.0}) {
      const double given = turns ? speed / radian : speed / 1000;
      if (bio::dynamometer::turnFits(width, given)) question.speeds.push_back(given);
    }
  }
  for (const double percent : options.efforts) {
    if (!(percent > 100 * bio::dynamometer::excitationAtRest && percent <= 100)) {
      throw std::invalid_argument(
          fmt::format("--efforts: {} % MVC, must be > {:g}, which muscles at rest have, and at "
                      "most 100",
                      percent, 100 * bio::dynamometer::excitationAtRest));
    }
    question.efforts.push_back(percent / 100);
  }
  makeDistinct(question.speeds);
  makeDistinct(question.efforts);
}

/// What moves beside the dynamometer's coordinate, or what else is said of that.
void checkRoles(const DynamometerOptions& options, const SimulationOptions& simulation,
                const bio::Model& model) {
  if (!simulation.coordinates.empty()) {
    throw std::invalid_argument(
        "--coordinate cannot be combined with --dynamometer: nothing moves freely there");
  }
  for (const Assignment& lock : simulation.locks) {
    if (lock.name != options.coordinate) continue;
    throw std::invalid_argument(fmt::format(
        "--lock {}: is held and turned by the dynamometer, must not be locked", lock.name));
  }
  SimulationOptions others = simulation;
  others.prescribed = {options.coordinate};
  refusePrescribedByModel(others, model);
}

}  // namespace

void addDynamometerOptions(CLI::App& options, DynamometerOptions& dynamometer) {
  const std::string group = "Dynamometer";
  CLI::Option* const asked =
      options
          .add_option(
              "--dynamometer", dynamometer.coordinate,
              "instead of TRIAL: a dynamometer holds or turns this coordinate and measures its "
              "moment; rank isometric, isokinetic and passive experiments by what they tell of "
              "--parameters, with default priors")
          ->type_name("NAME")
          ->group(group);
  const auto list = [&](const char* name, auto& target, const char* text, const char* type) {
    options.add_option(name, target, text)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name(type)
        ->needs(asked)
        ->group(group);
  };
  list("--angles", dynamometer.angles,
       "positions to hold; turns go between the first and the last; default: four in the range",
       "20deg,60deg,…");
  list("--speeds", dynamometer.speeds,
       "speeds of turns, per second; default: 30deg,120deg, as far as they "
       "fit between the angles",
       "30deg,120deg,…");
  list("--efforts", dynamometer.efforts, "contractions of flexors and of extensors [% MVC]",
       "30,60,…");
  options.add_option("--experiments", dynamometer.count, "how many are wanted")
      ->check(CLI::Range(1, 100))
      ->capture_default_str()
      ->type_name("N")
      ->needs(asked)
      ->group(group);
  options.add_option("--moment-noise", dynamometer.momentNoise, "noise of a sample of the moment")
      ->capture_default_str()
      ->type_name("NM")
      ->needs(asked)
      ->group(group);
}

ExitStatus designOnDynamometer(const CommandContext& context, const std::string& modelFile,
                               const std::vector<std::string>& parameters,
                               const std::vector<std::string>& nuisance,
                               const DynamometerOptions& options, double rate,
                               const SimulationOptions& typed) {
  if (!(options.momentNoise > 0 && std::isfinite(options.momentNoise))) {
    throw std::invalid_argument(
        fmt::format("--moment-noise: {} N·m, must be > 0", options.momentNoise));
  }
  std::vector<std::string> names;
  for (int n = 1; n <= options.count; ++n) names.push_back(fmt::format("experiment_{}.csv", n));
  OutputFolder folder(context, names);
  Summary summary(context);
  const bio::Model model = readModel(modelFile, summary);
  checkRoles(options, typed, model);
  SimulationOptions simulation = typed;
  simulation.prescribed = {options.coordinate};
  const bio::MusculoskeletalSystem arm = movableSystem(model, modelFile, simulation, summary);
  const bio::Coordinate& coordinate = bio::findCoordinate(model, options.coordinate);
  const bool turns = coordinate.isRotation;
  bio::DynamometerQuestion question;
  question.coordinate = options.coordinate;
  question.parameters = parameters;
  question.nuisance = nuisance;
  question.count = options.count;
  question.noise = options.momentNoise;
  question.rate = rate;
  question.threads = context.threads;
  addLists(options, coordinate, question);
  const bio::DynamometerPlan plan = bio::planOnDynamometer(
      model, arm, armOptions(simulation), simulationOptions(simulation, 0, 1), question);
  for (std::size_t n = 0; n < plan.chosen.size(); ++n) {
    folder.writeFile(names[n], [&](const std::filesystem::path& path) {
      bio::writeTable(plan.chosen[n].trial, path);
    });
  }
  if (plan.failed > 0) {
    summary.warn(fmt::format("{} of {} experiments cannot be simulated and were left out",
                             plan.failed, plan.candidates));
  }
  tellDynamometer(plan, turns, summary);
  deliver(context, summary, dynamometerReport(plan, options, turns), folder);
  return ExitStatus::done;
}

}  // namespace app
