#pragma once

#include <string_view>

namespace app {

/// Opens /dev/null for those of standard input, output and error that were closed when the program
/// started, so that no file gets their descriptors. Must be called first.
void openStandardStreams();

/// Writes to standard error; failures are ignored.
void tell(std::string_view text);

}  // namespace app
