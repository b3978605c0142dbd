#include "discovery/sensed_motion.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "bio/analysis/observed_motion.h"
#include "discovery/look_at.h"

namespace bio::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

VectorXd vectorOf(const std::vector<double>& values) {
  return VectorXd::Map(values.data(), static_cast<Index>(values.size()));
}

/// Share of the row behind, and the row before it.
std::pair<Index, double> between(const std::vector<double>& time, double t) {
  const auto behind = std::upper_bound(time.begin(), time.end(), t);
  const auto k = std::clamp<std::ptrdiff_t>(behind - time.begin() - 1, 0,
                                            static_cast<std::ptrdiff_t>(time.size()) - 2);
  const auto at = static_cast<std::size_t>(k);
  return {k, std::clamp((t - time[at]) / (time[at + 1] - time[at]), 0.0, 1.0)};
}

}  // namespace

SensedMotion::SensedMotion(const MusculoskeletalSystem& system, Observable what,
                           const SensorLaw& law, std::vector<double> stamps, double first)
    : system_(&system),
      what_(std::move(what)),
      law_(law),
      stamps_(std::move(stamps)),
      first_(first) {
  (void)ObservedMotion(system, {{what_, {}}});
  if (what_.isCoordinate()) coordinate_ = system.skeleton().indexOf(what_.of);
}

SensedMotion::Shown SensedMotion::shown(const Trajectory& motion) const {
  if (coordinate_ >= 0) return shownCoordinate(motion);
  Shown shown{VectorXd::Constant(size(), missing), VectorXd::Constant(size(), missing)};
  const VectorXd times = timesWithin(motion, 0);
  VectorXd values;
  if (law_.lag > 0) {
    const Lagged course = laggedCourse(motion);
    values.resize(size());
    for (Index i = 0; i < size(); ++i) {
      const auto [k, w] = between(motion.time, times[i]);
      values[i] = (1 - w) * course.value(0, k) + w * course.value(0, k + 1);
    }
  } else {
    values = valuesAt(motion, times);
  }
  const VectorXd rates = ratesOf(motion);
  const double factor = 1 + law_.gain;
  for (Index i = 0; i < size(); ++i) {
    if (measuredAt(i) > motion.time.back() + 1e-9) continue;
    shown.values[i] = factor * values[i] + law_.bias + law_.drift * since(i);
    shown.rates[i] = factor * rates[i];
  }
  return shown;
}

SensedMotion::Slopes SensedMotion::slopes(const SensitivityTrajectory& s) const {
  if (coordinate_ >= 0) return slopesOfCoordinate(s);
  const double factor = 1 + law_.gain;
  const VectorXd times = timesWithin(s.motion, 0);
  Slopes slopes;
  if (law_.lag > 0) {
    const ObservedMotion rows(*system_, {{what_, vectorOf(s.motion.time)}});
    const auto all = rows.linearised(s);
    const MatrixXd gamma = all.gamma.transpose();
    const Lagged late =
        lagged(s.motion.time, gamma, MatrixXd::Zero(gamma.rows(), gamma.cols()), law_.lag);
    const Lagged course = laggedCourse(s.motion);
    slopes.gamma.resize(size(), gamma.rows());
    slopes.value.resize(size());
    slopes.inLag.resize(size());
    for (Index i = 0; i < size(); ++i) {
      const auto [k, w] = between(s.motion.time, times[i]);
      slopes.gamma.row(i) =
          factor * ((1 - w) * late.value.col(k) + w * late.value.col(k + 1)).transpose();
      slopes.value[i] = (1 - w) * course.value(0, k) + w * course.value(0, k + 1);
      slopes.inLag[i] = factor * ((1 - w) * course.inLag(0, k) + w * course.inLag(0, k + 1));
    }
    return slopes;
  }
  const auto at = ObservedMotion(*system_, {{what_, times}}).linearised(s);
  slopes.gamma = factor * at.gamma;
  slopes.value = at.values;
  slopes.inLag = -factor * ratesOf(s.motion);  // x_L = x − lag·ẋ
  return slopes;
}

SensedMotion::Shown SensedMotion::shownCoordinate(const Trajectory& motion) const {
  Shown shown{VectorXd::Constant(size(), missing), VectorXd::Constant(size(), missing)};
  const Lagged course =
      lagged(motion.time, motion.q.row(coordinate_), motion.qDot.row(coordinate_), law_.lag);
  const auto q = course.value.row(0), qDot = course.speed.row(0);
  const double factor = 1 + law_.gain;
  for (Index i = 0; i < size(); ++i) {
    const auto w = lookAt(motion.time, measuredAt(i));
    if (!w) continue;
    shown.values[i] = factor * w->value(q, qDot) + law_.bias + law_.drift * since(i);
    shown.rates[i] = factor * w->slope(q, qDot);
  }
  return shown;
}

SensedMotion::Slopes SensedMotion::slopesOfCoordinate(const SensitivityTrajectory& s) const {
  const auto c = static_cast<std::size_t>(coordinate_);
  const Trajectory& motion = s.motion;
  Slopes slopes{MatrixXd::Constant(size(), s.q[c].cols(), missing),
                VectorXd::Constant(size(), missing), VectorXd::Constant(size(), missing)};
  SensitivityMatrix late, lateRate;
  if (law_.lag > 0) {
    const Lagged behind = lagged(motion.time, s.q[c].transpose(), s.qDot[c].transpose(), law_.lag);
    late = behind.value.transpose();
    lateRate = behind.speed.transpose();
  }
  const SensitivityMatrix& of = law_.lag > 0 ? late : s.q[c];
  const SensitivityMatrix& rate = law_.lag > 0 ? lateRate : s.qDot[c];
  const Lagged course =
      lagged(motion.time, motion.q.row(coordinate_), motion.qDot.row(coordinate_), law_.lag);
  const double factor = 1 + law_.gain;
  for (Index i = 0; i < size(); ++i) {
    const auto w = lookAt(motion.time, measuredAt(i));
    if (!w) continue;
    slopes.gamma.row(i) = factor * w->rows(of, rate);
    slopes.value[i] = w->value(course.value.row(0), course.speed.row(0));
    slopes.inLag[i] = factor * w->value(course.inLag.row(0), course.inLagSpeed.row(0));
  }
  return slopes;
}

VectorXd SensedMotion::valuesAt(const Trajectory& motion, const VectorXd& times) const {
  return ObservedMotion(*system_, {{what_, times}}).values(motion);
}

VectorXd SensedMotion::timesWithin(const Trajectory& motion, double shift) const {
  VectorXd times(size());
  for (Index i = 0; i < size(); ++i)
    times[i] = std::clamp(measuredAt(i) + shift, motion.time.front(), motion.time.back());
  return times;
}

/// ẋ_L(t′), by differences over a row's step.
VectorXd SensedMotion::ratesOf(const Trajectory& motion) const {
  if (law_.lag > 0) {
    const Lagged course = laggedCourse(motion);
    VectorXd rates(size());
    const VectorXd times = timesWithin(motion, 0);
    for (Index i = 0; i < size(); ++i) {
      const Index k = between(motion.time, times[i]).first;
      rates[i] =
          (course.value(0, k + 1) - course.value(0, k)) /
          (motion.time[static_cast<std::size_t>(k) + 1] - motion.time[static_cast<std::size_t>(k)]);
    }
    return rates;
  }
  constexpr double aside = 1e-4;  // [s]
  const VectorXd before = timesWithin(motion, -aside), after = timesWithin(motion, aside);
  const VectorXd difference = valuesAt(motion, after) - valuesAt(motion, before);
  return (difference.array() / (after - before).array().max(1e-12)).matrix();
}

Lagged SensedMotion::laggedCourse(const Trajectory& motion) const {
  const VectorXd rows = valuesAt(motion, vectorOf(motion.time));
  const MatrixXd course = rows.transpose();
  return lagged(motion.time, course, MatrixXd::Zero(1, course.cols()), law_.lag);
}

}  // namespace bio::discover
