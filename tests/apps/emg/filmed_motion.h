#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bio/analysis/replay.h"
#include "bio/observation/trial_predictor.h"
#include "bio/opensim/osim_file.h"
#include "bio/tables/trial_table.h"
#include "libbio/tables/binary_samples.h"
#include "support/run_program.h"
#include "support/scratch_folder.h"

/// Markers on a simulated motion as a laboratory would deliver them, and what the program makes of
/// them.
namespace filmed {

using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;

inline constexpr int frames = 101;  // at 100 Hz
inline constexpr double gap = 30;   // frame in which the last point was not seen

/// A model, a motion that it makes with one parameter changed, and what cameras see of it.
struct Filmed {
  std::string model;                     // file
  std::vector<std::string> coordinates;  // free ones
  std::vector<std::string> points;       // as the laboratory calls them
  std::vector<std::string> markers;      // BODY.MARKER
  std::string parameter;
  double truth;
  bio::Table excitations;
  Eigen::MatrixXd seen;  // model's axes [m]; x, y, z of each point by frame

  Filmed(std::string file, std::vector<std::string> free, std::vector<std::string> names,
         std::string changed, double factor)
      : model(std::move(file)), coordinates(std::move(free)), parameter(std::move(changed)) {
    const bio::Model made = bio::readOsim(model);
    const bio::SystemOptions options{{coordinates, {}}, {}, {}};
    const bio::MusculoskeletalSystem system(made, options);
    for (const bio::Marker& marker : made.markers) {
      markers.push_back(marker.body + "." + marker.name);
    }
    points = std::move(names);
    excitations.columns = {"time"};
    for (std::size_t m = 0; m < system.numMuscles(); ++m) {
      excitations.columns.push_back(system.muscles()[m].name);
    }
    excitations.values.resize(frames, static_cast<Eigen::Index>(excitations.columns.size()));
    for (Eigen::Index k = 0; k < frames; ++k) {
      const double t = 0.01 * static_cast<double>(k);
      excitations.values(k, 0) = t;
      for (Eigen::Index m = 1; m < excitations.values.cols(); ++m) {
        excitations.values(k, m) = 0.1 + 0.06 * std::sin(4 * t + static_cast<double>(m));
      }
    }
    const bio::Trial trial = bio::trialFrom(excitations, "made", made, {});
    const bio::ParameterCatalogue catalogue(made, system,
                                            {bio::startCoordinates(trial, system, {}), {}});
    const auto selection = catalogue.select({parameter});
    truth = factor * catalogue.values(selection)[0];
    std::vector<bio::ObservedSeries> series;
    for (const std::string& marker : markers) {
      for (int axis = 0; axis < 3; ++axis) {
        series.push_back({{bio::Observable::Kind::marker, marker, axis}, trial.times});
      }
    }
    bio::SimulationOptions simulation;
    simulation.duration = 1;
    const bio::TrialPredictor predictor(catalogue, options, bio::excitationOf(trial, system),
                                        series, selection, simulation);
    seen = predictor.outputs(Eigen::VectorXd::Constant(1, truth)).reshaped(frames, series.size());
  }

  /// [mm] in a laboratory whose z points up and whose origin lies elsewhere: x, −z, y of the model.
  double laboratory(int frame, std::size_t point, int axis) const {
    const auto first = static_cast<Eigen::Index>(3 * point);
    const Eigen::Vector3d p = seen.row(frame).segment<3>(first);
    return 1000 * (Eigen::Vector3d(p.x(), -p.z(), p.y()) + Eigen::Vector3d(0.5, -1, 0.25))[axis];
  }
  bool isSeen(int frame, std::size_t point) const {
    return frame != static_cast<int>(gap) || point + 1 < points.size();
  }

  std::string trc() const {
    std::string text = "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tNumFrames\tNumMarkers\tUnits\n";
    text += fmt::format("100\t{}\t{}\tmm\nFrame#\tTime", frames, points.size());
    for (const std::string& point : points) text += "\t" + point + "\t\t";
    text += "\n\n\n";
    for (int f = 0; f < frames; ++f) {
      text += fmt::format("{}\t{:.2f}", f + 1, 0.01 * f);
      for (std::size_t p = 0; p < points.size(); ++p) {
        for (int axis = 0; axis < 3; ++axis) {
          text += isSeen(f, p) ? fmt::format("\t{:.3f}", laboratory(f, p, axis)) : "\t";
        }
      }
      text += "\n";
    }
    return text;
  }

  std::string c3d() const {
    support::C3dSample sample;
    sample.floats = true;
    sample.points = static_cast<unsigned>(points.size());
    sample.frames = frames;
    sample.channels = sample.samplesPerFrame = 0;
    sample.without = {"POINT:LABELS", "ANALOG:OFFSET"};
    sample.more = {support::C3dSample::textOf("POINT", "LABELS", points, 24)};
    sample.position = [this](unsigned f, unsigned p, unsigned axis) {
      return laboratory(static_cast<int>(f), p, static_cast<int>(axis));
    };
    sample.isSeen = [this](unsigned f, unsigned p) { return isSeen(static_cast<int>(f), p); };
    return sample.write();
  }

  /// The excitations as an envelope in mV of which 1 mV is a maximum contraction.
  std::string envelopes() const {
    std::string text = "time";
    for (std::size_t m = 1; m < excitations.columns.size(); ++m) {
      text += "," + excitations.columns[m] + "_mV";
    }
    for (const auto& row : excitations.values.rowwise()) {
      text += fmt::format("\n{:.2f}", row[0]);
      for (Eigen::Index m = 1; m < row.size(); ++m) text += fmt::format(",{:.17g}", row[m]);
    }
    return text + "\n";
  }

  std::string config(const std::string& markersTable) const {
    std::string text =
        "[input]\nsignal = 'envelope'\n[excitation]\nrate_Hz = 100\n[[recording]]\noffset_s = 0\n";
    for (std::size_t m = 1; m < excitations.columns.size(); ++m) {
      text += fmt::format(
          "[[electrode]]\nchannel = '{0}_mV'\nmuscles = ['{0}']\nmvc = 1\n"
          "unit = 'mV'\n",
          excitations.columns[m]);
    }
    return text + markersTable;
  }
};

/// From a recording of points to a calibrated parameter.
inline void followMarkers(const Filmed& filmed, const std::string& markersTable) {
  const ScratchFolder scratch;
  const std::string envelopes = scratch.file("emg.csv", filmed.envelopes());
  const std::string config = scratch.file("c.toml", filmed.config(markersTable));
  std::vector<std::string> system;
  for (const std::string& name : filmed.coordinates) {
    system.insert(system.end(), {"--coordinate", name});
  }
  for (const bool isC3d : {false, true}) {
    const std::string out = (scratch / (isC3d ? "c3d" : "trc")).string();
    const std::string points =
        isC3d ? scratch.file("a.c3d", filmed.c3d()) : scratch.file("a.trc", filmed.trc());
    const ProgramResult emg =
        runFisherHill({"emg", envelopes, points, "--config", config, "--out", out});
    ASSERT_EQ(emg.status, 0) << emg.err;
    const std::string trial = out + "/excitations.sto";
    // turned, in metres, with its gap
    const bio::Table table = bio::readTable(trial);
    for (std::size_t p = 0; p < filmed.points.size(); ++p) {
      const Eigen::Index column = bio::columnIndex(table, filmed.markers[p] + ".y");
      const auto first = static_cast<Eigen::Index>(3 * p + 1);
      EXPECT_NEAR(table.values(50, column), filmed.seen(50, first), 2e-6) << filmed.markers[p];
      EXPECT_EQ(table.values.col(column).array().isNaN().count(),
                p + 1 < filmed.points.size() ? 0 : 1);
    }
    std::vector<std::string> replay = {"replay", filmed.model, trial, "--json"};
    replay.insert(replay.end(), system.begin(), system.end());
    const ProgramResult before = runFisherHill(replay);
    ASSERT_EQ(before.status, 0) << before.err;
    const std::string name = filmed.markers.back() + ".x";
    EXPECT_GT(nlohmann::json::parse(before.out)["rms_error"][name]["value"], 1e-3);
    std::vector<std::string> calibrate = {"calibrate",    filmed.model,     trial,
                                          "--parameters", filmed.parameter, "--out",
                                          out + "/fit",   "--step",         "0.01"};
    calibrate.insert(calibrate.end(), system.begin(), system.end());
    const ProgramResult fit = runFisherHill(calibrate);
    ASSERT_EQ(fit.status, 0) << fit.err;
    const auto json = nlohmann::json::parse(support::contentOf(out + "/fit/summary.json"));
    EXPECT_NEAR(json["estimates"][filmed.parameter]["value"].get<double>() / filmed.truth, 1, 1e-3);
    EXPECT_LT(json["channels"][name]["rmse_train"], 1e-5);
  }
}

}  // namespace filmed
