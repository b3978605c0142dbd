#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

namespace {

using nlohmann::json;
using support::contentOf;
using support::model;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using support::slow;
using testing::HasSubstr;
using testing::Not;

/// A short form of each command that takes a model.
const std::vector<std::vector<std::string>>& shortForms() {
  static const std::vector<std::vector<std::string>> all = {
      {"calibrate", model, slow, "--parameters", "TRI.radius", "--step", "0.02"},
      {"check", model},
      {"compare", model, slow, "--integrators", "vi", "--steps", "0.01"},
      {"design", model, slow, "--parameters", "TRI.radius", "--iterations", "1"},
      {"discover", model, slow, "--list-effects"},
      {"ensemble", model, slow, "--draws", "2", "--parameters", "hand.mass"},
      {"explore", model, slow, "--parameters", "hand.mass"},
      {"moment-arms", model, "--points", "3"},
      {"replay", model, slow},
      {"sensitivity", model, slow, "--parameters", "TRI.radius"}};
  return all;
}

std::vector<std::string> with(std::vector<std::string> words,
                              const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

json summaryOf(const std::vector<std::string>& words) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runFisherHill(with(words, {"--out", out, "--seed", "3"}));
  EXPECT_LE(result.status, 1) << words[0] << ": " << result.err;
  return json::parse(contentOf(out + "/summary.json"));
}

TEST(SetOption, IsToldByEveryCommandThatTakesAModel) {
  for (const std::vector<std::string>& words : shortForms()) {
    if (words[0] == "discover") continue;  // a list has no summary
    const json summary =
        summaryOf(with(words, {"--set", "TRI.radius=0.0165", "--set=hand.mass=0.6"}));
    const json& set = summary["set_parameters"];
    ASSERT_EQ(set.size(), 2u) << words[0];
    EXPECT_EQ(set["TRI.radius"]["value"], 0.0165) << words[0];
    EXPECT_EQ(set["TRI.radius"]["in_model"], 0.016) << words[0];
    EXPECT_EQ(set["TRI.radius"]["unit"], "m") << words[0];
    EXPECT_THAT(summary["command_line"].get<std::string>(), HasSubstr("--set TRI.radius=0.0165"));
  }
}

TEST(SetOption, RefusesWhatIsWrongBeforeAnythingIsWritten) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{"--set", "TRI.raduis=0.018"},
       "--set: no parameter is called 'TRI.raduis'; nearest: TRI.radius"},
      {{"--set", "hand.mass=-0.1"}, "--set: hand.mass = -0.1 kg, must be ≥ 0"},
      {{"--set", "TRI.radius=1"}, "--set: TRI.radius = 1 m, must be below"},
      {{"--set", "TRI.radius=30deg"}, "--set: TRI.radius is no angle, must be a number [m]"},
      {{"--set", "TRI.radius=0.017", "--set", "TRI.radius=0.017"},
       "--set: 'TRI.radius' is given twice"},
      {{"--set", "TRI.radius"}, "is not NAME=VALUE"},
      {{"--set", "TRI.radius=thick"}, "'thick' is not a finite number"}};
  for (const std::vector<std::string>& words : shortForms()) {
    const ScratchFolder scratch;
    const std::string out = (scratch / "out").string();
    for (const auto& [set, said] : wrong) {
      const ProgramResult result = runFisherHill(with(with(words, set), {"--out", out}));
      EXPECT_EQ(result.status, 2) << words[0] << " " << set[1];
      EXPECT_THAT(result.err, HasSubstr(said)) << words[0];
      const auto lines = std::count(result.err.begin(), result.err.end(), '\n');
      EXPECT_LE(lines, 2) << words[0] << ": " << result.err;
      EXPECT_FALSE(std::filesystem::exists(out)) << words[0];
    }
  }
  const ProgramResult noModel = runFisherHill({"check", slow, "--set", "TRI.radius=0.017"});
  EXPECT_EQ(noModel.status, 2);
  EXPECT_THAT(noModel.err, HasSubstr("--set: there is no model among the files"));
  // what a trial has is none of the model's
  for (const std::vector<std::string>& words : shortForms()) {
    if (words[0] == "replay") continue;
    const ScratchFolder scratch;
    const ProgramResult result = runFisherHill(
        with(words, {"--set", "emg.BRA.gain=2", "--out", (scratch / "out").string()}));
    EXPECT_EQ(result.status, 2) << words[0];
    EXPECT_THAT(result.err, HasSubstr("'emg.BRA.gain' belongs to a trial")) << words[0];
  }
}

TEST(SetOption, ChangesWhatIsComputed) {
  const auto valueOf = [](const json& list, const std::string& name, const char* key) {
    for (const json& one : list)
      if (one["name"] == name) return one[key].get<double>();
    return std::nan("");
  };
  const std::string value = "--set=TRI.radius=0.018";
  const json bounds =
      summaryOf({"sensitivity", model, slow, "--parameters", "TRI.radius,hand.mass", value});
  EXPECT_EQ(valueOf(bounds["parameters"], "TRI.radius", "value"), 0.018);
  const json list =
      json::parse(runFisherHill({"sensitivity", model, "--list-parameters", "--json", value}).out);
  EXPECT_EQ(valueOf(list, "TRI.radius", "value"), 0.018);
  const json arms = summaryOf({"moment-arms", model, "--points", "3"});
  const json thicker = summaryOf({"moment-arms", model, "--points", "3", value});
  EXPECT_NE(arms["ranges"]["TRIlong"], thicker["ranges"]["TRIlong"]);
  EXPECT_EQ(arms["ranges"]["BRA"], thicker["ranges"]["BRA"]);
  const json rough = summaryOf({"check", model, "--set", "hand.inertia.xx=10"});
  EXPECT_GT(rough["unusual"].get<int>(), summaryOf({"check", model})["unusual"].get<int>());
  EXPECT_THAT(rough["findings"].dump(), HasSubstr("body 'hand'"));
}

TEST(SetOption, IsWhereACalibrationBeginsAndStaysInItsModel) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result =
      runFisherHill({"calibrate", model, slow, "--parameters", "TRI.radius", "--step", "0.02",
                     "--set", "TRI.radius=0.019", "--set", "hand.mass=0.9", "--out", out});
  ASSERT_LE(result.status, 1) << result.err;
  EXPECT_THAT(contentOf(out + "/parameters.csv"), HasSubstr("TRI.radius,m,0.019,"));
  const json list = json::parse(
      runFisherHill({"sensitivity", out + "/calibrated.osim", "--list-parameters", "--json"}).out);
  for (const json& one : list) {
    if (one["name"] == "hand.mass") {
      EXPECT_EQ(one["value"], 0.9);
    }
  }
  const std::string report = contentOf(out + "/report.html");
  EXPECT_THAT(report,
              HasSubstr("2 numbers of the model were set to other values than its file has"));
  EXPECT_THAT(contentOf(out + "/reproduce.sh"), HasSubstr("--set hand.mass=0.9"));
}

TEST(SetOption, IsAngleWhereTheParameterIsOne) {
  const json summary = summaryOf({"replay", model, slow, "--set", "TRIlong.pennation=15deg"});
  EXPECT_NEAR(summary["set_parameters"]["TRIlong.pennation_angle"]["value"].get<double>(),
              0.2617993877991494, 1e-15);
}

TEST(SetOption, IsInThePageOfExploreAndItsCommand) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runFisherHill({"explore", model, slow, "--parameters", "TRI.radius",
                                              "--set", "TRI.radius=0.018", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string page = contentOf(out + "/report.html");
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const std::size_t begin = page.find(open) + open.size();
  const json data = json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  EXPECT_EQ(data["set"]["TRI.radius"], 0.018);
  EXPECT_EQ(data["parameters"][0]["value"], 0.018);
  EXPECT_FALSE(data["parameters"][0].contains("before"));
  const std::string text = data["files"][model].get<std::string>();
  EXPECT_THAT(text, HasSubstr("0.018"));
  EXPECT_NE(text, contentOf(model));
}

TEST(SetOption, IsRefusedForARobotsSystem) {
  const ProgramResult result =
      runFisherHill({"discover", slow, "--system", "double-pendulum", "--set", "m=1"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("--set cannot be combined with --system"));
}

}  // namespace
