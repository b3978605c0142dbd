#include "report/isolines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace app {
namespace {

std::vector<double> range(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(low + (high - low) * i / (count - 1));
  return values;
}

Eigen::MatrixXd heights(const std::vector<double>& x, const std::vector<double>& y,
                        const std::function<double(double, double)>& f) {
  Eigen::MatrixXd out(Eigen::Index(x.size()), Eigen::Index(y.size()));
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < y.size(); ++j)
      out(Eigen::Index(i), Eigen::Index(j)) = f(x[i], y[j]);
  return out;
}

// Pieces of a line: two points and a point that lifts the pen.
double length(const Series& lines) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < lines.x.size(); ++i)
    if (std::isfinite(lines.y[i]) && std::isfinite(lines.y[i + 1]))
      sum += std::hypot(lines.x[i + 1] - lines.x[i], lines.y[i + 1] - lines.y[i]);
  return sum;
}

TEST(Isolines, OfAPlaneAreStraightAndExact) {
  const auto x = range(0, 4, 5), y = range(-1, 1, 3);
  const Series lines =
      isolines("plane", x, y, heights(x, y, [](double a, double b) { return 2 * a + b; }), {3.3});
  EXPECT_EQ(lines.style, SeriesStyle::path);
  for (std::size_t i = 0; i < lines.x.size(); ++i)
    if (std::isfinite(lines.y[i])) {
      EXPECT_NEAR(2 * lines.x[i] + lines.y[i], 3.3, 1e-12);
    }
  EXPECT_NEAR(length(lines), std::sqrt(5.0), 1e-12);  // from y = −1 to 1 while x falls by 1
}

TEST(Isolines, OfARoundBowlAreCirclesOfTheirLevels) {
  const auto x = range(-2, 2, 81), y = range(-2, 2, 81);
  const auto bowl = heights(x, y, [](double a, double b) { return a * a + b * b; });
  const Series lines = isolines("bowl", x, y, bowl, {1});
  for (std::size_t i = 0; i < lines.x.size(); ++i)
    if (std::isfinite(lines.y[i])) {
      EXPECT_NEAR(std::hypot(lines.x[i], lines.y[i]), 1, 1e-3);
    }
  EXPECT_NEAR(length(lines), 2 * std::numbers::pi, 0.01);
  EXPECT_NEAR(length(isolines("bowl", x, y, bowl, {1, 2.25})), 2 * std::numbers::pi * 2.5, 0.02);
  EXPECT_TRUE(isolines("bowl", x, y, bowl, {-1, 100}).x.empty());
}

TEST(Isolines, LeaveOutWhatIsNotFinite) {
  const auto x = range(0, 2, 3), y = range(0, 1, 2);
  auto plane = heights(x, y, [](double a, double b) { return a + b; });
  EXPECT_NEAR(length(isolines("plane", x, y, plane, {1.5})), std::sqrt(2.0), 1e-12);
  plane(2, 1) = std::nan("");
  EXPECT_NEAR(length(isolines("plane", x, y, plane, {1.5})), std::sqrt(0.5), 1e-12);
}

TEST(Isolines, RefuseAGridThatDoesNotFit) {
  EXPECT_THROW(isolines("", {0, 1}, {0, 1}, Eigen::MatrixXd::Zero(2, 3), {0}),
               std::invalid_argument);
  EXPECT_THROW(isolines("", {0}, {0, 1}, Eigen::MatrixXd::Zero(1, 2), {0}), std::invalid_argument);
}

}  // namespace
}  // namespace app
