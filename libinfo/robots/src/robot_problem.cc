#include "robots/robot_problem.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "info/discovery/judgement/output_sd.h"

namespace info::robot {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

void mustBeSound(const Trial& trial, std::size_t channels) {
  const auto fail = [&](const std::string& what) {
    throw std::invalid_argument(fmt::format("{}: {}", trial.name, what));
  };
  const std::size_t n = trial.times.size();
  if (n < 2) fail(fmt::format("holds {} rows, must hold at least 2", n));
  if (trial.acceleration.size() != n || trial.measured.rows() != static_cast<Index>(n) ||
      trial.measured.cols() != static_cast<Index>(channels))
    fail("commands and measured values must have one row for each time");
  for (std::size_t k = 0; k < n; ++k) {
    if (!std::isfinite(trial.times[k]) || (k > 0 && !(trial.times[k] > trial.times[k - 1])))
      fail(fmt::format("time {} s in row {}, must be finite and rise", trial.times[k], k + 1));
    if (!std::isfinite(trial.acceleration[k]))
      fail(fmt::format("cart acceleration {} m/s² in row {}, must be finite", trial.acceleration[k],
                       k + 1));
  }
}

double noiseOf(const std::vector<Trial>& trials, Index channel, const std::string& name) {
  discover::ThirdDifferences differences;
  for (const Trial& trial : trials) differences.add(trial.times, trial.measured.col(channel));
  if (!(differences.squares > 0) || differences.count < 5)
    throw std::invalid_argument(fmt::format(
        "{}: the trials must hold at least eight equally spaced values with scatter", name));
  return differences.sd();
}

}  // namespace

RobotProblem::RobotProblem(Model model, std::vector<Trial> trials, DisagreementOptions options)
    : model_(std::move(model)), options_(std::move(options)) {
  if (!(options_.step > 0) || !(options_.latentSpacing > 0))
    throw std::invalid_argument("robot: step and spacing of the latent force must be > 0");
  if (trials.empty()) throw std::invalid_argument("robot: must have at least one trial");
  for (const Trial& trial : trials) mustBeSound(trial, model_.channels.size());
  for (const std::string& id : options_.without) {
    const auto before = model_.candidates.size();
    std::vector<std::string> known;
    for (const auto& c : model_.candidates) known.push_back(c.id);
    std::erase_if(model_.candidates, [&](const auto& c) { return c.id == id; });
    if (model_.candidates.size() == before)
      throw std::invalid_argument(
          fmt::format("effect {}: not in the catalogue of {}, which holds {}", id, model_.name,
                      fmt::join(known, ", ")));
  }
  if (!options_.sds.empty() && options_.sds.size() != model_.channels.size())
    throw std::invalid_argument(fmt::format("noise: {} values for {} channels", options_.sds.size(),
                                            model_.channels.size()));
  for (std::size_t c = 0; c < model_.channels.size(); ++c) {
    sds_.push_back(options_.sds.empty()
                       ? noiseOf(trials, static_cast<Index>(c), model_.channels[c].name)
                       : options_.sds[c]);
    if (!(sds_[c] > 0) || !std::isfinite(sds_[c]))
      throw std::invalid_argument(fmt::format("noise of {}: {} {}, must be > 0",
                                              model_.channels[c].name, sds_[c],
                                              model_.channels[c].unit));
  }

  quantities_ = model_.quantities;
  nuisances_ = model_.nuisances;
  for (std::size_t t = 0; t < trials.size(); ++t) {
    OfTrial one;
    one.trial = std::move(trials[t]);
    const Trial& trial = one.trial;
    std::vector<double> measured;
    VectorXd first = VectorXd::Zero(static_cast<Index>(model_.channels.size()));
    std::vector<bool> seen(model_.channels.size(), false);
    for (std::size_t k = 0; k < trial.times.size(); ++k)
      for (std::size_t c = 0; c < model_.channels.size(); ++c) {
        const double y = trial.measured(static_cast<Index>(k), static_cast<Index>(c));
        if (!std::isfinite(y)) continue;
        if (!seen[c]) first[static_cast<Index>(c)] = y;
        seen[c] = true;
        one.samples.push_back({trial.times[k], static_cast<int>(c)});
        one.times.push_back(trial.times[k]);
        one.channels.push_back(static_cast<int>(c));
        measured.push_back(y);
      }
    if (measured.empty())
      throw std::invalid_argument(
          fmt::format("{}: holds no measured value, must hold at least one", trial.name));
    one.measured = VectorXd::Map(measured.data(), static_cast<Index>(measured.size()));
    const double begin = trial.times.front(), length = trial.times.back() - begin;
    const auto count = static_cast<int>(std::ceil(length / options_.latentSpacing - 1e-9)) + 2;
    for (int i = 0; i < count; ++i) one.nodes.push_back(begin + i * options_.latentSpacing);
    for (const double time : one.nodes) one.latentNodes.push_back({time, 0});
    one.start = quantities_.size();
    for (const StartQuantity& s : model_.starts) {
      const double nominal = s.channel < 0 ? 0 : first[s.channel];
      nuisances_.push_back(quantities_.size());
      quantities_.push_back({fmt::format("{}, trial {}", s.name, t + 1), s.unit, nominal,
                             nominal - s.bound, nominal + s.bound, s.sd, false,
                             static_cast<int>(t)});
    }
    trials_.push_back(std::move(one));
  }
}

Response RobotProblem::simulate(const OfTrial& trial, const VectorXd& values,
                                const VectorXd& latent, const std::vector<std::size_t>& shared,
                                bool derivatives, bool latentToo, double stepFactor) const {
  const VectorXd numbers = values.head(static_cast<Index>(model_.quantities.size()));
  const VectorXd start =
      values.segment(static_cast<Index>(trial.start), static_cast<Index>(model_.starts.size()));
  return model_.simulate({trial.trial, trial.samples, trial.nodes, options_.step * stepFactor,
                          numbers, start, latent, shared, derivatives, latentToo});
}

RobotProblem::Prediction RobotProblem::predict(int trial, const VectorXd& values,
                                               const VectorXd& latent,
                                               const std::vector<std::size_t>& wanted,
                                               bool latentToo) const {
  const OfTrial& one = of(trial);
  // quantities of the model, each once
  std::vector<std::size_t> shared;
  for (const std::size_t q : wanted)
    if (q < model_.quantities.size() && std::find(shared.begin(), shared.end(), q) == shared.end())
      shared.push_back(q);
  Response r = simulate(one, values, latent, shared, true, latentToo, 1);
  Prediction p;
  p.outputs = std::move(r.outputs);
  p.speeds = std::move(r.speeds);
  p.gamma = MatrixXd::Zero(p.outputs.size(), static_cast<Index>(wanted.size()));
  for (std::size_t j = 0; j < wanted.size(); ++j) {
    const std::size_t q = wanted[j];
    const auto at = std::find(shared.begin(), shared.end(), q);
    auto column = p.gamma.col(static_cast<Index>(j));
    if (at != shared.end())
      column = r.byWanted.col(at - shared.begin());
    else if (q >= one.start && q < one.start + model_.starts.size())
      column = r.byStart.col(static_cast<Index>(q - one.start));
  }
  if (latentToo) {
    p.byNode = std::move(r.byLatent);
    p.scale = VectorXd::Ones(static_cast<Index>(one.nodes.size()));
    p.course = {std::move(r.angle), std::move(r.rate)};
    p.courseByNode = std::move(r.angleByLatent);
  }
  return p;
}

VectorXd RobotProblem::outputs(int trial, const VectorXd& values, const VectorXd& latent) const {
  const OfTrial& one = of(trial);
  return simulate(one, values, latent, {}, false, false, 1).outputs;
}

VectorXd RobotProblem::refinedOutputs(int trial, const VectorXd& values) const {
  const OfTrial& one = of(trial);
  return simulate(one, values, {}, {}, false, false, 0.5).outputs;
}

MatrixXd RobotProblem::states(int trial, const VectorXd& values) const {
  return simulate(of(trial), values, {}, {}, false, false, 1).states;
}

MatrixXd RobotProblem::inputs(int trial) const {
  const OfTrial& one = of(trial);
  MatrixXd u(one.measured.size(), 1);
  std::size_t row = 0;
  for (Index k = 0; k < u.rows(); ++k) {
    while (one.trial.times[row] < one.times[static_cast<std::size_t>(k)]) ++row;
    u(k, 0) = one.trial.acceleration[row];
  }
  return u;
}

}  // namespace info::robot
