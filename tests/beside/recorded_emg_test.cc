#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bio/emg/emg.h"
#include "bio/emg/emg_config.h"
#include "bio/tables/recording.h"
#include "bio/tables/table_file.h"

// Recordings made elsewhere, beside the source tree; they are not part of it, and CMake leaves this
// program out where they are not there.
namespace {

const std::string recordedSource = FISHERHILL_SOURCE_DIR;
const std::string recordings = recordedSource + "/../shared/data/emg/";
const std::string configs = recordedSource + "/emg_data/configs/";

double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::VectorXd x = a.array() - a.mean();
  const Eigen::VectorXd y = b.array() - b.mean();
  return x.dot(y) / (x.norm() * y.norm());
}

bio::EmgResult run(const std::string& recording, const std::string& config) {
  const bio::EmgConfigFile file = bio::readEmgConfig(configs + config);
  const bio::Recording data = bio::readRecording(recordings + recording, file.layout);
  return bio::excitationsFromEmg(data, bio::emgConfigFor(file, data));
}

// Known of this recording: 24.8 s, 1.3 % of the goniometer clipped, about 95° of motion, and the
// envelope fits the angle 0.6 s later with r = 0.81.
TEST(RecordedEmg, GoniometerRecordingGivesItsKnownSpanClippingAndLag) {
  const bio::EmgResult r = run("goniometer/Carl_1.txt", "goniometer.toml");
  EXPECT_NEAR(r.time[r.time.size() - 1], 24.82, 0.01);
  EXPECT_THAT(r.muscles, testing::ElementsAre("BIClong", "BICshort", "BRA", "BRD"));
  EXPECT_NEAR(r.measured->notMeasured, 0.013, 0.0005);
  const double most = r.measured_deg.maxCoeff<Eigen::PropagateNumbers>();
  const double least = r.measured_deg.minCoeff<Eigen::PropagateNumbers>();
  EXPECT_NEAR(most - least, 95, 2);
  double best = 0;
  double bestLag = 0;
  for (int lag = 0; lag <= 240; lag += 4) {  // rows of 5 ms; the angle stands on every fourth
    std::vector<double> excitation;
    std::vector<double> angle;
    for (Eigen::Index i = 0; i + lag < r.time.size(); ++i) {
      if (std::isnan(r.measured_deg[i + lag])) continue;
      excitation.push_back(r.excitations(i, 0));
      angle.push_back(r.measured_deg[i + lag]);
    }
    const auto n = static_cast<Eigen::Index>(angle.size());
    const double c = correlation(Eigen::VectorXd::Map(excitation.data(), n),
                                 Eigen::VectorXd::Map(angle.data(), n));
    if (c > best) {
      best = c;
      bestLag = 0.005 * lag;
    }
  }
  EXPECT_NEAR(best, 0.81, 0.04);
  // the excitation is already 0.06 s later than the envelope
  EXPECT_NEAR(bestLag, 0.54, 0.06);
}

// The same signals were filtered elsewhere (20–450 Hz, rectified, 3 Hz) and resampled to 100 Hz.
TEST(RecordedEmg, TrignoEnvelopesEqualThoseComputedElsewhere) {
  for (const std::string name : {"A321_5_5", "A321_10_2", "A321_15_11", "G998_15_1"}) {
    const std::string raw = "wrist_imu/raw/" + name + ".csv";
    const std::string derived = recordings + "wrist_imu/derived_100hz/" + name + ".csv";
    const bio::EmgConfigFile file = bio::readEmgConfig(configs + "trigno.toml");
    const bio::Recording data = bio::readRecording(recordings + raw, file.layout);
    bio::EmgConfig config = bio::emgConfigFor(file, data);
    config.notch.lines = {};
    const bio::ElectrodeTrace ours = bio::emgEnvelope(bio::findChannel(data, "biceps"), config);
    const bio::Table theirs = bio::readTable(derived);
    const Eigen::VectorXd times = bio::timesOf(theirs);
    const Eigen::VectorXd expected =
        theirs.values.col(bio::columnIndex(theirs, "biceps_envelope_mV"));
    const Eigen::VectorXd found = bio::sampledAt(ours.envelope, ours.rate, 0, times);
    // measured 0.9979 to 0.9992 and 0.4 %: the ends and the corner convention differ
    EXPECT_GT(correlation(found, expected), 0.997) << name;
    EXPECT_NEAR(found.norm() / expected.norm(), 1, 0.006) << name;
  }
}

// An envelope in a table is a recording too.
TEST(RecordedEmg, ADerivedEnvelopeIsReadAsATable) {
  const std::string file = recordings + "wrist_imu/derived_100hz/A321_5_5.csv";
  const bio::Recording data = bio::readRecording(file);
  EXPECT_EQ(data.format, bio::RecordingFormat::table);
  EXPECT_NEAR(bio::findChannel(data, "biceps_envelope_mV").rate, 100, 1e-9);
  EXPECT_EQ(bio::findChannel(data, "biceps_envelope_mV").unit, "mV");
  EXPECT_EQ(bio::findChannel(data, "forearm_inclination_deg").unit, "deg");
}

}  // namespace
