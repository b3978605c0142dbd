#include "mutations.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <sstream>
#include <stdexcept>

namespace robustness {
namespace {

using tinyxml2::XMLElement;

class Mutation {
 public:
  Mutation(tinyxml2::XMLDocument& document, std::uint64_t seed)
      : document_(document), random_(seed) {}

  // What was done, empty if it was nothing.
  std::string apply() {
    elements_.clear();
    collect(*document_.RootElement());
    XMLElement& element = someElement();
    const std::string where = fmt::format(
        "line {} {}{}", element.GetLineNum(), element.Name(),
        element.Attribute("name") ? fmt::format(" '{}'", element.Attribute("name")) : "");
    const bool hasText = element.GetText() != nullptr;
    // Numbers are what models are made of: half of all mutations.
    const std::string done = hasText && below(2) == 0 ? changeNumber(element) : changeTree(element);
    return done.empty() ? "" : where + ": " + done;
  }

 private:
  std::size_t below(std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_);
  }

  void collect(XMLElement& element) {
    elements_[element.Name()].push_back(&element);
    for (auto* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
      collect(*child);
    }
  }

  XMLElement& someElement() {
    const auto kind =
        std::next(elements_.begin(), static_cast<std::ptrdiff_t>(below(elements_.size())));
    return *kind->second[below(kind->second.size())];
  }

  std::string changeNumber(XMLElement& element) {
    std::istringstream stream(element.GetText());
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    if (words.empty()) return "";
    const std::size_t at = below(words.size());
    const std::string old = words[at];
    double number = 0;
    std::from_chars(old.data(), old.data() + old.size(), number);
    const std::vector<std::string> values = {"nan",
                                             "inf",
                                             "-inf",
                                             "0",
                                             "-1",
                                             "1e300",
                                             "-1e300",
                                             "1e-300",
                                             "1e9",
                                             "1e-9",
                                             "x",
                                             "",
                                             "0x10",
                                             "1,5",
                                             "1e999",
                                             "4.9e-324",
                                             fmt::format("{}", -number),
                                             fmt::format("{}", 1000 * number),
                                             fmt::format("{}", number / 1000),
                                             fmt::format("{}", 1.5 * number),
                                             fmt::format("{}", number + 1)};
    switch (below(10)) {
      case 0:
        words.erase(words.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 1:
        words.insert(words.begin() + static_cast<std::ptrdiff_t>(at), old);
        break;
      case 2:
        std::swap(words[at], words[below(words.size())]);
        break;
      default:
        words[at] = values[below(values.size())];
    }
    const std::string text = fmt::format("{}", fmt::join(words, " "));
    const bool shown = words.size() == 1;
    element.SetText(text.c_str());
    return shown ? fmt::format("{} → {}", old, text)
                 : fmt::format("number {} of {}, was {}, is {}", at + 1, words.size(), old,
                               at < words.size() ? words[at] : "gone");
  }

  std::string changeTree(XMLElement& element) {
    tinyxml2::XMLNode* parent = element.Parent();
    if (&element == document_.RootElement() || !parent) return "";
    switch (below(8)) {
      case 0:
        parent->DeleteChild(&element);
        return "deleted";
      case 1:
        parent->InsertAfterChild(&element, element.DeepClone(&document_));
        return "doubled";
      case 2: {
        XMLElement* next = element.NextSiblingElement();
        if (!next) return "";
        parent->InsertAfterChild(next, element.DeepClone(&document_));
        parent->DeleteChild(&element);
        return "swapped with its neighbour";
      }
      case 3:
        element.DeleteChildren();
        return "emptied";
      case 4: {
        const std::string name = someElement().Name();
        element.SetName(name.c_str());
        return "is now a " + name;
      }
      case 5:
        if (!element.Attribute("name")) return "";
        element.SetAttribute("name", "");
        return "name emptied";
      case 6: {
        const XMLElement& other = someElement();
        if (!element.Attribute("name") || !other.Attribute("name")) return "";
        const std::string name = other.Attribute("name");
        element.SetAttribute("name", name.c_str());
        return "is now called " + name;
      }
      default: {
        XMLElement& other = someElement();
        if (!element.GetText() || !other.GetText()) return "";
        const std::string mine = element.GetText(), its = other.GetText();
        element.SetText(its.c_str());
        other.SetText(mine.c_str());
        return fmt::format("text swapped with line {} {}", other.GetLineNum(), other.Name());
      }
    }
  }

  tinyxml2::XMLDocument& document_;
  std::mt19937_64 random_;
  std::map<std::string, std::vector<XMLElement*>> elements_;
};

}  // namespace

Mutant mutated(const std::string& text, std::uint64_t seed) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw std::invalid_argument("the document is not XML");
  }
  Mutation mutation(document, seed);
  Mutant mutant;
  const std::uint64_t wanted = 1 + seed % 3;
  // Little may be left to damage.
  for (std::uint64_t done = 0, tried = 0; done < wanted && tried < 100; ++tried) {
    const std::string story = mutation.apply();
    if (story.empty()) continue;
    mutant.story += (done++ ? "; " : "") + story;
  }
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  mutant.text = printer.CStr();
  return mutant;
}

}  // namespace robustness
