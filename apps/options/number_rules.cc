#include "options/number_rules.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>

#include "options/quantity.h"

namespace app {
namespace {

CLI::Validator rule(const std::string& words, const std::string& shown,
                    std::function<bool(double)> holds) {
  return {[=](std::string& text) -> std::string {
            try {
              const double value = parseNumber(text);
              return holds(value) ? "" : fmt::format("{} must be {}", text, words);
            } catch (const std::invalid_argument& error) {
              return error.what();
            }
          },
          shown};
}

}  // namespace

CLI::Validator finite() {
  return rule("finite", "", [](double) { return true; });
}

CLI::Validator positive() {
  return rule("> 0", "POSITIVE", [](double value) { return value > 0; });
}

CLI::Validator notNegative() {
  return rule("≥ 0", "NONNEGATIVE", [](double value) { return value >= 0; });
}

CLI::Validator wholeNumber() {
  return {[](std::string& text) -> std::string {
            std::uint64_t value = 0;
            const char* const end = text.data() + text.size();
            const auto [stop, error] = std::from_chars(text.data(), end, value);
            if (error == std::errc() && stop == end) return "";
            return fmt::format("{} must be a whole number from 0 to {}", text,
                               std::numeric_limits<std::uint64_t>::max());
          },
          "NONNEGATIVE"};
}

CLI::Validator between(double low, double high) {
  return rule(fmt::format("{} to {}", low, high), fmt::format("{} - {}", low, high),
              [=](double value) { return value >= low && value <= high; });
}

}  // namespace app
