#include "bio/analysis/ensemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <stdexcept>

#include "bio/sensitivity/coupled_sensitivity.h"
#include "bio/simulation/integrator_names.h"
#include "bio/simulation/simulate_batch.h"
#include "simulation/motion_weights.h"

namespace bio {
namespace {

EnsembleRun notFinished(std::string outcome, double failedAt, std::size_t course) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  return {std::move(outcome),
          failedAt,
          none,
          none,
          none,
          none,
          none,
          Eigen::VectorXd::Constant(static_cast<Eigen::Index>(course), none)};
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
                         ExcitationSignal trial, const std::string& coordinate,
                         std::optional<MeasuredChannel> measured, std::vector<double> course,
                         std::vector<std::size_t> selection, const SimulationOptions& options)
    : catalogue_(&catalogue),
      systemOptions_(system),
      trial_(std::move(trial)),
      measured_(std::move(measured)),
      course_(std::move(course)),
      selection_(std::move(selection)),
      options_(options),
      system_(catalogue.model(), system),
      driven_(drivenExcitation(trial_, muscleNames(system_), catalogue.nominal().mapping)),
      drawsEmg_(changesExcitations(catalogue, selection_)),
      shaped_(shapedMuscles(catalogue, selection_)),
      coordinate_(system_.skeleton().indexOf(coordinate)) {
  if (coordinate_ < 0) {
    throw std::invalid_argument(fmt::format("observed coordinate '{}' is not free", coordinate));
  }
  const SystemState start = startOf(system_, catalogue.nominal(), driven_, options_.startTime);
  const LaneJob own{&system_, &driven_, &start};
  const Trajectory motion = simulateTogether({&own, 1}, options_).front();
  if (motion.outcome != Outcome::completed) {
    throw std::invalid_argument(
        fmt::format("the model's own motion does not reach the end of the trial: {}", motion.why));
  }
  nominalMotion_ = motion.q.row(coordinate_);
  nominal_ = describe(motion);
}

EnsembleRun SystemBatch::describe(const Trajectory& motion) const {
  if (motion.outcome != Outcome::completed) {
    return notFinished(name(motion.outcome), motion.failedAt, course_.size());
  }
  EnsembleRun run =
      notFinished(name(motion.outcome), std::numeric_limits<double>::quiet_NaN(), course_.size());
  const auto q = motion.q.row(coordinate_);
  if (measured_) run.rmsError = compareWithMeasured(system_, motion, *measured_).rms;
  run.rmsFromNominal =
      std::sqrt((q - nominalMotion_).squaredNorm() / static_cast<double>(q.size()));
  run.last = q[q.size() - 1];
  run.lowest = q.minCoeff();
  run.highest = q.maxCoeff();
  for (std::size_t i = 0; i < course_.size(); ++i) {
    if (const auto w = weightsAt(motion.time, course_[i])) {
      run.atCourse[static_cast<Eigen::Index>(i)] = w->value(q, motion.qDot.row(coordinate_));
    }
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
  std::vector<EnsembleRun> runs(
      thetas.size(),
      notFinished("impossible", std::numeric_limits<double>::quiet_NaN(), course_.size()));
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
    for (std::size_t k = 0; k < count; ++k) runs[places[first + k]] = describe(motions[k]);
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
