#pragma once

// Activations of a run differentiated in parameters and in the times of a step; not public.

#include "bio/sensitivity/coupled_sensitivity.h"
#include "sensitivity/parameter_effects.h"

namespace bio::stepping {

/// Effect of a column on the excitation of a muscle, at the rows of the trial.
struct RowsOfColumn {
  Eigen::Index column;
  Eigen::RowVectorXd rows;
};
/// Columns of every muscle: of all parameters of the mapping but the delay, which moves rows.
std::vector<std::vector<RowsOfColumn>> excitationRows(const MusculoskeletalSystem& system,
                                                      const ParameterEffects& effects,
                                                      const ExcitationSignal& trial,
                                                      const EmgMapping& mapping);

/// Follows the recursion by which the variational integrator advances activations: straight pieces
/// of excitation from row to row of the trial, cut at the times of the steps.
class ExcitationSensitivity {
 public:
  ExcitationSensitivity(const MusculoskeletalSystem& system, const ParameterEffects& effects,
                        const ExcitationSignal& trial, const ExcitationSignal& driven,
                        const EmgMapping& mapping);

  /// The columns of θ that activations follow, rising, while times are fixed: those of the rows
  /// below. All others are zero.
  const std::vector<Eigen::Index>& columns() const { return columns_; }
  /// From now on rows have a column for every θ, because a time moves.
  void spread() { isSpread_ = true; }
  bool isSpread() const { return isSpread_; }

  /// d(activation)/dθ at the start, where it equals the excitation; rows = muscles.
  void start(double time, SensitivityMatrix& rows);

  /// From t0 to t1, whose derivatives are rows or null (fixed); `out` may not be `in`.
  /// @param activation  at t0
  void advance(double t0, double t1, const Eigen::RowVectorXd* dt0, const Eigen::RowVectorXd* dt1,
               const Eigen::Ref<const Eigen::VectorXd>& activation, const SensitivityMatrix& in,
               SensitivityMatrix& out);

 private:
  const MusculoskeletalSystem& system_;
  const ParameterEffects& effects_;
  const ExcitationSignal& driven_;
  Eigen::Index placeOf(Eigen::Index column) const;
  void findColumns();

  std::vector<std::vector<RowsOfColumn>> emg_;  ///< of each muscle
  std::vector<Eigen::Index> columns_;
  bool isSpread_ = false;
  std::size_t hint_ = 0;     ///< of the signal
  std::size_t nextRow_ = 0;  ///< first row of the signal behind the time reached
  Eigen::VectorXd from_, to_, now_;
};

}  // namespace bio::stepping
