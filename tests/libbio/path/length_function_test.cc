#include "bio/path/length_function.h"

#include <gmock/gmock.h>

#include <cmath>

#include "bio/path/tree_path.h"
#include "bio/simulation/musculoskeletal_system.h"
#include "libbio/path/arm_paths.h"
#include "support/finite_difference.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using namespace fixtures;

/// Some numbers between −1 and 1.
std::vector<double> someNumbers(std::size_t count) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < count; ++i) {
    numbers.push_back(std::sin(1.7 * static_cast<double>(i) + 0.3));
  }
  return numbers;
}

MultivariatePolynomial somePolynomial(int dimension, int order) {
  return {dimension, order, someNumbers(*MultivariatePolynomial::numTerms(dimension, order))};
}

// The table of OpenSim's documentation: index and exponents of X, Y, Z for order 3.
TEST(MultivariatePolynomial, HasTermsInTheOrderOfOpenSim) {
  const std::vector<std::array<int, 3>> exponents = {
      {0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}, {0, 1, 0}, {0, 1, 1}, {0, 1, 2},
      {0, 2, 0}, {0, 2, 1}, {0, 3, 0}, {1, 0, 0}, {1, 0, 1}, {1, 0, 2}, {1, 1, 0},
      {1, 1, 1}, {1, 2, 0}, {2, 0, 0}, {2, 0, 1}, {2, 1, 0}, {3, 0, 0}};
  ASSERT_EQ(*MultivariatePolynomial::numTerms(3, 3), exponents.size());
  const std::array<double, 3> x = {1.3, -0.7, 0.4};
  MultivariatePolynomial polynomial{3, 3, std::vector<double>(exponents.size(), 0.0)};
  for (std::size_t k = 0; k < exponents.size(); ++k) {
    polynomial.coefficients[k] = 1;
    double term = 1;
    for (std::size_t i = 0; i < 3; ++i) term *= std::pow(x[i], exponents[k][i]);
    EXPECT_NEAR(evaluate(polynomial, x.data()).value, term, 1e-15) << k;
    polynomial.coefficients[k] = 0;
  }
}

TEST(MultivariatePolynomial, HasExactDerivatives) {
  for (int dimension = 1; dimension <= MultivariatePolynomial::maxDimension; ++dimension) {
    const auto n = static_cast<std::size_t>(dimension);
    const MultivariatePolynomial polynomial = somePolynomial(dimension, 5);
    const std::vector<double> x = someNumbers(n);
    const PolynomialValue at = evaluate(polynomial, x.data());
    const auto moved = [&](std::size_t i, double to) {
      std::vector<double> there = x;
      there[i] = to;
      return evaluate(polynomial, there.data());
    };
    for (std::size_t i = 0; i < n; ++i) {
      const auto value = [&](double to) { return moved(i, to).value; };
      EXPECT_NEAR(at.first[i], support::centralDifference(value, x[i], 1e-3), 1e-9);
      for (std::size_t j = 0; j < n; ++j) {
        const auto slope = [&](double to) { return moved(i, to).first[j]; };
        EXPECT_NEAR(at.second[j][i], support::centralDifference(slope, x[i], 1e-3), 1e-8);
      }
    }
  }
}

TEST(MultivariatePolynomial, RefusesWhatCannotBe) {
  const auto complaint = [](MultivariatePolynomial polynomial) {
    try {
      polynomial.requireRules();
    } catch (const std::invalid_argument& broken) {
      return std::string(broken.what());
    }
    return std::string("nothing");
  };
  EXPECT_EQ(complaint({2, 1, {1, 2, 3}}), "nothing");
  EXPECT_EQ(complaint({2, 1, {1, 2}}), "has 2 coefficients, must have 3 (dimension 2, order 1)");
  EXPECT_EQ(complaint({7, 0, {1}}), "dimension = 7, must be 1 to 6");
  EXPECT_EQ(complaint({0, 0, {1}}), "dimension = 0, must be 1 to 6");
  EXPECT_EQ(complaint({6, 1000000, {1}}),
            "order = 1000000, must be 0 or more and give at most 1000000 terms");
  EXPECT_EQ(complaint({1, 0, {std::nan("")}}), "a coefficient is nan, must be finite");
}

Muscle byFunction(std::vector<std::string> coordinates,
                  std::variant<MultivariatePolynomial, Function> length) {
  Muscle m;
  m.name = "test";
  m.path.function = PathFunction{std::move(coordinates), std::move(length)};
  return m;
}

/// rotation = 0.2 + 0.5 shoulder − 0.1 shoulder²
Model coupledArm() {
  Model model = system();
  model.couplers.push_back(
      {"couple", "shoulder", "rotation", {1, PolynomialFunction{{-0.1, 0.5, 0.2}}}});
  return model;
}

TEST(LengthFunction, HasExactDerivativesInFreeLockedAndCoupledCoordinates) {
  const Muscle m = byFunction({"rotation", "shoulder", "flexion"}, somePolynomial(3, 4));
  const Model model = system();
  ArmPath<1>(model, m).expectDerivatives(ArmPath<1>::Q(0.4));
  ArmPath<2>(model, m).expectDerivatives({0.4, -0.3});
  ArmPath<3>(model, m).expectDerivatives({0.6, 0.4, -0.3});
  // two arguments by one coordinate
  const Model coupled = coupledArm();
  SkeletonOptions options;
  options.freeCoordinates = {"shoulder", "flexion"};
  const Skeleton skeleton(coupled, options);
  const LengthFunction function(*m.path.function, skeleton);
  EXPECT_THAT(function.support(), testing::ElementsAre(0, 1));
  const auto at = [&](double shoulder, double flexion) {
    const double q[] = {shoulder, flexion};
    return function.at(q);
  };
  const double x[] = {0.2 + 0.5 * 0.6 - 0.1 * 0.36, 0.6, 0.4};
  const auto& polynomial = std::get<MultivariatePolynomial>(m.path.function->length);
  EXPECT_NEAR(at(0.6, 0.4).length, evaluate(polynomial, x).value, 1e-15);
  const auto byShoulder = [&](double to) { return at(to, 0.4); };
  const auto length = [&](double to) { return byShoulder(to).length; };
  EXPECT_NEAR(at(0.6, 0.4).first[0], support::centralDifference(length, 0.6, 1e-3), 1e-9);
  for (std::size_t j : {0, 1}) {
    const auto slope = [&](double to) { return byShoulder(to).first[j]; };
    EXPECT_NEAR(at(0.6, 0.4).second[0][j], support::centralDifference(slope, 0.6, 1e-3), 1e-8);
  }
}

TEST(LengthFunction, IsTheSameOverATree) {
  const Muscle m = byFunction({"flexion", "rotation", "shoulder"}, somePolynomial(3, 5));
  const Model model = system();
  ArmPath<3> compiled(model, m);
  SkeletonOptions options;
  options.freeCoordinates = ArmPath<3>::names();
  options.asTree = true;
  const Skeleton tree(model, options);
  TreePaths paths(tree);
  paths.add(m, compiled.path);
  const ArmPath<3>::Q q(0.6, 0.4, -0.3);
  const LengthJet<3> expected = compiled.at(q);
  paths.moveTo(q);
  const LengthJet<Eigen::Dynamic>& jet = paths.length(0);
  EXPECT_EQ(jet.length, expected.length);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(jet.dL_dq[i], expected.dL_dq[i]);
    for (int j = 0; j < 3; ++j) EXPECT_EQ(jet.secondIn(i, j), expected.d2L_dq2(i, j));
  }
  EXPECT_TRUE(compiled.points(q).empty());
}

TEST(LengthFunction, OfOneCoordinateMayBeAnyFunction) {
  const Model model = system();
  for (const Function& f : {Function{2, LinearFunction{-0.02, 0.3}},
                            Function{1, PolynomialFunction{{0.01, -0.03, 0.3}}},
                            Function{1, SplineFunction{{0, 1, 2, 3}, {0.3, 0.28, 0.27, 0.29}}}}) {
    ArmPath<1>(model, byFunction({"flexion"}, f)).expectDerivatives(ArmPath<1>::Q(0.4));
  }
  // −dL/dq = 0.04 whatever the posture
  ArmPath<1> linear(model, byFunction({"flexion"}, Function{2, LinearFunction{-0.02, 0.3}}));
  EXPECT_DOUBLE_EQ(linear.at(ArmPath<1>::Q(0.7)).length, 0.6 - 0.04 * 0.7);
}

TEST(LengthFunction, NeedsAsManyCoordinatesAsArguments) {
  const Model model = system();
  EXPECT_THAT([&] { ArmPath<1>(model, byFunction({"flexion"}, somePolynomial(2, 1))); },
              testing::ThrowsMessage<std::invalid_argument>(
                  testing::HasSubstr("of 2 arguments is given 1 coordinates")));
  const Muscle elsewhere = byFunction({"rotation"}, somePolynomial(1, 2));
  EXPECT_FALSE(ArmPath<1>(model, elsewhere).path.moves());
}

}  // namespace
}  // namespace bio
