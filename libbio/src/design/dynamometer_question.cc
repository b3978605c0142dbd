#include "bio/design/dynamometer_question.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bio/model/units.h"

namespace bio {
namespace {

using Kind = DynamometerExperiment::Kind;
namespace course = dynamometer;

constexpr Kind everyKind[] = {Kind::isometric, Kind::isokinetic, Kind::passive, Kind::release,
                              Kind::isotonic};

/// Lists of a question for one coordinate, filled in and checked.
class DynamometerDefaults {
 public:
  DynamometerDefaults(DynamometerQuestion question, const Coordinate& coordinate,
                      const std::optional<double>& releaseSpeed)
      : question_(std::move(question)), coordinate_(coordinate), releaseSpeed_(releaseSpeed) {}

  DynamometerQuestion filled() {
    const std::vector<Kind> asked = std::move(question_.kinds);
    question_.kinds.clear();
    for (const Kind kind : everyKind) {
      const bool named = std::find(asked.begin(), asked.end(), kind) != asked.end();
      if (asked.empty() || named) question_.kinds.push_back(kind);
    }
    refuseUnused();
    fillPositions();
    fillSpeeds();
    fillShares();
    fillReleases();
    return std::move(question_);
  }

 private:
  /// A value in degrees as [rad], or in millimetres as [m].
  double small(double value) const {
    return coordinate_.isRotation ? value * radiansPerDegree : value / 1000;
  }

  /// "1.047 rad (60 deg)"
  std::string inWords(double value, const char* per = "") const {
    if (!coordinate_.isRotation) return fmt::format("{:.4g} m{}", value, per);
    return fmt::format("{:.4g} rad{} ({:.4g} deg{})", value, per, value * degreesPerRadian, per);
  }

  void requirePositive(double value, const char* quantity, const char* per = "") const {
    if (value > 0) return;
    throw std::invalid_argument(fmt::format("{}: {}, must be > 0", quantity, inWords(value, per)));
  }

  /// A speed that the coordinate may have.
  void requireSpeed(double value, const char* quantity) const {
    requirePositive(value, quantity, "/s");
    if (value <= question_.fastest * (1 + 1e-12)) return;
    throw std::invalid_argument(fmt::format("{}: {}, must be at most the largest speed, {}",
                                            quantity, inWords(value, "/s"),
                                            inWords(question_.fastest, "/s")));
  }

  bool any(std::initializer_list<Kind> kinds) const {
    return std::any_of(kinds.begin(), kinds.end(), [&](Kind kind) {
      return std::find(question_.kinds.begin(), question_.kinds.end(), kind) !=
             question_.kinds.end();
    });
  }

  /// Lists for experiments that are not considered.
  void refuseUnused() const {
    const auto refuse = [](bool isGiven, bool isUsed, const char* quantity, const char* kinds) {
      if (!isGiven || isUsed) return;
      throw std::invalid_argument(
          fmt::format("{}: must have {} among the kinds of experiments", quantity, kinds));
    };
    refuse(!question_.speeds.empty(), any({Kind::isokinetic, Kind::passive}), "speeds",
           "isokinetic or passive");
    refuse(!question_.efforts.empty(),
           any({Kind::isometric, Kind::isokinetic, Kind::release, Kind::isotonic}), "efforts",
           "one with contractions");
    refuse(!question_.releases.empty(), any({Kind::release}), "releases", "release");
    refuse(releaseSpeed_.has_value(), any({Kind::release}), "speed of releases", "release");
    refuse(!question_.loads.empty(), any({Kind::isotonic}), "loads", "isotonic");
  }

  void fillPositions() {
    for (const double angle : question_.positions) {
      if (angle >= coordinate_.rangeMin && angle <= coordinate_.rangeMax) continue;
      throw std::invalid_argument(
          fmt::format("angles: {} is outside the range of '{}', {:.4g} to {:.4g} {}",
                      inWords(angle), coordinate_.name, coordinate_.rangeMin, coordinate_.rangeMax,
                      coordinate_.isRotation ? "rad" : "m"));
    }
    if (question_.positions.empty()) {  // four over the middle four fifths of the range
      const double width = coordinate_.rangeMax - coordinate_.rangeMin;
      for (int k = 0; k < 4; ++k) {
        question_.positions.push_back(coordinate_.rangeMin + width * (0.1 + 0.8 * k / 3));
      }
    }
    makeDistinct(question_.positions);
  }

  void fillSpeeds() {
    if (!any({Kind::isokinetic, Kind::passive})) return;
    const double width = question_.positions.back() - question_.positions.front();
    for (const double speed : question_.speeds) {
      requireSpeed(speed, "speeds");
      if (course::turnFits(width, speed)) continue;
      throw std::invalid_argument(fmt::format(
          "speeds: {}: turns go from the first to the last of the angles and take from {} to {} s, "
          "these would take {:.3g} s",
          inWords(speed, "/s"), course::speedUp, course::longestTurn, width / speed));
    }
    if (question_.speeds.empty()) {
      for (const double value : {small(30), small(120)}) {
        if (course::turnFits(width, value) && value <= question_.fastest) {
          question_.speeds.push_back(value);
        }
      }
    }
    makeDistinct(question_.speeds);
  }

  void fillShares() {
    for (const double effort : question_.efforts) {
      if (effort > course::excitationAtRest && effort <= 1) continue;
      throw std::invalid_argument(
          fmt::format("efforts: {:g} % MVC, must be > {:g}, which muscles at rest have, and at "
                      "most 100",
                      100 * effort, 100 * course::excitationAtRest));
    }
    for (const double load : question_.loads) {
      if (load > 0 && load < 1) continue;
      throw std::invalid_argument(
          fmt::format("loads: {:g} %, must be > 0 and below 100, with which the joint does not "
                      "move",
                      100 * load));
    }
    if (question_.efforts.empty()) question_.efforts = {0.3, 0.6, 1};
    if (question_.loads.empty()) question_.loads = {0.5, 0.8};
    makeDistinct(question_.efforts);
    makeDistinct(question_.loads);
  }

  void fillReleases() {
    if (!any({Kind::release})) return;
    for (const double length : question_.releases) requirePositive(length, "releases");
    if (question_.releases.empty()) question_.releases.push_back(small(10));
    makeDistinct(question_.releases);
    const double shortest = question_.releases.front();
    if (!releaseSpeed_) {  // as fast as usual, the samples and the largest speed permit
      const double sampled = course::releaseTime(shortest, 1) * question_.rate / 8;
      question_.releaseSpeed = std::min({small(200), question_.fastest, sampled});
      return;
    }
    question_.releaseSpeed = *releaseSpeed_;
    requireSpeed(*releaseSpeed_, "speed of releases");
    if (course::releaseIsSampled(shortest, *releaseSpeed_, question_.rate)) return;
    throw std::invalid_argument(
        fmt::format("speed of releases: {}: a release of {} takes {:.3g} s, must be at least 8 "
                    "samples (of {:g} "
                    "per second)",
                    inWords(*releaseSpeed_, "/s"), inWords(shortest),
                    course::releaseTime(shortest, *releaseSpeed_), question_.rate));
  }

  /// Sorted, each once.
  static void makeDistinct(std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
  }

  DynamometerQuestion question_;
  const Coordinate& coordinate_;
  const std::optional<double>& releaseSpeed_;
};

}  // namespace

const char* name(Kind kind) {
  switch (kind) {
    case Kind::isometric:
      return "isometric";
    case Kind::isokinetic:
      return "isokinetic";
    case Kind::passive:
      return "passive";
    case Kind::release:
      return "release";
    case Kind::isotonic:
      break;
  }
  return "isotonic";
}

Kind dynamometerKindNamed(const std::string& word) {
  for (const Kind kind : everyKind) {
    if (word == name(kind)) return kind;
  }
  throw std::invalid_argument(fmt::format(
      "kind of experiment '{}', must be isometric, isokinetic, passive, release or isotonic",
      word));
}

DynamometerQuestion withDefaults(DynamometerQuestion question, const Coordinate& coordinate,
                                 const std::optional<double>& releaseSpeed) {
  return DynamometerDefaults(std::move(question), coordinate, releaseSpeed).filled();
}

std::string instructionOf(const DynamometerExperiment& experiment, bool turns) {
  const double unit = turns ? degreesPerRadian : 1000;
  const char* unitName = turns ? "deg" : "mm";
  const std::string contract = fmt::format("{}: rise to {:.0f} % MVC in {:g} s", experiment.group,
                                           100 * experiment.effort, course::ramp);
  const std::string hold = fmt::format("hold at {:.0f} {}; rest {:g} s, {}", experiment.from * unit,
                                       unitName, course::rest, contract);
  switch (experiment.kind) {
    case Kind::isometric:
      return fmt::format("{}, keep it for {:g} s, relax", hold, course::hold);
    case Kind::release:
      return fmt::format(
          "{}, keep it; after {:g} s turn to {:.0f} {} within {:.2g} s (up to {:.0f} {}/s) and "
          "hold there, keep it for {:g} s more, relax",
          hold, course::beforeRelease, experiment.to * unit, unitName,
          course::releaseTime(std::abs(experiment.to - experiment.from), experiment.speed),
          experiment.speed * unit, unitName, course::afterRelease);
    case Kind::isotonic: {
      const Eigen::Index rows = experiment.trial.values.rows();
      return fmt::format(
          "{}, keep it; when the moment is steady, let the joint go against a constant {:.3g} {} "
          "that pushes the angle {}, and measure the angle from then on for {:.2g} s, until about "
          "{:.0f} {}",
          hold, std::abs(experiment.torque), turns ? "N m" : "N",
          experiment.torque < 0 ? "down" : "up", experiment.trial.values(rows - 1, 0),
          experiment.to * unit, unitName);
    }
    case Kind::isokinetic:
    case Kind::passive:
      break;
  }
  const std::string turn =
      fmt::format("turn from {:.0f} to {:.0f} {} at {:.0f} {}/s", experiment.from * unit,
                  experiment.to * unit, unitName, experiment.speed * unit, unitName);
  if (experiment.kind == Kind::passive) return turn + "; relax all the time";
  return fmt::format("{}; rest {:g} s, {}, then turn and keep it to the end", turn, course::rest,
                     contract);
}

}  // namespace bio
