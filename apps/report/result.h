#pragma once

#include "output/command_context.h"
#include "output/output_folder.h"
#include "output/summary.h"
#include "report/report.h"

namespace app {

/// The last step of every subcommand: writes summary.json, report.html, reproduce.sh and what
/// --figures asks for, gives all files their
/// final names, and prints the verdict, the summary's values and the path of the report or, with
/// --json, only the summary.
void deliver(const CommandContext& context, const Summary& summary, const Report& report,
             OutputFolder& folder);

}  // namespace app
