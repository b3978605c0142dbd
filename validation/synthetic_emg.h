#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// The made-up person whose trials are shipped in emg_data/: what the muscles were asked to do and
/// what electrodes would have shown of it.
namespace validation {

/// One effort: excitation rises from the baseline and falls back, (½(1 − cos))² in shape.
struct Burst {
  double start;      ///< [s]
  double end;        ///< [s]
  double flexors;    ///< largest rise of the flexors' excitation
  double extensors;  ///< … of the extensors'
};

struct TrialPlan {
  std::string name;
  double startAngle_deg;  ///< elbow flexion at rest before the first effort
  double flexorBaseline;
  double extensorBaseline;
  std::vector<Burst> bursts;
  std::uint64_t seed;  ///< of the electrodes' and the goniometer's noise
};

/// curl_slow, curl_fast, cocontraction; 4.5 s each.
const std::vector<TrialPlan>& trialPlans();

struct MuscleShare {
  std::string name;
  bool flexor;
  double share;      ///< of the group's excitation
  double lag;        ///< behind the group [s]
  double mvc_uV;     ///< envelope of its EMG at excitation 1
  double offset_uV;  ///< of its amplifier
};
const std::array<MuscleShare, 8>& muscleShares();

/// Excitation of one muscle at any time [s].
double excitation(const TrialPlan& plan, const MuscleShare& muscle, double t);

/// Standard normal numbers, the same on every machine (std::normal_distribution is not).
class NormalNumbers {
 public:
  explicit NormalNumbers(std::uint64_t seed) : state_(seed) {}
  double next();

 private:
  std::uint64_t state_;
};

/// What an electrode on this muscle shows [µV]: noise of 20–450 Hz whose rectified mean after that
/// band-pass is mvc·excitation(t + lead), a line of 50 Hz (12 µV) and 150 Hz (4 µV), the
/// amplifier's noise (1.5 µV) and offset.
/// @param rate [Hz]
/// @param lead EMG before excitation [s]
Eigen::VectorXd electrodeSignal(const TrialPlan& plan, std::size_t muscle, double rate,
                                Eigen::Index samples, double lead);

}  // namespace validation
