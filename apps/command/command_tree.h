#pragma once

#include <nlohmann/json.hpp>

#include "command/described_commands.h"

namespace app {

/// The program and its subcommands as JSON, for documents and checks that are made from the command
/// line itself: `name`, `purpose`, `example`, `arguments`, `options` (`names`, `value`,
/// `description`, `group`, `default`, `choices`, `required`, `repeats`) and `subcommands`.
nlohmann::ordered_json commandTree(const DescribedCommand& command);

}  // namespace app
