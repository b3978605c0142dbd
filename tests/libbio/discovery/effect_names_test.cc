#include "bio/discovery/effect_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bio/discovery/effects.h"
#include "support/shipped_elbow.h"

namespace {

using namespace bio::discover;

const bio::SystemOptions options = bio::fixtures::ShippedElbow::options();

TEST(EffectNames, LongNamesAndIdsAreTheSameEffect) {
  EXPECT_EQ(effectId("viscous_damping"), "visc");
  EXPECT_EQ(effectId("visc"), "visc");
  EXPECT_EQ(effectId("max_isometric_force_TRI"), "Fmax_TRI");
  EXPECT_EQ(effectId("emg_baseline"), "offset");
  EXPECT_EQ(effectId("emg_baseline_BIC"), "offset_BIC");
  EXPECT_EQ(effectId("max_isometric_force_"), "max_isometric_force_");  // of no muscle
  EXPECT_EQ(effectLongName("gain"), "sensor_gain");
  EXPECT_EQ(effectLongName("gain_TRI"), "gain_TRI");  // the electrode's
}

TEST(EffectNames, EveryLongNameOfTheElbowsCatalogueLeadsBackToItsId) {
  const EncompassingModel all =
      encompassingModel(bio::fixtures::ShippedElbow().model, options, "elbow_flexion");
  int different = 0;
  for (const info::discover::Candidate& one : all.candidates()) {
    const std::string name = effectLongName(one.id);
    EXPECT_EQ(effectId(name), one.id);
    different += name != one.id;
  }
  EXPECT_GE(different, 9 + 3 * 3);
}

TEST(EffectNames, LeaveOutAnEffectOfTheCatalogue) {
  const bio::Model model = bio::fixtures::ShippedElbow().model;
  EXPECT_TRUE(encompassingModel(model, options, "elbow_flexion").knows("visc"));
  EXPECT_FALSE(encompassingModel(model, options, "elbow_flexion", {.without = {"viscous_damping"}})
                   .knows("visc"));
}

}  // namespace
