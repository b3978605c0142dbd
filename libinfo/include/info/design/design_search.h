#pragma once

#include <Eigen/Dense>
#include <functional>

#include "info/design/trajectory_search.h"

namespace info {

/// What an experiment with certain inputs would tell.
struct DesignOutcome {
  bool possible = false;        ///< false: there is no such experiment
  Eigen::MatrixXd information;  ///< I
  double penalty = 0;           ///< for what the experiment must not do ≥ 0
};

/// An experiment whose inputs are coefficients x of a convex set.
struct DesignProblem {
  /// Pure; called from several threads.
  std::function<DesignOutcome(const Eigen::VectorXd& x)> run;
  /// The nearest point of the set.
  std::function<Eigen::VectorXd(const Eigen::VectorXd& x)> project;
  /// φ(I) and its gradient, given which eigenvalues count as equal.
  /// @throws std::domain_error where there is none
  std::function<InformationCost(const Eigen::MatrixXd& information, double repeatedTolerance)> cost;
};

struct DesignSearchOptions {
  double difference = 1e-5;  ///< of a coefficient, for ∂I/∂x and ∂penalty/∂x [unit of x] > 0
  int threads = 0;           ///< at most so many runs at once; 0: all cores
  /// Asked after every run, from any thread; once it is true, the search ends where it is.
  std::function<bool()> stop = {};
};

/// Searches the inputs of an experiment for J(x) = φ(I(x)) + penalty(x), for info::search().
///
/// For systems whose step has no second derivatives, so that projection.h and discrete_projection.h
/// cannot give DJ. ∂I/∂x_i is the difference of two exact informations,
///     ∂J/∂x_i = ⟨∂φ/∂I, I(x + δe_i) − I(x)⟩/δ + ∂penalty/∂x_i,
/// all i in parallel; the step δ goes where x + δe_i stays between −1 and 1. Differencing I and not
/// φ keeps the generalised gradient of λ_min where eigenvalues meet. The direction is that of the
/// spectral projected gradient, d = P(x − α∂J) − x with Barzilai and Borwein's α = sᵀs/sᵀy, so that
/// x + γd keeps the limits for all γ ≤ 1 (Birgin, Martínez & Raydan 2000, with a monotone search).
class DesignSearch : public SearchProblem {
 public:
  /// @throws NoInformation, std::domain_error if there is no cost at the start
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
