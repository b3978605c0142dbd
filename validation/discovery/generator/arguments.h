#pragma once

#include <cstdio>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace hidden {

/// `--name value` and plain words of a command line; names in `switches` take no value.
struct Arguments {
  std::map<std::string, std::string> options;
  std::vector<std::string> words;

  /// @throws std::invalid_argument for an option that is not known or lacks its value
  Arguments(int argc, char** argv, const std::set<std::string>& known,
            const std::set<std::string>& switches = {}) {
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      if (!word.starts_with("--")) {
        words.push_back(word);
      } else if (switches.count(word.substr(2)) > 0) {
        options[word.substr(2)] = "";
      } else if (known.count(word.substr(2)) > 0 && i + 1 < argc) {
        options[word.substr(2)] = argv[++i];
      } else {
        throw std::invalid_argument("option " + word + " is not known or lacks its value");
      }
    }
  }

  bool has(const std::string& name) const { return options.count(name) > 0; }
  std::string text(const std::string& name, const std::string& otherwise = "") const {
    const auto at = options.find(name);
    return at == options.end() ? otherwise : at->second;
  }
  /// @throws std::invalid_argument unless it is a number
  double number(const std::string& name, double otherwise) const {
    if (!has(name)) return otherwise;
    std::size_t used = 0;
    double value = 0;
    try {
      value = std::stod(text(name), &used);
    } catch (const std::exception&) {
    }
    if (used == 0 || used != text(name).size()) {
      throw std::invalid_argument("--" + name + " " + text(name) + ", must be a number");
    }
    return value;
  }
};

/// What main() returns: the program's own status; 2 after a line on standard error for wrong use, 1
/// for what went wrong.
template <class Program>
int statusOf(const char* name, const Program& program) {
  try {
    return program();
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return 1;
  }
}

}  // namespace hidden
