#include <fmt/format.h>

#include <string>

#include "opensim/writing.h"

namespace bio::osim {

Element& append(Element& parent, const char* tag, std::string_view name) {
  Element* child = parent.InsertNewChildElement(tag);
  if (!name.empty()) child->SetAttribute("name", std::string(name).c_str());
  return *child;
}

void appendText(Element& parent, const char* tag, const std::string& text) {
  append(parent, tag).SetText(text.c_str());
}

void appendFlag(Element& parent, const char* tag, bool value) {
  appendText(parent, tag, value ? "true" : "false");
}

void appendNumber(Element& parent, const char* tag, double value) {
  appendText(parent, tag, fmt::format("{}", value));
}

void appendNumbers(Element& parent, const char* tag, const std::vector<double>& values) {
  appendText(parent, tag, fmt::format("{}", fmt::join(values, " ")));
}

void appendNumbers(Element& parent, const char* tag, const Eigen::Vector3d& values) {
  appendNumbers(parent, tag, std::vector<double>{values.x(), values.y(), values.z()});
}

Element& appendSet(const Writing& writing, Element& parent, const char* tag,
                   std::string_view name) {
  Element& set = append(parent, tag, writing.format == Format::opensim4 ? name : "");
  Element& objects = append(set, "objects");
  append(set, "groups");
  return objects;
}

void appendSpline(Element& parent, const SplineFunction& spline, std::string_view name) {
  Element& element = append(parent, "SimmSpline", name);
  appendNumbers(element, "x", spline.x);
  appendNumbers(element, "y", spline.y);
}

void appendFunction(Element& parent, const Function& function, std::string_view name) {
  if (function.scale != 1) {
    Element& product = append(parent, "MultiplierFunction", name);
    appendFunction(append(product, "function"), {1, function.shape}, "");
    appendNumber(product, "scale", function.scale);
    return;
  }
  struct Appender {
    Element& parent;
    std::string_view name;
    void operator()(const ConstantFunction& f) const {
      appendNumber(append(parent, "Constant", name), "value", f.value);
    }
    void operator()(const LinearFunction& f) const {
      appendNumbers(append(parent, "LinearFunction", name), "coefficients",
                    std::vector<double>{f.slope, f.intercept});
    }
    void operator()(const SplineFunction& f) const { appendSpline(parent, f, name); }
    void operator()(const PiecewiseLinearFunction& f) const {
      Element& element = append(parent, "PiecewiseLinearFunction", name);
      appendNumbers(element, "x", f.x);
      appendNumbers(element, "y", f.y);
    }
    void operator()(const PolynomialFunction& f) const {
      appendNumbers(append(parent, "PolynomialFunction", name), "coefficients", f.coefficients);
    }
    void operator()(const SineFunction& f) const {
      Element& element = append(parent, "Sine", name);
      appendNumber(element, "amplitude", f.amplitude);
      appendNumber(element, "omega", f.omega);
      appendNumber(element, "phase", f.phase);
      appendNumber(element, "offset", f.offset);
    }
  };
  std::visit(Appender{parent, name}, function.shape);
}

}  // namespace bio::osim
