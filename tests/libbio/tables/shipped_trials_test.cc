#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "bio/emg/emg.h"
#include "bio/emg/emg_config.h"
#include "bio/opensim/osim_file.h"
#include "bio/review/trial_review.h"
#include "bio/tables/recording.h"
#include "bio/tables/table_file.h"
#include "bio/tables/trial.h"

namespace {

const std::string sourceTree = FISHERHILL_SOURCE_DIR;

class ShippedTrials : public testing::TestWithParam<std::string> {
 protected:
  std::string trial() const { return sourceTree + "/emg_data/" + GetParam() + ".sto"; }
  std::string raw() const { return sourceTree + "/emg_data/" + GetParam() + "_raw.csv"; }
};

TEST_P(ShippedTrials, AreTrialsOfTheElbowModelWithoutAWarning) {
  const bio::Model model = bio::readOsim(sourceTree + "/models/elbow8.osim");
  const bio::Trial trial = bio::readTrial(this->trial(), model);
  EXPECT_THAT(trial.warnings, testing::IsEmpty());
  for (const bio::Remark& remark : bio::reviewTrial(trial, model)) {
    EXPECT_EQ(remark.weight, bio::Weight::unusual) << remark.message;
  }
  EXPECT_EQ(trial.times.size(), 901);
  EXPECT_DOUBLE_EQ(trial.times[900], 4.5);
  ASSERT_EQ(trial.measured.size(), 1u);
  EXPECT_EQ(trial.measured[0].values.size(), 451);
  // an interesting motion inside the joint's range
  const double degrees = 57.29577951308232;
  EXPECT_GT(trial.measured[0].values.minCoeff() * degrees, 5);
  EXPECT_LT(trial.measured[0].values.maxCoeff() * degrees, 130);
  EXPECT_GT((trial.measured[0].values.maxCoeff() - trial.measured[0].values.minCoeff()) * degrees,
            60);
}

// The raw signals through the shipped configuration give the excitations they were made from, up to
// the scatter of a noisy envelope, √(f_c/2B) = 6 % of the value at 3 Hz and 430 Hz.
TEST_P(ShippedTrials, RawSignalsGiveBackTheExcitations) {
  const bio::EmgConfigFile file =
      bio::readEmgConfig(sourceTree + "/emg_data/configs/shipped_raw.toml");
  const bio::Recording recording = bio::readRecording(raw(), file.layout);
  EXPECT_EQ(recording.channels.size(), 9u);
  EXPECT_EQ(recording.channels[0].rate, 2000);
  const bio::EmgResult result =
      bio::excitationsFromEmg(recording, bio::emgConfigFor(file, recording));
  const bio::Table truth = bio::readTable(trial());
  ASSERT_EQ(result.time.size(), truth.values.rows());
  for (std::size_t k = 0; k < result.muscles.size(); ++k) {
    const Eigen::VectorXd expected = truth.values.col(bio::columnIndex(truth, result.muscles[k]));
    const Eigen::VectorXd error = result.excitations.col(static_cast<Eigen::Index>(k)) - expected;
    const double rms = std::sqrt(error.squaredNorm() / static_cast<double>(error.size()));
    EXPECT_LT(rms, 0.12 * expected.maxCoeff()) << result.muscles[k];
    EXPECT_NEAR(result.excitations.col(static_cast<Eigen::Index>(k)).mean() / expected.mean(), 1,
                0.08)
        << result.muscles[k];
  }
  // the measured angle stands in the same rows
  const Eigen::VectorXd angle = truth.values.col(bio::columnIndex(truth, "elbow_flexion_deg"));
  for (Eigen::Index i = 0; i < angle.size(); ++i) {
    EXPECT_EQ(std::isnan(angle[i]), std::isnan(result.measured_deg[i])) << i;
    if (!std::isnan(angle[i])) {
      EXPECT_NEAR(angle[i], result.measured_deg[i], 1e-9);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EmgData, ShippedTrials,
                         testing::Values("curl_slow", "curl_fast", "cocontraction"));

TEST(EmgData, IsSmall) {
  std::uintmax_t size = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(sourceTree + "/emg_data")) {
    if (entry.is_regular_file()) size += entry.file_size();
  }
  EXPECT_LT(size, 2'400'000u);
}

}  // namespace
