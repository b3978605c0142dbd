#include "report/table_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace app {
namespace {

using testing::HasSubstr;

const Table table{
    "Estimates",
    {"name", "value [N·m]", "note"},
    {{"TRI.radius", "-1.5", "50 % of R_0"}, {"a,\"b\"", "5.445e-05", std::string(70, 'x')}}};

TEST(TableText, CsvQuotesWhatNeedsIt) {
  EXPECT_EQ(csvText(table),
            "name,value [N·m],note\r\nTRI.radius,-1.5,50 % of R_0\r\n\"a,\"\"b\"\"\",5.445e-05," +
                std::string(70, 'x') + "\r\n");
}

const std::string wrapped = ">{\\raggedright\\arraybackslash}p{18em}";

TEST(TableText, LatexSetsNumbersAndEscapes) {
  const std::string latex = latexTable(table);
  EXPECT_THAT(latex, HasSubstr("\\begin{tabular}{lrl}\n\\toprule\nname & "
                               "value [N$\\cdot$m] & note \\\\\n\\midrule\n"
                               "TRI.radius & $-1.5$ & 50 \\% of R\\_0 \\\\\n"));
  EXPECT_THAT(latex, HasSubstr("& $5.445\\cdot10^{-5}$ &"));
  EXPECT_THAT(latex, testing::StartsWith(
                         "% needs \\usepackage{graphicx,booktabs,array}\n"
                         "\\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}"
                         "{!}{%\n\\begin{tabular}"));
  EXPECT_THAT(latex, testing::EndsWith("\\bottomrule\n\\end{tabular}}\n"));
}

TEST(TableText, LatexWrapsOnlyWhatWouldBeTooSmall) {
  const std::string note(60, 'x');
  EXPECT_THAT(latexTable({"", {"a", "note"}, {{"1", note}}}), HasSubstr("\\begin{tabular}{rl}\n"));
  // a little too wide is set smaller
  const Table smaller{"", {"short", "long"}, {{std::string(30, 'y'), note}}};
  EXPECT_THAT(latexTable(smaller), HasSubstr("\\begin{tabular}{ll}\n"));
  // the longest wraps, and the other only if that is not enough
  const Table one{"", {"short", "long"}, {{std::string(50, 'y'), "a_b" + note}}};
  EXPECT_THAT(latexTable(one), HasSubstr("\\begin{tabular}{l" + wrapped + "}\n"));
  EXPECT_THAT(latexTable(one), HasSubstr("a\\_\\allowbreak{}bx"));
  const Table both{"", {"short", "long", "a"}, {{note + "y", note, std::string(30, 'z')}}};
  EXPECT_THAT(latexTable(both), HasSubstr("{" + wrapped + wrapped + "l}\n"));
  // characters count, not bytes
  std::string greek;
  for (int i = 0; i < 70; ++i) greek += "λ";
  EXPECT_THAT(latexTable({"", {"a", "b"}, {{"1", greek}}}), HasSubstr("\\begin{tabular}{rl}\n"));
}

TEST(TableText, LatexBreaksLongHeads) {
  const Table wide{"",
                   {"integrator", "Newton iterations per step", "energy error of the run [J]",
                    "TRIlong.max_isometric_force"},
                   {{"vi", "2.1", "0.01", "0.3"}}};
  EXPECT_THAT(latexTable(wide),
              HasSubstr("{lrrr}\n\\toprule\nintegrator & "
                        "\\shortstack[r]{Newton\\\\iterations\\\\per step} & "
                        "\\shortstack[r]{energy error\\\\of the run\\\\{}[J]} & "
                        "\\shortstack[r]{TRIlong.max\\_\\\\isometric\\_\\\\force} \\\\\n"));
}

TEST(TableText, LatexTakesNoBracketForAnArgument) {
  const Table brackets{"", {"[N]", "*"}, {{"[0, 1]", "x"}, {"*", "y"}}};
  EXPECT_THAT(latexTable(brackets), HasSubstr("\\toprule\n{}[N] & * \\\\\n\\midrule\n{}[0, 1] & x "
                                              "\\\\\n{}* & y \\\\\n"));
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
