#include "score/hard_suites.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace hidden {
namespace {

/// A lag or a drift is in the catalogue itself: to name it, beside what is hidden or alone, is
/// right.
bool namesTheViolation(const Outcome& o) {
  if (o.violation != "lag" && o.violation != "drift") return false;
  const auto isThere = [&](const std::string& id) {
    return id == o.violation || std::find(o.truth.begin(), o.truth.end(), id) != o.truth.end();
  };
  return !o.named.empty() && std::all_of(o.named.begin(), o.named.end(), isThere);
}

void count(HardRow& row, const Outcome& o) {
  ++row.sets;
  const bool isRight = namesTheViolation(o);
  const bool alarm = o.hides == "null" && !isRight && (o.claims || !o.hasVerdict);
  const bool structure = o.hides == "parameter" && !isRight && (o.namesStructure || !o.hasVerdict);
  row.nothing += o.hides == "null";
  row.alarms += alarm;
  row.parameters += o.hides == "parameter";
  row.structures += structure;
  row.effects += o.hides != "null";
  row.right += o.hides != "null" && o.firstIsRight;
  const bool confidentlyWrong = o.confidentlyWrong() && !isRight;
  row.confidentlyWrong += confidentlyWrong;
  if (alarm || structure || confidentlyWrong) row.wrong.push_back(describe(o));
}

std::string share(int k, int n) {
  if (n == 0) return "–";
  const Interval i = wilson(k, n);
  return fmt::format("{} of {} ({:.0f}–{:.0f} %)", k, n, 100 * i.low, 100 * i.high);
}

}  // namespace

bool isHard(const Outcome& outcome) {
  return outcome.suite == "far" || outcome.suite == "violated";
}

std::vector<HardRow> hardRows(const std::vector<Outcome>& outcomes) {
  HardRow far{.kind = "far", .wrong = {}}, all{.kind = "violated", .wrong = {}};
  std::map<std::string, HardRow> kinds;
  for (const Outcome& o : outcomes) {
    if (o.suite == "far") count(far, o);
    if (o.suite != "violated") continue;
    HardRow& row = kinds[o.violation];
    row.kind = o.violation;
    count(row, o);
    count(all, o);
  }
  std::vector<HardRow> rows;
  if (far.sets > 0) rows.push_back(far);
  for (const auto& [kind, row] : kinds) rows.push_back(row);
  if (all.sets > 0) rows.push_back(all);
  return rows;
}

std::string hardTable(const std::vector<Outcome>& outcomes) {
  const auto rows = hardRows(outcomes);
  if (rows.empty()) return {};
  std::string text =
      "\nHard suites: people and trials far from the nominal model, and data that break an "
      "assumption\n\n"
      "| kind | sets | confidently wrong | false names, nothing hidden | structure named, a "
      "parameter hidden | right name first |\n|---|---|---|---|---|---|\n";
  for (const HardRow& r : rows) {
    text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", r.kind, r.sets,
                        share(r.confidentlyWrong, r.sets), share(r.alarms, r.nothing),
                        share(r.structures, r.parameters), share(r.right, r.effects));
  }
  std::string misses;
  for (const HardRow& r : rows) {
    if (r.kind == "violated") continue;  // its kinds have told them
    for (const std::string& wrong : r.wrong) misses += fmt::format("- {}: {}\n", r.kind, wrong);
  }
  return misses.empty() ? text : text + "\nWrong of these\n\n" + misses;
}

Json hardJson(const std::vector<Outcome>& outcomes) {
  Json json = Json::array();
  for (const HardRow& r : hardRows(outcomes)) {
    json.push_back({{"kind", r.kind},
                    {"sets", r.sets},
                    {"confidently_wrong", r.confidentlyWrong},
                    {"null_sets", r.nothing},
                    {"false_alarms", r.alarms},
                    {"parameter_sets", r.parameters},
                    {"structure_named", r.structures},
                    {"hidden_sets", r.effects},
                    {"right_name_first", r.right},
                    {"wrong", r.wrong}});
  }
  return json;
}

}  // namespace hidden
