#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/skeleton/skeleton.h"

namespace bio {

/// Postures of a model, one row each.
struct PostureTable {
  std::vector<std::string> coordinates;
  Eigen::MatrixXd values;            ///< rows × coordinates [rad] or [m]
  std::vector<std::string> ignored;  ///< columns that are no coordinate of the model
};

/// Reads a .csv file with a row of names; columns whose name is a coordinate count.
/// @throws FileError naming file, line and column: no such column, one given twice, a cell of one
///   that is not a finite number, a row with too few or too many cells, no row
PostureTable readPostures(const std::filesystem::path& file, const Model& model);

/// Muscle–tendon lengths that another program computed in postures of a model.
struct LengthTable {
  PostureTable postures;
  std::vector<std::string> muscles;
  Eigen::MatrixXd length;  ///< rows = postures, columns = muscles [m]; NaN: not given
  /// Slopes ∂ℓ/∂q of each muscle, postures × coordinates [m/rad]; no rows where a column lacks.
  std::vector<Eigen::MatrixXd> slope;
};

/// Reads a table like those of `moment-arms --postures`: columns COORDINATE [rad] or [m],
/// MUSCLE.length_m [m] and, if there, MUSCLE.dlength_d.COORDINATE. Others are ignored, without
/// being listed if they begin with a muscle's name.
/// @throws FileError what readPostures throws; a length that is no number, no column with lengths
LengthTable readLengths(const std::filesystem::path& file, const Model& model);

/// Muscle–tendon lengths in given postures.
struct PathPostures {
  std::vector<std::string> coordinates;
  std::vector<std::string> muscles;
  Eigen::MatrixXd length;              ///< ℓ_MT, rows = postures, columns = muscles [m]
  std::vector<Eigen::MatrixXd> slope;  ///< of each muscle ∂ℓ/∂q, postures × coordinates [m/rad]
  /// Names of the wrap objects that the path of each muscle touches in each posture.
  std::vector<std::vector<std::vector<std::string>>> touched;
  std::vector<std::string> notes;
  std::vector<std::string> warnings;  ///< muscles or postures that cannot be computed
};

/// Paths of all enabled muscles, whatever their class, with the table's coordinates free and the
/// others at their defaults or where `locked` says. NaN where a path cannot be computed.
/// @throws std::invalid_argument what Skeleton and MusclePath throw
PathPostures pathsAt(const Model& model, const PostureTable& postures,
                     const std::map<std::string, double>& locked,
                     const std::vector<std::string>& wrapAsCylinder);

/// Lengths and moment arms of muscles over the range of one coordinate.
struct PathSample {
  Eigen::VectorXd value;  ///< of the coordinate [rad] or [m]
  std::vector<std::string> muscles;
  Eigen::MatrixXd length;          ///< rows = values, columns = muscles [m]
  Eigen::MatrixXd momentArm;       ///< −∂ℓ/∂q [m]
  Eigen::MatrixXd momentArmSlope;  ///< −∂²ℓ/∂q² [m/rad]
  Eigen::MatrixXi wrapped;         ///< 1: a wrap object is touched
  std::vector<std::string> notes;
  std::vector<std::string> warnings;  ///< muscles that cannot be computed and are left out
};
/// Paths of every enabled muscle that the skeleton's first coordinate moves, whatever its class;
/// the other free coordinates stay at their defaults.
/// @throws std::invalid_argument what MusclePath throws
PathSample samplePaths(const Model& model, const Skeleton& skeleton,
                       const std::vector<std::string>& wrapAsCylinder,
                       const Eigen::VectorXd& values);

}  // namespace bio
