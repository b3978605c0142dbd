#pragma once

// Where parameters enter the equations of one configuration; not public.

#include "bio/skeleton/skeleton_motion.h"
#include "sensitivity/force_slopes.h"
#include "sensitivity/parameter_effects.h"
#include "sensitivity/sensitivity_state.h"
#include "sensitivity/tree_inertia_effects.h"
#include "simulation/coordinate_sums.h"
#include "simulation/integrators.h"

namespace bio::stepping {

/// ∂/∂θ at a held state: of paths, of passive forces, of momentum and of what gravity and inertia
/// do to it. The configuration is the caller's, who moves it first.
template <int N>
class DirectEffects {
 public:
  using Index = Eigen::Index;
  using Vector = Eigen::Matrix<double, N, 1>;
  using Rows = typename SensitivityState<N>::Rows;

  DirectEffects(const MusculoskeletalSystem& system, const ParameterEffects& effects,
                const Model& model, const SystemConfiguration<N>& configuration, Index columns)
      : system_(system),
        effects_(effects),
        configuration_(configuration),
        forceSlopes_(system, effects) {
    inertia_.setZero(countOf<N>(system), columns);
    slope_.setZero(countOf<N>(system), columns);
    for (std::size_t m = 0; m < system.numMuscles(); ++m) {
      const SystemMuscle& muscle = system.muscles()[m];
      gradients_.emplace_back(model, system.skeleton(), findMuscle(model, muscle.name),
                              muscle.path);
      if constexpr (N == Eigen::Dynamic) {
        workspaces_.push_back(gradients_.back().workspace(system.treePath(m)));
        treeWork_.push_back(system.treePath(m).newWork());
      } else {
        workspaces_.push_back(gradients_.back().template workspace<N>());
      }
    }
  }

  const ParameterEffects& effects() const { return effects_; }

  void widen(const SensitivityColumns& columns) {
    for (Rows* rows : {&inertia_, &slope_}) columns.widen(*rows);
  }

  /// All geometric derivatives of a muscle's path; the segments must be where q puts them.
  const PathGradient<N>& geometry(std::size_t m, const Vector& q) {
    PathGradient<N>& gradient = workspaces_[m];
    if constexpr (N == Eigen::Dynamic) {
      gradients_[m].evaluate(q, system_.treePath(m), *system_.tree(), configuration_.motion(),
                             treeWork_[m], gradient);
    } else {
      gradients_[m].template evaluate<N>(q, configuration_.motions().data(), gradient);
    }
    return gradient;
  }

  /// Calls use(effect, row of the gradient) for each geometric parameter of a muscle; the segments
  /// must be where q puts them.
  template <class Use>
  void forGeometry(std::size_t m, const Vector& q, const Use& use) {
    const auto& effects = effects_.muscles[m];
    if (!effects.hasGeometry()) return;
    const PathGradient<N>& gradient = geometry(m, q);
    for (const QuantityEffect& effect : effects.points) {
      use(effect,
          gradient.points[effect.quantity / 3].row(static_cast<Index>(effect.quantity % 3)));
    }
    for (const QuantityEffect& effect : effects.wraps) {
      use(effect, gradient.wraps[effect.quantity / wrap_rows::count].row(
                      static_cast<Index>(effect.quantity % wrap_rows::count)));
    }
  }

  /// Numbers of springs, bushings, elastic paths, actuators: use(effect, ∂τ/∂number) at t, in the
  /// configuration.
  template <class Use>
  void forForceNumbers(double t, const Vector& v, const ExternalForce& external, const Use& use) {
    forceSlopes_.forEach(t, configuration_, v, external, use);
  }

  /// All that is neither a muscle's nor inertia's, at time t in the configuration.
  void addOtherForces(double t, const Vector& q, const Vector& v, const ExternalForce& external,
                      Rows& force) {
    addPassiveForces(q, v, force);
    forForceNumbers(t, v, external, [&](const QuantityEffect& effect, const auto& slope) {
      force.col(effect.column) += effect.factor * slope;
    });
  }

  void addPassiveForces(const Vector& q, const Vector& v, Rows& force) const {
    for (const auto& law : effects_.limitForces) {
      const auto d = parameterDerivatives(law.law, q[law.coordinate], v[law.coordinate]);
      force(law.coordinate, law.effect.column) += law.effect.factor * d[law.effect.quantity];
    }
    for (const auto& law : effects_.springForces) {
      const auto d = parameterDerivatives(law.law, q[law.coordinate], v[law.coordinate]);
      force(law.coordinate, law.effect.column) += law.effect.factor * d[law.effect.quantity];
    }
    for (const auto& law : effects_.expressions) {
      force(law.coordinate, law.effect.column) +=
          law.effect.factor *
          law.law.parameterDerivative(law.effect.quantity, q[law.coordinate], v[law.coordinate]);
    }
  }

  /// Whether anything but zeros stands in the two below.
  bool changesInertia() const { return !effects_.segments.empty() || !effects_.gravity.empty(); }
  const Rows& momentum() const { return inertia_; }  ///< ∂(M v)/∂θ
  const Rows& slope() const { return slope_; }       ///< ∂(½ vᵀ∂M v − ∂V)/∂θ

  /// Both at a speed v, linear in the segments' moments: with Ẋ = Σ v_l ∂_lX,
  /// (M v)_k = tr(∂_kX P Ẋᵀ) and ½ vᵀ∂_kM v = tr(∂_kẊ P Ẋᵀ).
  void computeInertia(const Vector& v) {
    if (!changesInertia()) return;  // both stay 0
    inertia_.setZero();
    slope_.setZero();
    if constexpr (N == Eigen::Dynamic) {
      addTreeInertia(system_, configuration_, effects_, v, inertia_, slope_);
    } else {
      computeFixedInertia(v);
    }
  }

 private:
  void computeFixedInertia(const Vector& v) {
    for (const auto& effect : effects_.segments) {
      const RigidMotion<double, N>& X = configuration_.motions()[effect.segment];
      const auto along = [&](auto&& part) {
        Placement<double> sum{Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero()};
        for (int l = 0; l < N; ++l) {
          const Placement<double>& X_l = part(l);
          sum.R += v[l] * X_l.R;
          sum.p += v[l] * X_l.p;
        }
        return sum;
      };
      const Placement<double> dX =
          along([&](int l) -> const auto& { return X.first[static_cast<std::size_t>(l)]; });
      for (int k = 0; k < N; ++k) {
        const Placement<double>& X_k = X.first[static_cast<std::size_t>(k)];
        const Placement<double> dX_k = along([&](int l) -> const auto& {
          return X.second[static_cast<std::size_t>(pairIndex(k, l))];
        });
        inertia_(k, effect.column) += detail::momentProduct(effect.change, X_k, dX);
        slope_(k, effect.column) +=
            detail::momentProduct(effect.change, dX_k, dX) +
            system_.skeleton().gravity().dot(X_k.R * effect.change.massMoment +
                                             X_k.p * effect.change.mass);
      }
    }
    for (const QuantityEffect& effect : effects_.gravity) {
      const auto axis = static_cast<Index>(effect.quantity);
      for (std::size_t s = 1; s < system_.skeleton().numSegments(); ++s) {
        const Segment& segment = system_.skeleton().segments()[s];
        for (int k = 0; k < N; ++k) {
          const Placement<double>& X_k =
              configuration_.motions()[s].first[static_cast<std::size_t>(k)];
          slope_(k, effect.column) += effect.factor * (X_k.R.row(axis).dot(segment.massMoment) +
                                                       X_k.p[axis] * segment.mass);
        }
      }
    }
  }

  const MusculoskeletalSystem& system_;
  const ParameterEffects& effects_;
  const SystemConfiguration<N>& configuration_;
  ForceSlopes<N> forceSlopes_;
  std::vector<PathGradients> gradients_;
  std::vector<PathGradient<N>> workspaces_;
  std::vector<SupportedLength<double>> treeWork_;
  Rows inertia_, slope_;
};

}  // namespace bio::stepping
