#include "reduced/reduced_elbow.h"

#include <cmath>

#include "reduced/reduced_motion.h"
#include "reduced/reduced_quantities.h"

namespace reduced {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

template <bool derivatives>
Motion Elbow::solve(int which, double step, const VectorXd& values, const VectorXd& latent,
                    const std::vector<std::size_t>& wanted, bool latentToo) const {
  const auto start = static_cast<Index>(kShared) + 2 * which;
  return solveMotion<derivatives>({trials_[index(which)], times_[index(which)],
                                   static_cast<Index>(nodes_[index(which)].size()), start, formula_,
                                   formulaAt_, step, values, latent, wanted, latentToo});
}

Elbow::Elbow(std::vector<Trial> trials, const std::vector<std::string>& hidden, double step)
    : trials_(std::move(trials)), step_(step) {
  quantities_ = sharedQuantities();
  candidates_ = catalogue(hidden);
  for (std::size_t i = 0; i <= kTau; ++i) nuisances_.push_back(i);
  for (std::size_t t = 0; t < trials_.size(); ++t) {
    const Trial& trial = trials_[t];
    const std::string suffix = " of trial " + std::to_string(t + 1);
    nuisances_.push_back(quantities_.size());
    quantities_.push_back(
        {"start angle" + suffix, "rad", trial.startAngle, -3, 6, 0.05, false, static_cast<int>(t)});
    nuisances_.push_back(quantities_.size());
    quantities_.push_back({"start speed" + suffix, "rad/s", trial.startSpeed, -20, 20, 0.5, false,
                           static_cast<int>(t)});
    times_.emplace_back();
    for (Index k = 0; k < trial.angles.size(); ++k)
      times_.back().push_back(trial.firstSample + kTick * static_cast<double>(k));
    const double duration = kTick * static_cast<double>(trial.excitations.size() - 1);
    nodes_.emplace_back();
    for (int i = 0; (i - 1) * kNode < duration - 1e-9; ++i) nodes_.back().push_back({i * kNode, 0});
  }
}

Elbow::Prediction Elbow::predict(int trial, const VectorXd& values, const VectorXd& latent,
                                 const std::vector<std::size_t>& wanted, bool latentToo) const {
  const Motion s = solve<true>(trial, step_, values, latent, wanted, latentToo);
  const auto P = static_cast<Index>(wanted.size());
  Prediction p;
  p.outputs = s.outputs;
  p.speeds = s.speeds;
  p.gamma = s.gamma.leftCols(P);
  if (latentToo) p.byNode = s.gamma.rightCols(s.gamma.cols() - P);
  p.scale = s.scale;
  p.course = {s.q, s.qDot};
  p.courseByNode = s.courseByNode;
  return p;
}

const std::vector<info::discover::Axis>& Elbow::axes() const {
  static const std::vector<info::discover::Axis> elbow = {{"elbow", "rad", "N·m"}};
  return elbow;
}

VectorXd Elbow::outputs(int trial, const VectorXd& values, const VectorXd& latent) const {
  return solve<false>(trial, step_, values, latent, {}, false).outputs;
}

VectorXd Elbow::refinedOutputs(int trial, const VectorXd& values) const {
  return solve<false>(trial, 0.5 * step_, values, {}, {}, false).outputs;
}

std::unique_ptr<info::discover::DiscoveryProblem> Elbow::withFormula(
    std::size_t /*axis*/, const std::vector<info::discover::FormulaTerm>& terms,
    const std::vector<std::size_t>& kept) const {
  auto widened = std::make_unique<Elbow>(*this);
  widened->candidates_.clear();
  for (const std::size_t c : kept) widened->candidates_.push_back(candidates_[c]);
  if (formula_.empty()) widened->formulaAt_ = static_cast<Index>(quantities_.size());
  widened->quantities_.resize(static_cast<std::size_t>(widened->formulaAt_));
  widened->formula_.clear();
  info::discover::Candidate candidate{"formula", "force without a name", "", {}, {}, {}, {}, {}};
  VectorXd starts(static_cast<Index>(terms.size()));
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const auto term = StateTerm::parse(terms[k].expression);
    if (!term) return nullptr;
    widened->formula_.push_back(*term);
    candidate.quantities.push_back(widened->quantities_.size());
    const double sd = terms[k].sd;
    candidate.sds.push_back(sd);
    starts[static_cast<Index>(k)] = terms[k].start;
    widened->quantities_.push_back(
        {"formula " + std::to_string(k + 1), "", 0, -20 * sd, 20 * sd, sd});
  }
  candidate.starts = {starts};
  widened->candidates_.push_back(std::move(candidate));
  return widened;
}

MatrixXd Elbow::inputs(int which) const {
  const Trial& trial = trials_[index(which)];
  const auto first = static_cast<std::size_t>(std::lround(trial.firstSample / kTick));
  MatrixXd u(trial.angles.size(), kMuscles);
  for (Index k = 0; k < u.rows(); ++k)
    for (Index m = 0; m < kMuscles; ++m)
      u(k, m) = trial.excitations[first + static_cast<std::size_t>(k)][static_cast<std::size_t>(m)];
  return u;
}

}  // namespace reduced
