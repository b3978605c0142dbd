#include <numbers>

#include "arms.h"
#include "bio/analysis/replay.h"
#include "bio/calibration/trial_predictor.h"
#include "bio/parameters/parameter_information.h"
#include "interruptible.h"

namespace python {
namespace {

py::object sensitivity(const bio::Model& model, const std::vector<bio::Trial>& trials,
                       const std::vector<std::string>& parameters, double noise,
                       const py::kwargs& keywords) {
  const SystemChoice choice = armChoice(keywords);
  if (trials.empty()) throw std::invalid_argument("trials: empty, must have at least one");
  std::vector<Eigen::MatrixXd> gammas;
  std::vector<Eigen::VectorXd> outputs;
  std::vector<std::vector<double>> times;
  bio::ParameterInformation information;
  Eigen::VectorXd values;
  interruptible([&](const std::atomic<bool>& goOn) {
    const bio::MusculoskeletalSystem arm(model, choice.armOptions());
    const std::string coordinate = choice.coordinates.front();
    std::vector<std::size_t> selection;
    for (const bio::Trial& trial : trials) {
      mustBeOfTheModelAsItIs(trial);
      bio::SimulationOptions options = during(trial, choice.simulation());
      options.externalForce = bio::externalForceOf(trial, arm);
      options.progress = [&](double) { return goOn.load(); };
      const bio::ParameterCatalogue catalogue(model, arm,
                                              {bio::startCoordinates(trial, arm, {}), {}});
      selection = catalogue.select(parameters);
      values = catalogue.values(selection);
      times.push_back(bio::observedTimes(trial, coordinate, options.step));
      const bio::TrialPredictor experiment(catalogue, choice.armOptions(),
                                           bio::excitationOf(trial, arm), coordinate, times.back(),
                                           selection, options);
      auto at = experiment.withSensitivities(values);
      if (!goOn) return;
      if (!at.outputs.allFinite()) {
        throw std::invalid_argument(trial.file +
                                    ": the simulation does not reach the end of the trial");
      }
      outputs.push_back(std::move(at.outputs));
      gammas.push_back(std::move(at.gamma));
      if (gammas.size() == trials.size()) {
        information = bio::informationAbout(catalogue, selection, gammas, noise);
      }
    }
  });
  std::vector<std::string> names, units;
  for (const info::Parameter& one : information.parameters) {
    names.push_back(one.name);
    units.push_back(one.unit);
  }
  return results("names"_a = names, "units"_a = units, "values"_a = values, "times"_a = times,
                 "outputs"_a = outputs, "gamma"_a = gammas, "fisher"_a = information.fisher,
                 "normalised_sensitivity"_a = information.normalisedSensitivity,
                 "bound_alone"_a = information.boundAlone, "bound_joint"_a = information.boundJoint,
                 "identifiable"_a = information.identifiable,
                 "correlation"_a = information.correlation, "sentences"_a = information.sentences);
}

py::list listParameters(const bio::Model& model, const py::kwargs& keywords) {
  const SystemChoice choice = armChoice(keywords);
  const bio::MusculoskeletalSystem arm(model, choice.armOptions());
  const bio::ParameterCatalogue catalogue(model, arm, {arm.skeleton().defaultValues(), {}});
  py::list list;
  for (const bio::ModelParameter& p : catalogue.parameters()) {
    list.append(results("name"_a = p.name, "value"_a = p.value, "unit"_a = p.unit,
                        "meaning"_a = p.meaning, "lower"_a = p.lower, "upper"_a = p.upper,
                        "deviation"_a = p.sd, "is_group"_a = p.isGroup));
  }
  return list;
}

}  // namespace

void defineSensitivity(py::module_& module) {
  module.def("list_parameters", &listParameters, "model"_a,
             R"doc(Lists the parameters of the model that affect the motion.

Each has name, value, unit, meaning, lower, upper, deviation (prior standard deviation) and is_group.)doc");
  module.def(
      "sensitivity", &sensitivity, "model"_a, "trials"_a, "parameters"_a, py::kw_only(),
      "noise"_a = std::numbers::pi / 180,
      R"doc(Exact sensitivities of the coordinate to parameters, and the information of a measurement.

Parameters
----------
model : Model
trials : list of Trial
parameters : list of str
    Names, which may contain *, or ['all'].
noise : float
    Standard deviation of the measured coordinate [rad].

Other keywords: coordinate='elbow_flexion' (the free coordinate, or a list of them),
lock={name: value} in rad or m, integrator='vi' ('vi-left', 'rk4' or 'cvode'), step [s].

Returns
-------
names, units, values
    Of the parameters.
times, outputs : list of arrays
    Sample times [s] and simulated coordinate [rad], for each trial.
gamma : list of arrays, times x parameters
    Sensitivities, for each trial.
fisher : array
    Fisher information.
normalised_sensitivity : array
    RMS change of the motion per prior standard deviation.
bound_alone, bound_joint : array
    Cramer-Rao standard deviations with the other parameters known, and with all estimated together
    with their priors.
identifiable : list of bool
    True: the data at least halve the prior standard deviation.
correlation : array
sentences : list of str
    Which parameters are not separately identifiable.)doc");
}

}  // namespace python
