#include "bio/discovery/effect_size.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bio/discovery/encompassing_model.h"
#include "simulation/motion_weights.h"

namespace bio::discover {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double rootMeanSquare(const VectorXd& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

// The length of a fibre after a step of the implicit midpoint rule, by Newton's method within a
// bracket, since the velocity has kinks; NaN where there is none.
double steppedFibre(const SimulatedMuscle& muscle, double activation, double length,
                    double muscleTendonLength, double h) {
  double low = std::max(2 * muscle.thickness() - length, muscle.shortestFibre());
  double high = muscleTendonLength + muscle.thickness();
  double next = length;
  SchuttePieces pieces{};
  for (int i = 0; i < 200 && std::isfinite(next); ++i) {
    const FibreRateDerivatives rate = muscle.rateNear(
        activation, (length + next) / 2, muscleTendonLength, (next - length) / h, h, pieces);
    const double residual = (next - length) / h - rate.fibreVelocity;
    (residual > 0 ? high : low) = next;
    double better = next - residual / (1 / h - rate.dV_dFibreLength / 2);
    if (!(better > low && better < high)) better = (low + high) / 2;
    if (std::abs(better - next) < 1e-12 || high - low < 1e-12) return better;
    next = better;
  }
  return EffectSize::unknown;
}

// Net moment of an arm's muscles along a motion, from rest at its start.
VectorXd muscleMoments(const MusculoskeletalSystem& arm, const Trajectory& motion,
                       const MatrixXd& activation) {
  const auto rows = static_cast<Index>(motion.time.size());
  const auto n = static_cast<Index>(arm.numMuscles());
  Trajectory along;
  along.time = motion.time;
  along.q = motion.q;
  along.qDot = motion.qDot;
  along.activation = activation;
  along.fibreLength = MatrixXd::Constant(n, rows, EffectSize::unknown);
  SystemConfiguration<1> bodies(arm);
  using Vector = SystemConfiguration<1>::Vector;
  bodies.moveTo(Vector(motion.q(0, 0)));
  for (Index i = 0; i < n; ++i) {
    const auto m = static_cast<std::size_t>(i);
    const StaticEquilibrium rest =
        arm.muscles()[m].muscle.rest(activation(i, 0), bodies.length(m).length);
    if (rest.isUsable()) along.fibreLength(i, 0) = rest.fibreLength;
  }
  for (Index k = 0; k + 1 < rows; ++k) {
    const auto at = static_cast<std::size_t>(k);
    bodies.moveTo(Vector((motion.q(0, k) + motion.q(0, k + 1)) / 2));
    for (Index i = 0; i < n; ++i) {
      const auto m = static_cast<std::size_t>(i);
      if (!arm.muscles()[m].muscle.hasFibreState()) continue;  // its force follows the path
      along.fibreLength(i, k + 1) = steppedFibre(
          arm.muscles()[m].muscle, (activation(i, k) + activation(i, k + 1)) / 2,
          along.fibreLength(i, k), bodies.length(m).length, motion.time[at + 1] - motion.time[at]);
    }
  }
  const MuscleReport report = reportMuscles(arm, along);
  return report.tendonForce.cwiseProduct(report.momentArm).colwise().sum().transpose();
}

// M q̈ + ½ M' q̇² + V' − τ_passive along a motion.
VectorXd skeletonMoments(const MusculoskeletalSystem& arm, const Trajectory& motion) {
  const auto rows = static_cast<Index>(motion.time.size());
  SystemConfiguration<1> bodies(arm);
  using Vector = SystemConfiguration<1>::Vector;
  VectorXd moments(rows);
  for (Index k = 0; k < rows; ++k) {
    const Index before = std::max<Index>(0, k - 1), after = std::min(rows - 1, k + 1);
    const double acceleration = (motion.qDot(0, after) - motion.qDot(0, before)) /
                                (motion.time[static_cast<std::size_t>(after)] -
                                 motion.time[static_cast<std::size_t>(before)]);
    const double q = motion.q(0, k), qDot = motion.qDot(0, k);
    bodies.moveSkeletonTo(Vector(q));
    const auto& inertia = bodies.inertia();
    Vector passive = Vector::Zero(), slope = Vector::Zero(), rate = Vector::Zero();
    arm.coordinateForces().add<1>(Vector(q), Vector(qDot), passive, slope, rate);
    moments[k] = inertia.massMatrix(0, 0) * acceleration + inertia.dM[0](0, 0) / 2 * qDot * qDot +
                 inertia.dV[0] - passive[0];
  }
  return moments;
}

// How far the sensor, with this effect of it alone, is from the motion.
double sensorError(const Trajectory& motion, const SensorLaw& sensor, int coordinate) {
  const Lagged course =
      lagged(motion.time, motion.q.row(coordinate), motion.qDot.row(coordinate), sensor.lag);
  const auto q = course.value.row(0), qDot = course.speed.row(0);
  const double first = motion.time.front();
  std::vector<double> errors;
  for (std::size_t k = 0; k < motion.time.size(); ++k) {
    const auto w = weightsAt(motion.time, sensor.measuredAt(motion.time[k], first));
    if (!w) continue;
    errors.push_back((1 + sensor.gain) * w->value(q, qDot) + sensor.bias +
                     sensor.drift * (motion.time[k] - first) -
                     motion.q(coordinate, static_cast<Index>(k)));
  }
  if (errors.empty()) return EffectSize::unknown;
  return rootMeanSquare(VectorXd::Map(errors.data(), static_cast<Index>(errors.size())));
}

}  // namespace

EffectSize effectSize(const MusculoskeletalProblem& data, std::size_t candidate,
                      const VectorXd& values, int trial) {
  const auto& effect = data.candidates().at(candidate);
  const int coordinate = data.encompassing().freeIndex();
  EffectSize size;
  VectorXd absent = values, alone = data.encompassing().nominal();
  for (const std::size_t q : effect.quantities) {
    const auto i = static_cast<Index>(q);
    absent[i] = data.quantities()[q].nominal;
    alone[i] = values[i];
  }
  try {
    const Trajectory with = data.motion(trial, values);
    if (with.outcome != Outcome::completed) return size;
    if (effect.kind == info::discover::EffectKind::sensor) {
      size.motionRms = sensorError(with, data.encompassing().sensorAt(alone), coordinate);
      return size;
    }
    const Trajectory without = data.motion(trial, absent);
    if (without.outcome != Outcome::completed || without.time.size() != with.time.size())
      return size;
    size.motionRms = rootMeanSquare((with.q - without.q).row(coordinate).transpose());
    if (with.q.rows() != 1) return size;
    const MusculoskeletalSystem armWith = data.armAt(trial, values),
                                armWithout = data.armAt(trial, absent);
    const VectorXd muscles = muscleMoments(armWith, with, with.activation);
    const VectorXd moment = skeletonMoments(armWithout, with) -
                            muscleMoments(armWithout, with, without.activation) -
                            skeletonMoments(armWith, with) + muscles;
    if (!moment.allFinite()) return size;
    size.momentRms = rootMeanSquare(moment);
    size.momentPeak = moment.cwiseAbs().maxCoeff();
    if (rootMeanSquare(muscles) > 0) size.share = size.momentRms / rootMeanSquare(muscles);
  } catch (const std::exception&) {
    // outside the model's domain without it
  }
  return size;
}

}  // namespace bio::discover
