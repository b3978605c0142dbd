#include "bio/design/experiment_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "bio/analysis/replay.h"
#include "model/require.h"
#include "simulation/integrators.h"

namespace bio {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double infinite = std::numeric_limits<double>::infinity();

std::vector<ObservedSeries> seriesOf(const std::vector<Observable>& observables,
                                     const std::vector<double>& times) {
  std::vector<ObservedSeries> series;
  for (const Observable& what : observables) {
    series.push_back({what, VectorXd::Map(times.data(), static_cast<Index>(times.size()))});
  }
  return series;
}

std::vector<Observable> observablesOf(const DesignQuestion& question) {
  std::vector<Observable> all;
  for (const ChannelCandidate& candidate : question.observed) {
    require(candidate.sd > 0 && std::isfinite(candidate.sd),
            fmt::format("noise of '{}' = {}, must be > 0", nameOf(candidate.what), candidate.sd));
    require(std::count(all.begin(), all.end(), candidate.what) == 0,
            fmt::format("'{}' is observed twice, must be once", nameOf(candidate.what)));
    all.push_back(candidate.what);
  }
  require(!all.empty(), "nothing is observed, at least one channel must be");
  return all;
}

/// Free coordinates first, so that a trial with these columns begins where the experiment does.
std::vector<Observable> predictedOf(const MusculoskeletalSystem& system,
                                    const std::vector<Observable>& observed) {
  std::vector<Observable> all;
  for (std::size_t i = 0; i < system.skeleton().coordinates().size(); ++i) {
    if (system.isPrescribed(static_cast<int>(i))) continue;
    all.push_back(ofCoordinate(system.skeleton().coordinates()[i].name));
  }
  const auto isNew = [&](const Observable& what) {
    return std::find(all.begin(), all.end(), what) == all.end() && !what.isCoordinate();
  };
  std::copy_if(observed.begin(), observed.end(), std::back_inserter(all), isNew);
  return all;
}

/// Samples of observable after observable as times × observables.
MatrixXd byObservable(const VectorXd& values, std::size_t observables) {
  const auto n = static_cast<Index>(observables);
  return Eigen::Map<const MatrixXd>(values.data(), values.size() / n, n);
}

}  // namespace

ExperimentDesign::ExperimentDesign(const MusculoskeletalSystem& system,
                                   const ParameterCatalogue& catalogue,
                                   ParameterCatalogue::Setting setting, const Trial& trial,
                                   const SimulationOptions& simulation, DesignQuestion question,
                                   DesignLimits limits, std::vector<MuscleGroup> groups,
                                   double knotInterval)
    : system_(&system),
      catalogue_(&catalogue),
      setting_(std::move(setting)),
      simulation_(simulation),
      question_(std::move(question)),
      inputs_(system, trial, simulation.startTime, simulation.duration, std::move(limits),
              std::move(groups), knotInterval,
              samplingTimes(simulation.startTime, simulation.duration, question_.period)),
      observed_(system, seriesOf(observablesOf(question_), inputs_.measuredTimes())),
      predicted_(predictedOf(system, observablesOf(question_))) {
  simulation_.prescribed = prescribedMotionOf(trial, system);
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
  SensitivityOptions options{simulation_, observed_.needsMuscles(), observed_.needsReactions()};
  options.simulation.externalForce = externalForceOf(trial, *system_);
  return simulateWithSensitivities(*system_, *catalogue_, setting_, wanted_,
                                   excitationOf(trial, *system_), options);
}

/// In units of the scales, and of the noise of each observable.
MatrixXd ExperimentDesign::inNoise(const MatrixXd& gamma) const {
  MatrixXd scaled = gamma * scale_.asDiagonal();
  const auto n = static_cast<Index>(inputs_.measuredTimes().size());
  for (std::size_t o = 0; o < question_.observed.size(); ++o) {
    scaled.middleRows(static_cast<Index>(o) * n, n) /= question_.observed[o].sd;
  }
  return scaled;
}

MatrixXd ExperimentDesign::scaledInformation(const MatrixXd& gamma) const {
  const MatrixXd scaled = inNoise(gamma);
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
  const info::Criterion criterion = info::criterion(question_.criterion, own, repeatedTolerance);
  info::InformationCost result;
  switch (question_.criterion) {
    case info::Optimality::a:
      result = {std::log(criterion.value), criterion.dvalue_dI / criterion.value};
      break;
    case info::Optimality::d:
      result = {-criterion.value, -criterion.dvalue_dI};
      break;
    default:
      if (!(criterion.value > 0))
        throw std::domain_error("the experiment has no information about the parameters");
      result = {-std::log(criterion.value), -criterion.dvalue_dI / criterion.value};
  }
  result.dvalue_dI = (Z * result.dvalue_dI * Z.transpose()).eval();
  return result;
}

/// √Σ(dy/dθ_i·deviation_i)² over the parameters asked for, at every row.
template <class Rows>
VectorXd ExperimentDesign::allowanceOf(const Rows& slopes) const {
  const auto p = static_cast<Index>(question_.parameters.size());
  const VectorXd off = inputs_.limits().robustness * scale_.cwiseMin(question_.priorSd).head(p);
  return (slopes.leftCols(p) * off.asDiagonal()).rowwise().norm();
}

MatrixXd ExperimentDesign::allowanceAt(const DesignedExperiment& e) const {
  return byObservable(allowanceOf(e.gamma), question_.observed.size());
}

VectorXd ExperimentDesign::boundOverTime(const DesignedExperiment& e) const {
  const Index times = e.measuredTimes.size();
  VectorXd bound = VectorXd::Constant(times, std::numeric_limits<double>::quiet_NaN());
  MatrixXd sum = MatrixXd::Zero(scale_.size(), scale_.size());
  sum.diagonal() = (scale_.array() / question_.priorSd.array()).square();
  const MatrixXd scaled = inNoise(e.gamma);
  for (Index k = 0; k < times; ++k) {
    for (Index row = k; row < scaled.rows(); row += times) {
      sum += scaled.row(row).transpose() * scaled.row(row);
    }
    const Eigen::LDLT<MatrixXd> factor(sum);
    const VectorXd D = factor.vectorD();
    if (factor.info() != Eigen::Success || !(D.minCoeff() > 1e-14 * D.maxCoeff())) continue;
    bound[k] = scale_[0] * std::sqrt(VectorXd(factor.solve(VectorXd::Unit(scale_.size(), 0)))[0]);
  }
  return bound;
}

double ExperimentDesign::penalty(const SensitivityTrajectory& s, double price) const {
  // from a margin inside the limits on, by the square, as a mean over the rows
  double sum = 0;
  for (const CoordinateLimits& limits : inputs_.limits().coordinates) {
    const int c = system_->skeleton().indexOf(limits.coordinate);
    const double margin = 0.02 * (limits.upper - limits.lower);
    const VectorXd allowance = allowanceOf(s.q[static_cast<std::size_t>(c)]);
    for (Index k = 0; k < allowance.size(); ++k) {
      const double q = s.motion.q(c, k);
      const double below = std::max(0.0, limits.lower + margin - q + allowance[k]) / margin;
      const double above = std::max(0.0, q + allowance[k] - limits.upper + margin) / margin;
      const double fast = std::max(0.0, std::abs(s.motion.qDot(c, k)) / limits.speed - 0.97) / 0.03;
      sum += below * below + above * above + fast * fast;
    }
  }
  return price * sum / static_cast<double>(s.motion.time.size());
}

std::vector<MotionRange> ExperimentDesign::rangesOf(const SensitivityTrajectory& s) const {
  std::vector<MotionRange> ranges;
  for (const CoordinateLimits& limits : inputs_.limits().coordinates) {
    const int c = system_->skeleton().indexOf(limits.coordinate);
    const VectorXd q = s.motion.q.row(c).transpose();
    const VectorXd allowance = allowanceOf(s.q[static_cast<std::size_t>(c)]);
    ranges.push_back({{q.minCoeff(), q.maxCoeff(), s.motion.qDot.row(c).cwiseAbs().maxCoeff()},
                      (q - allowance).minCoeff(),
                      (q + allowance).maxCoeff()});
  }
  return ranges;
}

DesignedExperiment ExperimentDesign::at(const VectorXd& x) const {
  DesignedExperiment e;
  e.inputs = x;
  e.trial = inputs_.at(x);
  SensitivityTrajectory s = simulateTrial(e.trial);
  if (s.motion.outcome != Outcome::completed) throw std::runtime_error(s.motion.why);
  ObservedMotion::Linearised seen = observed_.linearised(s);
  e.measured = byObservable(seen.values, question_.observed.size());
  e.gamma = std::move(seen.gamma);
  const MatrixXd scaled = scaledInformation(e.gamma);
  e.information = scale_.cwiseInverse().asDiagonal() * scaled * scale_.cwiseInverse().asDiagonal();
  const Eigen::LDLT<MatrixXd> factor(scaled);
  e.bound = VectorXd::Constant(scale_.size(), infinite);
  const VectorXd D = factor.vectorD();
  if (factor.info() == Eigen::Success && D.minCoeff() > 1e-14 * D.maxCoeff()) {
    const MatrixXd inverse = factor.solve(MatrixXd::Identity(scale_.size(), scale_.size()));
    e.bound = scale_.cwiseProduct(inverse.diagonal().cwiseSqrt());
  }
  const std::vector<double>& times = inputs_.measuredTimes();
  e.measuredTimes = VectorXd::Map(times.data(), static_cast<Index>(times.size()));
  const VectorXd predicted = ObservedMotion(*system_, seriesOf(predicted_, times)).values(s.motion);
  e.trial.measured = inputs_.measured(predicted_, byObservable(predicted, predicted_.size()));
  e.ranges = rangesOf(s);
  e.motion = std::move(s.motion);
  return e;
}

DesignedExperiment ExperimentDesign::before() const {
  return at({});
}

bool ExperimentDesign::keepsRanges(const std::vector<MotionRange>& ranges) const {
  const auto keeps = [](const MotionRange& range, const CoordinateLimits& limits) {
    return range.surprisedLowest >= limits.lower && range.surprisedHighest <= limits.upper &&
           range.fastest <= limits.speed;
  };
  const auto& limits = inputs_.limits().coordinates;
  return std::equal(ranges.begin(), ranges.end(), limits.begin(), limits.end(), keeps);
}

bool ExperimentDesign::keepsLimits(const DesignedExperiment& e) const {
  constexpr double rounding = 1 + 1e-6;
  const DesignLimits& limits = inputs_.limits();
  for (const CoordinateLimits& torque : inputs_.torques()) {
    if (inputs_.largestTorque(e.trial, torque.coordinate) > torque.torque * rounding) return false;
    if (inputs_.largestTorqueRate(e.trial, torque.coordinate) > limits.torqueRate * rounding) {
      return false;
    }
  }
  return keepsRanges(e.ranges) && (e.inputs.size() == 0 || inputs_.largestExcitationRate(e.trial) <=
                                                               limits.excitationRate * rounding);
}

std::vector<MuscleGroup> flexorsAndExtensors(const MusculoskeletalSystem& system, const VectorXd& q,
                                             int coordinate) {
  std::vector<MuscleGroup> groups = {{"flexors", {}}, {"extensors", {}}};
  stepping::withCoordinates(system.skeleton(), [&](auto N) {
    SystemConfiguration<decltype(N)::value> configuration(system);
    configuration.moveTo(q);
    for (std::size_t i = 0; i < system.numMuscles(); ++i) {
      const double slope = configuration.length(i).dL_dq[coordinate];
      if (std::abs(slope) < 1e-12) continue;  // does not cross it
      groups[slope < 0 ? 0 : 1].muscles.push_back(system.muscles()[i].name);
    }
  });
  std::erase_if(groups, [](const MuscleGroup& group) { return group.muscles.empty(); });
  return groups;
}

}  // namespace bio
