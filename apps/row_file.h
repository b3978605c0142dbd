#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace app {

/// A table whose rows are numbered, computed in any order and kept as they come: what is there
/// survives the death of the program, and a later run with the same settings goes on from it.
///
/// The file holds the settings as JSON behind "# ", a line of column names, and complete rows
/// "number,…,checksum" in the order of their arrival. Every row is handed to the system at once; a
/// row that was cut off at the end is dropped when the file is opened again, one that is not what
/// its checksum says counts as not computed. A lock keeps a second program away. Rows stay in the
/// file, and only with no path in memory.
class RowFile {
 public:
  /// Opens the file and reads what it has; makes it if there is none.
  /// @param settings  an object: all that the rows depend on
  /// @param columns   names, the row's number first
  /// @param replace   start anew if the file is of other settings
  /// @throws std::runtime_error if it cannot be written, is in use, is not such a file, or is of
  ///   other settings (naming the first that differs) or of a version that knew no checksums
  RowFile(std::filesystem::path path, const nlohmann::ordered_json& settings,
          const std::vector<std::string>& columns, bool replace);
  ~RowFile();
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;

  bool contains(std::uint64_t number) const {
    return number < places_.size() && places_[number] != 0;
  }
  /// How many rows there are.
  std::size_t count() const { return count_; }
  /// How many lines of the file, when it was opened, were no row or not the one that was written.
  std::size_t damaged() const { return damaged_; }

  /// The row's text behind the number's comma, without its checksum.
  /// @throws std::out_of_range if it is not contained, std::runtime_error if it cannot be read
  std::string row(std::uint64_t number) const;

  /// Adds a row. @param text what stands behind "number,": as many cells as there are columns, one
  ///   less @throws std::runtime_error if it cannot be written
  void append(std::uint64_t number, const std::string& text);

  /// Takes the file away, and with it the rows.
  void remove();

 private:
  void open(const nlohmann::ordered_json& settings, bool replace);
  void begin(const std::string& head);
  void read(std::uint64_t from);
  void keep(std::uint64_t number, std::uint64_t place);
  void write(const std::string& text);

  std::filesystem::path path_;
  std::size_t cells_;  ///< behind the number
  std::string columns_;
  int file_ = -1;
  std::uint64_t end_ = 0;              ///< bytes of the file
  std::vector<std::uint64_t> places_;  ///< by number: where its row begins, 0: nowhere
  std::vector<std::string> kept_;      ///< without a path: the texts; places are indices + 1
  std::size_t count_ = 0, damaged_ = 0;
};

/// The cells of a row without quotes.
std::vector<std::string> cellsOf(const std::string& row);

}  // namespace app
