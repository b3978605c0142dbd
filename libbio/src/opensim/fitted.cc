#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "opensim/reading.h"
#include "opensim/writing.h"

// The element FisherHill: the time step and the starts of trials that a model was fitted with.

namespace bio::osim {
namespace {

void mustBeOneOf(const Source& source, const Element& owner, const std::set<std::string>& known) {
  for (const Element* child : childrenOf(&owner)) {
    if (known.contains(child->Name())) continue;
    fail(source, owner,
         fmt::format("holds '{}', must hold nothing but {}", child->Name(), fmt::join(known, ", ")),
         child);
  }
}

TrialStart readStart(const Reading& reading, const Element& element) {
  const Source& source = reading.source;
  mustBeOneOf(source, element, {"coordinate", "file", "sha256", "speed", "value"});
  TrialStart start;
  start.file = readText(source, element, "file", "");
  start.sha256 = readText(source, element, "sha256");
  const bool isDigest = start.sha256.size() == 64 &&
                        start.sha256.find_first_not_of("0123456789abcdef") == std::string::npos;
  if (!isDigest) {
    fail(source, element,
         fmt::format("sha256 = '{}', must be 64 lower-case hexadecimal digits", start.sha256),
         element.FirstChildElement("sha256"));
  }
  start.coordinate = readCoordinateName(reading, element, "coordinate");
  start.value = readNumber(source, element, "value", "", Rule::finite);
  start.speed = readNumber(source, element, "speed", "", Rule::finite, 0);
  return start;
}

}  // namespace

void readFitted(Reading& reading, const Element& model) {
  const Element* own = model.FirstChildElement("FisherHill");
  if (!own) return;
  if (const Element* second = own->NextSiblingElement("FisherHill")) {
    fail(reading.source, *second, "is there twice, must be there once");
  }
  mustBeOneOf(reading.source, *own, {"step_s", "trial_start"});
  FittedSimulation& fitted = reading.model.fitted;
  if (own->FirstChildElement("step_s"))
    fitted.step = readNumber(reading.source, *own, "step_s", "s", Rule::positive);
  for (auto one = own->FirstChildElement("trial_start"); one;
       one = one->NextSiblingElement("trial_start")) {
    TrialStart start = readStart(reading, *one);
    const bool isKnown =
        std::any_of(fitted.starts.begin(), fitted.starts.end(), [&](const TrialStart& other) {
          return other.sha256 == start.sha256 && other.coordinate == start.coordinate;
        });
    if (isKnown) {
      fail(
          reading.source, *one,
          fmt::format("coordinate '{}' of the trial with this sha256 has two starts, must have one",
                      start.coordinate));
    }
    fitted.starts.push_back(std::move(start));
  }
}

void appendFitted(const Writing& writing, Element& model) {
  const FittedSimulation& fitted = writing.model.fitted;
  if (fitted.empty()) return;
  Element& own = append(model, "FisherHill");
  if (fitted.step) appendNumber(own, "step_s", *fitted.step);
  for (const TrialStart& start : fitted.starts) {
    Element& element = append(own, "trial_start");
    appendText(element, "file", start.file);
    appendText(element, "sha256", start.sha256);
    appendText(element, "coordinate", start.coordinate);
    appendNumber(element, "value", start.value);
    appendNumber(element, "speed", start.speed);
  }
}

}  // namespace bio::osim
