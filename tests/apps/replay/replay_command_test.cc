#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

namespace {

using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr const char* straightLine = "apart: the excitation between them is taken as a straight";

TEST(ReplayCommand, RemarksOnRowsThatDoNotShowTheExcitation) {
  const ScratchFolder scratch;
  const auto warningsOf = [&](double interval, double excitation) {
    const std::string trial = scratch.file(
        "trial.csv",
        fmt::format("time,BRA\n0,0.1\n{},{}\n{},0.1\n", interval, excitation, 2 * interval));
    const ProgramResult replayed = runFisherHill({"replay", support::model, trial, "--json"});
    const ProgramResult checked = runFisherHill({"check", support::model, trial, "--json"});
    EXPECT_EQ(replayed.status, 0) << replayed.err;
    EXPECT_EQ(checked.status, 0) << checked.err;
    EXPECT_EQ(checked.out.find(straightLine) == std::string::npos,
              replayed.err.find(straightLine) == std::string::npos);
    return nlohmann::json::parse(replayed.out)["warnings"];
  };
  EXPECT_THAT(
      warningsOf(0.25, 0.12),
      Contains(AllOf(HasSubstr("trial.csv: time: rows are up to 0.25 s apart: the excitation"),
                     HasSubstr("at 20 Hz or more"))));
  EXPECT_THAT(warningsOf(0.1, 0.12), Not(Contains(HasSubstr(straightLine))));
  EXPECT_THAT(warningsOf(0.25, 0.1), Not(Contains(HasSubstr(straightLine))));
}

// Angles of 50 Hz that were interpolated to the rows of the EMG.
TEST(ReplayCommand, RemarksOnAnInterpolatedAngle) {
  const ScratchFolder scratch;
  std::string rows = "time,BRA,elbow_flexion_deg\n", recorded = rows;
  for (int k = 0; k <= 100; ++k) {
    const auto angle = [](int i) { return 60 + 2 * std::sin(0.2 * i) + 0.1 * std::sin(17.0 * i); };
    const double value = angle(k / 4) + 0.25 * (k % 4) * (angle(k / 4 + 1) - angle(k / 4));
    const std::string time = fmt::format("{:.3f},{:.4f},", 0.005 * k, 0.05 + 0.0001 * k);
    rows += time + fmt::format("{:.6f}\n", value);
    recorded += time + (k % 4 == 0 ? fmt::format("{:.6f}\n", value) : "\n");
  }
  const auto warnings = [&](const std::string& text) {
    const std::string file = scratch.file("trial.csv", text);
    const ProgramResult result = runFisherHill({"replay", support::model, file, "--json"});
    const ProgramResult checked = runFisherHill({"check", support::model, file, "--json"});
    const auto found = nlohmann::json::parse(result.out)["warnings"];
    EXPECT_EQ(checked.out.find("1 value in") == std::string::npos,
              found.dump().find("1 value in") == std::string::npos);
    return found;
  };
  EXPECT_THAT(warnings(rows), Contains(HasSubstr("measured 'elbow_flexion': 1 value in 4 was")));
  EXPECT_THAT(warnings(recorded), Not(Contains(HasSubstr("1 value in"))));
}

/// The figure of a report, as its script gets it; null if there is none.
nlohmann::json figureOf(const std::string& report, const std::string& title) {
  const std::string begin = "{\"title\":\"" + title + "\"";
  const auto at = report.find(begin);
  if (at == std::string::npos) return {};
  return nlohmann::json::parse(report.substr(at, report.find("</script>", at) - at));
}

TEST(ReplayCommand, DrawsTheExcitationsThatTheTrialGives) {
  const ScratchFolder scratch;
  const std::string trial = scratch.file(
      "trial.csv", "time,BRA,TRIlong\n0,0.1,0.01\n0.05,0.3,0.01\n0.1,0.2,0.02\n0.15,0.1,0.02\n");
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runFisherHill({"replay", support::model, trial, "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string report = support::contentOf(out + "/report.html");
  const nlohmann::json figure = figureOf(report, "Excitations");
  ASSERT_EQ(figure["series"].size(), 2u) << figure;  // of eight muscles
  EXPECT_EQ(figure["series"][0]["name"], "TRIlong");
  EXPECT_EQ(figure["series"][1]["name"], "BRA");
  EXPECT_EQ(figure["series"][1]["x"], nlohmann::json({0, 0.05, 0.1, 0.15}));
  EXPECT_EQ(figure["series"][1]["y"], nlohmann::json({0.1, 0.3, 0.2, 0.1}));
  EXPECT_EQ(figureOf(report, "Activations")["series"].size(), 8u);
}

}  // namespace
