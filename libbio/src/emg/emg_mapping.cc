#include "bio/emg/emg_mapping.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace bio {
namespace {

struct Shaped {
  double value;    ///< S(x)
  double inShape;  ///< ∂S/∂A
};

/// Near A = 0 by its series, S = x + x(x−1)[A/2 + A²(2x−1)/12 + A³x(x−1)/24 + …].
Shaped shaped(double x, double A) {
  if (std::abs(A) < 1e-2) {
    const double b = x * (x - 1);
    const double c3 = b / 24;
    const double c4 = (2 * x - 1) * (3 * x * x - 3 * x - 1) / 720;
    return {x + b * (A / 2 + A * A * (2 * x - 1) / 12 + A * A * A * c3 + A * A * A * A * c4),
            b * (0.5 + A * (2 * x - 1) / 6 + 3 * A * A * c3 + 4 * A * A * A * c4)};
  }
  const double below = std::expm1(A);
  const double above = std::expm1(A * x);
  const double value = above / below;
  return {value, (x * (above + 1) - value * (below + 1)) / below};
}

double gainOf(const EmgMapping& mapping, const std::string& muscle) {
  const auto at = mapping.gain.find(muscle);
  return at == mapping.gain.end() ? 1.0 : at->second;
}

Eigen::VectorXd timesOf(const ExcitationSignal& trial) {
  return Eigen::VectorXd::Map(trial.times().data(),
                              static_cast<Eigen::Index>(trial.times().size()));
}

/// The trial's rows; rows = muscles.
Eigen::MatrixXd rowsOf(const ExcitationSignal& trial) {
  Eigen::MatrixXd rows(trial.numMuscles(), static_cast<Eigen::Index>(trial.times().size()));
  std::size_t hint = 0;
  for (Eigen::Index k = 0; k < rows.cols(); ++k) {
    trial.at(trial.times()[static_cast<std::size_t>(k)], hint, rows.col(k));
  }
  return rows;
}

Eigen::Index indexOf(const std::vector<std::string>& muscles, const std::string& name) {
  return std::find(muscles.begin(), muscles.end(), name) - muscles.begin();
}

/// x: the trial's rows, where there is a latent excitation with that.
Eigen::MatrixXd recordedOf(const ExcitationSignal& trial, const std::vector<std::string>& muscles,
                           const EmgMapping& mapping) {
  Eigen::MatrixXd rows = rowsOf(trial);
  for (const auto& [muscle, latent] : mapping.latent) {
    const Eigen::Index i = indexOf(muscles, muscle);
    rows.row(i) = withLatent(timesOf(trial), rows.row(i), latent);
  }
  return rows;
}

/// The rows without offset and crosstalk; not below 0, but for rows that have neither.
Eigen::MatrixXd cleaned(const Eigen::MatrixXd& rows, const std::vector<std::string>& muscles,
                        const EmgMapping& mapping) {
  if (mapping.offset.empty() && mapping.crosstalk.empty()) return rows;
  Eigen::MatrixXd clean = rows;
  for (const auto& [muscle, offset] : mapping.offset) {
    clean.row(indexOf(muscles, muscle)).array() -= offset;
  }
  for (const EmgMapping::Crosstalk& c : mapping.crosstalk) {
    clean.row(indexOf(muscles, c.to)) -= c.share * rows.row(indexOf(muscles, c.from));
  }
  return clean.cwiseMax(0.0);
}

/// z, from that: with what saturated records lack.
void addLacking(const Eigen::VectorXd& times, const Eigen::MatrixXd& recorded,
                const std::vector<std::string>& muscles, const EmgMapping& mapping,
                Eigen::MatrixXd& clean) {
  for (const auto& [muscle, size] : mapping.saturation) {
    if (size == 0) continue;
    const Eigen::Index i = indexOf(muscles, muscle);
    clean.row(i) += size * flatTops(times, recorded.row(i));
  }
}

/// ∂S/∂x
double slopeOfShape(double x, double A) {
  return A == 0 ? 1.0 : A * std::exp(A * x) / std::expm1(A);
}

/// ∫ dt from the first row, of straight lines between rows.
Eigen::RowVectorXd integral(const Eigen::VectorXd& times, const Eigen::RowVectorXd& rows) {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(rows.size());
  for (Eigen::Index k = 1; k < rows.size(); ++k) {
    sum[k] = sum[k - 1] + (times[k] - times[k - 1]) * (rows[k] + rows[k - 1]) / 2;
  }
  return sum;
}

/// e^{−I/T}
Eigen::ArrayXd freshness(const EmgMapping& mapping, const Eigen::RowVectorXd& work) {
  return (-work.transpose().array() / mapping.fatigueTime).exp();
}

}  // namespace

void requireValid(const std::vector<std::string>& muscles, const EmgMapping& mapping) {
  for (const auto& [muscle, gain] : mapping.gain) {
    if (std::find(muscles.begin(), muscles.end(), muscle) == muscles.end()) {
      throw std::invalid_argument(fmt::format("EMG gain of '{}': no such muscle moves", muscle));
    }
    if (!(gain >= 0 && std::isfinite(gain))) {
      throw std::invalid_argument(
          fmt::format("EMG gain of '{}' = {}, must be ≥ 0 and finite", muscle, gain));
    }
  }
  const auto known = [&](const std::string& muscle) {
    return std::find(muscles.begin(), muscles.end(), muscle) != muscles.end();
  };
  for (const auto& [muscle, offset] : mapping.offset) {
    if (!known(muscle) || !std::isfinite(offset)) {
      throw std::invalid_argument(fmt::format(
          "EMG offset of '{}' = {}: must be finite, of a muscle that moves", muscle, offset));
    }
  }
  for (const auto& [muscle, size] : mapping.saturation) {
    if (!known(muscle) || !std::isfinite(size)) {
      throw std::invalid_argument(fmt::format(
          "EMG saturation of '{}' = {}: must be finite, of a muscle that moves", muscle, size));
    }
  }
  for (const auto& [muscle, latent] : mapping.latent) {
    if (!known(muscle) || mapping.saturation.count(muscle) > 0) {
      throw std::invalid_argument(
          fmt::format("latent excitation of '{}': must be of a muscle that moves, and of one whose "
                      "record does not saturate",
                      muscle));
    }
  }
  for (const EmgMapping::Crosstalk& c : mapping.crosstalk) {
    if (!known(c.from) || !known(c.to) || !std::isfinite(c.share)) {
      throw std::invalid_argument(
          fmt::format("EMG crosstalk {} from '{}' to '{}': must be finite, between muscles "
                      "that move",
                      c.share, c.from, c.to));
    }
  }
  if (!std::isfinite(mapping.delay)) {
    throw std::invalid_argument(fmt::format("EMG delay = {} s, must be finite", mapping.delay));
  }
  if (!(std::abs(mapping.fatigue) <= 1) ||
      !(mapping.fatigueTime > 0 && std::isfinite(mapping.fatigueTime))) {
    throw std::invalid_argument(
        fmt::format("EMG fatigue φ = {}, must be −1 to 1, with T = {} s, must be > 0",
                    mapping.fatigue, mapping.fatigueTime));
  }
  if (!(std::abs(mapping.nonlinearity) <= 6)) {
    throw std::invalid_argument(
        fmt::format("EMG nonlinearity = {}, must be −6 to 6", mapping.nonlinearity));
  }
}

Eigen::RowVectorXd flatTops(const Eigen::VectorXd& times, const Eigen::RowVectorXd& record) {
  const Eigen::Index n = record.size();
  Eigen::RowVectorXd lacking = Eigen::RowVectorXd::Zero(n);
  const double top = n > 0 ? record.maxCoeff() : 0;
  if (!(top > 0)) return lacking;
  const auto isTop = [&](Eigen::Index k) { return record[k] >= (1 - 1e-9) * top; };
  const auto slope = [&](Eigen::Index k) {
    return (record[k + 1] - record[k]) / (times[k + 1] - times[k]);
  };
  for (Eigen::Index first = 0, end; first < n; first = end) {
    end = first + 1;
    if (!isTop(first)) continue;
    while (end < n && isTop(end)) ++end;
    const Eigen::Index last = end - 1;
    const bool begins = first > 0, ends = end < n;
    if (last - first < 4 || (!begins && !ends)) continue;
    // between two rows the record reaches its top on the way: the slope is that of the rows before
    const double a = begins ? slope(std::max<Eigen::Index>(first - 2, 0)) : 0;
    const double b = ends ? -slope(std::min(end, n - 2)) : 0;
    const double duration = times[last] - times[first];
    for (Eigen::Index k = first; k <= last; ++k) {
      const double tau = (times[k] - times[first]) / duration, left = 1 - tau;
      double h = a * tau * left * left + b * tau * tau * left;
      if (!ends) h = a * tau * (1 - tau / 2);
      if (!begins) h = b * left * (1 - left / 2);
      lacking[k] = std::max(0.0, duration * h);
    }
  }
  return lacking;
}

Eigen::RowVectorXd EmgDerivatives::tired(Eigen::Index muscle,
                                         const Eigen::RowVectorXd& change) const {
  if (share.size() == 0) return change;
  return share.row(muscle).cwiseProduct(change) -
         tiring.row(muscle).cwiseProduct(integral(times, change));
}

ExcitationSignal drivenExcitation(const ExcitationSignal& trial,
                                  const std::vector<std::string>& muscles,
                                  const EmgMapping& mapping) {
  requireValid(muscles, mapping);
  const bool changesNothing = mapping.gain.empty() && mapping.delay == 0 &&
                              mapping.nonlinearity == 0 && mapping.offset.empty() &&
                              mapping.crosstalk.empty() && mapping.saturation.empty() &&
                              mapping.fatigue == 0 && mapping.latent.empty();
  if (changesNothing) return trial;
  const Eigen::MatrixXd recorded = recordedOf(trial, muscles, mapping);
  Eigen::MatrixXd rows = cleaned(recorded, muscles, mapping);
  addLacking(timesOf(trial), recorded, muscles, mapping, rows);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const double gain = gainOf(mapping, muscles[static_cast<std::size_t>(i)]);
    for (Eigen::Index k = 0; k < rows.cols(); ++k) {
      const double z = rows(i, k);
      const double level = mapping.nonlinearity == 0 ? z : shaped(z, mapping.nonlinearity).value;
      rows(i, k) = std::clamp(gain * level, 0.0, 1.0);
    }
    if (mapping.fatigue == 0) continue;
    const Eigen::ArrayXd fresh = freshness(mapping, integral(timesOf(trial), rows.row(i)));
    rows.row(i).array() *= 1 - mapping.fatigue * (1 - fresh.transpose());
  }
  std::vector<double> times = trial.times();
  for (double& t : times) t += mapping.delay;
  return {std::move(times), rows.transpose()};
}

EmgDerivatives emgDerivatives(const ExcitationSignal& trial,
                              const std::vector<std::string>& muscles, const EmgMapping& mapping) {
  requireValid(muscles, mapping);
  const Eigen::MatrixXd recorded = recordedOf(trial, muscles, mapping);
  Eigen::MatrixXd rows = cleaned(recorded, muscles, mapping);
  addLacking(timesOf(trial), recorded, muscles, mapping, rows);
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(rows.rows(), rows.cols());
  EmgDerivatives derivatives{none, none, none, recorded, none, none, timesOf(trial), {}, {}};
  const double phi = mapping.fatigue, T = mapping.fatigueTime;
  if (phi != 0) derivatives.share = derivatives.tiring = none;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const double gain = gainOf(mapping, muscles[static_cast<std::size_t>(i)]);
    Eigen::RowVectorXd level(rows.cols());
    for (Eigen::Index k = 0; k < rows.cols(); ++k) {
      const Shaped s = shaped(rows(i, k), mapping.nonlinearity);
      level[k] = std::clamp(gain * s.value, 0.0, 1.0);
      if (gain * s.value > 1) continue;
      derivatives.gain(i, k) = s.value;
      derivatives.nonlinearity(i, k) = gain * s.inShape;
      if (rows(i, k) > 0) {
        derivatives.signal(i, k) = gain * slopeOfShape(rows(i, k), mapping.nonlinearity);
      }
    }
    const Eigen::RowVectorXd work = integral(derivatives.times, level);
    const Eigen::RowVectorXd fresh = freshness(mapping, work).matrix().transpose();
    derivatives.fatigue.row(i) = level.array() * (fresh.array() - 1);
    if (phi == 0) continue;
    derivatives.fatigueTime.row(i) = level.array() * fresh.array() * work.array() * (phi / (T * T));
    derivatives.share.row(i) = 1 - phi * (1 - fresh.array());
    derivatives.tiring.row(i) = level.array() * fresh.array() * (phi / T);
  }
  return derivatives;
}

}  // namespace bio
