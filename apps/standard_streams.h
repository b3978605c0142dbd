#pragma once

#include <string_view>

namespace app {

/// Opens /dev/null in place of standard input, output and error where the program was started with
/// them closed, so that no file it opens can be taken for one of them. To be called first.
void openStandardStreams();

/// Writes to standard error; a text that cannot be written there is lost, and no error.
void tell(std::string_view text);

}  // namespace app
