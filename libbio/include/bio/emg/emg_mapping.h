#pragma once

#include <map>
#include <string>
#include <vector>

#include "bio/muscle/activation/excitation.h"
#include "bio/tables/latent_excitation.h"

namespace bio {

/// Maps the excitations of a trial to those that drive the muscles:
///     u_i(t) = min(1, g_i·S(z_i(t − d))),   S(x) = (e^{Ax} − 1)/(e^A − 1), S = x for A = 0
///     z_i = max(0, x_i − o_i − Σ_j c_ji·x_j) + s_i·h_i
/// and fatigue reduces this the longer a muscle has been active:
///     u_i ← u_i·[1 − φ(1 − e^{−I_i/T})],   I_i = ∫u_i dt from the first row, u_i as above
/// where h_i is what a saturated record lacks (flatTops) and s_i its size. Before all that the x_i
/// of a muscle with a latent excitation is the trial's course corrected by it.
/// (S: Lloyd & Besier 2003, eq. 3, as in emg_stages.h). It is applied to the rows of the trial; u
/// is linear between them. The default is the identity.
struct EmgMapping {
  /// Crosstalk: share c_ji of muscle j in the signal of muscle i. For j = i, the share of its own
  /// signal that is lost: two channels are exchanged with c_ii = c_jj = 1 and c_ij = c_ji = −1.
  struct Crosstalk {
    std::string from, to;
    double share = 0;  ///< c [1]
  };

  std::map<std::string, double> gain;         ///< g [1] ≥ 0 by muscle; 1 where it has none
  double delay = 0;                           ///< d [s], electromechanical
  double nonlinearity = 0;                    ///< A [1], −6 to 6
  std::map<std::string, double> offset = {};  ///< o [1] by muscle; 0 where it has none
  std::vector<Crosstalk> crosstalk = {};
  std::map<std::string, double> saturation = {};  ///< s [1] by muscle; 0 where it has none
  double fatigue = 0;      ///< φ [1], −1 to 1; below 0 the excitation increases
  double fatigueTime = 1;  ///< T [s] > 0 of full excitation
  /// By muscle, which then has no saturation.
  std::map<std::string, LatentExcitation> latent = {};
};

/// Height that saturation cut off a record: 0 but on its flat tops, five or more rows in turn at
/// the record's maximum. There the record goes on with the slopes a [1/s] before and b behind it,
///     h = D·[a·τ(1 − τ)² + b·τ²(1 − τ)],  τ = (t − t₀)/D,
/// D its duration; with one slope, where it begins or ends the record, D·a·τ(1 − τ/2). 0 where the
/// record is flat from beginning to end.
Eigen::RowVectorXd flatTops(const Eigen::VectorXd& times, const Eigen::RowVectorXd& record);

/// @param muscles  of a signal
/// @throws std::invalid_argument for a gain < 0, a delay that is not finite, A outside −6 … 6, φ
///   outside −1 … 1, T not above 0, a gain, offset, crosstalk, saturation or latent excitation of
///   an unknown muscle, or the last two of one
void requireValid(const std::vector<std::string>& muscles, const EmgMapping& mapping);

/// @param muscles  the signal's, in order
/// @throws std::invalid_argument as requireValid() does
ExcitationSignal drivenExcitation(const ExcitationSignal& trial,
                                  const std::vector<std::string>& muscles,
                                  const EmgMapping& mapping);

/// ∂u_i/∂g_i, ∂u_i/∂A and ∂u_i/∂z_i at the rows of the signal, before fatigue; rows = muscles,
/// columns = rows. 0 where u is clipped to 1, ∂u/∂z also where z is clipped to 0. ∂u/∂d is −du/dt.
struct EmgDerivatives {
  Eigen::MatrixXd gain;
  Eigen::MatrixXd nonlinearity;
  Eigen::MatrixXd signal;  ///< ∂u/∂z: −1 times it is ∂u/∂o, −x_j ∂u/∂c_ji, h_i ∂u/∂s_i
  Eigen::MatrixXd rows;         ///< x: the trial's own, or with the latent excitation
  Eigen::MatrixXd fatigue;      ///< ∂u/∂φ
  Eigen::MatrixXd fatigueTime;  ///< ∂u/∂T [1/s]

  /// Maps a change of u_i before fatigue, at the rows, to the change of u_i:
  ///     δ[u w] = w δu − u (φ/T) e^{−I/T} ∫δu dt
  Eigen::RowVectorXd tired(Eigen::Index muscle, const Eigen::RowVectorXd& change) const;

  Eigen::VectorXd times;   ///< of the rows [s]
  Eigen::MatrixXd share;   ///< w = 1 − φ(1 − e^{−I/T}); empty: no fatigue
  Eigen::MatrixXd tiring;  ///< u (φ/T) e^{−I/T} [1/s]
};
EmgDerivatives emgDerivatives(const ExcitationSignal& trial,
                              const std::vector<std::string>& muscles, const EmgMapping& mapping);

}  // namespace bio
