#pragma once

// Activations of a run, differentiated against time; not public.

#include "bio/muscle/activation/excitation.h"
#include "sensitivity/parameter_effects.h"

namespace bio::stepping {

/// The transposed recursion of ExcitationSensitivity: from dJ/d(activation) at the end of a part of
/// a step to that at its begin, while dJ in excitations, delay and the laws' numbers is gathered.
class ExcitationAdjoint {
 public:
  ExcitationAdjoint(const MusculoskeletalSystem& system, const ExcitationSignal& driven);

  /// dJ in the times at both ends of a part.
  struct InTimes {
    double begin = 0, end = 0;
  };
  /// Replaces dJ/d(activation) at t1 by that at t0.
  /// @param activation  at t0
  /// @param gathers     whether dJ in the parameters is wanted as well
  InTimes pullBack(double t0, double t1, const Eigen::Ref<const Eigen::VectorXd>& activation,
                   Eigen::VectorXd& lambda, bool gathers);

  /// From dJ/d(activation) at the start, where it is the excitation within the law's limits.
  void finish(double time, const Eigen::VectorXd& lambda);

  const Eigen::MatrixXd& excitation() const { return excitation_; }  ///< dJ/du, muscles × rows
  double delay() const { return delay_; }
  /// In the numbers of the muscles' activation dynamics; rows = ActivationDynamics::names.
  const Eigen::MatrixXd& numbers() const { return numbers_; }

 private:
  struct Place {
    std::size_t row;
    double weight;  ///< of the row behind
  };
  /// Part of a step: a straight line of excitation.
  struct Piece {
    double begin, end;  ///< [s]
    bool beginsOnRow, endsOnRow;
    Place from, to;
    Eigen::VectorXd u0, u1;
    std::vector<ActivationStep> steps;  ///< of each muscle
  };
  Place placeOf(double t);
  void evaluate(double t, const Place& place, Eigen::VectorXd& u) const;
  /// From the activation now_ to that at the piece's end.
  void step(Piece& piece);
  void addExcitation(Eigen::Index muscle, const Place& place, double slope) {
    const auto k = static_cast<Eigen::Index>(place.row);
    excitation_(muscle, k) += (1 - place.weight) * slope;
    if (place.weight != 0) excitation_(muscle, k + 1) += place.weight * slope;
  }

  const MusculoskeletalSystem& system_;
  const ExcitationSignal& driven_;
  std::vector<Piece> pieces_;  ///< room for those of one part, kept from part to part
  Eigen::VectorXd now_;
  Eigen::MatrixXd excitation_, numbers_;
  double delay_ = 0;
  std::size_t near_ = 0;  ///< row of the last place
};

}  // namespace bio::stepping
