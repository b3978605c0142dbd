#include "info/information/identifiability.h"

#include <gmock/gmock.h>

#include <cmath>

namespace {

using Eigen::MatrixXd;
using info::identifiability;
using info::Parameter;
using info::ParameterScale;
using testing::ElementsAre;
using testing::HasSubstr;

// Information of data that depend on θ through the rows' combinations only.
MatrixXd from(const MatrixXd& rows) {
  return rows.transpose() * rows;
}

const std::vector<Parameter> kPendulum = {{.name = "m1", .unit = "kg", .start = 0.085},
                                          {.name = "L1", .unit = "m", .start = 0.3},
                                          {.name = "c", .unit = "kg m²/s", .start = 5e-4}};

// y depends on ln m1 + ln L1 and on c: d/dθ = (1/m1, 1/L1, ·).
TEST(Identifiability, SaysThatOnlyAProductIsDetermined) {
  MatrixXd rows(2, 3);
  rows << 1 / 0.085, 1 / 0.3, 0, 3, 3 * 0.085 / 0.3, 1e4;
  const auto report = identifiability(from(rows), kPendulum);
  EXPECT_EQ(report.rank, 2);
  EXPECT_THAT(report.determined, ElementsAre("m1·L1"));
  ASSERT_EQ(report.undetermined.size(), 1u);
  EXPECT_THAT(report.undetermined[0].parameters, ElementsAre("m1", "L1"));
  EXPECT_THAT(report.sentences,
              ElementsAre(HasSubstr(
                  "m1 and L1 are not separately identifiable: only m1·L1 is determined")));
  EXPECT_TRUE(std::isinf(report.sd[0]));
  EXPECT_TRUE(std::isinf(report.sd[1]));
  EXPECT_TRUE(std::isnan(report.correlation(0, 1)));
  // the direction really is one: along it, no output changes
  EXPECT_LT((rows * report.undetermined[0].direction).norm(), 1e-9 * (rows.rowwise().norm()).sum());
}

TEST(Identifiability, FindsRatiosAndPowers) {
  MatrixXd ratio(2, 3);
  ratio << 1 / 0.085, -1 / 0.3, 0, 0, 0, 1;
  auto report = identifiability(from(ratio), kPendulum);
  EXPECT_THAT(report.determined, ElementsAre("m1/L1"));
  EXPECT_EQ(report.undetermined[0].words, "m1 +1 %, L1 +1 %");
  MatrixXd power(1, 3);  // m1·L1²/c
  power << 1 / 0.085, 2 / 0.3, -1 / 5e-4;
  report = identifiability(from(power), kPendulum);
  EXPECT_EQ(report.rank, 1);
  EXPECT_THAT(report.determined, ElementsAre("m1·L1²/c"));
}

TEST(Identifiability, PutsSumsIntoWordsOnTheLinearScale) {
  const std::vector<Parameter> parameters = {{.name = "a", .unit = "m", .start = 1},
                                             {.name = "b", .unit = "m", .start = 4}};
  const auto report =
      identifiability(from(Eigen::RowVector2d(1, -2)), parameters, ParameterScale::linear);
  EXPECT_THAT(report.determined, ElementsAre("a − 2·b"));
}

// A direction through negative start values: m·k is fixed also where k < 0.
TEST(Identifiability, HandlesNegativeValuesOnTheLogarithmicScale) {
  const std::vector<Parameter> parameters = {{.name = "m", .start = 2}, {.name = "k", .start = -4}};
  const auto report = identifiability(from(Eigen::RowVector2d(1.0 / 2, -1.0 / 4)), parameters);
  EXPECT_THAT(report.determined, ElementsAre("m·k"));
  EXPECT_THAT(report.undetermined[0].words, testing::AnyOf("m +1 %, k −1 %", "m −1 %, k +1 %"));
}

TEST(Identifiability, NamesAParameterWithoutAnyEffect) {
  const auto report =
      identifiability(Eigen::Vector3d(3, 0, 1e6).asDiagonal().toDenseMatrix(), kPendulum);
  EXPECT_THAT(report.sentences, ElementsAre("L1 has no effect on what is measured"));
  EXPECT_EQ(report.rank, 2);
  EXPECT_NEAR(report.sd[0], 1 / std::sqrt(3.0), 1e-12);
}

TEST(Identifiability, KeepsSeparateGroupsApart) {
  const std::vector<Parameter> four = {{.name = "a", .start = 1},
                                       {.name = "b", .start = 1},
                                       {.name = "c", .start = 1},
                                       {.name = "d", .start = 1}};
  MatrixXd rows(2, 4);
  rows << 1, 1, 0, 0, 0, 0, 1, -1;
  const auto report = identifiability(from(rows), four);
  EXPECT_THAT(report.determined, testing::UnorderedElementsAre("a·b", "c/d"));
  EXPECT_EQ(report.sentences.size(), 2u);
}

TEST(Identifiability, GivesTheBoundAndCorrelationsWhereAllIsDetermined) {
  const MatrixXd information = (Eigen::Matrix2d() << 4, 1, 1, 9).finished();
  const auto report =
      identifiability(information, {{.name = "a", .start = 2}, {.name = "b", .start = 1e-3}});
  const MatrixXd bound = information.inverse();
  EXPECT_EQ(report.rank, 2);
  EXPECT_THAT(report.sentences, ElementsAre("all parameters are identifiable"));
  EXPECT_NEAR(report.sd[1], std::sqrt(bound(1, 1)), 1e-12);
  EXPECT_NEAR(report.correlation(0, 1), -1.0 / 6, 1e-12);
}

// Rank is a verdict about the model, so it must not change with the units of a parameter.
TEST(Identifiability, DoesNotDependOnUnits) {
  const MatrixXd information = (Eigen::Matrix2d() << 2, 1, 1, 1).finished();
  const Eigen::Vector2d unit(1, 1e8);
  const auto report = identifiability(unit.asDiagonal() * information * unit.asDiagonal(),
                                      {{.name = "a", .start = 1}, {.name = "b", .start = 1e-8}});
  EXPECT_EQ(report.rank, 2);
}

TEST(Identifiability, RefusesHalfAMatrix) {
  Eigen::Matrix2d information{{1, 0.3}, {0.5, 1}};
  const std::vector<Parameter> two = {{.name = "a", .start = 2}, {.name = "b", .start = 1e-3}};
  EXPECT_THAT([&] { identifiability(information, two); },
              testing::ThrowsMessage<std::invalid_argument>(
                  HasSubstr("must be symmetric, but entry (a, b) is 0.3 and (b, a) is 0.5")));
  information(0, 1) = 0.5;
  EXPECT_EQ(identifiability(information, two).rank, 2);
}

TEST(Identifiability, RefusesWhatItCannotScale) {
  EXPECT_THAT([] { identifiability(MatrixXd::Ones(1, 1), {{.name = "c", .start = 0}}); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("parameter c")));
  EXPECT_THROW(identifiability(MatrixXd::Ones(2, 2), {{.name = "c", .start = 1}}),
               std::invalid_argument);
  EXPECT_THROW(identifiability(MatrixXd::Constant(1, 1, std::nan("")), {{.name = "c", .start = 1}}),
               std::domain_error);
}

}  // namespace
