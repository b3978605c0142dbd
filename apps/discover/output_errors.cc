#include "discover/output_errors.h"

#include <algorithm>
#include <cmath>

#include "output/json_text.h"

namespace app {

using nlohmann::ordered_json;

double errorOf(const DiscoverFindings& f, std::size_t output, bool ofHeldOut) {
  const auto& held = f.options.heldOut;
  const Eigen::VectorXd& values = f.verdict.values.size() > 0 ? f.verdict.values : f.verdict.base;
  double squares = 0, count = 0;
  for (int t = 0; t < f.data.numTrials(); ++t) {
    if ((std::find(held.begin(), held.end(), t) != held.end()) != ofHeldOut) continue;
    const std::vector<Eigen::Index> samples = samplesOf(f.data, t, output);
    const Eigen::VectorXd simulated = f.data.outputs(t, values, {});
    squares += (simulated(samples) - f.data.measured(t)(samples)).squaredNorm();
    count += static_cast<double>(samples.size());
  }
  return f.wording.outputs[output].scale * std::sqrt(squares / count);
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
  for (std::size_t o = 0; o < f.wording.outputs.size(); ++o) {
    const ShownOutput& output = f.wording.outputs[o];
    ordered_json json{{"name", output.name},
                      {"unit", output.unit},
                      {"noise_sd", orNull(output.scale * f.verdict.outputSd.sd(o))}};
    if (f.wording.isInNoise() && f.verdict.base.size() > 0)
      json["rmse_after"] = orNull(errorOf(f, o, false));
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace app
