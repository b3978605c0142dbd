#include "output/summary.h"

#include <fmt/format.h>

#include "info/version.h"
#include "output/sha256.h"
#include "output/standard_streams.h"
#include "output/text.h"

namespace app {

Summary::Summary(const CommandContext& context) : context_(context) {}

void Summary::addInput(const std::filesystem::path& file) {
  inputs_.push_back({file.string(), sha256OfFile(file)});
}

void Summary::set(const std::string& name, nlohmann::ordered_json value) {
  figures_[name] = std::move(value);
}

void Summary::setSimulationFigures(const std::string& integrator, double step, double duration,
                                   double wallTime) {
  set("integrator", integrator);
  set("step_s", step);
  set("duration_s", duration);
  set("wall_s", wallTime);
}

void Summary::setSimulation(const std::string& integrator, double step, double duration,
                            double wallTime) {
  setSimulationFigures(integrator, step, duration, wallTime);
  saySimulation(integrator, step);
}

void Summary::saySimulation(const std::string& integrator, double step) {
  const std::string every = fmt::format(" of {} s", numberText(step));
  const auto say = [&](const std::string& sentence, Publication source) {
    methods_.say(Methods::Part::simulation, sentence, {source});
  };
  if (integrator == "vi" || integrator == "vi-left") {
    say(fmt::format(
            "Motions are simulated by a midpoint variational integrator ({}){} with a "
            "fixed step{}; the states of the muscles are solved implicitly within each step.",
            citation(Publication::wilson),
            integrator == "vi" ? ", the forces shared by both ends of a step,"
                               : ", the forces at the beginning of a step,",
            every),
        Publication::wilson);
  } else if (integrator == "vi-adaptive") {
    say(fmt::format("Motions are simulated by a midpoint variational integrator ({}), the forces "
                    "shared by both ends of a step, with steps{} and shorter ones where their "
                    "estimated errors ask for it; the states of the muscles are solved implicitly "
                    "within each step.",
                    citation(Publication::wilson), every),
        Publication::wilson);
  } else if (integrator == "cvode") {
    say(fmt::format("Motions are simulated by CVODE ({}) with a variable step, its values taken at "
                    "steps{}.",
                    citation(Publication::hindmarsh2005), every),
        Publication::hindmarsh2005);
  } else if (integrator == "rk4") {
    methods_.say(Methods::Part::simulation,
                 "Motions are simulated by the classical Runge–Kutta method of fourth order with a "
                 "fixed step" +
                     every + ".");
  }
}

void Summary::warn(const std::string& sentence) {
  warnings_.push_back(oneLine(sentence));
  if (context_.quiet) return;
  tell(fmt::format("fisherhill {}: warning: {}\n", context_.subcommand, warnings_.back()));
}

std::string Summary::commandLine() const {
  std::string line = "fisherhill";
  for (std::size_t i = 1; i < context_.commandLine.size(); ++i) {
    line += ' ';
    line += shellWord(context_.commandLine[i]);
  }
  return line;
}

nlohmann::ordered_json Summary::toJson() const {
  nlohmann::ordered_json json;
  json["program"] = "fisherhill";
  json["version"] = info::version();
  json["subcommand"] = context_.subcommand;
  json["command_line"] = commandLine();
  json["inputs"] = nlohmann::ordered_json::array();
  for (const InputFile& input : inputs_) {
    json["inputs"].push_back({{"path", input.path}, {"sha256", input.sha256}});
  }
  json["seed"] = context_.seed;
  json["warnings"] = warnings_;
  json.update(figures_);
  return json;
}

}  // namespace app
