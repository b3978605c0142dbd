#include "bio/analysis/ensemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "bio/sensitivity/coupled_sensitivity.h"
#include "bio/simulation/integrator_names.h"
#include "bio/simulation/simulate_batch.h"

namespace bio {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// RMS difference where both have a value; NaN if they have none.
double rmsDifference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double sum = 0, count = 0;
  for (const double difference : a - b) {
    if (std::isnan(difference)) continue;
    sum += difference * difference;
    ++count;
  }
  return std::sqrt(sum / count);
}

/// Muscles with a path point or a wrap object among the targets of these parameters.
std::vector<std::string> shapedMuscles(const ParameterCatalogue& catalogue,
                                       const std::vector<std::size_t>& selection) {
  std::vector<std::string> names;
  const Model& model = catalogue.model();
  for (const std::size_t index : selection) {
    for (const ParameterTarget& target : catalogue.parameters().at(index).targets) {
      if (const auto* point = std::get_if<PointTarget>(&target)) {
        names.push_back(model.muscles[point->muscle].name);
      } else if (const auto* wrap = std::get_if<WrapTarget>(&target)) {
        const std::string& object = model.wrapObjects[wrap->wrap].name;
        for (const Muscle& muscle : model.muscles) {
          for (const PathWrap& over : muscle.path.wraps) {
            if (over.wrapObject == object) names.push_back(muscle.name);
          }
        }
      }
    }
  }
  return names;
}

bool changesExcitations(const ParameterCatalogue& catalogue,
                        const std::vector<std::size_t>& selection) {
  return std::any_of(selection.begin(), selection.end(), [&](std::size_t index) {
    const auto& targets = catalogue.parameters().at(index).targets;
    return std::any_of(targets.begin(), targets.end(), [](const ParameterTarget& target) {
      return std::holds_alternative<EmgTarget>(target);
    });
  });
}

}  // namespace

/// Parts of one simulation; no system if there is none with these parameters.
struct SystemBatch::Draw {
  std::unique_ptr<const MusculoskeletalSystem> system;
  std::unique_ptr<const ExcitationSignal> excitation;  ///< unless it is the nominal one
  SystemState start;
};

SystemBatch::SystemBatch(const ParameterCatalogue& catalogue, const SystemOptions& system,
                         ExcitationSignal trial, std::vector<EnsembleChannel> channels,
                         std::vector<double> course, std::vector<std::size_t> selection,
                         const SimulationOptions& options)
    : catalogue_(&catalogue),
      systemOptions_(system),
      trial_(std::move(trial)),
      channels_(std::move(channels)),
      course_(std::move(course)),
      selection_(std::move(selection)),
      options_(options),
      system_(catalogue.model(), system),
      driven_(drivenExcitation(trial_, muscleNames(system_), catalogue.nominal().mapping)),
      drawsEmg_(changesExcitations(catalogue, selection_)),
      shaped_(shapedMuscles(catalogue, selection_)) {
  for (const EnsembleChannel& channel : channels_) {
    series_.push_back({channel.what, {}});  // its times are known when the motion is
    series_.push_back({channel.what, Eigen::VectorXd::Map(course_.data(), std::ssize(course_))});
    series_.push_back(
        {channel.what, channel.measured ? channel.measured->times : Eigen::VectorXd()});
  }
  (void)ObservedMotion(system_, series_);  // throws for what cannot be observed
  const SystemState start = startOf(system_, catalogue.nominal(), driven_, options_.startTime);
  const LaneJob own{&system_, &driven_, &start};
  const Trajectory motion = simulateTogether({&own, 1}, options_).front();
  if (motion.outcome != Outcome::completed) {
    throw std::invalid_argument(
        fmt::format("the model's own motion does not reach the end of the trial: {}", motion.why));
  }
  for (std::size_t s = 0; s < series_.size(); s += 3) {
    series_[s].times = Eigen::VectorXd::Map(motion.time.data(), std::ssize(motion.time));
  }
  nominalValues_ = ObservedMotion(system_, series_).values(motion);
  nominal_ = describe(system_, motion);
}

EnsembleRun SystemBatch::notFinished(const std::string& outcome, double failedAt) const {
  const Eigen::VectorXd course = Eigen::VectorXd::Constant(std::ssize(course_), none);
  return {outcome, failedAt,
          std::vector<ChannelRun>(channels_.size(), {none, none, none, none, none, course})};
}

EnsembleRun SystemBatch::describe(const MusculoskeletalSystem& system,
                                  const Trajectory& motion) const {
  if (motion.outcome != Outcome::completed) {
    return notFinished(name(motion.outcome), motion.failedAt);
  }
  const Eigen::VectorXd values = ObservedMotion(system, series_).values(motion);
  EnsembleRun run{name(motion.outcome), none, {}};
  Eigen::Index at = 0;
  for (const EnsembleChannel& channel : channels_) {
    const auto rows = series_.front().times.size(), points = std::ssize(course_);
    const Eigen::VectorXd measured =
        channel.measured ? channel.measured->values : Eigen::VectorXd();
    const auto all = values.segment(at, rows);
    run.channels.push_back(
        {rmsDifference(values.segment(at + rows + points, measured.size()), measured),
         rmsDifference(all, nominalValues_.segment(at, rows)), all[rows - 1], all.minCoeff(),
         all.maxCoeff(), values.segment(at + rows, points)});
    at += rows + points + measured.size();
  }
  return run;
}

SystemBatch::Draw SystemBatch::prepare(const Eigen::VectorXd& theta) const {
  const ParameterCatalogue::Setting setting = catalogue_->at(selection_, theta);
  try {
    Draw draw;
    auto system = std::make_unique<const MusculoskeletalSystem>(setting.model, systemOptions_,
                                                                system_, shaped_);
    if (drawsEmg_) {
      draw.excitation = std::make_unique<const ExcitationSignal>(
          drivenExcitation(trial_, muscleNames(*system), setting.mapping));
    }
    draw.start =
        startOf(*system, setting, draw.excitation ? *draw.excitation : driven_, options_.startTime);
    draw.system = std::move(system);
    return draw;
  } catch (const std::logic_error&) {  // outside the model's domain
  } catch (const NoStaticEquilibrium&) {
  }
  return {};
}

EnsembleRun SystemBatch::run(const Eigen::VectorXd& theta) const {
  return run(std::span(&theta, 1)).front();
}

std::vector<EnsembleRun> SystemBatch::run(std::span<const Eigen::VectorXd> thetas) const {
  std::vector<EnsembleRun> runs(thetas.size(), notFinished("impossible", none));
  std::vector<Draw> draws;
  std::vector<LaneJob> jobs;
  std::vector<std::size_t> places;
  for (const Eigen::VectorXd& theta : thetas) draws.push_back(prepare(theta));
  for (std::size_t i = 0; i < draws.size(); ++i) {
    const Draw& draw = draws[i];
    if (!draw.system) continue;
    jobs.push_back(
        {draw.system.get(), draw.excitation ? draw.excitation.get() : &driven_, &draw.start});
    places.push_back(i);
  }
  const auto simulate = [&](std::size_t first, std::size_t count) {
    const auto motions = simulateTogether({jobs.data() + first, count}, options_);
    for (std::size_t k = 0; k < count; ++k)
      runs[places[first + k]] = describe(*jobs[first + k].system, motions[k]);
  };
  try {
    simulate(0, jobs.size());
  } catch (const std::logic_error&) {  // one of them leaves the model's domain: which?
    for (std::size_t k = 0; k < jobs.size(); ++k) {
      try {
        simulate(k, 1);
      } catch (const std::logic_error&) {
      }
    }
  }
  return runs;
}

}  // namespace bio
