#include "opensim/merge.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

namespace bio::osim {
namespace {

std::string_view nameAttribute(const Element& element) {
  const char* name = element.Attribute("name");
  return name ? name : "";
}

bool sameKey(const Element& a, const Element& b) {
  return std::string_view(a.Name()) == b.Name() && nameAttribute(a) == nameAttribute(b);
}

// How many siblings before this one have its tag and name.
int occurrence(const Element& element) {
  int count = 0;
  for (auto e = element.PreviousSiblingElement(); e; e = e->PreviousSiblingElement()) {
    if (sameKey(*e, element)) ++count;
  }
  return count;
}

int countTag(const Element& parent, const char* tag) {
  int count = 0;
  for (auto e = parent.FirstChildElement(tag); e; e = e->NextSiblingElement(tag)) ++count;
  return count;
}

// The child of `parent` with the key of `like`.
const Element* strictMatch(const Element& parent, const Element& like) {
  int left = occurrence(like);
  for (auto e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
    if (sameKey(*e, like) && left-- == 0) return e;
  }
  return nullptr;
}

// The same in a document written by someone else: names of sets and frames are theirs, and a joint
// or function may be of a class that stands for ours.
Element* match(Element& parent, const Element& like) {
  if (const Element* exact = strictMatch(parent, like)) return const_cast<Element*>(exact);
  if (countTag(parent, like.Name()) == 1 && like.Parent() &&
      countTag(*like.Parent()->ToElement(), like.Name()) == 1) {
    return parent.FirstChildElement(like.Name());
  }
  if (nameAttribute(like).empty()) return nullptr;
  for (auto e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
    if (nameAttribute(*e) == nameAttribute(like)) return e;
  }
  return nullptr;
}

bool isLeaf(const Element& element) {
  return !element.FirstChildElement();
}

Element* insertCopy(Element& parent, const Element& child, Element* after) {
  auto* copy = child.DeepClone(parent.GetDocument());
  if (after) {
    parent.InsertAfterChild(after, copy);
  } else if (std::string_view(parent.Name()) == "objects") {
    parent.InsertFirstChild(copy);
  } else {
    parent.InsertEndChild(copy);
  }
  return copy->ToElement();
}

bool sameToken(const std::string& a, const std::string& b, double tolerance) {
  if (a == b) return true;
  double x = 0, y = 0;
  const auto ended = [](const std::string& s, double& value) {
    const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), value);
    return error == std::errc() && end == s.data() + s.size();
  };
  return ended(a, x) && ended(b, y) &&
         std::abs(x - y) <= tolerance * std::max(std::abs(x), std::abs(y));
}

bool sameText(const Element& a, const Element& b, double tolerance) {
  std::istringstream left(trimmedText(&a)), right(trimmedText(&b));
  std::string x, y;
  for (;;) {
    const bool more = static_cast<bool>(left >> x);
    if (more != static_cast<bool>(right >> y)) return false;
    if (!more) return true;
    if (!sameToken(x, y, tolerance)) return false;
  }
}

std::string pathOf(const Element& element) {
  std::string path;
  for (const Element* e = &element; e;) {
    const std::string_view name = nameAttribute(*e);
    path = fmt::format("/{}{}", name.empty() ? e->Name() : name, path);
    const auto parent = e->Parent();
    e = parent ? parent->ToElement() : nullptr;
  }
  return path;
}

// The x and y of a spline are one table: both are replaced, or the target's own x (with a point
// given twice, say) would no longer fit.
bool replaceTable(Element& target, const Element& after) {
  for (const char* tag : {"x", "y"}) {
    if (!after.FirstChildElement(tag) || !target.FirstChildElement(tag)) return false;
  }
  for (const char* tag : {"x", "y"}) {
    target.FirstChildElement(tag)->SetText(trimmedText(after.FirstChildElement(tag)).c_str());
  }
  return true;
}

}  // namespace

void applyChanges(Element& target, const Element& before, const Element& after) {
  if (nameAttribute(before) != nameAttribute(after)) {
    target.SetAttribute("name", std::string(nameAttribute(after)).c_str());
  }
  if (isLeaf(after) && isLeaf(before)) {
    if (trimmedText(&before) != trimmedText(&after)) target.SetText(trimmedText(&after).c_str());
    return;
  }
  if (replaceTable(target, after)) return;
  for (const Element* old : childrenOf(&before)) {
    if (strictMatch(after, *old) || std::string_view(old->Name()) == "Model") continue;
    if (Element* gone = match(target, *old)) target.DeleteChild(gone);
  }
  Element* previous = nullptr;
  for (const Element* wanted : childrenOf(&after)) {
    const Element* old = std::string_view(wanted->Name()) == "Model"
                             ? before.FirstChildElement("Model")
                             : strictMatch(before, *wanted);
    Element* own = match(target, *wanted);
    if (old && firstDifference(*old, *wanted, 0).empty() &&
        nameAttribute(*old) == nameAttribute(*wanted)) {
      if (own) previous = own;
      continue;
    }
    if (old && own) {
      applyChanges(*own, *old, *wanted);
      previous = own;
    } else {
      previous = insertCopy(target, *wanted, previous);
    }
  }
}

std::string firstDifference(const Element& a, const Element& b, double tolerance) {
  auto x = a.FirstChildElement();
  auto y = b.FirstChildElement();
  if (!x && !y && !sameText(a, b, tolerance)) {
    return fmt::format("{}: '{}', not '{}'", pathOf(a), trimmedText(&a), trimmedText(&b));
  }
  for (; x && y; x = x->NextSiblingElement(), y = y->NextSiblingElement()) {
    if (!sameKey(*x, *y)) return fmt::format("{}, not {}", pathOf(*x), pathOf(*y));
    if (std::string inner = firstDifference(*x, *y, tolerance); !inner.empty()) return inner;
  }
  if (x || y) return fmt::format("{} is {}", pathOf(x ? *x : *y), x ? "there" : "missing");
  return {};
}

}  // namespace bio::osim
