#include "render/render_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "bio/model/units.h"
#include "bio/skeleton/free_coordinates.h"
#include "options/set_parameters.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/progress_bar.h"
#include "output/text.h"
#include "render/moving_system.h"
#include "report/result.h"
#include "view/system_scene.h"
#include "view/virtual_display.h"

namespace app {
namespace {

namespace view = bio::view;

constexpr double fixedRadius = 0.004;   // [m]
constexpr double ghostRadius = 0.0022;  // [m]: hidden where both motions coincide

view::Camera cameraNamed(const std::string& name) {
  if (name == "side") return view::Camera::side;
  if (name == "front") return view::Camera::front;
  if (name == "top") return view::Camera::top;
  if (name == "isometric") return view::Camera::isometric;
  return view::Camera::fit;
}

/// The moments that are shown [s].
Eigen::VectorXd shownTimes(const RenderOptions& options, const view::SystemMotion& motion) {
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
    throw std::invalid_argument(fmt::format("{}: {} s are {} frames, must be 2 to {}",
                                            options.states, numberText(last - first),
                                            numberText(count, 8), numberText(most, 8)));
  }
  const auto n = static_cast<Eigen::Index>(count);
  return first + Eigen::VectorXd::LinSpaced(n, 0, count - 1).array() / options.framesPerSecond;
}

/// Radii of the tubes, by moment and muscle [m].
std::vector<std::vector<double>> tubeRadii(const std::vector<std::string>& muscles,
                                           const view::TendonForces& forces, Eigen::Index count) {
  std::vector<std::vector<double>> radii(static_cast<std::size_t>(count));
  for (Eigen::Index k = 0; k < count; ++k) {
    for (const std::string& muscle : muscles) {
      const auto found = forces.byMuscle.find(muscle);
      const double force = found == forces.byMuscle.end() ? 0 : found->second[k];
      radii[static_cast<std::size_t>(k)].push_back(
          forces.byMuscle.empty() ? fixedRadius : view::tubeRadius(force));
    }
  }
  return radii;
}

Report reportOn(const RenderOptions& options, const MovingSystem& system,
                const std::string& verdict) {
  const view::SystemMotion& motion = system.motion();
  Report report;
  report.title = options.states.empty() ? fmt::format("Posture of {}", options.model)
                                        : fmt::format("{} on {}", options.states, options.model);
  report.verdict = verdict;
  Figure shown{.title = "Activations (colour of the muscles)",
               .xLabel = "Time [s]",
               .yLabel = "Activation [1]"};
  const std::vector<double> times(motion.time.begin(), motion.time.end());
  for (const auto& [muscle, values] : motion.activations) {
    shown.series.push_back({.name = muscle, .x = times, .y = {values.begin(), values.end()}});
  }
  if (!shown.series.empty()) report.details.push_back(shown);
  for (const bio::Coordinate& coordinate : system.poser().skeleton().coordinates()) {
    const auto found = motion.coordinates.find(coordinate.name);
    if (found == motion.coordinates.end()) continue;
    const bio::ShownUnit unit = bio::positionUnit(coordinate.isRotation);
    const Eigen::VectorXd values = found->second * unit.factor;
    report.details.push_back(Figure{
        .title = coordinate.name,
        .xLabel = "Time [s]",
        .yLabel = fmt::format("{} [{}]", coordinate.name, unit.name),
        .series = {{.name = coordinate.name, .x = times, .y = {values.begin(), values.end()}}}});
  }
  return report;
}

std::string frameName(Eigen::Index k) {
  return fmt::format("frame_{:04}.png", k + 1);
}

/// The model options that concern this model: a ghost may have neither coordinate nor wrap of the
/// name.
bio::SystemOptions ghostOptions(const bio::Model& model, const SimulationOptions& simulation) {
  SimulationOptions known = simulation;
  std::erase_if(known.locks, [&](const Assignment& lock) {
    return std::none_of(model.joints.begin(), model.joints.end(), [&](const bio::Joint& joint) {
      return std::any_of(joint.coordinates.begin(), joint.coordinates.end(),
                         [&](const bio::Coordinate& c) { return c.name == lock.name; });
    });
  });
  std::erase_if(known.wrapAsCylinder, [&](const std::string& name) {
    return std::none_of(model.wrapObjects.begin(), model.wrapObjects.end(),
                        [&](const bio::WrapObject& wrap) { return wrap.name == name; });
  });
  return systemOptions(known);
}

/// All that is to be drawn.
struct Shown {
  Eigen::VectorXd times;                   ///< [s]
  std::optional<MovingSystem> system;      ///< never empty once read
  std::vector<std::vector<double>> radii;  ///< of its muscles, by moment [m]
  bool thicknessIsForce = false;
  double largestActivation = 1;
  std::optional<MovingSystem> ghost;
  std::vector<double> ghostRadii;
  std::string ghostCaption;
};

/// One posture as a motion: the values of --lock, else the model's defaults.
view::SystemMotion postureOf(const bio::Model& model, const SimulationOptions& options) {
  view::SystemMotion motion;
  motion.time = Eigen::VectorXd::Zero(1);
  for (const auto& [name, value] : byName(options.locks)) {
    (void)bio::findCoordinate(model, name);
    motion.coordinates[name] = Eigen::VectorXd::Constant(1, value);
  }
  return motion;
}

/// The largest activation that occurs, rounded up to twentieths; 1 if none is known.
double largestActivation(const view::SystemMotion& motion) {
  double largest = 0;
  for (const auto& [muscle, values] : motion.activations)
    largest = std::max(largest, values.maxCoeff());
  return motion.activations.empty() ? 1 : std::clamp(std::ceil(20 * largest) / 20, 0.05, 1.0);
}

Shown readShown(const RenderOptions& options, Summary& summary) {
  Shown shown;
  const bio::Model model =
      withSetInWholeModel(readModel(options.model, summary), options.simulation, summary);
  const bool isPosture = options.states.empty();
  if (!isPosture) summary.addInput(options.states);
  view::SystemMotion motion =
      isPosture ? postureOf(model, options.simulation)
                : view::readSystemMotion(options.states, model, options.ignoreExtra);
  shown.times = isPosture ? motion.time : shownTimes(options, motion);
  shown.largestActivation = options.largestActivation.value_or(largestActivation(motion));
  std::vector<const view::SystemMotion*> motions = {&motion};

  bio::Model otherModel;
  view::SystemMotion ghostMotion;
  const bool hasGhost = !options.ghost.empty(), isOther = !options.ghostModel.empty();
  if (hasGhost) {
    if (isOther) otherModel = readModel(options.ghostModel, summary);
    summary.addInput(options.ghost);
    ghostMotion =
        view::readSystemMotion(options.ghost, isOther ? otherModel : model, options.ignoreExtra);
    if (!isOther) motions.push_back(&ghostMotion);
    shown.ghostCaption =
        fmt::format("Orange: {}{}", std::filesystem::path(options.ghost).filename().string(),
                    isOther ? " on " + otherModel.name : "");
  }

  bio::SystemOptions systemOptions = app::systemOptions(options.simulation);
  systemOptions.skeleton = view::skeletonFor(model, motions, systemOptions.skeleton);
  if (isPosture) {
    systemOptions.skeleton.freeCoordinates = bio::freeByDefault(model, {}, {});
    for (const std::string& name : systemOptions.skeleton.freeCoordinates)
      systemOptions.skeleton.lockedValues.erase(name);  // it is in the motion
  }
  view::TendonForces forces;
  if (options.thicknessByForce && !isPosture) {
    forces = view::tendonForces(model, systemOptions, motion, shown.times);
    if (forces.byMuscle.empty()) {
      summary.warn(fmt::format("muscles are drawn with a fixed thickness: {}", forces.whyNone));
    }
  }
  shown.thicknessIsForce = !forces.byMuscle.empty();
  shown.system.emplace(model, systemOptions, std::move(motion));
  for (const std::string& warning : shown.system->poser().warnings()) summary.warn(warning);
  shown.radii = tubeRadii(shown.system->poser().muscles(), forces, shown.times.size());
  if (hasGhost) {
    if (isOther) {
      systemOptions = ghostOptions(otherModel, options.simulation);
      systemOptions.skeleton =
          view::skeletonFor(otherModel, {&ghostMotion}, systemOptions.skeleton);
    }
    shown.ghost.emplace(isOther ? otherModel : model, systemOptions, std::move(ghostMotion));
    shown.ghostRadii.assign(shown.ghost->poser().muscles().size(), ghostRadius);
    if (isOther) {
      for (const std::string& warning : shown.ghost->poser().warnings()) summary.warn(warning);
    }
  }
  return shown;
}

/// All that is ever seen, so that the camera stands still [m].
std::vector<Eigen::Vector3d> outlineOf(const Shown& shown, bool& ghostIsSeen) {
  std::vector<Eigen::Vector3d> outline;
  const Eigen::Index stride = std::max<Eigen::Index>(1, shown.times.size() / 24);
  for (Eigen::Index k = 0; k < shown.times.size(); k += stride) {
    const double time = shown.times[k];
    shown.system->addOutline(shown.system->at(time, shown.radii[static_cast<std::size_t>(k)]),
                             outline);
    if (shown.ghost && shown.ghost->covers(time)) {
      shown.ghost->addOutline(shown.ghost->at(time, shown.ghostRadii), outline);
      ghostIsSeen = true;
    }
  }
  return outline;
}

/// Why muscles are grey, for the caption; empty if none is.
std::string greyMuscles(const MovingSystem& system, const std::string& file) {
  const std::vector<std::string>& all = system.poser().muscles();
  const auto grey = std::count_if(all.begin(), all.end(), [&](const std::string& muscle) {
    return !system.motion().activations.contains(muscle);
  });
  if (grey == 0) return "";
  if (file.empty()) return "; grey: a posture has no activations";
  const bool areAll = grey == static_cast<std::ptrdiff_t>(all.size());
  return fmt::format("; grey{}: no activation in {}",
                     areAll ? "" : fmt::format(" ({} of {})", grey, all.size()), file);
}

view::SceneOptions sceneOptions(const RenderOptions& options, const Shown& shown,
                                const std::vector<Eigen::Vector3d>& outline) {
  view::SceneOptions scene;
  scene.width = options.width;
  scene.height = options.height;
  scene.showWraps = options.showWraps;
  scene.geometry = options.geometry;
  scene.floor = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& point : outline) {
    scene.floor = std::min(scene.floor, point.y() - 0.03);
    scene.middle += point / static_cast<double>(outline.size());
  }
  scene.largestActivation = shown.largestActivation;
  scene.showsActivations = !shown.system->motion().activations.empty();
  scene.showsTime = !options.states.empty();
  const std::string file = std::filesystem::path(options.states).filename().string();
  scene.captions = {
      fmt::format("{} – {}", shown.system->modelName(), file.empty() ? "posture" : file),
      fmt::format("Muscles: {}{}",
                  shown.thicknessIsForce ? "cross-section grows by 1 mm² per 5 N of tendon force"
                                         : "equal thickness",
                  greyMuscles(*shown.system, file))};
  if (shown.ghost) scene.captions.push_back(shown.ghostCaption);
  return scene;
}

}  // namespace

ExitStatus drawPictures(const RenderOptions& options, const CommandContext& context) {
  const auto begin = std::chrono::steady_clock::now();
  const bool toFilm = options.film && view::FilmWriter::available();
  OutputFolder folder(context, {!options.film ? "picture.png"
                                : toFilm      ? "film.mp4"
                                              : frameName(0)});
  Summary summary(context);
  const Shown shown = readShown(options, summary);
  const Eigen::VectorXd& times = shown.times;
  bool ghostIsSeen = false;
  const std::vector<Eigen::Vector3d> outline = outlineOf(shown, ghostIsSeen);
  if (shown.ghost && !ghostIsSeen) {
    summary.warn(fmt::format("{} has no time in common with the motion shown", options.ghost));
  }

  const view::VirtualDisplay display;
  view::SystemScene scene(shown.system->bodies(),
                          shown.ghost ? shown.ghost->bodies() : std::vector<view::BodyShape>{},
                          sceneOptions(options, shown, outline));
  for (const std::string& warning : scene.warnings()) summary.warn(warning);
  const Eigen::Vector3d direction = view::directionOf(cameraNamed(options.camera), outline);
  const Eigen::Vector3d up =
      options.camera == "top" ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  scene.look(view::fitCamera(outline, direction, up, view::cameraViewAngle,
                             static_cast<double>(options.width) / options.height,
                             view::pictureFrame));
  const auto draw = [&](Eigen::Index k) {
    const double time = times[k];
    const view::SystemPoser::Posture posture =
        shown.system->at(time, shown.radii[static_cast<std::size_t>(k)]);
    view::SystemScene::Moment moment{time, &posture, shown.system->activationsAt(time), nullptr};
    std::optional<view::SystemPoser::Posture> ghostPosture;
    if (shown.ghost && shown.ghost->covers(time)) {
      ghostPosture = shown.ghost->at(time, shown.ghostRadii);
      moment.ghost = &*ghostPosture;
    }
    return scene.draw(moment);
  };
  Picture embedded{.title = toFilm || options.film ? "Middle of the film" : "Model"};
  const auto drawAll = [&](const std::function<void(Eigen::Index, const view::Image&)>& take) {
    ProgressBar bar("render");
    for (Eigen::Index k = 0; k < times.size(); ++k) {
      bar.update(static_cast<double>(k) / static_cast<double>(times.size()));
      const view::Image image = draw(k);
      take(k, image);
      if (k != times.size() / 2) continue;
      embedded.png = view::pngOf(image);
      if (!options.states.empty()) embedded.caption = fmt::format("t = {} s", numberText(times[k]));
    }
  };

  std::string verdict;
  if (toFilm) {
    folder.writeFile("film.mp4", [&](const std::filesystem::path& file) {
      view::FilmWriter film(file, options.width, options.height, options.framesPerSecond,
                            context.threads);
      drawAll([&](Eigen::Index, const view::Image& image) { film.add(image); });
      film.finish();
    });
    verdict = fmt::format("A film of {} frames, {} per second.", times.size(),
                          numberText(options.framesPerSecond));
  } else {
    drawAll([&](Eigen::Index k, const view::Image& image) {
      folder.write(options.film ? frameName(k) : "picture.png",
                   [&](std::ostream& out) { out << view::pngOf(image); });
    });
    verdict = options.film             ? fmt::format("{} frames of a film.", times.size())
              : options.states.empty() ? std::string("A picture of one posture.")
                                       : fmt::format("A picture at {} s.", numberText(times[0]));
  }
  if (options.film && !toFilm) {
    summary.warn(
        fmt::format("ffmpeg is not installed; this command makes the film from the frames: ffmpeg "
                    "-framerate {} -i {}/frame_%04d.png -pix_fmt yuv420p film.mp4",
                    numberText(options.framesPerSecond), context.out->string()));
  }

  summary.set("pictures", times.size());
  summary.set("first_time_s", times[0]);
  summary.set("last_time_s", times[times.size() - 1]);
  summary.set("width_pixels", options.width);
  summary.set("height_pixels", options.height);
  summary.set("wall_s",
              std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  Report report = reportOn(options, *shown.system, verdict);
  report.mainPicture = std::move(embedded);
  deliver(context, summary, report, folder);
  return ExitStatus::done;
}

}  // namespace app
