#pragma once

#include <array>
#include <cstddef>

#include "bio/muscle/schutte_muscle.h"

namespace bio {

/// The parameters of a Schutte muscle that a simulation can be differentiated in.
///
/// The four scales change a curve relative to that of the model, for which they are 1:
///     F̂_T(ε/s_T),   s_a·f_l(1 + (l − 1)/s_w),   s_p·f_PE(l)
enum class MuscleQuantity : std::size_t {
  maxIsometricForce,   ///< F0 [N]
  optimalFibreLength,  ///< ℓ0 [m]
  tendonSlackLength,   ///< ℓs [m]
  pennation,           ///< α0 [rad]
  damping,             ///< B [1]
  timeScale,           ///< t_s [s] of force–velocity relation and activation
  tendonStrainScale,   ///< s_T [1]: compliance of the tendon
  activeForceScale,    ///< s_a [1]
  activeForceWidth,    ///< s_w [1]: width of the force–length relation about ℓ0
  passiveForceScale,   ///< s_p [1]
  activation1,         ///< c₁ [1] of the activation dynamics only
  activation2          ///< c₂ [1] of the activation dynamics only
};
/// Number of the quantities before activation1: those on which fibre velocity and tendon force
/// depend.
constexpr std::size_t numFibreQuantities = 10;
constexpr std::size_t numMuscleQuantities = 12;

/// Partial derivatives of a fibre's velocity and force with respect to the muscle's parameters, one
/// per MuscleQuantity, at fixed activation, ℓ and ℓ_MT.
struct FibreParameterDerivatives {
  std::array<double, numFibreQuantities> dV;  ///< ∂V/∂θ [m/s per unit]
  std::array<double, numFibreQuantities> dF;  ///< ∂F_T/∂θ [N per unit]
};

/// Analytical derivatives. With V = (ℓ0/t_s)·v(P, A, B), v_θ = v_P P_θ + v_A A_θ + v_B B_θ and v_B
/// = −v/(A f_v′ + B); P and A as in SchutteMuscle. At a kink they are those of the side that
/// fibreRateDerivatives takes; where P is clamped its derivatives are 0.
FibreParameterDerivatives fibreParameterDerivatives(const SchutteMuscle<double>& muscle,
                                                    double activation, double fibreLength,
                                                    double muscleTendonLength);
/// Derivatives without a search in the curves where `last` is from a state nearby; it is updated.
FibreParameterDerivatives fibreParameterDerivatives(const SchutteMuscle<double>& muscle,
                                                    double activation, double fibreLength,
                                                    double muscleTendonLength, SchuttePieces& last);

/// Derivatives of the fibre length in static equilibrium.
struct EquilibriumDerivatives {
  double dl_dActivation;                                ///< ∂ℓ/∂act [m]
  double dl_dMuscleTendonLength;                        ///< ∂ℓ/∂ℓ_MT [1]
  std::array<double, numFibreQuantities> dl_dQuantity;  ///< ∂ℓ/∂θ
};

/// By the implicit function theorem on P − A = 0, which is smooth where V = 0 has a kink; if fibre
/// and tendon carry no force (forceFree, or F_T < 1e-9·F0), of ℓ = √((ℓ_MT − ℓs)² + w²).
EquilibriumDerivatives equilibriumDerivatives(const SchutteMuscle<double>& muscle,
                                              double activation, double muscleTendonLength,
                                              const StaticEquilibrium& rest);

/// The curves that OpenSim's Schutte class has where a file gives none: F_T/F0 over the tendon's
/// strain, and f_l over ℓ/ℓ0.
SplineFunction schutteTendonCurve();
SplineFunction schutteActiveCurve();

}  // namespace bio
