#include "foreseen_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "text.h"

namespace app {

std::string rivalName(const info::discover::Disagreement& data,
                      const info::discover::Verdict& verdict, std::size_t rival) {
  const auto& first = verdict.rivals.front().hypothesis.effects;
  std::string name;
  for (const std::size_t effect : verdict.rivals[rival].hypothesis.effects) {
    const bool common = std::find(first.begin(), first.end(), effect) != first.end();
    if (rival != 0 && common) continue;
    name += (name.empty() ? "" : " + ") + data.candidates()[effect].id;
  }
  return name;
}

std::string foreseenSentence(const std::vector<bio::discover::ForeseenExperiment>& foreseen,
                             const info::discover::Disagreement& data,
                             const info::discover::Verdict& verdict, double enough) {
  if (foreseen.empty() || foreseen.front().least() < enough) return {};
  const bio::discover::ForeseenExperiment& best = foreseen.front();
  std::string rivals;
  for (std::size_t i = 0; i < best.nats.size(); ++i)
    rivals += fmt::format("{}{} ({} nats)", i == 0 ? "" : ", ", rivalName(data, verdict, i + 1),
                          numberText(best.nats[i], 2));
  std::string what = best.sentence;
  what.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(what.front())));
  return fmt::format(
      "{}. Simulated with all that cannot be told apart, it is expected to tell {} "
      "from {}; {} nats are enough.",
      what, rivalName(data, verdict, 0), rivals, enough);
}

}  // namespace app
