#include "explore/live_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "bio/analysis/replay.h"
#include "bio/emg/emg_mapping.h"
#include "bio/opensim/osim_file.h"
#include "bio/sensitivity/coupled_sensitivity.h"
#include "info/dynamics/linear_table.h"
#include "view/system_shape.h"

namespace app {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Whether a path over the wrap objects of one model is another one in a model that differs in
/// numbers only.
bool hasChanged(const bio::Path& path, const bio::Path& other, const bio::Model& model,
                const bio::Model& changed) {
  if (path != other) return true;
  return std::any_of(path.wraps.begin(), path.wraps.end(), [&](const bio::PathWrap& wrap) {
    return findWrapObject(model, wrap.wrapObject) != findWrapObject(changed, wrap.wrapObject);
  });
}

/// The system of a changed model; paths that stay are not compiled again, which takes most of the
/// time.
bio::MusculoskeletalSystem changedSystem(const bio::Model& model, const bio::Model& changed,
                                         const bio::SystemOptions& options,
                                         const bio::MusculoskeletalSystem& nominal) {
  for (std::size_t i = 0; i < model.elasticPaths.size(); ++i) {
    if (hasChanged(model.elasticPaths[i].path, changed.elasticPaths[i].path, model, changed))
      return {changed, options};
  }
  std::vector<std::string> shaped;
  for (std::size_t i = 0; i < model.muscles.size(); ++i) {
    if (hasChanged(model.muscles[i].path, changed.muscles[i].path, model, changed))
      shaped.push_back(model.muscles[i].name);
  }
  return {changed, options, nominal, shaped};
}

}  // namespace

LiveModel::LiveModel(const std::filesystem::path& model, LiveChoice choice)
    : model_(bio::readOsim(model)),
      choice_(std::move(choice)),
      nominal_(model_, choice_.system),
      still_(bio::view::stillPaths(model_, nominal_, choice_.system.wrapAsCylinder)),
      bodies_(bio::view::drawnBodyNames(model_)) {}

void LiveModel::addTrial(const std::filesystem::path& file, const std::string& sha256) {
  bio::Trial trial = bio::readTrial(file, model_, choice_.trial);
  trial.sha256 = sha256;
  const bio::TrialBeginning beginning = bio::beginningOf(trial, model_, nominal_, choice_.initial);
  bio::RecordedTrial recorded = bio::recordedTrial(trial, nominal_, {});
  bio::ParameterCatalogue catalogue(model_, nominal_, beginning.point);
  trials_.push_back({std::move(trial), std::move(catalogue), std::move(recorded.excitation),
                     std::move(recorded.simulation)});
}

void LiveModel::select(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const bool isKnown = std::any_of(trials_.begin(), trials_.end(), [&](const LiveTrial& trial) {
      return trial.catalogue.has(name);
    });
    if (!isKnown) throw std::invalid_argument(fmt::format("'{}' is no parameter", name));
  }
  names_ = names;
  for (LiveTrial& trial : trials_) {
    trial.selection.clear();
    trial.given.clear();
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (!trial.catalogue.has(names_[i])) continue;
      trial.selection.push_back(trial.catalogue.find(names_[i]));
      trial.given.push_back(static_cast<Eigen::Index>(i));
    }
  }
}

void LiveModel::run(std::size_t trial, const Eigen::VectorXd& values, bio::Integrator integrator,
                    double step) {
  const LiveTrial& live = trials_.at(trial);
  if (values.size() != static_cast<Eigen::Index>(names_.size())) {
    throw std::invalid_argument(fmt::format("{} values, must be {}", values.size(), names_.size()));
  }
  bio::ParameterCatalogue::Setting setting = live.catalogue.at(live.selection, values(live.given));
  bio::MusculoskeletalSystem system =
      changedSystem(model_, setting.model, choice_.system, nominal_);
  bio::SimulationOptions options = live.simulation;
  options.integrator = integrator;
  options.step = step;
  bio::Trajectory motion = bio::simulateSetting(system, setting, live.excitation, options);
  std::vector<Eigen::VectorXd> measured;
  for (const bio::MeasuredChannel& channel : live.trial.measured) {
    const bool canBe =
        !channel.what.isCoordinate() || system.skeleton().indexOf(channel.what.object) >= 0;
    measured.push_back(
        canBe ? bio::ObservedMotion(system, {{channel.what, channel.times}}).values(motion)
              : Eigen::VectorXd::Constant(channel.times.size(), nan));
  }
  const bio::ExcitationSignal driven =
      bio::drivenExcitation(live.excitation, bio::muscleNames(system), setting.mapping);
  excitations_.resize(static_cast<Eigen::Index>(system.numMuscles()),
                      static_cast<Eigen::Index>(motion.time.size()));
  std::size_t hint = 0;
  for (std::size_t k = 0; k < motion.time.size(); ++k)
    driven.at(motion.time[k], hint, excitations_.col(static_cast<Eigen::Index>(k)));
  motion_ = std::move(motion);
  measured_ = std::move(measured);
  setting_ = std::move(setting);
  system_.emplace(std::move(system));
}

std::vector<std::string> LiveModel::paths() const {
  return bio::view::drawnPathNames(nominal_, still_);
}

Eigen::VectorXd LiveModel::postureAt(double time) const {
  std::vector<bio::ObservedSeries> coordinates;
  for (const bio::Coordinate& one : system_->skeleton().coordinates())
    coordinates.push_back({bio::ofCoordinate(one.name), Eigen::VectorXd::Constant(1, time)});
  return bio::ObservedMotion(*system_, std::move(coordinates)).values(motion_);
}

void LiveModel::drawMuscles(double time, const Eigen::VectorXd& q, Drawing& drawing) const {
  const std::size_t n = system_->numMuscles();
  const info::LinearWeights at = info::linearAt(motion_.time, time);
  bio::Trajectory moment;
  moment.time = {time};
  moment.q = q;
  moment.qDot = at.rows(motion_.qDot.transpose()).transpose();
  moment.activation = at.rows(motion_.activation.transpose()).transpose();
  moment.fibreLength = at.rows(motion_.fibreLength.transpose()).transpose();
  const bio::MuscleReport report = bio::reportMuscles(*system_, moment);
  for (std::size_t i = 0; i < drawing.paths.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    drawing.paths[i].force = i < n ? report.tendonForce(k, 0) : nan;
    drawing.paths[i].activation = i < n ? moment.activation(k, 0) : nan;
  }
}

LiveModel::Drawing LiveModel::drawingAt(double time) const {
  if (!system_) throw std::logic_error("drawingAt: nothing has been simulated");
  time = std::clamp(time, motion_.time.front(), motion_.time.back());
  const Eigen::VectorXd q = postureAt(time);
  const bio::view::PlacedPaths placed = bio::view::placedPaths(
      system_->skeleton(), bodies_, bio::view::drawnPaths(*system_, still_), q);
  Drawing drawing;
  drawing.bodies = placed.bodies;
  for (const std::vector<Eigen::Vector3d>& line : placed.lines)
    drawing.paths.push_back({line, nan, nan});
  drawMuscles(time, q, drawing);
  return drawing;
}

}  // namespace app
