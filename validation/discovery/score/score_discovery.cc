// Compares verdicts with labels and prints the benchmark's table.
//
//     score_discovery --labels DIR --verdicts DIR [--repaired DIR] [--as-suite NAME] [--json FILE]
//
// --repaired: verdicts on the models repaired with what was found, for a table of every set.
// --as-suite: judges every set as one of this suite: "out" where the true effect was left out of
// the catalogue. Exit status 1 if a target with data is missed, 2 for wrong use or a file that
// cannot be read.

#include <fmt/format.h>

#include <fstream>

#include "generator/arguments.h"
#include "score/discovery_score.h"
#include "score/hard_suites.h"
#include "score/recovery.h"
#include "score/repaired_table.h"

int main(int argc, char** argv) {
  try {
    const hidden::Arguments arguments(argc, argv,
                                      {"labels", "verdicts", "repaired", "as-suite", "json"});
    if (!arguments.has("labels") || !arguments.has("verdicts")) {
      throw std::invalid_argument("--labels and --verdicts are needed");
    }
    auto outcomes = hidden::readOutcomes(arguments.text("labels"), arguments.text("verdicts"));
    if (arguments.has("as-suite"))
      for (auto& outcome : outcomes) outcome.suite = arguments.text("as-suite");
    const std::string hard = hidden::hardTable(outcomes);
    const auto hardJson = hidden::hardJson(outcomes);
    // these have no part in the tables that the targets are about
    std::erase_if(outcomes, hidden::isHard);
    const auto score = hidden::score(outcomes);
    fmt::print("{}\n{}{}", score.asMarkdown(), hidden::recoveryTable(outcomes), hard);
    if (arguments.has("repaired"))
      fmt::print("\n{}", hidden::repairedTable(arguments.text("labels"), arguments.text("verdicts"),
                                               arguments.text("repaired")));
    if (arguments.has("json")) {
      std::ofstream stream(arguments.text("json"));
      auto json = score.asJson();
      json["hard_suites"] = hardJson;
      stream << json.dump(2) << '\n';
      stream.close();
      if (!stream) throw std::runtime_error(arguments.text("json") + ": cannot be written");
    }
    bool missed = false;
    for (const auto& row : score.rows)
      missed = missed || (row.n > 0 && row.target != "–" && !row.met);
    for (const auto& spread : score.spreads)
      missed = missed || (!spread.values.empty() && !spread.met);
    return missed ? 1 : 0;
  } catch (const std::exception& e) {
    fmt::print(stderr, "score_discovery: {}\n", e.what());
    return 2;
  }
}
