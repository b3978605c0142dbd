// Makes a data set of the blind benchmark: trials of an elbow in which something may be hidden, and
// a label that only the scorer opens.
//
//     make_hidden_elbow --seed N --suite null|single|parameter|two|out|equivalents|far|violated
//         [--effect ID[,ID]] [--violation ID] [--size S] [--emg-noise C] [--nuisances SHARE]
//         --model MODEL.osim --out DIR --labels DIR
//     make_hidden_elbow --list
//
// Exit status 2 for wrong use, 1 if no data set could be made.

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "generator/arguments.h"
#include "generator/data_set.h"

namespace {

int make(const hidden::Arguments& arguments) {
  hidden::DataSetPlan plan;
  const double seed = arguments.number("seed", 0);
  if (!(seed >= 0 && seed == std::floor(seed))) {
    throw std::invalid_argument("--seed must be a whole number, 0 or more");
  }
  plan.seed = static_cast<std::uint64_t>(seed);
  plan.suite = arguments.text("suite", "single");
  std::istringstream ids(arguments.text("effect"));
  for (std::string id; std::getline(ids, id, ',');) plan.effects.push_back(id);
  plan.size = arguments.number("size", 1);
  plan.emgNoise = arguments.number("emg-noise", 0);
  if (!(plan.emgNoise >= 0 && plan.emgNoise <= 0.3)) {
    throw std::invalid_argument("--emg-noise must be 0 to 0.3");
  }
  plan.nuisances = arguments.number("nuisances", 1);
  for (const char* needed : {"out", "labels", "model"}) {
    if (!arguments.has(needed)) {
      throw std::invalid_argument(fmt::format("--{} is needed", needed));
    }
  }
  const std::filesystem::path folder = arguments.text("out");
  plan.violation = arguments.text("violation");
  hidden::chosenEffects(plan);  // wrong use is found before work begins
  if (!plan.violation.empty() && plan.suite != "violated") {
    throw std::invalid_argument("--violation is for suite violated");
  }
  if (plan.suite == "violated") hidden::chosenViolation(plan);
  const auto nominal = hidden::readElbow(arguments.text("model"));
  const auto set = hidden::makeDataSet(nominal, plan);
  hidden::writeDataSet(set, arguments.text("model"),
                       folder.has_filename() ? folder : folder.parent_path(),
                       arguments.text("labels"));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return hidden::statusOf("make_hidden_elbow", [&] {
    const hidden::Arguments arguments(argc, argv,
                                      {"seed", "suite", "effect", "violation", "size", "emg-noise",
                                       "nuisances", "model", "out", "labels"},
                                      {"list"});
    if (arguments.has("list")) {
      fmt::print("{}", hidden::effectsAsMarkdown());
      return 0;
    }
    return make(arguments);
  });
}
