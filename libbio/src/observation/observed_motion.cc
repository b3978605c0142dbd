#include "bio/observation/observed_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "info/dynamics/linear_table.h"
#include "simulation/integrators.h"
#include "simulation/motion_weights.h"

namespace bio {
namespace {

using Eigen::Index;
using Kind = Observable::Kind;

template <class List>
int placeIn(const List& list, const std::string& name) {
  const auto at =
      std::find_if(list.begin(), list.end(), [&](const auto& one) { return one.name == name; });
  return at == list.end() ? -1 : static_cast<int>(at - list.begin());
}

/// Index of what an observable is of.
int sourceOf(const MusculoskeletalSystem& system, const Observable& what) {
  const auto refuse = [&](const char* rule) {
    throw std::invalid_argument(fmt::format("measured '{}': {}", nameOf(what), rule));
  };
  int index = -1;
  switch (what.kind) {
    case Kind::coordinate:
    case Kind::speed:
      index = system.skeleton().indexOf(what.object);
      if (index < 0) refuse("its coordinate must be free");
      break;
    case Kind::moment:
      index = system.skeleton().indexOf(what.object);
      if (index < 0 || !system.isPrescribed(index)) {
        refuse(
            "its coordinate must be prescribed or locked: where it is free to move, nothing "
            "holds it, and the moment is 0");
      }
      break;
    case Kind::marker:
      index = placeIn(system.markers(), what.object);
      if (index < 0) refuse("the model has no such marker");
      break;
    case Kind::fibreLength:
    case Kind::pennation:
    case Kind::tendonForce:
    case Kind::activation:
      index = placeIn(system.muscles(), what.object);
      if (index < 0) refuse("no free or prescribed coordinate moves this muscle");
      break;
  }
  return index;
}

/// sin α = w/ℓ, dα = (dw − sin α dℓ)/(ℓ cos α). A slack muscle with a rigid tendon has ℓ = w for
/// whatever parameters, so that α stays a right angle.
void pennationAt(const SimulatedMuscle& muscle, std::size_t place,
                 const info::LinearWeights& between, const Trajectory& motion,
                 const SensitivityTrajectory* s, Index at, ObservedMotion::Linearised& all) {
  const double l = between.value(motion.fibreLength.row(static_cast<Index>(place)));
  const double w = muscle.thickness();
  const double sine = std::min(1.0, w / l);
  all.values[at] = std::asin(sine);
  if (!s) return;
  const double cosine = std::sqrt(1 - sine * sine);
  if (!(cosine > 1e-9)) {
    all.gamma.row(at).setZero();
    return;
  }
  all.gamma.row(at) =
      (s->thickness[place] - sine * between.rows(s->fibreLength[place])) / (l * cosine);
}

}  // namespace

ObservedMotion::ObservedMotion(const MusculoskeletalSystem& system,
                               std::vector<ObservedSeries> series)
    : system_(&system), series_(std::move(series)) {
  for (const ObservedSeries& observed : series_) {
    sources_.push_back(sourceOf(system, observed.what));
    size_ += observed.times.size();
    const Kind kind = observed.what.kind;
    needsReactions_ = needsReactions_ || kind == Kind::moment;
    needsMuscles_ = needsMuscles_ || kind == Kind::fibreLength || kind == Kind::pennation ||
                    kind == Kind::tendonForce || kind == Kind::activation;
  }
}

Eigen::VectorXd ObservedMotion::values(const Trajectory& motion) const {
  return evaluate(motion, nullptr).values;
}

ObservedMotion::Linearised ObservedMotion::linearised(const SensitivityTrajectory& s) const {
  return evaluate(s.motion, &s);
}

ObservedMotion::Linearised ObservedMotion::evaluate(const Trajectory& motion,
                                                    const SensitivityTrajectory* s) const {
  const Index parameters = s ? s->q.front().cols() : 0;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Linearised all{Eigen::VectorXd::Constant(size_, nan),
                 Eigen::MatrixXd::Constant(size_, parameters, nan)};
  const bool hasForces = std::any_of(
      series_.begin(), series_.end(),
      [](const ObservedSeries& series) { return series.what.kind == Kind::tendonForce; });
  const MuscleReport muscles = hasForces ? reportMuscles(*system_, motion) : MuscleReport{};
  Index at = 0;
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const Observable& what = series_[i].what;
    const Eigen::VectorXd& times = series_[i].times;
    const int index = sources_[i];
    const auto place = static_cast<std::size_t>(index);
    if (what.kind == Kind::marker) {
      addMarker(series_[i], system_->markers()[place], motion, s, at, all);
      at += times.size();
      continue;
    }
    for (Index k = 0; k < times.size(); ++k, ++at) {
      const auto w = weightsAt(motion.time, times[k]);
      if (!w) continue;
      const auto cubic = [&](double value, const auto& slopes) {
        all.values[at] = value;
        if (s) all.gamma.row(at) = slopes(s->q[place], s->qDot[place]);
      };
      const auto straight = [&](double sign, const auto& values, const auto& member) {
        const info::LinearWeights between = info::linearAt(motion.time, times[k]);
        all.values[at] = sign * between.value(values);
        if (s) all.gamma.row(at) = sign * between.rows((s->*member)[place]);
      };
      switch (what.kind) {
        case Kind::coordinate:
          cubic(w->value(motion.q.row(index), motion.qDot.row(index)),
                [&](const auto& q, const auto& qDot) { return w->rows(q, qDot); });
          break;
        case Kind::speed:
          cubic(w->slope(motion.q.row(index), motion.qDot.row(index)),
                [&](const auto& q, const auto& qDot) { return w->slopeRows(q, qDot); });
          break;
        case Kind::moment:
          straight(-1, motion.reaction.row(index), &SensitivityTrajectory::reaction);
          break;
        case Kind::fibreLength:
          straight(1, motion.fibreLength.row(index), &SensitivityTrajectory::fibreLength);
          break;
        case Kind::pennation:
          pennationAt(system_->muscles()[place].muscle, place,
                      info::linearAt(motion.time, times[k]), motion, s, at, all);
          break;
        case Kind::tendonForce:
          straight(1, muscles.tendonForce.row(index), &SensitivityTrajectory::tendonForce);
          break;
        case Kind::activation:
          straight(1, motion.activation.row(index), &SensitivityTrajectory::activation);
          break;
        case Kind::marker:
          break;
      }
    }
  }
  return all;
}

/// ∂x/∂θ = Σ_c ∂x/∂q_c ∂q_c/∂θ along an axis of the ground, from row `first` on.
void ObservedMotion::addMarker(const ObservedSeries& series, const SystemMarker& marker,
                               const Trajectory& motion, const SensitivityTrajectory* s,
                               Index first, Linearised& all) const {
  const auto along = [&](const Placement<double>& X) {
    return X.R.row(series.what.axis).dot(marker.p_S) + X.p[series.what.axis];
  };
  stepping::withCoordinates(system_->skeleton(), [&](auto N) {
    constexpr int count = decltype(N)::value;
    SystemConfiguration<count> configuration(*system_);
    Eigen::Matrix<double, count, 1> q = system_->skeleton().defaultValues();
    for (Index k = 0; k < series.times.size(); ++k) {
      const auto w = weightsAt(motion.time, series.times[k]);
      if (!w) continue;
      for (Index c = 0; c < q.size(); ++c) q[c] = w->value(motion.q.row(c), motion.qDot.row(c));
      configuration.moveSkeletonTo(q);
      if constexpr (count == Eigen::Dynamic) {
        all.values[first + k] = along(configuration.placement(marker.segment));
      } else {
        all.values[first + k] = along(configuration.motions()[marker.segment].value);
      }
      if (!s) continue;
      all.gamma.row(first + k).setZero();
      for (std::size_t c = 0; c < s->q.size(); ++c) {
        double slope = 0;
        if constexpr (count == Eigen::Dynamic) {
          slope = along(configuration.change(marker.segment, static_cast<int>(c)));
        } else {
          slope = along(configuration.motions()[marker.segment].first[c]);
        }
        all.gamma.row(first + k) += slope * w->rows(s->q[c], s->qDot[c]);
      }
    }
  });
}

void ObservedMotion::requireAdjoint() const {
  for (const ObservedSeries& series : series_) {
    const Kind kind = series.what.kind;
    if (kind != Kind::coordinate && kind != Kind::speed && kind != Kind::marker) {
      throw std::invalid_argument(fmt::format(
          "gradient of a cost: '{}' has no adjoint, only coordinates, speeds and markers have",
          nameOf(series.what)));
    }
  }
}

void ObservedMotion::pullBack(const Trajectory& motion, const Eigen::VectorXd& lambda,
                              Eigen::MatrixXd& q, Eigen::MatrixXd& qDot) const {
  requireAdjoint();
  if (lambda.size() != size_) {
    throw std::invalid_argument(
        fmt::format("{} slopes for {} observed samples, must be as many", lambda.size(), size_));
  }
  q.setZero(motion.q.rows(), motion.q.cols());
  qDot = q;
  Index at = 0;
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const auto& [what, times] = series_[i];
    const int index = sources_[i];
    if (what.kind == Kind::marker) {
      pullMarkerBack(series_[i], system_->markers()[static_cast<std::size_t>(index)], motion,
                     lambda.segment(at, times.size()), q, qDot);
    }
    for (Index k = 0; k < times.size() && what.kind != Kind::marker; ++k) {
      const auto w = weightsAt(motion.time, times[k]);
      if (!w) continue;
      if (what.kind == Kind::coordinate) w->addValue(lambda[at + k], q.row(index), qDot.row(index));
      if (what.kind == Kind::speed) w->addSlope(lambda[at + k], q.row(index), qDot.row(index));
    }
    at += times.size();
  }
}

void ObservedMotion::pullMarkerBack(const ObservedSeries& series, const SystemMarker& marker,
                                    const Trajectory& motion,
                                    const Eigen::Ref<const Eigen::VectorXd>& lambda,
                                    Eigen::MatrixXd& q, Eigen::MatrixXd& qDot) const {
  const auto along = [&](const Placement<double>& X) {
    return X.R.row(series.what.axis).dot(marker.p_S) + X.p[series.what.axis];
  };
  stepping::withCoordinates(system_->skeleton(), [&](auto N) {
    constexpr int count = decltype(N)::value;
    SystemConfiguration<count> configuration(*system_);
    Eigen::Matrix<double, count, 1> posture = system_->skeleton().defaultValues();
    for (Index k = 0; k < series.times.size(); ++k) {
      const auto w = weightsAt(motion.time, series.times[k]);
      if (!w) continue;
      for (Index c = 0; c < posture.size(); ++c) {
        posture[c] = w->value(motion.q.row(c), motion.qDot.row(c));
      }
      configuration.moveSkeletonTo(posture);
      for (Index c = 0; c < posture.size(); ++c) {
        double slope = 0;
        if constexpr (count == Eigen::Dynamic) {
          slope = along(configuration.change(marker.segment, static_cast<int>(c)));
        } else {
          slope = along(configuration.motions()[marker.segment].first[static_cast<std::size_t>(c)]);
        }
        w->addValue(lambda[k] * slope, q.row(c), qDot.row(c));
      }
    }
  });
}

}  // namespace bio
