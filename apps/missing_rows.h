#pragma once

#include <functional>
#include <string>

#include "crew.h"
#include "row_file.h"

namespace app {

/// Where rows are kept in the folder of results until all are there.
inline constexpr const char* unfinishedRows = "unfinished.csv";

/// How the folder of results is to be opened: results beside unfinished rows are of a run that was
/// killed while it gave them their names, so they may be overwritten. Whether those rows are of the
/// same settings is RowFile's to say, before anything is written.
CommandContext mayGoOn(CommandContext context);

/// The sentence that damaged rows are computed again; empty if none is.
std::string damageIn(const RowFile& file);

/// Has a crew compute the rows 0 … total − 1 that a file lacks, with a bar; every row is in the
/// file as soon as it is finished. After Ctrl-C it says how to go on.
/// @param things  what a row stands for, "simulations"
/// @param work    its rows, and how many are best computed at once; the rest of it is set here
/// @return how many were computed
/// @throws Interrupted, and what `work.rows` and RowFile::append throw
std::size_t computeMissing(Crew& crew, int threads, RowFile& file, std::uint64_t total,
                           RowWork work, const CommandContext& context, const std::string& things);

}  // namespace app
