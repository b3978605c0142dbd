#pragma once

#include <Eigen/Dense>
#include <functional>
#include <string>
#include <vector>

#include "info/estimation/robust_loss.h"
#include "info/information/output_covariance.h"
#include "info/information/parameter.h"

namespace info {

/// Predicted outputs of a model and their sensitivities to the parameters.
struct Prediction {
  Eigen::MatrixXd outputs;  ///< y: outputs × samples
  Eigen::MatrixXd
      gamma;  ///< Γ = dy/dθ stacked: rows k·h … k·h+h−1 belong to sample k, one column per θ
};

/// A model of an experiment for estimators: parameters in, samples out.
///
/// Contract: pure, i.e. equal θ give equal results, from any thread, in any order. If θ is outside
/// the model's domain, the outputs are not finite; estimators then take a shorter step.
struct Predictor {
  /// y(θ): outputs × samples
  std::function<Eigen::MatrixXd(const Eigen::VectorXd& theta)> outputs;
  /// y(θ) and Γ(θ)
  std::function<Prediction(const Eigen::VectorXd& theta)> withSensitivities;
  /// Σ_k Σ_i w_ik d²y_ik/dθ² [p × p]; w is outputs × samples. May be empty; Newton–Raphson is then
  /// unavailable.
  std::function<Eigen::MatrixXd(const Eigen::VectorXd& theta, const Eigen::MatrixXd& w)>
      contractedCurvature;
  /// In words, why outputs(θ) is not finite; empty if it is. May be empty.
  std::function<std::string(const Eigen::VectorXd& theta)> whyUndefined;
};

/// The measurements.
struct Measurements {
  Eigen::MatrixXd outputs;        ///< ỹ: outputs × samples
  OutputCovariance covariance;    ///< covariance of their noise
  ObservationMask observed = {};  ///< false: not measured, the entry of `outputs` is not read
  RobustLoss loss = {};           ///< cost of a residual; gaussian: least squares
};

/// The weighted least-squares cost of a model against data, with Gaussian priors,
///     β(θ) = ½ Σ_k r_kᵀΣ_k⁻¹r_k + ½ Σ_i (θ_i − μ_i)²/σ_i²,      r_k = ỹ_k − y_k(θ)
/// the negative log posterior up to a constant. Wilson's thesis (2.4), there without priors, with
///     dβ/dθ = −Σ_k Γ_kᵀΣ_k⁻¹r_k + (θ − μ)/σ²          (2.5), printed there without the minus
///     d²β/dθ² = Σ_k Γ_kᵀΣ_k⁻¹Γ_k − Σ_k r_kᵀΣ_k⁻¹ d²y_k/dθ² + 1/σ²                     (2.9)
///
/// With a robust loss ½r_kᵀΣ_k⁻¹r_k becomes ½ρ(r_kᵀΣ_k⁻¹r_k), and in gradient and information each
/// sample carries the weight ρ′ (iteratively reweighted least squares).
///
/// Immutable; may be used from several threads at once if the predictor may.
class LeastSquares {
 public:
  /// @throws std::invalid_argument if a parameter breaks a rule of checkParameters, or shapes do
  /// not fit
  /// @throws std::domain_error if an observed datum is not finite; the message names output and
  /// sample
  LeastSquares(Predictor predictor, Measurements measurements, std::vector<Parameter> parameters);

  const std::vector<Parameter>& parameters() const { return parameters_; }
  const Measurements& measurements() const { return measurements_; }
  const Predictor& predictor() const { return predictor_; }
  /// Second derivatives are available for ordinary least squares only.
  bool hasCurvature() const {
    return predictor_.contractedCurvature && measurements_.loss.kind == RobustLoss::Kind::gaussian;
  }
  /// Start values of the parameters.
  Eigen::VectorXd start() const;
  /// Number of measured values.
  Eigen::Index observations() const;

  struct Linearised {
    double cost;               ///< β; not finite if the model is undefined
    Eigen::VectorXd gradient;  ///< dβ/dθ
    Eigen::MatrixXd information;  ///< Σρ′ΓᵀΣ⁻¹Γ + 1/σ², the Gauss–Newton Hessian (2.10)
    Eigen::MatrixXd residuals;  ///< ỹ − y: outputs × samples, 0 where not observed
  };

  /// β(θ); +∞ if the prediction is not finite.
  double cost(const Eigen::VectorXd& theta) const;
  Linearised linearise(const Eigen::VectorXd& theta) const;
  /// d²β/dθ², exact. @throws std::logic_error if the predictor has no curvature
  Eigen::MatrixXd hessian(const Eigen::VectorXd& theta, const Linearised& at) const;

 private:
  void requireSize(const Eigen::VectorXd& theta) const;
  Eigen::MatrixXd residuals(const Eigen::MatrixXd& outputs) const;

  Predictor predictor_;
  Measurements measurements_;
  std::vector<Parameter> parameters_;
};

}  // namespace info
