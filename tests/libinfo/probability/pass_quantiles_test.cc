#include "info/probability/pass_quantiles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "info/probability/quantile.h"
#include "info/probability/random_stream.h"

// Quantiles from several passes are those of the sorted values, to the last bit.
namespace info {
namespace {

const std::vector<double> shares = {0, 0.05, 0.5, 0.951, 1};

std::vector<double> valuesOf(std::size_t count, const std::function<double(RandomStream&)>& one) {
  RandomStream stream(7, 3);
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(one(stream));
  return values;
}

struct Passed {
  PassQuantiles quantiles;
  int passes = 0;
};

Passed passed(const std::vector<std::vector<double>>& columns) {
  Passed result{{columns.size(), shares}};
  do {
    ++result.passes;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      for (const double x : columns[c]) result.quantiles.add(c, x);
    }
  } while (!result.quantiles.endPass());
  return result;
}

void expectSorted(const Passed& result, std::size_t column, const std::vector<double>& values) {
  for (std::size_t k = 0; k < shares.size(); ++k) {
    EXPECT_EQ(result.quantiles.quantile(column, k), quantileOf(values, shares[k]))
        << "column " << column << ", share " << shares[k];
  }
}

TEST(PassQuantiles, NeedOnePassWhereAllValuesAreKept) {
  const auto values = valuesOf(PassQuantiles::kept(), [](RandomStream& s) { return s.normal(); });
  const Passed result = passed({values});
  EXPECT_EQ(result.passes, 1);
  expectSorted(result, 0, values);
}

TEST(PassQuantiles, AreThoseOfTheSortedValues) {
  constexpr std::size_t count = 60000;
  std::vector<std::vector<double>> columns;
  columns.push_back(valuesOf(count, [](RandomStream& s) { return s.normal(); }));
  columns.push_back(valuesOf(count, [](RandomStream& s) { return std::exp(30 * s.normal()); }));
  columns.push_back(std::vector<double>(count, 0.3));
  columns.push_back(valuesOf(count, [](RandomStream& s) { return std::floor(8 * s.uniform()); }));
  // most at one value, the others around it
  columns.push_back(valuesOf(
      count, [](RandomStream& s) { return s.uniform() < 0.9 ? 0.1 : 0.1 + 1e-9 * s.normal(); }));
  // crowded into a 10⁻¹² part of the range
  columns.push_back(valuesOf(count, [](RandomStream& s) {
    return s.uniform() < 1e-3 ? 1e6 * s.normal() : 1e-6 * s.normal();
  }));
  // two neighbouring numbers
  columns.push_back(valuesOf(
      count, [](RandomStream& s) { return s.uniform() < 0.5 ? 1 : std::nextafter(1, 2); }));
  // two zeros, which are equal
  columns.push_back(valuesOf(count, [](RandomStream& s) {
    return s.uniform() < 0.5 ? 0.0 : s.uniform() < 0.8 ? -0.0 : s.normal();
  }));
  columns.push_back(valuesOf(count, [](RandomStream& s) { return s.uniform() < 0.5 ? 0 : -0.0; }));
  // a range that overflows
  columns.push_back(valuesOf(count, [](RandomStream& s) {
    return s.uniform() < 0.5 ? -1.7e308 * s.uniform() : 1.7e308 * s.uniform();
  }));
  const Passed result = passed(columns);
  EXPECT_LE(result.passes, 7);
  for (std::size_t c = 0; c < columns.size(); ++c) expectSorted(result, c, columns[c]);
}

TEST(PassQuantiles, OfSmoothValuesNeedThreePasses) {
  const auto values = valuesOf(200000, [](RandomStream& s) { return s.normal(); });
  const Passed result = passed({values});
  EXPECT_EQ(result.passes, 3);
  expectSorted(result, 0, values);
  double mean = 0, squares = 0;
  for (const double x : values) mean += x / 200000;
  for (const double x : values) squares += (x - mean) * (x - mean);
  EXPECT_NEAR(result.quantiles.mean(0), mean, 1e-14);
  EXPECT_NEAR(result.quantiles.sd(0), std::sqrt(squares / 199999), 1e-12);
}

TEST(PassQuantiles, IgnoreWhatIsNotFinite) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  const Passed result = passed({{nan, 2, infinity, 4}, {nan, -infinity}, {5}});
  EXPECT_EQ(result.quantiles.count(0), 2u);
  EXPECT_EQ(result.quantiles.quantile(0, 2), 3);
  EXPECT_EQ(result.quantiles.mean(0), 3);
  EXPECT_TRUE(std::isnan(result.quantiles.mean(1)));
  EXPECT_TRUE(std::isnan(result.quantiles.quantile(1, 2)));
  EXPECT_TRUE(std::isnan(result.quantiles.sd(2)));
}

TEST(PassQuantiles, RefuseAPassOfOtherValues) {
  const auto values = valuesOf(20000, [](RandomStream& s) { return s.normal(); });
  PassQuantiles quantiles(1, shares);
  for (const double x : values) quantiles.add(0, x);
  ASSERT_FALSE(quantiles.endPass());
  for (std::size_t i = 0; i < 100; ++i) quantiles.add(0, values[i]);
  EXPECT_THROW(quantiles.endPass(), std::logic_error);
}

}  // namespace
}  // namespace info
