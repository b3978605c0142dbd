#include "info/discovery/judgement/separation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// One hypothesis in the planned experiment.
class Predicted {
 public:
  Predicted(const DiscoveryProblem& planned, const DiscoveryProblem& fitted, const Fit& fit)
      : planned_(planned), fit_(fit) {
    const auto& quantities = planned.quantities();
    values_ = nominalValues(planned);
    for (std::size_t i = 0; i < fitted.quantities().size(); ++i)
      if (fitted.quantities()[i].trial < 0)
        values_[find(fitted.quantities()[i].name)] = fit.values[static_cast<Index>(i)];
    std::vector<Index> lasting;
    for (std::size_t i = 0; i < fit.hypothesis.free.size(); ++i) {
      const FreeQuantity& free = fit.hypothesis.free[i];
      const Quantity& quantity = fitted.quantities()[free.quantity];
      if (quantity.trial >= 0) continue;
      lasting.push_back(static_cast<Index>(i));
      wanted_.push_back(static_cast<std::size_t>(find(quantity.name)));
      slopes_.push_back(free.slope(fit.xi[static_cast<Index>(i)]));
    }
    covariance_ = fit.covariance(lasting, lasting);
    for (std::size_t i = 0; i < quantities.size(); ++i)
      if (quantities[i].trial >= 0) {
        starts_.push_back(i);
        sds_.push_back(quantities[i].sd);
      }
  }

  struct Outcome {
    VectorXd outputs;
    MatrixXd variance;  // from its uncertain parameters, without initial states and latent force
    MatrixXd starts, latent;
  };
  Outcome at(int trial, double latentSize) const {
    std::vector<std::size_t> wanted = wanted_;
    wanted.insert(wanted.end(), starts_.begin(), starts_.end());
    const auto p = static_cast<Index>(wanted_.size());
    DiscoveryProblem::Prediction y = planned_.predict(trial, values_, {}, wanted, latentSize > 0);
    if (!y.outputs.allFinite() || !y.gamma.allFinite())
      throw std::domain_error("the planned experiment cannot be simulated");
    for (Index i = 0; i < y.gamma.cols(); ++i)
      y.gamma.col(i) *=
          i < p ? slopes_[static_cast<std::size_t>(i)] : sds_[static_cast<std::size_t>(i - p)];
    Outcome outcome;
    outcome.outputs = y.outputs;
    outcome.variance = y.gamma.leftCols(p) * covariance_ * y.gamma.leftCols(p).transpose();
    outcome.starts = y.gamma.rightCols(y.gamma.cols() - p);
    if (latentSize > 0) {
      const MatrixXd K = latentCovariance(planned_.nodes(trial), y.scale, fit_.noise.latentTime,
                                          planned_.latentLag());
      outcome.latent = latentSize * latentSize * (y.byNode * K * y.byNode.transpose());
    }
    return outcome;
  }

 private:
  Index find(const std::string& name) const {
    const auto& quantities = planned_.quantities();
    const auto at = std::find_if(quantities.begin(), quantities.end(),
                                 [&](const Quantity& q) { return q.name == name; });
    if (at == quantities.end())
      throw std::invalid_argument(fmt::format("the planned experiment has no quantity {}", name));
    return at - quantities.begin();
  }

  const DiscoveryProblem& planned_;
  const Fit& fit_;
  VectorXd values_;
  std::vector<std::size_t> wanted_, starts_;
  std::vector<double> slopes_, sds_;
  MatrixXd covariance_;
};

}  // namespace

double expectedSeparation(const DiscoveryProblem& planned, const DiscoveryProblem& fitted,
                          const Fit& a, const Fit& b) {
  const Predicted first(planned, fitted, a), second(planned, fitted, b);
  const double latent = std::max(a.noise.latent, b.noise.latent);
  double nats = 0;
  for (int trial = 0; trial < planned.numTrials(); ++trial) {
    const auto one = first.at(trial, latent), other = second.at(trial, 0);
    const VectorXd difference = one.outputs - other.outputs;
    MatrixXd S = one.variance + other.variance + one.starts * one.starts.transpose();
    if (latent > 0) S += one.latent;
    S.diagonal() += a.noise.output.bySample(planned.outputOfSample(trial), S.rows()).cwiseAbs2();
    nats += 0.5 * S.llt().matrixL().solve(difference).squaredNorm();
  }
  return nats;
}

std::string rivalName(const DiscoveryProblem& data, const Verdict& verdict, std::size_t rival) {
  const auto& first = verdict.rivals.front().hypothesis.effects;
  std::string name;
  for (const std::size_t effect : verdict.rivals[rival].hypothesis.effects) {
    const bool common = std::find(first.begin(), first.end(), effect) != first.end();
    if (rival != 0 && common) continue;
    name += (name.empty() ? "" : " + ") + data.candidates()[effect].id;
  }
  return name;
}

}  // namespace info::discover
