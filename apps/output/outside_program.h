#pragma once

#include <string>
#include <vector>

namespace app {

/// Whether a program of this name is in one of the folders of PATH.
bool isInPath(const std::string& program);

/// Starts a program of PATH without its output and waits for its end. What it makes does not tell
/// when it was made: SOURCE_DATE_EPOCH is 0 unless it is set.
/// @param words  its name, then its arguments
/// @return its exit status; −1 if it could not be started or was killed
int statusOfProgram(std::vector<std::string> words);

}  // namespace app
