#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/simulation/musculoskeletal_system.h"

namespace bio::view {

/// A motion to be shown: what a table of states says about the coordinates and muscles of a model.
/// Every series has one finite value per time.
struct SystemMotion {
  Eigen::VectorXd time;                                 ///< [s], rising
  std::map<std::string, Eigen::VectorXd> coordinates;   ///< by name [rad] or [m]
  std::map<std::string, Eigen::VectorXd> activations;   ///< by muscle
  std::map<std::string, Eigen::VectorXd> fibreLengths;  ///< by muscle [m]
};

/// Reads states as OpenSim 4 names them (`/jointset/J/C/value`, `/forceset/M/activation`,
/// `/forceset/M/fiber_length`) or OpenSim 3 did (`J/C/value`, `C_u`, `M.activation`), or a motion
/// or trial whose columns are called as the coordinates are, in degrees if the header says so or
/// the name ends in `_deg`, in radians if it ends in `_rad`. Cells that were not measured are
/// filled by straight lines. Speeds, other states and excitations are passed over.
/// @throws FileError what readTable throws
/// @throws UnknownColumn for a column that belongs to nothing in the model unless `ignoreExtra`
/// @throws std::invalid_argument if no column gives a coordinate
SystemMotion readSystemMotion(const std::filesystem::path& file, const Model& model,
                              bool ignoreExtra);

/// The value of one series at a time between straight lines; the end values outside.
double valueAt(const Eigen::VectorXd& times, const Eigen::VectorXd& values, double time);

/// Coordinates that move in any of the motions are free, the others are locked where the first
/// motion that has them holds them. Values already in `options` win; if nothing moves, its free
/// coordinates stay.
SkeletonOptions skeletonFor(const Model& model, const std::vector<const SystemMotion*>& motions,
                            SkeletonOptions options);

/// Tendon forces at the given times, by muscle [N].
struct TendonForces {
  std::map<std::string, Eigen::VectorXd> byMuscle;
  std::string whyNone;  ///< one line if there are none
};
TendonForces tendonForces(const Model& model, const SystemOptions& options,
                          const SystemMotion& motion, const Eigen::VectorXd& times);

}  // namespace bio::view
