#pragma once

#include <Eigen/Dense>
#include <optional>
#include <vector>

#include "info/estimation/least_squares.h"
#include "namespace.h"

namespace python {

/// A system that a Python function defines, ẋ = f(x, u, θ, t), y = g(x, u, θ), sampled at times:
/// what info::LeastSquares asks of an experiment.
///
/// Steps are classical Runge–Kutta, `substeps` between two times, u linear between them. Where the
/// derivatives f_x, f_theta, g_x and g_theta are given, (x, ψ = dx/dθ) is stepped together,
///     ψ̇ = f_x ψ + f_θ
/// which differentiates the steps exactly; else Γ is a central difference of whole motions, to
/// about 1e-9 of its size. Called with the interpreter's lock held.
class PythonSystem {
 public:
  struct Derivatives {
    py::object f_x = py::none(), f_theta = py::none(), g_x = py::none(), g_theta = py::none();
  };
  /// @param g       None: y = x
  /// @param inputs  times × inputs; no columns: u is empty
  /// @throws std::invalid_argument times that do not rise, sizes, f_x without f_theta
  PythonSystem(py::object f, Eigen::VectorXd x0, Eigen::VectorXd times, Eigen::MatrixXd inputs,
               py::object g, Derivatives derivatives, int substeps);

  /// y: samples × outputs
  Eigen::MatrixXd outputs(const Eigen::VectorXd& theta) const;
  /// y and Γ = dy/dθ, (samples·outputs) × parameters
  std::pair<Eigen::MatrixXd, Eigen::MatrixXd> withSensitivities(const Eigen::VectorXd& theta) const;
  bool hasDerivatives() const { return !derivatives_.f_x.is_none(); }
  const Eigen::VectorXd& times() const { return times_; }

 private:
  struct State {
    Eigen::VectorXd x;
    Eigen::MatrixXd psi;  ///< no columns: not wanted
  };
  State rate(const State& state, const Eigen::VectorXd& u, const Eigen::VectorXd& theta,
             double t) const;
  State stepped(const State& state, Eigen::Index k, int substep,
                const Eigen::VectorXd& theta) const;
  Eigen::VectorXd outputOf(const State& state, Eigen::Index k, const Eigen::VectorXd& theta) const;

  py::object f_, g_;
  Derivatives derivatives_;
  Eigen::VectorXd x0_, times_;
  Eigen::MatrixXd inputs_;
  int substeps_;
};

/// A number, a vector (one row per sample), or samples × outputs.
/// @param what the argument, for messages
/// @throws std::invalid_argument for more dimensions, and what numbersOf throws
Eigen::MatrixXd samplesOf(const py::object& values, const std::string& what);

/// y: samples × outputs, as Python functions of θ, for estimation: `sensitivities` gives Γ, else
/// central differences do.
info::Predictor predictorOf(const py::object& outputs, const py::object& sensitivities);

/// dy/dθ of a function with values samples × outputs, stacked sample by sample, by central
/// differences with steps of 6e-6·max(1, |θ|).
Eigen::MatrixXd differenced(const std::function<Eigen::MatrixXd(const Eigen::VectorXd&)>& outputs,
                            const Eigen::VectorXd& theta);

void defineEstimation(py::module_& module);
void defineSystem(py::module_& module);

}  // namespace python
