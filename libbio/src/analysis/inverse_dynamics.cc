#include "bio/analysis/inverse_dynamics.h"

#include <fmt/format.h>

#include <utility>

namespace bio {

Trajectory inverseDynamics(MusculoskeletalSystem system, const ExcitationSignal& excitation,
                           const std::vector<double>& times, const Eigen::MatrixXd& q,
                           SimulationOptions options) {
  return inverseDynamicsOf(std::move(system).withAllPrescribed(), excitation, times, q,
                           std::move(options));
}

Trajectory inverseDynamicsOf(const MusculoskeletalSystem& driven,
                             const ExcitationSignal& excitation, const std::vector<double>& times,
                             const Eigen::MatrixXd& q, SimulationOptions options) {
  const int n = driven.skeleton().numCoordinates();
  if (times.size() < 2 || q.rows() != n || q.cols() != static_cast<Eigen::Index>(times.size())) {
    throw std::invalid_argument(
        fmt::format("inverse dynamics: {} × {} coordinates at {} times, must be {} × the number of "
                    "times, at least 2",
                    q.rows(), q.cols(), times.size(), n));
  }
  options.prescribed = {};
  for (int k = 0; k < n; ++k) options.prescribed.add(k, times, {q.row(k).begin(), q.row(k).end()});
  options.startTime = times.front();
  options.duration = times.back() - times.front();
  return simulate(driven, excitation, initialState(driven, q.col(0), excitation, options.startTime),
                  options);
}

}  // namespace bio
