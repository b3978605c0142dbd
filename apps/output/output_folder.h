#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "output/command_context.h"
#include "output/writer_mark.h"

namespace app {

/// The folder of --out. Its files appear all at once.
///
/// A file is first written under a temporary name in the folder. commit() builds a second folder
/// beside it, of the new files and of hard links to all else that is there, and exchanges the two
/// in one step (renameat2): whoever looks, also after kill -9, sees the older result or the new one
/// as a whole. What an older result has beyond the new one's files goes with it. Where folders
/// cannot be exchanged (the folder is where the program runs, or the file system can do neither)
/// the files are renamed one by one, behind the removal of the older ones. Without commit()
/// everything is removed, including the folder if it was created here; only after Ctrl-C the
/// finished files are kept. Without --out nothing is written and no call fails. What a program that
/// was killed has left is removed when the folder is opened again.
///
/// The folder of --figures is such a folder, too, and opened with this one.
class OutputFolder {
 public:
  /// @param resultNames files the subcommand is going to write, beside those of every result
  /// @throws std::runtime_error if the folder cannot be made or written to, if it holds one of
  ///   those files and --force was not given, or a folder of that name; std::invalid_argument if
  ///   one of them is an input, also under another name, or --figures names the same folder
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

  /// Makes a file of this folder executable as well; after it was written.
  void makeExecutable(const std::string& name);

  /// Gives every file written so far its final name.
  void commit();

  /// The folder of --figures; null without it.
  OutputFolder* figures() { return figures_.get(); }

  /// Names of the files written so far.
  const std::vector<std::string>& files() const { return finished_; }

  /// SHA-256 of one of them that has no final name yet.
  std::string hashOf(const std::string& name) const;

 private:
  OutputFolder(const CommandContext& context, const std::filesystem::path& folder,
               std::string option);
  void open(const std::filesystem::path& folder, std::vector<std::string> resultNames);
  bool isReplaced(const std::string& name) const;
  bool exchange();
  void mayBeWritten(const std::string& name) const;

  std::unique_ptr<OutputFolder> figures_;
  std::string option_ = "--out";
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> foldersMade_;  ///< outermost first
  bool force_ = false;
  std::vector<std::string> resultNames_;
  std::vector<std::filesystem::path> inputs_;
  std::vector<std::string> finished_;  ///< complete, possibly still under temporary names
  std::string unfinished_;             ///< the file being written
  std::size_t committed_ = 0;          ///< number of finished_ that have their final names
  std::optional<WriterMark> mark_;     ///< while there are temporary names
};

}  // namespace app
