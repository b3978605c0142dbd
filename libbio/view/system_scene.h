#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "view/camera_fit.h"
#include "view/film_writer.h"
#include "view/system_shape.h"

namespace bio::view {

struct SceneOptions {
  int width = 1280;                ///< [pixel] > 0
  int height = 960;                ///< [pixel] > 0
  bool showWraps = false;          ///< wrap surfaces, translucent
  std::filesystem::path geometry;  ///< folder of the .vtp files that the model names; may be empty
  std::vector<std::string> captions;                 ///< lines at the top left
  double largestActivation = 1;                      ///< with the last colour > 0
  bool showsActivations = true;                      ///< the scale of their colours
  bool showsTime = true;                             ///< at the bottom left
  double floor = 0;                                  ///< height of the ground plane [m]
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< of the ground plane [m]
};

/// Directions from which to look.
enum class Camera { fit, side, front, top, isometric };

/// Vertical angle of view [rad].
constexpr double cameraViewAngle = 0.4;

/// Unit vector towards the camera in OpenSim's axes, x forwards, y up, z to the right. `fit` looks
/// along the horizontal direction in which the points differ least, a little from above.
Eigen::Vector3d directionOf(Camera camera, const std::vector<Eigen::Vector3d>& points);

/// The part of the picture that legend, captions and time leave free.
constexpr PictureFrame pictureFrame = {-0.93, 0.68, -0.76, 0.7};

/// Bones, joints, muscles, wraps, ground, legend and time stamp, drawn off screen.
class SystemScene {
 public:
  /// One moment of the second system or motion is drawn translucent if `ghost` is not null.
  struct Moment {
    double time = 0;  ///< [s]
    const SystemPoser::Posture* posture = nullptr;
    std::vector<double> activations;  ///< by muscle, 0 … 1; NaN: unknown, drawn grey
    const SystemPoser::Posture* ghost = nullptr;
  };

  /// There must be a display (VirtualDisplay) as long as the scene lives.
  /// @param ghosts  the bodies of the second system; empty: none is ever drawn
  SystemScene(const std::vector<BodyShape>& bodies, const std::vector<BodyShape>& ghosts,
              const SceneOptions& options);
  ~SystemScene();
  SystemScene(const SystemScene&) = delete;
  SystemScene& operator=(const SystemScene&) = delete;

  /// One line if geometry files are missing or broken, so that tapered solids are drawn instead.
  const std::vector<std::string>& warnings() const;

  void look(const CameraPlace& camera);
  Image draw(const Moment& moment);

 private:
  struct Parts;  ///< hides VTK
  std::unique_ptr<Parts> parts_;
};

/// The bytes of a PNG file.
std::string pngOf(const Image& image);

}  // namespace bio::view
