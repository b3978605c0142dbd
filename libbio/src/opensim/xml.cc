#include "opensim/xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "tables/cells.h"

namespace bio::osim {
namespace {

bool isSpace(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

std::string ownLabel(const Element& element) {
  const char* name = element.Attribute("name");
  return name ? fmt::format("{} '{}'", element.Name(), name) : element.Name();
}

// The object that stands in a set of the model, and that a user would look for.
const Element* outermostObject(const Element& element) {
  const Element* found = nullptr;
  for (auto node = element.Parent(); node && node->ToElement(); node = node->Parent()) {
    const auto parent = node->Parent() ? node->Parent()->ToElement() : nullptr;
    if (parent && std::string_view(parent->Name()) == "objects") found = node->ToElement();
  }
  return found;
}

std::string located(const Source& source, const Element& element, const std::string& message,
                    const Element& where) {
  return fmt::format("{}:{}: {}: {}", source.file, where.GetLineNum(), label(element), message);
}

// A finite number that fills the whole token.
double parseNumber(const Source& source, const Element& object, const Element& element,
                   std::string_view token, const char* unit) {
  const char* property = element.Name();
  double value = 0;
  if (!tables::isNumber(token, value)) {
    throw UnreadableNumber(located(
        source, object, fmt::format("{} = '{}', must be a number", property, token), element));
  }
  if (!std::isfinite(value)) {
    throw UnreadableNumber(
        located(source, object,
                fmt::format("{} = {}{}{}, must be finite", property, token, *unit ? " " : "", unit),
                element));
  }
  return value;
}

}  // namespace

std::string label(const Element& element) {
  const Element* outer = outermostObject(element);
  return outer ? fmt::format("{} of {}", ownLabel(element), ownLabel(*outer)) : ownLabel(element);
}

void fail(const Source& source, const Element& element, const std::string& message,
          const Element* where) {
  throw FileError(located(source, element, message, where ? *where : element));
}

std::string nameOf(const Source& source, const Element& element) {
  const char* name = element.Attribute("name");
  if (!name || !*name) fail(source, element, "has no name, must have one");
  // what a table of results could not hold
  const std::string_view word = name;
  const bool isPadded = std::isspace(static_cast<unsigned char>(word.front())) != 0 ||
                        std::isspace(static_cast<unsigned char>(word.back())) != 0;
  const bool isControlled =
      std::any_of(word.begin(), word.end(), [](unsigned char c) { return std::iscntrl(c) != 0; });
  if (isPadded || isControlled || word.find_first_of(",\"") != word.npos) {
    fail(source, element,
         "its name must be without comma, quote, tab or line break, and begin and end with no "
         "space");
  }
  return name;
}

const Element* findProperty(const Source& source, const Element& object, const char* property) {
  if (const Element* own = object.FirstChildElement(property)) return own;
  const auto found = source.defaults.find(object.Name());
  return found == source.defaults.end() ? nullptr : found->second->FirstChildElement(property);
}

std::string trimmedText(const Element* element) {
  const char* raw = element ? element->GetText() : nullptr;
  if (!raw) return {};
  std::string_view text = raw;
  while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
  return std::string(text);
}

double readNumber(const Source& source, const Element& object, const char* property,
                  const char* unit, Rule rule, std::optional<double> fallback) {
  const Element* element = findProperty(source, object, property);
  if (!element && fallback) return *fallback;
  if (!element) fail(source, object, fmt::format("{} is missing, must be given", property));
  const double value = parseNumber(source, object, *element, trimmedText(element), unit);
  const char* broken = nullptr;
  if (rule == Rule::positive && !(value > 0)) broken = "must be > 0";
  if (rule == Rule::notNegative && !(value >= 0)) broken = "must be ≥ 0";
  if (broken) {
    fail(source, object,
         fmt::format("{} = {}{}{}, {}", property, value, *unit ? " " : "", unit, broken), element);
  }
  return value;
}

std::vector<double> readNumbers(const Source& source, const Element& object, const char* property,
                                const char* unit, std::optional<std::size_t> count,
                                std::optional<std::vector<double>> fallback) {
  const Element* element = findProperty(source, object, property);
  if (!element && fallback) return *fallback;
  if (!element) fail(source, object, fmt::format("{} is missing, must be given", property));
  const std::string text = trimmedText(element);
  std::vector<double> values;
  for (std::size_t at = 0; at < text.size();) {
    const char* const stop = text.data() + text.size();
    const char* const begin = std::find_if_not(text.data() + at, stop, isSpace);
    const char* const end = std::find_if(begin, stop, isSpace);
    if (begin != end) {
      const std::string_view token(begin, static_cast<std::size_t>(end - begin));
      values.push_back(parseNumber(source, object, *element, token, unit));
    }
    at = static_cast<std::size_t>(end - text.data());
  }
  if (count && values.size() != *count) {
    fail(source, object,
         fmt::format("{} has {} numbers, must have {}", property, values.size(), *count), element);
  }
  return values;
}

bool readFlag(const Source& source, const Element& object, const char* property, bool fallback) {
  const Element* element = findProperty(source, object, property);
  if (!element) return fallback;
  std::string text = trimmedText(element);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (text == "true" || text == "1") return true;
  if (text == "false" || text == "0") return false;
  fail(source, object, fmt::format("{} = '{}', must be true or false", property, text), element);
}

std::string readText(const Source& source, const Element& object, const char* property,
                     std::optional<std::string> fallback) {
  const Element* element = findProperty(source, object, property);
  if (element) return trimmedText(element);
  if (!fallback) fail(source, object, fmt::format("{} is missing, must be given", property));
  return *fallback;
}

std::vector<const Element*> objectsOf(const Element& owner, const char* set) {
  const Element* list = owner.FirstChildElement(set);
  return childrenOf(list ? list->FirstChildElement("objects") : nullptr);
}

std::vector<const Element*> childrenOf(const Element* parent) {
  std::vector<const Element*> children;
  if (!parent) return children;
  for (auto child = parent->FirstChildElement(); child; child = child->NextSiblingElement()) {
    children.push_back(child);
  }
  return children;
}

}  // namespace bio::osim
