#pragma once

#include <Eigen/Dense>
#include <functional>

#include "info/design/trajectory_search.h"

namespace info {

/// The information of an experiment with given inputs.
struct DesignOutcome {
  bool possible = false;        ///< false: the experiment is infeasible
  Eigen::MatrixXd information;  ///< I
  double penalty = 0;           ///< for violated constraints, ≥ 0
};

/// An experiment whose inputs are coefficients x of a convex set.
struct DesignProblem {
  /// Pure; called from several threads.
  std::function<DesignOutcome(const Eigen::VectorXd& x)> run;
  /// Projection onto the set.
  std::function<Eigen::VectorXd(const Eigen::VectorXd& x)> project;
  /// φ(I) and its gradient, given the tolerance for equal eigenvalues.
  /// @throws std::domain_error if undefined
  std::function<InformationCost(const Eigen::MatrixXd& information, double repeatedTolerance)> cost;
};

struct DesignSearchOptions {
  double difference = 1e-5;  ///< step for ∂I/∂x and ∂penalty/∂x [unit of x] > 0
  int threads = 0;           ///< number of concurrent runs; 0: all cores
  /// Called after every run, from any thread; returning true ends the search.
  std::function<bool()> stop = {};
};

/// Optimisation of the inputs of an experiment, J(x) = φ(I(x)) + penalty(x), for info::search().
///
/// For systems without second derivatives of the step, for which projection.h and
/// discrete_projection.h cannot compute DJ. ∂I/∂x_i is the difference quotient of two exact
/// information matrices,
///     ∂J/∂x_i = ⟨∂φ/∂I, I(x + δe_i) − I(x)⟩/δ + ∂penalty/∂x_i,
/// all i in parallel; δ has the sign for which x + δe_i stays between −1 and 1. Differencing I
/// instead of φ preserves the generalised gradient of λ_min at repeated eigenvalues. The direction
/// is that of the spectral projected gradient, d = P(x − α∂J) − x with Barzilai and Borwein's α =
/// sᵀs/sᵀy, so that x + γd respects the limits for all γ ≤ 1 (Birgin, Martínez & Raydan 2000, with
/// a monotone search).
class DesignSearch : public SearchProblem {
 public:
  /// @throws NoInformation, std::domain_error if the cost is undefined at the start
  DesignSearch(DesignProblem problem, const Eigen::VectorXd& start,
               DesignSearchOptions options = {});

  const Eigen::VectorXd& x() const { return x_; }
  double penalty() const { return at_.penalty; }
  /// ∂J/∂x at the current x.
  Eigen::VectorXd gradient(double repeatedTolerance) const;

  double cost() const override { return cost_; }
  const Eigen::MatrixXd& information() const override { return at_.information; }
  Direction findDirection(double repeatedTolerance) override;
  double trial(double step) override;
  void accept() override;

 private:
  double costOf(const DesignOutcome& outcome) const;
  bool stopped() const { return options_.stop && options_.stop(); }

  DesignProblem problem_;
  DesignSearchOptions options_;
  Eigen::VectorXd x_, direction_, gradient_, previousX_, previousGradient_, trialX_;
  DesignOutcome at_, trialAt_;
  double cost_ = 0, trialCost_ = 0;
};

}  // namespace info
