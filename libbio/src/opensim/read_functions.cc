#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "opensim/reading.h"

namespace bio::osim {
namespace {

struct Points {
  std::vector<double> x;
  std::vector<double> y;
};

// A spline keeps a point that is there twice: it is flat there, in OpenSim and here.
Points readPoints(Reading& reading, const Element& function, bool isSpline) {
  const std::vector<double> x = readNumbers(reading.source, function, "x", "", {});
  const std::vector<double> y = readNumbers(reading.source, function, "y", "", {});
  if (x.size() != y.size()) {
    fail(reading.source, function,
         fmt::format("has {} x and {} y, must have as many of each", x.size(), y.size()));
  }
  Points kept;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!kept.x.empty() && x[i] == kept.x.back() && y[i] == kept.y.back()) {
      reading.model.remarks.push_back(
          fmt::format("{}: the point x = {} is there twice; {}", label(function), x[i],
                      isSpline ? "the spline is flat there" : "once is used"));
      if (isSpline) {
        kept.x.push_back(x[i]);
        kept.y.push_back(y[i]);
      }
      continue;
    }
    if (!kept.x.empty() && !(x[i] > kept.x.back())) {
      fail(reading.source, function,
           fmt::format("x[{}] = {} after {}, must rise strictly", i, x[i], kept.x.back()),
           function.FirstChildElement("x"));
    }
    kept.x.push_back(x[i]);
    kept.y.push_back(y[i]);
  }
  if (kept.x.size() < 2) {
    fail(reading.source, function,
         fmt::format("has {} points, must have at least 2", kept.x.size()));
  }
  return kept;
}

}  // namespace

const Element* findFunction(const Element& object, const char* property) {
  if (const Element* wrapper = object.FirstChildElement(property)) {
    return wrapper->FirstChildElement();
  }
  for (const Element* child : childrenOf(&object)) {
    if (child->Attribute("name", property)) return child;
  }
  return nullptr;
}

SplineFunction readSpline(Reading& reading, const Element& function) {
  Points points = readPoints(reading, function, true);
  return {std::move(points.x), std::move(points.y)};
}

Function readFunction(Reading& reading, const Element& function) {
  const Source& source = reading.source;
  const std::string_view kind = function.Name();
  if (kind == "Constant") {
    return {1, ConstantFunction{readNumber(source, function, "value", "", Rule::finite)}};
  }
  if (kind == "LinearFunction") {
    const auto c = readNumbers(source, function, "coefficients", "", 2);
    return {1, LinearFunction{c[0], c[1]}};
  }
  if (kind == "SimmSpline") return {1, readSpline(reading, function)};
  if (kind == "NaturalCubicSpline" || kind == "natCubicSpline") {
    reading.model.warnings.push_back(
        fmt::format("{} is evaluated with the end conditions of a SimmSpline", label(function)));
    return {1, readSpline(reading, function)};
  }
  if (kind == "PiecewiseLinearFunction") {
    Points points = readPoints(reading, function, false);
    return {1, PiecewiseLinearFunction{std::move(points.x), std::move(points.y)}};
  }
  if (kind == "PolynomialFunction") {
    auto coefficients = readNumbers(source, function, "coefficients", "", {});
    if (coefficients.empty()) fail(source, function, "coefficients are missing, must be given");
    return {1, PolynomialFunction{std::move(coefficients)}};
  }
  if (kind == "Sine") {
    const auto number = [&](const char* property, double fallback) {
      return readNumber(source, function, property, "", Rule::finite, fallback);
    };
    return {1, SineFunction{number("amplitude", 1), number("omega", 1), number("phase", 0),
                            number("offset", 0)}};
  }
  if (kind == "MultiplierFunction") {
    const Element* inner = findFunction(function, "function");
    if (!inner) fail(source, function, "function is missing, must be given");
    Function product = readFunction(reading, *inner);
    product.scale *= readNumber(source, function, "scale", "", Rule::finite, 1.0);
    return product;
  }
  fail(source, function,
       fmt::format("function of class {}, must be one of Constant, "
                   "LinearFunction, SimmSpline, PiecewiseLinearFunction, "
                   "PolynomialFunction, Sine, MultiplierFunction",
                   kind));
}

bool isReadableFunction(const Element& function) {
  static constexpr std::array kinds{
      "Constant",       "LinearFunction",          "SimmSpline",         "NaturalCubicSpline",
      "natCubicSpline", "PiecewiseLinearFunction", "PolynomialFunction", "Sine"};
  const std::string_view kind = function.Name();
  if (kind != "MultiplierFunction")
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  const Element* inner = findFunction(function, "function");
  return !inner || isReadableFunction(*inner);
}

}  // namespace bio::osim
