#include <gmock/gmock.h>

#include <cstdio>
#include <fstream>
#include <sstream>

namespace {

const std::string source = FISHERHILL_SOURCE_DIR;

std::string contentOf(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(source + "/" + file).rdbuf();
  return text.str();
}

/// The part of the tutorial about a recorded trial.
std::string page() {
  const std::string all = contentOf("docs/tutorial.md");
  return all.substr(all.find("\n## A recorded trial\n"));
}

TEST(TutorialReplay, PageShowsTheCodeThatIsCompiled) {
  EXPECT_THAT(page(),
              testing::HasSubstr("```cpp\n" + contentOf("docs/tutorial/replay.cc") + "```"));
}

TEST(TutorialReplay, PageShowsWhatTheProgramPrints) {
  FILE* program = popen(("'" FISHERHILL_TUTORIAL_REPLAY "' '" + source + "/models/elbow8.osim' '" +
                         source + "/emg_data/curl_slow.sto'")
                            .c_str(),
                        "r");
  std::string printed;
  for (int c; (c = std::fgetc(program)) != EOF;) printed += static_cast<char>(c);
  EXPECT_EQ(pclose(program), 0);
  EXPECT_THAT(page(), testing::HasSubstr("```text\n" + printed + "```"));
}

}  // namespace
