#include "synthetic_emg.h"

#include <cmath>
#include <numbers>

#include "bio/emg/emg_stages.h"

namespace validation {
namespace {

constexpr double pi = std::numbers::pi;

double hump(double t, double start, double end) {
  if (t <= start || t >= end) return 0;
  const double half = 0.5 * (1 - std::cos(2 * pi * (t - start) / (end - start)));
  return half * half;
}

// SplitMix64: one 64-bit number after another.
std::uint64_t nextBits(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

// Uniform in (0, 1).
double nextUniform(std::uint64_t& state) {
  return (static_cast<double>(nextBits(state) >> 11) + 0.5) * 0x1p-53;
}

}  // namespace

const std::vector<TrialPlan>& trialPlans() {
  static const std::vector<TrialPlan> plans = {
      {"curl_slow", 30, 0.054, 0.009, {{0.3, 2.3, 0.050, 0.007}, {2.4, 4.4, 0.041, 0.017}}, 101},
      {"curl_fast",
       25,
       0.037,
       0.008,
       {{0.3, 1.2, 0.146, 0.021}, {1.5, 2.4, 0.062, 0.013}, {2.7, 3.8, 0.040, 0.026}},
       202},
      {"cocontraction",
       39,
       0.090,
       0.020,
       {{0.3, 1.9, 0.052, 0.063}, {1.8, 3.2, 0.089, 0.143}, {3.1, 4.4, 0.062, 0.126}},
       303},
  };
  return plans;
}

const std::array<MuscleShare, 8>& muscleShares() {
  static const std::array<MuscleShare, 8> muscles = {{
      {"TRIlong", false, 1.00, 0.000, 800, 14},
      {"TRIlat", false, 1.10, 0.010, 950, -22},
      {"TRImed", false, 0.90, 0.015, 700, 9},
      {"ANC", false, 0.85, 0.020, 400, 31},
      {"BIClong", true, 1.00, 0.000, 1100, -12},
      {"BICshort", true, 0.90, 0.005, 1000, 25},
      {"BRA", true, 1.10, -0.010, 600, -7},
      {"BRD", true, 0.95, 0.020, 850, 18},
  }};
  return muscles;
}

double excitation(const TrialPlan& plan, const MuscleShare& muscle, double t) {
  double group = muscle.flexor ? plan.flexorBaseline : plan.extensorBaseline;
  for (const Burst& burst : plan.bursts) {
    group += (muscle.flexor ? burst.flexors : burst.extensors) *
             hump(t - muscle.lag, burst.start, burst.end);
  }
  return muscle.share * group;
}

double NormalNumbers::next() {
  const double radius = std::sqrt(-2 * std::log(nextUniform(state_)));
  return radius * std::cos(2 * pi * nextUniform(state_));
}

Eigen::VectorXd electrodeSignal(const TrialPlan& plan, std::size_t muscle, double rate,
                                Eigen::Index samples, double lead) {
  const MuscleShare& share = muscleShares().at(muscle);
  NormalNumbers noise(1000 * plan.seed + muscle);
  // noise of the band; its rectified mean is 1 after the band-pass a reader will apply again
  const Eigen::VectorXd white =
      Eigen::VectorXd::NullaryExpr(samples, [&](Eigen::Index) { return noise.next(); });
  const bio::BandPassOptions band;
  Eigen::VectorXd emg = bio::bandPassed(white, rate, band);
  emg /= bio::bandPassed(emg, rate, band).cwiseAbs().mean();
  // effort, mains, amplifier
  for (Eigen::Index i = 0; i < samples; ++i) {
    const double t = static_cast<double>(i) / rate;
    const double phase = 0.7 * static_cast<double>(muscle);
    emg[i] = emg[i] * share.mvc_uV * excitation(plan, share, t + lead) +
             12 * std::sin(2 * pi * 50 * t + phase) + 4 * std::sin(2 * pi * 150 * t + 2 * phase) +
             1.5 * noise.next() + share.offset_uV;
  }
  return emg;
}

}  // namespace validation
