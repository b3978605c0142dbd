#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "libbio/tables/binary_samples.h"
#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr const char* goodTrial = "time,BIClong\n0,0.1\n0.1,0.2\n0.2,0.1\n";

long lines(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

TEST(CheckCommand, AGoodTrialIsStatusZero) {
  const ScratchFolder scratch;
  const ProgramResult result = runFisherHill({"check", scratch.file("good.csv", goodTrial)});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
}

TEST(CheckCommand, TellsWhatRecordingsHold) {
  const ScratchFolder scratch;
  support::XdfSample xdf;
  xdf.streamHeader(1, "EMG", 1, 100, "int16", support::XdfSample::label("BIC", "uV"));
  const std::string one = support::XdfSample::int16({1}), two = support::XdfSample::int16({2});
  xdf.chunk(3, support::XdfSample::samples(1, {5, 5.01}, {one, two}));
  const std::string trc =
      "PathFileType\t4\nDataRate\tNumFrames\tNumMarkers\tUnits\n50\t1\t1\tmm\n"
      "Frame#\tTime\tHIP\n\n1\t0\t1\t2\t3\n";
  const ProgramResult result =
      runFisherHill({"check", scratch.file("a.c3d", support::C3dSample{}.write()),
                     scratch.file("b.xdf", xdf.bytes), scratch.file("c.trc", trc), "--json"});
  EXPECT_EQ(result.status, 0) << result.err;
  const auto held = nlohmann::json::parse(result.out)["recordings"];
  EXPECT_THAT(held[0]["markers"], ElementsAre("HEAD", "ELBOW"));
  EXPECT_EQ(held[0]["channels"][1]["name"], "TRI");
  EXPECT_EQ(held[1]["channels"][0]["unit"], "uV");
  EXPECT_EQ(held[2]["frame_rate_Hz"], 50);
  const ProgramResult broken = runFisherHill({"check", scratch.file("d.c3d", "\x02\x50")});
  EXPECT_EQ(broken.status, 1);
  EXPECT_THAT(broken.out, HasSubstr("d.c3d: is no C3D file"));
}

// One line for all points that no camera saw, not one for each of them or of their frames.
TEST(CheckCommand, TellsUnseenPointsInOneLine) {
  const ScratchFolder scratch;
  support::C3dSample sample;
  sample.isSeen = [](unsigned, unsigned) { return false; };
  const std::string file = scratch.file("a.c3d", sample.write());
  const ProgramResult result = runFisherHill({"check", file});
  const std::string told = result.out + result.err;
  EXPECT_THAT(told, HasSubstr("2 of 2 markers are never seen: HEAD, ELBOW"));
  const auto seen = told.find("never seen");
  EXPECT_EQ(told.find("never seen", seen + 1), std::string::npos) << told;
}

TEST(CheckCommand, JsonIsTheSummaryAlone) {
  const ScratchFolder scratch;
  const std::string file = scratch.file("good.csv", goodTrial);
  const ProgramResult result = runFisherHill({"check", file, "--json"});
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["subcommand"], "check");
  EXPECT_EQ(json["errors"], 0);
  EXPECT_EQ(json["inputs"][0]["path"], file);
  EXPECT_EQ(json["command_line"], "fisherhill check " + file + " --json");
}

TEST(CheckCommand, WritesSummaryAndReportIntoANewFolder) {
  const ScratchFolder scratch;
  const std::string file = scratch.file("good.csv", goodTrial);
  const std::string out = (scratch / "a/b").string();
  const ProgramResult result = runFisherHill({"check", file, "--out", out});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(scratch.listing(), ElementsAre("a", "a/b", "a/b/report.html", "a/b/reproduce.sh",
                                             "a/b/summary.json", "good.csv"));
  const auto json = nlohmann::json::parse(support::contentOf(out + "/summary.json"));
  EXPECT_THAT(json["files"], ElementsAre("report.html", "reproduce.sh"));
  EXPECT_THAT(result.out, HasSubstr("Report: " + out + "/report.html"));
}

TEST(CheckCommand, AnExistingResultIsKeptUnlessForced) {
  const ScratchFolder scratch;
  const std::string file = scratch.file("good.csv", goodTrial);
  std::filesystem::create_directory(scratch / "out");
  scratch.file("out/summary.json", "old");
  const std::vector<std::string> arguments = {"check", file, "--out", (scratch / "out").string()};
  const ProgramResult refused = runFisherHill(arguments);
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("summary.json exists already; --force overwrites it"));
  EXPECT_EQ(support::contentOf(scratch / "out/summary.json"), "old");
  EXPECT_THAT(scratch.listing(), ElementsAre("good.csv", "out", "out/summary.json"));

  std::vector<std::string> forced = arguments;
  forced.push_back("--force");
  EXPECT_EQ(runFisherHill(forced).status, 0);
  EXPECT_NE(support::contentOf(scratch / "out/summary.json"), "old");
}

struct BadFile {
  const char* name;
  const char* content;
  const char* message;  ///< a part of the one line
};

class CheckBadFile : public testing::TestWithParam<BadFile> {};

TEST_P(CheckBadFile, IsNamedInOneLineAndIsStatusOne) {
  const ScratchFolder scratch;
  const std::string file = scratch.file(GetParam().name, GetParam().content);
  const ProgramResult result = runFisherHill({"check", file, "--json"});
  EXPECT_EQ(result.status, 1) << result.err << result.out;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["errors"], 1);
  const std::string message = json["findings"][0]["message"];
  EXPECT_THAT(message, testing::StartsWith(file));
  EXPECT_THAT(message, HasSubstr(GetParam().message));
  EXPECT_EQ(lines(message), 0);
}

INSTANTIATE_TEST_SUITE_P(
    All, CheckBadFile,
    testing::Values(
        BadFile{"empty.csv", "", "empty.csv"}, BadFile{"head_only.csv", "time,BIClong\n", "row"},
        BadFile{"no_time.csv", "t,BIClong\n0,1\n", "time"},
        BadFile{"back.csv", "time,BIClong\n0,0\n0.2,0\n0.1,0\n", "back.csv:4"},
        BadFile{"same.csv", "time,BIClong\n0,0\n0,0\n", "same.csv:3"},
        BadFile{"word.csv", "time,BIClong\n0,0\n0.1,much\n", "word.csv:3"},
        BadFile{"short.csv", "time,BIClong\n0,0\n0.1\n", "short.csv:3"},
        BadFile{"long.csv", "time,BIClong\n0,0\n0.1,0,0\n", "long.csv:3"},
        BadFile{"twice.csv", "time,BIClong,BIClong\n0,0,0\n", "BIClong"},
        BadFile{"nan_time.csv", "time,BIClong\n0,0\nnan,0\n", "nan_time.csv:3"},
        BadFile{"no_end.sto", "trial\nnRows=1\nnColumns=2\n", "endheader"},
        BadFile{"count.sto", "trial\nnRows=3\nnColumns=2\nendheader\ntime\ta\n0\t0\n", "count.sto"},
        BadFile{"empty.osim", "", "empty.osim"}, BadFile{"text.osim", "hello\n", "text.osim"},
        BadFile{"open.osim", "<OpenSimDocument Version=\"40000\">\n<Model>\n", "open.osim"},
        BadFile{"other.osim", "<html><body/></html>\n", "other.osim"},
        BadFile{"nomodel.osim", "<OpenSimDocument Version=\"40000\"/>\n", "nomodel.osim"}),
    [](const auto& test) {
      std::string name = test.param.name;
      for (char& c : name) c = c == '.' ? '_' : c;
      return name;
    });

TEST(CheckCommand, MatchesATrialsColumnsWithTheModel) {
  const ScratchFolder scratch;
  const std::string rows = "0,0.1,0.2\n0.1,0.2,0.3\n";
  const std::string good = scratch.file("good.csv", "time,BIClong,elbow_flexion_deg\n" + rows);
  const ProgramResult fits = runFisherHill({"check", good, "models/elbow8.osim"});
  EXPECT_EQ(fits.status, 0) << fits.out;
  EXPECT_THAT(fits.out,
              HasSubstr("7 of 8 muscles have no column, their excitation is 0.01: TRIlong, "));

  const std::string bad = scratch.file("bad.csv", "time,BIClong,GLUTmax\n" + rows);
  const ProgramResult differs = runFisherHill({"check", bad, "models/elbow8.osim"});
  EXPECT_EQ(differs.status, 1);
  EXPECT_THAT(differs.out, HasSubstr("error: " + bad));
  EXPECT_THAT(differs.out, HasSubstr("GLUTmax"));
}

// A line with a gap behind every value would not be seen.
TEST(CheckCommand, DrawsWhatWasMeasuredInEveryOtherRow) {
  const ScratchFolder scratch;
  const std::string file = scratch.file(
      "sparse.csv", "time,BIClong,elbow_flexion\n0,0.1,0.5\n0.1,0.2,\n0.2,0.1,0.7\n0.3,0.1,\n");
  const std::string out = (scratch / "out").string();
  EXPECT_EQ(runFisherHill({"check", file, "--out", out}).status, 0);
  const std::string report = support::contentOf(out + "/report.html");
  EXPECT_THAT(report, HasSubstr(R"("x":[0.0,0.2],"y":[0.5,0.7])"));
}

TEST(CheckCommand, ListsWhereLengthsOfMusclesJump) {
  const ProgramResult result = runFisherHill({"check", "models/elbow8.osim"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("the length of BRA jumps by 5.26 mm at elbow_flexion = 0 deg"));
  EXPECT_THAT(result.out, Not(HasSubstr("the length of TRI")));
}

// moment-arms tells of those within what it is asked for.
TEST(MomentArmsCommand, WarnsOfLengthsThatJump) {
  const std::vector<std::string> range = {
      "moment-arms", "models/elbow8.osim", "--from", "-20", "--to", "130", "--json"};
  const ProgramResult result = runFisherHill(range);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out + result.err, HasSubstr("the length of BRA jumps by 5.26 mm"));
  const ProgramResult above =
      runFisherHill({"moment-arms", "models/elbow8.osim", "--from", "1", "--to", "130", "--json"});
  EXPECT_THAT(above.out + above.err, Not(HasSubstr("jumps by")));
}

// The elbow with the triceps' cylinder as an ellipsoid across which it runs askew.
std::string elbowWithAnEllipsoid(const ScratchFolder& scratch) {
  std::string text = support::contentOf(std::string(FISHERHILL_SOURCE_DIR) + "/models/elbow8.osim");
  const auto replaceFrom = [&](std::size_t from, const std::string& old, const std::string& by) {
    text.replace(text.find(old, from), old.size(), by);
  };
  const std::size_t at = text.find("<WrapCylinder name=\"TRI\">");
  replaceFrom(at, "-0.14015 -0.00628319 0.154985", "0.8 0 0.155");
  replaceFrom(at, "<radius>0.016</radius>", "<dimensions>0.02 0.012 0.012</dimensions>");
  replaceFrom(at, "<length>0.1</length>", "");
  replaceFrom(at, "</WrapCylinder>", "</WrapEllipsoid>");
  replaceFrom(at, "<WrapCylinder", "<WrapEllipsoid");
  return scratch.file("ellipsoid.osim", text);
}

TEST(CheckCommand, SaysWhereOpenSimsPathsOverEllipsoidsDiffer) {
  const ScratchFolder scratch;
  const std::string model = elbowWithAnEllipsoid(scratch);
  const ProgramResult arms = runFisherHill({"moment-arms", model, "--from", "0", "--to", "130",
                                            "--json", "--out", (scratch / "out").string()});
  ASSERT_EQ(arms.status, 0) << arms.err;
  const auto summary = nlohmann::json::parse(arms.out);
  const auto& differences = summary["opensim_differences"];
  ASSERT_EQ(differences.size(), 3u);  // the three heads
  for (const auto& one : differences) {
    EXPECT_EQ(one["muscle"].get<std::string>().substr(0, 3), "TRI");
    EXPECT_EQ(one["ellipsoids"], nlohmann::json({"TRI"}));
    EXPECT_GT(one["length_mm"], 0.1);  // a plane section is longer than the geodesic
    EXPECT_GE(one["apart_deg"][0][0], 0);
  }
  EXPECT_THAT(
      summary["warnings"].dump(),
      HasSubstr("in OpenSim the path of TRIlong over TRI differs from the taut string by up to"));
  EXPECT_THAT(support::contentOf((scratch / "out/report.html").string()),
              HasSubstr("Paths over ellipsoids: OpenSim less the taut string"));
  const ProgramResult check = runFisherHill({"check", model});
  EXPECT_EQ(check.status, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("in OpenSim the path of TRIlong over TRI differs"));
  const ProgramResult without =
      runFisherHill({"moment-arms", "models/elbow8.osim", "--from", "0", "--to", "130", "--json"});
  EXPECT_TRUE(nlohmann::json::parse(without.out)["opensim_differences"].empty());
}

TEST(CheckCommand, TheShippedModelsHaveNoErrorAndNoWarning) {
  for (const char* model : {"models/elbow8.osim", "models/elbow8_passive.osim"}) {
    const ProgramResult result = runFisherHill({"check", model, "--json"});
    EXPECT_EQ(result.status, 0) << model;
    EXPECT_EQ(nlohmann::json::parse(result.out)["warnings_found"], 0) << model;
  }
}

TEST(FisherHill, WithoutASubcommandIsStatusTwo) {
  const ProgramResult result = runFisherHill({});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(lines(result.err), 1);
}

TEST(FisherHill, EverySubcommandHasHelpWithAnExample) {
  const ProgramResult help = runFisherHill({"--help"});
  EXPECT_EQ(help.status, 0);
  std::istringstream text(help.out.substr(help.out.find("Subcommands:")));
  std::string line;
  std::getline(text, line);
  int subcommands = 0;
  while (std::getline(text, line) && line.starts_with("  ")) {
    if (line.starts_with("   ")) continue;  // the purpose of the one above
    const std::string name = line.substr(2, line.find(' ', 2) - 2);
    const ProgramResult one = runFisherHill({name, "--help"});
    EXPECT_EQ(one.status, 0) << name;
    EXPECT_THAT(one.out, HasSubstr("Example:\n  fisherhill " + name)) << name;
    EXPECT_THAT(one.out, HasSubstr("--out DIR")) << name;
    ++subcommands;
  }
  EXPECT_GT(subcommands, 0);
}

TEST(CheckCommand, TellsManyJumpsOfAMuscleInOneLine) {
  const ScratchFolder scratch;
  std::string text = support::contentOf(std::string(FISHERHILL_SOURCE_DIR) + "/models/elbow8.osim");
  const std::string old = "<range>0 0.813149</range>";
  std::size_t at = 0;
  for (const std::string range : {"<range>0.2 0.8</range>", "<range>0.4 1</range>"}) {
    at = text.find(old, at);
    ASSERT_NE(at, text.npos);
    text.replace(at, old.size(), range);
  }
  const ProgramResult result = runFisherHill({"check", scratch.file("jumps.osim", text)});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("muscle 'BRA': its length or moment arm jumps 3 times along "
                                    "elbow_flexion, at 11.46 to 57.3 deg; most: the length of BRA "
                                    "jumps by 2.78 mm at elbow_flexion = 11.46 deg"));
}

}  // namespace
