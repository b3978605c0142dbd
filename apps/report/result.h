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

/// deliver() for a subcommand whose report is a page of its own.
/// @param verdict  one sentence or two
/// @param page     HTML
void deliverPage(const CommandContext& context, const Summary& summary, const std::string& verdict,
                 const std::string& page, OutputFolder& folder);

}  // namespace app
