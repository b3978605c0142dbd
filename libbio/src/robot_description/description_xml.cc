#include "robot_description/description_xml.h"

#include <fmt/format.h>

#include <cmath>

#include "bio/tables/file_error.h"
#include "tables/cells.h"
#include "tables/text_file.h"

namespace bio::robot {
namespace {

constexpr std::string_view spaces = " \t\r\n\f\v";

}  // namespace

std::string label(const Element& element) {
  const char* name = element.Attribute("name");
  return name ? fmt::format("{} '{}'", element.Name(), name) : element.Name();
}

std::string textOf(const Element& element, const char* attribute) {
  const char* text = element.Attribute(attribute);
  return text ? text : "";
}

Documents::Documents(const tinyxml2::XMLDocument& main, std::filesystem::path file)
    : main_(main), file_(std::move(file)) {}

std::vector<const Element*> Documents::childrenOf(const Element& parent) const {
  std::vector<const Element*> children;
  for (auto child = parent.FirstChildElement(); child; child = child->NextSiblingElement()) {
    if (std::string_view(child->Name()) != "include") {
      children.push_back(child);
      continue;
    }
    for (const Element* each : childrenOf(*included(*child).RootElement())) {
      children.push_back(each);
    }
  }
  return children;
}

std::vector<const Element*> Documents::childrenOf(const Element& parent,
                                                  std::string_view tag) const {
  std::vector<const Element*> children;
  for (const Element* child : childrenOf(parent)) {
    if (tag == child->Name()) children.push_back(child);
  }
  return children;
}

const tinyxml2::XMLDocument& Documents::included(const Element& include) const {
  for (const Included& known : included_) {
    if (known.by == &include) return *known.document;
  }
  const std::string name = textOf(include, "file");
  if (name.empty()) fail(include, "has no file, must name one");
  const std::string path = (file_.parent_path() / name).lexically_normal().string();
  if (path == file_.lexically_normal().string()) fail(include, "includes the file itself");
  for (const Included& known : included_) {
    if (known.file == path) {
      fail(include, fmt::format("'{}' is included twice, each file may be included once", name));
    }
  }
  auto document = std::make_unique<tinyxml2::XMLDocument>();
  std::string text;
  try {
    text = readTextFile(path);
  } catch (const FileError& error) {
    fail(include, fmt::format("cannot include: {}", error.what()));
  }
  if (document->Parse(text.c_str(), text.size()) != tinyxml2::XML_SUCCESS ||
      !document->RootElement()) {
    fail(include, fmt::format("{}:{}: is not well-formed XML", path, document->ErrorLineNum()));
  }
  included_.push_back({std::move(document), path, &include});
  return *included_.back().document;
}

void Documents::fail(const Element& element, const std::string& what) const {
  std::string file = file_.string();
  for (const Included& known : included_) {
    if (known.document.get() == element.GetDocument()) file = known.file;
  }
  throw FileError(fmt::format("{}:{}: {}: {}", file, element.GetLineNum(), label(element), what));
}

std::vector<double> Documents::numbers(const Element& element, const char* attribute,
                                       std::string_view text) const {
  std::vector<double> values;
  for (std::size_t at = text.find_first_not_of(spaces); at != text.npos;
       at = text.find_first_not_of(spaces, at)) {
    const std::size_t end = std::min(text.find_first_of(spaces, at), text.size());
    const std::string_view token = text.substr(at, end - at);
    double value = 0;
    if (!tables::isNumber(token, value) || !std::isfinite(value)) {
      fail(element, fmt::format("{} = '{}', must be a finite number", attribute, token));
    }
    values.push_back(value);
    at = end;
  }
  return values;
}

std::vector<double> Documents::numbers(const Element& element, const char* attribute,
                                       std::string_view text, std::size_t count) const {
  std::vector<double> values = numbers(element, attribute, text);
  if (values.size() != count) {
    fail(element, fmt::format("{} has {} numbers, must have {}", attribute, values.size(), count));
  }
  return values;
}

double Documents::number(const Element& element, const char* attribute, Rule rule,
                         std::optional<double> fallback) const {
  const char* text = element.Attribute(attribute);
  if (!text && fallback) return *fallback;
  if (!text) fail(element, fmt::format("{} is missing, must be given", attribute));
  return ruled(element, attribute, numbers(element, attribute, text, 1).front(), rule);
}

double Documents::ruled(const Element& element, const char* attribute, double value,
                        Rule rule) const {
  const bool isFine = rule == Rule::finite || (rule == Rule::positive ? value > 0 : value >= 0);
  if (!isFine) {
    fail(element, fmt::format("{} = {}, must be {} 0", attribute, value,
                              rule == Rule::positive ? ">" : "≥"));
  }
  return value;
}

}  // namespace bio::robot
