#include <fmt/format.h>

#include <variant>

#include "arguments/columns.h"
#include "arguments/file_name.h"
#include "bio/tables/different_trials.h"
#include "bio/tables/table_file.h"
#include "discovery/verdict.h"
#include "docstrings.h"
#include "interruptible.h"
#include "robots/robot_discovery.h"
#include "robots/robot_recording.h"
#include "robots/robots.h"
#include "systems.h"
#include "trials/trials.h"

namespace python {
namespace {

using info::robot::KnownEffect;

/// A file, or columns as make_trial takes them.
using RobotTrial = std::variant<FileName, py::object>;

/// Trials as they are given, and by what they are known.
struct RobotTrials {
  std::vector<info::robot::Trial> trials;
  std::vector<bio::TrialIdentity> identities;
  std::vector<std::string> warnings;  ///< columns that were ignored
};

void addTrial(const RobotTrial& given, const std::vector<info::robot::Channel>& channels,
              bool ignoreExtra, RobotTrials& all) {
  const auto* file = std::get_if<FileName>(&given);
  const std::string name = file ? file->text : fmt::format("trial {}", all.trials.size() + 1);
  const bio::Table table = file ? bio::readTable(name) : tableOf(std::get<py::object>(given), name);
  all.trials.push_back(info::robot::recordingOf(
      {name, table.columns, table.values, table.inDegrees}, channels,
      [&](const std::string& column) {
        const std::string what = fmt::format("{}: column {} is unknown", name, column);
        if (!ignoreExtra) throw std::invalid_argument(what + "; ignore_extra=True ignores it");
        all.warnings.push_back(what + " and ignored");
      }));
  const auto size = sizeof(double) * static_cast<std::size_t>(table.values.size());
  all.identities.push_back(
      {name, digestOf(py::bytes(reinterpret_cast<const char*>(table.values.data()), size))});
}

/// @param member  (object, name) ↦ the member of an effect or of a parameter
template <class Member>
std::vector<KnownEffect> effectsFrom(const py::iterable& effects, const Member& member) {
  std::vector<KnownEffect> known;
  for (const auto& effect : effects) {
    KnownEffect& one = known.emplace_back();
    one.id = member(effect, "id").template cast<std::string>();
    const auto parameters = member(effect, "parameters").template cast<py::dict>();
    for (const auto& [name, parameter] : parameters)
      one.values[name.template cast<std::string>()] =
          member(parameter, "value").template cast<double>();
  }
  return known;
}

/// From a with_effect.json.
std::vector<KnownEffect> effectsIn(const std::string& file, const std::string& system) {
  try {
    const auto path = py::module_::import("pathlib").attr("Path")(file);
    const py::object json =
        py::module_::import("json").attr("loads")(path.attr("read_text")("encoding"_a = "utf-8"));
    const auto ofSystem = json["system"].cast<std::string>();
    if (ofSystem != system)
      throw std::invalid_argument(fmt::format("system is {}, must be {}", ofSystem, system));
    return effectsFrom(json["effects"], [](const py::handle& object, const char* name) {
      return py::object(object[name]);
    });
  } catch (const py::error_already_set& error) {
    throw std::invalid_argument(
        fmt::format("{}: {}", file, py::str(error.value()).cast<std::string>()));
  } catch (const std::exception& error) {
    throw std::invalid_argument(fmt::format("{}: {}", file, error.what()));
  }
}

std::vector<KnownEffect> knownEffectsOf(const py::object& given, const std::string& system) {
  if (given.is_none()) return {};
  if (py::isinstance<py::str>(given) || py::hasattr(given, "__fspath__")) {
    return effectsIn(given.cast<FileName>().text, system);
  }
  return effectsFrom(given.cast<py::iterable>(), [](const py::handle& object, const char* name) {
    return py::object(object.attr(name));
  });
}

py::object discoverRobot(const std::string& system, std::vector<RobotTrial> trials,
                         const std::vector<RobotTrial>& holdOut, const py::object& withEffects,
                         const std::optional<std::variant<double, std::vector<double>>>& noise,
                         const std::vector<std::string>& without, int maxEffects,
                         std::optional<double> step, std::optional<double> inputScatter,
                         bool ignoreExtra, const py::object& progress) {
  const std::vector<info::robot::Channel> channels = info::robot::channelsOf(system);
  if (trials.empty()) throw std::invalid_argument("trials: empty, must hold at least one");
  trials.insert(trials.end(), holdOut.begin(), holdOut.end());
  info::robot::DiscoveryRequest asked;
  RobotTrials all;
  for (const RobotTrial& trial : trials) addTrial(trial, channels, ignoreExtra, all);
  bio::requireDifferentTrials(all.identities, trials.size() - holdOut.size());
  asked.trials = std::move(all.trials);
  asked.numHeldOut = holdOut.size();
  asked.model = info::robot::modelFor(system, asked.trials);
  const std::vector<std::string> present =
      info::robot::buildIn(knownEffectsOf(withEffects, system), asked.model);
  if (step && !(*step > 0))
    throw std::invalid_argument(fmt::format("step = {} s, must be > 0", *step));
  asked.step = step;
  asked.problem.without = without;
  if (noise)
    asked.problem.sds = std::holds_alternative<double>(*noise)
                            ? std::vector<double>{std::get<double>(*noise)}
                            : std::get<std::vector<double>>(*noise);
  asked.search = searchOptions(maxEffects, inputScatter);
  info::robot::DiscoveryResult result;
  interruptible({progress, "discover_robot"}, [&](const auto& goOn, auto& done) {
    asked.search.goOn = [&] { return goOn.load(); };
    asked.search.progress = [&](const info::discover::Progress& at) {
      return noting(goOn, done)(at.fraction);
    };
    result = info::robot::discover(asked);
  });
  const info::robot::RobotProblem& data = *result.data;
  py::list effects;
  for (const auto& effect : result.found.verdict.effects)
    effects.append(results(**effectMembers(data, effect)));
  py::dict noises;
  for (std::size_t c = 0; c < channels.size(); ++c)
    noises[channels[c].name.c_str()] = data.sds()[c];
  return tableResult("RobotDiscoveryResult", **verdictMembers(data, result.found, result.fitted),
                     "effects"_a = effects, "noise"_a = noises, "already_in_the_model"_a = present,
                     "warnings"_a = all.warnings);
}

}  // namespace

void defineRobotDiscovery(py::module_& module) {
  module.def("discover_robot", &discoverRobot, "system"_a, "trials"_a, py::kw_only(),
             "hold_out"_a = std::vector<RobotTrial>(), "with_effects"_a = py::none(),
             "noise"_a = py::none(), "without"_a = std::vector<std::string>(), "max_effects"_a = 3,
             "step"_a = py::none(), "input_scatter"_a = py::none(), "ignore_extra"_a = false,
             "progress"_a = false, docstrings::discover_robot);
}

}  // namespace python
