#pragma once

#include <string>

#include "index/found_results.h"

namespace app {

/// index.html: a table of results with links to their reports, sortable, and the numbers of two of
/// them side by side. One file that needs no network; without scripts it is a plain table.
/// @param folder  what was searched, for the title
/// @param way  from the page to that folder: "" or "../results/"
std::string indexPage(const FoundResults& found, const std::string& folder, const std::string& way);

/// Whether a file is such a page.
bool isIndexPage(const std::filesystem::path& file);

}  // namespace app
