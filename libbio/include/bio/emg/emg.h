#pragma once

#include <Eigen/Dense>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bio/emg/emg_stages.h"
#include "bio/emg/measured_coordinate.h"
#include "bio/tables/latent_excitation.h"
#include "bio/tables/recording.h"

namespace bio {

/// Kind of signal in the channel.
enum class EmgSignal {
  raw,      ///< offset removed, band-pass, notch, rectified, low-pass
  envelope  ///< already rectified and smoothed; only normalised, delayed and shaped
};

/// Normalisation: the envelope of a maximum voluntary contraction, in the channel's unit,
/// corresponds to excitation 1 …
struct MvcValue {
  double value = 0;              ///< > 0
  std::string source = "given";  ///< source of the number, for the report
  std::string recording = {};    ///< file of the contraction; empty: the value was given
};
/// … or, if none was recorded, a percentile of this recording's own envelope.
struct OwnPercentile {
  double percent = 99;  ///< 0 < percent ≤ 100
};

/// One electrode and the muscles that it represents.
struct Electrode {
  std::string channel;
  std::variant<OwnPercentile, MvcValue> full;           ///< value that corresponds to excitation 1
  std::vector<std::pair<std::string, double>> muscles;  ///< name and weight, 0 < weight ≤ 1
};

/// Excitation of a muscle without an electrode, in place of its own signal.
struct UnrecordedMuscle {
  std::string muscle;
  /// Electrodes by their channels, with weights w > 0: the weighted mean of their excitations,
  ///     factor·Σ w_e u_e/Σ w_e
  /// One electrode alone is shared. Empty: constant.
  std::vector<std::pair<std::string, double>> synergy;
  double factor = 1;                        ///< 0 < factor ≤ 1
  double constant = 0;                      ///< excitation, 0 to 1
  std::optional<LatentDeclaration> latent;  ///< how far calibration may pull it
};

/// Processing of raw EMG to excitation; the stages are applied in the order of the members.
struct EmgConfig {
  EmgSignal signal = EmgSignal::raw;
  std::optional<BandPassOptions> bandPass = BandPassOptions{};
  NotchOptions notch;
  EnvelopeOptions envelope;
  double shape = 0;         ///< A of shapedExcitation, −3 to 0
  double delay = 0;         ///< electromechanical delay of the excitation [s], 0 to 0.5
  double outputRate = 200;  ///< rows per second [Hz], > 2·envelope.cutoff
  std::optional<double>
      start;                  ///< first row [s]; absent: the first sample common to all electrodes
  std::optional<double> end;  ///< no row after this [s]
  std::vector<Electrode> electrodes;  ///< at least one
  std::vector<UnrecordedMuscle> unrecorded = {};
  std::optional<MeasuredOptions> measured;
  /// Other measured columns of the trial: `coordinate` is the column's name, `degreesPerUnit` and
  /// `sign` its factor.
  std::vector<MeasuredOptions> columns = {};
  /// In sentences, which units were converted or assumed.
  std::vector<std::string> conversions = {};
};

/// Intermediate results of one electrode, at its own sampling rate.
struct ElectrodeTrace {
  std::string channel;
  std::string unit;
  double rate = 0;           ///< [Hz]
  double startTime = 0;      ///< [s]
  double offset = 0;         ///< mean of the raw signal, removed [unit]
  Eigen::VectorXd filtered;  ///< before rectification [unit]; empty for envelopes
  Eigen::VectorXd envelope;  ///< [unit]
  double full = 0;           ///< envelope that corresponds to excitation 1 [unit]
  std::string fullSource;
  double fractionBelow = 0;    ///< of samples < 0, clipped
  double fractionAbove = 0;    ///< of samples > 1, clipped
  Eigen::VectorXd excitation;  ///< clipped and shaped, not yet delayed
};

struct EmgResult {
  Eigen::VectorXd time;              ///< rows [s], equally spaced
  std::vector<std::string> muscles;  ///< in the order of their first electrode; then those without
  Eigen::MatrixXd excitations;       ///< rows × muscles, 0 to 1
  double fractionSumAbove = 0;       ///< of all values: weighted sums > 1, clipped
  std::vector<ElectrodeTrace> electrodes;
  std::optional<MeasuredCoordinate> measured;
  Eigen::VectorXd measured_deg;      ///< at the rows, NaN: not measured; empty without `measured`
  Eigen::MatrixXd columns;           ///< rows × EmgConfig::columns, NaN: not measured
  std::vector<std::string> remarks;  ///< sentences for the report: processing steps and limitations
  std::vector<std::string> warnings;  ///< channels that look wrong (channel_review.h)
};

/// "0.7 of electrode 'biceps'", "the mean of …", "a constant 0.05"
std::string sourceOf(const UnrecordedMuscle& muscle);

/// "'biceps': 2000 Hz, 0.8 mV corresponds to excitation 1 (…); …", one of the result's remarks.
std::string remarkOn(const ElectrodeTrace& trace);

/// How a measured channel is filtered before it becomes rows: as `options` say; one that is faster
/// than the rows passes a zero-lag low-pass of order 6 at 0.4 of their rate, unless its own is
/// lower.
/// @param rate        of the channel [Hz]
/// @param outputRate  of the rows [Hz]
MeasuredOptions withoutAliasing(MeasuredOptions options, double rate, double outputRate);

/// Envelope of one channel through the first stages (up to the low-pass), in the channel's unit.
/// @throws std::invalid_argument for gaps, a signal shorter than one period of the cut-off, edges
/// above fs/2
ElectrodeTrace emgEnvelope(const Channel& channel, const EmgConfig& config);

/// The complete processing. Measured channels pass withoutAliasing(). The excitation of a muscle is
/// the weighted sum of the excitations of its electrodes, clipped to 1.
/// @throws std::invalid_argument naming channel or setting, value, unit and rule
EmgResult excitationsFromEmg(const Recording& recording, const EmgConfig& config);

}  // namespace bio
