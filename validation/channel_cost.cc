// What measured channels cost: processor time of an iteration of a calibration (one simulation with
// sensitivities) from one coordinate, and from two coordinates and a marker, of the same model.
//
//     channel_cost MODEL.osim [ROUNDS]
//
// The model must have two coordinates and a marker (arm26). Prints medians, and the median of the
// ratios of neighbouring measurements; exit status 1 if it is above 1.3.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "bio/analysis/replay.h"
#include "bio/observation/trial_predictor.h"
#include "bio/opensim/osim_file.h"

namespace {

using bio::Observable;
using Kind = Observable::Kind;

constexpr double bound = 1.3;

double processorTime() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double medianOf(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ssize(values) / 2, values.end());
  return values[values.size() / 2];
}

/// Excitations that move both joints.
bio::ExcitationSignal excitation(std::size_t muscles) {
  std::vector<double> times;
  Eigen::MatrixXd u(101, static_cast<Eigen::Index>(muscles));
  for (Eigen::Index k = 0; k < u.rows(); ++k) {
    times.push_back(0.01 * static_cast<double>(k));
    for (Eigen::Index m = 0; m < u.cols(); ++m) {
      u(k, m) = 0.1 + 0.06 * std::sin(4 * times.back() + static_cast<double>(m));
    }
  }
  return {times, u};
}

struct Iteration {
  bio::TrialPredictor predictor;
  Eigen::VectorXd theta;
  double seconds() const {
    const double begin = processorTime();
    constexpr int repeats = 20;
    for (int i = 0; i < repeats; ++i) (void)predictor.withSensitivities(theta);
    return (processorTime() - begin) / repeats;
  }
};

/// Median with one coordinate free, and measured.
double secondsAlone(const bio::Model& model, const std::string& coordinate,
                    const std::vector<std::string>& names, const Eigen::VectorXd& times,
                    int rounds) {
  const bio::SystemOptions options{{{coordinate}, {}}, {}, {}};
  const bio::MusculoskeletalSystem system(model, options);
  const bio::ParameterCatalogue catalogue(model, system, {system.skeleton().defaultValues(), {}});
  bio::SimulationOptions simulation;
  simulation.duration = 1;
  std::vector<std::size_t> selection;  // those of muscles that cross this joint
  for (const std::string& name : names) {
    if (catalogue.has(name)) selection.push_back(catalogue.find(name));
  }
  std::vector<bio::ObservedSeries> measured(1);
  measured[0].what.kind = Kind::coordinate;
  measured[0].what.object = coordinate;
  measured[0].times = times;
  const Iteration one{
      {catalogue, options, excitation(system.numMuscles()), measured, selection, simulation},
      catalogue.values(selection)};
  std::vector<double> seconds;
  for (int i = 0; i < rounds; ++i) seconds.push_back(one.seconds());
  return medianOf(seconds);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) {
    fmt::print(stderr, "usage: channel_cost MODEL.osim [ROUNDS]\n");
    return 2;
  }
  const int rounds = count > 2 ? std::max(1, std::atoi(arguments[2])) : 25;
  const bio::Model model = bio::readOsim(arguments[1]);
  const std::vector<std::string> free = {"r_shoulder_elev", "r_elbow_flex"};
  const bio::SystemOptions options{{free, {}}, {}, {}};
  const bio::MusculoskeletalSystem system(model, options);
  const bio::ParameterCatalogue catalogue(model, system, {system.skeleton().defaultValues(), {}});
  const auto selection = catalogue.select({"BRA.max_isometric_force", "TRIlong.max_isometric_force",
                                           "BIClong.optimal_fiber_length",
                                           "BRA.tendon_slack_length", "r_ulna_radius_hand.mass"});
  const std::string marker = model.markers.back().body + "." + model.markers.back().name;
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(101, 0, 1);
  const auto iteration = [&](const std::vector<Observable>& channels) {
    std::vector<bio::ObservedSeries> series;
    for (const Observable& what : channels) series.push_back({what, times});
    bio::SimulationOptions simulation;
    simulation.duration = 1;
    return Iteration{
        {catalogue, options, excitation(system.numMuscles()), series, selection, simulation},
        catalogue.values(selection)};
  };
  const Iteration one = iteration({{Kind::coordinate, free[1], 0}});
  const Iteration all = iteration({{Kind::coordinate, free[0], 0},
                                   {Kind::coordinate, free[1], 0},
                                   {Kind::marker, marker, 0},
                                   {Kind::marker, marker, 1},
                                   {Kind::marker, marker, 2}});
  one.seconds();
  all.seconds();
  std::vector<double> ofOne, ofAll, ratios;
  for (int i = 0; i < rounds; ++i) {
    // in turns, so that a machine that slows down slows both
    const double before = one.seconds(), between = all.seconds(), after = one.seconds();
    ofOne.push_back((before + after) / 2);
    ofAll.push_back(between);
    ratios.push_back(2 * between / (before + after));
  }
  fmt::print("{} rounds, {} parameters, 101 samples of each channel\n", rounds, selection.size());
  fmt::print("one coordinate: {:.3f} ms per iteration\n", 1e3 * medianOf(ofOne));
  fmt::print("two coordinates and a marker (x, y, z): {:.3f} ms\n", 1e3 * medianOf(ofAll));
  fmt::print("ratio: {:.3f} (least {:.3f}, largest {:.3f})\n", medianOf(ratios),
             *std::min_element(ratios.begin(), ratios.end()),
             *std::max_element(ratios.begin(), ratios.end()));
  std::vector<std::string> names;
  for (const std::size_t i : selection) names.push_back(catalogue.parameters()[i].name);
  for (const std::string& name : free) {
    const double alone = secondsAlone(model, name, names, times, rounds);
    fmt::print("only {} free: {:.3f} ms\n", name, 1e3 * alone);
  }
  return medianOf(ratios) <= bound ? 0 : 1;
}
