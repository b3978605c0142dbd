#pragma once

// A scalar's derivatives in everything that parameters touch, gathered along a motion; not public.

#include "sensitivity/inertia_adjoint.h"
#include "sensitivity/parameter_jacobian.h"

namespace bio::stepping {

/// Sums of a backward sweep: of every muscle in its own numbers and in the points and wrap objects
/// of its path, of every segment in its moments. Only the end of the sweep sorts them into the
/// columns of parameters, so that a step costs the same however many there are.
template <int N>
class GradientSums {
 public:
  using Index = Eigen::Index;
  using Vector = Eigen::Matrix<double, N, 1>;

  /// @param direct  made with one column, or any number: only its paths are used
  GradientSums(const MusculoskeletalSystem& system, DirectEffects<N>& direct,
               const SystemConfiguration<N>& configuration, Index numParameters)
      : effects_(direct.effects()),
        direct_(direct),
        inertia_(system, direct.effects(), configuration),
        changesInertia_(direct.changesInertia()),
        muscles_(system.numMuscles()),
        columns_(Eigen::VectorXd::Zero(numParameters)) {
    for (std::size_t m = 0; m < muscles_.size(); ++m) {
      const auto& effects = effects_.muscles[m];
      OfMuscle& muscle = muscles_[m];
      for (const QuantityEffect& effect : effects.fibre) {
        muscle.count = std::max(muscle.count, effect.quantity + 1);
      }
      std::size_t points = 0, wraps = 0;
      for (const QuantityEffect& e : effects.points) points = std::max(points, e.quantity / 3 + 1);
      for (const QuantityEffect& e : effects.wraps) {
        wraps = std::max(wraps, e.quantity / wrap_rows::count + 1);
      }
      muscle.points.assign(points, Eigen::Vector3d::Zero());
      muscle.wraps.assign(wraps, OfWrap::Zero());
    }
  }

  bool hasNumbers(std::size_t m) const { return muscles_[m].count > 0; }
  /// Adds factor·d to the sums in a muscle's numbers.
  void addNumbers(std::size_t m, double factor, const PerMuscleNumber& d) {
    OfMuscle& muscle = muscles_[m];
    for (std::size_t k = 0; k < muscle.count; ++k) muscle.numbers[k] += factor * d[k];
  }

  bool hasGeometry(std::size_t m) const { return effects_.muscles[m].hasGeometry(); }
  /// Adds w_0 ∂_θℓ + Σ w_{1+slot} ∂_θ∂ℓ of a muscle's path; the segments must be where q puts them.
  template <class Weights>
  void addGeometry(std::size_t m, const Vector& q, const Weights& w) {
    const PathGradient<N>& gradient = direct_.geometry(m, q);
    OfMuscle& muscle = muscles_[m];
    for (std::size_t i = 0; i < muscle.points.size(); ++i) {
      muscle.points[i].noalias() += gradient.points[i] * w;
    }
    for (std::size_t i = 0; i < muscle.wraps.size(); ++i) {
      muscle.wraps[i].noalias() += gradient.wraps[i] * w;
    }
  }

  /// Adds a·∂_θ(M v) + b·∂_θ(½ vᵀ∂M v − ∂V) at the configuration's posture.
  void addInertia(const Vector& v, const Vector& a, const Vector& b) {
    if (changesInertia_) inertia_.add(v, a, b);
  }

  /// Adds λ·∂_θτ of all that is neither a muscle's nor inertia's, at time t in the configuration.
  void addOtherForces(double t, const Vector& q, const Vector& v, const ExternalForce& external,
                      const Vector& lambda) {
    direct_.forForceNumbers(t, v, external, [&](const QuantityEffect& effect, const auto& slope) {
      columns_[effect.column] += effect.factor * slope.dot(lambda);
    });
    const auto add = [&](const auto& law, double derivative) {
      columns_[law.effect.column] += law.effect.factor * derivative * lambda[law.coordinate];
    };
    for (const auto& law : effects_.limitForces) {
      const auto d = parameterDerivatives(law.law, q[law.coordinate], v[law.coordinate]);
      add(law, d[law.effect.quantity]);
    }
    for (const auto& law : effects_.springForces) {
      const auto d = parameterDerivatives(law.law, q[law.coordinate], v[law.coordinate]);
      add(law, d[law.effect.quantity]);
    }
    for (const auto& law : effects_.expressions) {
      add(law,
          law.law.parameterDerivative(law.effect.quantity, q[law.coordinate], v[law.coordinate]));
    }
  }

  /// dJ/dθ of all that was added; without what goes through activations and the start.
  Eigen::VectorXd inColumns() const {
    Eigen::VectorXd gradient = columns_;
    for (std::size_t m = 0; m < muscles_.size(); ++m) {
      const auto& effects = effects_.muscles[m];
      const OfMuscle& muscle = muscles_[m];
      for (const QuantityEffect& effect : effects.fibre) {
        gradient[effect.column] += effect.factor * muscle.numbers[effect.quantity];
      }
      for (const QuantityEffect& effect : effects.points) {
        gradient[effect.column] +=
            effect.factor *
            muscle.points[effect.quantity / 3][static_cast<Index>(effect.quantity % 3)];
      }
      for (const QuantityEffect& effect : effects.wraps) {
        gradient[effect.column] +=
            effect.factor * muscle.wraps[effect.quantity / wrap_rows::count]
                                        [static_cast<Index>(effect.quantity % wrap_rows::count)];
      }
    }
    inertia_.addTo(gradient);
    return gradient;
  }

 private:
  using OfWrap = Eigen::Matrix<double, wrap_rows::count, 1>;
  struct OfMuscle {
    std::size_t count = 0;  ///< of the numbers, up to the last that is wanted
    PerMuscleNumber numbers{};
    std::vector<Eigen::Vector3d> points;
    std::vector<OfWrap> wraps;
  };

  const ParameterEffects& effects_;
  DirectEffects<N>& direct_;
  InertiaAdjoint<N> inertia_;
  bool changesInertia_;
  std::vector<OfMuscle> muscles_;
  Eigen::VectorXd columns_;
};

}  // namespace bio::stepping
