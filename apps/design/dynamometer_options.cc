#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "design/design_options.h"
#include "options/quantity.h"
#include "output/angle_unit.h"

namespace app {
namespace {

using ExperimentKind = bio::DynamometerExperiment::Kind;
namespace course = bio::dynamometer;

constexpr ExperimentKind allKinds[] = {ExperimentKind::isometric, ExperimentKind::isokinetic,
                                       ExperimentKind::passive, ExperimentKind::release,
                                       ExperimentKind::isotonic};

/// Of one coordinate: reads the lists of the options.
class DynamometerLists {
 public:
  DynamometerLists(const DesignOptions& typed, const bio::Coordinate& coordinate)
      : typed_(typed),
        options_(typed.dynamometer),
        coordinate_(coordinate),
        turns_(coordinate.isRotation) {}

  bio::DynamometerQuestion question() {
    question_.coordinate = options_.coordinate;
    question_.kinds.clear();
    for (const ExperimentKind kind : allKinds) {
      if (considers(options_, kind)) question_.kinds.push_back(kind);
    }
    question_.parameters = typed_.parameters;
    question_.nuisance = typed_.nuisance;
    question_.count = options_.count;
    question_.noise = options_.momentNoise;
    question_.angleNoise = shown(typed_.noise_deg);
    question_.rate = typed_.rate_Hz;
    question_.fastest = shown(typed_.speed_deg);
    question_.surprise = typed_.limits.surprise;
    refuseUnused();
    addPositions();
    addSpeeds();
    addShares();
    addReleases();
    return std::move(question_);
  }

 private:
  /// Degrees, or millimetres.
  double shown(double value) const { return turns_ ? value * degree : value / 1000; }

  double quantity(const std::string& text, const char* option) const {
    try {
      return turns_ ? parseAngle(text) : parseNumber(text);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}: {}", option, error.what()));
    }
  }

  double positive(const std::string& text, const char* option) const {
    const double value = quantity(text, option);
    if (value > 0) return value;
    throw std::invalid_argument(fmt::format("{}: {}, must be > 0", option, text));
  }

  /// A speed that the coordinate may have.
  double speed(const std::string& text, const char* option) const {
    const double value = positive(text, option);
    if (value <= question_.fastest * (1 + 1e-12)) return value;
    throw std::invalid_argument(fmt::format("{}: {}, must be at most --speed {:g} {}/s", option,
                                            text, typed_.speed_deg, turns_ ? "deg" : "mm"));
  }

  bool any(std::initializer_list<ExperimentKind> kinds) const {
    return std::any_of(kinds.begin(), kinds.end(),
                       [&](ExperimentKind kind) { return considers(options_, kind); });
  }

  /// Lists for experiments that are not considered.
  void refuseUnused() const {
    const auto refuse = [](bool isGiven, bool isUsed, const char* option, const char* kinds) {
      if (!isGiven || isUsed) return;
      throw std::invalid_argument(fmt::format("{} requires {} among --kinds", option, kinds));
    };
    refuse(!options_.speeds.empty(), any({ExperimentKind::isokinetic, ExperimentKind::passive}),
           "--speeds", "isokinetic or passive");
    refuse(!options_.efforts.empty(),
           any({ExperimentKind::isometric, ExperimentKind::isokinetic, ExperimentKind::release,
                ExperimentKind::isotonic}),
           "--efforts", "one with contractions");
    refuse(!options_.releases.empty(), any({ExperimentKind::release}), "--releases", "release");
    refuse(!options_.releaseSpeed.empty(), any({ExperimentKind::release}), "--release-speed",
           "release");
    refuse(!options_.loads.empty(), any({ExperimentKind::isotonic}), "--loads", "isotonic");
  }

  void addPositions() {
    for (const std::string& text : options_.angles) {
      question_.positions.push_back(quantity(text, "--angles"));
      const double angle = question_.positions.back();
      if (!(angle >= coordinate_.rangeMin && angle <= coordinate_.rangeMax)) {
        throw std::invalid_argument(
            fmt::format("--angles: {} is outside the range of '{}', {:.4g} "
                        "to {:.4g} {}",
                        text, coordinate_.name, coordinate_.rangeMin, coordinate_.rangeMax,
                        turns_ ? "rad" : "m"));
      }
    }
    if (question_.positions.empty()) {  // four over the middle four fifths of the range
      const double width = coordinate_.rangeMax - coordinate_.rangeMin;
      for (int k = 0; k < 4; ++k) {
        question_.positions.push_back(coordinate_.rangeMin + width * (0.1 + 0.8 * k / 3));
      }
    }
    makeDistinct(question_.positions);
  }

  void addSpeeds() {
    if (!any({ExperimentKind::isokinetic, ExperimentKind::passive})) return;
    const double width = question_.positions.back() - question_.positions.front();
    for (const std::string& text : options_.speeds) {
      question_.speeds.push_back(speed(text, "--speeds"));
      if (!course::turnFits(width, question_.speeds.back())) {
        throw std::invalid_argument(fmt::format(
            "--speeds: {}: turns go from the first to the last of --angles and take from {} to {} "
            "s, these would take {:.3g} s",
            text, course::speedUp, course::longestTurn, width / question_.speeds.back()));
      }
    }
    if (question_.speeds.empty()) {
      for (const double value : {shown(30), shown(120)}) {
        if (course::turnFits(width, value) && value <= question_.fastest) {
          question_.speeds.push_back(value);
        }
      }
    }
    makeDistinct(question_.speeds);
  }

  void addShares() {
    for (const double percent : options_.efforts) {
      if (!(percent > 100 * course::excitationAtRest && percent <= 100)) {
        throw std::invalid_argument(
            fmt::format("--efforts: {} % MVC, must be > {:g}, which muscles at rest have, and at "
                        "most 100",
                        percent, 100 * course::excitationAtRest));
      }
      question_.efforts.push_back(percent / 100);
    }
    for (const double percent : options_.loads) {
      if (!(percent > 0 && percent < 100)) {
        throw std::invalid_argument(
            fmt::format("--loads: {} %, must be > 0 and below 100, with which the joint does not "
                        "move",
                        percent));
      }
      question_.loads.push_back(percent / 100);
    }
    if (question_.efforts.empty()) question_.efforts = {0.3, 0.6, 1};
    if (question_.loads.empty()) question_.loads = {0.5, 0.8};
    makeDistinct(question_.efforts);
    makeDistinct(question_.loads);
  }

  void addReleases() {
    if (!any({ExperimentKind::release})) return;
    for (const std::string& text : options_.releases) {
      question_.releases.push_back(positive(text, "--releases"));
    }
    if (question_.releases.empty()) question_.releases.push_back(shown(10));
    makeDistinct(question_.releases);
    const double shortest = question_.releases.front();
    if (options_.releaseSpeed.empty()) {  // as fast as usual, the samples and --speed permit
      const double sampled = course::releaseTime(shortest, 1) * typed_.rate_Hz / 8;
      question_.releaseSpeed = std::min({shown(200), question_.fastest, sampled});
      return;
    }
    question_.releaseSpeed = speed(options_.releaseSpeed, "--release-speed");
    if (!course::releaseIsSampled(shortest, question_.releaseSpeed, typed_.rate_Hz)) {
      throw std::invalid_argument(fmt::format(
          "--release-speed: {}: a release of {:.4g} {} takes {:.3g} s, must be at least 8 samples "
          "(--rate {:g})",
          options_.releaseSpeed, turns_ ? shortest * radian : shortest * 1000,
          turns_ ? "deg" : "mm", course::releaseTime(shortest, question_.releaseSpeed),
          typed_.rate_Hz));
    }
  }

  /// Sorted, each once.
  static void makeDistinct(std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
  }

  const DesignOptions& typed_;
  const DynamometerOptions& options_;
  const bio::Coordinate& coordinate_;
  bool turns_;
  bio::DynamometerQuestion question_;
};

}  // namespace

const char* wordOf(ExperimentKind kind) {
  switch (kind) {
    case ExperimentKind::isometric:
      return "isometric";
    case ExperimentKind::isokinetic:
      return "isokinetic";
    case ExperimentKind::passive:
      return "passive";
    case ExperimentKind::release:
      return "release";
    case ExperimentKind::isotonic:
      break;
  }
  return "isotonic";
}

bool considers(const DynamometerOptions& options, ExperimentKind kind) {
  return options.kinds.empty() ||
         std::find(options.kinds.begin(), options.kinds.end(), wordOf(kind)) != options.kinds.end();
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
  for (const ExperimentKind kind : allKinds) words.emplace_back(wordOf(kind));
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
  return DynamometerLists(typed, coordinate).question();
}

}  // namespace app
