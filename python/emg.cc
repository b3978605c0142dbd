#include "bio/emg/emg.h"

#include "arms.h"
#include "bio/emg/emg_config.h"
#include "bio/emg/emg_recordings.h"
#include "bio/opensim/osim_file.h"
#include "docstrings.h"
#include "interruptible.h"

namespace python {
namespace {

/// BODY.MARKER of the model that [markers] names.
std::vector<std::string> markersOf(const bio::EmgConfigFile& file) {
  std::vector<std::string> names;
  if (!file.markers || file.markers->model.empty()) return names;
  for (const bio::Marker& marker : bio::readOsim(file.markers->model).markers) {
    names.push_back(marker.body + "." + marker.name);
  }
  return names;
}

/// As make_trial takes them.
py::dict columnsOf(const bio::EmgResult& result, const bio::EmgConfig& config) {
  py::dict columns;
  columns["time"] = result.time;
  for (std::size_t k = 0; k < result.muscles.size(); ++k) {
    columns[result.muscles[k].c_str()] =
        Eigen::VectorXd(result.excitations.col(static_cast<Eigen::Index>(k)));
  }
  if (result.measured) {
    columns[(result.measured->coordinate + "_deg").c_str()] = result.measured_deg;
  }
  for (std::size_t k = 0; k < config.columns.size(); ++k) {
    columns[config.columns[k].coordinate.c_str()] =
        Eigen::VectorXd(result.columns.col(static_cast<Eigen::Index>(k)));
  }
  return columns;
}

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

py::object emg(const Names& recordings, const std::string& config) {
  const auto* one = std::get_if<std::string>(&recordings);
  const std::vector<std::string> files =
      one ? std::vector<std::string>{*one} : std::get<std::vector<std::string>>(recordings);
  if (files.empty()) throw std::invalid_argument("recordings: empty, must have at least one");
  bio::JoinedRecordings joined;
  bio::EmgConfig of;
  bio::EmgResult result;
  interruptible([&](const std::atomic<bool>&) {
    const bio::EmgConfigFile file = bio::readEmgConfig(config);
    joined = bio::readRecordings(file, files);
    of = bio::emgConfigFor(file, joined.recording, markersOf(file));
    result = bio::excitationsFromEmg(joined.recording, of);
  });
  py::dict offsets;
  for (const auto& placed : joined.placed) offsets[placed.file.c_str()] = placed.offset;
  std::vector<bio::LatentDeclaration> latent;
  for (const bio::UnrecordedMuscle& muscle : of.unrecorded) {
    if (muscle.latent) latent.push_back(*muscle.latent);
  }
  return results("columns"_a = columnsOf(result, of), "muscles"_a = result.muscles,
                 "electrodes"_a = electrodesOf(result),
                 "fraction_of_sums_clipped"_a = result.fractionSumAbove, "offsets"_a = offsets,
                 "latent_excitation"_a = bio::latentHeader(latent), "remarks"_a = result.remarks,
                 "warnings"_a = result.warnings);
}

}  // namespace

void defineEmg(py::module_& module) {
  module.def("emg", &emg, "recordings"_a, "config"_a, docstrings::emg);
}

}  // namespace python
