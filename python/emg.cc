#include "bio/emg/emg.h"

#include <limits>

#include "arguments/columns.h"
#include "arguments/file_name.h"
#include "bio/emg/emg_config.h"
#include "bio/emg/emg_config_draft.h"
#include "bio/emg/emg_recordings.h"
#include "bio/emg/emg_trial.h"
#include "bio/tables/recorded_file.h"
#include "docstrings.h"
#include "interruptible.h"
#include "systems.h"

namespace python {
namespace {

py::dict electrodesOf(const bio::EmgResult& result) {
  py::dict electrodes;
  for (const bio::ElectrodeTrace& trace : result.electrodes) {
    electrodes[trace.channel.c_str()] =
        results("unit"_a = trace.unit, "rate"_a = trace.rate, "start_time"_a = trace.startTime,
                "filtered"_a = trace.filtered, "envelope"_a = trace.envelope, "full"_a = trace.full,
                "full_source"_a = trace.fullSource, "fraction_below"_a = trace.fractionBelow,
                "fraction_above"_a = trace.fractionAbove, "excitation"_a = trace.excitation);
  }
  return electrodes;
}

/// A file or several.
using Files = std::variant<FileName, std::vector<FileName>>;

std::vector<std::string> filesOf(const Files& recordings) {
  std::vector<std::string> files;
  if (const auto* one = std::get_if<FileName>(&recordings)) {
    files.push_back(one->text);
  } else {
    for (const FileName& each : std::get<1>(recordings)) files.push_back(each.text);
  }
  if (files.empty()) throw std::invalid_argument("recordings: empty, must have at least one");
  return files;
}

py::object writeEmgConfig(const Files& recordings, const FileName& file) {
  const std::vector<std::string> files = filesOf(recordings);
  bio::EmgConfigDraft draft;
  interruptible([&](const std::atomic<bool>&) {
    draft = bio::draftEmgConfig(files);
    bio::writeEmgConfig(draft, file.text);
  });
  return results("channels"_a = draft.channels, "electrodes"_a = draft.electrodes,
                 "is_complete"_a = draft.complete);
}

py::object emg(const Files& recordings, const FileName& config, const FileName& write) {
  const std::vector<std::string> files = filesOf(recordings);
  bio::JoinedRecordings joined;
  bio::EmgResult result;
  bio::Table trial;
  interruptible([&](const std::atomic<bool>&) {
    const bio::EmgConfigFile file = bio::readEmgConfig(config.text);
    joined = bio::readRecordings(file, files);
    const bio::EmgConfig settings =
        bio::emgConfigFor(file, joined.recording, bio::markerNames(file));
    result = bio::excitationsFromEmg(joined.recording, settings);
    trial = bio::excitationTable(result, settings);
    if (!write.text.empty()) bio::writeTable(trial, write.text);
  });
  py::dict offsets;
  for (const auto& placed : joined.placed) offsets[placed.file.c_str()] = placed.offset;
  return tableResult("EmgResult", "columns"_a = columnsOf(trial), "muscles"_a = result.muscles,
                     "electrodes"_a = electrodesOf(result),
                     "fraction_of_sums_clipped"_a = result.fractionSumAbove, "offsets"_a = offsets,
                     "latent_excitation"_a = trial.metadata["latent_excitation"],
                     "remarks"_a = result.remarks, "warnings"_a = result.warnings);
}

/// As `check` shows it.
py::object readRecording(const FileName& file) {
  bio::RecordedFile recorded;
  interruptible([&](const std::atomic<bool>&) { recorded = bio::readRecordedFile(file.text); });
  py::dict markers;
  Eigen::VectorXd times;
  if (recorded.markers) {
    times = recorded.markers->times;
    for (const std::string& name : recorded.markers->names) {
      markers[name.c_str()] = Eigen::MatrixXd(bio::positionsOf(*recorded.markers, name));
    }
  }
  py::list channels;
  for (const bio::Channel& channel : recorded.channels) {
    channels.append(results("name"_a = channel.name, "unit"_a = channel.unit,
                            "rate"_a = channel.rate, "start_time"_a = channel.startTime,
                            "values"_a = channel.values));
  }
  return results("markers"_a = markers, "times"_a = times,
                 "frame_rate"_a = recorded.markers ? recorded.markers->rate
                                                   : std::numeric_limits<double>::quiet_NaN(),
                 "channels"_a = tableOfRows(channels), "remarks"_a = recorded.remarks);
}

}  // namespace

void defineEmg(py::module_& module) {
  module.def("emg", &emg, "recordings"_a, "config"_a, py::kw_only(), "write"_a = "",
             docstrings::emg);
  module.def("write_emg_config", &writeEmgConfig, "recordings"_a, "file"_a,
             docstrings::write_emg_config);
  module.def("read_recording", &readRecording, "file"_a, docstrings::read_recording);
}

}  // namespace python
