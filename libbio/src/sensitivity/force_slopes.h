#pragma once

// Derivatives of springs, bushings, elastic paths and actuators in their own numbers; not public.

#include "sensitivity/parameter_effects.h"
#include "simulation/other_forces.h"

namespace bio::stepping {

/// ∂τ/∂θ of what is neither a muscle nor a force on a single coordinate, in one configuration after
/// the other; holds what that needs.
template <int N>
class ForceSlopes {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  ForceSlopes(const MusculoskeletalSystem& system, const ParameterEffects& effects)
      : system_(system), effects_(effects) {
    using Kind = ForceNumberTarget::Kind;
    for (const auto& force : effects.forces) {
      const bool isOnBodies = force.kind == Kind::pointSpring || force.kind == Kind::bushing;
      if (isOnBodies && segments_.empty()) segments_ = system.bodyForces().segments();
    }
  }

  /// Calls use(effect, ∂τ/∂number) for every number wanted; the configuration is where the
  /// coordinates are, v their speeds.
  template <class Use>
  void forEach(double t, const SystemConfiguration<N>& configuration, const Vector& v,
               const ExternalForce& external, const Use& use) {
    if (effects_.forces.empty()) return;
    if (!segments_.empty()) moveSegments(system_, configuration, segments_);
    speeds_ = v;
    for (const auto& force : effects_.forces) {
      evaluate(force, t, configuration, v, external);
      for (const QuantityEffect& effect : force.numbers) {
        use(effect, slopes_.col(static_cast<Eigen::Index>(effect.quantity)));
      }
    }
  }

 private:
  void evaluate(const ParameterEffects::OfForce& force, double t,
                const SystemConfiguration<N>& configuration, const Vector& v,
                const ExternalForce& external) {
    switch (force.kind) {
      case ForceNumberTarget::Kind::pointSpring:
        system_.bodyForces().springInNumbers(force.place, segments_, slopes_);
        break;
      case ForceNumberTarget::Kind::bushing:
        system_.bodyForces().bushingInNumbers(force.place, segments_, speeds_, slopes_);
        break;
      case ForceNumberTarget::Kind::elasticPath: {
        const LengthJet<N>& path = configuration.length(system_.numMuscles() + force.place);
        const auto d =
            system_.elasticPaths()[force.place].law.inNumbers(path.length, path.dL_dq.dot(v));
        slopes_.setZero(v.size(), static_cast<Eigen::Index>(d.size()));
        forEachMoved<N>(path, [&](int k, int) {
          for (std::size_t i = 0; i < d.size(); ++i) {
            slopes_(k, static_cast<Eigen::Index>(i)) = -d[i] * path.dL_dq[k];
          }
        });
        break;
      }
      case ForceNumberTarget::Kind::actuator: {
        const CoordinateActuator& actuator = system_.actuators()[force.place];
        slopes_.setZero(v.size(), 1);
        slopes_(system_.skeleton().indexOf(actuator.coordinate), 0) =
            external.controlAt(actuator.name, t);
        break;
      }
    }
  }

  const MusculoskeletalSystem& system_;
  const ParameterEffects& effects_;
  std::vector<MovingSegment> segments_;
  Eigen::VectorXd speeds_;
  Eigen::MatrixXd slopes_;
};

}  // namespace bio::stepping
