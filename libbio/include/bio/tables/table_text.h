#pragma once

#include <filesystem>
#include <string>

#include "bio/tables/table_file.h"

namespace bio {

/// The text that writeTable() writes into `file`, whose extension decides about its format.
/// @throws FileError as writeTable, but for writing
std::string tableText(const Table& table, const std::filesystem::path& file);

}  // namespace bio
