#pragma once

#include "command_context.h"
#include "output_folder.h"
#include "report.h"
#include "summary.h"

namespace app {

/// The last step of every subcommand: writes summary.json and report.html, gives all files their
/// names, and tells the user the verdict, the figures and where the report is – or, with --json,
/// prints the summary alone.
void deliver(const CommandContext& context, const Summary& summary, const Report& report,
             OutputFolder& folder);

}  // namespace app
