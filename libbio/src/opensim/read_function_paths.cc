#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "opensim/reading.h"

namespace bio::osim {
namespace {

/// Names of coordinates, or paths to them as OpenSim 4.6 writes them.
std::vector<std::string> readArguments(const Reading& reading, const Element& path) {
  const bool isNew = path.FirstChildElement("coordinate_paths") != nullptr;
  const char* property = isNew ? "coordinate_paths" : "coordinates";
  const Element* where = path.FirstChildElement(property);
  std::istringstream words(readText(reading.source, path, property));
  std::vector<std::string> names;
  for (std::string word; words >> word;) {
    const std::string name = word.substr(word.find_last_of('/') + 1);
    if (!coordinateOrNull(reading.model, name)) {
      fail(reading.source, path,
           fmt::format("{} = '{}', must name a coordinate of the model", property, word), where);
    }
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      fail(reading.source, path, fmt::format("{} has '{}' twice", property, name), where);
    }
    names.push_back(name);
  }
  if (names.empty()) {
    fail(reading.source, path, fmt::format("{} is empty, must name a coordinate", property), where);
  }
  return names;
}

int readWhole(const Source& source, const Element& function, const char* property) {
  const double value = readNumber(source, function, property, "", Rule::notNegative);
  if (value != std::floor(value) || value > 1e6) {
    fail(source, function, fmt::format("{} = {}, must be a whole number", property, value),
         function.FirstChildElement(property));
  }
  return static_cast<int>(value);
}

MultivariatePolynomial readPolynomial(const Source& source, const Element& function) {
  MultivariatePolynomial polynomial;
  polynomial.dimension = readWhole(source, function, "dimension");
  polynomial.order = readWhole(source, function, "order");
  polynomial.coefficients = readNumbers(source, function, "coefficients", "", {});
  try {
    polynomial.requireRules();
  } catch (const std::invalid_argument& broken) {
    fail(source, function, broken.what());
  }
  return polynomial;
}

/// a·x + b·y + … + constant
MultivariatePolynomial readLinear(const Source& source, const Element& function,
                                  std::size_t arguments) {
  const auto given = readNumbers(source, function, "coefficients", "", arguments + 1);
  // ascending from the last argument: 1, y, x
  return {static_cast<int>(arguments), 1, {given.rbegin(), given.rend()}};
}

std::variant<MultivariatePolynomial, Function> readLength(Reading& reading, const Element& path,
                                                          std::size_t arguments) {
  const Element* function = findFunction(path, "length_function");
  if (!function) fail(reading.source, path, "length_function is missing, must be given");
  const std::string_view kind = function->Name();
  if (kind == "MultivariatePolynomialFunction") {
    MultivariatePolynomial polynomial = readPolynomial(reading.source, *function);
    if (static_cast<std::size_t>(polynomial.dimension) != arguments) {
      fail(reading.source, *function,
           fmt::format("dimension = {}, must be {}, the number of coordinates",
                       polynomial.dimension, arguments),
           function->FirstChildElement("dimension"));
    }
    return polynomial;
  }
  if (arguments == 1) return readFunction(reading, *function);
  if (kind == "LinearFunction") return readLinear(reading.source, *function, arguments);
  fail(reading.source, *function,
       fmt::format("a length_function of {} coordinates is of class {}, must be "
                   "MultivariatePolynomialFunction or LinearFunction",
                   arguments, kind));
}

}  // namespace

// OpenSim takes moment arms and speeds from functions of their own where they are given; they are
// the slopes of the length, or forces do other work than lengths say.
Path readFunctionPath(Reading& reading, const Element& force, const Element& path) {
  PathFunction function;
  function.coordinates = readArguments(reading, path);
  function.length = readLength(reading, path, function.coordinates.size());
  for (const char* unused : {"moment_arm_functions", "lengthening_speed_function"}) {
    const Element* given = path.FirstChildElement(unused);
    if (!given || !given->FirstChildElement()) continue;
    reading.model.remarks.push_back(fmt::format(
        "{}: {} of its path is not used: the slope of length_function is", label(force), unused));
  }
  Path result;
  result.function = std::move(function);
  return result;
}

}  // namespace bio::osim
