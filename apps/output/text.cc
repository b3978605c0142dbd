#include "output/text.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <cmath>
#include <cstdlib>

namespace app {

std::string oneLine(std::string_view text) {
  constexpr std::string_view space = " \t\r\n";
  std::string line;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view part = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t first = part.find_first_not_of(space);
    if (first == part.npos) continue;
    part = part.substr(first, part.find_last_not_of(space) - first + 1);
    if (!line.empty()) line += "; ";
    line += part;
  }
  return line;
}

std::string numberText(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  return fmt::format("{:.{}g}", value, digits);
}

std::string cellText(double value) {
  return std::isfinite(value) ? fmt::format("{:.17g}", value) : std::string();
}

std::string cellText(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : std::string();
}

double numberIn(const std::string& text) {
  return std::strtod(text.c_str(), nullptr);
}

std::string withUnit(double value, const std::string& unit, int digits) {
  return numberText(value, digits) + (unit.empty() ? "" : " " + unit);
}

std::string counted(std::size_t count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " and " : ", ";
    text += words[i];
  }
  return text;
}

std::string identifiableWords(std::ptrdiff_t identifiable, std::ptrdiff_t all) {
  if (all == 1) return fmt::format("The parameter is {}identifiable", identifiable ? "" : "not ");
  if (identifiable == all) {
    return all == 2 ? "Both parameters are identifiable"
                    : fmt::format("All {} parameters are identifiable", all);
  }
  if (identifiable == 0) return fmt::format("None of the {} parameters is identifiable", all);
  return fmt::format("{} of {} parameters {} identifiable", identifiable, all,
                     identifiable == 1 ? "is" : "are");
}

std::string htmlText(std::string_view text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

std::string shellWord(const std::string& word) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%";
  if (!word.empty() && word.find_first_not_of(plain) == word.npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string unitText(const std::string& unit) {
  return unit == "N·m" ? "N m" : unit.empty() ? "1" : unit;
}

bio::ShownUnit shownUnit(const std::string& unit) {
  if (!unit.starts_with("rad")) return {1, unitText(unit)};
  return {bio::degreesPerRadian, "deg" + unit.substr(3)};
}

std::string base64(const std::string& bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                                     reinterpret_cast<const unsigned char*>(bytes.data()),
                                     static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(length));
  return text;
}

std::string filled(std::string_view text,
                   const std::vector<std::pair<std::string, std::string>>& values) {
  std::string result;
  while (true) {
    const std::size_t open = text.find("{{");
    result += text.substr(0, open);
    if (open == text.npos) return result;
    const std::size_t close = text.find("}}", open);
    const std::string_view name = text.substr(open + 2, close - open - 2);
    for (const auto& [key, value] : values) {
      if (key == name) result += value;
    }
    text.remove_prefix(close + 2);
  }
}

}  // namespace app
