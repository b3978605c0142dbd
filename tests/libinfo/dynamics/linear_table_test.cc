#include "info/dynamics/linear_table.h"

#include <gtest/gtest.h>

#include <vector>

namespace {

using info::linearAt;

const std::vector<double> times{0.0, 1.0, 3.0};
const Eigen::Vector3d values{2.0, -2.0, 4.0};

TEST(LinearTable, IsStraightBetweenRowsAndExactOnThem) {
  EXPECT_DOUBLE_EQ(linearAt(times, 0.25).value(values), 1.0);
  EXPECT_DOUBLE_EQ(linearAt(times, 2.5).value(values), 2.5);
  for (Eigen::Index k = 0; k < 3; ++k)
    EXPECT_EQ(linearAt(times, times[std::size_t(k)]).value(values), values[k]);
}

TEST(LinearTable, HoldsTheFirstAndTheLastRowOutside) {
  EXPECT_EQ(linearAt(times, -5.0).value(values), 2.0);
  EXPECT_EQ(linearAt(times, 9.0).value(values), 4.0);
  EXPECT_EQ(linearAt(std::vector<double>{7.0}, 9.0).value(Eigen::VectorXd::Constant(1, 5)), 5.0);
}

TEST(LinearTable, GivesWholeRowsAndTakesTimesOfEitherKind) {
  const Eigen::VectorXd sameTimes = Eigen::Vector3d(0.0, 1.0, 3.0);
  Eigen::MatrixXd table(3, 2);
  table << values, 10 * values;
  for (double t : {-1.0, 0.0, 0.3, 1.0, 2.9, 3.0, 4.0}) {
    const auto row = linearAt(sameTimes, t).rows(table);
    EXPECT_EQ(row[0], linearAt(times, t).value(values));
    EXPECT_DOUBLE_EQ(row[1], 10 * row[0]);
  }
}

}  // namespace
