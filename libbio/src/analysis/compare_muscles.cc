#include "bio/analysis/compare_muscles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bio/model/convert_muscles.h"
#include "bio/observation/trial_predictor.h"

namespace bio {
namespace {

/// Numbers that every class has, in the order of the muscles.
std::vector<std::size_t> sharedNumbers(const ParameterCatalogue& catalogue,
                                       const MusculoskeletalSystem& system) {
  std::vector<std::size_t> selection;
  for (const SystemMuscle& muscle : system.muscles()) {
    for (const char* number :
         {"max_isometric_force", "optimal_fiber_length", "tendon_slack_length"}) {
      selection.push_back(catalogue.find(muscle.name + "." + number));
    }
  }
  return selection;
}

double rootMeanSquareOf(const Eigen::VectorXd& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

/// The rest that no change of the parameters explains: Δ − Γ(ΓᵀΓ + σ²Λ)⁻¹ΓᵀΔ, Λ of their priors.
Eigen::VectorXd unexplainedBy(const Eigen::MatrixXd& gamma, const ParameterInformation& known,
                              double noise, const Eigen::VectorXd& difference) {
  // in prior deviations, so that the matrix is of one size
  Eigen::MatrixXd scaled = gamma;
  for (Eigen::Index j = 0; j < scaled.cols(); ++j) {
    scaled.col(j) *= known.parameters[static_cast<std::size_t>(j)].prior->sd;
  }
  Eigen::MatrixXd normal = scaled.transpose() * scaled;
  normal.diagonal().array() += noise * noise;
  return difference - scaled * normal.ldlt().solve(scaled.transpose() * difference);
}

struct Measured {
  Eigen::VectorXd outputs;
  Eigen::MatrixXd gamma;
};

MuscleClassMotion motionOf(const Model& model, const SystemOptions& options,
                           const MuscleClassTrial& trial, const MuscleClassMotion* first,
                           Measured& measured) {
  MuscleClassMotion result;
  const MusculoskeletalSystem system(model, options);
  const auto& [excitation, simulation] = trial.recorded;
  const SystemState start = trial.recorded.startAt(system, trial.start);
  result.motion = simulate(system, excitation, start, simulation);
  if (result.motion.outcome != Outcome::completed) return result;
  for (int repeat = 0; repeat < 4; ++repeat) {  // the least time: others use the machine
    result.motion.wallSeconds = std::min(
        result.motion.wallSeconds, simulate(system, excitation, start, simulation).wallSeconds);
  }
  result.energyError = energyError(system, result.motion);
  if (first) result.difference = sd(system, result.motion, first->motion);
  const ParameterCatalogue catalogue(model, system, trial.start);
  const std::vector<std::size_t> selection = sharedNumbers(catalogue, system);
  const TrialPredictor predictor(catalogue, options, excitation, trial.coordinate, trial.times,
                                 selection, simulation);
  auto linearised = predictor.withSensitivities(catalogue.values(selection));
  result.information = informationAbout(catalogue, selection, {linearised.gamma}, trial.noise);
  measured = {std::move(linearised.outputs), std::move(linearised.gamma)};
  return result;
}

}  // namespace

std::vector<MuscleClassMotion> compareMuscleClasses(const Model& model,
                                                    const SystemOptions& options,
                                                    const std::vector<std::string>& classes,
                                                    const MuscleClassTrial& trial) {
  std::vector<MuscleClassMotion> all;
  Measured reference;
  all.push_back(motionOf(model, options, trial, nullptr, reference));
  all.back().name = "as in the model";
  if (all.back().motion.outcome != Outcome::completed) {
    throw std::runtime_error(fmt::format(
        "the motion of the model as it is does not reach the end: {}", all.back().motion.why));
  }
  for (const std::string& name : classes) {
    if (trial.progress) {
      trial.progress(static_cast<double>(all.size()) / static_cast<double>(classes.size() + 1));
    }
    Model changed = model;
    std::vector<std::string> lost = convertMuscles(changed, name).lost;
    Measured measured;
    MuscleClassMotion motion = motionOf(changed, options, trial, &all.front(), measured);
    motion.name = name;
    motion.lost = std::move(lost);
    if (motion.motion.outcome == Outcome::completed) {
      const Eigen::VectorXd difference = measured.outputs - reference.outputs;
      motion.measured = rootMeanSquareOf(difference);
      motion.unexplained = rootMeanSquareOf(
          unexplainedBy(reference.gamma, all.front().information, trial.noise, difference));
    }
    all.push_back(std::move(motion));
  }
  return all;
}

}  // namespace bio
