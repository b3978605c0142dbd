#include "bio/analysis/ensemble.h"

#include <fmt/format.h>

#include <algorithm>

#include "bio/analysis/ensemble_statistics.h"
#include "bio/analysis/trial_ensemble.h"
#include "bio/opensim/external_loads.h"
#include "docstrings.h"
#include "info/parallel_for.h"
#include "interruptible.h"
#include "systems.h"

namespace python {
namespace {

/// Names and the covariance of what they name.
using Covariance = std::pair<std::vector<std::string>, Eigen::MatrixXd>;

info::Marginal::Shape shapeOf(const std::string& distribution) {
  if (distribution == "normal") return info::Marginal::Shape::normal;
  if (distribution == "uniform") return info::Marginal::Shape::even;
  throw std::invalid_argument(
      fmt::format("distribution '{}', must be normal or uniform", distribution));
}

/// All runs, as rows.
struct EnsembleRows {
  Eigen::MatrixXd parameters;  ///< runs × parameters
  std::vector<bio::EnsembleRun> runs;
};

EnsembleRows rowsOf(const bio::TrialEnsemble& ensemble, int first, std::uint64_t seed, int threads,
                    const std::atomic<bool>& goOn, std::atomic<double>& done) {
  constexpr int together = 32;
  const auto count = static_cast<int>(ensemble.count());
  EnsembleRows rows;
  rows.parameters.resize(count, std::ssize(ensemble.laws().parameters));
  rows.runs.resize(static_cast<std::size_t>(count));
  std::atomic<int> finished = 0;
  info::parallelFor((count + together - 1) / together, threads, [&](int part) {
    if (!goOn) return;
    std::vector<Eigen::VectorXd> thetas;
    const int begin = part * together;
    for (int i = begin; i < std::min(begin + together, count); ++i) {
      thetas.push_back(
          ensemble.draw(static_cast<std::uint64_t>(first) + static_cast<std::uint64_t>(i), seed));
      rows.parameters.row(i) = thetas.back();
    }
    std::vector<bio::EnsembleRun> runs = ensemble.run(thetas);
    std::move(runs.begin(), runs.end(), rows.runs.begin() + begin);
    done = static_cast<double>(finished += static_cast<int>(runs.size())) / count;
  });
  return rows;
}

py::object spreadOf(const std::vector<double>& values, double nominal) {
  const bio::Spread s = bio::spreadOf(values);
  return results("nominal"_a = nominal, "mean"_a = s.mean, "sd"_a = s.sd, "p5"_a = s.p5,
                 "p50"_a = s.p50, "p95"_a = s.p95);
}

/// Percentiles over the runs at each time.
py::object bandOf(const Eigen::MatrixXd& courses, const bio::ChannelRun& nominal) {
  const Eigen::Index n = courses.cols();
  Eigen::VectorXd mean(n), p5(n), p50(n), p95(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const bio::Spread s = bio::spreadOf({courses.col(k).begin(), courses.col(k).end()});
    mean[k] = s.mean;
    p5[k] = s.p5;
    p50[k] = s.p50;
    p95[k] = s.p95;
  }
  return results("nominal"_a = nominal.atCourse, "mean"_a = mean, "p5"_a = p5, "p50"_a = p50,
                 "p95"_a = p95);
}

py::object sobolOf(const bio::SobolFinding& sobol) {
  const info::SobolResult& indices = sobol.indices;
  return results(
      "first"_a = indices.first, "first_interval"_a = Eigen::MatrixXd(sobol.intervals.first),
      "total"_a = indices.total, "total_interval"_a = Eigen::MatrixXd(sobol.intervals.total),
      "variance"_a = indices.variance, "undefined"_a = indices.undefined);
}

py::list lawsOf(const bio::ParameterLaws& laws) {
  py::list list;
  for (const bio::DrawnParameter& parameter : laws.parameters) {
    list.append(results("name"_a = parameter.name, "unit"_a = parameter.unit,
                        "value"_a = parameter.value, "mean"_a = parameter.law.mean,
                        "sd"_a = parameter.law.sd, "lower"_a = parameter.law.quantile(0),
                        "upper"_a = parameter.law.quantile(1)));
  }
  return list;
}

Eigen::VectorXd arrayOf(const std::vector<double>& values) {
  return Eigen::VectorXd::Map(values.data(), std::ssize(values));
}

/// A number of a channel of each run.
std::vector<double> ofEachRun(const EnsembleRows& rows, std::size_t channel,
                              const bio::EnsembleOutput& output) {
  std::vector<double> values;
  for (const bio::EnsembleRun& run : rows.runs) values.push_back(output.of(run.channels[channel]));
  return values;
}

py::object channelOf(const bio::TrialEnsemble& ensemble, const EnsembleRows& rows,
                     std::size_t channel, const std::vector<bio::SobolFinding>& sobol) {
  const bio::Observable& what = ensemble.channels()[channel].what;
  const bio::ChannelRun& nominal = ensemble.nominal().channels[channel];
  Eigen::MatrixXd courses(std::ssize(rows.runs), std::ssize(ensemble.course()));
  int left = 0;
  for (std::size_t i = 0; i < rows.runs.size(); ++i) {
    const bio::ChannelRun& run = rows.runs[i].channels[channel];
    courses.row(static_cast<Eigen::Index>(i)) = run.atCourse;
    if (!what.isCoordinate()) continue;
    const bio::Coordinate& coordinate = bio::findCoordinate(ensemble.model(), what.object);
    left += bio::leavesRange(coordinate, run.lowest, run.highest) ? 1 : 0;
  }
  py::dict outputs, spreads;
  for (const bio::EnsembleOutput& output : bio::ensembleOutputs()) {
    const std::vector<double> values = ofEachRun(rows, channel, output);
    outputs[output.name.c_str()] = arrayOf(values);
    spreads[output.name.c_str()] = spreadOf(values, output.of(nominal));
  }
  return results("name"_a = bio::nameOf(what), "unit"_a = bio::unitOf(what, ensemble.model()),
                 "outputs"_a = outputs, "spread"_a = spreads, "course"_a = courses,
                 "band"_a = bandOf(courses, nominal),
                 "sobol"_a = sobol.empty() ? py::none() : sobolOf(sobol[channel]),
                 "left_range"_a = left);
}

py::object resultOf(const bio::TrialEnsemble& ensemble, const EnsembleRows& rows,
                    const std::vector<bio::SobolFinding>& sobol) {
  std::vector<std::string> outcomes;
  std::vector<double> failed;
  for (const bio::EnsembleRun& run : rows.runs) {
    outcomes.push_back(run.outcome);
    failed.push_back(run.failedAt);
  }
  py::list channels;
  for (std::size_t c = 0; c < ensemble.channels().size(); ++c) {
    channels.append(channelOf(ensemble, rows, c, sobol));
  }
  const py::object first = channels[0];
  std::vector<std::string> warnings;
  if (!ensemble.nominalRemark().empty()) warnings.push_back(ensemble.nominalRemark());
  return tableResult(
      "EnsembleResult", "coordinate"_a = first.attr("name"), "laws"_a = lawsOf(ensemble.laws()),
      "parameters"_a = rows.parameters, "outcome"_a = outcomes, "failed_at"_a = arrayOf(failed),
      "outputs"_a = first.attr("outputs"), "spread"_a = first.attr("spread"),
      "time"_a = arrayOf(ensemble.course()), "course"_a = first.attr("course"),
      "band"_a = first.attr("band"), "sobol"_a = first.attr("sobol"),
      "left_range"_a = first.attr("left_range"), "channels"_a = channels, "warnings"_a = warnings);
}

py::object ensemble(const bio::Model& model, const bio::Trial& trial,
                    const std::vector<std::string>& parameters, int draws, int first,
                    std::uint64_t seed, const std::string& distribution, double spread,
                    const Pairs& prior, const Pairs& bounds,
                    const std::optional<Covariance>& covariance, bool sobol,
                    const std::string& output, const std::vector<std::string>& observe,
                    int bandPoints, int threads, const std::map<std::string, double>& initial,
                    const py::object& progress, const Names& coordinate,
                    const std::map<std::string, double>& lock, const std::string& integrator,
                    std::optional<double> step) {
  const SystemChoice choice = systemChoice(model, {trial}, coordinate, lock, integrator, step);
  if (first < 0 || (first > 0 && sobol)) {
    throw std::invalid_argument(fmt::format(
        "first = {}, must be ≥ 0, and 0 with sobol, whose runs belong together", first));
  }
  if (threads < 0) throw std::invalid_argument(fmt::format("threads = {}, must be ≥ 0", threads));
  mustBeOfTheModelAsItIs(trial);
  bio::requireLoadsCover(model.externalLoads, trial.times[0], trial.times[0] + trial.duration());
  bio::TrialEnsembleOptions options;
  options.laws = {.names = parameters,
                  .shape = shapeOf(distribution),
                  .spread = spread,
                  .priors = prior,
                  .bounds = bounds};
  if (covariance) options.laws.covariance = {covariance->first, covariance->second};
  options.draws = draws;
  options.sobol = sobol;
  options.output = output;
  options.observe = observe;
  options.bandPoints = bandPoints;
  options.simulation = during(trial, choice.simulation());
  std::unique_ptr<const bio::TrialEnsemble> made;
  EnsembleRows rows;
  std::vector<bio::SobolFinding> indices;
  interruptible({progress, "ensemble"}, [&](const auto& goOn, auto& done) {
    const bio::MusculoskeletalSystem system(model, choice.systemOptions());
    made = std::make_unique<const bio::TrialEnsemble>(
        model, system, choice.systemOptions(), trial,
        bio::beginningOf(trial, model, system, initial).point, options);
    rows = rowsOf(*made, first, seed, threads, goOn, done);
    if (!sobol || !goOn) return;
    const bio::EnsembleOutput& decomposed =
        bio::ensembleOutputs()[bio::ensembleOutputNamed(output)];
    for (std::size_t c = 0; c < made->channels().size(); ++c) {
      indices.push_back(bio::sobolOf(ofEachRun(rows, c, decomposed),
                                     static_cast<int>(made->laws().parameters.size()), seed));
    }
  });
  return resultOf(*made, rows, indices);
}

}  // namespace

void defineEnsemble(py::module_& module) {
  defineWithChoice(module, "ensemble", &ensemble, docstrings::ensemble, "model"_a, "trial"_a,
                   py::kw_only(), "parameters"_a = std::vector<std::string>(), "draws"_a = 1000,
                   "first"_a = 0, "seed"_a = 1, "distribution"_a = "normal", "spread"_a = 1.0,
                   "prior"_a = Pairs(), "bounds"_a = Pairs(), "covariance"_a = py::none(),
                   "sobol"_a = false, "output"_a = "final",
                   "observe"_a = std::vector<std::string>(), "band_points"_a = 46, "threads"_a = 1,
                   "initial"_a = std::map<std::string, double>(), "progress"_a = false);
}

}  // namespace python
