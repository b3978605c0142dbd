#include "info/dynamics/predictor.h"

#include <stdexcept>

namespace info {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Predictor reparametrise(Predictor full, VectorXd nominal, std::vector<Eigen::Index> estimated,
                        VectorXd unit) {
  if (unit.size() != static_cast<Eigen::Index>(estimated.size()))
    throw std::invalid_argument("reparametrise: one unit for each estimated parameter is needed");
  for (Eigen::Index i : estimated)
    if (i < 0 || i >= nominal.size())
      throw std::invalid_argument("reparametrise: parameter " + std::to_string(i) + " of " +
                                  std::to_string(nominal.size()) + " does not exist");
  const auto expand = [nominal, estimated, unit](const VectorXd& theta) {
    VectorXd all = nominal;
    all(estimated) = unit.cwiseProduct(theta);
    return all;
  };
  Predictor part;
  part.outputs = [full, expand](const VectorXd& theta) { return full.outputs(expand(theta)); };
  part.withSensitivities = [full, expand, estimated, unit](const VectorXd& theta) {
    Prediction prediction = full.withSensitivities(expand(theta));
    prediction.gamma = (prediction.gamma(Eigen::all, estimated) * unit.asDiagonal()).eval();
    return prediction;
  };
  if (full.contractedCurvature)
    part.contractedCurvature = [full, expand, estimated, unit](const VectorXd& theta,
                                                               const MatrixXd& w) -> MatrixXd {
      return unit.asDiagonal() * full.contractedCurvature(expand(theta), w)(estimated, estimated) *
             unit.asDiagonal();
    };
  return part;
}

}  // namespace info
