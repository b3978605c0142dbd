#pragma once

#include <string>
#include <string_view>

namespace bio::tables {

/// One line for a file of a format that is known but not read: what it is, by its first bytes or
/// its name, and how to export it as one that is read. Empty for any other file.
std::string foreignFormat(const std::string& file, std::string_view bytes);

/// How a table that has no column of times looks, for its message: "; it looks like a Vicon Nexus
/// export, which `fisherhill emg` reads". Empty: like nothing that is known.
std::string looksLike(const std::string& file);

}  // namespace bio::tables
