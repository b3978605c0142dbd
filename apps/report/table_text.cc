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

std::string latexRow(const std::vector<std::string>& cells) {
  std::string row;
  for (std::size_t i = 0; i < cells.size(); ++i) row += (i > 0 ? " & " : "") + latexCell(cells[i]);
  return row + " \\\\\n";
}

/// "r" for numbers, "l" for text, a paragraph where a text is long.
std::string alignment(const Table& table, std::size_t column) {
  constexpr std::size_t longest = 50;
  bool numbers = !table.rows.empty();
  for (const auto& row : table.rows) {
    const std::string& cell = row.at(column);
    if (cell.size() > longest) return "p{0.45\\linewidth}";
    numbers = numbers && (cell.empty() || cell == "–" || isNumber(cell));
  }
  return numbers ? "r" : "l";
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

std::string latexTable(const Table& table) {
  std::string columns;
  for (std::size_t i = 0; i < table.columns.size(); ++i) columns += alignment(table, i);
  std::string text =
      "% needs \\usepackage{booktabs}\n\\begin{tabular}{" + columns + "}\n\\toprule\n";
  text += latexRow(table.columns) + "\\midrule\n";
  for (const auto& row : table.rows) text += latexRow(row);
  return text + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace app
