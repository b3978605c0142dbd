#pragma once

#include <optional>
#include <set>
#include <string>
#include <toml.hpp>
#include <utility>
#include <vector>

namespace bio {

/// A table of a TOML file that knows where it stands and which of its keys were asked for, so that
/// errors name file, line and key, and no misspelt key passes in silence.
class TomlTable {
 public:
  /// Reads a whole file. @throws FileError
  static TomlTable read(const std::string& file);

  int line() const;
  bool has(const std::string& key) const;

  /// Value of a key, nothing if it is absent. @throws FileError if it has another type
  std::optional<double> number(const std::string& key);
  std::optional<int> integer(const std::string& key);
  std::optional<bool> flag(const std::string& key);
  std::optional<std::string> text(const std::string& key);
  std::optional<std::vector<double>> numbers(const std::string& key);

  /// Like number(), and @throws FileError unless `within(value)`; `rule` says it in words.
  template <class Within>
  std::optional<double> number(const std::string& key, Within within, const std::string& rule) {
    const std::optional<double> value = number(key);
    if (value && !within(*value)) fail(key, rule);
    return value;
  }
  /// A list of texts, or one text; empty if the key is absent.
  std::vector<std::string> texts(const std::string& key);
  /// One of these words.
  std::optional<std::string> word(const std::string& key, const std::vector<std::string>& words);
  /// { name = number, … } in the order of the file, or [ "name", … ] with 1 for each.
  std::vector<std::pair<std::string, double>> weights(const std::string& key);
  /// { name = "name", … } in the order of the names; empty if the key is absent.
  std::vector<std::pair<std::string, std::string>> names(const std::string& key);

  /// An empty table if the key is absent. @throws FileError if it is no table
  TomlTable table(const std::string& key);
  /// [[key]] tables in the order of the file.
  std::vector<TomlTable> tables(const std::string& key);

  /// A key that must be there. @throws FileError
  template <class T>
  T required(const std::string& key, std::optional<T> value) const {
    if (!value) missing(key);
    return *std::move(value);
  }

  /// @throws FileError naming the key's line, its value and the rule
  [[noreturn]] void fail(const std::string& key, const std::string& rule) const;
  /// @throws FileError for the first key that was not asked for
  void finish() const;

 private:
  TomlTable(std::string file, std::string name, toml::value value);
  const toml::value* find(const std::string& key);
  [[noreturn]] void missing(const std::string& key) const;

  std::string file_;
  std::string name_;  ///< "[envelope] "; empty for the whole file
  toml::value value_;
  std::set<std::string> known_;
};

}  // namespace bio
