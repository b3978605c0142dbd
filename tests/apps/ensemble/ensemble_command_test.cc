#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <sstream>

#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

namespace {

using support::contentOf;
using support::linesOf;
using support::model;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using support::slow;
using testing::HasSubstr;

using Words = std::vector<std::string>;

/// `ensemble` on the shipped elbow with what comes behind; `before` starts it, as mpirun does.
ProgramResult runEnsemble(const std::string& out, Words more, Words before = {}) {
  Words words = std::move(before);
  for (const std::string& word : Words{FISHERHILL_PROGRAM, "ensemble", model, slow, "--out", out}) {
    words.push_back(word);
  }
  words.insert(words.end(), more.begin(), more.end());
  return support::runProgram(words, FISHERHILL_SOURCE_DIR);
}

const Words four = {"--draws", "40",  "--parameters", "TRI.radius,hand.mass,BRA.*_length",
                    "--step",  "0.02"};

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> parts;
  std::istringstream text(line);
  for (std::string part; std::getline(text, part, ',');) parts.push_back(part);
  return parts;
}

nlohmann::json summaryIn(const std::string& folder) {
  return nlohmann::json::parse(contentOf(folder + "/summary.json"));
}

/// The result files that say nothing of when and how they were made.
std::string resultsIn(const std::string& folder) {
  return contentOf(folder + "/draws.csv") + contentOf(folder + "/band.csv");
}

/// All results have their names, and the rows that the folder was made of are gone.
bool isDone(const std::string& folder) {
  return std::filesystem::exists(folder + "/summary.json") &&
         !std::filesystem::exists(folder + "/unfinished.csv");
}

/// Starts `ensemble` and ends it by a signal, later and later until it has finished rows.
ProgramResult endedAtWork(const std::string& out, const Words& work, const std::string& signal) {
  ProgramResult result;
  for (double limit = 0.2; limit < 60; limit *= 1.6) {
    // --foreground: one signal, not another one for the whole group, which would end it at once
    result =
        runEnsemble(out, work, {"timeout", "--foreground", "-s", signal, std::to_string(limit)});
    if (linesOf(contentOf(out + "/unfinished.csv")).size() > 4) break;
  }
  return result;
}

TEST(EnsembleCommand, GivesARowForEveryDrawWithItsParametersAndOutputs) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runEnsemble(out, four);
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out,
              HasSubstr("40 of 40 simulations with 4 drawn parameters reached the end"));
  const auto lines = linesOf(contentOf(out + "/draws.csv"));
  ASSERT_EQ(lines.size(), 41u);
  EXPECT_EQ(
      lines[0],
      "draw,outcome,failed_at_s,rms_error_deg,rms_from_nominal_deg,final_deg,min_deg,max_deg,"
      "TRI.radius [m],hand.mass [kg],BRA.optimal_fiber_length [m],BRA.tendon_slack_length [m]");
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < 40; ++i) {
    const auto row = cells(lines[i + 1]);
    EXPECT_EQ(row[0], std::to_string(i));
    EXPECT_EQ(row[1], "ok");
    EXPECT_EQ(row[2], "");
    EXPECT_LE(std::stod(row[6]), std::stod(row[5]));
    EXPECT_LE(std::stod(row[5]), std::stod(row[7]));
    const double radius = std::stod(row[8]);
    sum += radius;
    squares += (radius - 0.016) * (radius - 0.016);
  }
  // the catalogue's law of a radius: normal about the model's value with 15 % of it
  EXPECT_NEAR(sum / 40, 0.016, 4 * 0.0024 / std::sqrt(40));
  EXPECT_NEAR(std::sqrt(squares / 40), 0.0024, 0.001);
  const auto json = summaryIn(out);
  EXPECT_EQ(json["draws"], 40);
  EXPECT_EQ(json["outcomes"]["ok"], 40);
  EXPECT_GT(json["final_deg"]["sd"].get<double>(), 1);
  EXPECT_EQ(json["rms_from_nominal_deg"]["nominal"], 0);
  EXPECT_EQ(linesOf(contentOf(out + "/band.csv")).size(), 47u);
  EXPECT_THAT(contentOf(out + "/report.html"), HasSubstr("elbow_flexion over the ensemble"));
  EXPECT_EQ(scratch.listing(),
            (Words{"out", "out/band.csv", "out/draws.csv", "out/report.html", "out/summary.json"}));
}

// The draw's own parameters, given to replay's model by another command, give its outputs.
TEST(EnsembleCommand, ADrawIsWhatASweepOfItsValueGives) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  ASSERT_EQ(runEnsemble(out, {"--draws", "2", "--parameters", "TRI.radius"}).status, 0);
  const auto row = cells(linesOf(contentOf(out + "/draws.csv"))[2]);
  const std::string other = (scratch / "sweep").string();
  ASSERT_EQ(runFisherHill({"sensitivity", model, slow, "--parameter", "TRI.radius", "--values",
                           row[8], "--out", other})
                .status,
            0);
  const auto run = summaryIn(other)["sweep"]["runs"][0];
  EXPECT_NEAR(run["rms_change_deg"].get<double>(), std::stod(row[4]), 1e-7);
}

TEST(EnsembleCommand, SameSeedSameBytesWhateverTheThreadsAndOtherSeedOthers) {
  const ScratchFolder scratch;
  const auto results = [&](const std::string& folder, const Words& more) {
    const std::string out = (scratch / folder).string();
    EXPECT_EQ(runEnsemble(out, with(four, more)).status, 0);
    return resultsIn(out);
  };
  const std::string one = results("one", {"--threads", "1"});
  EXPECT_EQ(one, results("two", {"--threads", "2"}));
  EXPECT_NE(one, results("other", {"--seed", "2"}));
}

TEST(EnsembleCommand, GoesOnAfterAKillAndGivesTheSameBytes) {
  const ScratchFolder scratch;
  const std::string whole = (scratch / "whole").string(), cut = (scratch / "cut").string();
  const Words work = {"--draws", "3000", "--parameters", "hand.mass", "--step", "0.02"};
  ASSERT_EQ(runEnsemble(whole, work).status, 0);
  int kills = 0;
  ProgramResult last;
  for (int i = 0; i < 40; ++i) {
    const std::string limit = std::to_string(0.04 * std::pow(1.4, i));
    last = runEnsemble(cut, with(work, {"--threads", "1"}), {"timeout", "-s", "KILL", limit});
    if (last.status != 137) break;
    ++kills;
    if (isDone(cut)) break;  // killed as it was about to end
    // a kill in the middle of a row: the file ends anywhere
    const std::string growing = cut + "/unfinished.csv";
    const std::string content = contentOf(growing);
    if (i % 2 == 0 && content.size() > 400) {
      std::filesystem::resize_file(growing, content.size() - 11);
    }
  }
  ASSERT_TRUE(isDone(cut)) << last.err;
  EXPECT_GT(kills, 0);
  EXPECT_EQ(resultsIn(cut), resultsIn(whole));
  EXPECT_LT(summaryIn(cut)["computed"].get<int>(), 3000);
  EXPECT_FALSE(std::filesystem::exists(cut + "/unfinished.csv"));
}

TEST(EnsembleCommand, RefusesToGoOnWithOtherSettings) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const Words many = {"--draws", "100000", "--parameters", "hand.mass"};
  ASSERT_EQ(endedAtWork(out, many, "KILL").status, 137);
  const std::string before = contentOf(out + "/unfinished.csv");
  for (const auto& [more, words] : std::vector<std::pair<Words, std::string>>{
           {{"--seed", "2"}, "seed is 1 there, 2 here"},
           {{"--step", "0.02"}, "step_s is 0.01 there, 0.02 here"},
           {{"--spread", "2"}, "(parameters is [[\"hand.mass\""},
           {{"--sobol"}, "scheme is \"draws\" there, \"sobol\" here"}}) {
    const ProgramResult result = runEnsemble(out, with(many, more));
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(linesOf(result.err).size(), 1u) << result.err;
    EXPECT_THAT(result.err, HasSubstr(words));
  }
  EXPECT_EQ(contentOf(out + "/unfinished.csv"), before);
  // fewer draws are not other settings: what is there already is taken
  const ProgramResult less = runEnsemble(out, {"--draws", "3", "--parameters", "hand.mass"});
  EXPECT_EQ(less.status, 0) << less.err;
  EXPECT_EQ(summaryIn(out)["computed"], 0);
}

TEST(EnsembleCommand, GoesOnAfterAKillWhileItNamesTheResults) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string(), growing = out + "/unfinished.csv";
  const Words many = {"--draws", "100000", "--parameters", "hand.mass"};
  const Words few = {"--draws", "3", "--parameters", "hand.mass"};
  ASSERT_EQ(endedAtWork(out, many, "KILL").status, 137);
  const std::string rows = contentOf(growing);
  ASSERT_EQ(runEnsemble(out, few).status, 0);
  const std::string results = resultsIn(out);
  // some have their names, and the rows are there still
  std::ofstream(growing) << rows;
  std::filesystem::remove(out + "/summary.json");
  const ProgramResult other = runEnsemble(out, with(few, {"--seed", "2"}));
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("seed is 1 there, 2 here"));
  EXPECT_EQ(resultsIn(out), results);
  const ProgramResult again = runEnsemble(out, few);
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(resultsIn(out), results);
  EXPECT_FALSE(std::filesystem::exists(growing));
  // without them nothing is overwritten
  EXPECT_EQ(runEnsemble(out, few).status, 2);
}

TEST(EnsembleCommand, CtrlCKeepsWhatIsDoneAndSaysHowToGoOn) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const Words many = {"--draws", "100000", "--parameters", "hand.mass"};
  const ProgramResult result = endedAtWork(out, many, "INT");
  EXPECT_THAT(result.err, HasSubstr("run the same command again to continue"));
  EXPECT_THAT(result.err, HasSubstr("interrupted; finished parts are in " + out));
  EXPECT_GT(linesOf(contentOf(out + "/unfinished.csv")).size(), 2u);
}

/// Two parameters and how they hang together, ρ = −0.75.
const char* const twoTogether =
    "parameter,TRI.radius,hand.mass\nTRI.radius,1e-06,-1.5e-05\nhand.mass,-1.5e-05,4e-04\n";

TEST(EnsembleCommand, DrawsTogetherWhatACovarianceHoldsTogether) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const std::string file = scratch.file("c.csv", twoTogether);
  const Words work = {
      "--draws", "400",  "--covariance", file,
      "--step",  "0.05", "--parameters", "BRA.pennation_angle,hand.mass,TRI.radius"};
  ASSERT_EQ(runEnsemble(out, with(work, {"--threads", "2"})).status, 0);
  const auto lines = linesOf(contentOf(out + "/draws.csv"));
  ASSERT_EQ(lines.size(), 401u);
  EXPECT_TRUE(lines[0].ends_with("BRA.pennation_angle [rad],hand.mass [kg],TRI.radius [m]"));
  std::array<std::vector<double>, 3> draws;
  for (std::size_t k = 1; k <= 400; ++k) {
    const auto row = cells(lines[k]);
    for (std::size_t i = 0; i < 3; ++i) draws[i].push_back(std::stod(row[8 + i]));
  }
  const auto covariance = [&](std::size_t i, std::size_t j) {
    const auto mean = [](const std::vector<double>& x) {
      return std::accumulate(x.begin(), x.end(), 0.0) / 400;
    };
    const double a = mean(draws[i]), b = mean(draws[j]);
    double sum = 0;
    for (std::size_t k = 0; k < 400; ++k) sum += (draws[i][k] - a) * (draws[j][k] - b);
    return sum / 399;
  };
  const double pennation = covariance(0, 0);
  const double wanted[3][3] = {{pennation, 0, 0}, {0, 4e-4, -1.5e-5}, {0, -1.5e-5, 1e-6}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double error =
          std::sqrt((wanted[i][i] * wanted[j][j] + wanted[i][j] * wanted[i][j]) / 400);
      EXPECT_NEAR(covariance(i, j), wanted[i][j], 4 * error) << i << ' ' << j;
    }
  }
  const std::string one = (scratch / "one").string();
  ASSERT_EQ(runEnsemble(one, with(work, {"--threads", "1"})).status, 0);
  EXPECT_EQ(resultsIn(one), resultsIn(out));
}

TEST(EnsembleCommand, ACovarianceAloneSaysWhatIsDrawn) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const std::string file = scratch.file("c.csv", twoTogether);
  ASSERT_EQ(runEnsemble(out, {"--draws", "3", "--covariance", file}).status, 0);
  EXPECT_TRUE(linesOf(contentOf(out + "/draws.csv"))[0].ends_with("TRI.radius [m],hand.mass [kg]"));
  EXPECT_EQ(summaryIn(out)["inputs"][2]["path"], file);
}

TEST(EnsembleCommand, RefusesACovarianceThatIsNoneInOneLine) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const std::string good = scratch.file("good.csv", twoTogether);
  const std::string tied = scratch.file("tied.csv", "TRI.radius,hand.mass\n1e-6,3e-5\n3e-5,4e-4\n");
  const std::string other = scratch.file("other.csv", "TRI.radius,nothing\n1,0\n0,1\n");
  const std::string spelt =
      scratch.file("spelt.csv", "BRA.pennation,BRA.pennation_angle\n1,0\n0,1\n");
  for (const auto& [more, words] : std::vector<std::pair<Words, std::string>>{
           {{"--covariance", tied}, "tied.csv: not positive definite: the smallest eigenvalue"},
           {{"--covariance", other}, "other.csv: "},
           {{"--covariance", spelt}, "spelt.csv: BRA.pennation_angle is listed under another name"},
           {{"--covariance", good, "--parameters", "hand.mass"},
            "good.csv: TRI.radius is not one of the --parameters"},
           {{"--covariance", good, "--prior", "hand.mass=0.5:0.1"},
            "--prior: hand.mass already has its distribution from --covariance"},
           {{"--covariance", good, "--sobol"}, "--covariance cannot be combined with --sobol"},
           {{"--covariance", good, "--distribution", "uniform"},
            "--covariance cannot be combined with --distribution uniform"}}) {
    const ProgramResult result = runEnsemble(out, more);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(linesOf(result.err).size(), 1u) << result.err;
    EXPECT_THAT(result.err, HasSubstr(words));
  }
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(EnsembleCommand, SobolsIndicesSayWhichParameterMovesTheEnd) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runEnsemble(
      out, {"--draws", "32", "--sobol", "--parameters", "TRI.radius,hand.mass,BRA.pennation_angle",
            "--output", "max", "--distribution", "uniform", "--step", "0.02"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto sobol = summaryIn(out)["sobol"];
  EXPECT_EQ(sobol["output"], "max");
  EXPECT_EQ(summaryIn(out)["draws"], 32 * 5);
  double sum = 0;
  for (const auto& index : sobol["indices"]) {
    const double total = index["total"].get<double>();
    EXPECT_LE(index["total_interval"][0].get<double>(), total);
    EXPECT_GE(index["total_interval"][1].get<double>(), total);
    sum += total;
  }
  EXPECT_GT(sum, 0.9);  // at least the whole variance
  EXPECT_LT(sobol["indices"][2]["total"].get<double>(), 0.01);
  const auto lines = linesOf(contentOf(out + "/sobol.csv"));
  EXPECT_EQ(lines[0], "output,parameter,first,first_low,first_high,total,total_low,total_high");
  EXPECT_EQ(lines.size(), 4u);
}

/// A folder of data sets "a", "b", …: half a second of a shipped trial each, shifted by rows.
void writeSets(const ScratchFolder& scratch, int count) {
  const auto lines = linesOf(contentOf(FISHERHILL_SOURCE_DIR "/emg_data/hidden_a/train_1.sto"));
  const auto header =
      static_cast<std::size_t>(std::find(lines.begin(), lines.end(), "endheader") - lines.begin());
  for (int set = 0; set < count; ++set) {
    std::string text = "cut\nversion=1\nnRows=51\nnColumns=10\ninDegrees=no\n";
    for (std::size_t i = header; i < header + 2; ++i) text += lines[i] + "\n";
    for (std::size_t i = 0; i < 51; ++i) {
      text += lines[header + 2 + i + 30 * static_cast<std::size_t>(set)] + "\n";
    }
    const std::string folder = std::string("sets/") + static_cast<char>('a' + set);
    std::filesystem::create_directories(scratch / folder);
    scratch.file(folder + "/train_1.sto", text);
  }
  std::filesystem::create_directories(scratch / "sets/of_no_use");
}

const Words quick = {"--noise-deg", "5", "--max-effects", "1"};

ProgramResult discoverSets(const ScratchFolder& scratch, const std::string& out, const Words& more,
                           Words before = {}) {
  Words words = std::move(before);
  for (const std::string& word :
       {std::string(FISHERHILL_PROGRAM), std::string("ensemble"), model, std::string("--discover"),
        (scratch / "sets").string(), std::string("--out"), (scratch / out).string()}) {
    words.push_back(word);
  }
  return support::runProgram(with(with(words, quick), more), FISHERHILL_SOURCE_DIR);
}

TEST(EnsembleCommand, AsksOfEveryDataSetWhatDiscoverAsksOfOne) {
  const ScratchFolder scratch;
  writeSets(scratch, 2);
  const ProgramResult result = discoverSets(scratch, "out", {});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(linesOf(result.out).front().find("Of 2 data sets: "), 0u) << result.out;
  const auto lines = linesOf(contentOf(scratch / "out/verdicts.csv"));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0], "set,verdict,effects,probability,gap_closed_train,gap_closed_held_out");
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string name(1, static_cast<char>('a' + i));
    const ProgramResult alone = runFisherHill(
        with({"discover", model, (scratch / ("sets/" + name + "/train_1.sto")).string(), "--out",
              (scratch / ("alone_" + name)).string()},
             quick));
    ASSERT_EQ(alone.status, 0) << alone.err;
    auto one = nlohmann::json::parse(contentOf(scratch / ("alone_" + name + "/verdict.json")));
    auto many =
        nlohmann::json::parse(contentOf(scratch / ("out/verdicts/" + name + "/verdict.json")));
    for (const char* time : {"wall_s", "processor_s"}) {
      one.erase(time);
      many.erase(time);
    }
    EXPECT_EQ(one, many);
    EXPECT_EQ(lines[i + 1].find(name + "," + one["verdict"].get<std::string>() + ","), 0u);
  }
  // nothing is asked twice
  std::filesystem::remove_all(scratch / "out/verdicts");
  EXPECT_THAT(discoverSets(scratch, "out", {}).err, HasSubstr("verdicts.csv exists already"));
}

TEST(EnsembleCommand, DiscoveryGoesOnAfterAKillAndLooksAtNoSetTwice) {
  const ScratchFolder scratch;
  writeSets(scratch, 3);
  ASSERT_EQ(discoverSets(scratch, "whole", {}).status, 0);
  ProgramResult last;
  std::string before;
  for (int i = 0; i < 60; ++i) {
    last = discoverSets(scratch, "cut", {"--threads", "1"},
                        {"timeout", "-s", "KILL", std::to_string(0.25 * std::pow(1.6, i))});
    if (last.status != 137 || isDone((scratch / "cut").string())) break;
    const std::string growing = contentOf(scratch / "cut/unfinished.csv");
    EXPECT_TRUE(growing.starts_with(before));
    before = growing;
  }
  ASSERT_TRUE(isDone((scratch / "cut").string())) << last.err;
  EXPECT_EQ(contentOf(scratch / "cut/verdicts.csv"), contentOf(scratch / "whole/verdicts.csv"));
  const auto rows = linesOf(before).size();
  EXPECT_EQ(summaryIn((scratch / "cut").string())["computed"], 3 - (rows < 2 ? 0 : rows - 2));
}

#ifdef FISHERHILL_MPIRUN

Words ranks(int n) {
  const std::string leaks = "ASAN_OPTIONS=detect_leaks=0";  // Open MPI's own, in sanitized builds
  return {FISHERHILL_MPIRUN, "--oversubscribe", "--allow-run-as-root", "-x", leaks, "-n",
          std::to_string(n)};
}

TEST(EnsembleCommand, SameBytesWhateverTheRanks) {
  const ScratchFolder scratch;
  const std::string alone = (scratch / "alone").string();
  ASSERT_EQ(runEnsemble(alone, four).status, 0);
  for (const int n : {1, 2, 4}) {
    const std::string out = (scratch / std::to_string(n)).string();
    const Words threads = {"--threads", n == 2 ? "2" : "1"};
    const ProgramResult result = runEnsemble(out, with(four, threads), ranks(n));
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(summaryIn(out)["ranks"], n);
    EXPECT_EQ(resultsIn(out), resultsIn(alone));
  }
}

TEST(EnsembleCommand, RanksShareTheDataSets) {
  const ScratchFolder scratch;
  writeSets(scratch, 2);
  ASSERT_EQ(discoverSets(scratch, "alone", {}).status, 0);
  const ProgramResult result = discoverSets(scratch, "ranks", {}, ranks(2));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(contentOf(scratch / "ranks/verdicts.csv"), contentOf(scratch / "alone/verdicts.csv"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "ranks/verdicts/b/verdict.json"));
}

/// Whether a program lives that was started with this word.
bool isAlive(const std::string& word) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    if (contentOf(entry.path() / "cmdline").find(word) != std::string::npos) return true;
  }
  return false;
}

TEST(EnsembleCommand, CtrlCStopsEveryRankKeepsTheRowsAndTheSameCommandGoesOn) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string(), growing = out + "/unfinished.csv";
  const Words work = {"--parameters", "hand.mass", "--step", "0.02"};
  const Words many = with({"--draws", "100000"}, work), few = with({"--draws", "20"}, work);
  // Ctrl-C as soon as there are rows; mpirun hears it in a group of its own, as on a terminal
  const std::string untilRows =
      "set -m; \"$@\" & job=$!; for i in {1..1200}; do sleep 0.05; "
      "[ \"$(wc -l < \"$0\")\" -gt 40 ] && break; done 2>/dev/null; kill -INT $job; wait $job";
  const ProgramResult result =
      runEnsemble(out, many, with({"bash", "-c", untilRows, growing}, ranks(3)));
  EXPECT_NE(result.status, 0);
  EXPECT_THAT(result.err, HasSubstr("run the same command again to continue"));
  EXPECT_FALSE(isAlive(out));
  std::set<std::string> numbers;
  for (const std::string& line : linesOf(contentOf(growing))) numbers.insert(cells(line)[0]);
  std::size_t there = 0;
  for (int i = 0; i < 20; ++i) there += numbers.count(std::to_string(i));
  ASSERT_EQ(runEnsemble(out, few, ranks(2)).status, 0);
  EXPECT_EQ(summaryIn(out)["computed"], 20 - there);
  const std::string alone = (scratch / "alone").string();
  ASSERT_EQ(runEnsemble(alone, few).status, 0);
  EXPECT_EQ(resultsIn(out), resultsIn(alone));
}

TEST(EnsembleCommand, OnlyOneRankSaysWhatIsWrong) {
  const ScratchFolder scratch;
  for (const Words& more : {Words{"--draws", "0"}, Words{"--parameters", "nothing"}}) {
    const ProgramResult result = runEnsemble((scratch / "out").string(), more, ranks(3));
    EXPECT_EQ(result.status, 2);
    const auto lines = linesOf(result.err);
    EXPECT_EQ(std::count_if(lines.begin(), lines.end(),
                            [](const std::string& line) {
                              return line.starts_with("fisherhill ensemble: ");
                            }),
              1)
        << result.err;
  }
}

#endif

}  // namespace
