#pragma once

#include <filesystem>
#include <string>

namespace app {

/// What says that a program is at work in a folder: the file `.unfinished-HOST-PID`, locked (flock)
/// as long as the mark lives. Its program writes under names that begin like it,
/// `.unfinished-HOST-PID-NAME`.
///
/// The kernel lets go of the lock when the program dies, however it dies. So a mark that can be
/// locked is nobody's, and with it all that is called after it. A process's number alone would not
/// do: it is given again, and means another process in another container. Where the file system
/// has no locks there is no mark, and nothing is ever taken for a leftover.
class WriterMark {
 public:
  explicit WriterMark(std::filesystem::path folder);
  ~WriterMark();
  WriterMark(const WriterMark&) = delete;
  WriterMark& operator=(const WriterMark&) = delete;

  /// The name under which a file is to be written.
  std::filesystem::path temporaryPath(const std::string& name) const;

 private:
  std::filesystem::path path_;
  int lock_ = -1;  ///< open and locked; −1: no locks here
};

/// Takes away what programs of this host that live no longer have left in a folder: marks and what
/// is called after them, regular files alone.
void removeLeftovers(const std::filesystem::path& folder);

}  // namespace app
