#include "ensemble/missing_rows.h"

#include <fmt/format.h>

#include <filesystem>

#include "output/interruption.h"
#include "output/progress_bar.h"
#include "output/standard_streams.h"

namespace app {

CommandContext mayGoOn(CommandContext context) {
  if (context.out && std::filesystem::exists(*context.out / unfinishedRows)) context.force = true;
  return context;
}

std::string damageIn(const RowFile& file) {
  if (file.damaged() == 0) return "";
  return fmt::format("{}: {} damaged row{} recomputed", unfinishedRows, file.damaged(),
                     file.damaged() == 1 ? "" : "s");
}

std::size_t computeMissing(WorkerPool& pool, int threads, RowFile& file, std::uint64_t total,
                           RowWork work, const CommandContext& context, const std::string& things) {
  file.expect(total);
  for (std::uint64_t number = 0; number < total; ++number) {
    if (!file.contains(number)) work.numbers.add(number);
  }
  const std::size_t missing = work.numbers.size();
  std::uint64_t done = total - missing;
  ProgressBar bar("ensemble");
  work.take = [&](std::uint64_t number, const std::string& text) {
    file.append(number, text);
    bar.update(static_cast<double>(++done) / static_cast<double>(total));
  };
  try {
    pool.start();
    pool.work(work, threads);
  } catch (const Interrupted&) {
    if (context.out) {
      tell(fmt::format(
          "fisherhill {}: {} of {} {} are done; run the same command again to continue\n",
          context.subcommand, done, total, things));
    }
    throw;
  }
  return missing;
}

}  // namespace app
