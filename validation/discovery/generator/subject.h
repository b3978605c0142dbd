#pragma once

#include <vector>

#include "generator/hidden_effects.h"

namespace hidden {

struct TrialPlan {
  double duration = 4.5;      ///< [s]
  double rate = 100;          ///< of EMG and angle [Hz]
  double emgNoise = 0;        ///< relative, Ornstein–Uhlenbeck of 80 ms, at the muscle
  double angleNoise = 0.5;    ///< [deg]
  bool torquePulses = false;  ///< known pulses from outside
  bool passive = false;       ///< relaxed, moved by somebody else (passive_trial.h)
  bool openLoop = false;      ///< random pulses that nobody steers (open_loop_trial.h)
};

struct Trial {
  Recording truth;                              ///< what drove the muscles
  std::vector<std::array<double, 8>> recorded;  ///< what the file says of it
  std::vector<double> angle;                    ///< q at the rows [rad]
  std::vector<double> measured_deg;             ///< through the sensor, with noise, 0.01° steps
  double tracking_deg = 0;                      ///< RMS distance from the target
};

/// The EMG, as a file can hold it, that gives these excitations through the chain.
std::array<double, 8> recordedAs(const InputChain& chain, const std::array<double, 8>& excitations);

/// What an angle sensor shows without noise [rad]: q after clock, gain and bias.
std::vector<double> throughSensor(const Sensor& sensor, const Recording& times,
                                  const std::vector<double>& angle);

/// Takes the truth's dropout off the recorded EMG.
void loseRecords(const Truth& truth, Trial& trial);

/// Writes down what the sensor shows of the trial's angle, with white noise, in steps of 0.01°.
void measure(const Truth& truth, const TrialPlan& plan, Trial& trial, RandomNumbers& random);

/// q [rad] at the recording's times under its EMG, from rest at q0, open loop.
std::vector<double> replayed(const Truth& truth, const Recording& recording, double q0,
                             double tolerance);

/// A person follows a random smooth target between 25 and 115° with feedback (100 Hz, position,
/// speed, integral), co-contraction and shares between muscles that wander, in the true elbow.
/// What the muscles received is recorded, so that replaying the record open loop gives the same
/// motion. The arm starts at rest, balanced.
/// @throws std::runtime_error where it does not work out: no balance, or an angle outside 8 … 128°
Trial makeTrial(const Truth& truth, const TrialPlan& plan, RandomNumbers& random);

}  // namespace hidden
