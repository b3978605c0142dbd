#include "report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <stdexcept>

namespace app {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

Report smallReport() {
  Report report;
  report.title = "Replay of a.sto";
  report.verdict = "It moves.";
  report.mainFigure = {.title = "Angle",
                       .xLabel = "Time [s]",
                       .yLabel = "Elbow flexion [deg]",
                       .series = {{.name = "measured",
                                   .x = {0, 0.1, 0.2},
                                   .y = {10, missing, 12},
                                   .style = SeriesStyle::points}}};
  return report;
}

TEST(Report, BeginsWithWhatWasRunTheVerdictAndTheFigure) {
  Report report = smallReport();
  report.details = {Section{"Muscles"}, Paragraph{"Eight of them."}};
  const std::string html = renderReport(report, Summary({}));
  const auto at = [&](const char* text) { return html.find(text); };
  ASSERT_NE(at("<h1>Replay of a.sto</h1>"), html.npos);
  EXPECT_LT(at("<h1>Replay of a.sto</h1>"), at("It moves."));
  EXPECT_LT(at("It moves."), at("<figure>"));
  EXPECT_LT(at("<figure>"), at("<h2>Muscles</h2>"));
  EXPECT_LT(at("<h2>Muscles</h2>"), at("<p>Eight of them.</p>"));
  EXPECT_LT(at("<p>Eight of them.</p>"), at("<h2>Provenance</h2>"));
}

TEST(Report, KeepsWhatWasNotMeasuredAsAGap) {
  EXPECT_THAT(renderReport(smallReport(), Summary({})), HasSubstr("\"y\":[10.0,null,12.0]"));
}

// A body at rest ends with speeds below the least normal number.
TEST(Report, DrawsNumbersBelowTheLeastNormalOne) {
  Report report = smallReport();
  report.mainFigure->series[0].y = {1e-310, -4.94065645841247e-324, 1e308};
  EXPECT_THAT(renderReport(report, Summary({})), HasSubstr("1e+308"));
}

TEST(Report, OfHalfAMillionRowsIsSmall) {
  Report report = smallReport();
  std::vector<double>& x = report.mainFigure->series[0].x;
  x.resize(500000);
  std::iota(x.begin(), x.end(), 0.0);
  report.mainFigure->series[0].y = x;
  EXPECT_LT(renderReport(report, Summary({})).size(), 500000u);  // 8 MB with every point
}

TEST(Report, SaysWhereNotEveryPointIsDrawn) {
  const std::string words = "drawn by the lowest and highest values of 2000 intervals";
  Report report = smallReport();
  report.mainFigure->caption = "An angle.";
  EXPECT_THAT(renderReport(report, Summary({})),
              AllOf(HasSubstr("<figcaption>An angle.</figcaption>"), Not(HasSubstr(words))));
  std::vector<double>& x = report.mainFigure->series[0].x;
  x.resize(9000);
  std::iota(x.begin(), x.end(), 0.0);
  report.mainFigure->series[0].y = x;
  EXPECT_THAT(renderReport(report, Summary({})),
              HasSubstr("<figcaption>An angle. Long curves are " + words + ".</figcaption>"));
}

TEST(Report, NeedsNothingFromElsewhere) {
  const std::string html = renderReport(smallReport(), Summary({}));
  EXPECT_THAT(html,
              AllOf(HasSubstr("default-src 'none'"), Not(HasSubstr("src=\"")),
                    Not(HasSubstr("href=\"")), Not(HasSubstr("@import")), Not(HasSubstr("url("))));
  EXPECT_THAT(html, HasSubstr("Copyright (c) 2022 Leon Sorokin"));
}

TEST(Report, KeepsPicturesInsideThePage) {
  Report report = smallReport();
  report.mainPicture = Picture{.title = "An arm", .png = "\x89PNG\r\n\x1a\n", .caption = "Bent."};
  report.details = {Picture{.title = "Another", .png = "\x89PNG"}};
  const std::string html = renderReport(report, Summary({}));
  // RFC 4648: 8 bytes are 12 letters with one '=', 4 bytes 8 with two
  const std::size_t main =
      html.find("<img alt=\"An arm\" src=\"data:image/png;base64,iVBORw0KGgo=\">");
  ASSERT_NE(main, html.npos);
  EXPECT_GT(main, html.find("It moves."));
  EXPECT_LT(main, html.find("<h3>Angle</h3>"));
  EXPECT_THAT(html, HasSubstr("src=\"data:image/png;base64,iVBORw==\">"));
  report.details = {Picture{.title = "A film", .png = "ftyp"}};
  EXPECT_THROW(renderReport(report, Summary({})), std::invalid_argument);
}

TEST(Report, KeepsNumbersOfTablesOnOneLine) {
  Report report = smallReport();
  report.details = {Table{"", {"a", "b"}, {{"1.7e-05", "2.71e-4, -1.5 of case-05<"}}}};
  EXPECT_THAT(renderReport(report, Summary({})),
              HasSubstr("<td><span class=\"number\">1.7e-05</span></td><td><span "
                        "class=\"number\">2.71e-4</span>, -1.5 of case-05&lt;</td>"));
}

TEST(Report, TakesTextLiterally) {
  Report report = smallReport();
  report.title = "<b>&\"";
  report.mainFigure->series[0].name = "</script><script>alert(1)</script>";
  const std::string html = renderReport(report, Summary({}));
  EXPECT_THAT(html, HasSubstr("<h1>&lt;b&gt;&amp;&quot;</h1>"));
  EXPECT_THAT(html, Not(HasSubstr("<script>alert(1)")));
}

TEST(Report, ShowsFiguresWarningsAndProvenance) {
  CommandContext context;
  context.commandLine = {"fisherhill", "replay", "a.osim"};
  Summary summary(context);
  summary.set("rms_error_deg", 1.23456789);
  summary.set("observed_order", {{"vi", 2.0}});
  summary.warn("muscle ANC has no column");
  EXPECT_THAT(renderReport(smallReport(), summary),
              AllOf(HasSubstr("<td>rms_error_deg</td><td>1.23457</td>"),
                    HasSubstr("<td>observed_order.vi</td><td>2</td>"),
                    HasSubstr("<li>muscle ANC has no column</li>"),
                    HasSubstr("<pre>fisherhill replay a.osim</pre>")));
}

TEST(Report, RefusesListsOfDifferentLength) {
  Report report = smallReport();
  report.mainFigure->series[0].y.pop_back();
  EXPECT_THROW(renderReport(report, Summary({})), std::invalid_argument);
  report = smallReport();
  report.mainFigure->series[0].bandLow = {0, 0, 0};
  EXPECT_THROW(renderReport(report, Summary({})), std::invalid_argument);
  report = smallReport();
  report.details = {Table{"", {"a", "b"}, {{"1"}}}};
  EXPECT_THROW(renderReport(report, Summary({})), std::invalid_argument);
}

TEST(Report, KeepsADrawingInsideThePage) {
  Report report = smallReport();
  report.details = {
      VectorDrawing{"A ball & a box", "<svg viewBox=\"0 0 1 1\"></svg>\n", "It moves."}};
  EXPECT_THAT(
      renderReport(report, Summary({})),
      AllOf(HasSubstr("<h3>A ball &amp; a box</h3>\n<svg viewBox"), HasSubstr("It moves.")));
  report.details = {VectorDrawing{"", "<script></script>", ""}};
  EXPECT_THROW(renderReport(report, Summary({})), std::invalid_argument);
}

TEST(Report, CarriesThreeDimensionsOnlyWhereSomethingIsPlayed) {
  Report report = smallReport();
  EXPECT_THAT(renderReport(report, Summary({})), Not(HasSubstr("THREE")));
  Playback playback{.title = "An <arm>", .caption = "It & moves."};
  playback.still = "<svg class=\"still\"></svg>\n";
  playback.data = {{"trials", {{{"name", "</script><script>alert(1)</script>"}}}}};
  report.details = {playback};
  const std::string html = renderReport(report, Summary({}));
  EXPECT_THAT(html, AllOf(HasSubstr("<figure class=\"playback\">\n<h3>An &lt;arm&gt;</h3>\n<svg"),
                          HasSubstr("<figcaption>It &amp; moves.</figcaption>"),
                          HasSubstr("class View"), HasSubstr("three.js 0.170.0"),
                          HasSubstr("default-src 'none'"), Not(HasSubstr("<script>alert(1)"))));
  playback.still = "<script></script>";
  report.details = {playback};
  EXPECT_THROW(renderReport(report, Summary({})), std::invalid_argument);
}

TEST(Report, HasSectionsWithContextAndTheMethodsThatWereUsed) {
  Report report = smallReport();
  report.details = {Section{"Muscles", "What drives <it>."}};
  Summary summary({});
  EXPECT_THAT(renderReport(report, summary),
              AllOf(HasSubstr("<h2>Muscles</h2>\n<p class=\"context\">What drives &lt;it&gt;.</p>"),
                    Not(HasSubstr("<h2>Methods</h2>"))));
  summary.methods().say(Methods::Part::model, "Two muscles (Thelen, 2003).",
                        {Publication::thelen2003});
  summary.methods().assume("Nothing <moves>.");
  EXPECT_THAT(renderReport(report, summary),
              AllOf(HasSubstr("Two muscles (Thelen, 2003).</p>"),
                    HasSubstr("<li>Nothing &lt;moves&gt;.</li>"),
                    HasSubstr("<li>D. G. Thelen, Adjustment of muscle mechanics")));
}

}  // namespace
}  // namespace app
