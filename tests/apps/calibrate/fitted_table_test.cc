#include "calibrate/fitted_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace app {
namespace {

TEST(FittedTable, HasARowPerNumberAndNothingWhereNothingIsKnown) {
  const std::vector<info::discover::FittedNumber> numbers = {
      {3, "BRA.max_isometric_force", "N", 100, 120.5, 2.5, 15, 1.25},
      {4, "hand.mass", "kg", 0.5, 0.25, std::nan(""), std::nan(""), std::nan("")}};
  std::ostringstream out;
  writeFitted(numbers, out);
  EXPECT_EQ(out.str(),
            "name,unit,nominal,estimate,sd,prior_sd,prior_z\n"
            "BRA.max_isometric_force,N,100,120.5,2.5,15,1.25\n"
            "hand.mass,kg,0.5,0.25,,,\n");
  const auto json = fittedJson(numbers);
  ASSERT_EQ(json.size(), 2U);
  EXPECT_EQ(json[0]["prior_z"], 1.25);
  EXPECT_EQ(json[1]["name"], "hand.mass");
  EXPECT_TRUE(json[1]["sd"].is_null());
}

}  // namespace
}  // namespace app
