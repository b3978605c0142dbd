#include "discovery/sensed_motion.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "bio/observation/observed_motion.h"
#include "discovery/look_at.h"
#include "info/dynamics/linear_table.h"

namespace bio::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

VectorXd vectorOf(const std::vector<double>& values) {
  return VectorXd::Map(values.data(), static_cast<Index>(values.size()));
}

}  // namespace

SensedMotion::SensedMotion(const MusculoskeletalSystem& system, Observable what,
                           const SensorLaw& law, std::vector<double> stamps, double first)
    : system_(&system),
      what_(std::move(what)),
      law_(law),
      stamps_(std::move(stamps)),
      first_(first) {
  const ObservedMotion observed(system, {{what_, {}}});
  needsMuscles_ = observed.needsMuscles();
  needsReactions_ = observed.needsReactions();
  if (what_.isCoordinate()) coordinate_ = system.skeleton().indexOf(what_.object);
}

VectorXd SensedMotion::since() const {
  return vectorOf(stamps_).array() - first_;
}

SensedMotion::Shown SensedMotion::shown(const Trajectory& motion) const {
  const Sensed at = sensed(motion);
  const double factor = 1 + law_.gain;
  return {((factor * at.value).array() + law_.bias + law_.drift * since().array()).matrix(),
          factor * at.rate};
}

SensedMotion::Slopes SensedMotion::slopes(const SensitivityTrajectory& s) const {
  const std::vector<double>& time = s.motion.time;
  const double factor = 1 + law_.gain;
  Sensed at = sensed(s.motion);
  Slopes slopes{SensitivityMatrix::Constant(size(), s.q.front().cols(), missing),
                std::move(at.value), factor * at.inLag};
  if (coordinate_ < 0 && !(law_.lag > 0)) {
    slopes.gamma =
        factor * ObservedMotion(*system_, {{what_, timesWithin(s.motion, 0)}}).linearised(s).gamma;
    return slopes;
  }
  if (coordinate_ < 0) {
    const MatrixXd rows =
        ObservedMotion(*system_, {{what_, vectorOf(time)}}).linearised(s).gamma.transpose();
    const SensitivityMatrix late =
        lagged(time, rows, MatrixXd::Zero(rows.rows(), rows.cols()), law_.lag).value.transpose();
    const VectorXd times = timesWithin(s.motion, 0);
    for (Index i = 0; i < size(); ++i)
      slopes.gamma.row(i) = factor * info::linearAt(time, times[i]).rows(late);
    return slopes;
  }
  const auto c = static_cast<std::size_t>(coordinate_);
  SensitivityMatrix late, lateRate;
  if (law_.lag > 0) {
    const Lagged behind = lagged(time, s.q[c].transpose(), s.qDot[c].transpose(), law_.lag);
    late = behind.value.transpose();
    lateRate = behind.speed.transpose();
  }
  const SensitivityMatrix& slope = law_.lag > 0 ? late : s.q[c];
  const SensitivityMatrix& rate = law_.lag > 0 ? lateRate : s.qDot[c];
  for (Index i = 0; i < size(); ++i) {
    if (const auto w = lookAt(time, measuredAt(i)))
      slopes.gamma.row(i) = factor * w->rows(slope, rate);
  }
  return slopes;
}

SensedMotion::Sensed SensedMotion::sensed(const Trajectory& motion) const {
  if (coordinate_ >= 0) return sensedCoordinate(motion);
  Sensed at;
  if (law_.lag > 0) {
    at = sensedLate(motion);
  } else {
    // 0.1 ms to either side: of a cubic with x‴ of 1e4 units/s³ off by 2e-5, of rounding by 1e-12
    constexpr double aside = 1e-4;
    const VectorXd before = timesWithin(motion, -aside), after = timesWithin(motion, aside);
    at.value = valuesAt(motion, timesWithin(motion, 0));
    at.rate = ((valuesAt(motion, after) - valuesAt(motion, before)).array() /
               (after - before).array().max(1e-12))
                  .matrix();
    at.inLag = -at.rate;  // x_L = x − lag·ẋ
  }
  for (Index i = 0; i < size(); ++i) {
    if (measuredAt(i) > motion.time.back() + 1e-9) at.value[i] = at.rate[i] = at.inLag[i] = missing;
  }
  return at;
}

SensedMotion::Sensed SensedMotion::sensedCoordinate(const Trajectory& motion) const {
  const VectorXd nowhere = VectorXd::Constant(size(), missing);
  Sensed at{nowhere, nowhere, nowhere};
  const Lagged course =
      lagged(motion.time, motion.q.row(coordinate_), motion.qDot.row(coordinate_), law_.lag);
  const auto q = course.value.row(0), qDot = course.speed.row(0);
  for (Index i = 0; i < size(); ++i) {
    const auto w = lookAt(motion.time, measuredAt(i));
    if (!w) continue;
    at.value[i] = w->value(q, qDot);
    at.rate[i] = w->slope(q, qDot);
    at.inLag[i] = w->value(course.inLag.row(0), course.inLagSpeed.row(0));
  }
  return at;
}

/// Values of another observable after a lag, linear between rows.
SensedMotion::Sensed SensedMotion::sensedLate(const Trajectory& motion) const {
  const std::vector<double>& time = motion.time;
  const MatrixXd rows = valuesAt(motion, vectorOf(time)).transpose();
  const Lagged course = lagged(time, rows, MatrixXd::Zero(1, rows.cols()), law_.lag);
  const auto x = course.value.row(0), inLag = course.inLag.row(0);
  const VectorXd times = timesWithin(motion, 0);
  Sensed at{times, times, times};
  for (Index i = 0; i < size(); ++i) {
    const info::LinearWeights w = info::linearAt(time, times[i]);
    const auto k = static_cast<std::size_t>(w.row);
    at.value[i] = w.value(x);
    at.rate[i] = x.size() > 1 ? (x(w.row + 1) - x(w.row)) / (time[k + 1] - time[k]) : missing;
    at.inLag[i] = w.value(inLag);
  }
  return at;
}

VectorXd SensedMotion::timesWithin(const Trajectory& motion, double shift) const {
  VectorXd times(size());
  for (Index i = 0; i < size(); ++i)
    times[i] = std::clamp(measuredAt(i) + shift, motion.time.front(), motion.time.back());
  return times;
}

VectorXd SensedMotion::valuesAt(const Trajectory& motion, const VectorXd& times) const {
  return ObservedMotion(*system_, {{what_, times}}).values(motion);
}

}  // namespace bio::discover
