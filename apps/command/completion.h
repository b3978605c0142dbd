#pragma once

#include <string>

#include "command/described_commands.h"

namespace app {

/// A file that bash sources (share/bash-completion/completions/fisherhill): subcommands, their
/// options, and values that are one of a few words, files or folders. Requires bash ≥ 4 only.
std::string bashCompletion(const DescribedCommand& program);

/// Completion for zsh, as a function of its fpath (share/zsh/site-functions/_fisherhill), with a
/// description of each option.
std::string zshCompletion(const DescribedCommand& program);

}  // namespace app
