#include "bio/observation/channel_information.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "bio/model/units.h"

namespace bio {
namespace {

using Kind = Observable::Kind;

double usualSd(Kind kind, bool turns) {
  switch (kind) {
    case Kind::coordinate:
      return turns ? 0.5 * radiansPerDegree : 1e-3;
    case Kind::speed:
      return turns ? 5 * radiansPerDegree : 1e-2;
    case Kind::moment:
      return turns ? 0.5 : 2;
    case Kind::fibreLength:
      return 1e-3;
    case Kind::pennation:
      return 1 * radiansPerDegree;
    case Kind::tendonForce:
      return 10;
    case Kind::activation:
      return 0.05;
    case Kind::marker:
      break;
  }
  return 2e-3;
}

}  // namespace

std::vector<ChannelCandidate> usualChannels(const MusculoskeletalSystem& system) {
  std::vector<ChannelCandidate> channels;
  const auto add = [&](Kind kind, const std::string& object, bool turns, int axis = 0) {
    channels.push_back({{kind, object, axis}, usualSd(kind, turns)});
  };
  const auto& coordinates = system.skeleton().coordinates();
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    const Coordinate& c = coordinates[k];
    if (system.isPrescribed(static_cast<int>(k))) {
      add(Kind::moment, c.name, c.isRotation);
    } else {
      add(Kind::coordinate, c.name, c.isRotation);
      add(Kind::speed, c.name, c.isRotation);
    }
  }
  for (const SystemMuscle& muscle : system.muscles()) {
    for (const Kind kind :
         {Kind::fibreLength, Kind::pennation, Kind::tendonForce, Kind::activation}) {
      add(kind, muscle.name, false);
    }
  }
  for (const SystemMarker& marker : system.markers()) {
    if (marker.segment == 0) continue;  // on the ground
    for (int axis = 0; axis < 3; ++axis) add(Kind::marker, marker.name, false, axis);
  }
  return channels;
}

std::vector<Eigen::MatrixXd> informationOf(const MusculoskeletalSystem& system,
                                           const std::vector<ChannelCandidate>& candidates,
                                           const std::vector<double>& times,
                                           const SensitivityTrajectory& motion) {
  const auto n = static_cast<Eigen::Index>(times.size());
  std::vector<ObservedSeries> series;
  for (const ChannelCandidate& candidate : candidates) {
    if (!(candidate.sd > 0)) {
      throw std::invalid_argument(
          fmt::format("noise of '{}' = {}, must be > 0", nameOf(candidate.what), candidate.sd));
    }
    series.push_back({candidate.what, Eigen::VectorXd::Map(times.data(), n)});
  }
  const Eigen::MatrixXd gamma = ObservedMotion(system, std::move(series)).linearised(motion).gamma;
  std::vector<Eigen::MatrixXd> information;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const auto rows = gamma.middleRows(static_cast<Eigen::Index>(c) * n, n);
    information.push_back(rows.transpose() * rows / (candidates[c].sd * candidates[c].sd));
  }
  return information;
}

std::vector<ChannelGain> channelGains(const ParameterInformation& before,
                                      const std::vector<ChannelCandidate>& candidates,
                                      const std::vector<Eigen::MatrixXd>& information) {
  const auto p = static_cast<Eigen::Index>(before.parameters.size());
  bool fits = candidates.size() == information.size() && before.fisher.rows() == p;
  for (const Eigen::MatrixXd& one : information) fits = fits && one.rows() == p && one.cols() == p;
  if (!fits) {
    throw std::invalid_argument(
        "channel gains: must have the information of each candidate about all parameters");
  }
  Eigen::VectorXd sd(p);
  for (Eigen::Index i = 0; i < p; ++i) {
    sd[i] = before.parameters[static_cast<std::size_t>(i)].prior->sd;
  }
  // in units of prior deviations: I + Λ becomes S I S + 1
  const auto scaled = [&](const Eigen::MatrixXd& one) -> Eigen::LLT<Eigen::MatrixXd> {
    Eigen::MatrixXd A = sd.asDiagonal() * one * sd.asDiagonal();
    A.diagonal().array() += 1;
    return A.llt();
  };
  const auto logDeterminant = [](const Eigen::LLT<Eigen::MatrixXd>& A) {
    return 2 * A.matrixLLT().diagonal().array().log().sum();
  };
  const auto bounds = [&](const Eigen::LLT<Eigen::MatrixXd>& A) -> Eigen::ArrayXd {
    return A.solve(Eigen::MatrixXd::Identity(p, p)).diagonal().array().sqrt();
  };
  const Eigen::LLT<Eigen::MatrixXd> now = scaled(before.fisher);
  const Eigen::ArrayXd boundsNow = bounds(now);
  std::vector<ChannelGain> gains;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const Eigen::LLT<Eigen::MatrixXd> then = scaled(before.fisher + information[c]);
    const Eigen::ArrayXd boundsThen = bounds(then);
    Eigen::Index best = 0;
    (boundsThen / boundsNow).minCoeff(&best);
    gains.push_back({candidates[c], (logDeterminant(then) - logDeterminant(now)) / 2,
                     before.parameters[static_cast<std::size_t>(best)].name,
                     boundsNow[best] * sd[best], boundsThen[best] * sd[best]});
  }
  std::stable_sort(gains.begin(), gains.end(), [](const ChannelGain& a, const ChannelGain& b) {
    return a.information > b.information;
  });
  return gains;
}

}  // namespace bio
