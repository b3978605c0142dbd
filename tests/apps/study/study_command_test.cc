#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

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

namespace fs = std::filesystem;

/// A study of so many subjects, each with a second of a shipped trial.
class StudyCommand : public testing::Test {
 protected:
  void write(int subjects, const std::string& more = "") {
    const std::string source = FISHERHILL_SOURCE_DIR;
    const auto lines = linesOf(contentOf(source + "/emg_data/curl_slow.sto"));
    std::size_t header = 0;
    while (lines[header] != "endheader") ++header;
    std::string text = "title = \"Of a test\"\nparameters = [\"hand.mass\"]\nnoise_deg = 1.0\n";
    for (int i = 0; i < subjects; ++i) {
      std::string trial = "cut\nversion=1\ninDegrees=no\n";
      for (std::size_t k = header; k < header + 2; ++k) trial += lines[k] + "\n";
      for (std::size_t k = 0; k < 51; ++k)
        trial += lines[header + 2 + k + 20 * static_cast<std::size_t>(i)] + "\n";
      scratch_.file("t" + std::to_string(i) + ".sto", trial);
      text += "[[subject]]\nname = \"s" + std::to_string(i) + "\"\nmodel = \"" + source +
              "/models/elbow8.osim\"\ntrain = \"t" + std::to_string(i) + ".sto\"\nhold_out = [\"t" +
              std::to_string((i + 1) % subjects) + ".sto\"]\n";
    }
    scratch_.file("study.toml", text + more);
  }

  ProgramResult run(const std::vector<std::string>& before = {},
                    const std::vector<std::string>& after = {}) const {
    std::vector<std::string> words = before;
    for (const std::string& word :
         {std::string(FISHERHILL_PROGRAM), std::string("study"), std::string("run"),
          (scratch_ / "study.toml").string(), std::string("--out"), (scratch_ / "out").string()})
      words.push_back(word);
    words.insert(words.end(), after.begin(), after.end());
    return support::runProgram(words, FISHERHILL_SOURCE_DIR);
  }

  /// Of all that says nothing of when it was made.
  std::string bytes() const {
    std::string all;
    for (const char* file : {"study.csv", "estimates.csv", "report.html", "summary.json"})
      all += contentOf(scratch_ / "out" / file);
    std::set<fs::path> subjects;
    for (const auto& entry : fs::directory_iterator(scratch_ / "out/subjects"))
      subjects.insert(entry.path());
    for (const fs::path& subject : subjects) {
      all += contentOf(subject / "calibrate/calibrated.osim");
      all += contentOf(subject / "calibrate/parameters.csv");
    }
    return all;
  }

  ScratchFolder scratch_;
};

TEST_F(StudyCommand, GivesARowForEverySubjectAsItsCommandWould) {
  write(2, "[[subject]]\nname = \"broken\"\nmodel = \"" + std::string(FISHERHILL_SOURCE_DIR) +
               "/models/elbow8.osim\"\ntrain = \"study.toml\"\n");
  const ProgramResult result = run();
  EXPECT_EQ(result.status, 1) << result.err;  // one subject failed
  EXPECT_THAT(result.out, HasSubstr("Of 3 subjects: 1 failed, 2 ok."));
  const auto rows = linesOf(contentOf(scratch_ / "out/study.csv"));
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_THAT(rows[1], testing::StartsWith("s0,ok,"));
  EXPECT_THAT(rows[3], testing::StartsWith("broken,failed,,,"));
  EXPECT_THAT(rows[3], HasSubstr("calibrate: "));
  const ProgramResult alone = runFisherHill(
      {"calibrate", "models/elbow8.osim", (scratch_ / "t0.sto").string(), "--hold-out",
       (scratch_ / "t1.sto").string(), "--parameters", "hand.mass", "--noise-deg", "1", "--json"});
  const auto summary = nlohmann::json::parse(alone.out);
  const auto estimates = linesOf(contentOf(scratch_ / "out/estimates.csv"));
  ASSERT_EQ(estimates.size(), 3u);
  EXPECT_THAT(estimates[1], testing::StartsWith("s0,hand.mass,kg,"));
  std::string cell = estimates[1].substr(0, estimates[1].rfind(','));
  cell = cell.substr(cell.rfind(',') + 1);
  EXPECT_NEAR(std::stod(cell), summary["estimates"]["hand.mass"]["value"].get<double>(), 1e-9);
  EXPECT_THAT(result.err, testing::Not(HasSubstr("confounded")));  // warnings are the subjects' own
}

TEST_F(StudyCommand, KilledTwiceEndsInTheSameBytes) {
  write(8);
  ASSERT_LE(run({}, {"--threads", "1"}).status, 1);
  const std::string whole = bytes();
  fs::remove_all(scratch_ / "out");
  int kills = 0;
  std::string before;
  ProgramResult last;
  for (double limit = 0.03; limit < 100; limit *= 1.3) {
    last = run({"timeout", "-s", "KILL", std::to_string(limit)}, {"--threads", "1"});
    if (last.status != 137) break;
    ++kills;
    if (fs::exists(scratch_ / "out/study.csv")) continue;  // killed behind the last subject
    const std::string growing = contentOf(scratch_ / "out/unfinished.csv");
    EXPECT_TRUE(growing.starts_with(before));  // nothing is computed twice
    before = growing;
  }
  EXPECT_GE(kills, 2);
  EXPECT_TRUE(bytes() == whole) << "the last one: " << last.status << ", " << last.err;
}

TEST_F(StudyCommand, RefusesWhatCannotBeCarriedOut) {
  const std::vector<std::pair<std::string, std::string>> studies = {
      {"parameters = [\"hand.mass\"]\n", "needs a key 'subject'"},
      {"[[subject]]\nname = \"a\"\nmodel = \"m.osim\"\ntrain = \"t.sto\"\n", "m.osim' is no file"},
      {"[[subject]]\nname = \"a/b\"\n", "name = \"a/b\", must be letters"},
      {"parmeters = [\"x\"]\n", "parmeters"},
      {"starts = 0\n", "starts = 0, must be 1 to 1000"},
      {"noise_deg = -1\n", "noise_deg = -1"}};
  for (const auto& [text, message] : studies) {
    scratch_.file("study.toml", text);
    const ProgramResult result = run();
    EXPECT_EQ(result.status, 2) << text;
    EXPECT_THAT(result.err, HasSubstr(message)) << text;
    EXPECT_EQ(linesOf(result.err).size(), 1u) << result.err;
    EXPECT_FALSE(fs::exists(scratch_ / "out")) << text;
  }
}

#ifdef FISHERHILL_MPIRUN
TEST_F(StudyCommand, UnderMpiIsTheSame) {
  write(3);
  ASSERT_LE(run().status, 1);
  const std::string whole = bytes();
  fs::remove_all(scratch_ / "out");
  const ProgramResult result = run({FISHERHILL_MPIRUN, "--allow-run-as-root", "--oversubscribe",
                                    "-x", "ASAN_OPTIONS=detect_leaks=0", "-n", "2"});
  EXPECT_LE(result.status, 1) << result.err;
  EXPECT_TRUE(bytes() == whole);
}
#endif

}  // namespace
