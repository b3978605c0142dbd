// Recordings of our own in other programs' layouts, through the shipped configurations.
// tests/beside asks the same of recordings made by people.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "bio/emg/emg.h"
#include "bio/emg/emg_config.h"
#include "bio/tables/recording.h"
#include "support/scratch_folder.h"

namespace {

constexpr double trignoRate = 2148.1481;

/// Effort in the recording below [mV]: the amplitude of its tone of 110 Hz.
double effortAt(double t) {
  return 0.3 + 0.2 * std::sin(2 * std::numbers::pi * 0.4 * t);
}

/// Four seconds of a Delsys Trigno export: an accelerometer beside an EMG of another rate.
std::string trignoExport() {
  std::string text =
      "Application:, Trigno Discover (1.6.5)\nDate/Time:, 01/01/2026 12:00:00\n"
      "Collection Length (seconds):, 4\nwrist (1), bicep (2)\nsensor mode: 1, sensor mode: 40\n"
      "ACC X (G), EMG 1 (mV)\n370.3704 Hz, 2148.1481 Hz\n";
  for (int k = 0; k < static_cast<int>(4 * trignoRate); ++k) {
    const double t = k / trignoRate;
    if (t < 4 * 370.3704 / trignoRate) text += "0.9";
    text +=
        ", " + std::to_string(effortAt(t) * std::sin(2 * std::numbers::pi * 110 * t) + 0.04) + "\n";
  }
  return text;
}

// The envelope of a tone is its rectified mean, 2/π of the amplitude, times the gain of the slow
// filter at the effort's own frequency, 1/(1 + (f/fc)^4) of two passes of second order.
TEST(RecordedEmg, ATrignoExportGivesTheEnvelopeOfItsTone) {
  const support::ScratchFolder folder;
  const std::string raw = folder.file("tone.csv", trignoExport());
  const bio::EmgConfigFile file =
      bio::readEmgConfig(std::string(FISHERHILL_SOURCE_DIR) + "/emg_data/configs/trigno.toml");
  const bio::Recording data = bio::readRecording(raw, file.layout);
  EXPECT_EQ(data.format, bio::RecordingFormat::trigno);
  EXPECT_NEAR(bio::findChannel(data, "biceps").rate, trignoRate, 1e-6);
  EXPECT_EQ(bio::findChannel(data, "biceps").unit, "mV");
  const bio::EmgConfig config = bio::emgConfigFor(file, data);
  const bio::ElectrodeTrace ours = bio::emgEnvelope(bio::findChannel(data, "biceps"), config);
  double worst = 0;
  for (double t = 0.5; t < 3.5; t += 0.05) {
    const double at = t * ours.rate;
    const double found = ours.envelope[static_cast<Eigen::Index>(std::lround(at))];
    worst = std::max(worst, std::abs(found - 2 / std::numbers::pi * effortAt(t)));
  }
  std::printf("worst difference from 2/pi of the amplitude %.2g mV\n", worst);
  EXPECT_LT(worst, 0.003);
}

// An envelope in a table is a recording too.
TEST(RecordedEmg, ADerivedEnvelopeIsReadAsATable) {
  const support::ScratchFolder folder;
  std::string text = "time_s,forearm_inclination_deg,biceps_envelope_mV\n";
  for (int k = 0; k < 100; ++k) {
    text += std::to_string(0.01 * k) + ",-0.1," + std::to_string(0.01 + 0.001 * k) + "\n";
  }
  const bio::Recording data = bio::readRecording(folder.file("derived.csv", text));
  EXPECT_EQ(data.format, bio::RecordingFormat::table);
  EXPECT_NEAR(bio::findChannel(data, "biceps_envelope_mV").rate, 100, 1e-9);
  EXPECT_EQ(bio::findChannel(data, "biceps_envelope_mV").unit, "mV");
  EXPECT_EQ(bio::findChannel(data, "forearm_inclination_deg").unit, "deg");
}

}  // namespace
