#include "options/observed_channels.h"

#include <fmt/format.h>

#include "options/quantity.h"
#include "output/text.h"

namespace app {

std::vector<bio::ChannelCandidate> readObserved(const std::vector<std::string>& typed,
                                                const bio::Model& model,
                                                const bio::MusculoskeletalSystem& arm) {
  std::vector<std::pair<std::string, double>> named;
  for (const std::string& text : typed) {
    const Assignment one = parseAssignment(text);
    named.emplace_back(one.name, one.value);
  }
  return bio::observedChannels(named, model, arm);
}

std::string inWords(const std::vector<bio::ChannelCandidate>& channels, const bio::Model& model) {
  std::string text;
  for (const bio::ChannelCandidate& one : channels) {
    text += fmt::format("{}{} (noise {} {})", text.empty() ? "" : ", ", nameOf(one.what),
                        numberText(one.sd), bio::unitOf(one.what, model));
  }
  return text;
}

}  // namespace app
