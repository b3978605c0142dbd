#include <gmock/gmock.h>

#include <cstdio>
#include <fstream>
#include <sstream>

namespace {

const std::string kDocs = std::string(FISHERHILL_SOURCE_DIR) + "/docs";

std::string contentOf(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// What the tutorial's program prints about its recording.
std::string output() {
  FILE* program =
      popen(("'" FISHERHILL_TUTORIAL "' '" + kDocs + "/tutorial/spring.csv'").c_str(), "r");
  std::string text;
  for (int c; (c = std::fgetc(program)) != EOF;) text += static_cast<char>(c);
  EXPECT_EQ(pclose(program), 0);
  return text;
}

/// The part of the page about a system of one's own.
std::string tutorial() {
  const std::string page = contentOf(kDocs + "/tutorial.md");
  return page.substr(0, page.find("\n## A recorded trial\n"));
}

/// The text of the only ```language block of the page.
std::string block(const std::string& page, const std::string& language) {
  const std::string begin = "```" + language + "\n";
  const auto start = page.find(begin);
  EXPECT_NE(start, page.npos) << language;
  EXPECT_EQ(page.find(begin, start + 1), page.npos) << "more than one block of " << language;
  return page.substr(start + begin.size(), page.find("```", start + 3) - start - begin.size());
}

TEST(Tutorial, PageShowsTheCodeThatIsCompiled) {
  EXPECT_EQ(block(tutorial(), "cpp"), contentOf(kDocs + "/tutorial/spring.cc"));
}

TEST(Tutorial, PageShowsWhatTheProgramPrints) {
  EXPECT_EQ(block(tutorial(), "text"), output());
}

// The system itself, from its head to its end, is what a user writes: at most 30 lines.
TEST(Tutorial, SystemTakesAtMostThirtyLines) {
  const std::string code = contentOf(kDocs + "/tutorial/spring.cc");
  const auto start = code.find("struct Spring"), end = code.find("\n};\n", start);
  ASSERT_NE(end, code.npos);
  EXPECT_LE(std::count(code.begin() + long(start), code.begin() + long(end) + 4, '\n'), 30);
}

// The recording was simulated with k = 10, h = 20, c = 0.3 and noise of 0.01 m: each interval holds
// it.
TEST(Tutorial, EstimateHoldsTheTruth) {
  const std::string printed = output();
  for (const auto& [name, truth] :
       {std::pair{"k [N/m] = ", 10.0}, {"h [N/m³] = ", 20.0}, {"c [N s/m] = ", 0.3}}) {
    const auto at = printed.find(name);
    ASSERT_NE(at, std::string::npos);
    double value, low, high;
    ASSERT_EQ(std::sscanf(printed.c_str() + at + std::string(name).size(),
                          "%lf, 95 %% between %lf and %lf", &value, &low, &high),
              3);
    EXPECT_LE(low, truth);
    EXPECT_GE(high, truth);
  }
}

}  // namespace
