#include "options/model_methods.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>

#include "output/text.h"

namespace app {
namespace {

std::optional<Publication> publicationOfClass(const std::string& className) {
  if (className.starts_with("Schutte")) return Publication::schutte1993;
  if (className.starts_with("Thelen")) return Publication::thelen2003;
  if (className.starts_with("Millard")) return Publication::millard2013;
  if (className.starts_with("DeGroote")) return Publication::deGroote2016;
  return {};
}

}  // namespace

void sayModel(const bio::Model& model, const bio::MusculoskeletalSystem& system, Methods& methods) {
  using Part = Methods::Part;
  std::vector<std::string> free, prescribed;
  const auto& coordinates = system.skeleton().coordinates();
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    (system.isPrescribed(static_cast<int>(i)) ? prescribed : free).push_back(coordinates[i].name);
  std::string sentence = free.empty() ? std::string("No coordinate is free")
                                      : fmt::format("The model moves in {}", fmt::join(free, ", "));
  if (!prescribed.empty())
    sentence += fmt::format("; the motion of {} is prescribed", fmt::join(prescribed, ", "));
  methods.say(Part::model, sentence + "; all other coordinates are locked.");

  std::map<std::string, int> classes;
  std::vector<std::string> muscles;
  for (const bio::SystemMuscle& muscle : system.muscles()) {
    muscles.push_back(muscle.name);
    const auto found =
        std::find_if(model.muscles.begin(), model.muscles.end(),
                     [&](const bio::Muscle& one) { return one.name == muscle.name; });
    if (found == model.muscles.end()) continue;
    ++classes[found->className];
  }
  for (const auto& [className, count] : classes) {
    const std::optional<Publication> source = publicationOfClass(className);
    methods.say(Part::model,
                fmt::format("{} {} of OpenSim's class {}{}.", count,
                            count == 1 ? "muscle is" : "muscles are", className,
                            source ? " (" + citation(*source) + ")" : ""),
                source ? std::vector{*source} : std::vector<Publication>{});
  }
  sayPaths(model, muscles, methods);
  methods.assume(
      "Segments are rigid, and nothing touches them but the loads that model and trial name.");
}

void sayPaths(const bio::Model& model, const std::vector<std::string>& muscles, Methods& methods) {
  std::size_t functions = 0;
  bool wraps = false;
  for (const bio::Muscle& muscle : model.muscles) {
    if (std::find(muscles.begin(), muscles.end(), muscle.name) == muscles.end()) continue;
    if (muscle.path.function) ++functions;
    wraps = wraps || !muscle.path.wraps.empty();
  }
  if (wraps) {
    methods.say(Methods::Part::model,
                "Muscle paths are the shortest ones round the model's wrap surfaces and slide "
                "without friction.");
  } else if (functions < muscles.size()) {
    methods.say(Methods::Part::model, "Muscle paths are straight between their points.");
  }
  if (functions > 0) {
    methods.say(
        Methods::Part::model,
        fmt::format("The {} a function of the coordinates that the model's file gives.",
                    functions == 1 ? std::string("length of one muscle is")
                                   : fmt::format("length of each of {} muscles is", functions)));
  }
}

void sayCylinders(const std::vector<std::string>& wrapAsCylinder, Methods& methods) {
  if (wrapAsCylinder.empty()) return;
  methods.say(Methods::Part::model,
              fmt::format("{} {} taken as {}.", listed(wrapAsCylinder),
                          wrapAsCylinder.size() == 1 ? "is an ellipsoid that was"
                                                     : "are ellipsoids that were",
                          wrapAsCylinder.size() == 1 ? "a cylinder" : "cylinders"));
}

void sayExcitations(const bio::MusculoskeletalSystem& system, Methods& methods) {
  if (system.numMuscles() == 0) return;
  methods.say(
      Methods::Part::data,
      "Recorded excitations, linear between samples, drive the muscles; unless model or trial give "
      "an initial state, activations begin at the first excitation and fibres in static "
      "equilibrium.");
  methods.assume(
      "The excitations are those that the muscles received: EMG, its normalisation and its mapping "
      "to muscles are taken as exact unless a parameter or an effect says otherwise.");
}

}  // namespace app
