#pragma once

#include <tinyxml2.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Elements and attributes of robot descriptions, with messages that name file, line and element.
namespace bio::robot {

using Element = tinyxml2::XMLElement;

enum class Rule { finite, notNegative, positive };

/// "joint 'shoulder'"
std::string label(const Element& element);
/// The attribute's text; empty if there is none.
std::string textOf(const Element& element, const char* attribute);

/// A document and those that it includes.
class Documents {
 public:
  Documents(const tinyxml2::XMLDocument& main, std::filesystem::path file);

  /// Child elements; `<include file="…"/>` is replaced by those of the file's root, as in MuJoCo:
  /// relative to the main file, each file once.
  std::vector<const Element*> childrenOf(const Element& parent) const;
  std::vector<const Element*> childrenOf(const Element& parent, std::string_view tag) const;

  /// Throws FileError "file:line: label: what".
  [[noreturn]] void fail(const Element& element, const std::string& what) const;

  /// All numbers of a text, each finite.
  std::vector<double> numbers(const Element& element, const char* attribute,
                              std::string_view text) const;
  /// `count` numbers of a text that is the attribute's.
  std::vector<double> numbers(const Element& element, const char* attribute, std::string_view text,
                              std::size_t count) const;
  /// The attribute's number; FileError without one unless there is a fallback.
  double number(const Element& element, const char* attribute, Rule rule,
                std::optional<double> fallback = {}) const;
  double ruled(const Element& element, const char* attribute, double value, Rule rule) const;

 private:
  const tinyxml2::XMLDocument& included(const Element& include) const;

  const tinyxml2::XMLDocument& main_;
  std::filesystem::path file_;
  struct Included {
    std::unique_ptr<tinyxml2::XMLDocument> document;
    std::string file;
    const Element* by;
  };
  mutable std::vector<Included> included_;
};

}  // namespace bio::robot
