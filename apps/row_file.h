#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace app {

/// A table whose rows are numbered, computed in any order and kept as they come: what is there
/// survives the death of the program, and a later run with the same settings goes on from it.
///
/// The file holds the settings as JSON behind "# ", a line of column names, and complete rows
/// "number,…" in the order of their arrival. Every row is handed to the system at once; a row that
/// was cut off at the end is dropped when the file is opened again. A lock keeps a second program
/// away. With no path rows are kept in memory alone.
class RowFile {
 public:
  /// Opens the file and reads what it has; makes it if there is none.
  /// @param settings  an object: all that the rows depend on
  /// @param columns   names, the row's number first
  /// @param replace   start anew if the file is of other settings
  /// @throws std::runtime_error if it cannot be written, is in use, is not such a file, or is of
  ///   other settings (naming the first that differs)
  RowFile(std::filesystem::path path, const nlohmann::ordered_json& settings,
          const std::vector<std::string>& columns, bool replace);
  ~RowFile();
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;

  /// Rows so far, by number: the text behind the number's comma.
  const std::map<std::uint64_t, std::string>& rows() const { return rows_; }

  /// Adds a row. @param text what stands behind "number,": as many cells as there are columns, one
  ///   less @throws std::runtime_error if it cannot be written
  void append(std::uint64_t number, const std::string& text);

  /// Takes the file away; the rows stay in memory.
  void remove();

 private:
  void open(const nlohmann::ordered_json& settings, bool replace);
  void begin(const std::string& head);
  void read(const std::string& content, std::size_t from);
  void write(const std::string& text);

  std::filesystem::path path_;
  std::size_t cells_;  ///< behind the number
  std::string columns_;
  int file_ = -1;
  std::map<std::uint64_t, std::string> rows_;
};

/// The cells of a row without quotes.
std::vector<std::string> cellsOf(const std::string& row);

}  // namespace app
