#include "bio/model/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace bio {
namespace {

template <class Item>
const Item& findByName(const std::vector<Item>& items, const std::string& name, const char* kind) {
  for (const Item& item : items) {
    if (item.name == name) return item;
  }
  std::string known;
  for (const Item& item : items) known += (known.empty() ? "" : ", ") + item.name;
  throw std::invalid_argument(
      fmt::format("the model has no {} called '{}' (it has: {})", kind, name, known));
}

}  // namespace

std::optional<std::size_t> MultivariatePolynomial::numTerms(int dimension, int order) {
  if (dimension < 1 || order < 0) return {};
  constexpr std::size_t most = 1000000;
  std::size_t terms = 1;
  for (int i = 1; i <= dimension; ++i) {
    const auto n = static_cast<std::size_t>(order) + static_cast<std::size_t>(i);
    if (n > 2 * most) return {};
    terms = terms * n / static_cast<std::size_t>(i);  // a binomial coefficient each time
    if (terms > most) return {};
  }
  return terms;
}

void MultivariatePolynomial::requireRules() const {
  if (!(dimension >= 1 && dimension <= maxDimension)) {
    throw std::invalid_argument(
        fmt::format("dimension = {}, must be 1 to {}", dimension, maxDimension));
  }
  const auto terms = numTerms(dimension, order);
  if (!terms) {
    throw std::invalid_argument(
        fmt::format("order = {}, must be 0 or more and give at most 1000000 terms", order));
  }
  if (coefficients.size() != *terms) {
    throw std::invalid_argument(
        fmt::format("has {} coefficients, must have {} (dimension {}, order {})",
                    coefficients.size(), *terms, dimension, order));
  }
  for (const double c : coefficients) {
    if (!std::isfinite(c)) {
      throw std::invalid_argument(fmt::format("a coefficient is {}, must be finite", c));
    }
  }
}

const Body& findBody(const Model& model, const std::string& name) {
  return findByName(model.bodies, name, "body");
}

const Coordinate* coordinateOrNull(const Model& model, const std::string& name) {
  for (const Joint& joint : model.joints) {
    for (const Coordinate& coordinate : joint.coordinates) {
      if (coordinate.name == name) return &coordinate;
    }
  }
  return nullptr;
}

const Coordinate& findCoordinate(const Model& model, const std::string& name) {
  if (const Coordinate* found = coordinateOrNull(model, name)) return *found;
  std::string known;
  for (const Joint& joint : model.joints) {
    for (const Coordinate& coordinate : joint.coordinates) {
      known += (known.empty() ? "" : ", ") + coordinate.name;
    }
  }
  throw std::invalid_argument(
      fmt::format("the model has no coordinate called '{}' (it has: {})", name, known));
}

const WrapObject& findWrapObject(const Model& model, const std::string& name) {
  return findByName(model.wrapObjects, name, "wrap object");
}

const Muscle& findMuscle(const Model& model, const std::string& name) {
  return findByName(model.muscles, name, "muscle");
}

std::string simulatedClasses() {
  std::string list = "Schutte1993Muscle_Deprecated";
  for (const std::string_view name : muscles::MuscleClasses::names) {
    list += ", ";
    list += name;
  }
  return list;
}

}  // namespace bio
