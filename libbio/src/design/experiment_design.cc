#include "bio/design/experiment_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bio/analysis/replay.h"
#include "model/require.h"
#include "simulation/integrators.h"
#include "simulation/motion_weights.h"

namespace bio {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double sameSample = 1e-9;  ///< times nearer than this are one [s]

std::vector<double> equalTimes(double start, double duration, double interval) {
  const auto count = static_cast<std::size_t>(std::floor(duration / interval + 1e-6));
  std::vector<double> times;
  for (std::size_t k = 0; k <= count; ++k) {
    times.push_back(start + static_cast<double>(k) * interval);
  }
  return times;
}

std::vector<double> measurements(const DesignQuestion& question,
                                 const SimulationOptions& simulation) {
  require(question.period >= 1e-6 * simulation.duration && question.period <= simulation.duration,
          fmt::format(
              "period of the measurements = {} s, must be a millionth of the duration to all of it",
              question.period));
  return equalTimes(simulation.startTime, simulation.duration, question.period);
}

MatrixXd valuesAt(const ExcitationSignal& signal, const std::vector<double>& times) {
  MatrixXd values(signal.numMuscles(), static_cast<Index>(times.size()));
  std::size_t hint = 0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    signal.at(times[k], hint, values.col(static_cast<Index>(k)));
  }
  return values.transpose();
}

}  // namespace

ExperimentDesign::ExperimentDesign(const MusculoskeletalSystem& arm,
                                   const ParameterCatalogue& catalogue,
                                   ParameterCatalogue::Setting setting, const Trial& trial,
                                   const SimulationOptions& simulation, DesignQuestion question,
                                   DesignLimits limits, std::vector<MuscleGroup> groups,
                                   double knotInterval)
    : arm_(&arm),
      catalogue_(&catalogue),
      setting_(std::move(setting)),
      simulation_(simulation),
      question_(std::move(question)),
      coordinate_(arm.skeleton().indexOf(question_.coordinate)),
      inputs_(arm, trial, question_.coordinate, simulation.startTime, simulation.duration, limits,
              std::move(groups), knotInterval, measurements(question_, simulation)) {
  require(coordinate_ >= 0,
          fmt::format("measured coordinate '{}' is not free", question_.coordinate));
  require(question_.noise > 0 && std::isfinite(question_.noise),
          fmt::format("noise = {}, must be > 0", question_.noise));
  require(!question_.parameters.empty(), "no parameter is given");
  require(question_.criterion != info::Optimality::conditionNumber,
          "the criterion must be E, A or D");

  wanted_ = question_.parameters;
  wanted_.insert(wanted_.end(), question_.nuisance.begin(), question_.nuisance.end());
  const auto p = static_cast<Index>(wanted_.size());
  if (question_.priorSd.size() == 0) {
    question_.priorSd = VectorXd::Constant(p, infinite);
  }
  require(question_.priorSd.size() == p && (question_.priorSd.array() > 0).all(),
          "prior standard deviations: must be > 0, one for each parameter");
  scale_.resize(p);
  for (Index i = 0; i < p; ++i) {
    const std::size_t index = wanted_[static_cast<std::size_t>(i)];
    require(std::count(wanted_.begin(), wanted_.end(), index) == 1,
            fmt::format("parameter '{}' is named twice", catalogue.parameters()[index].name));
    scale_[i] = catalogue.parameters()[index].sd;
  }
}

SensitivityTrajectory ExperimentDesign::simulateTrial(const Trial& trial) const {
  SensitivityOptions options{simulation_, false};
  options.simulation.externalForce = externalForceOf(trial, *arm_);
  return simulateWithSensitivities(*arm_, *catalogue_, setting_, wanted_,
                                   excitationOf(trial, *arm_), options);
}

MatrixXd ExperimentDesign::gammaOf(const SensitivityTrajectory& s) const {
  const auto c = static_cast<std::size_t>(coordinate_);
  MatrixXd gamma(static_cast<Index>(inputs_.measuredTimes().size()),
                 static_cast<Index>(wanted_.size()));
  for (std::size_t i = 0; i < inputs_.measuredTimes().size(); ++i) {
    const MotionWeights w = weightsAt(s.motion.time, inputs_.measuredTimes()[i]).value();
    gamma.row(static_cast<Index>(i)) = w.rows(s.q[c], s.qDot[c]);
  }
  return gamma;
}

MatrixXd ExperimentDesign::scaledInformation(const MatrixXd& gamma) const {
  const MatrixXd scaled = gamma * scale_.asDiagonal() / question_.noise;
  MatrixXd information = scaled.transpose() * scaled;
  information.diagonal().array() += (scale_.array() / question_.priorSd.array()).square();
  return information;
}

info::InformationCost ExperimentDesign::cost(const MatrixXd& information,
                                             double repeatedTolerance) const {
  // the information about the parameters alone: Zᵀ I Z with Z = (1; −I_nn⁻¹ I_nc)
  const auto c = static_cast<Index>(question_.parameters.size());
  const auto n = static_cast<Index>(question_.nuisance.size());
  MatrixXd Z = MatrixXd::Identity(c + n, c);
  if (n > 0) {
    const Eigen::LDLT<MatrixXd> factor(information.bottomRightCorner(n, n));
    if (!factor.isPositive())
      throw std::domain_error("the experiment has no information about the nuisance parameters");
    Z.bottomRows(n) = -factor.solve(information.bottomLeftCorner(n, c));
  }
  MatrixXd own = Z.transpose() * information * Z;
  own = (own + own.transpose()) / 2;
  const info::Criterion of = info::criterion(question_.criterion, own, repeatedTolerance);
  info::InformationCost result;
  switch (question_.criterion) {
    case info::Optimality::a:
      result = {std::log(of.value), of.dvalue_dI / of.value};
      break;
    case info::Optimality::d:
      result = {-of.value, -of.dvalue_dI};
      break;
    default:
      if (!(of.value > 0))
        throw std::domain_error("the experiment has no information about the parameters");
      result = {-std::log(of.value), -of.dvalue_dI / of.value};
  }
  result.dvalue_dI = (Z * result.dvalue_dI * Z.transpose()).eval();
  return result;
}

/// How far the coordinate is from where it was expected when the parameters asked for are off, at
/// every row: √Σ(dq/dθ_i·deviation_i)².
VectorXd ExperimentDesign::surpriseOf(const SensitivityTrajectory& s) const {
  const auto p = static_cast<Index>(question_.parameters.size());
  const VectorXd off = limits().surprise * scale_.cwiseMin(question_.priorSd).head(p);
  return (s.q[static_cast<std::size_t>(coordinate_)].leftCols(p) * off.asDiagonal())
      .rowwise()
      .norm();
}

VectorXd ExperimentDesign::surpriseAt(const DesignedExperiment& e) const {
  const auto p = static_cast<Index>(question_.parameters.size());
  const VectorXd off = limits().surprise * scale_.cwiseMin(question_.priorSd).head(p);
  return (e.gamma.leftCols(p) * off.asDiagonal()).rowwise().norm();
}

VectorXd ExperimentDesign::boundOverTime(const DesignedExperiment& e) const {
  VectorXd bound = VectorXd::Constant(e.gamma.rows(), std::numeric_limits<double>::quiet_NaN());
  MatrixXd sum = scaledInformation(MatrixXd::Zero(0, scale_.size()));
  for (Index k = 0; k < e.gamma.rows(); ++k) {
    const VectorXd row = scale_.cwiseProduct(e.gamma.row(k).transpose()) / question_.noise;
    sum += row * row.transpose();
    const Eigen::LDLT<MatrixXd> factor(sum);
    const VectorXd D = factor.vectorD();
    if (factor.info() != Eigen::Success || !(D.minCoeff() > 1e-14 * D.maxCoeff())) continue;
    bound[k] = scale_[0] * std::sqrt(VectorXd(factor.solve(VectorXd::Unit(scale_.size(), 0)))[0]);
  }
  return bound;
}

double ExperimentDesign::penalty(const SensitivityTrajectory& s, double price) const {
  // from a margin inside the limits on, by the square, as a mean over the rows
  const double margin = 0.02 * (limits().upper - limits().lower);
  const VectorXd surprise = surpriseOf(s);
  double sum = 0;
  for (Index k = 0; k < surprise.size(); ++k) {
    const double q = s.motion.q(coordinate_, k);
    const double below = std::max(0.0, limits().lower + margin - q + surprise[k]) / margin;
    const double above = std::max(0.0, q + surprise[k] - limits().upper + margin) / margin;
    const double fast =
        std::max(0.0, std::abs(s.motion.qDot(coordinate_, k)) / limits().speed - 0.97) / 0.03;
    sum += below * below + above * above + fast * fast;
  }
  return price * sum / static_cast<double>(surprise.size());
}

DesignedExperiment ExperimentDesign::describe(VectorXd x) const {
  const Trial trial = inputs_.at(x);
  SensitivityTrajectory s = simulateTrial(trial);
  if (s.motion.outcome != Outcome::completed) throw std::runtime_error(s.motion.why);
  DesignedExperiment e;
  e.inputs = std::move(x);
  e.gamma = gammaOf(s);
  const MatrixXd scaled = scaledInformation(e.gamma);
  e.information = scale_.cwiseInverse().asDiagonal() * scaled * scale_.cwiseInverse().asDiagonal();
  const Eigen::LDLT<MatrixXd> factor(scaled);
  e.bound = VectorXd::Constant(scale_.size(), infinite);
  const VectorXd D = factor.vectorD();
  if (factor.info() == Eigen::Success && D.minCoeff() > 1e-14 * D.maxCoeff()) {
    const MatrixXd inverse = factor.solve(MatrixXd::Identity(scale_.size(), scale_.size()));
    e.bound = scale_.cwiseProduct(inverse.diagonal().cwiseSqrt());
  }
  e.measuredTimes = Eigen::Map<const VectorXd>(inputs_.measuredTimes().data(),
                                               static_cast<Index>(inputs_.measuredTimes().size()));
  e.measured.resize(e.measuredTimes.size());
  for (std::size_t i = 0; i < inputs_.measuredTimes().size(); ++i) {
    const MotionWeights w = weightsAt(s.motion.time, inputs_.measuredTimes()[i]).value();
    e.measured[static_cast<Index>(i)] =
        w.value(s.motion.q.row(coordinate_), s.motion.qDot.row(coordinate_));
  }
  e.lowest = s.motion.q.row(coordinate_).minCoeff();
  e.highest = s.motion.q.row(coordinate_).maxCoeff();
  const VectorXd surprise = surpriseOf(s);
  e.surprisedLowest = (s.motion.q.row(coordinate_).transpose() - surprise).minCoeff();
  e.surprisedHighest = (s.motion.q.row(coordinate_).transpose() + surprise).maxCoeff();
  e.fastest = s.motion.qDot.row(coordinate_).cwiseAbs().maxCoeff();
  e.largestTorque = inputs_.torqueOf(trial).cwiseAbs().maxCoeff();
  e.largestTorqueRate = inputs_.largestTorqueRate(trial);
  e.largestExcitationRate = inputs_.largestExcitationRate(trial);
  e.motion = std::move(s.motion);
  e.excitation = excitationOf(trial, *arm_);
  e.torque = externalForceOf(trial, *arm_);
  return e;
}

DesignedExperiment ExperimentDesign::before() const {
  return describe({});
}

DesignedExperiment ExperimentDesign::at(const VectorXd& x) const {
  return describe(x);
}

bool ExperimentDesign::keepsRange(double lowest, double highest, double fastest) const {
  return lowest >= limits().lower && highest <= limits().upper && fastest <= limits().speed;
}

bool ExperimentDesign::keepsLimits(const DesignedExperiment& e) const {
  constexpr double rounding = 1 + 1e-6;
  return keepsRange(e.surprisedLowest, e.surprisedHighest, e.fastest) &&
         e.largestTorque <= limits().torque * rounding &&
         e.largestTorqueRate <= limits().torqueRate * rounding &&
         (e.inputs.size() == 0 || e.largestExcitationRate <= limits().excitationRate * rounding);
}

std::vector<MuscleGroup> flexorsAndExtensors(const MusculoskeletalSystem& arm, const VectorXd& q,
                                             int coordinate) {
  std::vector<MuscleGroup> groups = {{"flexors", {}}, {"extensors", {}}};
  stepping::withCoordinates(arm.skeleton(), [&](auto N) {
    SystemConfiguration<decltype(N)::value> configuration(arm);
    configuration.moveTo(q);
    for (std::size_t i = 0; i < arm.numMuscles(); ++i) {
      const bool shortens = configuration.length(i).dL_dq[coordinate] < 0;
      groups[shortens ? 0 : 1].muscles.push_back(arm.muscles()[i].name);
    }
  });
  std::erase_if(groups, [](const MuscleGroup& group) { return group.muscles.empty(); });
  return groups;
}

Table designTable(const MusculoskeletalSystem& arm, const DesignedExperiment& e,
                  const std::string& coordinate) {
  Table table;
  table.name = "designed experiment";
  table.metadata["predicted"] = coordinate + " is predicted, not measured";
  table.columns = {"time"};
  for (const SystemMuscle& muscle : arm.muscles()) table.columns.push_back(muscle.name);
  const std::vector<double>& times = e.excitation.times();
  const auto K = static_cast<Index>(times.size());
  const auto n = static_cast<Index>(arm.numMuscles());
  const bool pushed = !e.torque.empty();
  table.values =
      MatrixXd::Constant(K, n + (pushed ? 3 : 2), std::numeric_limits<double>::quiet_NaN());
  table.values.col(0) = Eigen::Map<const VectorXd>(times.data(), K);
  table.values.middleCols(1, n) = valuesAt(e.excitation, times);
  if (pushed) {
    table.columns.push_back(coordinate + ".torque");
    const int index = arm.skeleton().indexOf(coordinate);
    for (Index k = 0; k < K; ++k) {
      table.values(k, n + 1) = e.torque.at(times[static_cast<std::size_t>(k)]).value[index];
    }
  }
  table.columns.push_back(coordinate);
  Index row = 0;
  for (Index i = 0; i < e.measuredTimes.size(); ++i) {
    while (row + 1 < K && times[static_cast<std::size_t>(row)] < e.measuredTimes[i] - sameSample) {
      ++row;
    }
    table.values(row, table.values.cols() - 1) = e.measured[i];
  }
  return table;
}

}  // namespace bio
