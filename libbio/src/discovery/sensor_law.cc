#include "bio/discovery/sensor_law.h"

#include <algorithm>
#include <cmath>

#include "bio/observation/smoothed_motion.h"

namespace bio::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Between two times h apart the course is q + s·t, and so
//     q_L = q + s(t − τ) + (q_L0 − q_0 + τs) e^{−t/τ}
Lagged lagged(const std::vector<double>& times, const Eigen::Ref<const MatrixXd>& q,
              const Eigen::Ref<const MatrixXd>& qDot, double lag) {
  const Index n = q.cols();
  Lagged result{q, qDot, -qDot, MatrixXd::Zero(q.rows(), n)};
  if (!(lag > 0)) {
    for (Index k = 0; k < n && n > 1; ++k) {
      const Index before = std::max<Index>(0, k - 1), behind = std::min(n - 1, k + 1);
      const double h =
          times[static_cast<std::size_t>(behind)] - times[static_cast<std::size_t>(before)];
      result.inLagSpeed.col(k) = (qDot.col(before) - qDot.col(behind)) / h;
    }
    return result;
  }
  result.inLag.leftCols(std::min<Index>(1, n)).setZero();
  for (Index k = 0; k + 1 < n; ++k) {
    const double h = times[static_cast<std::size_t>(k) + 1] - times[static_cast<std::size_t>(k)];
    const double fade = std::exp(-h / lag);
    const VectorXd s = (q.col(k + 1) - q.col(k)) / h;
    const VectorXd behind = result.value.col(k) - q.col(k) + lag * s;
    result.value.col(k + 1) = q.col(k + 1) - lag * s + fade * behind;
    result.inLag.col(k + 1) = -s + fade * (result.inLag.col(k) + s + (h / (lag * lag)) * behind);
  }
  result.speed = (q - result.value) / lag;
  result.inLagSpeed = -(result.inLag + result.speed) / lag;
  return result;
}

namespace {

/// Speeds of the course that the samples smoothly follow [1/s of its unit].
VectorXd speedsOf(const MeasuredChannel& motion) {
  const std::vector<double> times(motion.times.begin(), motion.times.end());
  const SmoothedMotion course = smoothed(times, motion.values);
  VectorXd speeds(motion.times.size());
  for (Index i = 0; i < speeds.size(); ++i) {
    const double x = (motion.times[i] - course.times.front()) / (course.times[1] - course.times[0]);
    const auto k = std::min(static_cast<Index>(x), course.speeds.size() - 2);
    const double w = x - static_cast<double>(k);
    speeds[i] = (1 - w) * course.speeds[k] + w * course.speeds[k + 1];
  }
  return speeds;
}

}  // namespace

Trial asTrueSensor(Trial trial, const Observable& what, const SensorLaw& sensor) {
  if (!sensor.isTrue()) trial.sha256.clear();  // it is not what is in the file
  const double first = trial.times[0], last = trial.times[trial.times.size() - 1];
  for (MeasuredChannel& motion : trial.measured) {
    if (motion.what != what || sensor.isTrue()) continue;
    VectorXd shown = motion.values;
    if (sensor.lag > 0) shown += sensor.lag * speedsOf(motion);
    std::vector<double> times, values;
    for (Index i = 0; i < motion.times.size(); ++i) {
      const double written = motion.times[i];
      const double t = sensor.measuredAt(written, first);
      if (t < first || t > last) continue;
      times.push_back(t);
      values.push_back((shown[i] - sensor.bias - sensor.drift * (written - first)) /
                       (1 + sensor.gain));
    }
    const auto n = static_cast<Index>(times.size());
    motion.times = VectorXd::Map(times.data(), n);
    motion.values = VectorXd::Map(values.data(), n);
  }
  return trial;
}

}  // namespace bio::discover
