#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

namespace {

namespace fs = std::filesystem;
using support::contentOf;
using support::model;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using support::slow;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A folder of results: two replays, and one that somebody else wrote.
class IndexCommand : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(runFisherHill({"replay", model, slow, "--out", results + "/a b"}).status, 0);
    ASSERT_EQ(
        runFisherHill({"replay", model, slow, "--step", "0.02", "--out", results + "/deep/er"})
            .status,
        0);
  }
  ProgramResult index(std::vector<std::string> words = {}) {
    words.insert(words.begin(), {"index", results});
    return runFisherHill(words);
  }
  const ScratchFolder scratch;
  const std::string results = (scratch / "results").string();
};

TEST_F(IndexCommand, ListsEveryResultWithItsAnswerAndALink) {
  const ProgramResult result = index();
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, "2 results in " + results + ".\nIndex: " + results + "/index.html\n");
  const std::string page = contentOf(results + "/index.html");
  EXPECT_THAT(page,
              AllOf(HasSubstr("<a href=\"./a%20b/report.html\">a b</a>"),
                    HasSubstr("<a href=\"./deep/er/report.html\">deep/er</a>"),
                    HasSubstr(">elbow8.osim</td><td data-label=\"inputs\">curl_slow.sto</td>"),
                    HasSubstr(">Simulated elbow_flexion differs from the measurement by 12 deg"),
                    HasSubstr("[\"step_s\",0.02]"), HasSubstr("default-src 'none'"),
                    Not(HasSubstr("http:")), Not(HasSubstr("https:"))));
  // made anew without --force, for it is an index; beside the results, too
  fs::create_directories(scratch / "pages");
  EXPECT_EQ(index().status, 0);
  EXPECT_EQ(index({"--out", (scratch / "pages").string()}).status, 0);
  EXPECT_THAT(contentOf(scratch / "pages/index.html"),
              HasSubstr("\"./../results/a%20b/report.html\""));
}

TEST_F(IndexCommand, PrintsTheListAsJson) {
  const ProgramResult result = index({"--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  ASSERT_EQ(json["results"].size(), 2u);
  EXPECT_EQ(json["results"][0]["folder"], "a b");
  EXPECT_EQ(json["results"][0]["subcommand"], "replay");
  EXPECT_EQ(json["results"][0]["warnings"], 0);
  EXPECT_THAT(json["results"][0]["date"].get<std::string>(),
              testing::MatchesRegex("20[0-9-]+ [0-9:]+"));
}

TEST_F(IndexCommand, TakesHostileNamesAsTextAndSaysWhatItCannotRead) {
  for (const char* name : {"<img src=x onerror=alert(1)>", "broken", "other"})
    fs::create_directories(results + "/" + name);
  scratch.file(
      "results/<img src=x onerror=alert(1)>/summary.json",
      "{\"program\": \"fisherhill\", \"version\": \"</script><script>alert(2)</script>\", "
      "\"subcommand\": "
      "\"replay\", \"inputs\": [{\"path\": \"javascript:alert(3)//m.osim\"}], \"warnings\": [], "
      "\"rms\": \"</script><b>\"}");
  scratch.file("results/broken/summary.json", "{");
  scratch.file("results/other/summary.json", "[1]");
  const ProgramResult result = index();
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, AllOf(HasSubstr("broken/summary.json: is not a summary"),
                                HasSubstr("other/summary.json")));
  const std::string page = contentOf(results + "/index.html");
  EXPECT_THAT(page, AllOf(HasSubstr("&lt;img src=x"), Not(HasSubstr("<img")),
                          Not(HasSubstr("<script>alert")), Not(HasSubstr("</script><b>")),
                          HasSubstr("3 results.")));
}

TEST_F(IndexCommand, RefusesInOneLineAndLeavesThingsAsTheyWere) {
  scratch.file("results/index.html", "mine");
  scratch.file("empty/notes.txt", "");
  const auto before = scratch.listing();
  const std::vector<std::vector<std::string>> mistakes = {
      {"index", results},
      {"index", (scratch / "empty").string()},
      {"index", (scratch / "nowhere").string()},
      {"index"},
      {"index", results, "--out", (scratch / "nowhere").string()}};
  for (const auto& words : mistakes) {
    const ProgramResult result = runFisherHill(words);
    EXPECT_EQ(result.status, 2) << words.back();
    EXPECT_EQ(support::linesOf(result.err).size(), 1u) << result.err;
    EXPECT_EQ(scratch.listing(), before);
  }
  EXPECT_EQ(contentOf(results + "/index.html"), "mine");
  EXPECT_EQ(index({"--force"}).status, 0);
}

}  // namespace
