#include "report/table_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <regex>
#include <utility>

#include "report/svg_text.h"

namespace app {
namespace {

std::string csvCell(const std::string& cell) {
  if (cell.find_first_of(",\"\r\n") == cell.npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string csvRow(const std::vector<std::string>& cells) {
  std::string row;
  for (std::size_t i = 0; i < cells.size(); ++i) row += (i > 0 ? "," : "") + csvCell(cells[i]);
  return row + "\r\n";
}

constexpr std::array<std::pair<std::string_view, std::string_view>, 11> escapes = {{
    {"\\", "\\textbackslash{}"},
    {"{", "\\{"},
    {"}", "\\}"},
    {"$", "\\$"},
    {"&", "\\&"},
    {"#", "\\#"},
    {"%", "\\%"},
    {"_", "\\_"},
    {"~", "\\textasciitilde{}"},
    {"^", "\\textasciicircum{}"},
    {"\"", "''"},
}};

constexpr std::array<std::pair<std::string_view, std::string_view>, 66> signs = {{
    {"−", "$-$"},
    {"±", "$\\pm$"},
    {"×", "$\\times$"},
    {"·", "$\\cdot$"},
    {"÷", "$\\div$"},
    {"≤", "$\\leq$"},
    {"≥", "$\\geq$"},
    {"≠", "$\\neq$"},
    {"≈", "$\\approx$"},
    {"∞", "$\\infty$"},
    {"√", "$\\surd$"},
    {"∂", "$\\partial$"},
    {"∝", "$\\propto$"},
    {"∈", "$\\in$"},
    {"Σ", "$\\Sigma$"},
    {"°", "$^{\\circ}$"},
    {"→", "$\\rightarrow$"},
    {"←", "$\\leftarrow$"},
    {"⊤", "$^{\\top}$"},
    {"ᵀ", "$^{\\top}$"},
    {"⁰", "$^{0}$"},
    {"¹", "$^{1}$"},
    {"²", "$^{2}$"},
    {"³", "$^{3}$"},
    {"⁴", "$^{4}$"},
    {"⁵", "$^{5}$"},
    {"⁶", "$^{6}$"},
    {"⁷", "$^{7}$"},
    {"⁸", "$^{8}$"},
    {"⁹", "$^{9}$"},
    {"χ", "$\\chi$"},
    {"κ", "$\\kappa$"},
    {"∫", "$\\int$"},
    {"⁻", "$^{-}$"},
    {"₀", "$_{0}$"},
    {"₁", "$_{1}$"},
    {"₂", "$_{2}$"},
    {"α", "$\\alpha$"},
    {"β", "$\\beta$"},
    {"γ", "$\\gamma$"},
    {"δ", "$\\delta$"},
    {"ε", "$\\varepsilon$"},
    {"θ", "$\\theta$"},
    {"λ", "$\\lambda$"},
    {"µ", "$\\mu$"},
    {"μ", "$\\mu$"},
    {"π", "$\\pi$"},
    {"ρ", "$\\rho$"},
    {"σ", "$\\sigma$"},
    {"τ", "$\\tau$"},
    {"φ", "$\\varphi$"},
    {"ω", "$\\omega$"},
    {"Δ", "$\\Delta$"},
    {"Γ", "$\\Gamma$"},
    {"Ω", "$\\Omega$"},
    {"ℓ", "$\\ell$"},
    {"–", "--"},
    {"—", "---"},
    {"…", "\\dots{}"},
    {"“", "``"},
    {"”", "''"},
    {"‘", "`"},
    {"’", "'"},
    {"<", "$<$"},
    {">", "$>$"},
    {"|", "$|$"},
}};

/// Bytes of the character at the beginning.
std::size_t bytesOfFirst(std::string_view text) {
  std::size_t length = 1;
  while (length < text.size() && (text[length] & 0xC0) == 0x80) ++length;
  return length;
}

template <std::size_t N>
const std::string_view* commandFor(
    const std::array<std::pair<std::string_view, std::string_view>, N>& list,
    std::string_view character) {
  const auto found = std::find_if(list.begin(), list.end(),
                                  [&](const auto& pair) { return pair.first == character; });
  return found == list.end() ? nullptr : &found->second;
}

bool isNumber(const std::string& cell) {
  static const std::regex number("[-−+]?[0-9]+([.][0-9]+)?(e[-+]?[0-9]+)?");
  return std::regex_match(cell, number);
}

/// "5.4e-05" as 5.4 · 10⁻⁵ of LaTeX.
std::string latexCell(const std::string& cell) {
  if (!isNumber(cell)) return latexText(cell);
  std::string digits = std::regex_replace(cell, std::regex("−"), "-");
  const std::size_t at = digits.find('e');
  if (at == digits.npos) return digits.front() == '-' ? "$" + digits + "$" : digits;
  return fmt::format("${}\\cdot10^{{{}}}$", digits.substr(0, at), std::stol(digits.substr(at + 1)));
}

/// Characters of a text, not bytes.
std::size_t lengthOf(std::string_view text) {
  std::size_t length = 0;
  for (; !text.empty(); text.remove_prefix(bytesOfFirst(text))) ++length;
  return length;
}

/// A column of a LaTeX table; lengths in characters.
struct LatexColumn {
  bool numbers = false;           ///< set to the right
  std::size_t wrapped = 0;        ///< width at which its texts are broken; 0: they are not
  std::vector<std::string> head;  ///< lines
  std::size_t widest = 0;         ///< of the longest cell

  std::size_t width() const {
    if (wrapped > 0) return wrapped;
    std::size_t most = widest;
    for (const std::string& text : head) most = std::max(most, lengthOf(text));
    return most;
  }
};

/// Lines of at most so many characters if its words allow that; names are broken behind dots and
/// underscores.
std::vector<std::string> brokenHead(const std::string& head, std::size_t most) {
  std::vector<std::string> lines(1);
  const std::regex piece("[^ ._]*[ ._]*");
  for (std::sregex_iterator at(head.begin(), head.end(), piece), end; at != end; ++at) {
    const std::string next = at->str(), word = next.substr(0, next.find_last_not_of(' ') + 1);
    if (!lines.back().empty() && lengthOf(lines.back()) + lengthOf(word) > most)
      lines.emplace_back();
    lines.back() += next;
  }
  for (std::string& text : lines) text.erase(text.find_last_not_of(' ') + 1);
  return lines;
}

std::size_t widthOf(const std::vector<LatexColumn>& columns) {
  std::size_t sum = 0;
  for (const LatexColumn& column : columns) sum += column.width() + 2;
  return sum;
}

constexpr std::size_t line = 72;  ///< characters of a page's line

/// Makes a table narrower that is too wide for a page: first heads are broken; then, where it would
/// have to be set smaller than 7 of 10 points, the longest texts are.
void narrow(std::vector<LatexColumn>& columns) {
  constexpr std::size_t widest = line * 10 / 7, shortHead = 12, mostLines = 3, wrapped = 36;
  if (widthOf(columns) <= line) return;
  for (LatexColumn& column : columns) {
    const std::string head = column.head.front();
    for (std::size_t most = std::max(column.widest, shortHead); lengthOf(head) > most; ++most) {
      column.head = brokenHead(head, most);
      if (column.head.size() <= mostLines) break;
    }
  }
  while (widthOf(columns) > widest) {
    LatexColumn* longest = nullptr;
    for (LatexColumn& column : columns) {
      if (column.numbers || column.wrapped > 0 || column.widest <= wrapped) continue;
      if (longest == nullptr || column.widest > longest->widest) longest = &column;
    }
    if (longest == nullptr) return;
    longest->wrapped = wrapped;
  }
}

std::vector<LatexColumn> latexColumns(const Table& table) {
  std::vector<LatexColumn> columns;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    LatexColumn column{.numbers = !table.rows.empty(), .head = {table.columns[i]}};
    for (const auto& row : table.rows) {
      const std::string& cell = row.at(i);
      column.widest = std::max(column.widest, lengthOf(cell));
      column.numbers = column.numbers && (cell.empty() || cell == "–" || isNumber(cell));
    }
    columns.push_back(column);
  }
  narrow(columns);
  return columns;
}

/// With breaks allowed behind the slashes and underscores of names and paths.
std::string breakable(std::string latex) {
  for (const std::string sign : {"/", "\\_"}) {
    for (std::size_t at = latex.find(sign); at != latex.npos; at = latex.find(sign, at + 1))
      latex.insert(at + sign.size(), "\\allowbreak{}");
  }
  return latex;
}

/// What follows the end of a line: a bracket or a star there would be an argument of that.
std::string beginningOfLine(const std::string& latex) {
  return latex.starts_with('[') || latex.starts_with('*') ? "{}" + latex : latex;
}

std::string latexHead(const LatexColumn& column) {
  if (column.head.size() == 1) return latexText(column.head.front());
  std::string lines = latexText(column.head.front());
  for (std::size_t i = 1; i < column.head.size(); ++i)
    lines += "\\\\" + beginningOfLine(latexText(column.head[i]));
  return fmt::format("\\shortstack[{}]{{{}}}", column.numbers ? 'r' : 'l', lines);
}

/// Cells that are LaTeX as a row.
std::string latexRow(const std::vector<std::string>& cells) {
  std::string row;
  for (std::size_t i = 0; i < cells.size(); ++i) row += (i > 0 ? " & " : "") + cells[i];
  return beginningOfLine(row) + " \\\\\n";
}

}  // namespace

std::string csvText(const Table& table) {
  std::string text = csvRow(table.columns);
  for (const auto& row : table.rows) text += csvRow(row);
  return text;
}

std::string latexText(std::string_view text) {
  const std::string valid = xmlCharacters(text);
  std::string latex;
  for (std::string_view rest = valid; !rest.empty();) {
    const std::string_view character = rest.substr(0, bytesOfFirst(rest));
    rest.remove_prefix(character.size());
    const std::string_view* command = commandFor(escapes, character);
    if (command == nullptr) command = commandFor(signs, character);
    constexpr std::string_view dotAbove = "\u0307";
    if (rest.starts_with(dotAbove)) {
      latex += fmt::format("$\\dot{{{}}}$", character);
      rest.remove_prefix(dotAbove.size());
    } else if (character == "-" && latex.ends_with('-')) {
      latex += "{}-";  // two hyphens are no dash
    } else if (command != nullptr) {
      latex += *command;
    } else {
      latex += character == "\n" || character == "\r" || character == "\t" ? " " : character;
    }
  }
  // two scripts in a row are one
  for (const char* twice : {"}$$^{", "}$$_{"}) {
    for (std::size_t at; (at = latex.find(twice)) != latex.npos;) latex.erase(at, 5);
  }
  return latex;
}

std::string latexProse(std::string_view text) {
  return breakable(latexText(text));
}

std::string latexTable(const Table& table) {
  const std::vector<LatexColumn> columns = latexColumns(table);
  std::string alignment;
  std::vector<std::string> heads;
  for (const LatexColumn& column : columns) {
    alignment += column.wrapped > 0 ? fmt::format(">{{\\raggedright\\arraybackslash}}p{{{}em}}",
                                                  column.wrapped / 2)
                 : column.numbers   ? "r"
                                    : "l";
    heads.push_back(latexHead(column));
  }
  std::string text = fmt::format(
      "% needs \\usepackage{{graphicx,booktabs,array}}\n"
      "\\resizebox{{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}}{{!}}{{%\n"
      "\\begin{{tabular}}{{{}}}\n",
      alignment);
  text += "\\toprule\n" + latexRow(heads) + "\\midrule\n";
  for (const auto& row : table.rows) {
    std::vector<std::string> cells;
    for (std::size_t i = 0; i < columns.size(); ++i)
      cells.push_back(columns[i].wrapped > 0 ? breakable(latexCell(row[i])) : latexCell(row[i]));
    text += latexRow(cells);
  }
  return text + "\\bottomrule\n\\end{tabular}}\n";
}

}  // namespace app
