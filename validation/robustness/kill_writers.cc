#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "support/scratch_folder.h"

// Kill -9 at random moments while `fisherhill` writes: every file is then absent, the old one or
// the complete new one; what lies about besides is called .unfinished-…, or unfinished.csv for an
// ensemble, and is gone once the same command has gone through.
//     kill_writers FISHERHILL KILLS SEED [COMMAND…]      (in the top folder of the source tree)
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Command {
  std::string name;
  /// Without --out. STATES stands for a motion, SHORT:TRIAL for half a second of a trial: whoever
  /// computes for long is rarely killed while it writes.
  std::vector<std::string> words;
};

const std::vector<Command>& commands() {
  const std::string model = "models/elbow8.osim", trial = "emg_data/curl_slow.sto",
                    brief = "SHORT:" + trial, hidden = "emg_data/hidden_a/";
  static const std::vector<Command> all = {
      {"replay", {"replay", model, trial}},
      {"emg",
       {"emg", "emg_data/curl_slow_raw.csv", "--config", "emg_data/configs/shipped_raw.toml"}},
      {"moment-arms", {"moment-arms", model, "--from", "0", "--to", "130", "--points", "131"}},
      {"check", {"check", model, trial}},
      {"compare", {"compare", model, brief, "--integrators", "vi", "--steps", "0.01"}},
      {"sensitivity", {"sensitivity", model, trial, "--all"}},
      {"calibrate", {"calibrate", model, brief, "--parameters", "hand.mass"}},
      {"design",
       {"design", model, brief, "--parameters", "TRI.radius", "--candidates", "2", "--generations",
        "0", "--iterations", "1"}},
      {"discover",
       {"discover", model, "SHORT:" + hidden + "train_1.sto", "--noise-deg", "5", "--max-effects",
        "1"}},
      {"ensemble",
       {"ensemble", model, trial, "--draws", "40", "--parameters", "TRI.radius,hand.mass"}},
      {"robot", {"robot", "double-pendulum", "--discrete", "--trials", "2"}},
      {"robot-baxter", {"robot", "baxter"}},
      {"render", {"render", model, "STATES", "--film", "--size", "320x240"}},
  };
  return all;
}

std::string contentOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The first half second of a trial, in a file of its own.
fs::path shortened(const fs::path& trial, const fs::path& folder) {
  std::ifstream from(trial);
  std::string head, rows, line;
  long count = 0;
  for (bool inHead = true; std::getline(from, line) && count < 51;) {
    if (inHead && !line.starts_with("nRows")) head += line + "\n";
    if (!inHead) rows += line + "\n", count += line.starts_with("time") ? 0 : 1;
    if (line == "endheader") inHead = false;
  }
  const std::string end = "endheader\n";
  head.insert(head.size() - end.size(), fmt::format("nRows={}\n", count));
  const fs::path file = folder / ("short_" + trial.filename().string());
  std::ofstream(file) << head << rows;
  return file;
}

bool isUnfinished(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with(".unfinished-") || name == "unfinished.csv";
}

using Files = std::map<std::string, std::string>;

Files filesIn(const fs::path& folder) {
  Files files;
  if (!fs::exists(folder)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files[fs::relative(entry.path(), folder).string()] = contentOf(entry.path());
    }
  }
  return files;
}

pid_t started(const std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  const pid_t child = ::fork();
  if (child != 0) return child;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nothing = ::open("/dev/null", O_RDWR);
  for (int stream = 0; stream <= 2; ++stream) ::dup2(nothing, stream);
  ::execv(pointers[0], pointers.data());
  ::_exit(127);
}

// Whether a new file is whole. Files that are not the same in two runs (they hold wall times) must
// be as long in lines, to a fifth, and end alike.
bool isWhole(const std::string& name, const std::string& found, const Files& first,
             const Files& second) {
  const auto a = first.find(name), b = second.find(name);
  if (a == first.end() || b == second.end()) return false;
  if (a->second == b->second) return found == a->second;
  const auto lines = [](const std::string& text) {
    return static_cast<double>(std::count(text.begin(), text.end(), '\n'));
  };
  const double wanted = lines(a->second);
  const std::size_t tail = std::min<std::size_t>(3, a->second.size());
  return std::abs(lines(found) - wanted) <= 0.2 * wanted &&
         found.ends_with(a->second.substr(a->second.size() - tail));
}

struct Tally {
  long kills = 0, tooLate = 0, findings = 0, leftovers = 0;
  long none = 0, old = 0, mixed = 0, all = 0;  ///< of the killed: which files were there
};

class Trial {
 public:
  Trial(std::string program, Command command, const support::ScratchFolder& scratch)
      : command_(std::move(command)), out_(scratch.path() / command_.name) {
    command_.words.insert(command_.words.begin(), std::move(program));
    command_.words.insert(command_.words.end(), {"--force", "--out", out_.string()});
    for (std::string& word : command_.words) {
      if (word.starts_with("SHORT:")) word = shortened(word.substr(6), scratch.path()).string();
      // A film needs a motion.
      if (word != "STATES") continue;
      const fs::path motion = scratch.path() / "motion";
      const pid_t child = started({command_.words[0], "replay", "models/elbow8.osim",
                                   "emg_data/curl_slow.sto", "--force", "--out", motion.string()});
      ::waitpid(child, nullptr, 0);
      word = (motion / "states.sto").string();
    }
    const auto begin = Clock::now();
    first_ = finished();
    duration_ = std::chrono::duration<double>(Clock::now() - begin).count();
    second_ = finished();
  }

  double duration() const { return duration_; }

  /// The command once more where the last kill has left its files: all of them are new and nothing
  /// else lies about.
  void goOn(Tally& tally) {
    const pid_t child = started(command_.words);
    int status = 0;
    ::waitpid(child, &status, 0);
    const Files files = filesIn(out_);
    for (const auto& [name, text] : files) {
      if (isWhole(name, text, first_, second_)) continue;
      ++tally.findings;
      fmt::print("finding: {}: {} ({} bytes) after a run that was not killed\n", command_.name,
                 name, text.size());
    }
    if (files.size() == first_.size()) return;
    ++tally.findings;
    fmt::print("finding: {}: {} files after a run that was not killed, not {}\n", command_.name,
               files.size(), first_.size());
  }

  void kill(std::mt19937_64& random, Tally& tally) {
    std::uniform_real_distribution<double> unit(0, 1);
    // Every other time there is an older result, which must stay or be replaced.
    Files before;
    fs::remove_all(out_);
    if (unit(random) < 0.5) {
      fs::create_directories(out_);
      for (const auto& [name, text] : first_) {
        before[name] = "old\n";
        fs::create_directories((out_ / name).parent_path());
        std::ofstream(out_ / name) << "old\n";
      }
    }
    const pid_t child = started(command_.words);
    // At any moment, within 20 ms of the first byte that is written, or as results get their names.
    const double choice = unit(random);
    const double wait = choice < 0.3 ? unit(random) * duration_ : 0.02 * std::pow(unit(random), 2);
    if (choice >= 0.3) waitForWriting(child, before.size(), choice >= 0.65);
    if (choice < 0.65) std::this_thread::sleep_for(std::chrono::duration<double>(wait));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (WIFSIGNALED(status))
      ++tally.kills;
    else
      ++tally.tooLate;
    judge(before, WIFSIGNALED(status), tally);
  }

 private:
  Files finished() {
    fs::remove_all(out_);
    const pid_t child = started(command_.words);
    int status = 0;
    ::waitpid(child, &status, 0);
    const Files files = filesIn(out_);
    if (files.empty()) throw std::runtime_error(command_.name + " writes nothing, cannot be tried");
    return files;
  }

  // Until a file is there that was not before, or one under its own name, or the program has ended.
  void waitForWriting(pid_t child, std::size_t before, bool named) const {
    siginfo_t info = {};
    for (;;) {
      std::size_t files = 0, results = 0;
      std::error_code ignored;
      for (fs::directory_iterator at(out_, ignored), end; at != end; at.increment(ignored)) {
        ++files;
        results += !isUnfinished(at->path()) && at->file_size(ignored) != 4;  // "old\n"
      }
      if (named ? results > 0 : files > before) return;
      info.si_pid = 0;
      ::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT);
      if (info.si_pid == child) return;
      if (!named) std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }

  void judge(const Files& before, bool killed, Tally& tally) {
    long fresh = 0, old = 0;
    for (const auto& [name, text] : filesIn(out_)) {
      if (isUnfinished(name)) {
        ++tally.leftovers;
        continue;
      }
      const auto known = before.find(name);
      if (known != before.end() && known->second == text) {
        ++old;
      } else if (isWhole(name, text, first_, second_)) {
        ++fresh;
      } else {
        ++tally.findings;
        fmt::print("finding: {}: {} is half a file or one of unknown name ({} bytes)\n",
                   command_.name, name, text.size());
      }
    }
    for (const auto& [name, text] : before) {
      if (fs::exists(out_ / name)) continue;
      ++tally.findings;
      fmt::print("finding: {}: {} was there before and is gone\n", command_.name, name);
    }
    if (!killed) return;
    ++(fresh == 0                                              ? old == 0 ? tally.none : tally.old
       : old == 0 && fresh == static_cast<long>(first_.size()) ? tally.all
                                                               : tally.mixed);
  }

  Command command_;
  fs::path out_;
  Files first_, second_;
  double duration_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    fmt::print(stderr, "kill_writers FISHERHILL KILLS SEED [COMMAND…]\n");
    return 2;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const std::vector<std::string> wanted(argv + 4, argv + argc);
  std::vector<Command> chosen;
  for (const Command& command : commands()) {
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), command.name) != wanted.end()) {
      chosen.push_back(command);
    }
  }
  const long each = std::atol(argv[2]) / static_cast<long>(chosen.size());
  std::mt19937_64 random(static_cast<std::uint64_t>(std::atoll(argv[3])));
  const support::ScratchFolder scratch;
  Tally sum;
  fmt::print("{:<13} {:>7} {:>6} {:>5} {:>5} {:>4} {:>6} {:>4} {:>10} {:>9}\n", "command", "run_s",
             "kills", "late", "none", "old", "mixed", "new", "unfinished", "findings");
  for (const Command& command : chosen) {
    Tally tally;
    Trial trial(argv[1], command, scratch);
    for (long i = 0; tally.kills < each && i < 3 * each; ++i) trial.kill(random, tally);
    trial.goOn(tally);
    fmt::print("{:<13} {:>7.2f} {:>6} {:>5} {:>5} {:>4} {:>6} {:>4} {:>10} {:>9}\n", command.name,
               trial.duration(), tally.kills, tally.tooLate, tally.none, tally.old, tally.mixed,
               tally.all, tally.leftovers, tally.findings);
    sum.kills += tally.kills;
    sum.findings += tally.findings;
  }
  fmt::print("{} kills, {} findings\n", sum.kills, sum.findings);
  return sum.findings == 0 ? 0 : 1;
}
