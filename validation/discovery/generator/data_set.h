#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "generator/subject.h"
#include "generator/violations.h"

namespace hidden {

/// What a data set is to contain. Everything else follows from the seed.
struct DataSetPlan {
  std::uint64_t seed = 0;
  /// null: nuisances alone · single: one effect that is no parameter · parameter: one parameter
  /// far outside its tolerance · two: two effects · out: one that the catalogue lacks ·
  /// equivalents: one of delay, clock, tilt, handforce, and the trial that would tell it from its
  /// twin · far: trials in open loop of a person far from the nominal model (nothing, an effect, a
  /// parameter, an effect, by seed) · violated: an assumption on the data that does not hold (ten
  /// of them by seed, each with nothing, an effect, a parameter)
  std::string suite = "single";
  std::vector<std::string> effects;  ///< ids; empty: chosen by seed from those of the suite
  double size = 1;                   ///< share of the full size
  double emgNoise = 0;
  double nuisances = 1;   ///< share of the person's usual departures
  std::string violation;  ///< of suite violated: its id; empty: by seed
};

/// A trial with the name of its file, without extension.
struct NamedTrial {
  std::string name;
  Trial trial;
  // what is known, and written in the file's header
  double knownMass = 0;  ///< held in the hand [kg]
  double knownTurn = 0;  ///< of the whole arm [deg]
};

struct DataSet {
  std::vector<NamedTrial> trials;  ///< train_1, train_2, train_3, held_out[, follow_up]
  nlohmann::ordered_json label;    ///< the truth, for the scorer alone
  std::string
      leftOut;  ///< muscle that the model to compare with lacks, and the files' EMG; or empty
};

/// What a plan hides: "null", "single", "parameter", "two", "out" or "equivalents". That of the
/// suite, of far and violated by seed, or by the one effect named. @throws std::invalid_argument
/// for an unknown suite
std::string hides(const DataSetPlan& plan);

/// The violation of a plan, which is of suite violated. @throws std::invalid_argument for an
/// unknown one
const Violation& chosenViolation(const DataSetPlan& plan);

/// Effects that a plan hides: those it names, else by seed, in turn. @throws std::invalid_argument
/// for an unknown suite or id, or effects that do not fit the suite
std::vector<std::string> chosenEffects(const DataSetPlan& plan);

/// Draws the person and the trials. @throws std::runtime_error if 60 draws of a trial fail
DataSet makeDataSet(const ElbowNumbers& nominal, const DataSetPlan& plan);

/// One trial as an .sto table: time, eight EMG channels (0 … 1) but that of the muscle left out,
/// the angle [deg], the known torque where there is one; known mass and turn in the header.
std::string asTable(const NamedTrial& trial, const std::string& title,
                    const std::string& leftOut = {});

/// Writes NAME.sto into `folder` (follow_up.sto into folder/follow_up) and truth.sha256 beside
/// them, the label into labels/NAME-OF-FOLDER.json; model.osim, `model` without the muscle left
/// out, where there is one.
/// @throws std::runtime_error if a file cannot be written
void writeDataSet(const DataSet& set, const std::filesystem::path& model,
                  const std::filesystem::path& folder, const std::filesystem::path& labels);

/// SHA-256 as 64 hexadecimal digits.
std::string sha256(const std::string& bytes);

}  // namespace hidden
