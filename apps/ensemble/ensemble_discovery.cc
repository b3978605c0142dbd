#include "ensemble/ensemble_discovery.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <map>

#include "ensemble/ensemble_methods.h"
#include "ensemble/missing_rows.h"
#include "info/version.h"
#include "options/set_parameters.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/json_text.h"
#include "report/result.h"

namespace app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct DataSet {
  std::string name;
  std::vector<std::string> training, heldOut;
};

const std::vector<std::string>& verdictColumns() {
  static const std::vector<std::string> names = {"number",
                                                 "set",
                                                 "verdict",
                                                 "effects",
                                                 "probability",
                                                 "gap_closed_train",
                                                 "gap_closed_held_out"};
  return names;
}

std::vector<DataSet> dataSetsIn(const fs::path& folder) {
  std::vector<DataSet> sets;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!entry.is_directory()) continue;
    DataSet set{entry.path().filename().string(), {}, {}};
    for (const auto& file : fs::directory_iterator(entry.path())) {
      const std::string name = file.path().filename().string();
      if (!name.ends_with(".sto")) continue;
      if (name.starts_with("train_")) set.training.push_back(file.path().string());
      if (name.starts_with("held_out")) set.heldOut.push_back(file.path().string());
    }
    if (set.training.empty()) continue;
    if (set.name.find_first_of(",\n\"") != set.name.npos) {
      throw std::invalid_argument(fmt::format(
          "--discover {}: the name of folder '{}' must be without comma, quote or line break",
          folder.string(), set.name));
    }
    std::sort(set.training.begin(), set.training.end());
    std::sort(set.heldOut.begin(), set.heldOut.end());
    sets.push_back(std::move(set));
  }
  if (sets.empty()) {
    throw std::invalid_argument(
        fmt::format("--discover {}: no subfolder has files train_*.sto, must have at least one",
                    folder.string()));
  }
  std::sort(sets.begin(), sets.end(),
            [](const DataSet& a, const DataSet& b) { return a.name < b.name; });
  return sets;
}

/// Every file is read once before anything long begins; all become inputs of the summary.
void checkSets(ModelDiscoveryRequest& each, const std::vector<DataSet>& sets, Summary& summary) {
  bio::Model model = readModel(each.model, summary);
  std::vector<std::string> training;
  for (const DataSet& set : sets)
    training.insert(training.end(), set.training.begin(), set.training.end());
  chooseCoordinates(each.simulation, model, training);
  model = withSetParameters(std::move(model), each.simulation, summary);
  (void)movableSystem(model, each.model, each.simulation, summary);
  for (const DataSet& set : sets) {
    for (const auto* files : {&set.training, &set.heldOut}) {
      for (const std::string& file : *files) {
        summary.addInput(file);
        (void)readTrialFile(file, model, each.simulation, {.experimentalConditions = true});
      }
    }
  }
}

Json discoverySettings(const ModelDiscoveryRequest& each, const Summary& summary) {
  Json json;
  json["program"] = "fisherhill ensemble --discover";
  json["version"] = info::version();
  json["noise"] = each.noise ? Json(*each.noise) : Json();
  json["without"] = each.without;
  json["max_effects"] = each.maxEffects;
  json["input_scatter"] = each.inputScatter ? Json(*each.inputScatter) : Json();
  json["simulation"] = settingsOf(each.simulation);
  json["inputs"] = Json::array();
  for (const Summary::InputFile& input : summary.inputs()) {
    json["inputs"].push_back({fs::path(input.path).filename().string(), input.sha256});
  }
  return json;
}

std::string verdictRow(const DataSet& set, const Json& verdict) {
  std::vector<std::string> ids;
  for (const Json& effect : verdict.at("effects")) ids.push_back(effect.at("id"));
  const auto closed = [&](const char* which) {
    const Json& gap = verdict.at("gap").at(which);
    return gap.is_object() ? numberCell(gap.at("gap_closed")) : std::string();
  };
  const Json& effects = verdict.at("effects");
  return fmt::format("{},{},{},{},{},{}", set.name, verdict.at("verdict").get<std::string>(),
                     fmt::join(ids, "+"),
                     effects.empty() ? "" : numberCell(effects.front().at("probability")),
                     closed("train"), closed("held_out"));
}

Report discoveryReport(const std::vector<std::vector<std::string>>& rows, const std::string& model,
                       const std::map<std::string, int>& counts) {
  std::vector<std::string> parts;
  for (const auto& [verdict, count] : counts) parts.push_back(fmt::format("{} {}", count, verdict));
  Report report{
      .title = fmt::format("Missing effects of {} in {} data sets", model, rows.size()),
      .verdict = fmt::format("Of {} data sets: {}.", rows.size(), fmt::join(parts, ", "))};
  Table table{.title = "",
              .columns = {"set", "verdict", "effects", "probability", "excess error explained",
                          "excess error explained, held out"},
              .rows = rows};
  report.details = {
      Section{"Verdicts",
              "What discover found in each data set; the excess error explained is 1 where the "
              "effects leave only noise."},
      table, Paragraph{"verdicts/NAME/report.html explains each verdict."}};
  return report;
}

}  // namespace

ExitStatus discoverInSets(ModelDiscoveryRequest each, const fs::path& folder,
                          const CommandContext& context, WorkerPool& pool, int threads) {
  const std::vector<DataSet> sets = dataSetsIn(folder);
  RowWork work;
  work.rows = [&](std::span<const std::uint64_t> numbers) {  // one at a time
    const DataSet& set = sets[numbers.front()];
    ModelDiscoveryRequest request = each;
    request.trials = set.training;
    request.heldOut = set.heldOut;
    request.plays = false;  // every set has a report: half a megabyte more each
    CommandContext one = context;
    one.quiet = true;
    one.figures.reset();
    one.force = true;  // what a killed run has left there is made anew
    one.out = *context.out / "verdicts" / set.name;
    return std::vector{verdictRow(set, discoverInModel(request, one).verdict)};
  };
  if (!pool.leads()) {
    pool.work(work, threads);
    return ExitStatus::done;
  }
  OutputFolder results(mayGoOn(context), {"verdicts.csv"});
  Summary summary(context);
  checkSets(each, sets, summary);
  RowFile file(results.path(unfinishedRows), discoverySettings(each, summary), verdictColumns(),
               context.force);
  if (const std::string damage = damageIn(file); !damage.empty()) summary.warn(damage);
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t computed =
      computeMissing(pool, threads, file, sets.size(), work, context, "data sets");
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  std::vector<std::vector<std::string>> rows;
  std::map<std::string, int> counts;
  results.write("verdicts.csv", [&](std::ostream& out) {
    const auto& columns = verdictColumns();
    out << fmt::format("{}\n", fmt::join(columns.begin() + 1, columns.end(), ","));
    for (std::size_t i = 0; i < sets.size(); ++i) out << file.row(i) << '\n';
  });
  for (std::size_t i = 0; i < sets.size(); ++i) {
    rows.push_back(cellsOf(file.row(i)));
    ++counts[rows.back()[1]];
  }
  summary.setSimulation(each.simulation.integrator, each.simulation.stepOrDefault(), 0, wall);
  sayDiscoveryInSets(each, sets.size(), summary.methods());
  summary.set("sets", sets.size());
  summary.set("computed", computed);
  summary.set("ranks", pool.ranks());
  summary.set("verdicts", counts);
  deliver(context, summary, discoveryReport(rows, each.model, counts), results);
  file.remove();
  return ExitStatus::done;
}

}  // namespace app
