#include "report/table_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace app {
namespace {

using testing::HasSubstr;

const Table table{
    "Estimates",
    {"name", "value [N·m]", "note"},
    {{"TRI.radius", "-1.5", "50 % of R_0"}, {"a,\"b\"", "5.445e-05", std::string(80, 'x')}}};

TEST(TableText, CsvQuotesWhatNeedsIt) {
  EXPECT_EQ(csvText(table),
            "name,value [N·m],note\r\nTRI.radius,-1.5,50 % of R_0\r\n\"a,\"\"b\"\"\",5.445e-05," +
                std::string(80, 'x') + "\r\n");
}

TEST(TableText, LatexSetsNumbersAndEscapes) {
  const std::string latex = latexTable(table);
  EXPECT_THAT(
      latex,
      HasSubstr("\\begin{tabular}{lrp{0.45\\linewidth}}\n\\toprule\nname & value [N$\\cdot$m] & "
                "note \\\\\n\\midrule\nTRI.radius & $-1.5$ & 50 \\% of R\\_0 \\\\\n"));
  EXPECT_THAT(latex, HasSubstr("& $5.445\\cdot10^{-5}$ &"));
}

TEST(TableText, LatexTakesNothingForACommand) {
  EXPECT_EQ(latexText("\\input{/etc/passwd} $x_1^2$ & # ~ %"),
            "\\textbackslash{}input\\{/etc/passwd\\} \\$x\\_1\\textasciicircum{}2\\$ \\& \\# "
            "\\textasciitilde{} \\%");
  EXPECT_EQ(latexText("--out q\u0307"), "-{}-out $\\dot{q}$");
  EXPECT_EQ(latexText("m⁻² ± 3 µm, θ ≤ 5°\n"),
            "m$^{-2}$ $\\pm$ 3 $\\mu$m, $\\theta$ $\\leq$ 5$^{\\circ}$ ");
}

}  // namespace
}  // namespace app
