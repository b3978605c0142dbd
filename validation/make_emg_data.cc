// Makes the trials of emg_data/, or checks that they are what this program makes.
//
//     make_emg_data MODEL.osim FOLDER            writes NAME.sto and NAME_raw.csv of every trial
//     make_emg_data MODEL.osim FOLDER --damped   writes damped_NAME.sto instead: the model itself
//                                                with a damping of the elbow
//     … --raw NAME                               no other raw signals than of this trial
//     … --check                                  compares; exit status 1 if a value differs

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "bio/muscle/activation/excitation.h"
#include "bio/opensim/osim_file.h"
#include "bio/simulation/musculoskeletal_system.h"
#include "bio/simulation/simulate.h"
#include "bio/tables/table_file.h"
#include "emg_subject.h"
#include "synthetic_emg.h"

namespace {

constexpr double duration = 4.5;         // [s]
constexpr double rawRate = 2000;         // [Hz]
constexpr double excitationRate = 200;   // [Hz]
constexpr double goniometerRate = 100;   // [Hz]
constexpr double lead = 0.04;            // EMG before excitation [s]
constexpr double goniometerNoise = 0.5;  // [deg]
constexpr double hiddenViscosity = 0.3;  // [N m s/rad]
constexpr double notMeasured = std::numeric_limits<double>::quiet_NaN();
constexpr double degree = std::numbers::pi / 180;

// Rounded to so many decimals, so that few digits are printed.
double rounded(double value, int decimals) {
  const double scale = std::pow(10, decimals);
  return std::round(value * scale) / scale;
}

Eigen::Index rowsAt(double rate) {
  return static_cast<Eigen::Index>(std::lround(duration * rate)) + 1;
}

// Of the muscles with electrodes those that the model has, by their place in muscleShares().
std::vector<std::size_t> recordedMuscles(const bio::Model& model) {
  std::vector<std::size_t> recorded;
  for (std::size_t k = 0; k < validation::muscleShares().size(); ++k) {
    const auto hasName = [&](const bio::Muscle& muscle) {
      return muscle.name == validation::muscleShares()[k].name;
    };
    if (std::ranges::any_of(model.muscles, hasName)) recorded.push_back(k);
  }
  return recorded;
}

bio::Table emptyTable(double rate, const std::vector<std::size_t>& recorded) {
  bio::Table table;
  table.columns = {"time"};
  table.values.resize(rowsAt(rate), static_cast<Eigen::Index>(recorded.size()) + 1);
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    table.values(i, 0) = static_cast<double>(i) / rate;
  }
  return table;
}

// time | one column per muscle
bio::Table excitationTable(const validation::TrialPlan& plan,
                           const std::vector<std::size_t>& recorded) {
  bio::Table table = emptyTable(excitationRate, recorded);
  table.name = plan.name + " (synthetic)";
  for (const std::size_t k : recorded) {
    const validation::MuscleShare& muscle = validation::muscleShares()[k];
    const auto column = static_cast<Eigen::Index>(table.columns.size());
    for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
      table.values(i, column) = rounded(excitation(plan, muscle, table.values(i, 0)), 5);
    }
    table.columns.push_back(muscle.name);
  }
  return table;
}

bio::MusculoskeletalSystem elbowOf(const bio::Model& model) {
  bio::SystemOptions options;
  options.skeleton.freeCoordinates = {"elbow_flexion"};
  return bio::MusculoskeletalSystem(model, options);
}

bio::ExcitationSignal signalFor(const bio::MusculoskeletalSystem& system, const bio::Table& table) {
  Eigen::MatrixXd values(table.values.rows(), static_cast<Eigen::Index>(system.numMuscles()));
  for (std::size_t i = 0; i < system.numMuscles(); ++i) {
    values.col(static_cast<Eigen::Index>(i)) =
        table.values.col(bio::columnIndex(table, system.muscles()[i].name));
  }
  const Eigen::VectorXd times = table.values.col(0);
  return {{times.begin(), times.end()}, values};
}

// Elbow flexion [deg] at goniometerRate, without noise.
Eigen::VectorXd motionOf(const bio::Model& model, const bio::Table& excitations, double start_deg) {
  const bio::MusculoskeletalSystem system = elbowOf(model);
  const bio::ExcitationSignal signal = signalFor(system, excitations);
  bio::SimulationOptions options;
  options.integrator = bio::Integrator::cvode;
  options.duration = duration;
  options.step = 1 / goniometerRate;
  const bio::SystemState start =
      bio::initialState(system, Eigen::VectorXd::Constant(1, start_deg * degree), signal, 0);
  const bio::Trajectory motion = bio::simulate(system, signal, start, options);
  if (motion.outcome != bio::Outcome::completed) throw std::runtime_error(motion.why);
  return motion.q.row(0).transpose() / degree;
}

Eigen::VectorXd measured(const Eigen::VectorXd& angle_deg, std::uint64_t seed) {
  validation::NormalNumbers noise(seed);
  return angle_deg.unaryExpr(
      [&](double angle) { return rounded(angle + goniometerNoise * noise.next(), 2); });
}

// Adds the measured angle to every k-th row.
void addAngle(bio::Table& table, const Eigen::VectorXd& angle_deg, double rate) {
  table.columns.push_back("elbow_flexion_deg");
  table.values.conservativeResize(Eigen::NoChange, table.values.cols() + 1);
  table.values.col(table.values.cols() - 1).setConstant(notMeasured);
  const auto every = static_cast<Eigen::Index>(std::lround(rate / goniometerRate));
  for (Eigen::Index i = 0; i < angle_deg.size(); ++i) {
    table.values(every * i, table.values.cols() - 1) = angle_deg[i];
  }
}

bio::Table rawTable(const validation::TrialPlan& plan, const std::vector<std::size_t>& recorded) {
  bio::Table table = emptyTable(rawRate, recorded);
  for (const std::size_t k : recorded) {
    table.values.col(static_cast<Eigen::Index>(table.columns.size())) =
        validation::electrodeSignal(plan, k, rawRate, table.values.rows(), lead).array().round();
    table.columns.push_back(validation::muscleShares()[k].name + "_uV");
  }
  return table;
}

// Number of cells that differ by more than the last digit written.
int differences(const bio::Table& made, const std::filesystem::path& file) {
  const bio::Table shipped = bio::readTable(file);
  if (shipped.columns != made.columns || shipped.values.rows() != made.values.rows()) {
    fmt::print("{}: other columns or rows than this program makes\n", file.string());
    return 1;
  }
  int count = 0;
  for (Eigen::Index k = 0; k < made.values.cols(); ++k) {
    const std::string& column = made.columns[static_cast<std::size_t>(k)];
    const double unit = column == "time"           ? 1e-9
                        : column.ends_with("_uV")  ? 1
                        : column.ends_with("_deg") ? 0.01
                                                   : 1e-5;
    for (Eigen::Index i = 0; i < made.values.rows(); ++i) {
      const double a = made.values(i, k);
      const double b = shipped.values(i, k);
      if (std::isnan(a) && std::isnan(b)) continue;
      if (std::abs(a - b) <= 1.01 * unit) continue;
      if (count++ == 0) {
        fmt::print("{}: {} = {} in row {}, this program makes {}\n", file.string(), column, b, i,
                   a);
      }
    }
  }
  return count;
}

struct Job {
  bio::Model model;
  std::filesystem::path folder;
  bool check = false;   // compare instead of writing
  bool damped = false;  // the trials of a damped arm instead of the subject's
  std::string raw;      // the only trial whose raw signals are made; empty: all
};

// Number of cells that differ, 0 where nothing is compared.
int writtenOrCompared(const bio::Table& table, const std::string& name, const Job& job) {
  const std::filesystem::path file = job.folder / name;
  if (job.check) return differences(table, file);
  bio::writeTable(table, file);
  return 0;
}

int run(const Job& job) {
  const std::vector<std::size_t> recorded = recordedMuscles(job.model);
  const bio::Model person = job.damped ? validation::dampedArmOf(job.model, hiddenViscosity)
                                       : validation::subjectOf(job.model);
  int count = 0;
  for (const validation::TrialPlan& plan : validation::trialPlans()) {
    bio::Table trial = excitationTable(plan, recorded);
    const Eigen::VectorXd subject = motionOf(person, trial, plan.startAngle_deg);
    const Eigen::VectorXd nominal = motionOf(job.model, trial, plan.startAngle_deg);
    fmt::print("{}: subject {:.1f} to {:.1f}°, model {:.1f} to {:.1f}°, RMS difference {:.1f}°\n",
               plan.name, subject.minCoeff(), subject.maxCoeff(), nominal.minCoeff(),
               nominal.maxCoeff(),
               (subject - nominal).norm() / std::sqrt(static_cast<double>(subject.size())));
    const Eigen::VectorXd angle = measured(subject, plan.seed);
    addAngle(trial, angle, excitationRate);
    if (job.damped) {
      count += writtenOrCompared(trial, "damped_" + plan.name + ".sto", job);
      continue;
    }
    count += writtenOrCompared(trial, plan.name + ".sto", job);
    if (!job.raw.empty() && job.raw != plan.name) continue;
    bio::Table raw = rawTable(plan, recorded);
    addAngle(raw, angle, rawRate);
    count += writtenOrCompared(raw, plan.name + "_raw.csv", job);
  }
  return count == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> given(argv + 1, argv + argc);
  std::string raw;
  if (const auto option = std::ranges::find(given, "--raw");
      option != given.end() && option + 1 != given.end()) {
    raw = option[1];
    given.erase(option, option + 2);
  }
  const auto isKnown = [](const std::string& option) {
    return option == "--check" || option == "--damped";
  };
  if (given.size() < 2 || !std::all_of(given.begin() + 2, given.end(), isKnown)) {
    fmt::print(stderr, "make_emg_data MODEL.osim FOLDER [--damped] [--raw NAME] [--check]\n");
    return 2;
  }
  const auto isNamed = [&](const validation::TrialPlan& plan) { return plan.name == raw; };
  if (!raw.empty() && std::ranges::none_of(validation::trialPlans(), isNamed)) {
    fmt::print(stderr, "make_emg_data: --raw {}: no trial has this name\n", raw);
    return 2;
  }
  try {
    return run({bio::readOsim(given[0]), given[1], std::ranges::count(given, "--check") > 0,
                std::ranges::count(given, "--damped") > 0, raw});
  } catch (const std::exception& e) {
    fmt::print(stderr, "make_emg_data: {}\n", e.what());
    return 2;
  }
}
