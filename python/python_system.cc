#include "python_system.h"

#include <fmt/format.h>

#include "arguments/columns.h"
#include "docstrings.h"
#include "info/autodiff/derivatives.h"

namespace python {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Γ as (samples·outputs) × parameters, or samples × outputs × parameters.
MatrixXd gammaOf(const py::object& values, Eigen::Index rows, Eigen::Index parameters) {
  const Numbers array = numbersOf(values, "sensitivities");
  if (array.size() != rows * parameters ||
      (array.ndim() > 1 && array.shape(array.ndim() - 1) != parameters)) {
    throw std::invalid_argument(
        fmt::format("sensitivities: {} numbers, must be {} outputs of all samples x {} parameters",
                    array.size(), rows, parameters));
  }
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(array.data(), rows, parameters);
}

VectorXd vectorFrom(const char* what, const py::object& value, Eigen::Index size) {
  const MatrixXd all = samplesOf(value, what);
  if (all.size() != size || (all.rows() != 1 && all.cols() != 1)) {
    throw std::invalid_argument(
        fmt::format("{}: {} x {} numbers, must be {}", what, all.rows(), all.cols(), size));
  }
  return Eigen::Map<const VectorXd>(all.data(), size);
}

MatrixXd matrixFrom(const char* what, const py::object& value, Eigen::Index rows,
                    Eigen::Index columns) {
  const MatrixXd all = samplesOf(value, what);
  if (all.rows() != rows || all.cols() != columns) {
    throw std::invalid_argument(fmt::format("{}: {} x {} numbers, must be {} x {}", what,
                                            all.rows(), all.cols(), rows, columns));
  }
  return all;
}

VectorXd stack(const MatrixXd& samples) {
  const MatrixXd columns = samples.transpose();
  return Eigen::Map<const VectorXd>(columns.data(), columns.size());
}

}  // namespace

MatrixXd samplesOf(const py::object& values, const std::string& what) {
  const Numbers array = numbersOf(values, what);
  if (array.ndim() > 2) {
    throw std::invalid_argument(fmt::format(
        "{}: {} dimensions, must be samples, or samples x outputs", what, array.ndim()));
  }
  const Eigen::Index rows = array.ndim() == 0 ? 1 : array.shape(0);
  const Eigen::Index columns = array.ndim() == 2 ? array.shape(1) : 1;
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(array.data(), rows, columns);
}

PythonSystem::PythonSystem(py::object f, VectorXd x0, VectorXd times, MatrixXd inputs, py::object g,
                           Derivatives derivatives, int substeps)
    : f_(std::move(f)),
      g_(std::move(g)),
      derivatives_(std::move(derivatives)),
      x0_(std::move(x0)),
      times_(std::move(times)),
      inputs_(std::move(inputs)),
      substeps_(substeps) {
  if (times_.size() == 0) throw std::invalid_argument("times: empty, must have at least one");
  for (Eigen::Index k = 1; k < times_.size(); ++k) {
    if (times_[k] > times_[k - 1]) continue;
    throw std::invalid_argument(
        fmt::format("times: {} s after {} s, must rise", times_[k], times_[k - 1]));
  }
  if (inputs_.size() == 0) inputs_.resize(times_.size(), 0);
  if (inputs_.rows() != times_.size()) {
    throw std::invalid_argument(fmt::format("inputs: {} rows, must be {}, one for each time",
                                            inputs_.rows(), times_.size()));
  }
  if (substeps_ < 1) {
    throw std::invalid_argument(fmt::format("substeps = {}, must be >= 1", substeps_));
  }
  const Derivatives& d = derivatives_;
  if (d.f_x.is_none() != d.f_theta.is_none()) {
    throw std::invalid_argument("f_x and f_theta require each other");
  }
  if (!g_.is_none() && !d.f_x.is_none() && (d.g_x.is_none() || d.g_theta.is_none())) {
    throw std::invalid_argument("f_x and f_theta with an output g require g_x and g_theta as well");
  }
}

PythonSystem::State PythonSystem::rate(const State& state, const VectorXd& u, const VectorXd& theta,
                                       double t) const {
  const Eigen::Index n = x0_.size(), p = state.psi.cols();
  State rate{vectorFrom("f", f_(state.x, u, theta, t), n), MatrixXd(n, p)};
  if (p > 0) {
    const MatrixXd f_x = matrixFrom("f_x", derivatives_.f_x(state.x, u, theta, t), n, n);
    rate.psi =
        f_x * state.psi + matrixFrom("f_theta", derivatives_.f_theta(state.x, u, theta, t), n, p);
  }
  return rate;
}

PythonSystem::State PythonSystem::stepped(const State& state, Eigen::Index k, int substep,
                                          const VectorXd& theta) const {
  const double whole = times_[k + 1] - times_[k], h = whole / substeps_;
  const auto inputAt = [&](double share) -> VectorXd {
    const double w = (substep + share) / substeps_;
    return (1 - w) * inputs_.row(k) + w * inputs_.row(k + 1);
  };
  const double t = times_[k] + substep * h;
  const auto moved = [&](const State& slope, double length) -> State {
    return {state.x + length * slope.x, state.psi + length * slope.psi};
  };
  const VectorXd middle = inputAt(0.5);
  const State k1 = rate(state, inputAt(0), theta, t);
  const State k2 = rate(moved(k1, h / 2), middle, theta, t + h / 2);
  const State k3 = rate(moved(k2, h / 2), middle, theta, t + h / 2);
  const State k4 = rate(moved(k3, h), inputAt(1), theta, t + h);
  return {state.x + h / 6 * (k1.x + 2 * k2.x + 2 * k3.x + k4.x),
          state.psi + h / 6 * (k1.psi + 2 * k2.psi + 2 * k3.psi + k4.psi)};
}

VectorXd PythonSystem::outputOf(const State& state, Eigen::Index k, const VectorXd& theta) const {
  if (g_.is_none()) return state.x;
  return stack(samplesOf(g_(state.x, VectorXd(inputs_.row(k)), theta), "g"));
}

MatrixXd PythonSystem::outputs(const VectorXd& theta) const {
  State state{x0_, MatrixXd(x0_.size(), 0)};
  MatrixXd y;
  for (Eigen::Index k = 0; k < times_.size(); ++k) {
    const VectorXd output = outputOf(state, k, theta);
    if (k == 0) y.resize(times_.size(), output.size());
    if (output.size() != y.cols()) {
      throw std::invalid_argument(
          fmt::format("g: {} outputs, must be {} as in the first call", output.size(), y.cols()));
    }
    y.row(k) = output;
    for (int s = 0; k + 1 < times_.size() && s < substeps_; ++s) {
      state = stepped(state, k, s, theta);
    }
  }
  return y;
}

std::pair<MatrixXd, MatrixXd> PythonSystem::withSensitivities(const VectorXd& theta) const {
  if (!hasDerivatives()) {
    return {outputs(theta), differenced([this](const VectorXd& at) { return outputs(at); }, theta)};
  }
  const Eigen::Index n = x0_.size(), p = theta.size();
  State state{x0_, MatrixXd::Zero(n, p)};
  MatrixXd y, gamma;
  for (Eigen::Index k = 0; k < times_.size(); ++k) {
    const VectorXd output = outputOf(state, k, theta), u = inputs_.row(k);
    const Eigen::Index outputs = output.size();
    if (k == 0) {
      y.resize(times_.size(), outputs);
      gamma.resize(times_.size() * outputs, p);
    }
    y.row(k) = output;
    auto rows = gamma.middleRows(k * outputs, outputs);
    if (g_.is_none()) {
      rows = state.psi;
    } else {
      rows = matrixFrom("g_x", derivatives_.g_x(state.x, u, theta), outputs, n) * state.psi +
             matrixFrom("g_theta", derivatives_.g_theta(state.x, u, theta), outputs, p);
    }
    for (int s = 0; k + 1 < times_.size() && s < substeps_; ++s) {
      state = stepped(state, k, s, theta);
    }
  }
  return {y, gamma};
}

MatrixXd differenced(const std::function<MatrixXd(const VectorXd&)>& outputs,
                     const VectorXd& theta) {
  return info::finiteDifferenceJacobian(
      [&](const VectorXd& at) -> VectorXd { return stack(outputs(at)); }, VectorXd(theta));
}

info::Predictor predictorOf(const py::object& outputs, const py::object& sensitivities) {
  const auto samples = [outputs](const VectorXd& theta) {
    return samplesOf(outputs(theta), "outputs");
  };
  info::Predictor predictor;
  predictor.outputs = [samples](const VectorXd& theta) -> MatrixXd {
    return samples(theta).transpose();
  };
  predictor.withSensitivities = [samples, sensitivities](const VectorXd& theta) {
    info::Prediction prediction{samples(theta).transpose(), {}};
    prediction.gamma = sensitivities.is_none()
                           ? differenced(samples, theta)
                           : gammaOf(sensitivities(theta), prediction.outputs.size(), theta.size());
    return prediction;
  };
  return predictor;
}

void defineSystem(py::module_& module) {
  py::class_<PythonSystem> system(module, "System", docstrings::System);
  system.attr("__module__") = packageName;
  system
      .def(py::init([](py::object f, const VectorXd& x0, const VectorXd& times,
                       const py::object& inputs, py::object g, py::object f_x, py::object f_theta,
                       py::object g_x, py::object g_theta, int substeps) {
             return PythonSystem(
                 std::move(f), x0, times,
                 inputs.is_none() ? MatrixXd() : samplesOf(inputs, "inputs"), std::move(g),
                 {std::move(f_x), std::move(f_theta), std::move(g_x), std::move(g_theta)},
                 substeps);
           }),
           "f"_a, "x0"_a, "times"_a, py::kw_only(), "inputs"_a = py::none(), "g"_a = py::none(),
           "f_x"_a = py::none(), "f_theta"_a = py::none(), "g_x"_a = py::none(),
           "g_theta"_a = py::none(), "substeps"_a = 1)
      .def("__call__", &PythonSystem::outputs, "theta"_a, docstrings::System_call)
      .def(
          "sensitivities",
          [](const PythonSystem& s, const VectorXd& theta) {
            return s.withSensitivities(theta).second;
          },
          "theta"_a, docstrings::System_sensitivities)
      .def_property_readonly("times", &PythonSystem::times, docstrings::System_times);
}

}  // namespace python
