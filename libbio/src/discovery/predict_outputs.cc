#include <algorithm>
#include <cmath>
#include <limits>

#include "bio/analysis/replay.h"
#include "bio/discovery/musculoskeletal_problem.h"
#include "bio/sensitivity/coupled_sensitivity.h"
#include "discovery/look_at.h"

namespace bio::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The clock, and starts of other trials, have no column of the simulation.
struct MusculoskeletalProblem::Columns {
  std::vector<ParameterDirection> directions;
  std::vector<Index> place;                        ///< of the wanted among them; −1: none
  std::vector<std::optional<Meaning::Kind>> kind;  ///< of the model's quantities
};

MusculoskeletalProblem::Columns MusculoskeletalProblem::columnsOf(
    const OfTrial& one, const VectorXd& values, const std::vector<std::size_t>& wanted) const {
  const std::size_t own = encompassing_.quantities().size();
  const VectorXd modelValues = values.head(static_cast<Index>(own)) + one.known;
  const int c = encompassing_.freeIndex();
  Columns columns;
  for (const std::size_t quantity : wanted) {
    ParameterDirection direction;
    std::optional<Meaning::Kind> kind;
    if (quantity < own) {
      kind = encompassing_.kindOf(quantity);
      direction = encompassing_.direction(modelValues, quantity);
    }
    if (quantity == one.angle || kind == Meaning::Kind::bias || kind == Meaning::Kind::gain)
      direction = {{InitialTarget{c, false}}};
    if (quantity == one.speed) direction = {{InitialTarget{c, true}}};
    columns.kind.push_back(kind);
    columns.place.push_back(direction.empty() ? -1 : static_cast<Index>(columns.directions.size()));
    if (!direction.empty()) columns.directions.push_back(std::move(direction));
  }
  return columns;
}

MatrixXd MusculoskeletalProblem::latentScale(const OfTrial& one, const MusculoskeletalSystem& arm,
                                             const Trajectory& motion) const {
  Trajectory atNodes;  // the nearest rows
  const auto rows = static_cast<Index>(motion.time.size());
  const auto numNodes = static_cast<Index>(one.nodes.size());
  atNodes.q.resize(motion.q.rows(), numNodes);
  atNodes.fibreLength.resize(motion.fibreLength.rows(), numNodes);
  for (Index k = 0; k < numNodes; ++k) {
    const double at = one.nodes[static_cast<std::size_t>(k)] - motion.time.front();
    const Index row = std::clamp<Index>(
        static_cast<Index>(std::lround(at / options_.simulation.step)), 0, rows - 1);
    atNodes.q.col(k) = motion.q.col(row);
    atNodes.fibreLength.col(k) = motion.fibreLength.col(row);
  }
  const MuscleReport muscles = reportMuscles(arm, atNodes, encompassing_.freeIndex());
  MatrixXd scale(numNodes, muscles.momentArm.rows() + 1);
  scale << muscles.momentArm.cwiseProduct(muscles.tendonForce).transpose(),
      VectorXd::Constant(numNodes, options_.latentFloor);
  return scale;
}

MusculoskeletalProblem::Prediction MusculoskeletalProblem::predictWith(
    const Nudge* nudge, int trial, const VectorXd& values, const VectorXd& latent,
    const std::vector<std::size_t>& wanted, bool latentToo) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const OfTrial& one = of(trial);
  const auto K = static_cast<Index>(one.times.size());
  const auto numNodes = static_cast<Index>(latentToo ? one.nodes.size() : 0);
  Prediction result{
      VectorXd::Constant(K, nan), MatrixXd::Constant(K, static_cast<Index>(wanted.size()), nan),
      MatrixXd::Constant(latentToo ? K : 0, numNodes, nan),
      MatrixXd::Constant(numNodes, 1, options_.latentFloor), VectorXd::Constant(K, nan)};
  ParameterCatalogue::Setting setting = settingAt(one, values, wanted);
  const SensorLaw sensor = encompassing_.sensorAt(values);
  const double begin = one.trial.times[0];
  // forces that change in time follow those at the nodes
  const MatrixXd timedNodes = timedDirections(one, values, wanted);
  const bool timed = timedNodes.size() > 0;
  const Columns columns = columnsOf(one, values, wanted);

  SensitivityOptions options;
  SensitivityTrajectory s;
  try {
    options.simulation = simulationOf(one, withTimedForces(one, values, latent), sensor);
    if (nudge) apply(*nudge, setting.model, options.simulation.externalForce);
    if (latentToo || timed) options.externalNodes = {encompassing_.freeIndex(), one.nodes};
    const MusculoskeletalSystem arm = encompassing_.armOf(setting);
    s = simulateWithSensitivities(arm, setting, columns.directions, excitationFor(one, arm),
                                  options);
    if (latentToo) result.latentScale = latentScale(one, arm, s.motion);
  } catch (const std::exception&) {
    return result;  // outside the model's domain
  }

  const auto c = static_cast<std::size_t>(encompassing_.freeIndex());
  const Lagged course = lagged(s.motion.time, s.motion.q.row(encompassing_.freeIndex()),
                               s.motion.qDot.row(encompassing_.freeIndex()), sensor.lag);
  const auto q = course.value.row(0), qDot = course.speed.row(0);
  if (sensor.lag > 0) {
    const auto behind = [&](SensitivityMatrix& of, SensitivityMatrix& rate) {
      const Lagged late = lagged(s.motion.time, of.transpose(), rate.transpose(), sensor.lag);
      of = late.value.transpose();
      rate = late.speed.transpose();
    };
    behind(s.q[c], s.qDot[c]);
    if (numNodes > 0 || timed) behind(s.qOfNodes[c], s.qDotOfNodes[c]);
  }
  const double factor = 1 + sensor.gain;
  const double firstAngle = setting.start.q[encompassing_.freeIndex()];
  for (Index i = 0; i < K; ++i) {
    const double t = one.times[static_cast<std::size_t>(i)];
    const auto w = lookAt(s.motion.time, sensor.measuredAt(t, begin));
    if (!w) continue;
    const double value = w->value(q, qDot), slope = w->slope(q, qDot);
    result.outputs[i] = factor * value + sensor.bias + sensor.drift * (t - begin);
    result.speeds[i] = factor * slope;
    const Eigen::RowVectorXd along = factor * w->rows(s.q[c], s.qDot[c]);
    for (std::size_t j = 0; j < wanted.size(); ++j) {
      double& entry = result.gamma(i, static_cast<Index>(j));
      entry = columns.place[j] >= 0 ? along[columns.place[j]] : 0;
      // what the sensor shows of the first angle stays where it is
      const auto kind = columns.kind[j];
      if (wanted[j] == one.angle) entry /= factor;
      if (kind == Meaning::Kind::bias) entry = 1 - entry / factor;
      if (kind == Meaning::Kind::gain) entry = value - entry * firstAngle / factor;
      if (kind == Meaning::Kind::clock) entry = -factor * slope;
      if (kind == Meaning::Kind::rate) entry = factor * slope * (t - begin);
      if (kind == Meaning::Kind::lag) {
        entry = factor * w->value(course.inLag.row(0), course.inLagSpeed.row(0));
      }
      if (kind == Meaning::Kind::drift) entry = t - begin;
      if (kind == Meaning::Kind::timed) {
        entry = factor *
                w->rows(s.qOfNodes[c], s.qDotOfNodes[c]).dot(timedNodes.col(static_cast<Index>(j)));
      }
    }
    if (numNodes > 0) {
      result.latentGamma.row(i) = factor * w->rows(s.qOfNodes[c], s.qDotOfNodes[c]);
    }
  }
  return result;
}

}  // namespace bio::discover
