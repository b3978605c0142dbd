#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace app {

/// A table of numbered rows that are computed in any order and stored as they arrive: finished rows
/// survive the death of the program, and a later run with the same settings continues from them.
///
/// The file holds the settings as JSON after "# ", a line of column names, and complete rows
/// "number,…,checksum" in order of arrival. Every row is written at once; a truncated row at the
/// end is dropped when the file is opened again, and a row whose checksum does not match counts as
/// not computed. A lock, waited for at most a second, excludes a second program. Rows are kept in
/// the file; without a path they are kept in memory.
class RowFile {
 public:
  /// Opens and reads the file, or creates it.
  /// @param settings  an object: all that the rows depend on
  /// @param columns   names, the row's number first
  /// @param replace start anew if the file has other settings
  /// @throws std::runtime_error if it cannot be written, is in use, is another kind of file, or has
  ///   other settings (naming the first that differs) or no checksums (an earlier version)
  RowFile(std::filesystem::path path, const nlohmann::ordered_json& settings,
          const std::vector<std::string>& columns, bool replace);
  ~RowFile();
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;

  bool contains(std::uint64_t number) const {
    return number < places_.size() && places_[number] != 0;
  }
  /// Number of rows.
  std::size_t count() const { return count_; }
  /// Number of lines that were damaged when the file was opened.
  std::size_t damaged() const { return damaged_; }

  /// Text of the row after the number and comma, without its checksum.
  /// @throws std::out_of_range if it is not contained, std::runtime_error if it cannot be read
  std::string row(std::uint64_t number) const;

  /// Makes room for the numbers below `count`: eight bytes each.
  void expect(std::uint64_t count) { places_.reserve(count); }

  /// Adds a row.
  /// @param text the cells after "number,", one fewer than there are columns
  /// @throws std::runtime_error if it cannot be written
  void append(std::uint64_t number, const std::string& text);

  /// Removes the file with its rows.
  void remove();

 private:
  void open(const nlohmann::ordered_json& settings, bool replace);
  void lock() const;
  void begin(const std::string& head);
  void read(std::uint64_t from);
  void keep(std::uint64_t number, std::uint64_t place);
  void write(const std::string& text);

  std::filesystem::path path_;
  std::size_t cells_;  ///< cells after the number
  std::string columns_;
  int file_ = -1;
  std::uint64_t end_ = 0;              ///< bytes of the file
  std::vector<std::uint64_t> places_;  ///< by number: offset of its row, 0: none
  std::vector<std::string> kept_;      ///< without a path: the texts; places_ are then indices + 1
  std::size_t count_ = 0, damaged_ = 0;
};

/// The cells of a row without quotes.
std::vector<std::string> cellsOf(const std::string& row);

}  // namespace app
