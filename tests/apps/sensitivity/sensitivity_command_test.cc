#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

namespace {

using support::linesOf;
using support::model;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::HasSubstr;

const std::string trial = "emg_data/curl_slow.sto";

// Figure 3.7 of the thesis: millimetres of wrap radius change the motion by degrees.
TEST(SensitivityCommand, TwoMillimetresOfTricepsRadiusChangeTheAngleByDegrees) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result =
      runFisherHill({"sensitivity", model, trial, "--parameter", "TRI.radius", "--values",
                     "0.012,0.014,0.018,0.02", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(support::contentOf(out + "/summary.json"));
  const auto& runs = json["sweep"]["runs"];
  ASSERT_EQ(runs.size(), 4u);
  EXPECT_GT(runs[1]["max_change_deg"].get<double>(), 2);
  EXPECT_GT(runs[2]["max_change_deg"].get<double>(), 2);
  EXPECT_GT(runs[3]["rms_change_deg"].get<double>(), runs[2]["rms_change_deg"].get<double>());
  const auto lines = linesOf(support::contentOf(out + "/sweep.csv"));
  EXPECT_EQ(lines.size(), 452u);
  EXPECT_EQ(lines[0],
            "time,elbow_flexion_deg,TRI.radius=0.012,TRI.radius=0.014,TRI.radius=0.018,"
            "TRI.radius=0.02");
  EXPECT_THAT(support::contentOf(out + "/report.html"),
              HasSubstr("elbow_flexion for 4 values of TRI.radius"));
}

TEST(SensitivityCommand, TellsAllParametersTheirBoundsAndWhatCannotBeToldApart) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result =
      runFisherHill({"sensitivity", model, trial, "emg_data/curl_fast.sto", "--all", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto lines = linesOf(support::contentOf(out + "/sensitivity.csv"));
  EXPECT_EQ(lines[0],
            "parameter,unit,value,normalised_sensitivity,bound_alone,bound_joint,identifiable");
  EXPECT_EQ(lines.size(), 286u);
  for (const std::string& line : lines) EXPECT_EQ(std::count(line.begin(), line.end(), ','), 6);
  EXPECT_EQ(linesOf(support::contentOf(out + "/fisher.csv")).size(), 286u);
  const auto json = nlohmann::json::parse(support::contentOf(out + "/summary.json"));
  EXPECT_EQ(json["parameters"].size(), 285u);
  EXPECT_EQ(json["samples"], 902);
  EXPECT_GT(json["cost_ratio"].get<double>(), 1);
  EXPECT_GT(json["parameters"][0]["normalised_sensitivity"].get<double>(), 1);
  EXPECT_LE(json["parameters"][0]["bound_alone"].get<double>(),
            json["parameters"][0]["bound_joint"].get<double>());
  EXPECT_GE(json["not_told_apart"].size(), 3u);
  EXPECT_EQ(json["inputs"].size(), 3u);
  for (const char* title : {"Influence on the motion", "Identifiability",
                            "Parameters that are not separately identifiable"}) {
    EXPECT_THAT(support::contentOf(out + "/report.html"), HasSubstr(title));
  }
}

TEST(SensitivityCommand, ProfilesAndLooksOverTheWholeRange) {
  const ScratchFolder scratch;
  const auto run = [&](const std::string& folder, const std::string& threads) {
    return runFisherHill({"sensitivity", model, trial, "--parameters", "TRI.radius,hand.mass",
                          "--profile", "TRI.radius", "--global", "both", "--samples", "4",
                          "--threads", threads, "--out", (scratch / folder).string()});
  };
  ASSERT_EQ(run("one", "1").status, 0);
  ASSERT_EQ(run("two", "2").status, 0);
  const std::string global = support::contentOf(scratch / "one" / "global.csv");
  EXPECT_EQ(global, support::contentOf(scratch / "two" / "global.csv"));
  EXPECT_EQ(linesOf(global).size(), 3u);
  const auto json = nlohmann::json::parse(support::contentOf(scratch / "one" / "summary.json"));
  EXPECT_EQ(json["profile"]["bounded_below"], true);
  EXPECT_EQ(json["profile"]["bounded_above"], true);
  EXPECT_EQ(json["morris_runs"], 12);
  EXPECT_EQ(json["sobol_runs"], 16);
  EXPECT_EQ(linesOf(support::contentOf(scratch / "one" / "profile.csv")).size(), 14u);
}

TEST(SensitivityCommand, ListsItsParametersWithoutATrial) {
  const ProgramResult result = runFisherHill({"sensitivity", model, "--list-parameters"});
  EXPECT_EQ(result.status, 0) << result.err;
  for (const char* name : {"TRI.radius", "BRA.tendon_slack_length", "hand.mass", "emg.delay",
                           "initial.elbow_flexion", "activation.time_scale"}) {
    EXPECT_THAT(result.out, HasSubstr(name));
  }
}

TEST(SensitivityCommand, ListsItsParametersAsJson) {
  const ProgramResult result = runFisherHill({"sensitivity", model, "--list-parameters", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto list = nlohmann::json::parse(result.out);
  EXPECT_EQ(list.size(), 292u);  // 285 and seven groups
  const auto mass = std::find_if(list.begin(), list.end(),
                                 [](const auto& one) { return one["name"] == "hand.mass"; });
  ASSERT_NE(mass, list.end());
  EXPECT_EQ((*mass)["unit"], "kg");
  EXPECT_GT((*mass)["value"].get<double>(), (*mass)["lower"].get<double>());
}

}  // namespace
