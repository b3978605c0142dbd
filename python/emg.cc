#include "bio/emg/emg.h"

#include <limits>

#include "arms.h"
#include "bio/emg/emg_config.h"
#include "bio/emg/emg_recordings.h"
#include "bio/emg/emg_trial.h"
#include "bio/tables/recorded_file.h"
#include "docstrings.h"
#include "interruptible.h"

namespace python {
namespace {

py::dict electrodesOf(const bio::EmgResult& result) {
  py::dict electrodes;
  for (const bio::ElectrodeTrace& one : result.electrodes) {
    electrodes[one.channel.c_str()] =
        results("unit"_a = one.unit, "rate"_a = one.rate, "start_time"_a = one.startTime,
                "filtered"_a = one.filtered, "envelope"_a = one.envelope, "full"_a = one.full,
                "full_source"_a = one.fullSource, "fraction_below"_a = one.fractionBelow,
                "fraction_above"_a = one.fractionAbove, "excitation"_a = one.excitation);
  }
  return electrodes;
}

py::object emg(const Names& recordings, const std::string& config, const std::string& write) {
  const auto* one = std::get_if<std::string>(&recordings);
  const std::vector<std::string> files =
      one ? std::vector<std::string>{*one} : std::get<std::vector<std::string>>(recordings);
  if (files.empty()) throw std::invalid_argument("recordings: empty, must have at least one");
  bio::JoinedRecordings joined;
  bio::EmgResult result;
  bio::Table trial;
  interruptible([&](const std::atomic<bool>&) {
    const bio::EmgConfigFile file = bio::readEmgConfig(config);
    joined = bio::readRecordings(file, files);
    const bio::EmgConfig of = bio::emgConfigFor(file, joined.recording, bio::markerNames(file));
    result = bio::excitationsFromEmg(joined.recording, of);
    trial = bio::excitationTable(result, of);
    if (!write.empty()) bio::writeTable(trial, write);
  });
  py::dict offsets;
  for (const auto& placed : joined.placed) offsets[placed.file.c_str()] = placed.offset;
  py::dict columns;  // as make_trial takes them
  for (std::size_t k = 0; k < trial.columns.size(); ++k) {
    columns[trial.columns[k].c_str()] =
        Eigen::VectorXd(trial.values.col(static_cast<Eigen::Index>(k)));
  }
  return results("columns"_a = columns, "muscles"_a = result.muscles,
                 "electrodes"_a = electrodesOf(result),
                 "fraction_of_sums_clipped"_a = result.fractionSumAbove, "offsets"_a = offsets,
                 "latent_excitation"_a = trial.metadata["latent_excitation"],
                 "remarks"_a = result.remarks, "warnings"_a = result.warnings);
}

/// As `check` shows it.
py::object readRecording(const std::string& file) {
  bio::RecordedFile recorded;
  interruptible([&](const std::atomic<bool>&) { recorded = bio::readRecordedFile(file); });
  py::dict markers;
  Eigen::VectorXd times;
  if (recorded.markers) {
    times = recorded.markers->times;
    for (const std::string& name : recorded.markers->names) {
      markers[name.c_str()] = Eigen::MatrixXd(bio::positionsOf(*recorded.markers, name));
    }
  }
  py::list channels;
  for (const bio::Channel& one : recorded.channels) {
    channels.append(results("name"_a = one.name, "unit"_a = one.unit, "rate"_a = one.rate,
                            "start_time"_a = one.startTime, "values"_a = one.values));
  }
  return results("markers"_a = markers, "times"_a = times,
                 "frame_rate"_a = recorded.markers ? recorded.markers->rate
                                                   : std::numeric_limits<double>::quiet_NaN(),
                 "channels"_a = channels, "remarks"_a = recorded.remarks);
}

}  // namespace

void defineEmg(py::module_& module) {
  module.def("emg", &emg, "recordings"_a, "config"_a, py::kw_only(), "write"_a = "",
             docstrings::emg);
  module.def("read_recording", &readRecording, "file"_a, docstrings::read_recording);
}

}  // namespace python
