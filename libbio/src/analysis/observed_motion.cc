#include "bio/analysis/observed_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

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
int sourceOf(const MusculoskeletalSystem& arm, const Observable& what) {
  const auto refuse = [&](const char* rule) {
    throw std::invalid_argument(fmt::format("measured '{}': {}", nameOf(what), rule));
  };
  int index = -1;
  switch (what.kind) {
    case Kind::coordinate:
    case Kind::speed:
      index = arm.skeleton().indexOf(what.of);
      if (index < 0) refuse("its coordinate must be free");
      break;
    case Kind::moment:
      index = arm.skeleton().indexOf(what.of);
      if (index < 0 || !arm.isPrescribed(index)) {
        refuse(
            "its coordinate must be prescribed or locked: where it is free to move, nothing "
            "holds it, and the moment is 0");
      }
      break;
    case Kind::marker:
      index = placeIn(arm.markers(), what.of);
      if (index < 0) refuse("the model has no such marker");
      break;
    case Kind::fibreLength:
    case Kind::tendonForce:
    case Kind::activation:
      index = placeIn(arm.muscles(), what.of);
      if (index < 0) refuse("no free or prescribed coordinate moves this muscle");
      break;
  }
  return index;
}

/// A value between two rows of a motion, linear between them.
struct LinearWeights {
  Index row = 0;
  double behind = 0;
  template <class Values>
  auto value(const Values& y) const {
    return (1 - behind) * y(row) + behind * y(row + 1);
  }
  Eigen::RowVectorXd rows(const SensitivityMatrix& y) const {
    return (1 - behind) * y.row(row) + behind * y.row(row + 1);
  }
};

LinearWeights linear(const std::vector<double>& time, const MotionWeights& w, double t) {
  const auto k = static_cast<std::size_t>(w.row);
  return {w.row, std::clamp((t - time[k]) / (time[k + 1] - time[k]), 0.0, 1.0)};
}

}  // namespace

ObservedMotion::ObservedMotion(const MusculoskeletalSystem& arm, std::vector<ObservedSeries> series)
    : arm_(&arm), series_(std::move(series)) {
  for (const ObservedSeries& one : series_) {
    sources_.push_back(sourceOf(arm, one.what));
    size_ += one.times.size();
    const Kind kind = one.what.kind;
    needsReactions_ = needsReactions_ || kind == Kind::moment;
    needsMuscles_ = needsMuscles_ || kind == Kind::fibreLength || kind == Kind::tendonForce ||
                    kind == Kind::activation;
  }
}

double ObservedMotion::markerAt(const SystemMarker& marker, int axis, const Eigen::VectorXd& q,
                                Eigen::RowVectorXd* slope) const {
  return stepping::withCoordinates(arm_->skeleton(), [&](auto N) {
    SystemConfiguration<decltype(N)::value> configuration(*arm_);
    configuration.moveSkeletonTo(q);
    const auto along = [&](const Placement<double>& X) {
      return X.R.row(axis).dot(marker.p_S) + X.p[axis];
    };
    if (slope) slope->resize(q.size());
    if constexpr (decltype(N)::value == Eigen::Dynamic) {
      for (int k = 0; slope && k < slope->size(); ++k) {
        (*slope)[k] = along(configuration.change(marker.segment, k));
      }
      return along(configuration.placement(marker.segment));
    } else {
      const auto& X = configuration.motions()[marker.segment];
      for (int k = 0; slope && k < slope->size(); ++k) {
        (*slope)[k] = along(X.first[static_cast<std::size_t>(k)]);
      }
      return along(X.value);
    }
  });
}

Eigen::VectorXd ObservedMotion::values(const Trajectory& motion) const {
  SensitivityTrajectory alone;
  alone.motion = motion;
  return linearised(alone).values;
}

ObservedMotion::Linearised ObservedMotion::linearised(const SensitivityTrajectory& s) const {
  const Trajectory& motion = s.motion;
  const Index parameters = s.q.empty() ? 0 : s.q.front().cols();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Linearised result{Eigen::VectorXd::Constant(size_, nan),
                    Eigen::MatrixXd::Constant(size_, parameters, nan)};
  const bool wantsMuscles =
      std::any_of(series_.begin(), series_.end(),
                  [](const ObservedSeries& one) { return one.what.kind == Kind::tendonForce; });
  const MuscleReport muscles = wantsMuscles ? reportMuscles(*arm_, motion) : MuscleReport{};
  Index at = 0;
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const auto [what, times] = series_[i];
    const int index = sources_[i];
    const auto place = static_cast<std::size_t>(index);
    for (Index k = 0; k < times.size(); ++k, ++at) {
      const auto w = weightsAt(motion.time, times[k]);
      if (!w) continue;
      const LinearWeights between = linear(motion.time, *w, times[k]);
      double& value = result.values[at];
      const auto slopes = [&](const Eigen::RowVectorXd& row) {
        if (parameters > 0) result.gamma.row(at) = row;
      };
      const bool differentiates = parameters > 0;
      switch (what.kind) {
        case Kind::coordinate:
          value = w->value(motion.q.row(index), motion.qDot.row(index));
          if (differentiates) slopes(w->rows(s.q[place], s.qDot[place]));
          break;
        case Kind::speed:
          value = w->slope(motion.q.row(index), motion.qDot.row(index));
          if (differentiates) slopes(w->slopeRows(s.q[place], s.qDot[place]));
          break;
        case Kind::moment:
          value = -between.value(motion.reaction.row(index));
          if (differentiates) slopes(-between.rows(s.reaction[place]));
          break;
        case Kind::fibreLength:
          value = between.value(motion.fibreLength.row(index));
          if (differentiates) slopes(between.rows(s.fibreLength[place]));
          break;
        case Kind::tendonForce:
          value = between.value(muscles.tendonForce.row(index));
          if (differentiates) slopes(between.rows(s.tendonForce[place]));
          break;
        case Kind::activation:
          value = between.value(motion.activation.row(index));
          if (differentiates) slopes(between.rows(s.activation[place]));
          break;
        case Kind::marker: {
          Eigen::VectorXd q(motion.q.rows());
          for (Index c = 0; c < q.size(); ++c) q[c] = w->value(motion.q.row(c), motion.qDot.row(c));
          Eigen::RowVectorXd dx;
          value = markerAt(arm_->markers()[place], what.axis, q, differentiates ? &dx : nullptr);
          if (!differentiates) break;
          Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(parameters);
          for (Index c = 0; c < q.size(); ++c) {
            const auto sc = static_cast<std::size_t>(c);
            row += dx[c] * w->rows(s.q[sc], s.qDot[sc]);
          }
          slopes(row);
          break;
        }
      }
    }
  }
  return result;
}

}  // namespace bio
