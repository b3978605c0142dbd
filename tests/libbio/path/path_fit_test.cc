#include "bio/path/path_fit.h"

#include <gmock/gmock.h>

#include <cmath>

#include "bio/analysis/fit_paths.h"
#include "bio/path/length_function.h"
#include "support/elbow_model.h"

namespace bio {
namespace {

/// Values and slopes of f on a lattice of n² postures of two coordinates.
template <class F>
SampledPath latticeOf(const F& f, int n, double shift) {
  SampledPath path;
  path.coordinates = {"a", "b"};
  path.q.resize(n * n, 2);
  path.length.resize(n * n);
  path.slope.resize(n * n, 2);
  for (int i = 0; i < n * n; ++i) {
    const double a = 0.2 + 1.5 * (i % n + shift) / n, b = -0.7 + 0.9 * (i / n + shift) / n;
    path.q.row(i) << a, b;
    const std::array<double, 3> at = f(a, b);
    path.length[i] = at[0];
    path.slope.row(i) << at[1], at[2];
  }
  return path;
}

TEST(PathFit, FindsAPolynomialOfItsOrder) {
  const MultivariatePolynomial truth{
      2, 3, {0.3, 0.02, -0.01, 0.004, -0.03, 0.007, 0.01, 0.002, -0.003, 0.005}};
  const auto f = [&](double a, double b) {
    const double x[] = {a, b};
    const PolynomialValue p = evaluate(truth, x);
    return std::array<double, 3>{p.value, p.first[0], p.first[1]};
  };
  const PathFit fit = fitPolynomial(latticeOf(f, 12, 0), latticeOf(f, 7, 0.4), {1e-9, 9});
  EXPECT_TRUE(fit.meetsTolerance);
  EXPECT_LT(fit.length.largest, 1e-14);
  EXPECT_LT(fit.arm.largest, 1e-13);
  const auto& found = std::get<MultivariatePolynomial>(fit.function.length);
  EXPECT_EQ(found.order, 3);
  ASSERT_EQ(found.coefficients.size(), truth.coefficients.size());
  for (std::size_t k = 0; k < truth.coefficients.size(); ++k) {
    EXPECT_NEAR(found.coefficients[k], truth.coefficients[k], 1e-13) << k;
  }
}

// Of exp(a)·sin(b)-like lengths the least sufficient order: one less is not enough.
TEST(PathFit, TakesTheLeastOrderThatIsEnough) {
  const auto f = [](double a, double b) {
    const double e = 0.1 * std::exp(-a);
    return std::array<double, 3>{0.3 + e * std::sin(b), -e * std::sin(b), e * std::cos(b)};
  };
  const auto fitted = latticeOf(f, 14, 0), held = latticeOf(f, 9, 0.4);
  const PathFit fit = fitPolynomial(fitted, held, {1e-6, 9});
  ASSERT_TRUE(fit.meetsTolerance);
  EXPECT_LE(fit.length.largest, 1e-6);
  EXPECT_GE(fit.length.largest, fit.length.rms);
  const int order = std::get<MultivariatePolynomial>(fit.function.length).order;
  const PathFit lower = fitPolynomial(fitted, held, {1e-6, order - 1});
  EXPECT_FALSE(lower.meetsTolerance);
  EXPECT_GT(lower.length.largest, 1e-6);
  SampledPath lengthsOnly = fitted;
  lengthsOnly.slope.resize(0, 0);
  const PathFit without = fitPolynomial(lengthsOnly, {}, {1e-6, 9});
  EXPECT_TRUE(without.meetsTolerance);
  EXPECT_TRUE(std::isnan(without.arm.rms));
}

TEST(PathFit, RefusesWhatItCannotFit) {
  const auto f = [](double a, double b) { return std::array<double, 3>{a + b, 1, 1}; };
  const auto complaint = [&](const SampledPath& path, PathFitOptions options = {}) {
    try {
      fitPolynomial(path, {}, options);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const SampledPath good = latticeOf(f, 4, 0);
  EXPECT_EQ(complaint(good), "nothing");
  SampledPath still = good;
  still.q.col(1).setConstant(0.1);
  EXPECT_EQ(complaint(still), "coordinate 'b' does not vary");
  SampledPath few = good;
  few.q.conservativeResize(1, 2);
  few.length.conservativeResize(1);
  few.slope.resize(0, 0);
  EXPECT_EQ(complaint(few), "1 postures are too few for 2 coordinates");
  EXPECT_THAT(complaint(good, {0, 9}), testing::HasSubstr("must be > 0, 1 to 9"));
  EXPECT_THAT(complaint(good, {1e-4, 10}), testing::HasSubstr("must be > 0, 1 to 9"));
}

// Over the elbow the brachialis' length jumps at 0 when its conditional point goes.
TEST(PathFit, ReplacesPathsOfTheElbowAndSaysWhichItCannot) {
  Model model = fixtures::elbowModel();
  for (Joint& joint : model.joints) {
    for (Coordinate& c : joint.coordinates) {
      if (c.name == "elbow_flexion") c.rangeMin = -0.3;
    }
  }
  SkeletonOptions options;
  options.freeCoordinates = {"elbow_flexion"};
  const auto fits = fitPaths(model, options, {}, {"BRA", "BIClong", "TRIlat"}, {2e-4, 9});
  ASSERT_EQ(fits.size(), 3u);
  for (const MuscleFit& one : fits) {
    if (one.muscle == "BRA") {
      EXPECT_THAT(one.whyNot, testing::HasSubstr("the length of BRA jumps by 5.2"));
      continue;
    }
    ASSERT_TRUE(one.fit);
    EXPECT_EQ(one.whyNot, "");
    EXPECT_LE(one.fit->length.largest, 2e-4);
  }
  const Model changed = withFittedPaths(model, fits);
  EXPECT_FALSE(findMuscle(changed, "BRA").path.function);
  ASSERT_TRUE(findMuscle(changed, "BIClong").path.function);
  EXPECT_TRUE(findMuscle(changed, "BIClong").path.points.empty());
  EXPECT_EQ(findMuscle(changed, "BICshort"), findMuscle(model, "BICshort"));
}

}  // namespace
}  // namespace bio
