#pragma once

#include <functional>
#include <string>

#include "ensemble/worker_pool.h"
#include "output/resumable_table.h"

namespace app {

/// Name of the file that keeps rows in the folder of results until all are finished.
inline constexpr const char* unfinishedRows = "unfinished.csv";

/// The context with which to open the folder of results. Results beside unfinished rows come from a
/// run that was killed while renaming its files, so they may be overwritten. RowFile checks whether
/// the rows have the same settings before anything is written.
CommandContext mayGoOn(CommandContext context);

/// The warning that damaged rows are recomputed; empty if there are none.
std::string damageIn(const RowFile& file);

/// Computes the rows 0 … total − 1 that a file lacks, with a progress bar; every row is in the file
/// as soon as it is finished. After Ctrl-C it prints how to continue.
/// @param things name of the rows, e.g. "simulations"
/// @param work the function that computes rows, and how many are best computed at once; the rest is
///   set here
/// @return number of rows computed
/// @throws Interrupted, and what `work.rows` and RowFile::append throw
std::size_t computeMissing(WorkerPool& pool, int threads, RowFile& file, std::uint64_t total,
                           RowWork work, const CommandContext& context, const std::string& things);

}  // namespace app
