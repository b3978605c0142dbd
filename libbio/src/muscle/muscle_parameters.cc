#include "bio/muscle/muscle_parameters.h"

#include <algorithm>
#include <cmath>

namespace bio {
namespace {

constexpr std::size_t at(MuscleQuantity quantity) {
  return static_cast<std::size_t>(quantity);
}

using PerQuantity = std::array<double, numFibreQuantities>;

/// P, A and F̂_T with their derivatives in the parameters and in act, ℓ and ℓ_MT.
struct Balance {
  double P = 0, A = 0;
  double tendon = 0, tendonSlope = 0;  ///< F̂_T over ε
  double A_act = 0, A_l = 0, P_l = 0, P_m = 0;
  PerQuantity dP{}, dA{}, dTendon{};
  bool clamped = false;
};

Balance balanceOf(const SchutteMuscle<double>& muscle, double activation, double fibreLength,
                  double muscleTendonLength, SchuttePieces& last) {
  const SchutteQuantities<double>& p = muscle.quantities();
  const SchutteCurves& curves = muscle.curves();
  Balance b;

  // pennation: d = √(ℓ² − w²), κ = ℓ/d, w = ℓ0 sin α0
  const double w = muscle.thickness();
  const double d = fibreLength > w ? std::sqrt(fibreLength * fibreLength - w * w)
                                   : std::numeric_limits<double>::quiet_NaN();
  const double kappa = fibreLength / d;
  const double d_w = -w / d;
  const double kappa_w = kappa * w / (d * d);
  const double kappa_l = -w * w / (d * d * d);

  // tendon: F̂_T(ε)
  const double strain = (muscleTendonLength - d) * muscle.perTendon() - 1;
  if (!(strain < 0)) {
    const CurveValue y = curves.tendonForce.evaluate(strain, last.tendonForce);
    b.tendon = y.value;
    b.tendonSlope = y.slope;
  }
  const double perStrain = b.tendonSlope * muscle.perTendon();
  const double w_l0 = w * muscle.perFibre();
  const double w_pennation = std::sqrt(p.optimalFibreLength * p.optimalFibreLength - w * w);
  const double tendon_w = -perStrain * d_w;
  b.dTendon[at(MuscleQuantity::optimalFibreLength)] = tendon_w * w_l0;
  b.dTendon[at(MuscleQuantity::pennation)] = tendon_w * w_pennation;
  b.dTendon[at(MuscleQuantity::tendonSlackLength)] = -perStrain * (strain + 1);
  b.dTendon[at(MuscleQuantity::tendonStrainScale)] = -b.tendonSlope * strain;

  // fibre: f_l(l) and f_PE(l), l = ℓ/ℓ0
  const double l = fibreLength * muscle.perFibre();
  const double l_l0 = -l * muscle.perFibre();
  double passive = 0, passiveSlope = 0;
  if (curves.passiveForce) {
    const CurveValue y = curves.passiveForce->evaluate(l, last.passiveForce);
    passive = y.value;
    passiveSlope = y.slope;
  } else {
    passive = std::exp(8 * l - 12);
    passiveSlope = 8 * passive;
  }
  const CurveValue active = curves.activeForce.evaluate(l, last.activeForce);
  const double floor = muscle.options().activationFloor;
  const bool floored = activation < floor;
  const double act = floored ? floor : activation;
  if (!(active.value < 0)) {
    b.A = act * active.value;
    b.A_act = floored ? 0 : active.value;
    b.A_l = act * active.slope * muscle.perFibre();
    b.dA[at(MuscleQuantity::optimalFibreLength)] = act * active.slope * l_l0;
    b.dA[at(MuscleQuantity::activeForceScale)] = b.A;
    b.dA[at(MuscleQuantity::activeForceWidth)] = -act * active.slope * (l - 1);
  }

  // P = F̂_T κ − f_PE, held at 0 where it is clamped
  b.P = b.tendon * kappa - passive;
  if (muscle.options().clampForce && b.P < 0) {
    b.P = 0;
    b.clamped = true;
    return b;
  }
  for (std::size_t i = 0; i < numFibreQuantities; ++i) b.dP[i] = b.dTendon[i] * kappa;
  b.dP[at(MuscleQuantity::optimalFibreLength)] += b.tendon * kappa_w * w_l0 - passiveSlope * l_l0;
  b.dP[at(MuscleQuantity::pennation)] += b.tendon * kappa_w * w_pennation;
  b.dP[at(MuscleQuantity::passiveForceScale)] -= passive;
  b.P_m = perStrain * kappa;
  b.P_l = -perStrain * kappa * kappa + b.tendon * kappa_l - passiveSlope * muscle.perFibre();
  return b;
}

/// v(P, A, B) and its slopes, from the quadratic G(v; P, A, B) = 0 of its regime.
struct VelocityGradient {
  double v, v_P, v_A, v_B;
};

VelocityGradient velocityOf(double P, double A, double B) {
  using schutte::maxLengtheningForce;
  using schutte::shapeLengthening;
  using schutte::shapeShortening;
  if (P < -B) return {P / B, 1 / B, 0, -P / (B * B)};
  const double v = schutte::velocityFromForce(P, A, B);
  if (P < A) {
    const double b = P + shapeShortening * (A + B);
    const double perRoot = 1 / std::sqrt(b * b - 4 * B * shapeShortening * (P - A));
    return {v, (shapeShortening - v) * perRoot, -shapeShortening * (1 + v) * perRoot,
            (v - shapeShortening) * v * perRoot};
  }
  const double b = P - maxLengtheningForce * A - shapeLengthening * B;
  const double perRoot = 1 / std::sqrt(b * b + 4 * B * shapeLengthening * (P - A));
  return {v, (v + shapeLengthening) * perRoot,
          -(maxLengtheningForce * v + shapeLengthening) * perRoot,
          -(v + shapeLengthening) * v * perRoot};
}

}  // namespace

FibreParameterDerivatives fibreParameterDerivatives(const SchutteMuscle<double>& muscle,
                                                    double activation, double fibreLength,
                                                    double muscleTendonLength) {
  SchuttePieces last;
  return fibreParameterDerivatives(muscle, activation, fibreLength, muscleTendonLength, last);
}

FibreParameterDerivatives fibreParameterDerivatives(const SchutteMuscle<double>& muscle,
                                                    double activation, double fibreLength,
                                                    double muscleTendonLength,
                                                    SchuttePieces& last) {
  const SchutteQuantities<double>& p = muscle.quantities();
  const Balance b = balanceOf(muscle, activation, fibreLength, muscleTendonLength, last);
  const VelocityGradient u = velocityOf(b.P, b.A, p.damping);
  const double speed = muscle.speedScale();
  FibreParameterDerivatives result;
  for (std::size_t i = 0; i < numFibreQuantities; ++i) {
    result.dV[i] = speed * (u.v_P * b.dP[i] + u.v_A * b.dA[i]);
    result.dF[i] = p.maxIsometricForce * b.dTendon[i];
  }
  result.dV[at(MuscleQuantity::optimalFibreLength)] += u.v / p.timeScale;
  result.dV[at(MuscleQuantity::timeScale)] -= speed / p.timeScale * u.v;
  result.dV[at(MuscleQuantity::damping)] += speed * u.v_B;
  result.dF[at(MuscleQuantity::maxIsometricForce)] += b.tendon;
  return result;
}

EquilibriumDerivatives equilibriumDerivatives(const SchutteMuscle<double>& muscle,
                                              double activation, double muscleTendonLength,
                                              const StaticEquilibrium& rest) {
  EquilibriumDerivatives result{};
  const SchutteQuantities<double>& p = muscle.quantities();
  const bool isSlack = rest.why == StaticEquilibrium::Why::forceFree ||
                       rest.tendonForce < 1e-9 * p.maxIsometricForce;
  if (isSlack) {
    const double l = rest.fibreLength;
    const double along = (muscleTendonLength - p.tendonSlackLength) / l;
    const double across = muscle.thickness() / l;
    result.dl_dMuscleTendonLength = along;
    result.dl_dQuantity[at(MuscleQuantity::tendonSlackLength)] = -along;
    result.dl_dQuantity[at(MuscleQuantity::optimalFibreLength)] = across * std::sin(p.pennation);
    result.dl_dQuantity[at(MuscleQuantity::pennation)] =
        across * p.optimalFibreLength * std::cos(p.pennation);
    return result;
  }
  SchuttePieces last;
  const Balance b = balanceOf(muscle, activation, rest.fibreLength, muscleTendonLength, last);
  const double perSlope = -1 / (b.P_l - b.A_l);
  result.dl_dActivation = -b.A_act * perSlope;
  result.dl_dMuscleTendonLength = b.P_m * perSlope;
  for (std::size_t i = 0; i < numFibreQuantities; ++i) {
    result.dl_dQuantity[i] = (b.dP[i] - b.dA[i]) * perSlope;
  }
  return result;
}

SplineFunction schutteTendonCurve() {
  return {{-10, -0.002, -0.001, 0, 0.00131, 0.00281, 0.00431, 0.00581, 0.00731, 0.00881, 0.0103,
           0.0118, 0.0123, 9.2, 9.201, 9.202, 20},
          {0, 0, 0, 0, 0.0108, 0.0257, 0.0435, 0.0652, 0.0915, 0.123, 0.161, 0.208, 0.227, 345, 345,
           345, 345}};
}

SplineFunction schutteActiveCurve() {
  return {{-5.307692, -4.307692, -1.923077, -0.884615, -0.269231, 0.230769, 0.461538,
           0.52725,   0.62875,   0.71875,   0.86125,   1.045,     1.2175,   1.43875,
           1.5,       1.615385,  2,         2.961538,  3.692308,  5.461538, 9.901902},
          {0.012188, 0.021899, 0.036466, 0.052493, 0.075312, 0.114158, 0.157859,
           0.226667, 0.636667, 0.856667, 0.95,     0.993333, 0.77,     0.246667,
           0.193821, 0.133252, 0.072683, 0.044417, 0.036341, 0.021899, 0.007332}};
}

}  // namespace bio
