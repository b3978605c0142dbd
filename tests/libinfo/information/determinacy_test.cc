#include "info/information/determinacy.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace info {
namespace {

using testing::HasSubstr;

const std::vector<Parameter> kPair = {{.name = "a", .unit = "kg"}, {.name = "b"}};

TEST(Determinacy, GivesTheCramerRaoBounds) {
  Eigen::Matrix2d information;
  information << 500, 200, 200, 400;
  const auto told = determinacy(information, kPair, Eigen::Vector2d(1, 2));
  const Eigen::Matrix2d covariance = information.inverse();
  for (std::size_t i = 0; i < 2; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(told[i].bound, std::sqrt(covariance(k, k)), 1e-12);
    EXPECT_NEAR(told[i].boundAlone, 1 / std::sqrt(information(k, k)), 1e-12);
    EXPECT_TRUE(told[i].identifiable);
    EXPECT_EQ(told[i].why, "");
  }
}

TEST(Determinacy, NamesThePairThatOnlyMovesTogether) {
  Eigen::Matrix2d information;  // only a + b is seen, to 0.01
  information << 1e4, 1e4, 1e4, 1e4;
  const auto told = determinacy(information, kPair, Eigen::Vector2d(1, 1));
  EXPECT_FALSE(told[0].identifiable);
  EXPECT_TRUE(std::isinf(told[0].bound));
  EXPECT_NEAR(told[0].boundAlone, 0.01, 1e-12);
  EXPECT_THAT(told[0].why, HasSubstr("a is confounded with b: a by +1 kg, b by −1 together"));
  EXPECT_THAT(told[1].why, HasSubstr("b is confounded with a: b by +1, a by −1 kg"));
}

TEST(Determinacy, SaysThatAParameterHardlyMattersOrNotAtAll) {
  const Eigen::Matrix2d information = Eigen::Vector2d(4, 0).asDiagonal();
  const auto told = determinacy(information, kPair, Eigen::Vector2d(0.1, 1), "the angle");
  EXPECT_FALSE(told[0].identifiable);
  EXPECT_EQ(told[0].why,
            "a has too little effect on the angle: even with all other parameters known, the data "
            "alone would determine it to ±0.5 kg only, and its prior is ±0.1 kg");
  EXPECT_FALSE(told[1].identifiable);
  EXPECT_EQ(told[1].why, "b has no effect on the angle");
  EXPECT_TRUE(std::isinf(told[1].boundAlone));
}

// The border is where data and prior together know twice as well as the prior: 1/√(I + 1/d²) = d/2.
TEST(Determinacy, ChangesItsVerdictWhereTheDataHalveWhatWasUncertain) {
  const auto verdict = [](double known) {
    return determinacy(Eigen::MatrixXd::Constant(1, 1, 4), {{.name = "a"}},
                       Eigen::VectorXd::Constant(1, known))[0]
        .identifiable;
  };
  EXPECT_TRUE(verdict(0.867));
  EXPECT_FALSE(verdict(0.865));
  EXPECT_NEAR(1 / std::sqrt(4 + 1 / (0.866025 * 0.866025)), 0.866025 / 2, 1e-6);
}

// A nearly blind direction of others does not make a well-known parameter doubtful.
TEST(Determinacy, KeepsTheThirdParameterOutOfThePairsTrouble) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  information.topLeftCorner(2, 2) << 1e4, 9999.99, 9999.99, 1e4;
  information(2, 2) = 100;
  information(0, 2) = information(2, 0) = 1;
  const auto told = determinacy(information, {{.name = "a"}, {.name = "b"}, {.name = "c"}},
                                Eigen::Vector3d(1, 1, 1));
  EXPECT_FALSE(told[0].identifiable);
  EXPECT_THAT(told[0].why, testing::Not(HasSubstr("c by")));
  EXPECT_TRUE(told[2].identifiable);
}

TEST(Determinacy, RefusesWhatHasNoMeaning) {
  const Eigen::Matrix2d information = Eigen::Matrix2d::Identity();
  EXPECT_THROW(determinacy(information, {{.name = "a"}}, Eigen::Vector2d(1, 1)),
               std::invalid_argument);
  EXPECT_THROW(determinacy(information, kPair, Eigen::Vector2d(1, 0)), std::invalid_argument);
  EXPECT_THROW(determinacy(information, kPair, Eigen::Vector2d(1, std::nan(""))),
               std::invalid_argument);
  EXPECT_THROW(determinacy(Eigen::Matrix2d::Constant(std::nan("")), kPair, Eigen::Vector2d(1, 1)),
               std::domain_error);
}

}  // namespace
}  // namespace info
