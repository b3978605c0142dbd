// Makes the trials of emg_data/, or checks that they are what this program makes.
//
//     make_emg_data MODEL.osim FOLDER            writes NAME.sto and NAME_raw.csv of every trial
//     make_emg_data MODEL.osim FOLDER --check    compares; exit status 1 if a value differs

#include <fmt/format.h>

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

// time | one column per muscle
bio::Table excitationTable(const validation::TrialPlan& plan) {
  bio::Table table;
  table.name = plan.name + " (synthetic)";
  table.columns = {"time"};
  table.values.resize(rowsAt(excitationRate), 9);
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    table.values(i, 0) = static_cast<double>(i) / excitationRate;
  }
  for (const validation::MuscleShare& muscle : validation::muscleShares()) {
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

bio::Table rawTable(const validation::TrialPlan& plan) {
  bio::Table table;
  table.columns = {"time"};
  const Eigen::Index rows = rowsAt(rawRate);
  table.values.resize(rows, 9);
  for (Eigen::Index i = 0; i < rows; ++i) table.values(i, 0) = static_cast<double>(i) / rawRate;
  for (std::size_t k = 0; k < validation::muscleShares().size(); ++k) {
    table.columns.push_back(validation::muscleShares()[k].name + "_uV");
    table.values.col(static_cast<Eigen::Index>(k) + 1) =
        validation::electrodeSignal(plan, k, rawRate, rows, lead).array().round();
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

int run(const std::string& modelFile, const std::filesystem::path& folder, bool check) {
  const bio::Model model = bio::readOsim(modelFile);
  int count = 0;
  for (const validation::TrialPlan& plan : validation::trialPlans()) {
    bio::Table trial = excitationTable(plan);
    bio::Table raw = rawTable(plan);
    const Eigen::VectorXd subject =
        motionOf(validation::subjectOf(model), trial, plan.startAngle_deg);
    const Eigen::VectorXd nominal = motionOf(model, trial, plan.startAngle_deg);
    fmt::print("{}: subject {:.1f} to {:.1f}°, model {:.1f} to {:.1f}°, RMS difference {:.1f}°\n",
               plan.name, subject.minCoeff(), subject.maxCoeff(), nominal.minCoeff(),
               nominal.maxCoeff(),
               (subject - nominal).norm() / std::sqrt(static_cast<double>(subject.size())));
    const Eigen::VectorXd angle = measured(subject, plan.seed);
    addAngle(trial, angle, excitationRate);
    addAngle(raw, angle, rawRate);
    const auto trialFile = folder / (plan.name + ".sto");
    const auto rawFile = folder / (plan.name + "_raw.csv");
    if (check) {
      count += differences(trial, trialFile) + differences(raw, rawFile);
    } else {
      bio::writeTable(trial, trialFile);
      bio::writeTable(raw, rawFile);
    }
  }
  return count == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const bool check = argc == 4 && std::string(argv[3]) == "--check";
  if (argc != 3 && !check) {
    fmt::print(stderr, "make_emg_data MODEL.osim FOLDER [--check]\n");
    return 2;
  }
  try {
    return run(argv[1], argv[2], check);
  } catch (const std::exception& e) {
    fmt::print(stderr, "make_emg_data: {}\n", e.what());
    return 2;
  }
}
