#include "command/run_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <functional>
#include <map>
#include <new>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <variant>

#include "options/simulation_options.h"
#include "output/interruption.h"

namespace app {
namespace {

using testing::internal::CaptureStderr;
using testing::internal::CaptureStdout;
using testing::internal::GetCapturedStderr;
using testing::internal::GetCapturedStdout;

/// A subcommand that does what the test says.
class Trying : public Command {
 public:
  using Action = std::function<ExitStatus(const CommandContext&, const SimulationOptions&)>;
  explicit Trying(Action action) : action_(std::move(action)) {}
  About about() const override { return {"try", "Tries.", "fisherhill try file"}; }
  void addOptions(CLI::App& options) override {
    options.add_option("FILE", file_, "a file")->required();
    addSimulationOptions(options, options_);
  }
  ExitStatus run(const CommandContext& context) override { return action_(context, options_); }

 private:
  Action action_;
  std::string file_;
  SimulationOptions options_;
};

struct Outcome {
  int status;
  std::string out, err;
};

Outcome tryProgram(std::vector<std::string> arguments, Trying::Action action) {
  arguments.insert(arguments.begin(), {"fisherhill"});
  std::vector<std::unique_ptr<Command>> commands;
  commands.push_back(std::make_unique<Trying>(std::move(action)));
  CaptureStdout();
  CaptureStderr();
  const int status = runProgram(arguments, std::move(commands));
  return {status, GetCapturedStdout(), GetCapturedStderr()};
}

ExitStatus done(const CommandContext&, const SimulationOptions&) {
  return ExitStatus::done;
}

TEST(RunProgram, OneSignalEndsWorkThatNeverLooksWhetherThereWasOne) {
  const auto busy = [] {
    std::vector<std::unique_ptr<Command>> commands;
    commands.push_back(
        std::make_unique<Trying>([](const CommandContext&, const SimulationOptions&) -> ExitStatus {
          std::raise(SIGTERM);
          for (;;) pause();
        }));
    runProgram({"fisherhill", "try", "a"}, std::move(commands));
  };
  EXPECT_EXIT(busy(), testing::ExitedWithCode(130), "work that cannot be stopped halfway");
}

TEST(RunProgram, ReturnsTheSubcommandsStatus) {
  EXPECT_EQ(tryProgram({"try", "a"}, done).status, 0);
  const auto no = [](const auto&, const auto&) { return ExitStatus::answerIsNo; };
  EXPECT_EQ(tryProgram({"try", "a"}, no).status, 1);
}

TEST(RunProgram, TurnsEveryExceptionIntoOneLine) {
  const auto outcomeOf = [](auto exception) {
    return tryProgram({"try", "a"},
                      [&](const auto&, const auto&) -> ExitStatus { throw exception; });
  };
  for (const Outcome& outcome :
       {outcomeOf(std::runtime_error("a.osim:3: mass = -1 kg\nmust be ≥ 0\n")),
        outcomeOf(std::domain_error("a.osim:3: mass = -1 kg\n\n  must be ≥ 0")),
        outcomeOf(std::invalid_argument("a.osim:3: mass = -1 kg; must be ≥ 0"))}) {
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.err, "fisherhill try: a.osim:3: mass = -1 kg; must be ≥ 0\n");
    EXPECT_EQ(outcome.out, "");
  }
  EXPECT_EQ(outcomeOf(std::bad_alloc()).err, "fisherhill try: not enough memory\n");
  EXPECT_EQ(outcomeOf(42).status, 2);
  EXPECT_EQ(outcomeOf(Interrupted{}).status, 130);
}

// What the standard library says is never all that a user is told.
TEST(RunProgram, CallsAFaultOfTheProgramByItsName) {
  const std::vector<int> none;
  const std::map<int, int> empty;
  const auto sayOf = [](const std::function<void()>& fault) {
    return tryProgram({"try", "x"}, [&](const auto&, const auto&) {
      fault();
      return ExitStatus::done;
    });
  };
  for (const std::function<void()>& fault : std::vector<std::function<void()>>{
           [] { (void)std::stod("1e-310"); }, [] { (void)std::stoi("many"); },
           [&] { (void)none.at(1); }, [&] { (void)empty.at(1); },
           [] { (void)std::string("a").substr(2); }, [] { std::function<void()>()(); },
           [] { (void)std::optional<int>().value(); },
           [] { (void)std::get<int>(std::variant<int, double>(1.5)); },
           [] { const nlohmann::json read = nlohmann::json::parse("{"); }}) {
    const Outcome outcome = sayOf(fault);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err,
                testing::StartsWith("fisherhill try: stopped by a fault of the program ("));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
  EXPECT_EQ(sayOf([] { throw std::invalid_argument("step = 0 s must be > 0"); }).err,
            "fisherhill try: step = 0 s must be > 0\n");
}

TEST(RunProgram, EveryMistakeOnTheCommandLineIsOneLineAndStatusTwo) {
  const std::vector<std::vector<std::string>> mistakes = {
      {},
      {"fly"},
      {"try"},
      {"--verbose"},
      {"try", "a", "b"},
      {"try", "a", "--fast"},
      {"try", "a", "--out"},
      {"try", "a", "--seed", "-1"},
      {"try", "a", "--seed", "many"},
      {"try", "a", "--threads", "0"},
      {"try", "a", "--threads", "1.5"},
      {"try", "a", "--force=perhaps"},
      {"try", "a", "--integrator", "euler"},
      {"try", "a", "--step", "0"},
      {"try", "a", "--step", "-0.01"},
      {"try", "a", "--step", "nan"},
      {"try", "a", "--step", "10ms"},
      {"try", "a", "--initial", "elbow_flexion"},
      {"try", "a", "--initial", "elbow_flexion=34°"},
      {"try", "a", "--lock", "shoulder_elv=inf"},
      {"try", "a", "--lock", "=1"},
      {"try", "a", "--wrap-as-cylinder"},
  };
  for (const auto& arguments : mistakes) {
    const Outcome outcome = tryProgram(arguments, done);
    const std::string shown = testing::PrintToString(arguments);
    EXPECT_EQ(outcome.status, 2) << shown;
    EXPECT_EQ(outcome.out, "") << shown;
    EXPECT_THAT(outcome.err, testing::StartsWith("fisherhill")) << shown;
    EXPECT_THAT(outcome.err, testing::HasSubstr("--help)\n")) << shown;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << shown << outcome.err;
  }
}

TEST(RunProgram, HelpShowsAnExampleOnStandardOutput) {
  const Outcome outcome = tryProgram({"try", "--help"}, done);
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
  for (const char* text : {"Example:\n  fisherhill try file", "--out DIR", "--force", "--json",
                           "--seed", "--threads", "--integrator", "--step SECONDS"}) {
    EXPECT_THAT(outcome.out, testing::HasSubstr(text));
  }
}

TEST(RunProgram, HandsOverTheCommonOptions) {
  CommandContext seen;
  tryProgram(
      {"try", "--out", "a folder", "file", "--json", "--seed", "7", "--threads", "3", "--force"},
      [&](const CommandContext& context, const SimulationOptions&) {
        seen = context;
        return ExitStatus::done;
      });
  EXPECT_EQ(seen.subcommand, "try");
  EXPECT_EQ(seen.out, "a folder");
  EXPECT_TRUE(seen.json);
  EXPECT_TRUE(seen.force);
  EXPECT_EQ(seen.seed, 7u);
  EXPECT_EQ(seen.threads, 3);
}

TEST(SimulationOptions, MayStandBeforeOrAfterTheFiles) {
  SimulationOptions seen;
  const auto keep = [&](const CommandContext&, const SimulationOptions& options) {
    seen = options;
    return ExitStatus::done;
  };
  const Outcome outcome =
      tryProgram({"try", "--coordinate", "elbow_flexion", "--coordinate", "pro_sup", "--initial",
                  "elbow_flexion=180deg", "--lock", "shoulder_elv=-0.5", "--lock", "shoulder_rot=1",
                  "--step", "5e-3", "--wrap-as-cylinder", "Elbow_BIC_BRD", "file", "--integrator",
                  "vi-left", "--ignore-extra"},
                 keep);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(seen.coordinates, testing::ElementsAre("elbow_flexion", "pro_sup"));
  ASSERT_EQ(seen.initial.size(), 1u);
  EXPECT_DOUBLE_EQ(seen.initial[0].value, std::numbers::pi);
  ASSERT_EQ(seen.locks.size(), 2u);
  EXPECT_EQ(seen.locks[0].name, "shoulder_elv");
  EXPECT_EQ(seen.locks[0].value, -0.5);
  EXPECT_EQ(seen.stepOrDefault(), 5e-3);
  EXPECT_THAT(seen.wrapAsCylinder, testing::ElementsAre("Elbow_BIC_BRD"));
  EXPECT_EQ(seen.integrator, "vi-left");
  EXPECT_TRUE(seen.ignoreExtra);
}

TEST(SimulationOptions, StepsByDefaultAsTheIntegratorNeeds) {
  SimulationOptions options;
  EXPECT_EQ(options.stepOrDefault(), 0.01);
  EXPECT_THAT(options.coordinates, testing::IsEmpty());  // chooseCoordinates() chooses
  options.integrator = "rk4";
  EXPECT_EQ(options.stepOrDefault(), 2e-4);
}

}  // namespace
}  // namespace app
