#pragma once

#include "command_context.h"
#include "output_folder.h"
#include "report.h"
#include "summary.h"

namespace app {

/// The last step of every subcommand: writes summary.json and report.html, gives all files their
/// final names, and prints the verdict, the summary's values and the path of the report or, with
/// --json, only the summary.
void deliver(const CommandContext& context, const Summary& summary, const Report& report,
             OutputFolder& folder);

}  // namespace app
