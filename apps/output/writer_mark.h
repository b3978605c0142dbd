#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace app {

/// Marks that a program is writing into a folder: the file `.unfinished-HOST-PID`, locked (flock)
/// for the lifetime of the mark. The program's temporary files are called
/// `.unfinished-HOST-PID-NAME`.
///
/// The kernel releases the lock when the program ends for any reason. So a mark that can be locked
/// belongs to no running program, nor do the files named after it. The process number alone would
/// not suffice: it is reused, and means another process in another container. On a file system
/// without locks there is no mark, and no file counts as left over.
class WriterMark {
 public:
  /// How the names of temporary folders end, of results that are exchanged with older ones.
  static constexpr std::string_view exchanged = ".exchange";

  explicit WriterMark(std::filesystem::path folder);
  ~WriterMark();
  WriterMark(const WriterMark&) = delete;
  WriterMark& operator=(const WriterMark&) = delete;

  /// Whether this program has a mark in a folder already.
  static bool hasOne(const std::filesystem::path& folder);

  /// The temporary name of a file.
  std::filesystem::path temporaryPath(const std::string& name) const;

 private:
  std::filesystem::path path_;
  int lock_ = -1;  ///< open and locked; −1: no locks on this file system
};

/// Removes from a folder the marks, and the regular files and exchanged folders named after them, of
/// programs of this host that have ended.
void removeLeftovers(const std::filesystem::path& folder);

}  // namespace app
