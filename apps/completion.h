#pragma once

#include <string>

#include "described_commands.h"

namespace app {

/// A file that bash sources (share/bash-completion/completions/fisherhill): subcommands, their
/// options, and values where these are few words, files or folders. Needs nothing but bash ≥ 4.
std::string bashCompletion(const DescribedCommand& program);

/// The same for zsh, as a function of its fpath (share/zsh/site-functions/_fisherhill), with what
/// each option means beside it.
std::string zshCompletion(const DescribedCommand& program);

}  // namespace app
