#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include "bio/discovery/musculoskeletal_problem.h"
#include "support/cut_trial.h"
#include "support/shipped_elbow.h"

/// The shipped elbow with its catalogue of effects, and derivatives by whole simulations.
namespace bio::discover::effect_cases {

using Eigen::Index;
using Eigen::VectorXd;
using fixtures::cut;
using fixtures::ShippedElbow;
using info::discover::Candidate;

struct Case {
  explicit Case(double seconds = 0.6, const std::string& model = "elbow8",
                const std::string& trial = "curl_fast")
      : elbow(model, trial),
        data(elbow.model, ShippedElbow::options(), "elbow_flexion", {cut(elbow.trial, seconds)},
             exact()) {}

  static MusculoskeletalProblemOptions exact() {
    MusculoskeletalProblemOptions options;
    options.simulation.newtonTolerance = 1e-12;
    return options;
  }

  VectorXd nominal() const {
    VectorXd values(static_cast<Index>(data.quantities().size()));
    for (Index i = 0; i < values.size(); ++i) {
      values[i] = data.quantities()[static_cast<std::size_t>(i)].nominal;
    }
    return values;
  }
  /// With an effect as a start of its has it.
  VectorXd with(const Candidate& candidate, std::size_t start = 0) const {
    VectorXd values = nominal();
    for (std::size_t i = 0; i < candidate.quantities.size(); ++i) {
      values[static_cast<Index>(candidate.quantities[i])] =
          candidate.starts.at(start)[static_cast<Index>(i)];
    }
    return values;
  }
  const Candidate& find(const std::string& id) const {
    for (const Candidate& candidate : data.candidates()) {
      if (candidate.id == id) return candidate;
    }
    throw std::invalid_argument("no candidate " + id);
  }
  VectorXd outputs(const VectorXd& values) const { return data.outputs(0, values, {}); }

  ShippedElbow elbow;
  MusculoskeletalProblem data;
};

/// Fourth-order central difference of whole simulations.
template <class F>
VectorXd difference(const F& f, double h) {
  return (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h);
}

/// max |column − difference| / max |difference|, of the step that agrees best: a fibre that turns
/// and a path that lifts off put kinks into the motion, which a finer step does not meet.
inline double problem(const VectorXd& column, const std::function<VectorXd(double)>& f,
                      double scale) {
  double best = std::numeric_limits<double>::infinity();
  for (const double h : {3e-3, 3e-4, 3e-5, 1e-2}) {
    const VectorXd d = difference(f, h * scale);
    const double size = std::max(d.cwiseAbs().maxCoeff(), 1e-6);
    best = std::min(best, (column - d).cwiseAbs().maxCoeff() / size);
    if (best < 1e-5) break;
  }
  return best;
}

}  // namespace bio::discover::effect_cases
