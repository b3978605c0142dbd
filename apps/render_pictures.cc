#include "render_pictures.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "arm_input.h"
#include "arm_options.h"
#include "progress_bar.h"
#include "result.h"
#include "text.h"
#include "view/arm_motion.h"
#include "view/arm_scene.h"
#include "view/virtual_display.h"

namespace app {
namespace {

namespace view = bio::view;

constexpr double fixedRadius = 0.004;     // [m]
constexpr double restingRadius = 0.0025;  // [m], of a tube without force
constexpr double ghostRadius = 0.0022;    // [m]: hidden where both motions coincide
constexpr double shownStress = 5e6;       // [N/m²]: tendon force per area that a tube gains

view::Camera cameraNamed(const std::string& name) {
  if (name == "side") return view::Camera::side;
  if (name == "front") return view::Camera::front;
  if (name == "top") return view::Camera::top;
  if (name == "isometric") return view::Camera::isometric;
  return view::Camera::fit;
}

/// The moments that are shown [s].
Eigen::VectorXd shownTimes(const RenderOptions& options, const view::ArmMotion& motion) {
  const double first = motion.time[0], last = motion.time[motion.time.size() - 1];
  if (!options.film) {
    const double time = options.time.value_or(0.5 * (first + last));
    if (!(time >= first && time <= last)) {
      throw std::invalid_argument(fmt::format("--time {} s: {} covers {} s to {} s",
                                              numberText(time), options.states,
                                              numberText(first, 6), numberText(last, 6)));
    }
    return Eigen::VectorXd::Constant(1, time);
  }
  constexpr double most = 1e5;
  const double count = std::floor((last - first) * options.framesPerSecond + 1e-6) + 1;
  if (!(count >= 2 && count <= most)) {
    throw std::invalid_argument(fmt::format("{}: {} s are {} pictures, a film has 2 to {}",
                                            options.states, numberText(last - first),
                                            numberText(count, 8), numberText(most, 8)));
  }
  const auto n = static_cast<Eigen::Index>(count);
  return first + Eigen::VectorXd::LinSpaced(n, 0, count - 1).array() / options.framesPerSecond;
}

/// A motion with the arm that can follow it.
class MovingArm {
 public:
  MovingArm(const bio::Model& model, const bio::ArmOptions& options, const view::ArmMotion& motion)
      : motion_(motion), poser_(model, options.skeleton, options.wrapAsCylinder) {}

  const view::ArmPoser& poser() const { return poser_; }
  bool covers(double time) const {
    return time >= motion_.time[0] && time <= motion_.time[motion_.time.size() - 1];
  }

  view::ArmPoser::Posture at(double time, const std::vector<double>& radii) const {
    const auto& coordinates = poser_.skeleton().coordinates();
    Eigen::VectorXd q(static_cast<Eigen::Index>(coordinates.size()));
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      const auto found = motion_.coordinates.find(coordinates[i].name);
      q[static_cast<Eigen::Index>(i)] = found == motion_.coordinates.end()
                                            ? coordinates[i].defaultValue
                                            : view::valueAt(motion_.time, found->second, time);
    }
    return poser_.pose(q, radii);
  }

  std::vector<double> activationsAt(double time) const {
    std::vector<double> values;
    for (const std::string& muscle : poser_.muscles()) {
      const auto found = motion_.activations.find(muscle);
      values.push_back(found == motion_.activations.end()
                           ? std::numeric_limits<double>::quiet_NaN()
                           : view::valueAt(motion_.time, found->second, time));
    }
    return values;
  }

 private:
  const view::ArmMotion& motion_;
  view::ArmPoser poser_;
};

/// Radii of the tubes, by moment and muscle [m].
std::vector<std::vector<double>> tubeRadii(const std::vector<std::string>& muscles,
                                           const view::TendonForces& forces, Eigen::Index count) {
  std::vector<std::vector<double>> radii(static_cast<std::size_t>(count));
  for (Eigen::Index k = 0; k < count; ++k) {
    for (const std::string& muscle : muscles) {
      const auto found = forces.byMuscle.find(muscle);
      const double area =
          found == forces.byMuscle.end() ? -1 : std::max(found->second[k], 0.0) / shownStress;
      radii[static_cast<std::size_t>(k)].push_back(
          forces.byMuscle.empty() ? fixedRadius
          : area < 0              ? restingRadius
                     : std::sqrt(restingRadius * restingRadius + area / std::numbers::pi));
    }
  }
  return radii;
}

/// What the camera has to see.
void addOutline(const std::vector<view::BodyShape>& bodies, const view::ArmPoser::Posture& posture,
                std::vector<Eigen::Vector3d>& points) {
  const auto addBall = [&](const Eigen::Vector3d& centre, double radius) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        points.push_back(centre + sign * radius * Eigen::Vector3d::Unit(axis));
      }
    }
  };
  for (const view::BodyShape& body : bodies) {
    const bio::Placement<double>& X = posture.bodies.at(body.name);
    for (const view::TaperedBone& bone : body.bones) {
      addBall(X.R * bone.from + X.p, 1.5 * bone.fromRadius);
      addBall(X.R * bone.to + X.p, 1.5 * bone.toRadius);
    }
  }
  for (const view::MuscleShape& muscle : posture.muscles) {
    for (const Eigen::Vector3d& point : muscle.points) addBall(point, muscle.radius);
  }
}

Report reportOn(const RenderOptions& options, const view::ArmMotion& motion, const MovingArm& arm,
                const std::string& verdict) {
  Report report;
  report.title = fmt::format("{} on {}", options.states, options.model);
  report.verdict = verdict;
  Figure shown{
      .title = "Activation, the muscles' colour", .xLabel = "Time [s]", .yLabel = "Activation [1]"};
  const std::vector<double> times(motion.time.begin(), motion.time.end());
  for (const auto& [muscle, values] : motion.activations) {
    shown.series.push_back({.name = muscle, .x = times, .y = {values.begin(), values.end()}});
  }
  if (!shown.series.empty()) report.mainFigure = shown;
  for (const bio::Coordinate& coordinate : arm.poser().skeleton().coordinates()) {
    const auto found = motion.coordinates.find(coordinate.name);
    if (found == motion.coordinates.end()) continue;
    const double unit = coordinate.isRotation ? 180 / std::numbers::pi : 1e3;
    const Eigen::VectorXd values = found->second * unit;
    report.details.push_back(Figure{
        .title = coordinate.name,
        .xLabel = "Time [s]",
        .yLabel = fmt::format("{} [{}]", coordinate.name, coordinate.isRotation ? "deg" : "mm"),
        .series = {{.name = coordinate.name, .x = times, .y = {values.begin(), values.end()}}}});
  }
  return report;
}

std::string frameName(Eigen::Index k) {
  return fmt::format("frame_{:04}.png", k + 1);
}

}  // namespace

ExitStatus drawPictures(const RenderOptions& options, const CommandContext& context) {
  const auto begin = std::chrono::steady_clock::now();
  const bool toFilm = options.film && view::FilmWriter::available();
  OutputFolder folder(context, {!options.film ? "arm.png" : toFilm ? "arm.mp4" : frameName(0)});
  Summary summary(context);
  const bio::Model model = readModel(options.model, summary);
  summary.addInput(options.states);
  const view::ArmMotion motion = view::readArmMotion(options.states, model, options.ignoreExtra);
  std::optional<view::ArmMotion> ghostMotion;
  std::vector<const view::ArmMotion*> motions = {&motion};
  if (!options.ghost.empty()) {
    summary.addInput(options.ghost);
    ghostMotion = view::readArmMotion(options.ghost, model, options.ignoreExtra);
    motions.push_back(&*ghostMotion);
  }
  const Eigen::VectorXd times = shownTimes(options, motion);

  // The arm, and a second one of the same build for the ghost.
  bio::ArmOptions armOptions = app::armOptions(options.simulation);
  armOptions.skeleton = view::skeletonFor(model, motions, armOptions.skeleton);
  const MovingArm arm(model, armOptions, motion);
  for (const std::string& warning : arm.poser().warnings()) summary.warn(warning);
  std::optional<MovingArm> ghost;
  if (ghostMotion) ghost.emplace(model, armOptions, *ghostMotion);
  view::TendonForces forces;
  if (options.thicknessByForce) {
    forces = view::tendonForces(model, armOptions, motion, times);
    if (forces.byMuscle.empty()) {
      summary.warn(fmt::format("muscles are drawn with a fixed thickness: {}", forces.whyNone));
    }
  }
  const auto radii = tubeRadii(arm.poser().muscles(), forces, times.size());
  const std::vector<double> ghostRadii(arm.poser().muscles().size(), ghostRadius);

  // All that is ever seen, so that the camera stands still.
  const std::vector<view::BodyShape> bodies = view::bodyShapes(model);
  std::vector<Eigen::Vector3d> outline;
  bool ghostIsSeen = false;
  const Eigen::Index stride = std::max<Eigen::Index>(1, times.size() / 24);
  for (Eigen::Index k = 0; k < times.size(); k += stride) {
    addOutline(bodies, arm.at(times[k], radii[static_cast<std::size_t>(k)]), outline);
    if (ghost && ghost->covers(times[k])) {
      addOutline(bodies, ghost->at(times[k], ghostRadii), outline);
      ghostIsSeen = true;
    }
  }
  if (ghost && !ghostIsSeen) {
    summary.warn(fmt::format("{} has no moment in common with what is shown", options.ghost));
  }
  view::SceneOptions sceneOptions;
  sceneOptions.width = options.width;
  sceneOptions.height = options.height;
  sceneOptions.showWraps = options.showWraps;
  sceneOptions.geometry = options.geometry;
  sceneOptions.floor = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& point : outline) {
    sceneOptions.floor = std::min(sceneOptions.floor, point.y() - 0.03);
    sceneOptions.middle += point / static_cast<double>(outline.size());
  }
  sceneOptions.captions = {
      fmt::format("{} – {}", model.name, std::filesystem::path(options.states).filename().string()),
      forces.byMuscle.empty() ? "Muscles: equal thickness"
                              : "Muscles: 1 mm² more of cross-section per 5 N of tendon force"};
  if (ghost) {
    sceneOptions.captions.push_back(
        fmt::format("Orange: {}", std::filesystem::path(options.ghost).filename().string()));
  }

  const view::VirtualDisplay display;
  view::ArmScene scene(bodies, sceneOptions);
  for (const std::string& warning : scene.warnings()) summary.warn(warning);
  const Eigen::Vector3d direction = view::directionOf(cameraNamed(options.camera), outline);
  const Eigen::Vector3d up =
      options.camera == "top" ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  scene.look(view::fitCamera(outline, direction, up, view::viewAngle,
                             static_cast<double>(options.width) / options.height,
                             view::pictureFrame));
  const auto draw = [&](Eigen::Index k) {
    const double time = times[k];
    const view::ArmPoser::Posture posture = arm.at(time, radii[static_cast<std::size_t>(k)]);
    view::ArmScene::Moment moment{time, &posture, arm.activationsAt(time), nullptr};
    std::optional<view::ArmPoser::Posture> ghostPosture;
    if (ghost && ghost->covers(time)) {
      ghostPosture = ghost->at(time, ghostRadii);
      moment.ghost = &*ghostPosture;
    }
    return scene.draw(moment);
  };
  const auto drawAll = [&](const std::function<void(Eigen::Index, const view::Image&)>& take) {
    ProgressBar bar("render");
    for (Eigen::Index k = 0; k < times.size(); ++k) {
      bar.update(static_cast<double>(k) / static_cast<double>(times.size()));
      take(k, draw(k));
    }
  };

  std::string verdict;
  if (toFilm) {
    folder.writeFile("arm.mp4", [&](const std::filesystem::path& file) {
      view::FilmWriter film(file, options.width, options.height, options.framesPerSecond,
                            context.threads);
      drawAll([&](Eigen::Index, const view::Image& image) { film.add(image); });
      film.finish();
    });
    verdict = fmt::format("A film of {} pictures, {} per second.", times.size(),
                          numberText(options.framesPerSecond));
  } else {
    drawAll([&](Eigen::Index k, const view::Image& image) {
      folder.writeFile(options.film ? frameName(k) : "arm.png",
                       [&](const std::filesystem::path& file) { view::writePng(image, file); });
    });
    verdict = options.film ? fmt::format("{} pictures of a film.", times.size())
                           : fmt::format("A picture at {} s.", numberText(times[0]));
  }
  if (options.film && !toFilm) {
    summary.warn(fmt::format(
        "ffmpeg is not installed; this makes the film of the pictures: ffmpeg -framerate {} -i "
        "{}/frame_%04d.png -pix_fmt yuv420p arm.mp4",
        numberText(options.framesPerSecond), context.out->string()));
  }

  summary.set("pictures", times.size());
  summary.set("first_time_s", times[0]);
  summary.set("last_time_s", times[times.size() - 1]);
  summary.set("width_pixels", options.width);
  summary.set("height_pixels", options.height);
  summary.set("wall_s",
              std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  deliver(context, summary, reportOn(options, motion, arm, verdict), folder);
  return ExitStatus::done;
}

}  // namespace app
