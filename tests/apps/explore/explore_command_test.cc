#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

namespace {

using support::contentOf;
using support::model;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using support::slow;
using testing::HasSubstr;
using testing::Not;

/// What the page reads.
nlohmann::json dataOf(const std::string& page) {
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const std::size_t begin = page.find(open) + open.size();
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

TEST(ExploreCommand, WritesOnePageThatHoldsEverything) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result =
      runFisherHill({"explore", model, slow, "--parameters", "TRI.radius,hand.mass", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string page = contentOf(out + "/report.html");
  EXPECT_LT(page.size(), 3'000'000u);
  for (const char* outside : {"src=\"http", "href=\"http", "@import", "connect-src"})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  const nlohmann::json data = dataOf(page);
  EXPECT_EQ(data["files"][model].get<std::string>(),
            contentOf(std::string(FISHERHILL_SOURCE_DIR "/") + model));
  EXPECT_EQ(data["files"][slow].get<std::string>(),
            contentOf(std::string(FISHERHILL_SOURCE_DIR "/") + slow));
  ASSERT_EQ(data["parameters"].size(), 2u);
  EXPECT_EQ(data["parameters"][0]["name"], "TRI.radius");
  EXPECT_EQ(data["parameters"][1]["unit"], "kg");
  EXPECT_EQ(data["trials"][0]["channels"][0]["times"].size(), 451u);
}

TEST(ExploreCommand, KnowsWhatTheTrialsSayAsSensitivityDoes) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  ASSERT_EQ(runFisherHill({"explore", model, slow, "--parameters", "TRI.radius,hand.mass",
                           "--noise", "2", "--out", out})
                .status,
            0);
  const nlohmann::json data = dataOf(contentOf(out + "/report.html"));
  const ProgramResult bounds = runFisherHill({"sensitivity", model, slow, "--parameters",
                                              "TRI.radius,hand.mass", "--noise", "2", "--json"});
  const nlohmann::json told = nlohmann::json::parse(bounds.out);
  for (const auto& parameter : data["parameters"]) {
    bool isFound = false;
    for (const auto& one : told["parameters"]) {
      if (one["name"] != parameter["name"]) continue;
      isFound = true;
      EXPECT_NEAR(parameter["sd"].get<double>() / one["bound_joint"].get<double>(), 1, 1e-6);
    }
    EXPECT_TRUE(isFound);
  }
}

TEST(ExploreCommand, RefusesWhatAPageCannotDo) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const auto refused = [&](std::vector<std::string> words) {
    const ProgramResult result = runFisherHill(words);
    EXPECT_EQ(result.status, 2);
    EXPECT_FALSE(std::filesystem::exists(out));
    return result.err;
  };
  EXPECT_THAT(refused({"explore", model, slow}), HasSubstr("--out is required"));
  EXPECT_THAT(refused({"explore", model, slow, "--integrator", "cvode", "--out", out}),
              HasSubstr("vi, vi-left and rk4"));
  EXPECT_THAT(refused({"explore", model, slow, "--parameters", "TRI.diameter", "--out", out}),
              HasSubstr("TRI.diameter"));
  EXPECT_THAT(refused({"explore", model, slow, "--noise", "0", "--out", out}),
              HasSubstr("must be > 0"));
  EXPECT_THAT(refused({"explore", model, slow, "--verdict", "models", "--out", out}),
              HasSubstr("verdict.json"));
}

// The page's core reads trials as replay does.
TEST(ExploreCommand, CarriesPrescribedMotionsAsTheyAreSmoothed) {
  const ScratchFolder scratch;
  std::string rows = "time,BRA,BIClong,elbow_flexion_deg,pro_sup_deg\n";
  for (int k = 0; k <= 80; ++k) {
    rows += std::to_string(0.01 * k) + ",0.1,0.08," + std::to_string(40 + 0.2 * k) + "," +
            std::to_string(10 + 0.3 * k + (k % 2 ? 3 : -3)) + "\n";
  }
  const std::string trial = scratch.file("trial.csv", rows), out = (scratch / "out").string();
  const ProgramResult result =
      runFisherHill({"explore", model, trial, "--prescribe", "pro_sup", "--prescribe-cutoff", "20",
                     "--parameters", "BRA.max_isometric_force", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json data = dataOf(contentOf(out + "/report.html"));
  EXPECT_THAT(data["options"].get<std::string>(), HasSubstr("--prescribe-cutoff 20"));
  const std::string carried = scratch.file("carried.csv", data["files"][trial].get<std::string>());
  const auto errorOf = [](const std::string& file, std::vector<std::string> more) {
    std::vector<std::string> words = {"replay", model, file, "--prescribe", "pro_sup", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return nlohmann::json::parse(runFisherHill(words).out)["rms_error_deg"].get<double>();
  };
  const double smoothed = errorOf(trial, {"--prescribe-cutoff", "20"});
  EXPECT_NEAR(errorOf(carried, {}), smoothed, 1e-9);
  EXPECT_GT(std::abs(errorOf(trial, {}) - smoothed), 1e-6);
}

TEST(ReplayWithSet, TakesOtherValuesOfParameters) {
  const ScratchFolder scratch;
  const auto replayed = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {"replay", model, slow, "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return runFisherHill(words);
  };
  const auto errorOf = [](const ProgramResult& result) {
    return nlohmann::json::parse(result.out)["rms_error_deg"].get<double>();
  };
  const double asGiven = errorOf(replayed({}));
  // the model's own value changes nothing
  const nlohmann::json list = nlohmann::json::parse(
      runFisherHill({"sensitivity", model, "--list-parameters", "--json"}).out);
  double mass = 0;
  for (const auto& one : list)
    if (one["name"] == "hand.mass") mass = one["value"];
  EXPECT_EQ(errorOf(replayed({"--set", "hand.mass=" + nlohmann::json(mass).dump()})), asGiven);
  EXPECT_GT(std::abs(errorOf(replayed({"--set", "hand.mass=1.2"})) - asGiven), 1);
  // of electrodes and of the start, too
  EXPECT_NE(errorOf(replayed({"--set", "emg.BRA.gain=1.5"})), asGiven);
  EXPECT_NE(errorOf(replayed({"--set", "initial.elbow_flexion=0.7"})), asGiven);
  EXPECT_THAT(replayed({"--set", "hand.mass"}).err, HasSubstr("is not NAME=VALUE"));
  EXPECT_THAT(replayed({"--set", "hand.mass=x"}).err, HasSubstr("x"));
  EXPECT_THAT(replayed({"--set", "hand.weight=1"}).err, HasSubstr("hand.mass"));
  EXPECT_EQ(replayed({"--set", "hand.mass=1", "--set", "hand.mass=2"}).status, 2);
}

}  // namespace
