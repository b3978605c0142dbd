#pragma once

#include <map>
#include <string>
#include <vector>

#include "bio/excitation.h"

namespace bio {

/// From the excitations of a trial to those that drive the muscles:
///     u_i(t) = min(1, g_i·S(x_i(t − d))),   S(x) = (e^{Ax} − 1)/(e^A − 1), S = x for A = 0
/// (S: Lloyd & Besier 2003, eq. 3, as in emg_stages.h). S and the gain act on the rows of the
/// trial, between which u stays straight. As it stands, the identity.
struct EmgMapping {
  std::map<std::string, double> gain;  ///< g [1] ≥ 0 by muscle; 1 where it has none
  double delay = 0;                    ///< d [s], electromechanical
  double nonlinearity = 0;             ///< A [1], −3 to 0
};

/// @param muscles  the signal's, in order
/// @throws std::invalid_argument for a gain < 0, a delay that is not finite, A outside −6 … 6, or a
///   gain of a muscle that is not there
ExcitationSignal drivenExcitation(const ExcitationSignal& trial,
                                  const std::vector<std::string>& muscles,
                                  const EmgMapping& mapping);

/// ∂u/∂g_i and ∂u/∂A at the rows of the signal; rows = muscles, columns = rows. 0 where u is held
/// at 1. ∂u/∂d is −du/dt.
struct EmgDerivatives {
  Eigen::MatrixXd gain;
  Eigen::MatrixXd nonlinearity;
};
EmgDerivatives emgDerivatives(const ExcitationSignal& trial,
                              const std::vector<std::string>& muscles, const EmgMapping& mapping);

}  // namespace bio
