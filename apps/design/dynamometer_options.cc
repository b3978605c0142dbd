#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "bio/model/units.h"
#include "design/design_options.h"
#include "options/quantity.h"

namespace app {
namespace {

using ExperimentKind = bio::DynamometerExperiment::Kind;

constexpr ExperimentKind allKinds[] = {ExperimentKind::isometric, ExperimentKind::isokinetic,
                                       ExperimentKind::passive, ExperimentKind::release,
                                       ExperimentKind::isotonic};

/// A list in radians (metres).
std::vector<double> quantities(const std::vector<std::string>& texts, bool turns,
                               const char* option) {
  std::vector<double> values;
  for (const std::string& text : texts) {
    try {
      values.push_back(turns ? parseAngle(text) : parseNumber(text));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}: {}", option, error.what()));
    }
  }
  return values;
}

std::vector<double> shares(const std::vector<double>& percents) {
  std::vector<double> values;
  for (const double percent : percents) values.push_back(percent / 100);
  return values;
}

}  // namespace

bool considers(const DynamometerOptions& options, ExperimentKind kind) {
  return options.kinds.empty() || std::find(options.kinds.begin(), options.kinds.end(),
                                            bio::name(kind)) != options.kinds.end();
}

void addDynamometerOptions(CLI::App& options, DynamometerOptions& dynamometer) {
  const std::string group = "Dynamometer";
  CLI::Option* const asked =
      options
          .add_option(
              "--dynamometer", dynamometer.coordinate,
              "instead of TRIAL: a dynamometer holds or turns this coordinate and measures its "
              "moment, or lets it go against a torque and measures its angle; rank experiments by "
              "what they tell of --parameters, with default priors")
          ->type_name("NAME")
          ->group(group);
  const auto list = [&](const char* name, auto& target, const char* text, const char* type) {
    return options.add_option(name, target, text)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name(type)
        ->needs(asked)
        ->group(group);
  };
  std::vector<std::string> words;
  for (const ExperimentKind kind : allKinds) words.emplace_back(bio::name(kind));
  list("--kinds", dynamometer.kinds,
       "experiments that it can do: isometric, isokinetic, passive, release (quick release: held, "
       "let shorten a short way, held) and isotonic (let go against a constant torque); default: "
       "all",
       "isometric,…")
      ->check(CLI::IsMember(words));
  list("--angles", dynamometer.angles,
       "positions to hold; turns go between the first and the last; default: four in the range",
       "20deg,60deg,…");
  list("--speeds", dynamometer.speeds,
       "speeds of turns, per second; default: 30deg,120deg, as far as they "
       "fit between the angles",
       "30deg,120deg,…");
  list("--efforts", dynamometer.efforts,
       "contractions of flexors and of extensors [% MVC]; default: 30,60,100", "30,60,…");
  list("--releases", dynamometer.releases,
       "how far muscles shorten in a quick release from each of --angles; default: 10deg",
       "5deg,10deg,…");
  options
      .add_option("--release-speed", dynamometer.releaseSpeed,
                  "largest speed of a quick release, per second; default: 200deg, less where "
                  "--rate (eight samples in a release) or --speed require it")
      ->type_name("SPEED")
      ->needs(asked)
      ->group(group);
  list("--loads", dynamometer.loads,
       "torque of isotonic contractions [% of what holds the contracted limb]; default: 50,80",
       "50,80,…");
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

bio::DynamometerQuestion dynamometerQuestion(const DesignOptions& typed,
                                             const bio::Coordinate& coordinate) {
  const DynamometerOptions& options = typed.dynamometer;
  const bool turns = coordinate.isRotation;
  bio::DynamometerQuestion question;
  question.coordinate = options.coordinate;
  question.kinds.clear();
  for (const std::string& word : options.kinds) {
    question.kinds.push_back(bio::dynamometerKindNamed(word));
  }
  question.parameters = typed.parameters;
  question.nuisance = typed.nuisance;
  question.count = options.count;
  question.noise = options.momentNoise;
  question.angleNoise = turns ? typed.noise_deg * bio::radiansPerDegree : typed.noise_deg / 1000;
  question.rate = typed.rate_Hz;
  question.fastest = turns ? typed.speed_deg * bio::radiansPerDegree : typed.speed_deg / 1000;
  question.robustness = typed.limits.robustness;
  question.positions = quantities(options.angles, turns, "--angles");
  question.speeds = quantities(options.speeds, turns, "--speeds");
  question.efforts = shares(options.efforts);
  question.releases = quantities(options.releases, turns, "--releases");
  question.loads = shares(options.loads);
  std::optional<double> releaseSpeed;
  if (!options.releaseSpeed.empty()) {
    releaseSpeed = quantities({options.releaseSpeed}, turns, "--release-speed").front();
  }
  return bio::withDefaults(std::move(question), coordinate, releaseSpeed);
}

}  // namespace app
