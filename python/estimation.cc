#include <fmt/format.h>

#include "arguments/columns.h"
#include "docstrings.h"
#include "info/estimation/estimate.h"
#include "info/information/fisher.h"
#include "info/information/identifiability.h"
#include "python_system.h"

namespace python {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A standard deviation, one for each output, or a covariance matrix of the outputs.
info::OutputCovariance covarianceOf(const py::object& noise, Eigen::Index outputs) {
  const Numbers array = numbersOf(noise, "noise");
  if (array.ndim() > 2) {
    throw std::invalid_argument(fmt::format(
        "noise: {} dimensions, must be one number, one for each output, or outputs x outputs",
        array.ndim()));
  }
  if (array.ndim() == 2) return info::OutputCovariance(array.cast<MatrixXd>());
  const VectorXd given = Eigen::Map<const VectorXd>(array.data(), array.size());
  const VectorXd sd = given.size() == 1 ? VectorXd::Constant(outputs, given[0]) : given;
  if (!(sd.array() > 0).all()) {
    throw std::invalid_argument("noise: standard deviations must be > 0");
  }
  return info::OutputCovariance(MatrixXd(sd.array().square().matrix().asDiagonal()));
}

std::vector<std::string> namesFor(const std::vector<std::string>& given, Eigen::Index count) {
  if (!given.empty() && static_cast<Eigen::Index>(given.size()) != count) {
    throw std::invalid_argument(
        fmt::format("names: {}, must be {}, one for each parameter", given.size(), count));
  }
  std::vector<std::string> names = given;
  for (Eigen::Index i = 0; given.empty() && i < count; ++i) names.push_back(fmt::format("θ{}", i));
  return names;
}

std::vector<info::Parameter> parametersOf(const VectorXd& start,
                                          const std::vector<std::string>& names,
                                          const Pairs& bounds, const Pairs& prior) {
  std::vector<info::Parameter> parameters;
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    info::Parameter parameter{.name = names[static_cast<std::size_t>(i)], .start = start[i]};
    if (const auto found = bounds.find(parameter.name); found != bounds.end()) {
      std::tie(parameter.lower, parameter.upper) = found->second;
    }
    if (const auto found = prior.find(parameter.name); found != prior.end()) {
      parameter.prior = info::GaussianPrior{found->second.first, found->second.second};
    }
    parameters.push_back(std::move(parameter));
  }
  for (const auto* named : {&bounds, &prior}) {
    for (const auto& [name, values] : *named) {
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        throw std::invalid_argument(fmt::format("'{}' must be a parameter", name));
      }
    }
  }
  return parameters;
}

info::Method methodOf(const std::string& name) {
  static const std::map<std::string, info::Method> methods = {
      {"levenberg-marquardt", info::Method::levenbergMarquardt},
      {"gauss-newton", info::Method::iteratedLeastSquares},
      {"gradient-descent", info::Method::gradientDescent}};
  const auto found = methods.find(name);
  if (found != methods.end()) return found->second;
  throw std::invalid_argument(fmt::format(
      "method '{}', must be levenberg-marquardt, gauss-newton or gradient-descent", name));
}

MatrixXd fisherInformation(const py::object& gamma, const py::object& noise, Eigen::Index outputs) {
  const Numbers array = numbersOf(gamma, "gamma");
  if (array.ndim() != 2 && array.ndim() != 3) {
    throw std::invalid_argument(fmt::format(
        "gamma: {} dimensions, must be (samples * outputs) x parameters or samples x outputs x "
        "parameters",
        array.ndim()));
  }
  const bool isStacked = array.ndim() == 2;
  const Eigen::Index h = isStacked ? outputs : array.shape(1);
  const Eigen::Index parameters = array.shape(array.ndim() - 1);
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const MatrixXd stacked = Eigen::Map<const RowMajor>(
      array.data(), isStacked ? array.shape(0) : array.shape(0) * h, parameters);
  return info::fisherInformation(stacked, covarianceOf(noise, h));
}

py::object estimate(const py::object& predict, const py::object& measured, const py::object& noise,
                    const VectorXd& start, const std::vector<std::string>& names,
                    py::object sensitivities, const Pairs& bounds, const Pairs& prior,
                    const std::string& method, int iterations, double confidence) {
  if (sensitivities.is_none() && py::hasattr(predict, "sensitivities")) {
    sensitivities = predict.attr("sensitivities");
  }
  const info::Predictor predictor = predictorOf(predict, sensitivities);
  const MatrixXd outputs = samplesOf(measured, "measured").transpose();
  info::Measurements measurements{outputs, covarianceOf(noise, outputs.rows()),
                                  info::observedWhereNotNaN(outputs)};
  info::EstimateOptions options;
  options.method = methodOf(method);
  options.maxIterations = iterations;
  options.confidence = confidence;
  const auto allNames = namesFor(names, start.size());
  const info::Estimate found = info::estimate(
      info::LeastSquares(predictor, measurements, parametersOf(start, allNames, bounds, prior)),
      options);
  return tableResult("EstimateResult", "parameters"_a = found.parameters, "names"_a = allNames,
                     "converged"_a = found.converged, "why"_a = info::describe(found.why),
                     "cost"_a = found.cost, "iterations"_a = found.iterations,
                     "evaluations"_a = found.evaluations, "information"_a = found.information,
                     "covariance"_a = found.covariance,
                     "sd"_a = found.covariance.diagonal().cwiseSqrt().eval(),
                     "intervals"_a = MatrixXd(found.intervals), "at_bound"_a = found.atBound,
                     "reduced_chi_square"_a = found.reducedChiSquare);
}

MatrixXd cramerRaoBound(const MatrixXd& information, const std::vector<std::string>& names) {
  return info::cramerRaoBound(information, namesFor(names, information.rows()));
}

py::object identifiability(const MatrixXd& information, const VectorXd& values,
                           const std::vector<std::string>& names) {
  const auto allNames = namesFor(names, values.size());
  const auto report =
      info::identifiability(information, parametersOf(values, allNames, {}, {}),
                            (values.array() == 0).any() ? info::ParameterScale::linear
                                                        : info::ParameterScale::logarithmic);
  return tableResult("IdentifiabilityResult", "names"_a = allNames, "values"_a = values,
                     "rank"_a = report.rank, "sentences"_a = report.sentences, "sd"_a = report.sd,
                     "correlation"_a = report.correlation, "determined"_a = report.determined);
}

}  // namespace

void defineEstimation(py::module_& module) {
  const std::vector<std::string> unnamed;
  module.def("fisher_information", &fisherInformation, "gamma"_a, "noise"_a, py::kw_only(),
             "outputs"_a = 1, docstrings::fisher_information);
  module.def("cramer_rao_bound", &cramerRaoBound, "information"_a, "names"_a = unnamed,
             docstrings::cramer_rao_bound);
  module.def("identifiability", &identifiability, "information"_a, "values"_a, "names"_a = unnamed,
             docstrings::identifiability);
  module.def("estimate", &estimate, "predict"_a, "measured"_a, "noise"_a, "start"_a, py::kw_only(),
             "names"_a = unnamed, "sensitivities"_a = py::none(), "bounds"_a = Pairs(),
             "prior"_a = Pairs(), "method"_a = "levenberg-marquardt", "iterations"_a = 100,
             "confidence"_a = 0.95, docstrings::estimate);
}

}  // namespace python
