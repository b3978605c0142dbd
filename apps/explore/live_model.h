#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/observation/observed_motion.h"
#include "bio/parameters/parameters.h"
#include "bio/simulation/simulate.h"
#include "bio/tables/trial.h"
#include "view/still_paths.h"

/// The simulation behind the page of `explore`: what `replay` computes, again and again with other
/// parameters. Compiled into the program and into the page (live_exports.cc), so that both compute
/// the same.
namespace app {

/// How the trials of a page are read and simulated: what the options of `replay` say.
struct LiveChoice {
  bio::SystemOptions system;
  bio::TrialOptions trial;
  std::map<std::string, double> initial;  ///< values at the start [rad] or [m], by coordinate
};

/// A muscle, ligament or path spring at one moment.
struct LivePath {
  std::vector<Eigen::Vector3d> points;  ///< centre line in ground [m]; empty: a function, no line
  double force = 0;                     ///< of the tendon or string [N]; NaN: not simulated
  double activation = 0;                ///< NaN: no muscle, or not simulated
};

/// A model and its recorded trials, simulated with parameters that change.
class LiveModel {
 public:
  /// @throws what readOsim and MusculoskeletalSystem throw
  LiveModel(const std::filesystem::path& model, LiveChoice choice);

  /// @param sha256  of the file; with it the model's fitted start is found
  /// @throws what readTrial, beginningOf and recordedTrial throw
  void addTrial(const std::filesystem::path& file, const std::string& sha256);

  const bio::Model& model() const { return model_; }
  const bio::ParameterCatalogue& catalogue(std::size_t trial) const {
    return trials_.at(trial).catalogue;
  }
  const bio::Trial& trial(std::size_t index) const { return trials_.at(index).trial; }
  std::size_t numTrials() const { return trials_.size(); }

  /// The parameters whose values run() takes, by name.
  /// @throws std::invalid_argument for a name that no trial's catalogue has
  void select(const std::vector<std::string>& names);

  /// Simulates a trial with the selected parameters at these values, all others as in the model.
  /// After an error the last motion stays.
  /// @throws std::invalid_argument what ParameterCatalogue::at and MusculoskeletalSystem throw;
  ///   NoStaticEquilibrium
  void run(std::size_t trial, const Eigen::VectorXd& values, bio::Integrator integrator,
           double step);
  /// The model of the last run.
  const bio::Model& changedModel() const { return setting_->model; }

  const bio::Trajectory& motion() const { return motion_; }
  const bio::MusculoskeletalSystem& system() const { return *system_; }
  /// At the rows of the motion; rows = muscles.
  const Eigen::MatrixXd& excitations() const { return excitations_; }
  /// Simulated values of each measured channel at its times; NaN where the motion has none.
  const std::vector<Eigen::VectorXd>& measured() const { return measured_; }

  /// The bodies that a picture has: the ground, then the model's.
  const std::vector<std::string>& bodies() const { return bodies_; }
  /// Muscles that are simulated, elastic paths, then muscles that no free coordinate moves.
  std::vector<std::string> paths() const;
  struct Drawing {
    std::vector<bio::Placement<double>> bodies;  ///< in ground
    std::vector<LivePath> paths;
  };
  /// The last motion at a time [s], between its rows by the cubic of Hermite.
  Drawing drawingAt(double time) const;

 private:
  struct LiveTrial {
    bio::Trial trial;
    bio::ParameterCatalogue catalogue;
    bio::ExcitationSignal excitation;
    bio::SimulationOptions simulation;
    std::vector<std::size_t> selection = {};  ///< of its catalogue, in the order of names_
    std::vector<Eigen::Index> given = {};     ///< which of the values those are
  };
  Eigen::VectorXd postureAt(double time) const;
  void drawMuscles(double time, const Eigen::VectorXd& q, Drawing& drawing) const;

  bio::Model model_;
  LiveChoice choice_;
  bio::MusculoskeletalSystem nominal_;
  bio::view::StillPaths still_;
  std::vector<LiveTrial> trials_;
  std::vector<std::string> names_;
  std::vector<std::string> bodies_;
  std::optional<bio::ParameterCatalogue::Setting> setting_;
  std::optional<bio::MusculoskeletalSystem> system_;
  bio::Trajectory motion_;
  Eigen::MatrixXd excitations_;
  std::vector<Eigen::VectorXd> measured_;
};

}  // namespace app
