#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "info/estimation/least_squares.h"

/// Models whose outputs, sensitivities and curvatures are written out by hand.
namespace support {

/// y_k = a + b·t_k, θ = (a, b): linear, so that every estimator is exact in one step.
inline info::Predictor straightLine(const Eigen::VectorXd& t) {
  info::Predictor line;
  line.outputs = [t](const Eigen::VectorXd& theta) -> Eigen::MatrixXd {
    return (theta[0] + theta[1] * t.array()).matrix().transpose();
  };
  line.withSensitivities = [t, line](const Eigen::VectorXd& theta) {
    Eigen::MatrixXd gamma(t.size(), 2);
    gamma << Eigen::VectorXd::Ones(t.size()), t;
    return info::Prediction{line.outputs(theta), gamma};
  };
  line.contractedCurvature = [](const Eigen::VectorXd&, const Eigen::MatrixXd&) -> Eigen::MatrixXd {
    return Eigen::Matrix2d::Zero();
  };
  return line;
}

/// The damped oscillation x(t) = e^(−ct) cos ωt measured at times t; θ = (c, ω).
struct DampedOscillation {
  Eigen::VectorXd t;

  /// Position, and its derivatives by (c, ω) to second order in closed form.
  static double x(double t, double c, double w) { return std::exp(-c * t) * std::cos(w * t); }

  info::Predictor predictor() const {
    info::Predictor model;
    const Eigen::VectorXd times = t;
    model.outputs = [times](const Eigen::VectorXd& theta) -> Eigen::MatrixXd {
      return times.unaryExpr([&](double s) { return x(s, theta[0], theta[1]); }).transpose();
    };
    model.withSensitivities = [times, outputs = model.outputs](const Eigen::VectorXd& theta) {
      Eigen::MatrixXd gamma(times.size(), 2);
      for (Eigen::Index k = 0; k < times.size(); ++k) {
        const double s = times[k], decay = std::exp(-theta[0] * s);
        gamma.row(k) << -s * decay * std::cos(theta[1] * s), -s * decay * std::sin(theta[1] * s);
      }
      return info::Prediction{outputs(theta), gamma};
    };
    model.contractedCurvature = [times](const Eigen::VectorXd& theta,
                                        const Eigen::MatrixXd& w) -> Eigen::MatrixXd {
      Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
      for (Eigen::Index k = 0; k < times.size(); ++k) {
        const double s = times[k], decay = s * s * std::exp(-theta[0] * s);
        const double cosine = decay * std::cos(theta[1] * s), sine = decay * std::sin(theta[1] * s);
        Eigen::Matrix2d hessian;
        hessian << cosine, sine, sine, -cosine;
        sum += w(0, k) * hessian;
      }
      return sum;
    };
    return model;
  }
};

}  // namespace support
