#include "bio/parameters/parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "bio/opensim/osim_file.h"
#include "support/shipped_elbow.h"

namespace bio {
namespace {

using fixtures::ShippedElbow;
using ::testing::HasSubstr;

TEST(Parameters, AreCalledAsAPersonWouldGuess) {
  const ShippedElbow elbow("elbow8_passive");
  const ParameterCatalogue& c = elbow.catalogue;
  const auto value = [&](const char* name) { return c.parameters()[c.find(name)].value; };
  EXPECT_DOUBLE_EQ(value("TRI.radius"), 0.016);
  EXPECT_DOUBLE_EQ(value("BRA.tendon_slack_length"), 0.0535);
  EXPECT_DOUBLE_EQ(value("BIClong.max_isometric_force"), 525.1);
  EXPECT_DOUBLE_EQ(value("BIClong.optimal_fibre_length"), 0.1157);
  EXPECT_DOUBLE_EQ(value("TRIlong.pennation"), 0.20943951);
  EXPECT_DOUBLE_EQ(value("TRIlong.point2.x"), -0.02714);
  EXPECT_DOUBLE_EQ(value("hand.mass"), 0.5819);
  EXPECT_DOUBLE_EQ(value("ulna.com.y"), -0.0959509);
  EXPECT_DOUBLE_EQ(value("TRI.x"), 0.0028);
  EXPECT_DOUBLE_EQ(value("emg.delay"), 0);
  EXPECT_DOUBLE_EQ(value("emg.BRA.gain"), 1);
  EXPECT_DOUBLE_EQ(value("activation.time_scale"), 0.1);
  EXPECT_NEAR(value("initial.elbow_flexion"), elbow.trial.measured[0].values[0], 1e-15);
  EXPECT_GT(value("elbow_flexion_ligaments.upper_stiffness"), 0);
}

TEST(Parameters, AreEachListedOnce) {
  const ShippedElbow elbow;
  std::set<std::string> names;
  for (const ModelParameter& p : elbow.catalogue.parameters()) {
    EXPECT_TRUE(names.insert(p.name).second) << p.name;
    EXPECT_GT(p.sd, 0) << p.name;
    EXPECT_LE(p.lower, p.value) << p.name;
    EXPECT_GE(p.upper, p.value) << p.name;
    EXPECT_FALSE(p.meaning.empty()) << p.name;
  }
  EXPECT_EQ(elbow.catalogue.select({"all"}).size(), 285u);
}

TEST(Parameters, SetTheModelAndNothingElse) {
  const ShippedElbow elbow("elbow8_passive");
  const ParameterCatalogue& c = elbow.catalogue;
  for (std::size_t i = 0; i < c.parameters().size(); ++i) {
    const ModelParameter& p = c.parameters()[i];
    const double value = std::min(p.value + 0.1 * p.sd, p.upper);
    const auto setting = c.at({i}, Eigen::VectorXd::Constant(1, value));
    // compiled anew, the changed model tells the new value where it tells values at all
    const MusculoskeletalSystem system(setting.model, ShippedElbow::options());
    const ParameterCatalogue again(setting.model, system, setting.start, setting.mapping);
    for (std::size_t j = 0; j < c.parameters().size(); ++j) {
      const bool isScale = p.name.ends_with("_scale") && !p.name.ends_with("time_scale");
      if (j >= again.parameters().size() || p.isGroup || c.parameters()[j].isGroup) continue;
      if (isScale || p.name.ends_with("active_force_width")) continue;
      EXPECT_NEAR(again.parameters()[j].value, j == i ? value : c.parameters()[j].value, 1e-14)
          << c.parameters()[j].name << " after setting " << p.name;
    }
  }
}

TEST(Parameters, AChangedModelIsWrittenAndReadAgain) {
  const ShippedElbow elbow;
  const auto selection = elbow.catalogue.select(
      {"TRI.radius", "BRA.tendon_strain_scale", "BIClong.point9.x", "hand.inertia.xy"});
  const Eigen::Vector4d values(0.018, 1.2, 0.004, 1e-5);
  const auto setting = elbow.catalogue.at(selection, values);
  const std::filesystem::path file =
      std::filesystem::path(::testing::TempDir()) / "changed_elbow.osim";
  writeOsim(setting.model, file);
  const Model again = readOsim(file);
  std::filesystem::remove(file);
  EXPECT_EQ(findWrapObject(again, "TRI").radius, 0.018);
  const MusculoskeletalSystem system(again, ShippedElbow::options());
  const ParameterCatalogue catalogue(again, system, setting.start);
  EXPECT_NEAR(catalogue.parameters()[catalogue.find("BIClong.point9.x")].value, 0.004, 1e-12);
  EXPECT_EQ(findBody(again, "hand").inertia[3], 1e-5);
}

TEST(Parameters, AnUnknownNameOffersTheNearest) {
  const ShippedElbow elbow;
  try {
    elbow.catalogue.find("TRI.radios");
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), HasSubstr("'TRI.radios'"));
    EXPECT_THAT(e.what(), HasSubstr("nearest: TRI.radius"));
  }
  EXPECT_THROW(elbow.catalogue.select({"*.nothing"}), std::invalid_argument);
}

TEST(Parameters, PatternsTakeWhatTheyMatch) {
  const ShippedElbow elbow;
  const auto forces = elbow.catalogue.select({"*.max_isometric_force"});
  EXPECT_EQ(forces.size(), 8u);
  EXPECT_EQ(elbow.catalogue.select({"TRI.radius", "TRI.*", "TRI.radius"}).size(), 7u);
}

TEST(Parameters, AGroupAndItsMemberCannotBeTakenTogether) {
  const ShippedElbow elbow;
  EXPECT_THROW(elbow.catalogue.select({"activation.time_scale", "BRA.time_scale"}),
               std::invalid_argument);
}

TEST(Parameters, ValuesThatAreNotFiniteAreRefused) {
  const ShippedElbow elbow;
  const auto radius = elbow.catalogue.select({"TRI.radius"});
  EXPECT_THROW(elbow.catalogue.at(radius, Eigen::VectorXd::Constant(1, std::nan(""))),
               std::invalid_argument);
  EXPECT_THROW(elbow.catalogue.at(radius, Eigen::VectorXd::Zero(2)), std::invalid_argument);
}

}  // namespace
}  // namespace bio
