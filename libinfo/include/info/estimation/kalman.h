#pragma once

#include <Eigen/Dense>
#include <functional>
#include <vector>

#include "info/information/output_covariance.h"

namespace info {

/// A normally distributed random vector.
struct Gaussian {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

/// The linear minimum mean-square error estimate of x from y,
///     x̂ = x̄ + Σ_xy Σ_y⁻¹ (y − ȳ)            (2.12)
///     Σ_x|y = Σ_x − Σ_xy Σ_y⁻¹ Σ_yx          (2.13)
/// the conditional mean if x and y are jointly Gaussian, the best linear estimate in any case.
/// @throws std::invalid_argument if shapes do not fit; std::domain_error if Σ_y is no covariance
Gaussian minimumMeanSquareEstimate(const Gaussian& x, const Eigen::MatrixXd& covariance_xy,
                                   const Gaussian& y, const Eigen::VectorXd& measured);

/// A function's value and Jacobian at a point.
struct LinearisedMap {
  Eigen::VectorXd value;
  Eigen::MatrixXd jacobian;
};

/// A discrete system with noise,
///     x_{k+1} = Φ_k(x_k) + v_k,  v_k ~ N(0, Q_k);      y_k = h_k(x_k) + w_k,  w_k ~ N(0, R_k)
/// Inputs and parameters are inside Φ and h. All functions are pure.
struct NoisySystem {
  std::function<LinearisedMap(Eigen::Index k, const Eigen::VectorXd& x)> step;    ///< Φ_k and F_k
  std::function<LinearisedMap(Eigen::Index k, const Eigen::VectorXd& x)> output;  ///< h_k and H_k
  std::function<Eigen::MatrixXd(Eigen::Index k)> processNoise;  ///< Q_k, positive semidefinite
  OutputCovariance outputNoise;                                 ///< R_k
};

/// The result of a filter after the samples 0 … k.
struct FilterStep {
  Gaussian predicted;                    ///< x_k given y_0 … y_{k−1}
  Gaussian filtered;                     ///< x_k given y_0 … y_k
  Eigen::MatrixXd transition;            ///< F_{k−1}, from the previous sample; empty at k = 0
  Eigen::VectorXd innovation;            ///< of the outputs observed: y_k − h_k(predicted mean)
  Eigen::MatrixXd innovationCovariance;  ///< S_k = H P Hᵀ + R
};

struct FilterResult {
  std::vector<FilterStep> steps;  ///< one per sample
  double logLikelihood = 0;  ///< ln p(y_0 … y_N) = −½ Σ (νᵀS⁻¹ν + ln det S + h ln 2π)
};

/// The measurement update of one sample,
///     K = P Hᵀ S⁻¹,  x̂ = x̄ + K ν                                   (2.15)
///     P⁺ = (I − KH) P (I − KH)ᵀ + K R Kᵀ
/// in Joseph's form, which stays symmetric and positive semidefinite under rounding, unlike P − P
/// Hᵀ S⁻¹ (P Hᵀ)ᵀ of Wilson's thesis. The value is the same.
/// @throws std::invalid_argument if shapes do not fit
FilterStep updateWithMeasurement(const Gaussian& predicted, const LinearisedMap& output,
                                 const Eigen::VectorXd& measured, const Eigen::MatrixXd& noise);

/// The extended Kalman filter: Φ and h linearised at the latest mean. On a linear system it is the
/// Kalman filter (section 2.2.3), exact; elsewhere it is first order in the deviations.
///
/// @param prior x_0 before any measurement
/// @param outputs ỹ: outputs × samples, k = 0 … N
/// @param observed mask of the outputs; gaps are bridged by prediction
/// @throws std::invalid_argument if shapes do not fit; std::domain_error if an observed datum is
/// not finite
///         or the prior's covariance is not positive semidefinite
FilterResult extendedKalmanFilter(const NoisySystem& system, const Gaussian& prior,
                                  const Eigen::MatrixXd& outputs,
                                  const ObservationMask& observed = {});

/// The Rauch–Tung–Striebel smoother: x_k given all samples, from a filter's result, backwards,
///     C = P_k|k F_kᵀ P_{k+1|k}⁻¹,  x̂_k|N = x̂_k|k + C (x̂_{k+1|N} − x̂_{k+1|k})
///     P_k|N = P_k|k + C (P_{k+1|N} − P_{k+1|k}) Cᵀ
/// The inverse is a pseudo-inverse, so that static states without process noise are allowed.
std::vector<Gaussian> smooth(const FilterResult& filtered);

}  // namespace info
