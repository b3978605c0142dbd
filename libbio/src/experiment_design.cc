#include "bio/experiment_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bio/replay.h"
#include "coupled_stepping.h"
#include "motion_weights.h"
#include "require.h"

namespace bio {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double sameTime = 1e-9;  ///< times nearer than this are one [s]

std::vector<double> equalTimes(double start, double duration, double interval) {
  const auto count = static_cast<std::size_t>(std::floor(duration / interval + 1e-6));
  std::vector<double> times;
  for (std::size_t k = 0; k <= count; ++k) {
    times.push_back(start + static_cast<double>(k) * interval);
  }
  return times;
}

/// Knots at most `interval` apart, equally spaced, from start to end.
std::vector<double> knotsOf(double start, double duration, double interval) {
  require(interval > 0 && duration / interval < 1e4,
          fmt::format("interval of the knots = {} s, must be > 0 and not tiny", interval));
  const double parts = std::max(1.0, std::ceil(duration / interval - 1e-9));
  std::vector<double> knots;
  for (double k = 0; k <= parts; ++k) knots.push_back(start + duration * k / parts);
  return knots;
}

/// Both, sorted; where two are together, the first list's.
std::vector<double> merged(const std::vector<double>& first, const std::vector<double>& second) {
  std::vector<double> all = first;
  for (const double t : second) {
    const auto at = std::lower_bound(first.begin(), first.end(), t - sameTime);
    if (at == first.end() || *at > t + sameTime) all.push_back(t);
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<info::ProfileLimits> profileLimits(const DesignLimits& limits, std::size_t groups) {
  std::vector<info::ProfileLimits> inputs;
  if (limits.torque > 0) inputs.push_back({-limits.torque, limits.torque, limits.torqueRate, 0.0});
  for (std::size_t g = 0; g < groups; ++g) {
    inputs.push_back({limits.leastExcitation, limits.largestExcitation, limits.excitationRate, {}});
  }
  return inputs;
}

double largestSlope(const std::vector<double>& times, const MatrixXd& values) {
  double largest = 0;
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    const auto row = static_cast<Index>(k);
    largest = std::max(largest, (values.row(row + 1) - values.row(row)).cwiseAbs().maxCoeff() /
                                    (times[k + 1] - times[k]));
  }
  return largest;
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

ExperimentDesign::ExperimentDesign(const Arm& arm, const ParameterCatalogue& catalogue,
                                   ParameterCatalogue::Setting setting, const Trial& trial,
                                   const SimulationOptions& simulation, DesignQuestion question,
                                   DesignLimits limits, std::vector<MuscleGroup> groups,
                                   double knotInterval)
    : arm_(&arm),
      catalogue_(&catalogue),
      setting_(std::move(setting)),
      simulation_(simulation),
      question_(std::move(question)),
      limits_(limits),
      groups_(std::move(groups)),
      coordinate_(arm.skeleton().indexOf(question_.coordinate)),
      profiles_(knotsOf(simulation.startTime, simulation.duration, knotInterval),
                profileLimits(limits_, groups_.size())) {
  require(coordinate_ >= 0,
          fmt::format("measured coordinate '{}' is not free", question_.coordinate));
  require(question_.noise > 0 && std::isfinite(question_.noise),
          fmt::format("noise = {}, must be > 0", question_.noise));
  require(question_.period > 0 && question_.period <= simulation.duration,
          fmt::format("period of the measurements = {} s, must be > 0 and at most the duration",
                      question_.period));
  require(limits_.torque >= 0 && std::isfinite(limits_.torque),
          fmt::format("largest torque = {} N·m, must be ≥ 0", limits_.torque));
  require(limits_.leastExcitation >= 0 && limits_.largestExcitation <= 1,
          fmt::format("excitations {} to {}, must be within 0 to 1", limits_.leastExcitation,
                      limits_.largestExcitation));
  require(limits_.lower < limits_.upper,
          fmt::format("range {} to {}, must rise", limits_.lower, limits_.upper));
  require(limits_.surprise >= 0, fmt::format("surprise = {}, must be ≥ 0", limits_.surprise));
  require(limits_.speed > 0, fmt::format("largest speed = {}, must be > 0", limits_.speed));
  require(!question_.parameters.empty(), "no parameter is asked for");
  require(profiles_.size() > 0, "nothing may be changed: no torque and no muscle");
  require(question_.criterion != info::Optimality::conditionNumber,
          "the criterion must be E, A or D");

  wanted_ = question_.parameters;
  wanted_.insert(wanted_.end(), question_.nuisance.begin(), question_.nuisance.end());
  const auto p = static_cast<Index>(wanted_.size());
  if (question_.priorDeviation.size() == 0) {
    question_.priorDeviation = VectorXd::Constant(p, infinite);
  }
  require(question_.priorDeviation.size() == p && (question_.priorDeviation.array() > 0).all(),
          "one prior deviation > 0 is needed for each parameter");
  scale_.resize(p);
  for (Index i = 0; i < p; ++i) {
    const std::size_t index = wanted_[static_cast<std::size_t>(i)];
    require(std::count(wanted_.begin(), wanted_.end(), index) == 1,
            fmt::format("parameter '{}' is named twice", catalogue.parameters()[index].name));
    scale_[i] = catalogue.parameters()[index].deviation;
  }

  std::vector<std::string> seen;
  for (const MuscleGroup& group : groups_) {
    require(!group.muscles.empty(), fmt::format("group '{}' has no muscle", group.name));
    columns_.emplace_back();
    for (const std::string& name : group.muscles) {
      const auto& all = arm.muscles();
      const auto found =
          std::find_if(all.begin(), all.end(), [&](const auto& m) { return m.name == name; });
      require(found != all.end(), fmt::format("'{}' is no muscle of the arm", name));
      require(std::count(seen.begin(), seen.end(), name) == 0,
              fmt::format("muscle '{}' is in two groups", name));
      seen.push_back(name);
      columns_.back().push_back(found - all.begin());
    }
  }

  const ExcitationSignal given = excitationOf(trial, arm);
  rows_ = merged(given.times(), profiles_.knots());
  measuredTimes_ = equalTimes(simulation.startTime, simulation.duration, question_.period);
  rows_ = merged(rows_, measuredTimes_);
  trialExcitation_ = valuesAt(given, rows_);
  trialForce_ = externalForceOf(trial, arm);
}

ExperimentDesign::Inputs ExperimentDesign::inputsOf(const VectorXd& x) const {
  MatrixXd excitation = trialExcitation_;
  ExternalForce torque = trialForce_;
  if (x.size() > 0) {
    const MatrixXd values = profiles_.values(x, rows_);
    Index input = 0;
    if (hasTorque()) {
      MatrixXd all = MatrixXd::Zero(values.rows(), arm_->skeleton().numCoordinates());
      for (std::size_t k = 0; k < rows_.size() && !trialForce_.empty(); ++k) {
        all.row(static_cast<Index>(k)) = trialForce_.at(rows_[k]).value.transpose();
      }
      all.col(coordinate_) = values.col(input++);
      torque = ExternalForce(rows_, std::move(all));
    }
    for (const auto& columns : columns_) {
      for (const Index column : columns) excitation.col(column) = values.col(input);
      ++input;
    }
  }
  return {ExcitationSignal(rows_, std::move(excitation)), std::move(torque)};
}

SensitivityTrajectory ExperimentDesign::simulateInputs(const Inputs& inputs) const {
  SensitivityOptions options{simulation_, false};
  options.simulation.externalForce = inputs.torque;
  return simulateWithSensitivities(*arm_, *catalogue_, setting_, wanted_, inputs.excitation,
                                   options);
}

MatrixXd ExperimentDesign::gammaOf(const SensitivityTrajectory& s) const {
  const auto c = static_cast<std::size_t>(coordinate_);
  MatrixXd gamma(static_cast<Index>(measuredTimes_.size()), static_cast<Index>(wanted_.size()));
  for (std::size_t i = 0; i < measuredTimes_.size(); ++i) {
    const MotionWeights w = weightsAt(s.motion.time, measuredTimes_[i]).value();
    gamma.row(static_cast<Index>(i)) = w.rows(s.q[c], s.qDot[c]);
  }
  return gamma;
}

MatrixXd ExperimentDesign::scaledInformation(const MatrixXd& gamma) const {
  const MatrixXd scaled = gamma * scale_.asDiagonal() / question_.noise;
  MatrixXd information = scaled.transpose() * scaled;
  information.diagonal().array() += (scale_.array() / question_.priorDeviation.array()).square();
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
    if (!factor.isPositive()) throw std::domain_error("nothing tells the nuisance parameters");
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
      if (!(of.value > 0)) throw std::domain_error("nothing tells the parameters");
      result = {-std::log(of.value), -of.dvalue_dI / of.value};
  }
  result.dvalue_dI = (Z * result.dvalue_dI * Z.transpose()).eval();
  return result;
}

/// How far the coordinate is from where it was expected when the parameters asked for are off, at
/// every row: √Σ(dq/dθ_i·deviation_i)².
VectorXd ExperimentDesign::surpriseOf(const SensitivityTrajectory& s) const {
  const auto p = static_cast<Index>(question_.parameters.size());
  const VectorXd off = limits_.surprise * scale_.cwiseMin(question_.priorDeviation).head(p);
  return (s.q[static_cast<std::size_t>(coordinate_)].leftCols(p) * off.asDiagonal())
      .rowwise()
      .norm();
}

VectorXd ExperimentDesign::surpriseAt(const DesignedExperiment& e) const {
  const auto p = static_cast<Index>(question_.parameters.size());
  const VectorXd off = limits_.surprise * scale_.cwiseMin(question_.priorDeviation).head(p);
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
  const double margin = 0.02 * (limits_.upper - limits_.lower);
  const VectorXd surprise = surpriseOf(s);
  double sum = 0;
  for (Index k = 0; k < surprise.size(); ++k) {
    const double q = s.motion.q(coordinate_, k);
    const double below = std::max(0.0, limits_.lower + margin - q + surprise[k]) / margin;
    const double above = std::max(0.0, q + surprise[k] - limits_.upper + margin) / margin;
    const double fast =
        std::max(0.0, std::abs(s.motion.qDot(coordinate_, k)) / limits_.speed - 0.97) / 0.03;
    sum += below * below + above * above + fast * fast;
  }
  return price * sum / static_cast<double>(surprise.size());
}

DesignedExperiment ExperimentDesign::describe(VectorXd x, Inputs inputs) const {
  SensitivityTrajectory s = simulateInputs(inputs);
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
  e.measuredTimes =
      Eigen::Map<const VectorXd>(measuredTimes_.data(), static_cast<Index>(measuredTimes_.size()));
  e.measured.resize(e.measuredTimes.size());
  for (std::size_t i = 0; i < measuredTimes_.size(); ++i) {
    const MotionWeights w = weightsAt(s.motion.time, measuredTimes_[i]).value();
    e.measured[static_cast<Index>(i)] =
        w.value(s.motion.q.row(coordinate_), s.motion.qDot.row(coordinate_));
  }
  e.lowest = s.motion.q.row(coordinate_).minCoeff();
  e.highest = s.motion.q.row(coordinate_).maxCoeff();
  const VectorXd surprise = surpriseOf(s);
  e.surprisedLowest = (s.motion.q.row(coordinate_).transpose() - surprise).minCoeff();
  e.surprisedHighest = (s.motion.q.row(coordinate_).transpose() + surprise).maxCoeff();
  e.fastest = s.motion.qDot.row(coordinate_).cwiseAbs().maxCoeff();
  if (!inputs.torque.empty()) {
    MatrixXd values(static_cast<Index>(rows_.size()), 1);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      values(static_cast<Index>(k), 0) = inputs.torque.at(rows_[k]).value[coordinate_];
    }
    e.largestTorque = values.cwiseAbs().maxCoeff();
    e.largestTorqueRate = largestSlope(rows_, values);
  }
  for (const auto& columns : columns_) {
    for (const Index column : columns) {
      e.largestExcitationRate =
          std::max(e.largestExcitationRate,
                   largestSlope(rows_, valuesAt(inputs.excitation, rows_).col(column)));
    }
  }
  e.motion = std::move(s.motion);
  e.excitation = std::move(inputs.excitation);
  e.torque = std::move(inputs.torque);
  return e;
}

DesignedExperiment ExperimentDesign::before() const {
  return describe({}, inputsOf({}));
}

DesignedExperiment ExperimentDesign::at(const VectorXd& x) const {
  return describe(x, inputsOf(x));
}

bool ExperimentDesign::keepsRange(double lowest, double highest, double fastest) const {
  return lowest >= limits_.lower && highest <= limits_.upper && fastest <= limits_.speed;
}

bool ExperimentDesign::keepsLimits(const DesignedExperiment& e) const {
  constexpr double rounding = 1 + 1e-6;
  return keepsRange(e.surprisedLowest, e.surprisedHighest, e.fastest) &&
         e.largestTorque <= limits_.torque * rounding &&
         e.largestTorqueRate <= limits_.torqueRate * rounding &&
         (e.inputs.size() == 0 || e.largestExcitationRate <= limits_.excitationRate * rounding);
}

VectorXd ExperimentDesign::startCoefficients() const {
  MatrixXd atKnots = MatrixXd::Zero(static_cast<Index>(profiles_.knots().size()),
                                    static_cast<Index>(profiles_.inputs().size()));
  const ExcitationSignal trial(rows_, trialExcitation_);
  const MatrixXd excitation = valuesAt(trial, profiles_.knots());
  Index input = hasTorque() ? 1 : 0;
  for (std::size_t k = 0; k < profiles_.knots().size() && hasTorque(); ++k) {
    if (trialForce_.empty()) break;
    atKnots(static_cast<Index>(k), 0) = trialForce_.at(profiles_.knots()[k]).value[coordinate_];
  }
  for (const auto& columns : columns_) {
    for (const Index column : columns) {
      atKnots.col(input) += excitation.col(column) / static_cast<double>(columns.size());
    }
    ++input;
  }
  return profiles_.project(profiles_.coefficients(atKnots));
}

std::vector<MuscleGroup> flexorsAndExtensors(const Arm& arm, const VectorXd& q, int coordinate) {
  std::vector<MuscleGroup> groups = {{"flexors", {}}, {"extensors", {}}};
  stepping::withCoordinates(arm.skeleton().numCoordinates(), [&](auto N) {
    ArmConfiguration<decltype(N)::value> configuration(arm);
    configuration.moveTo(q);
    for (std::size_t i = 0; i < arm.numMuscles(); ++i) {
      const bool shortens = configuration.length(i).dL_dq[coordinate] < 0;
      groups[shortens ? 0 : 1].muscles.push_back(arm.muscles()[i].name);
    }
  });
  std::erase_if(groups, [](const MuscleGroup& group) { return group.muscles.empty(); });
  return groups;
}

Table designTable(const Arm& arm, const DesignedExperiment& e, const std::string& coordinate) {
  Table table;
  table.name = "designed experiment";
  table.metadata["predicted"] = coordinate + " is predicted, not measured";
  table.columns = {"time"};
  for (const ArmMuscle& muscle : arm.muscles()) table.columns.push_back(muscle.name);
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
    while (row + 1 < K && times[static_cast<std::size_t>(row)] < e.measuredTimes[i] - sameTime) {
      ++row;
    }
    table.values(row, table.values.cols() - 1) = e.measured[i];
  }
  return table;
}

}  // namespace bio
