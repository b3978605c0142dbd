#include "bio/discovery/musculoskeletal_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "analysis/initial_speed.h"
#include "bio/analysis/replay.h"
#include "bio/discovery/effects.h"
#include "bio/discovery/with_experimental_conditions.h"
#include "bio/review/trial_review.h"
#include "bio/sensitivity/coupled_sensitivity.h"
#include "discovery/effects/effects.h"

namespace bio::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Floor of the latent force in units of CoordinateUnits::strength, without muscles: there are
/// no inputs whose errors it stands for, and little friction damps a free swing (decision 080).
constexpr double passiveFloor = 0.1;

/// Muscles whose record has a flat top in a trial that hides 1 % of its height or more.
std::vector<std::string> withFlatTops(const std::vector<Trial>& trials) {
  std::vector<std::string> muscles;
  for (const Trial& trial : trials) {
    for (std::size_t i = 0; i < trial.muscles.size(); ++i) {
      const Eigen::RowVectorXd record = trial.excitations.col(static_cast<Index>(i)).transpose();
      if (flatTops(trial.times, record).maxCoeff() > 0.01 * record.maxCoeff())
        muscles.push_back(trial.muscles[i]);
    }
  }
  return muscles;
}

/// Muscles whose excitation is one number in all rows of all trials: without an electrode, at the
/// baseline. A recorded EMG is never constant.
std::vector<std::string> neverRecorded(const std::vector<Trial>& trials) {
  std::vector<std::string> muscles;
  const Trial& first = trials.front();
  for (std::size_t i = 0; i < first.muscles.size(); ++i) {
    const auto column = static_cast<Index>(i);
    const double value = first.excitations(0, column);
    if (std::all_of(trials.begin(), trials.end(), [&](const Trial& trial) {
          return i < trial.muscles.size() && trial.muscles[i] == first.muscles[i] &&
                 (trial.excitations.col(column).array() == value).all();
        }))
      muscles.push_back(first.muscles[i]);
  }
  return muscles;
}

/// There will be thousands of simulations.
SystemOptions withTables(SystemOptions system) {
  system.tabulatePaths = true;
  return system;
}

}  // namespace

std::vector<Observable> measuredOutputs(const std::vector<Trial>& trials,
                                        const SystemOptions& system,
                                        const std::vector<std::string>& coordinates) {
  std::vector<Observable> sensors;
  const auto add = [&](const Observable& what) {
    if (std::find(sensors.begin(), sensors.end(), what) == sensors.end()) sensors.push_back(what);
  };
  for (const std::string& name : coordinates) {
    const bool isPrescribed = std::find(system.prescribed.begin(), system.prescribed.end(), name) !=
                              system.prescribed.end();
    const bool isMeasured = std::any_of(trials.begin(), trials.end(), [&](const Trial& trial) {
      return trial.measurementOf(ofCoordinate(name));
    });
    if (isMeasured && !isPrescribed) add(ofCoordinate(name));
  }
  for (const Trial& trial : trials) {
    for (const MeasuredChannel& channel : trial.measured)
      if (!channel.what.isCoordinate()) add(channel.what);
  }
  return sensors;
}

std::vector<std::string> coordinatesInQuestion(const std::vector<std::string>& free,
                                               const std::vector<std::string>& held,
                                               const std::vector<Trial>& trials) {
  if (!free.empty()) return free;
  std::vector<std::string> names;
  for (const std::string& name : held) {
    const Observable moment{Observable::Kind::moment, name, 0};
    const bool isMeasured =
        trials.empty() || std::any_of(trials.begin(), trials.end(), [&](const Trial& trial) {
          return trial.measurementOf(moment) != nullptr;
        });
    if (isMeasured) names.push_back(name);
  }
  return names;
}

namespace {

/// With what the trials measure as outputs, what they command and how they saw it move, unless
/// these are chosen.
MusculoskeletalProblemOptions ofTrials(MusculoskeletalProblemOptions options,
                                       const std::vector<Trial>& trials,
                                       const SystemOptions& system,
                                       const CoordinateNames& coordinates) {
  if (!options.drives) options.drives = commandsOf(trials, coordinates.all);
  if (options.sensors.empty()) options.sensors = measuredOutputs(trials, system, coordinates.all);
  if (options.motions.empty()) options.motions = motionSizes(trials, coordinates.all);
  return options;
}

}  // namespace

MusculoskeletalProblem::MusculoskeletalProblem(const Model& model, const SystemOptions& system,
                                               const CoordinateNames& coordinates,
                                               std::vector<Trial> trials,
                                               MusculoskeletalProblemOptions options)
    : options_(ofTrials(std::move(options), trials, system, coordinates)),
      encompassing_(encompassingModel(model, withTables(system), coordinates, options_)),
      quantities_(encompassing_.quantities()),
      nuisances_(encompassing_.nuisances()) {
  if (trials.empty()) throw std::invalid_argument("no trial is given, must have at least one");
  const auto positive = [](double value, const char* what) {
    if (!(value > 0 && std::isfinite(value))) {
      throw std::invalid_argument(fmt::format("{} = {}, must be > 0", what, value));
    }
  };
  positive(options_.latentSpacing, "spacing of the latent force");
  positive(options_.latentFloor, "floor of the latent force's scale");
  positive(options_.startSd, "standard deviation of the start");
  positive(options_.speedSd, "standard deviation of the start's speed");
  if (!isVariational(options_.simulation.integrator)) {
    throw std::invalid_argument("sensitivities: integrator must be vi-adaptive, vi or vi-left");
  }
  double lastStart = -HUGE_VAL, firstEnd = HUGE_VAL;
  for (const Trial& trial : trials) {
    lastStart = std::max(lastStart, trial.times[0]);
    firstEnd = std::min(firstEnd, trial.times[trial.times.size() - 1]);
  }
  for (const MovingCoordinate& at : encompassing_.coordinates()) {
    const std::string& name = at.coordinate.name;
    const bool isDriven = encompassing_.system().numMuscles() > 0;
    latentFloors_.push_back(options_.latentFloor *
                            (isDriven ? 1 : passiveFloor * unitsOf(encompassing_, at).strength));
    axes_.push_back(at.coordinate.isRotation ? info::discover::Axis{name, "rad", "N·m"}
                                             : info::discover::Axis{name, "m", "N"});
    if (!isDriven) axes_.back().smallSpeed = unitsOf(encompassing_, at).frictionWidth;
  }
  encompassing_.trialsLast(lastStart, firstEnd);
  encompassing_.forget(unsaturated(encompassing_, withFlatTops(trials)));
  encompassing_.forget(withoutElectrode(encompassing_, neverRecorded(trials)));
  quantities_ = encompassing_.quantities();
  if (!options_.initial.empty())
    (void)startCoordinates(trials.front(), encompassing_.system(), options_.initial);
  for (Trial& trial : trials) addTrial(withSynergists(std::move(trial), encompassing_));
  latentLag_ = activationLag();
  separateWhatTrialsTellApart();
}

void MusculoskeletalProblem::addTrial(Trial trial) {
  OfTrial one;
  one.trial = std::move(trial);
  collectSamples(one);
  one.recorded = recordedTrial(one.trial, encompassing_.system(), options_.simulation);
  one.recorded.simulation.progress = {};
  one.conditions = experimentalConditionsOf(one.trial, encompassing_);
  addNodes(one);
  addStarts(one);
  trials_.push_back(std::move(one));
}

/// By time, and at one time by output.
void MusculoskeletalProblem::collectSamples(OfTrial& trial) const {
  struct Sample {
    double time, value;
    std::size_t sensor;
  };
  std::vector<Sample> samples;
  const auto& sensors = encompassing_.sensors();
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const MeasuredChannel* channel = trial.trial.measurementOf(sensors[i]);
    if (!channel || channel->times.size() == 0) continue;
    if (options_.usableSeries) requireUsable(trial.trial.file, *channel);
    for (Index k = 0; k < channel->times.size(); ++k)
      samples.push_back({channel->times[k], channel->values[k], i});
    trial.series.push_back({i, {channel->times.begin(), channel->times.end()}, {}});
  }
  if (samples.empty()) {
    std::string names;
    for (const Observable& what : sensors)
      names += (names.empty() ? "'" : ", '") + nameOf(what) + "'";
    throw std::invalid_argument(
        fmt::format("{}: no measured value of {}", trial.trial.file, names));
  }
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return a.time < b.time; });
  trial.measured.resize(static_cast<Index>(samples.size()));
  for (std::size_t k = 0; k < samples.size(); ++k) {
    trial.times.push_back(samples[k].time);
    trial.measured[static_cast<Index>(k)] = samples[k].value;
    if (sensors.size() > 1) trial.outputs.push_back(static_cast<int>(samples[k].sensor));
    for (Series& series : trial.series)
      if (series.sensor == samples[k].sensor) series.samples.push_back(static_cast<Index>(k));
  }
}

void MusculoskeletalProblem::addNodes(OfTrial& trial) const {
  const double first = trial.trial.times[0], last = trial.times.back();
  const double intervals = std::max(1.0, std::ceil((last - first) / options_.latentSpacing - 1e-9));
  for (int k = 0; k <= static_cast<int>(intervals); ++k)
    trial.nodeTimes.push_back(first + k * options_.latentSpacing);
  for (std::size_t axis = 0; axis < axes_.size(); ++axis)
    for (const double t : trial.nodeTimes) trial.nodes.push_back({t, axis});
  trial.heldMass = VectorXd::Zero(static_cast<Index>(trial.nodeTimes.size()));
  if (!encompassing_.hasOneCoordinate() || trial.series.front().sensor != 0) return;
  const MeasuredChannel* channel = trial.trial.measurementOf(encompassing_.sensors().front());
  if (channel->what.isCoordinate())
    trial.heldMass = weightOfHeldMass(encompassing_, trial.series.front().times, channel->values,
                                      trial.nodeTimes);
}

void MusculoskeletalProblem::addStarts(OfTrial& trial) {
  const auto& coordinates = encompassing_.coordinates();
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (encompassing_.system().isPrescribed(coordinates[i].index)) continue;
    const Coordinate& observed = coordinates[i].coordinate;
    const bool turns = observed.isRotation;
    const CoordinateUnits units = unitsOf(encompassing_, coordinates[i]);
    const double length = units.length;
    const Observable what = ofCoordinate(observed.name);
    const auto& sensors = encompassing_.sensors();
    const auto sensor = std::find(sensors.begin(), sensors.end(), what);
    const MeasuredChannel* channel = trial.trial.measurementOf(what);
    const auto given = options_.initial.find(observed.name);
    const bool isGiven = given != options_.initial.end();
    const bool isMeasured =
        !isGiven && sensor != sensors.end() && channel && channel->times.size() > 0;
    Start start{i, 0, 0, isMeasured ? static_cast<int>(sensor - sensors.begin()) : -1};
    double shown = 0;
    if (isMeasured) {
      const std::vector<double> times(channel->times.begin(), channel->times.end());
      shown = std::abs(initialSpeedShown(times, channel->values, 0.3 * length));
    }
    const double fastest = std::max((turns ? 10 : 16) * units.speedSize, 3 * shown);
    const double first = isGiven      ? given->second
                         : isMeasured ? channel->values[0]
                                      : observed.defaultValue;
    start.angle = addOwnQuantity(
        observed.name, {"", turns ? "rad" : "m", first, observed.rangeMin, observed.rangeMax,
                        (isMeasured || isGiven ? 1 : 10) * options_.startSd * length, false});
    start.speed = addOwnQuantity(observed.name + ".speed",
                                 {"", turns ? "rad/s" : "m/s", 0, -fastest, fastest,
                                  std::max(options_.speedSd * units.speedSize, shown), false});
    trial.starts.push_back(start);
  }
}

std::size_t MusculoskeletalProblem::addOwnQuantity(const std::string& what, Quantity quantity) {
  quantity.trial = static_cast<int>(trials_.size());
  quantity.name = fmt::format("trial{}.initial.{}", quantity.trial + 1, what);
  quantity.lower = std::min(quantity.lower, quantity.nominal);
  quantity.upper = std::max(quantity.upper, quantity.nominal);
  nuisances_.push_back(quantities_.size());
  quantities_.push_back(std::move(quantity));
  return quantities_.size() - 1;
}

void MusculoskeletalProblem::separateWhatTrialsTellApart() {
  // the limb answers a push at once, but late muscles late; a clock that is off shifts both
  const bool isPushed = std::any_of(trials_.begin(), trials_.end(), [&](const OfTrial& trial) {
    return std::any_of(
        trial.trial.applied.begin(), trial.trial.applied.end(), [&](const auto& push) {
          const auto& all = encompassing_.coordinates();
          return std::any_of(
                     all.begin(), all.end(),
                     [&](const auto& at) { return at.coordinate.name == push.coordinate; }) &&
                 push.values.maxCoeff() > push.values.minCoeff();
        });
  });
  if (isPushed) encompassing_.separate("delay", "clock");
  // gravity's moment grows with a mass, that of a force on the hand does not
  const bool isLoaded = std::any_of(trials_.begin(), trials_.end(), [&](const OfTrial& trial) {
    return trial.trial.conditions.massInHand != trials_.front().trial.conditions.massInHand;
  });
  if (isLoaded) encompassing_.separate("tilt", "handforce");
}

double MusculoskeletalProblem::activationLag() const {
  double sum = 0, count = 0;
  for (const OfTrial& trial : trials_) {
    const auto& times = trial.recorded.excitation.times();
    VectorXd u(trial.recorded.excitation.numMuscles());
    std::size_t hint = 0;
    for (const double t : times) {
      trial.recorded.excitation.at(t, hint, u);
      for (Index i = 0; i < u.size(); ++i) {
        sum += encompassing_.system().muscles()[static_cast<std::size_t>(i)].activation.lag(u[i]);
        ++count;
      }
    }
  }
  return count > 0 ? sum / count : 0;
}

MusculoskeletalProblem::Prediction MusculoskeletalProblem::predict(
    int trial, const VectorXd& values, const VectorXd& latent,
    const std::vector<std::size_t>& wanted, bool latentToo) const {
  return predictWith(nullptr, trial, values, latent, wanted, latentToo);
}

std::unique_ptr<MusculoskeletalProblem::Simulation> MusculoskeletalProblem::simulated(
    int trial, const VectorXd& values, const VectorXd& latent,
    const std::vector<std::size_t>& wanted, bool latentToo) const {
  return simulatedWith(nullptr, trial, values, latent, wanted, latentToo);
}

MatrixXd MusculoskeletalProblem::inputs(int trial) const {
  const OfTrial& one = of(trial);
  MatrixXd values(static_cast<Index>(one.times.size()), one.recorded.excitation.numMuscles());
  std::size_t hint = 0;
  for (std::size_t i = 0; i < one.times.size(); ++i) {
    one.recorded.excitation.at(one.times[i], hint, values.row(static_cast<Index>(i)).transpose());
  }
  return values;
}

std::vector<std::string> MusculoskeletalProblem::inputNames() const {
  return muscleNames(encompassing_.system());
}

std::unique_ptr<info::discover::DiscoveryProblem> MusculoskeletalProblem::withFormula(
    std::size_t axis, const std::vector<info::discover::FormulaTerm>& terms,
    const std::vector<std::size_t>& kept) const {
  MusculoskeletalProblemOptions options = options_;
  options.formula = terms;
  options.formulaAxis = axis;
  for (std::size_t c = 0; c < candidates().size(); ++c) {
    if (std::find(kept.begin(), kept.end(), c) == kept.end())
      options.without.push_back(candidates()[c].id);
  }
  std::vector<Trial> trials;
  for (const OfTrial& trial : trials_) trials.push_back(trial.trial);
  auto widened = std::make_unique<MusculoskeletalProblem>(
      encompassing_.base(), encompassing_.systemOptions(), encompassing_.coordinateNames(),
      std::move(trials), std::move(options));
  if (!widened->encompassing().knows("formula")) return nullptr;
  return widened;
}

}  // namespace bio::discover
