// Makes a data set of the blind benchmark: trials of a robot in which something may be hidden, and
// a label that only the scorer opens.
//
//     make_hidden_robot --system double-pendulum|suspended-mass --seed N
//         --suite null|single|parameter|two|out [--effect ID[,ID]] [--size S] [--input-noise SD]
//         [--nuisances SHARE] [--seconds S] --out DIR --labels DIR
//     make_hidden_robot --list
//
// Exit status 2 for wrong use, 1 if no data set could be made.

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "generator/arguments.h"
#include "robots/hidden_robots.h"

namespace {

int make(const hidden::Arguments& arguments) {
  hidden::RobotPlan plan;
  for (const char* needed : {"system", "out", "labels"})
    if (!arguments.has(needed)) throw std::invalid_argument(fmt::format("--{} is needed", needed));
  plan.system = arguments.text("system");
  const double seed = arguments.number("seed", 0);
  if (!(seed >= 0 && seed == std::floor(seed)))
    throw std::invalid_argument("--seed must be a whole number, 0 or more");
  plan.seed = static_cast<std::uint64_t>(seed);
  plan.suite = arguments.text("suite", "single");
  std::istringstream ids(arguments.text("effect"));
  for (std::string id; std::getline(ids, id, ',');) plan.effects.push_back(id);
  plan.size = arguments.number("size", 1);
  plan.inputNoise = arguments.number("input-noise", 0);
  if (!(plan.inputNoise >= 0 && plan.inputNoise <= 1))
    throw std::invalid_argument("--input-noise must be 0 to 1 m/s²");
  plan.nuisances = arguments.number("nuisances", 1);
  plan.seconds = arguments.number("seconds", 5);
  if (!(plan.seconds >= 2 && plan.seconds <= 60))
    throw std::invalid_argument("--seconds must be 2 to 60");
  const std::filesystem::path folder = arguments.text("out");
  hidden::chosenEffects(plan);  // wrong use is found before work begins
  hidden::writeRobotDataSet(hidden::makeRobotDataSet(plan), hidden::robotKind(plan.system),
                            folder.has_filename() ? folder : folder.parent_path(),
                            arguments.text("labels"));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return hidden::statusOf("make_hidden_robot", [&] {
    const hidden::Arguments arguments(argc, argv,
                                      {"system", "seed", "suite", "effect", "size", "input-noise",
                                       "nuisances", "seconds", "out", "labels"},
                                      {"list"});
    if (arguments.has("list")) {
      fmt::print("{}", hidden::robotEffectsAsMarkdown());
      return 0;
    }
    return make(arguments);
  });
}
