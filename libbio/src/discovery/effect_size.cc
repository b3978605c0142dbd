#include "bio/discovery/effect_size.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "bio/discovery/encompassing_model.h"
#include "discovery/sensed_motion.h"

namespace bio::discover {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double rootMeanSquare(const VectorXd& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

// How far a sensor is from the coordinate that it measures, from the first time on that it shows.
double sensorError(const Trajectory& motion, const SensedMotion& sensor, int coordinate) {
  const VectorXd shown = sensor.shown(motion).values;
  std::vector<double> errors;
  for (Index k = 0; k < shown.size(); ++k) {
    if (std::isnan(shown[k]) || sensor.measuredAt(k) < motion.time.front() - 1e-9) continue;
    errors.push_back(shown[k] - motion.q(coordinate, k));
  }
  if (errors.empty()) return std::numeric_limits<double>::quiet_NaN();
  return rootMeanSquare(VectorXd::Map(errors.data(), static_cast<Index>(errors.size())));
}

}  // namespace

EffectSize effectSize(const MusculoskeletalProblem& data, std::size_t candidate,
                      const VectorXd& values, int trial) {
  const auto& effect = data.candidates().at(candidate);
  const int coordinate = data.encompassing().coordinates().front().index;
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
      const EncompassingModel& model = data.encompassing();
      const std::size_t sensor = model.sensorOf(effect.quantities.front());
      const Observable& what = model.sensors()[sensor];
      if (!what.isCoordinate()) return size;
      const MusculoskeletalSystem system = data.systemAt(trial, values);
      size.motionRms = sensorError(
          with, {system, what, model.sensorAt(alone, sensor), with.time, with.time.front()},
          system.skeleton().indexOf(what.object));
      return size;
    }
    const Trajectory without = data.motion(trial, absent);
    if (without.outcome != Outcome::completed || without.time.size() != with.time.size())
      return size;
    const MatrixXd moved = with.q - without.q;
    size.motionRms = rootMeanSquare(moved.row(coordinate).transpose());
    const Trajectory required = data.inverseDynamics(trial, values, with),
                     requiredWithout = data.inverseDynamics(trial, absent, with);
    if (required.outcome != Outcome::completed || requiredWithout.outcome != Outcome::completed)
      return size;
    const MatrixXd moments = requiredWithout.reaction - required.reaction;
    if (!moments.allFinite()) return size;
    const MusculoskeletalSystem system = data.systemAt(trial, values);
    for (int k = 0; k < static_cast<int>(moments.rows()); ++k) {
      const MuscleReport muscles = reportMuscles(system, with, k);
      const VectorXd net = muscles.tendonForce.cwiseProduct(muscles.momentArm).colwise().sum();
      EffectMoment moment{rootMeanSquare(moments.row(k)), moments.row(k).cwiseAbs().maxCoeff()};
      if (const double all = rootMeanSquare(net); all > 0) moment.share = moment.rms / all;
      moment.motionRms = rootMeanSquare(moved.row(k).transpose());
      size.moments.push_back(moment);
    }
    size.moment = size.moments[static_cast<std::size_t>(coordinate)];
  } catch (const std::exception&) {
    // outside the model's domain without it
  }
  return size;
}

}  // namespace bio::discover
