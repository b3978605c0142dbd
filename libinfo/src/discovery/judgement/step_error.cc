#include "discovery/judgement/step_error.h"

namespace info::discover {

using Eigen::VectorXd;

StepError stepError(const DiscoveryProblem& data, const std::vector<int>& trials,
                    const VectorXd& values, const Whitening& sds) {
  StepError worst;
  for (const int t : trials) {
    const VectorXd refined = data.refinedOutputs(t, values);
    if (refined.size() == 0) continue;
    VectorXd moved = refined - data.outputs(t, values, {});
    sds.whiten(data.outputOfSample(t), moved);
    const double change = moved.cwiseAbs().maxCoeff();
    if (change > worst.largest) worst = {change, t};
  }
  return worst;
}

}  // namespace info::discover
