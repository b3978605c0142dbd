#include "command/common_options.h"

#include <algorithm>
#include <thread>

#include "options/number_rules.h"

namespace app {

void addCommonOptions(CLI::App& subcommand, CommandContext& context) {
  context.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const std::string group = "Results and running";
  subcommand.add_option("--out", context.out, "folder for the results; created if missing")
      ->type_name("DIR")
      ->group(group);
  subcommand
      .add_option("--figures", context.figures,
                  "folder for the report's figures as SVG and PDF and its tables as CSV and LaTeX")
      ->type_name("DIR")
      ->group(group);
  subcommand.add_flag("--force", context.force, "overwrite an existing result")->group(group);
  subcommand.add_flag("--json", context.json, "print only the summary, as JSON")->group(group);
  subcommand.add_option("--seed", context.seed, "seed of the random numbers, ≥ 0")
      ->type_name("N")
      ->check(wholeNumber())
      ->capture_default_str()
      ->group(group);
  subcommand.add_option("--threads", context.threads, "number of threads; default: one per core")
      ->type_name("N")
      ->check(CLI::Range(1, 1024))
      ->group(group);
}

}  // namespace app
