#include "score/recovery.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "score/wilson.h"

namespace hidden {

std::vector<RecoveryBin> recoveryByDetectability(const std::vector<Outcome>& outcomes) {
  constexpr double edges[] = {0, 0.5, 1, 1.5, 2, 4, std::numeric_limits<double>::infinity()};
  std::vector<RecoveryBin> bins;
  for (std::size_t i = 0; i + 1 < std::size(edges); ++i) bins.push_back({edges[i], edges[i + 1]});
  for (const Outcome& o : outcomes) {
    if (!o.visibility || o.truth.size() != 1 || o.suite == "out") continue;
    for (RecoveryBin& bin : bins) {
      if (*o.visibility < bin.from || *o.visibility >= bin.to) continue;
      ++bin.n;
      bin.right += o.firstIsRight;
    }
  }
  return bins;
}

std::optional<double> recoveryError(const std::vector<Outcome>& outcomes) {
  double sum = 0;
  int n = 0;
  for (const Outcome& o : outcomes) {
    if (!o.z) continue;
    sum += *o.z * *o.z;
    ++n;
  }
  if (n == 0) return {};
  return std::sqrt(sum / n);
}

std::string recoveryTable(const std::vector<Outcome>& outcomes) {
  std::string text =
      "| amplitude over the least one that would have shown | right name first | share | 95 % "
      "interval |\n|---|---|---|---|\n";
  for (const RecoveryBin& bin : recoveryByDetectability(outcomes)) {
    if (bin.n == 0) continue;
    const Interval i = wilson(bin.right, bin.n);
    text += fmt::format("| {} | {} of {} | {:.1f} % | {:.1f}–{:.1f} % |\n",
                        std::isinf(bin.to) ? fmt::format("{:g} and more", bin.from)
                                           : fmt::format("{:g} to {:g}", bin.from, bin.to),
                        bin.right, bin.n, 100.0 * bin.right / bin.n, 100 * i.low, 100 * i.high);
  }
  if (const auto error = recoveryError(outcomes))
    text += fmt::format("\nError of the estimates: {:.2f} of their deviations (target ≤ 1.3).\n",
                        *error);
  return text;
}

}  // namespace hidden
