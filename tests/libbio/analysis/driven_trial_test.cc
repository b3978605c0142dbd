#include "bio/analysis/driven_trial.h"

#include <gtest/gtest.h>

#include "bio/opensim/osim_file.h"
#include "bio/tables/trial_table.h"

namespace {

using Eigen::VectorXd;

// What drove the muscles changes; what pushed from outside and what the hand held do not.
TEST(DrivenTrial, KeepsTheTorqueFromOutsideAndWhatIsKnown) {
  const std::string root = FISHERHILL_SOURCE_DIR;
  const bio::Model model = bio::readOsim(root + "/models/elbow8.osim");
  const bio::MusculoskeletalSystem system(model, {{{"elbow_flexion"}, {}}, {}, {}});
  bio::Trial trial = bio::readTrial(root + "/emg_data/curl_slow.sto", model);
  const VectorXd torque = (3 * trial.times).array().sin();
  trial.applied = {{"elbow_flexion", torque}};
  trial.conditions = {1.25, -0.5};
  bio::EmgMapping mapping;
  mapping.delay = 0.013;
  const bio::Table table = bio::drivenTable(trial, system, mapping);
  const bio::Trial driven =
      bio::trialFrom(table, "driven", model, {.experimentalConditions = true});
  EXPECT_EQ(driven.conditions.massInHand, 1.25);
  EXPECT_NEAR(driven.conditions.armTurn, -0.5, 1e-12);
  ASSERT_EQ(driven.applied.size(), 1U);
  ASSERT_EQ(driven.measured.size(), 1U);
  EXPECT_GT(driven.times.size(), trial.times.size());  // excitations bend between the rows now
  Eigen::Index next = 0;
  for (Eigen::Index i = 0; i < driven.times.size(); ++i) {
    if (driven.times[i] != trial.times[next]) continue;
    EXPECT_NEAR(driven.applied[0].values[i], torque[next], 1e-12);
    ++next;
  }
  EXPECT_EQ(next, trial.times.size());
}

}  // namespace
