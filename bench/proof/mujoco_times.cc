/// Error and time of MuJoCo's integrators and steps, for the table of proof.
///
///     mujoco_times MODEL.xml EXCITATIONS.sto SECONDS JOINT=START
///
/// Muscles are driven by the columns of their actuators' names, linear between rows, read off in the middle of each
/// step. The reference is RK4 at 1e-5 s, errors are RMS over every 0.01 s [deg], times the median of nine runs [ms].
/// Build: g++ -O3 -march=native mujoco_times.cc -lmujoco (Debian package libmujoco-dev).
#include <mujoco/mujoco.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

struct Excitations {
  std::vector<double> times;
  std::vector<std::vector<double>> values;  ///< of each actuator, at these times

  /// Sets the controls at a time not before those of earlier calls.
  void apply(double time, std::size_t& row, mjtNum* control) const {
    while (row + 2 < times.size() && times[row + 1] <= time) ++row;
    const double share = std::clamp((time - times[row]) / (times[row + 1] - times[row]), 0.0, 1.0);
    for (std::size_t m = 0; m < values.size(); ++m)
      control[m] = values[m][row] + share * (values[m][row + 1] - values[m][row]);
  }
};

Excitations readExcitations(const std::string& path, const mjModel* model) {
  std::ifstream file(path);
  std::string line, word;
  while (std::getline(file, line) && line.rfind("time", 0) != 0) {}
  std::istringstream heads(line);
  std::vector<int> actuators;
  heads >> word;
  while (heads >> word) actuators.push_back(mj_name2id(model, mjOBJ_ACTUATOR, word.c_str()));
  Excitations read;
  read.values.resize(model->nu);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    double x = 0;
    if (!(cells >> x)) continue;
    read.times.push_back(x);
    for (const int actuator : actuators) {
      cells >> x;
      if (actuator >= 0) read.values[actuator].push_back(x);
    }
  }
  for (const auto& column : read.values) {
    if (read.times.size() < 2 || column.size() != read.times.size())
      throw std::invalid_argument(path + ": not a column for every actuator");
  }
  return read;
}

struct Run {
  std::vector<double> angles;  ///< at every 0.01 s [rad]
  double milliseconds = 0;
};

Run simulate(mjModel* model, mjData* data, const Excitations& excitations, int joint, double start, double seconds,
             int integrator, double step) {
  model->opt.integrator = integrator;
  model->opt.timestep = step;
  mj_resetData(model, data);
  const int at = model->jnt_qposadr[joint];
  data->qpos[at] = start;
  std::size_t row = 0;
  excitations.apply(0, row, data->ctrl);
  for (int m = 0; m < model->na; ++m) data->act[m] = data->ctrl[m];
  const int steps = static_cast<int>(std::lround(seconds / step)), every = static_cast<int>(std::lround(0.01 / step));
  Run run;
  run.angles.reserve(steps / every + 1);
  const auto begin = std::chrono::steady_clock::now();
  for (int k = 0; k <= steps; ++k) {
    if (k % every == 0) run.angles.push_back(data->qpos[at]);
    excitations.apply((k + 0.5) * step, row, data->ctrl);
    mj_step(model, data);
  }
  run.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return run;
}

double rmsDegrees(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size())) * 180 / M_PI;
}

int measure(const std::string& file, const std::string& sto, double seconds, const std::string& setting) {
  char why[1000] = "";
  mjModel* model = mj_loadXML(file.c_str(), nullptr, why, sizeof why);
  if (model == nullptr) throw std::invalid_argument(why);
  mjData* data = mj_makeData(model);
  const Excitations excitations = readExcitations(sto, model);
  const std::size_t equals = setting.find('=');
  const int joint = mj_name2id(model, mjOBJ_JOINT, setting.substr(0, equals).c_str());
  if (joint < 0) throw std::invalid_argument("no joint " + setting);
  const double start = std::stod(setting.substr(equals + 1));
  const double given = model->opt.timestep;
  const auto run = [&](int integrator, double step) {
    return simulate(model, data, excitations, joint, start, seconds, integrator, step);
  };
  const Run reference = run(mjINT_RK4, 1e-5);
  const std::pair<const char*, int> integrators[] = {
      {"Euler", mjINT_EULER}, {"implicit", mjINT_IMPLICIT}, {"RK4", mjINT_RK4}};
  std::printf("# MuJoCo %s, its own step %g s, last angle %.6g rad\nintegrator,step_s,rms_deg,wall_ms\n", mj_versionString(),
              given, reference.angles.back());
  for (const auto& [name, integrator] : integrators) {
    for (const double step : {0.01, 0.005, 0.002, 0.001, 0.0005, 0.0002, 0.0001, 0.00005, 0.00002}) {
      std::vector<double> times;
      Run last;
      for (int k = 0; k < 9; ++k) {
        last = run(integrator, step);
        times.push_back(last.milliseconds);
      }
      std::nth_element(times.begin(), times.begin() + 4, times.end());
      std::printf("%s,%g,%.6g,%.6g\n", name, step, rmsDegrees(last.angles, reference.angles), times[4]);
    }
  }
  mj_deleteData(data);
  mj_deleteModel(model);
  return 0;
}

}  // namespace

int main(int count, char** words) try {
  if (count != 5) throw std::invalid_argument("usage: mujoco_times MODEL.xml EXCITATIONS.sto SECONDS JOINT=START");
  return measure(words[1], words[2], std::stod(words[3]), words[4]);
} catch (const std::exception& error) {
  std::fprintf(stderr, "mujoco_times: %s\n", error.what());
  return 2;
}
