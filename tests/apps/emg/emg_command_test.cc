#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "libbio/tables/binary_samples.h"
#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::Contains;
using testing::HasSubstr;

// Two columns without a header: something like an EMG at 100 Hz, an angle at 50 Hz.
std::string columns() {
  std::string text;
  for (int i = 0; i < 300; ++i) {
    text +=
        std::to_string((i * 37) % 101 - 50) + "\t" + (i < 150 ? std::to_string(i) : "") + "\r\n";
  }
  return text;
}

const std::string config =
    "[[channel]]\ncolumn = 1\nname = \"biceps\"\nrate_Hz = 100\nunit = \"mV\"\n"
    "[[channel]]\ncolumn = 2\nname = \"angle\"\nrate_Hz = 50\nunit = \"deg\"\n"
    "[bandpass]\nlow_Hz = 10\nhigh_Hz = 40\n"
    "[[electrode]]\nchannel = \"biceps\"\nmuscles = [\"BRA\", \"BRD\"]\n"
    "[measured]\nchannel = \"angle\"\n";

TEST(EmgCommand, WritesATrialASummaryAndAReport) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runFisherHill({"emg", scratch.file("raw.txt", columns()), "--config",
                                              scratch.file("c.toml", config), "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string trial = support::contentOf(out + "/excitations.sto");
  EXPECT_THAT(trial, HasSubstr("time\tBRA\tBRD\telbow_flexion_deg\n"));
  const auto json = nlohmann::json::parse(support::contentOf(out + "/summary.json"));
  EXPECT_EQ(json["format"], "columns");
  EXPECT_EQ(json["rows"], 599);
  EXPECT_EQ(json["measured_values"], 150);
  EXPECT_EQ(json["inputs"].size(), 2u);
  EXPECT_THAT(support::contentOf(out + "/report.html"), HasSubstr("they share one time course"));
  // what it wrote is a trial that the program itself accepts
  EXPECT_EQ(runFisherHill({"check", out + "/excitations.sto"}).status, 0);
}

TEST(EmgCommand, TellsBadInputInOneLineAndLeavesNothingBehind) {
  const ScratchFolder scratch;
  const std::string raw = scratch.file("raw.txt", columns());
  const std::string word = scratch.file("word.txt", "1\t2\n3\tx\n");
  const std::string good = scratch.file("c.toml", config);
  const std::string bad = scratch.file("bad.toml", config + "unit = \"V\"\n");
  const std::string fast = scratch.file(
      "fast.toml", "[bandpass]\nhigh_Hz = 60\n" + config.substr(0, config.find("[bandpass]")) +
                       config.substr(config.find("[[electrode]]")));
  const std::string out = (scratch / "out").string();
  const auto fails = [&](const std::vector<std::string>& arguments, const std::string& message) {
    const ProgramResult result = runFisherHill(arguments);
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(std::filesystem::exists(out));
  };
  fails({"emg", raw, "--config", bad, "--out", out}, "bad.toml:19: [measured] unknown key 'unit'");
  fails({"emg", raw, "--config", fast, "--out", out}, "upper band edge 60 Hz");
  fails({"emg", word, "--config", good, "--out", out}, "word.txt:2: column 2: 'x' is not a number");
  fails({"emg", raw, "--out", out}, "--config");
  fails({"emg", raw, "--config", (scratch / "none.toml").string(), "--out", out}, "none.toml");
}

// A C3D file, and a table of semicolons and decimal commas on a clock of its own.
TEST(EmgCommand, JoinsRecordingsOfTwoClocks) {
  const ScratchFolder scratch;
  support::C3dSample sample;
  sample.frames = 100;  // 400 samples at 400 Hz
  std::string table = "Time [ms];knee [deg]\n";
  for (int i = 0; i < 120; ++i) {
    table += std::to_string(5000 + 10 * i) + ";" + std::to_string(i) + ",5\n";
  }
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runFisherHill(
      {"emg", scratch.file("emg.c3d", sample.write()), scratch.file("knee.csv", table), "--config",
       scratch.file("c.toml",
                    "[bandpass]\nlow_Hz = 10\nhigh_Hz = 190\n"
                    "[[recording]]\noffset_s = -5.1\n"
                    "[[electrode]]\nchannel = 'BIC'\nmuscles = ['BIClong']\n"
                    "[[column]]\nchannel = 'knee [deg]'\nname = 'knee_deg'\nscale = -2\n"),
       "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(support::contentOf(out + "/summary.json"));
  EXPECT_EQ(json["format"], "c3d");
  EXPECT_EQ(json["further_recordings"][0]["offset_s"], -5.1);
  EXPECT_EQ(json["inputs"].size(), 3u);
  const std::vector<std::string> lines =
      support::linesOf(support::contentOf(out + "/excitations.sto"));
  const auto names = std::find(lines.begin(), lines.end(), "time\tBIClong\tknee_deg");
  ASSERT_NE(names, lines.end());
  // at 0 s the knee's own time is 5.1 s: 10.5 degrees, turned round and doubled
  EXPECT_TRUE((names + 1)->ends_with("\t-21")) << *(names + 1);
}

// A recording of our own in the columns of the shipped configuration: 6 s, three columns of
// different length, tabs, carriage returns, an EMG with an offset and a line of 120 Hz, an angle
// that goes beyond the instrument's end stop.
std::string goniometerRecording(double& clipped) {
  constexpr int emgRows = 6000, angleRows = 300, constantRows = 5900;
  std::string text;
  std::uint32_t state = 1;
  int beyond = 0;
  for (int k = 0; k < emgRows; ++k) {
    const double t = 0.001 * k, effort = std::pow(std::sin(std::numbers::pi * t / 2), 2);
    state = state * 1664525u + 1013904223u;
    const double noise = static_cast<double>(state >> 8) / (1 << 24) - 0.5;
    const double emg = 135 + 2000 * effort * noise + 40 * std::sin(2 * std::numbers::pi * 120 * t);
    text += std::to_string(std::lround(emg)) + '\t';
    if (k < angleRows) {
      const double angle = -2900 - 1150 * std::sin(std::numbers::pi * 0.02 * k / 1.5);
      beyond += angle < -4000 ? 1 : 0;
      text += std::to_string(std::lround(std::max(angle, -4000.0)));
    }
    text += '\t';
    if (k < constantRows) text += "31";
    text += "\r\n";
  }
  clipped = static_cast<double>(beyond) / angleRows;
  return text;
}

TEST(EmgCommand, RunsOnAGoniometerRecordingWithTheShippedConfiguration) {
  const ScratchFolder scratch;
  double clipped = 0;
  const std::string raw = scratch.file("curls.txt", goniometerRecording(clipped));
  ASSERT_GT(clipped, 0.05);
  const ProgramResult result =
      runFisherHill({"emg", raw, "--config", "emg_data/configs/goniometer.toml", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_THAT(json["muscles"], testing::ElementsAre("BIClong", "BICshort", "BRA", "BRD"));
  EXPECT_THAT(json["remarks"], Contains(HasSubstr("does not show how they share the load")));
  // samples at the stop itself count as clipped: one on either side of a peak may round to it
  EXPECT_NEAR(json["measured_fraction_missing"].get<double>(), clipped, 0.02);
}

}  // namespace
