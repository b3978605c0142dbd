#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "index/index_page.h"
#include "report/report.h"
#include "support/run_program.h"
#include "support/scratch_folder.h"

// Built only where CMake found Chromium; the browser is the judge here.
namespace app {
namespace {

using support::ProgramResult;
using support::ScratchFolder;

Figure waves(AxisScale scale, std::size_t curves) {
  Figure figure{.title = "Waves",
                .xLabel = "Time [s]",
                .yLabel = "Angle [deg]",
                .caption = "What to see.",
                .xScale = scale,
                .yScale = scale};
  for (std::size_t i = 0; i < curves; ++i) {
    Series series{.name = "curve " + std::to_string(i), .style = static_cast<SeriesStyle>(i % 3)};
    for (int k = 1; k <= 50; ++k) {
      series.x.push_back(0.1 * k);
      series.y.push_back(k == 20 ? std::numeric_limits<double>::quiet_NaN()
                                 : 2 + std::sin(0.3 * k));
      if (i != 0) continue;
      series.bandLow.push_back(series.y.back() - 0.1);
      series.bandHigh.push_back(series.y.back() + 0.1);
    }
    figure.series.push_back(series);
  }
  return figure;
}

ProgramResult openInBrowser(const std::string& html, const ScratchFolder& scratch,
                            const char* setting = "--window-position=0,0") {
  const std::string page = scratch.file("report.html", html);
  return support::runProgram(
      {FISHERHILL_CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic",
       "--no-first-run", "--disable-background-networking", "--disable-component-update",
       "--disable-sync", "--user-data-dir=" + (scratch / "profile").string(),
       "--enable-logging=stderr", "--window-size=1280,1600", "--virtual-time-budget=2000", setting,
       "--dump-dom", "file://" + page},
      scratch.path());
}

TEST(ReportInBrowser, DrawsEveryFigureWithoutAConsoleMessage) {
  Report report;
  report.title = "A test";
  report.verdict = "It draws.";
  report.mainFigure = waves(AxisScale::linear, 1);
  // 1 × 1 pixel
  const std::string png(
      "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\b\0\0\0\0:~\x9bU\0\0\0\nIDATx\x9c"
      "c`\0\0\0\2\0\1H\xaf\xa4q\0\0\0\0IEND\xae\x42`\x82",
      67);
  report.details = {waves(AxisScale::linear, 10), waves(AxisScale::logarithmic, 3), Figure{},
                    Picture{.title = "A picture", .png = png}};
  const ScratchFolder scratch;
  const ProgramResult result = openInBrowser(renderReport(report, Summary({})), scratch);
  ASSERT_EQ(result.status, 0) << result.err;
  std::size_t canvases = 0;
  for (std::size_t at = 0; (at = result.out.find("<canvas", at)) != result.out.npos; ++at)
    ++canvases;
  EXPECT_EQ(canvases, 4u);
  // A refused request would be told here as well: the page's own policy forbids all of them.
  EXPECT_THAT(result.err, testing::Not(testing::HasSubstr("CONSOLE")));
}

// The legend's samples are elements of the page, and are painted as the curves are.
TEST(ReportInBrowser, HasLighterCurvesOnADarkScreen) {
  Report report;
  report.title = "A test";
  report.mainFigure = waves(AxisScale::linear, 2);
  const std::string html = renderReport(report, Summary({}));
  const auto painted = [&](const char* setting) {
    const ScratchFolder scratch;
    const ProgramResult result = openInBrowser(html, scratch, setting);
    EXPECT_THAT(result.err, testing::Not(testing::HasSubstr("CONSOLE")));
    return result.out.substr(result.out.find("<table class=\"u-legend"));
  };
  const std::string light = painted("--blink-settings=preferredColorScheme=1");
  EXPECT_THAT(light, testing::HasSubstr("stroke=\"#0072B2\""));
  EXPECT_THAT(light, testing::Not(testing::HasSubstr("stroke=\"#56B4E9\"")));
  const std::string dark = painted("--blink-settings=preferredColorScheme=0");
  EXPECT_THAT(dark, testing::HasSubstr("stroke=\"#56B4E9\""));
  EXPECT_THAT(dark, testing::Not(testing::HasSubstr("stroke=\"#0072B2\"")));
}

TEST(ReportInBrowser, WouldBeHeardIfSomethingWentWrong) {
  const ScratchFolder scratch;
  std::string html = renderReport({}, Summary({}));
  html.insert(html.find("<main>"), "<img src=\"http://example.invalid/a.png\">");
  EXPECT_THAT(openInBrowser(html, scratch).err, testing::HasSubstr("CONSOLE"));
}

TEST(IndexInBrowser, SortsAndShowsTwoResultsSideBySideAsText) {
  FoundResults found;
  for (const char* name : {"b", "a", "<img src=x onerror=console.log(1)>"}) {
    FoundResult result;
    result.folder = name;
    result.subcommand = "replay";
    result.numbers = {{"rms_error_deg", found.results.empty() ? 2.0 : 3.0},
                      {name, "<script>console.log(2)</script>"}};
    found.results.push_back(std::move(result));
  }
  std::string page = indexPage(found, "out", "");
  // what a reader does: sorts by the name, then chooses b and the third
  page.insert(page.find("</body>"), R"(<script>
    const boxes = document.querySelectorAll("#results input");
    document.querySelector("#results th button").click();
    for (const i of [0, 2]) {
      boxes[i].checked = true;
      boxes[i].dispatchEvent(new Event("change", { bubbles: true }));
    }</script>)");
  const ScratchFolder scratch;
  const ProgramResult result = openInBrowser(page, scratch);
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, testing::Not(testing::HasSubstr("CONSOLE")));
  EXPECT_THAT(result.out,
              testing::HasSubstr("<td>rms_error_deg</td><td>2</td><td>3</td><td>+50 %</td>"));
  EXPECT_THAT(result.out, testing::HasSubstr("aria-sort=\"ascending\""));
  EXPECT_LT(result.out.find("compare a\""), result.out.find("compare b\""));
}

}  // namespace
}  // namespace app
