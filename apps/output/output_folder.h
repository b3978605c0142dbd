#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "command/command_context.h"
#include "output/writer_mark.h"

namespace app {

/// The folder of --out. Its files appear all at once.
///
/// A file is first written under a temporary name in the folder; commit() renames all of them.
/// Without commit() everything is removed, including the folder if it was created here; only after
/// Ctrl-C the finished files are kept. Without --out nothing is written and no call fails.
/// Temporary files of a program that was killed are removed when the folder is opened again.
class OutputFolder {
 public:
  /// @param resultNames files the subcommand is going to write, beside summary.json and report.html
  /// @throws std::runtime_error if the folder cannot be made or written to, or if it holds one of
  ///   those files and --force was not given; std::invalid_argument if one of them is an input,
  ///   also under another name
  OutputFolder(const CommandContext& context, std::vector<std::string> resultNames);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// False without --out.
  bool active() const { return !folder_.empty(); }

  /// Final path of the file of this name; empty without --out.
  std::filesystem::path path(std::string_view name) const;

  /// Writes one file; each name once.
  void write(const std::string& name, const std::function<void(std::ostream&)>& content);

  /// For libraries that write files themselves: they receive the temporary path, which keeps the
  /// extension of `name`.
  void writeFile(const std::string& name,
                 const std::function<void(const std::filesystem::path&)>& writer);

  /// Gives every file written so far its final name.
  void commit();

  /// Names of the files written so far.
  const std::vector<std::string>& files() const { return finished_; }

 private:
  void mayBeWritten(const std::string& name) const;

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> foldersMade_;  ///< outermost first
  bool force_ = false;
  std::vector<std::filesystem::path> inputs_;
  std::vector<std::string> finished_;  ///< complete, possibly still under temporary names
  std::string unfinished_;             ///< the file being written
  std::size_t committed_ = 0;          ///< number of finished_ that have their final names
  std::optional<WriterMark> mark_;     ///< while there are temporary names
};

}  // namespace app
