#include "discover/output_errors.h"

#include <algorithm>

#include "info/discovery/judgement/excess_error.h"
#include "output/json_text.h"

namespace app {

using nlohmann::ordered_json;

Eigen::VectorXd errorsOf(const DiscoverFindings& f, bool ofHeldOut) {
  const auto& held = f.options.heldOut;
  std::vector<int> trials;
  for (int t = 0; t < f.data.numTrials(); ++t)
    if ((std::find(held.begin(), held.end(), t) != held.end()) == ofHeldOut) trials.push_back(t);
  const Eigen::VectorXd& values = f.verdict.values.size() > 0 ? f.verdict.values : f.verdict.base;
  Eigen::VectorXd errors =
      info::discover::errorsByOutput(f.data, trials, values, f.wording.outputs.size());
  for (std::size_t o = 0; o < f.wording.outputs.size(); ++o)
    errors[static_cast<Eigen::Index>(o)] *= f.wording.outputs[o].scale;
  return errors;
}

std::vector<Eigen::Index> samplesOf(const info::discover::DiscoveryProblem& data, int trial,
                                    std::size_t output) {
  const auto& which = data.outputOfSample(trial);
  std::vector<Eigen::Index> samples;
  for (std::size_t k = 0; k < data.times(trial).size(); ++k) {
    if (which.empty() ? output == 0 : static_cast<std::size_t>(which[k]) == output)
      samples.push_back(static_cast<Eigen::Index>(k));
  }
  return samples;
}

ordered_json outputsJson(const DiscoverFindings& f) {
  ordered_json list = ordered_json::array();
  const bool hasErrors = f.wording.isInNoise() && f.verdict.base.size() > 0;
  const Eigen::VectorXd errors = hasErrors ? errorsOf(f, false) : Eigen::VectorXd();
  for (std::size_t o = 0; o < f.wording.outputs.size(); ++o) {
    const ShownOutput& output = f.wording.outputs[o];
    ordered_json json{{"name", output.name},
                      {"unit", output.unit},
                      {"noise_sd", orNull(output.scale * f.verdict.sds.sd(o))}};
    if (hasErrors) json["rmse_after"] = orNull(errors[static_cast<Eigen::Index>(o)]);
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace app
