#include "options/observed_channels.h"

#include <fmt/format.h>

#include "options/quantity.h"
#include "output/text.h"

namespace app {

std::vector<bio::ChannelCandidate> readObserved(const std::vector<std::string>& typed,
                                                const bio::Model& model,
                                                const bio::MusculoskeletalSystem& system) {
  std::vector<std::pair<std::string, double>> named;
  for (const std::string& text : typed) {
    const Assignment assignment = parseAssignment(text);
    named.emplace_back(assignment.name, assignment.value);
  }
  return bio::observedChannels(named, model, system);
}

std::vector<std::string> namesOf(const std::vector<std::string>& typed) {
  std::vector<std::string> names;
  for (const std::string& text : typed) {
    names.push_back(text.find('=') == text.npos ? text : parseAssignment(text).name);
  }
  return names;
}

std::string inWords(const std::vector<bio::ChannelCandidate>& channels, const bio::Model& model) {
  std::string text;
  for (const bio::ChannelCandidate& candidate : channels) {
    text += fmt::format("{}{} (noise {} {})", text.empty() ? "" : ", ", nameOf(candidate.what),
                        numberText(candidate.sd), bio::unitOf(candidate.what, model));
  }
  return text;
}

}  // namespace app
