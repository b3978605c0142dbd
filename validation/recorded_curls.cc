// Calibrates the elbow on half of the repetitions of a recorded series of curls and tests it on the
// other half: recorded_curls RECORDING CONFIG.toml MODEL.osim. Prints what
// validation/calibration.md quotes.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <exception>
#include <numbers>

#include "bio/calibration/calibrate.h"
#include "bio/emg/emg.h"
#include "bio/emg/emg_config.h"
#include "bio/opensim/osim_file.h"
#include "bio/tables/recording.h"

namespace {

using Eigen::Index;
constexpr double degree = std::numbers::pi / 180;

bio::EmgResult excitations(const std::string& recording, const std::string& config) {
  const bio::EmgConfigFile file = bio::readEmgConfig(config);
  const bio::Recording data = bio::readRecording(recording, file.layout);
  return bio::excitationsFromEmg(data, bio::emgConfigFor(file, data));
}

/// Rows at which the arm is most extended: below 35°, and the least value within ±0.8 s.
std::vector<Index> turns(const bio::EmgResult& r) {
  std::vector<Index> rows;
  for (Index k = 0; k < r.time.size(); ++k) {
    if (!(r.measured_deg[k] < 35) || r.time[k] < 1) continue;
    bool least = true;
    for (Index i = 0; i < r.time.size() && least; ++i) {
      least = !(std::abs(r.time[i] - r.time[k]) <= 0.8 && r.measured_deg[i] < r.measured_deg[k]);
    }
    if (least) rows.push_back(k);
  }
  return rows;
}

/// One repetition as a trial; muscles without electrode at the baseline.
bio::Trial repetition(const bio::EmgResult& r, const bio::Model& model, Index from, Index to,
                      std::size_t number) {
  const Index rows = to - from + 1;
  bio::Trial trial;
  trial.file = fmt::format("repetition {}", number);
  trial.times = r.time.segment(from, rows);
  for (const bio::Muscle& muscle : model.muscles) trial.muscles.push_back(muscle.name);
  trial.excitations =
      Eigen::MatrixXd::Constant(rows, static_cast<Index>(trial.muscles.size()), 0.01);
  for (std::size_t j = 0; j < trial.muscles.size(); ++j) {
    for (std::size_t i = 0; i < r.muscles.size(); ++i) {
      if (r.muscles[i] == trial.muscles[j]) {
        trial.excitations.col(static_cast<Index>(j)) =
            r.excitations.col(static_cast<Index>(i)).segment(from, rows);
      }
    }
  }
  std::vector<double> times, values;
  for (Index k = from; k <= to; ++k) {
    if (std::isnan(r.measured_deg[k])) continue;
    times.push_back(r.time[k]);
    values.push_back(r.measured_deg[k] * degree);
  }
  const auto n = static_cast<Index>(times.size());
  trial.measured = {{bio::ofCoordinate("elbow_flexion"), Eigen::VectorXd::Map(times.data(), n),
                     Eigen::VectorXd::Map(values.data(), n)}};
  return trial;
}

struct Question {
  std::string title;
  std::vector<std::string> parameters;
  double load = 0;  ///< added to the hand's mass [kg]
  std::map<std::string, info::GaussianPrior> prior = {};
  std::map<std::string, std::pair<double, double>> bounds = {};
};

void answer(const Question& question, bio::Model model, const std::vector<bio::Trial>& training,
            const std::vector<bio::Trial>& heldOut) {
  for (bio::Body& body : model.bodies) {
    if (body.name == "hand") body.mass += question.load;
  }
  bio::CalibrationOptions options;
  options.trials.parameters = question.parameters;
  options.trials.threads = 2;
  options.prior = question.prior;
  options.bounds = question.bounds;
  options.starts = 6;
  const bio::SystemOptions system{{{"elbow_flexion"}, {}}, {}, {}};
  const bio::TrialSet odd(model, system, training, options.trials);
  const bio::TrialSet even(model, system, heldOut, options.trials);
  const bio::Calibration found = bio::calibrate(odd, &even, options);
  fmt::print("\n{}\n", question.title);
  if (!found.failure.empty()) {
    fmt::print("  no estimate: {}\n", found.failure);
    return;
  }
  const auto rms = [](const bio::TrialSet& set, const Eigen::MatrixXd& y) {
    return std::sqrt(set.meanSquare(y)) / degree;
  };
  fmt::print(
      "  estimated from: {:.2f} deg before, {:.2f} deg after; held out: {:.2f} before, "
      "{:.2f} after\n",
      rms(odd, found.before), rms(odd, found.after), rms(even, found.heldOutBefore),
      rms(even, found.heldOutAfter));
  fmt::print("  {}; {} of {} starts agree; {:.1f} samples count as one\n",
             info::describe(found.why), found.agreeingStarts, found.starts.size(),
             found.noise.correlationTime);
  for (const bio::CalibratedParameter& one : found.parameters) {
    if (one.identifiable) {
      fmt::print("  {} = {:.4g} ± {:.2g} {}\n", one.asked.name, one.value, one.sd, one.asked.unit);
    } else {
      fmt::print("  {} = {:.4g} {}, no interval: {}\n", one.asked.name, one.value, one.asked.unit,
                 one.why);
    }
  }
}

void run(const std::string& recording, const std::string& config, const std::string& file) {
  const bio::EmgResult r = excitations(recording, config);
  const bio::Model model = bio::readOsim(file);
  const std::vector<Index> ends = turns(r);
  std::vector<bio::Trial> training, heldOut;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    bio::Trial trial = repetition(r, model, ends[k], ends[k + 1], k + 1);
    (k % 2 == 0 ? training : heldOut).push_back(std::move(trial));
  }
  fmt::print("{} repetitions, {} to estimate from and {} held out\n", ends.size() - 1,
             training.size(), heldOut.size());

  const std::vector<std::string> gains = {"emg.BIClong.gain", "emg.BICshort.gain", "emg.BRA.gain",
                                          "emg.BRD.gain", "emg.TRIlong.gain"};
  const std::map<std::string, std::pair<double, double>> wide = {{"emg.gain", {0, 20}}};
  const std::vector<Question> questions = {
      {"empty hand: one gain", {"emg.gain"}},
      {"empty hand: gain and mass of the hand", {"emg.gain", "hand.mass"}},
      {"empty hand: gain, nonlinearity and delay", {"emg.gain", "emg.nonlinearity", "emg.delay"}},
      {"empty hand: one gain for each muscle", gains},
      {"empty hand: gain, triceps radius, triceps force",
       {"emg.gain", "TRI.radius", "TRIlong.max_isometric_force"}},
      {"4.54 kg in the hand: one gain", {"emg.gain"}, 4.54, {{"emg.gain", {3, 1.5}}}, wide},
      {"4.54 kg in the hand: gain, nonlinearity and delay",
       {"emg.gain", "emg.nonlinearity", "emg.delay"},
       4.54,
       {{"emg.gain", {3, 1.5}}},
       wide}};
  for (const Question& question : questions) answer(question, model, training, heldOut);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) {
    fmt::print(stderr, "usage: recorded_curls RECORDING CONFIG.toml MODEL.osim\n");
    return 2;
  }
  try {
    run(arguments[1], arguments[2], arguments[3]);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "recorded_curls: {}\n", error.what());
    return 2;
  }
}
