#pragma once

#include <map>
#include <string>

#include "bio/analysis/replay.h"
#include "bio/observation/trial_predictor.h"
#include "bio/opensim/osim_file.h"
#include "info/probability/random_stream.h"

namespace bio::fixtures {

/// Trials of the shipped elbow whose truth is known: a shipped trial's excitations, and the angle
/// that the model moves to with some parameters at other values.
struct SyntheticElbow {
  SyntheticElbow()
      : model(readOsim(std::string(FISHERHILL_SOURCE_DIR) + "/models/elbow8.osim")),
        system(model, options()) {}

  static SystemOptions options() { return {{{"elbow_flexion"}, {}}, {}, {}}; }

  /// @param duration [s] from the start of the shipped trial
  /// @param every    rows between measured values
  Trial trial(const std::string& shipped, double duration,
              const std::map<std::string, double>& truth = {}, double startDegrees = 30,
              Eigen::Index every = 4) const {
    Trial result =
        readTrial(std::string(FISHERHILL_SOURCE_DIR) + "/emg_data/" + shipped + ".sto", model);
    Eigen::Index rows = 0;
    while (rows < result.times.size() && result.times[rows] <= duration + 1e-9) ++rows;
    result.times.conservativeResize(rows);
    result.excitations.conservativeResize(rows, Eigen::NoChange);
    const ExcitationSignal signal = excitationOf(result, system);
    const StartPoint start{Eigen::VectorXd::Constant(1, startDegrees / 180 * 3.141592653589793),
                           {}};
    const ParameterCatalogue catalogue(model, system, start);
    std::vector<std::size_t> selection;
    std::vector<double> values;
    for (const auto& [name, value] : truth) {
      selection.push_back(catalogue.find(name));
      values.push_back(value);
    }
    SimulationOptions simulation;
    simulation.startTime = result.times[0];
    simulation.duration = result.times[rows - 1] - result.times[0];
    MeasuredChannel measured{ofCoordinate("elbow_flexion"), {}, {}};
    std::vector<double> times;
    for (Eigen::Index k = 0; k < rows; k += every) times.push_back(result.times[k]);
    const auto n = static_cast<Eigen::Index>(times.size());
    measured.times = Eigen::VectorXd::Map(times.data(), n);
    const TrialPredictor experiment(catalogue, options(), signal, "elbow_flexion", times, selection,
                                    simulation);
    measured.values = experiment.outputs(
        Eigen::VectorXd::Map(values.data(), static_cast<Eigen::Index>(values.size())));
    result.measured = {measured};
    result.file = shipped + ".sto";
    return result;
  }

  /// Of a parameter in the model.
  double valueOf(const std::string& parameter) const {
    const ParameterCatalogue catalogue(model, system, {system.skeleton().defaultValues(), {}});
    return catalogue.parameters()[catalogue.find(parameter)].value;
  }

  /// The trial with noise on its angle. The first value keeps exact: it is where simulations start.
  static Trial noisy(Trial trial, double degrees, std::uint64_t seed, std::uint64_t stream = 0) {
    info::RandomStream random(seed, stream);
    Eigen::VectorXd& values = trial.measured[0].values;
    for (Eigen::Index k = 1; k < values.size(); ++k) {
      values[k] += degrees / 180 * 3.141592653589793 * random.normal();
    }
    return trial;
  }

  Model model;
  MusculoskeletalSystem system;
};

}  // namespace bio::fixtures
