#pragma once

#include <filesystem>
#include <string>

namespace bio::fixtures {

/// A table of tests/libbio/reference: numbers that other programs computed (its README).
inline std::filesystem::path reference(const std::string& file) {
  return std::filesystem::path(FISHERHILL_SOURCE_DIR) / "tests/libbio/reference" / file;
}

}  // namespace bio::fixtures
