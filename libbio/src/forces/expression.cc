#include "bio/forces/expression.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <charconv>
#include <stdexcept>
#include <utility>

#include "tables/text_file.h"

namespace bio {

/// Recursive descent: sum → product → sign → power → atom.
class Expression::Parser {
 public:
  Parser(const std::string& text, const std::vector<std::string>& variables,
         std::vector<Instruction>& program)
      : text_(text), variables_(variables), program_(program) {}

  void parse() {
    sum();
    skipSpace();
    if (at_ != text_.size()) fail(fmt::format("unexpected '{}'", text_[at_]));
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::invalid_argument(
        onOneLine(fmt::format("expression '{}', character {}: {}", text_, at_ + 1, what)));
  }
  void skipSpace() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  bool take(char c) {
    skipSpace();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void emit(Code code, double number = 0, std::size_t variable = 0) {
    program_.push_back({code, number, variable});
    depth_ += code == Code::number || code == Code::variable ? 1
              : code == Code::add || code == Code::subtract || code == Code::multiply ||
                      code == Code::divide || code == Code::min || code == Code::max
                  ? -1
                  : 0;
    if (depth_ > static_cast<int>(maxDepth)) fail("too deeply nested");
  }

  void sum() {
    if (++nesting_ > 200) fail("too deeply nested");
    product();
    while (true) {
      if (take('+')) {
        product();
        emit(Code::add);
      } else if (take('-')) {
        product();
        emit(Code::subtract);
      } else {
        break;
      }
    }
    --nesting_;
  }
  void product() {
    sign();
    while (true) {
      if (take('*')) {
        sign();
        emit(Code::multiply);
      } else if (take('/')) {
        sign();
        emit(Code::divide);
      } else {
        return;
      }
    }
  }
  void sign() {
    bool negative = false;
    while (true) {
      if (take('-')) {
        negative = !negative;
      } else if (!take('+')) {
        break;
      }
    }
    atom();
    while (take('^')) {
      bool negativeExponent = false;
      while (take('-')) negativeExponent = !negativeExponent;
      const bool bracket = take('(');
      while (bracket && take('-')) negativeExponent = !negativeExponent;
      const double exponent = number("an exponent must be a number");
      if (bracket && !take(')')) fail("')' is missing");
      emit(Code::power, negativeExponent ? -exponent : exponent);
    }
    if (negative) emit(Code::negate);
  }
  double number(const char* otherwise) {
    skipSpace();
    double value = 0;
    const bool begins = at_ < text_.size() &&
                        (std::isdigit(static_cast<unsigned char>(text_[at_])) || text_[at_] == '.');
    const char* const first = text_.data() + at_;
    const auto [end, error] = std::from_chars(first, text_.data() + text_.size(), value);
    if (!begins || error != std::errc()) fail(otherwise);
    at_ += static_cast<std::size_t>(end - first);
    return value;
  }
  void atom() {
    skipSpace();
    if (at_ >= text_.size()) fail("a value is missing at the end");
    const char c = text_[at_];
    if (take('(')) {
      sum();
      if (!take(')')) fail("')' is missing");
    } else if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') {
      emit(Code::number, number("a number cannot be read"));
    } else if (std::isalpha(static_cast<unsigned char>(c)) || c == '_') {
      name();
    } else {
      fail(fmt::format("unexpected '{}'", c));
    }
  }
  void name() {
    const std::size_t start = at_;
    while (at_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_')) {
      ++at_;
    }
    const std::string word = text_.substr(start, at_ - start);
    for (std::size_t i = 0; i < variables_.size(); ++i) {
      if (variables_[i] == word) return emit(Code::variable, 0, i);
    }
    static const std::array<std::pair<const char*, Code>, 16> functions = {{{"sqrt", Code::sqrt},
                                                                            {"exp", Code::exp},
                                                                            {"log", Code::log},
                                                                            {"sin", Code::sin},
                                                                            {"cos", Code::cos},
                                                                            {"tan", Code::tan},
                                                                            {"asin", Code::asin},
                                                                            {"acos", Code::acos},
                                                                            {"atan", Code::atan},
                                                                            {"sinh", Code::sinh},
                                                                            {"cosh", Code::cosh},
                                                                            {"tanh", Code::tanh},
                                                                            {"abs", Code::abs},
                                                                            {"min", Code::min},
                                                                            {"max", Code::max},
                                                                            {"step", Code::step}}};
    for (const auto& [known, code] : functions) {
      if (word != known) continue;
      if (!take('(')) fail(fmt::format("'(' is missing after '{}'", word));
      sum();
      if (code == Code::min || code == Code::max) {
        if (!take(',')) fail(fmt::format("'{}' needs two arguments", word));
        sum();
      }
      if (!take(')')) fail("')' is missing");
      return emit(code);
    }
    at_ = start;
    fail(fmt::format("unknown name '{}'", word));
  }

  const std::string& text_;
  const std::vector<std::string>& variables_;
  std::vector<Instruction>& program_;
  std::size_t at_ = 0;
  int depth_ = 0;
  int nesting_ = 0;
};

Expression::Expression(const std::string& text, const std::vector<std::string>& variables)
    : text_(text) {
  Parser(text_, variables, program_).parse();
}

bool Expression::vanishes(const std::vector<std::optional<double>>& known) const {
  std::vector<std::optional<double>> stack;  // what is known of the values
  for (const Instruction& instruction : program_) {
    const auto pop = [&] {
      const std::optional<double> top = stack.back();
      stack.pop_back();
      return top;
    };
    switch (instruction.code) {
      case Code::number:
        stack.emplace_back(instruction.number);
        break;
      case Code::variable:
        stack.push_back(known.at(instruction.variable));
        break;
      case Code::add:
      case Code::subtract:
      case Code::multiply:
      case Code::divide:
      case Code::min:
      case Code::max: {
        const std::optional<double> right = pop(), left = pop();
        if (left && right) {
          double two[2] = {*left, *right};
          std::size_t top = 2;
          run(instruction, two, two, top);
          stack.emplace_back(two[0]);
        } else if (instruction.code == Code::multiply &&
                   ((left && *left == 0) || (right && *right == 0))) {
          stack.emplace_back(0.0);
        } else {
          stack.emplace_back();
        }
        break;
      }
      default: {
        const std::optional<double> of = pop();
        if (of) {
          double one[1] = {*of};
          std::size_t top = 1;
          run(instruction, one, one, top);
          stack.emplace_back(one[0]);
        } else {
          stack.emplace_back();
        }
      }
    }
  }
  return stack.at(0) && *stack[0] == 0;
}

}  // namespace bio
