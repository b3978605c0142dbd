#include "robot_options/robot_program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <string_view>

namespace app {
namespace {

std::filesystem::path robotProgram() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "fisherhill-robot";
}

[[noreturn]] void sayMissing() {
  throw std::runtime_error(fmt::format(
      "{} is not there or cannot be started; `cmake --build build/program` builds it",
      robotProgram().string()));
}

bool asksForARobot(char** argv) {
  if (!argv[0] || !argv[1]) return false;
  const std::string_view command = argv[1];
  if (command == "robot") return true;
  if (command != "discover") return false;
  for (char** word = argv + 2; *word; ++word) {
    const std::string_view option = *word;
    if (option == "--system" || option.starts_with("--system=")) return true;
  }
  return false;
}

class MissingRobot : public Command {
 public:
  About about() const override {
    return {"robot", "Find the motion of a robot that is most informative about its parameters",
            "fisherhill robot double-pendulum --discrete"};
  }
  void addOptions(CLI::App& options) override { options.allow_extras(); }
  ExitStatus run(const CommandContext&) override { sayMissing(); }
};

}  // namespace

void becomeRobotProgram(char** argv) {
  if (asksForARobot(argv)) execv(robotProgram().c_str(), argv);
}

std::unique_ptr<Command> missingRobotCommand() {
  return std::make_unique<MissingRobot>();
}

ExitStatus missingRobotDiscovery(const RobotRequest&, const CommandContext&) {
  sayMissing();
}

}  // namespace app
