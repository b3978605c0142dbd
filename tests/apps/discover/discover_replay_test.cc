#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "support/replays.h"
#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using support::contentOf;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;

// What `discover` writes is what it scored: its files are replayed, trial by trial.
void expectOneNumber(const std::string& set) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string(), data = "emg_data/" + set;
  const ProgramResult result =
      runFisherHill({"discover", "models/elbow8.osim", data + "/train_1.sto", data + "/train_2.sto",
                     data + "/train_3.sto", "--hold-out", data + "/held_out.sto", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto verdict = nlohmann::json::parse(contentOf(out + "/verdict.json"));
  ASSERT_EQ(verdict["trials"].size(), 4U);
  EXPECT_EQ(verdict["trials"][3]["role"], "held_out");
  EXPECT_THAT(result.err, testing::Not(testing::HasSubstr("the search itself had")));
  ASSERT_TRUE(verdict["model"].is_string()) << verdict["sentence"];
  support::expectReplaysAgree(out + "/" + verdict["model"].get<std::string>(), verdict["trials"],
                              verdict["step_s"]);
  EXPECT_NEAR(verdict["gap"]["train"]["rmse_after_deg"].get<double>(),
              support::pooled(verdict["trials"], "train"), 0.02);
  EXPECT_NEAR(verdict["gap"]["held_out"]["rmse_after_deg"].get<double>(),
              support::pooled(verdict["trials"], "held_out"), 1e-9);
}

/// The rows of a .sto file behind its header, and where a column is.
struct Columns {
  explicit Columns(const std::string& file) {
    std::istringstream text(contentOf(file));
    std::string line;
    while (std::getline(text, line) && line != "endheader") continue;
    std::getline(text, line);
    std::istringstream head(line);
    for (std::string name; head >> name;) names.push_back(name);
    while (std::getline(text, line)) {
      std::istringstream row(line);
      rows.emplace_back();
      for (double value; row >> value;) rows.back().push_back(value);
    }
  }
  std::size_t find(const std::string& name) const {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  }
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
};

/// The motion that the model makes of a trial, with noise of 0.5 deg, beside excitations that were
/// recorded 60 ms too early.
std::string delayed(const ScratchFolder& scratch, const std::string& trial, unsigned seed) {
  const std::string out = (scratch / ("replay" + std::to_string(seed))).string();
  EXPECT_EQ(runFisherHill({"replay", "models/elbow8.osim", trial, "--out", out}).status, 0);
  const Columns states(out + "/states.sto");
  const Columns recorded(std::string(FISHERHILL_SOURCE_DIR) + "/" + trial);
  const std::size_t angle = states.find("/jointset/elbow/elbow_flexion/value");
  const std::size_t own = recorded.find("elbow_flexion_deg");
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 0.5);
  constexpr double radian = 57.29577951308232;  // in degrees
  std::ostringstream text;
  text << "trial\nversion=1\ninDegrees=no\nendheader\n";
  for (const std::string& name : recorded.names) text << name << '\t';
  text << '\n';
  text.precision(12);
  constexpr std::size_t rowsEarly = 6;
  for (std::size_t k = 0; k + rowsEarly < recorded.rows.size(); ++k) {
    for (std::size_t c = 0; c < recorded.names.size(); ++c) {
      const bool isExcitation = c != own && c != 0;
      text << (c == own ? radian * states.rows[k][angle] + noise(random)
                        : recorded.rows[isExcitation ? k + rowsEarly : k][c])
           << '\t';
    }
    text << '\n';
  }
  return scratch.file("delayed" + std::to_string(seed) + ".sto", text.str());
}

// A delay has no place in a model: the driven trials are replayed, each role with its own numbers.
TEST(DiscoverReplay, DrivenTrialsStandForThoseThatWereRecorded) {
  const ScratchFolder scratch;
  const std::string train = delayed(scratch, "emg_data/hidden_a/train_1.sto", 1);
  const std::string held = delayed(scratch, "emg_data/hidden_a/held_out.sto", 2);
  const std::string out = (scratch / "out").string();
  const ProgramResult result =
      runFisherHill({"discover", "models/elbow8.osim", train, "--hold-out", held, "--noise-deg",
                     "0.5", "--max-effects", "1", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto verdict = nlohmann::json::parse(contentOf(out + "/verdict.json"));
  ASSERT_TRUE(verdict["model"].is_string()) << verdict["sentence"];
  EXPECT_EQ(verdict["trials"][0]["replay_file"], out + "/driven_1.sto");
  EXPECT_EQ(verdict["trials"][1]["replay_file"], out + "/driven_held_out_1.sto");
  support::expectReplaysAgree(out + "/with_effect.osim", verdict["trials"], verdict["step_s"]);
  const auto& judged = verdict["gap"]["held_out"];
  EXPECT_LT(judged["rmse_after_deg"].get<double>(), judged["rmse_expected_deg"].get<double>());
}

TEST(DiscoverReplay, HiddenA) {
  expectOneNumber("hidden_a");
}
TEST(DiscoverReplay, HiddenB) {
  expectOneNumber("hidden_b");
}
TEST(DiscoverReplay, HiddenC) {
  expectOneNumber("hidden_c");
}

}  // namespace
