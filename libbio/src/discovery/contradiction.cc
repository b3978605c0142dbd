#include "bio/discovery/contradiction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>

#include "bio/analysis/inverse_dynamics.h"
#include "bio/analysis/replay.h"
#include "bio/discovery/with_experimental_conditions.h"
#include "bio/model/units.h"
#include "bio/observation/smoothed_motion.h"
#include "info/dynamics/linear_table.h"

namespace bio::discover {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double cutoff = 3;       ///< of the smoothed motion [Hz]
constexpr double spacing = 0.01;   ///< of its samples [s]
constexpr double shortest = 0.5;   ///< duration of a trial that can be judged [s]
constexpr double ends = 0.05;      ///< share of a trial that is left out on either side
constexpr double farthest = 2;     ///< shift of the excitations [s], at most a third of a trial
constexpr double nearest = 0.3;    ///< a smaller one is a delay
constexpr double shiftStep = 0.1;  ///< [s]
constexpr double tie = 0.05;       ///< difference of correlations that says nothing

/// What is compared of a trial, on a grid of times.
struct Recorded {
  std::string name;
  /// The model under the trial's experimental conditions, with all coordinates prescribed.
  std::shared_ptr<const MusculoskeletalSystem> driven;
  std::vector<double> times;
  MatrixXd q;       ///< the system's coordinates × times
  MatrixXd moment;  ///< measured: coordinates in question × times; 0 of a free coordinate
  ExcitationSignal excitation;
  SimulationOptions simulation;
};

VectorXd onGrid(const MeasuredChannel& channel, const std::vector<double>& times) {
  const std::vector<double> at(channel.times.begin(), channel.times.end());
  const SmoothedMotion smooth = smoothed(at, channel.values, cutoff, spacing);
  VectorXd values(static_cast<Index>(times.size()));
  for (std::size_t k = 0; k < times.size(); ++k)
    values[static_cast<Index>(k)] = info::linearAt(smooth.times, times[k]).value(smooth.values);
  return values;
}

ExcitationSignal noExcitation(const ExcitationSignal& like) {
  return {{0}, MatrixXd::Zero(1, like.numMuscles())};
}

ExcitationSignal shifted(const ExcitationSignal& signal, double by) {
  std::vector<double> times = signal.times();
  MatrixXd values(static_cast<Index>(times.size()), signal.numMuscles());
  std::size_t hint = 0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    signal.at(times[k], hint, values.row(static_cast<Index>(k)).transpose());
    times[k] += by;
  }
  return {std::move(times), std::move(values)};
}

/// The recording with its excitations later by so many seconds (earlier if negative), without the
/// part that they do not cover then.
Recorded withLaterExcitations(Recorded trial, double by) {
  trial.excitation = shifted(trial.excitation, by);
  const auto lost = static_cast<std::ptrdiff_t>(std::abs(by) / spacing);
  const std::ptrdiff_t kept = std::ssize(trial.times) - lost, from = by > 0 ? lost : 0;
  trial.times = {trial.times.begin() + from, trial.times.begin() + from + kept};
  trial.q = MatrixXd(trial.q.middleCols(from, kept));
  trial.moment = MatrixXd(trial.moment.middleCols(from, kept));
  return trial;
}

class Comparison {
 public:
  Comparison(const Model& model, const SystemOptions& options,
             const std::vector<std::string>& inQuestion)
      : model_(model),
        options_(options),
        system_(model, options),
        inQuestion_(inQuestion),
        driven_(drivenBy(model)) {
    const auto& all = system_.skeleton().coordinates();
    for (const std::string& name : inQuestion) {
      const auto at = std::find_if(all.begin(), all.end(),
                                   [&](const auto& coordinate) { return coordinate.name == name; });
      if (at != all.end()) rows_.push_back(static_cast<Index>(at - all.begin()));
    }
  }

  bool isPossible() const { return system_.numMuscles() > 0 && rows_.size() == inQuestion_.size(); }
  const std::vector<Index>& rows() const { return rows_; }
  bool isFree(std::size_t i) const { return !system_.isPrescribed(static_cast<int>(rows_[i])); }
  bool isRotation(std::size_t i) const {
    return system_.skeleton().coordinates()[static_cast<std::size_t>(rows_[i])].isRotation;
  }

  /// The recorded motion; nothing if it is not known throughout.
  std::optional<Recorded> recorded(const Trial& trial) const {
    std::vector<const MeasuredChannel*> motion, moments;
    double first = trial.times[0], last = trial.times[trial.times.size() - 1];
    const auto take = [&](const Observable& what, std::vector<const MeasuredChannel*>& list) {
      const MeasuredChannel* channel = trial.measurementOf(what);
      list.push_back(channel);
      if (!channel || channel->times.size() < 4) return false;
      first = std::max(first, channel->times[0]);
      last = std::min(last, channel->times[channel->times.size() - 1]);
      return true;
    };
    const auto& all = system_.skeleton().coordinates();
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (system_.isPrescribed(static_cast<int>(k)))
        motion.push_back(nullptr);
      else if (!take(ofCoordinate(all[k].name), motion))
        return {};
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (isFree(i))
        moments.push_back(nullptr);
      else if (!take({Observable::Kind::moment, inQuestion_[i], 0}, moments))
        return {};
    }
    if (!(last - first > shortest)) return {};
    Recorded result;
    result.name = std::filesystem::path(trial.file).filename().string();
    result.driven = trial.conditions.any()
                        ? drivenBy(withExperimentalConditions(model_, options_, inQuestion_, trial))
                        : driven_;
    for (double t = first; t < last; t += spacing) result.times.push_back(t);
    const auto n = static_cast<Index>(result.times.size());
    Trial smooth = trial;
    smoothPrescribed(smooth, cutoff);
    result.q = courses(prescribedMotionOf(smooth, system_), result.times);
    for (std::size_t k = 0; k < motion.size(); ++k)
      if (motion[k]) result.q.row(static_cast<Index>(k)) = onGrid(*motion[k], result.times);
    result.moment = MatrixXd::Zero(static_cast<Index>(rows_.size()), n);
    for (std::size_t i = 0; i < moments.size(); ++i)
      if (moments[i]) result.moment.row(static_cast<Index>(i)) = onGrid(*moments[i], result.times);
    RecordedTrial inputs = recordedTrial(trial, system_, {});
    result.excitation = std::move(inputs.excitation);
    result.simulation = std::move(inputs.simulation);
    return result;
  }

  /// Mean correlation over the coordinates in question; NaN if it cannot be told.
  double correlation(const std::vector<Recorded>& trials) const {
    const auto n = static_cast<Index>(rows_.size());
    VectorXd both = VectorXd::Zero(n), made = both, required = both;
    try {
      for (const Recorded& trial : trials) {
        const MatrixXd without = reactions(trial, noExcitation(trial.excitation));
        const MatrixXd with = reactions(trial, trial.excitation);
        const auto skipped =
            static_cast<Index>(ends * static_cast<double>(std::min(with.cols(), without.cols())));
        const Index count = std::min(with.cols(), without.cols()) - 2 * skipped;
        for (Index i = 0; i < n; ++i) {
          const auto part = [&](const MatrixXd& from) {
            VectorXd row = from.row(i).segment(skipped, count).transpose();
            row.array() -= row.mean();
            return row;
          };
          const VectorXd need = part(without) + part(trial.moment);
          const VectorXd muscles = part(without) - part(with);
          both[i] += need.dot(muscles);
          made[i] += muscles.squaredNorm();
          required[i] += need.squaredNorm();
        }
      }
    } catch (const std::exception&) {
      return NAN;  // the model cannot make this motion
    }
    return (both.array() / (made.array() * required.array()).sqrt()).mean();
  }

 private:
  std::shared_ptr<const MusculoskeletalSystem> drivenBy(const Model& model) const {
    return std::make_shared<const MusculoskeletalSystem>(
        MusculoskeletalSystem(model, options_).withAllPrescribed());
  }

  MatrixXd courses(const PrescribedMotion& motion, const std::vector<double>& times) const {
    const Index n = system_.skeleton().numCoordinates();
    MatrixXd q = MatrixXd::Zero(n, static_cast<Index>(times.size()));
    VectorXd at = VectorXd::Zero(n), rate = at, acceleration = at;
    for (std::size_t k = 0; k < times.size(); ++k) {
      motion.place(times[k], at, rate, acceleration);
      q.col(static_cast<Index>(k)) = at;
    }
    return q;
  }

  /// Reactions of the coordinates in question, at the grid's times.
  MatrixXd reactions(const Recorded& trial, const ExcitationSignal& excitation) const {
    const Trajectory motion =
        inverseDynamicsOf(*trial.driven, excitation, trial.times, trial.q, trial.simulation);
    if (motion.outcome != Outcome::completed) throw std::domain_error(motion.why);
    const auto count = static_cast<Index>(
        std::min(trial.times.size(), static_cast<std::size_t>(motion.reaction.cols())));
    MatrixXd result(static_cast<Index>(rows_.size()), count);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const VectorXd row = motion.reaction.row(rows_[i]);
      for (Index k = 0; k < count; ++k)
        result(static_cast<Index>(i), k) =
            info::linearAt(motion.time, trial.times[static_cast<std::size_t>(k)]).value(row);
    }
    return result;
  }

  const Model& model_;
  const SystemOptions& options_;
  MusculoskeletalSystem system_;
  std::vector<std::string> inQuestion_;
  std::vector<Index> rows_;                              ///< of the coordinates in question
  std::shared_ptr<const MusculoskeletalSystem> driven_;  ///< without experimental conditions
};

/// The search for what would make a recording agree with itself.
class Remedies {
 public:
  Remedies(const Comparison& comparison, const std::vector<std::string>& names,
           const std::vector<Recorded>& trials, const std::function<bool()>& goOn)
      : comparison_(comparison), names_(names), trials_(trials), goOn_(goOn) {}

  void run(InputAgreement& result) {
    ofSigns();
    for (std::size_t i = 0; i < names_.size(); ++i)
      if (comparison_.isRotation(i)) ofAngle(i);
    ofTime();
    ofTrials();
    if (stopped_) return;
    std::stable_sort(found_.begin(), found_.end(),
                     [](const Found& a, const Found& b) { return a.correlation > b.correlation; });
    for (const Found& found : found_) {
      const bool helps = found.correlation > InputAgreement::largeEnough &&
                         found.correlation > result.correlation + InputAgreement::gain;
      if (helps && found.correlation > found_.front().correlation - tie)
        result.remedies.push_back(found.clause);
    }
    if (!result.remedies.empty()) result.remedied = found_.front().correlation;
  }

 private:
  struct Found {
    std::string clause;
    double correlation;
  };

  double correlation(const std::vector<Recorded>& changed) {
    stopped_ = stopped_ || !goOn_();
    return stopped_ ? NAN : comparison_.correlation(changed);
  }
  void consider(std::string clause, const std::vector<Recorded>& changed) {
    const double correlation = this->correlation(changed);
    if (std::isfinite(correlation)) found_.push_back({std::move(clause), correlation});
  }
  template <class Change>
  void considerAll(std::string clause, const Change& change) {
    std::vector<Recorded> changed = trials_;
    for (Recorded& trial : changed) change(trial);
    consider(std::move(clause), changed);
  }

  /// Reverses each channel, and each two together.
  void ofSigns() {
    struct Channel {
      std::string name;
      std::size_t coordinate;
      bool isMoment;
    };
    std::vector<Channel> channels;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      channels.push_back({names_[i], i, false});
      if (!comparison_.isFree(i)) channels.push_back({names_[i] + ".moment", i, true});
    }
    const auto reverse = [&](Recorded& trial, const Channel& channel) {
      if (channel.isMoment)
        trial.moment.row(static_cast<Index>(channel.coordinate)) *= -1;
      else
        trial.q.row(comparison_.rows()[channel.coordinate]) *= -1;
    };
    for (std::size_t a = 0; a < channels.size(); ++a) {
      considerAll(fmt::format("the sign of {} is reversed", channels[a].name),
                  [&](Recorded& trial) { reverse(trial, channels[a]); });
      for (std::size_t b = a + 1; b < channels.size(); ++b)
        considerAll(
            fmt::format("the signs of {} and {} are reversed", channels[a].name, channels[b].name),
            [&](Recorded& trial) {
              reverse(trial, channels[a]);
              reverse(trial, channels[b]);
            });
    }
  }

  void ofAngle(std::size_t i) {
    const Index row = comparison_.rows()[i];
    const std::string& name = names_[i];
    considerAll(
        fmt::format("{} is 180 degrees minus what was recorded", name),
        [&](Recorded& trial) { trial.q.row(row) = std::numbers::pi - trial.q.row(row).array(); });
    double largest = 0;
    for (const Recorded& trial : trials_)
      largest = std::max(largest, trial.q.row(row).cwiseAbs().maxCoeff());
    if (degreesPerRadian * largest < 2 * std::numbers::pi)
      considerAll(fmt::format("{} is in radians, not in degrees", name),
                  [&](Recorded& trial) { trial.q.row(row) *= degreesPerRadian; });
  }

  /// The excitations, or the motion, of all trials are late.
  void ofTime() {
    double duration = HUGE_VAL;
    for (const Recorded& trial : trials_)
      duration = std::min(duration, trial.times.back() - trial.times.front());
    const double most = std::min(farthest, duration / 3);
    std::optional<Found> best;
    for (const double direction : {1.0, -1.0}) {
      for (double by = nearest; by < most; by += shiftStep) {
        std::vector<Recorded> changed;
        for (const Recorded& trial : trials_)
          changed.push_back(withLaterExcitations(trial, direction * by));
        const double correlation = this->correlation(changed);
        if (best && !(correlation > best->correlation)) continue;
        best = Found{
            fmt::format("the excitations are {:.1f} s {}", by, direction > 0 ? "early" : "late"),
            correlation};
      }
    }
    if (best && std::isfinite(best->correlation)) found_.push_back(*best);
  }

  /// Excitations of another trial.
  void ofTrials() {
    if (trials_.size() < 2) return;
    std::vector<Recorded> changed = trials_;
    std::string words;
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      double most = -HUGE_VAL;
      std::size_t best = i;
      for (std::size_t k = 0; k < trials_.size(); ++k) {
        Recorded trial = trials_[i];
        trial.excitation = trials_[k].excitation;
        const double correlation = this->correlation({trial});
        if (!(correlation > most)) continue;
        most = correlation;
        best = k;
      }
      if (best == i) continue;
      changed[i].excitation = trials_[best].excitation;
      words += fmt::format("{}the motion of {} belongs to the excitations of {}",
                           words.empty() ? "" : ", ", trials_[i].name, trials_[best].name);
    }
    if (!words.empty()) consider(words, changed);
  }

  const Comparison& comparison_;
  const std::vector<std::string>& names_;
  const std::vector<Recorded>& trials_;
  const std::function<bool()>& goOn_;
  std::vector<Found> found_;
  bool stopped_ = false;
};

}  // namespace

InputAgreement inputAgreement(const Model& model, const SystemOptions& system,
                              const CoordinateNames& coordinates, const std::vector<Trial>& trials,
                              const std::function<bool()>& goOn) {
  InputAgreement result;
  const Comparison comparison(model, system, coordinates.all);
  if (!comparison.isPossible()) return result;
  std::vector<Recorded> recorded;
  for (const Trial& trial : trials) {
    auto one = comparison.recorded(trial);
    if (!one) return result;
    recorded.push_back(std::move(*one));
  }
  result.correlation = comparison.correlation(recorded);
  if (result.correlation < InputAgreement::tooSmall)
    Remedies(comparison, coordinates.all, recorded, goOn).run(result);
  return result;
}

}  // namespace bio::discover
