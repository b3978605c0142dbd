#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/simulation/musculoskeletal_system.h"
#include "bio/simulation/simulate.h"
#include "view/still_paths.h"

namespace app {

/// A muscle, ligament or path spring at one moment.
struct PlayedLine {
  std::vector<Eigen::Vector3d> points;  ///< centre line in ground [m]; empty: nothing to draw
  double radius = 0;                    ///< of its tube [m]
  double activation = 0;                ///< NaN: no muscle, or not simulated
};

/// One moment of a simulated motion, as a picture shows it.
struct PlayedFrame {
  double time = 0;                             ///< [s]
  std::vector<bio::Placement<double>> bodies;  ///< in ground, in the order of bodyShapes()
  std::vector<PlayedLine> lines;               ///< in the order of FrameMaker::paths()
};

/// Draws the postures of one system. Points of a line that lie within 0.1 mm of the line without
/// them are left out.
class FrameMaker {
 public:
  /// Both must outlive this object.
  FrameMaker(const bio::Model& model, const bio::MusculoskeletalSystem& system,
             const std::vector<std::string>& wrapAsCylinder);

  const std::vector<std::string>& bodies() const { return bodies_; }
  /// Muscles that are simulated, elastic paths, then muscles that no free coordinate moves.
  std::vector<std::string> paths() const;

  /// @param rows  of the motion
  /// @throws what reportMuscles throws
  std::vector<PlayedFrame> frames(const bio::Trajectory& motion,
                                  const std::vector<std::size_t>& rows) const;
  /// Bodies alone.
  /// @param q  in the skeleton's order [rad] or [m]
  std::vector<bio::Placement<double>> bodiesAt(const Eigen::VectorXd& q) const;

 private:
  std::vector<std::vector<Eigen::Vector3d>> linesAt(const Eigen::VectorXd& q) const;

  const bio::MusculoskeletalSystem* system_;
  std::vector<std::string> bodies_;
  bio::view::StillPaths still_;
};

/// At most `count` rows of a motion at about equal distances in time, the first and the last among
/// them.
std::vector<std::size_t> evenRows(const std::vector<double>& times, std::size_t count);

/// The line without the points that lie within `tolerance` [m] of the line without them (Ramer,
/// Douglas and Peucker); its ends stay.
std::vector<Eigen::Vector3d> thinnedLine(const std::vector<Eigen::Vector3d>& line,
                                         double tolerance);

}  // namespace app
