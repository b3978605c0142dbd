#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

namespace {

using support::contentOf;
using support::linesOf;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::HasSubstr;
using testing::Not;

const std::string ankle = std::string(FISHERHILL_SOURCE_DIR) + "/models/ankle_ta.osim";

/// Columns of a .sto file by name.
std::vector<double> columnOf(const std::string& file, const std::string& name) {
  std::vector<double> values;
  std::ptrdiff_t place = -1;
  for (const std::string& line : linesOf(contentOf(file))) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, '\t');) cells.push_back(cell);
    if (place >= 0) values.push_back(std::stod(cells.at(static_cast<std::size_t>(place))));
    const auto at = std::find(cells.begin(), cells.end(), name);
    if (at != cells.end()) place = at - cells.begin();
  }
  return values;
}

/// A contraction while the ankle turns from 30° of plantarflexion at 15°/s; the moment is 0 or
/// given.
void writeTrial(const std::filesystem::path& file, const std::vector<double>& moment,
                const std::string& extra = "") {
  std::ofstream out(file);
  out << "time,TA,ankle_angle_deg,ankle_angle.moment" << extra << "\n";
  for (int k = 0; k <= 150; ++k) {
    const double t = 0.01 * k;
    const double u = 0.05 + 0.5 * std::pow(std::sin(std::numbers::pi * t), 2);
    out << fmt::format("{:.2f},{:.6f},{:.6f},", t, u, -30 + 15 * t);
    if (!moment.empty()) out << fmt::format("{:.9g}", moment.at(static_cast<std::size_t>(k)));
    if (moment.empty()) out << 0;
    if (!extra.empty()) out << "," << 0;
    out << "\n";
  }
}

TEST(Dynamometer, TheMomentIsSimulatedComparedAndCalibratedOn) {
  const ScratchFolder scratch;
  const std::string trial = (scratch / "trial.csv").string();
  const std::string out = (scratch / "out").string();
  writeTrial(trial, {});
  ProgramResult result =
      runFisherHill({"replay", ankle, trial, "--prescribe", "ankle_angle", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  std::vector<double> moment = columnOf(out + "/forces.sto", "ankle_angle.reaction");
  ASSERT_EQ(moment.size(), 151u);
  for (double& value : moment) value = -value;
  EXPECT_LT(moment.front(), 0);                                   // tissues resist dorsiflexion,
  EXPECT_GT(*std::max_element(moment.begin(), moment.end()), 5);  // the muscle causes it
  EXPECT_EQ(columnOf(out + "/states.sto", "/jointset/ankle/ankle_angle/value").size(), 151u);

  // compared with itself there is no error
  writeTrial(trial, moment);
  result = runFisherHill(
      {"replay", ankle, trial, "--prescribe", "ankle_angle", "--out", out, "--force"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto replay = nlohmann::json::parse(contentOf(out + "/summary.json"));
  EXPECT_LT(replay["rms_error"]["ankle_angle.moment"]["value"].get<double>(), 1e-6);
  EXPECT_EQ(replay["rms_error"]["ankle_angle.moment"]["unit"], "N·m");
  EXPECT_EQ(replay["prescribed"][0], "ankle_angle");
  EXPECT_FALSE(replay.contains("rms_error_deg"));
  const std::string report = contentOf(out + "/report.html");
  EXPECT_THAT(report, HasSubstr("Simulated and measured ankle_angle.moment"));
  EXPECT_THAT(report, HasSubstr("Reaction moments"));

  // a calibration that starts elsewhere comes back
  const std::string fitted = (scratch / "fitted").string();
  result = runFisherHill({"calibrate", ankle, trial, "--prescribe", "ankle_angle", "--parameters",
                          "TA.max_isometric_force", "--prior", "TA.max_isometric_force=900:500",
                          "--noise", "ankle_angle.moment=0.5", "--out", fitted});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(contentOf(fitted + "/summary.json"));
  EXPECT_NEAR(json["estimates"]["TA.max_isometric_force"]["value"].get<double>(), 1227, 1);
  EXPECT_TRUE(json["rmse_train_deg"].is_null());
  EXPECT_EQ(json["channels"]["ankle_angle.moment"]["noise"], 0.5);
  EXPECT_LT(json["channels"]["ankle_angle.moment"]["rmse_train"].get<double>(), 0.02);
  EXPECT_THAT(contentOf(fitted + "/report.html"), HasSubstr("ankle_angle.moment [N m]"));

  // and what else would tell is told
  const std::string told = (scratch / "told").string();
  result = runFisherHill({"sensitivity", ankle, trial, "--prescribe", "ankle_angle", "--observe",
                          "ankle_angle.moment=0.5", "--parameters",
                          "TA.max_isometric_force,TA.optimal_fiber_length", "--out", told});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto sensitivity = nlohmann::json::parse(contentOf(told + "/summary.json"));
  ASSERT_FALSE(sensitivity["further_channels"].empty());
  double last = std::numeric_limits<double>::infinity();
  for (const auto& channel : sensitivity["further_channels"]) {
    EXPECT_LE(channel["information_nats"].get<double>(), last);
    last = channel["information_nats"].get<double>();
    EXPECT_LE(channel["bound_after"].get<double>(), channel["bound_before"].get<double>());
  }
  EXPECT_THAT(sensitivity["further_channels"].dump(), HasSubstr("TA.fiber_length"));
}

TEST(Dynamometer, ALockedJointHasAMomentToo) {
  const ScratchFolder scratch;
  const std::string trial = (scratch / "trial.csv").string();
  const std::string out = (scratch / "out").string();
  {
    std::ofstream file(trial);
    file << "time,TA,ankle_angle.moment\n0,0.3,0\n0.5,0.3,\n1,0.3,0\n";
  }
  ProgramResult result =
      runFisherHill({"replay", ankle, trial, "--lock", "ankle_angle=-20deg", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::vector<double> q = columnOf(out + "/states.sto", "/jointset/ankle/ankle_angle/value");
  for (const double value : q) EXPECT_NEAR(value, -20 * std::numbers::pi / 180, 1e-12);
  const auto reaction = columnOf(out + "/forces.sto", "ankle_angle.reaction");
  EXPECT_NEAR(reaction.back(), reaction[reaction.size() - 5], 1e-3);  // the fibre has come to rest

  // without the column, on request
  {
    std::ofstream file(trial);
    file << "time,TA\n0,0.3\n1,0.3\n";
  }
  result = runFisherHill({"replay", ankle, trial, "--lock", "ankle_angle=-20deg", "--reactions",
                          "--out", out, "--force"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NEAR(columnOf(out + "/forces.sto", "ankle_angle.reaction").back(), reaction.back(), 1e-9);
}

/// The ankle's model with a motion of its own.
std::string prescribingModel(const ScratchFolder& scratch, const std::string& function,
                             const std::string& name = "prescribing.osim") {
  std::string text = contentOf(ankle);
  const std::string at = "<default_value>0</default_value>";
  text.replace(text.find(at), at.size(),
               at + "<prescribed>true</prescribed><prescribed_function>" + function +
                   "</prescribed_function>");
  return scratch.file(name, text);
}

const std::string turning =
    fmt::format("<LinearFunction><coefficients>{:.17g} {:.17g}</coefficients></LinearFunction>",
                std::numbers::pi / 12, -std::numbers::pi / 6);

TEST(Dynamometer, TheModelsOwnFunctionIsAPrescribedMotion) {
  const ScratchFolder scratch;
  const std::string trial = (scratch / "trial.csv").string();
  writeTrial(trial, {});
  const auto run = [&](const std::string& model, const std::string& out,
                       const std::vector<std::string>& more) {
    std::vector<std::string> words{"replay", model, trial, "--out", (scratch / out).string()};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = runFisherHill(words);
    EXPECT_EQ(result.status, 0) << result.err;
    return nlohmann::json::parse(contentOf((scratch / out / "summary.json").string()));
  };
  const auto reactionOf = [&](const std::string& out) {
    return columnOf((scratch / out / "forces.sto").string(), "ankle_angle.reaction");
  };
  const auto angleOf = [&](const std::string& out) {
    return columnOf((scratch / out / "states.sto").string(), "/jointset/ankle/ankle_angle/value");
  };
  run(ankle, "column", {"--prescribe", "ankle_angle"});
  const std::string model = prescribingModel(scratch, turning);
  const auto summary = run(model, "function", {});
  EXPECT_EQ(summary["prescribed"][0], "ankle_angle");
  const auto wanted = reactionOf("column"), found = reactionOf("function");
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    EXPECT_NEAR(found[k], wanted[k], 1e-6);
    EXPECT_NEAR(angleOf("function")[k], angleOf("column")[k], 1e-6);
  }

  // a column overrides it, and so does another role
  const std::string still =
      prescribingModel(scratch, "<Constant><value>0</value></Constant>", "still.osim");
  EXPECT_NEAR(angleOf("function").back(), -7.5 * std::numbers::pi / 180, 1e-6);
  run(still, "still", {});
  EXPECT_NEAR(angleOf("still").back(), 0, 1e-12);
  run(still, "overridden", {"--prescribe", "ankle_angle"});
  EXPECT_NEAR(reactionOf("overridden").back(), wanted.back(), 1e-9);
  {
    std::ofstream file(trial);
    file << "time,TA\n0,0.1\n1,0.1\n";
  }
  run(model, "locked", {"--lock", "ankle_angle=-20deg", "--reactions"});
  EXPECT_NEAR(angleOf("locked").back(), -20 * std::numbers::pi / 180, 1e-12);
  EXPECT_FALSE(run(model, "free", {"--coordinate", "ankle_angle"}).contains("prescribed"));
  EXPECT_GT(std::abs(angleOf("free").back() + 0.2618), 0.05);
}

TEST(Dynamometer, CalibrationKeepsTheModelsOwnFunction) {
  const ScratchFolder scratch;
  const std::string trial = (scratch / "trial.csv").string(), out = (scratch / "out").string();
  const std::string model = prescribingModel(scratch, turning);
  writeTrial(trial, {});
  ProgramResult result = runFisherHill({"replay", model, trial, "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  std::vector<double> moment = columnOf(out + "/forces.sto", "ankle_angle.reaction");
  for (double& value : moment) value = -value;
  writeTrial(trial, moment);
  const std::string fitted = (scratch / "fitted").string();
  result = runFisherHill({"calibrate", model, trial, "--parameters", "TA.max_isometric_force",
                          "--prior", "TA.max_isometric_force=900:500", "--noise",
                          "ankle_angle.moment=0.5", "--out", fitted});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(contentOf(fitted + "/summary.json"));
  EXPECT_NEAR(json["estimates"]["TA.max_isometric_force"]["value"].get<double>(), 1227, 1);
  const std::string written = contentOf(fitted + "/calibrated.osim");
  EXPECT_THAT(written, HasSubstr("<prescribed>true</prescribed>"));
  EXPECT_THAT(written, HasSubstr(fmt::format("{:.17g}", std::numbers::pi / 12)));
}

TEST(Dynamometer, WhatCannotFollowTheModelsFunctionSaysSo) {
  const ScratchFolder scratch;
  const std::string trial = (scratch / "trial.csv").string();
  {
    std::ofstream file(trial);
    file << "time,TA,ankle_angle\n0,0.1,0\n0.5,0.1,0\n1,0.1,0\n";
  }
  const auto refused = [&](const std::vector<std::string>& words, const std::string& why) {
    const ProgramResult result = runFisherHill(words);
    EXPECT_EQ(result.status, 2) << result.out;
    EXPECT_THAT(result.err, HasSubstr(why));
  };
  const std::string known = prescribingModel(scratch, turning);
  refused({"discover", known, trial, "--out", (scratch / "d").string()},
          "no trial measures the moment of one that is prescribed");
  refused({"design", known, trial, "--parameters", "TA.max_isometric_force", "--out",
           (scratch / "e").string()},
          "no coordinate is free to be observed");
  const std::string unknown =
      prescribingModel(scratch, "<GCVSpline><x>0 1 2</x><y>0 0 0</y></GCVSpline>", "unknown.osim");
  refused({"replay", unknown, trial, "--out", (scratch / "r").string()},
          "by a function of a class that is not known");
  const ProgramResult given = runFisherHill(
      {"replay", unknown, trial, "--prescribe", "ankle_angle", "--out", (scratch / "g").string()});
  EXPECT_EQ(given.status, 0) << given.err;
  EXPECT_THAT(given.err, HasSubstr("its prescribed_function is a GCVSpline"));
  const ProgramResult checked = runFisherHill({"check", unknown, known});
  EXPECT_THAT(checked.out + checked.err, HasSubstr("its prescribed_function is a GCVSpline"));
}

// Locked comes first: a function that is not used need not be known, and hinders no writing.
TEST(Dynamometer, ALockedCoordinateDoesNotNeedItsFunction) {
  const ScratchFolder scratch;
  const std::string model =
      prescribingModel(scratch, "<GCVSpline><x>0 1 2</x><y>0 0 0</y></GCVSpline>", "locked.osim");
  std::string text = contentOf(model);
  const std::string at = "<locked>false</locked>";
  if (text.find(at) == std::string::npos) {
    text.replace(text.find("<prescribed>true"), 0, "<locked>true</locked>");
  } else {
    text.replace(text.find(at), at.size(), "<locked>true</locked>");
  }
  const std::string locked = scratch.file("locked.osim", text);
  const std::string trial = scratch.file(
      "trial.csv", "time,TA,ankle_angle.moment\n0,0.1,2\n0.5,0.2,3\n1,0.3,4\n1.5,0.3,4\n");
  const std::string out = (scratch / "out").string();
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, {"--convert-muscles", "Thelen2003"}}) {
    std::vector<std::string> words = {
        "calibrate", locked, trial,    "--parameters", "TA.max_isometric_force",
        "--out",     out,    "--force"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = runFisherHill(words);
    EXPECT_LE(result.status, 1) << result.err;
    EXPECT_THAT(result.err, Not(HasSubstr("GCVSpline")));
    const std::string written = contentOf(out + "/calibrated.osim");
    EXPECT_EQ(written.find("GCVSpline") != std::string::npos, more.empty());
    EXPECT_THAT(written, HasSubstr("<locked>true</locked>"));
  }
}

// Its angle is not what is fitted, which is said once.
TEST(Dynamometer, AMeasuredColumnThatTheModelPrescribesIsNotFittedAndSaysSo) {
  const ScratchFolder scratch;
  const std::string model = prescribingModel(scratch, turning);
  const std::string trial = (scratch / "trial.csv").string(),
                    other = (scratch / "other.csv").string();
  writeTrial(trial, std::vector<double>(151, 1.0));
  writeTrial(other, std::vector<double>(151, 2.0));
  const auto remarks = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {
        "calibrate", model, trial, "--hold-out", other, "--parameters", "TA.max_isometric_force"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = runFisherHill(words);
    EXPECT_LE(result.status, 1) << result.err;
    return result.err;
  };
  const std::string told = remarks({});
  EXPECT_THAT(told, HasSubstr(trial + ", " + other +
                              ": the measured 'ankle_angle' is not part of the fit, since the "
                              "model prescribes the motion of 'ankle_angle'"));
  const auto first = told.find("not part of the fit");
  EXPECT_EQ(told.find("not part of the fit", first + 1), std::string::npos) << told;
  EXPECT_THAT(remarks({"--prescribe", "ankle_angle"}), Not(HasSubstr("not part of the fit")));
}

TEST(Dynamometer, WrongUseIsToldInOneLine) {
  const ScratchFolder scratch;
  const std::string trial = (scratch / "trial.csv").string();
  writeTrial(trial, {});
  const auto refused = [&](std::vector<std::string> arguments, const char* words) {
    arguments.insert(arguments.begin(), {"replay", ankle, trial});
    const ProgramResult result = runFisherHill(arguments);
    EXPECT_EQ(result.status, 2) << words;
    EXPECT_THAT(result.err, HasSubstr(words));
  };
  refused({}, "'ankle_angle.moment' is measured, but 'ankle_angle' is free to move");
  refused({"--prescribe", "ankle"}, "has no coordinate called 'ankle'");
  refused({"--prescribe", "ankle_angle", "--coordinate", "ankle_angle"},
          "must be free or prescribed");
  refused({"--prescribe", "ankle_angle", "--lock", "ankle_angle=0"},
          "must be locked or prescribed");
  refused({"--prescribe", "ankle_angle", "--initial", "ankle_angle=0"}, "its motion is prescribed");
  refused({"--lock", "ankle_angle=0"}, "at which 'ankle_angle' is locked");
  refused({"--prescribe", "ankle_angle", "--prescribe-cutoff", "0"}, "--prescribe-cutoff");
  {
    std::ofstream file(trial);
    file << "time,TA,ankle_angle_deg\n0,0.1,\n0.5,0.1,3\n1,0.1,4\n";
  }
  refused({"--prescribe", "ankle_angle"}, "must have them from the first row to the last");
  {
    std::ofstream file(trial);
    file << "time,TA\n0,0.1\n1,0.1\n";
  }
  refused({"--prescribe", "ankle_angle"}, "has no column 'ankle_angle', must have one");
}

}  // namespace
