#include "playback/playback.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numbers>

#include "bio/model/units.h"
#include "info/dynamics/linear_table.h"
#include "output/text.h"
#include "playback/packed_frames.h"
#include "playback/played_frames.h"
#include "playback/still_drawing.h"
#include "view/system_shape.h"

namespace app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t mostFrames = 120, fewestFrames = 30;
constexpr double framesPerSecond = 40;
constexpr double mostBytes = 900e3;  // of all motions, in base 64
constexpr double longestGap = 0.25;  // [s] between measurements over which a ghost is shown

/// A body of a mechanism that has no bone is a ball about its mass centre, of water.
void addBalls(const bio::Model& model, std::vector<bio::view::BodyShape>& shapes) {
  if (!model.muscles.empty()) return;
  for (const bio::Body& body : model.bodies) {
    const auto shape = std::find_if(shapes.begin(), shapes.end(),
                                    [&](const auto& one) { return one.name == body.name; });
    if (!(body.mass > 0) || shape == shapes.end() || !shape->bones.empty()) continue;
    const double radius = std::cbrt(3 * body.mass / (4000 * std::numbers::pi));
    shape->joints.emplace_back(body.massCenter, std::clamp(radius, 0.01, 0.1));
  }
}

/// A model as it is drawn.
struct DrawnModel {
  FrameMaker maker;
  std::vector<bio::view::BodyShape> shapes;
  std::size_t index;  ///< in the list of models
};

bool isFree(const bio::MusculoskeletalSystem& system, std::size_t coordinate) {
  return !system.isPrescribed(static_cast<int>(coordinate));
}

/// The time at which a motion was measured around a moment: within a short gap, or as often as it
/// is measured anywhere.
bool isMeasuredAt(const bio::MeasuredChannel& channel, double time) {
  const Eigen::VectorXd& times = channel.times;
  const auto after = std::lower_bound(times.begin(), times.end(), time);
  if (after == times.end()) return false;
  if (*after == time) return true;
  if (after == times.begin()) return false;
  const double usual = (times[times.size() - 1] - times[0]) / static_cast<double>(times.size() - 1);
  return *after - *(after - 1) <= std::max(longestGap, 2 * usual);
}

/// Collects what playback.js reads.
class Maker {
 public:
  Maker(const std::vector<PlayedTrial>& trials, const std::vector<std::string>& wrapAsCylinder,
        std::size_t numTrials)
      : wrapAsCylinder_(wrapAsCylinder) {
    for (const PlayedTrial& trial : trials) {
      PlayedTrial moving{trial.name, trial.trial, {}};
      for (const PlayedMotion& one : trial.motions)
        if (one.motion.time.size() > 1) moving.motions.push_back(one);
      if (moving.motions.empty()) continue;
      ++numTrials_;
      if (trials_.size() < mostPlayedTrials) trials_.push_back(std::move(moving));
    }
    numTrials_ = std::max(numTrials_, numTrials);
  }

  std::optional<Playback> make(const std::string& title) {
    if (trials_.empty()) return {};
    const PlayedMotion& first = trials_.front().motions.front();
    const std::vector<bio::view::BodyShape>& shapes = drawn(first).shapes;
    if (std::none_of(shapes.begin(), shapes.end(), [](const bio::view::BodyShape& body) {
          return !body.bones.empty() || !body.joints.empty();
        })) {
      return {};
    }
    const std::size_t count = chooseFrames();
    Json trials = Json::array();
    for (const PlayedTrial& trial : trials_) trials.push_back(trialJson(trial, count));
    const Viewpoint viewpoint = viewpointOf(firstFrames_, first.model.gravity);
    const double largest = std::max(0.05, std::ceil(20 * largest_) / 20);
    const std::string description = describe(first);
    Playback playback{.title = title, .caption = caption(largest)};
    playback.still = stillDrawing(firstFrames_[firstFrames_.size() / 3], shapes, viewpoint, largest,
                                  description);
    playback.data = {{"up", {viewpoint.up.x(), viewpoint.up.y(), viewpoint.up.z()}},
                     {"view", viewpoint.isFront ? "front" : "side"},
                     {"largest", hasMuscles_ ? largest : 0},
                     {"hasWraps", hasWraps_},
                     {"description", description},
                     {"models", modelsJson_},
                     {"trials", trials}};
    return playback;
  }

 private:
  const DrawnModel& drawn(const PlayedMotion& motion) {
    std::unique_ptr<DrawnModel>& model = models_[&motion.system];
    if (model) return *model;
    model = std::make_unique<DrawnModel>(
        DrawnModel{FrameMaker(motion.model, motion.system, wrapAsCylinder_),
                   bio::view::bodyShapes(motion.model), modelsJson_.size()});
    addBalls(motion.model, model->shapes);
    Json numbers = Json::array();
    for (const double x : bio::view::shapeNumbers(model->shapes))
      numbers.push_back(std::isfinite(x) ? Json(numberIn(fmt::format("{:.5g}", x))) : Json(0));
    modelsJson_.push_back({{"bodies", model->shapes.size()}, {"shapes", numbers}});
    for (const bio::view::BodyShape& body : model->shapes)
      hasWraps_ = hasWraps_ || !body.wraps.empty();
    return *model;
  }

  std::vector<PlayedFrame> framesOf(const PlayedMotion& one, std::size_t count) {
    return drawn(one).maker.frames(one.motion, evenRows(one.motion.time, count));
  }

  /// As many frames of each motion as fit; drops trials that do not.
  std::size_t chooseFrames() {
    double bytes = 0, longest = 0;  // of a frame of each motion in base 64
    for (std::size_t t = 0; t < trials_.size(); ++t) {
      double more = 0;
      for (const PlayedMotion& one : trials_[t].motions) {
        more += static_cast<double>(
            packedFrames(framesOf(one, 1))["data"].get_ref<const std::string&>().size());
        longest = std::max(longest, one.motion.time.back() - one.motion.time.front());
      }
      if (t > 0 && (bytes + more) * fewestFrames > mostBytes) {
        trials_.erase(trials_.begin() + static_cast<std::ptrdiff_t>(t), trials_.end());
        break;
      }
      bytes += more;
    }
    const double wanted = std::clamp(framesPerSecond * longest, 2.0, double{mostFrames});
    return static_cast<std::size_t>(std::max(2.0, std::min(wanted, mostBytes / bytes)));
  }

  Json trialJson(const PlayedTrial& trial, std::size_t count) {
    Json motions = Json::array();
    double start = infinity_, end = -infinity_;
    for (const PlayedMotion& one : trial.motions) {
      std::vector<PlayedFrame> frames = framesOf(one, count);
      for (const PlayedFrame& frame : frames) {
        for (const PlayedLine& line : frame.lines) {
          if (std::isnan(line.activation)) {
            hasGrey_ = hasGrey_ || !line.points.empty();
            continue;
          }
          hasMuscles_ = true;
          largest_ = std::max(largest_, line.activation);
        }
      }
      start = std::min(start, frames.front().time);
      end = std::max(end, frames.back().time);
      Json json = packedFrames(frames);
      json["name"] = one.name;
      json["model"] = drawn(one).index;
      json["isGhost"] = false;
      motions.push_back(std::move(json));
      if (firstFrames_.empty()) firstFrames_ = std::move(frames);
    }
    if (auto ghost = ghostOf(trial, count)) motions.push_back(*std::move(ghost));
    return {{"name", trial.name}, {"start", start}, {"end", end}, {"motions", motions}};
  }

  /// The measured posture at the rows of the first motion.
  std::optional<Json> ghostOf(const PlayedTrial& trial, std::size_t count) {
    const PlayedMotion& one = trial.motions.front();
    const auto& coordinates = one.system.skeleton().coordinates();
    bool isAnyFree = false;
    for (std::size_t i = 0; i < coordinates.size(); ++i)
      isAnyFree = isAnyFree || isFree(one.system, i);
    if (trial.trial == nullptr || !isAnyFree) return {};
    const std::vector<std::string> lacking = unmeasuredCoordinates(one.system, *trial.trial);
    if (!lacking.empty()) {
      if (lacking.size() < coordinates.size()) unmeasured_ = lacking;
      return {};
    }
    std::vector<PlayedFrame> frames;
    for (const std::size_t row : evenRows(one.motion.time, count)) {
      PlayedFrame& frame = frames.emplace_back();
      frame.time = one.motion.time[row];
      Eigen::VectorXd q = one.motion.q.col(static_cast<Eigen::Index>(row));
      bool isKnown = true;
      for (std::size_t i = 0; i < coordinates.size(); ++i) {
        if (!isFree(one.system, i)) continue;
        const auto* channel = trial.trial->measurementOf(bio::ofCoordinate(coordinates[i].name));
        isKnown = isKnown && isMeasuredAt(*channel, frame.time);
        if (isKnown)
          q[static_cast<Eigen::Index>(i)] =
              info::linearAt(channel->times, frame.time).value(channel->values);
      }
      if (isKnown) frame.bodies = drawn(one).maker.bodiesAt(q);
    }
    const bool isAnyKnown = std::any_of(frames.begin(), frames.end(),
                                        [](const auto& frame) { return !frame.bodies.empty(); });
    if (!isAnyKnown) return {};
    Json json = packedFrames(frames);
    json["name"] = "measured";
    json["model"] = drawn(one).index;
    json["isGhost"] = true;
    hasGhost_ = true;
    return json;
  }

  /// "elbow_flexion from 12 to 105 deg": what moves most.
  static std::string describe(const PlayedMotion& one) {
    struct Range {
      double span;
      std::string text;
    };
    std::vector<Range> ranges;
    const auto& coordinates = one.system.skeleton().coordinates();
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      const auto row = one.motion.q.row(static_cast<Eigen::Index>(i));
      const bio::ShownUnit unit = bio::positionUnit(coordinates[i].isRotation);
      const double low = row.minCoeff(), high = row.maxCoeff();
      ranges.push_back({high - low, fmt::format("{} between {} and {}", coordinates[i].name,
                                                numberText(unit.factor * low, 3),
                                                withUnit(unit.factor * high, unit.name, 3))});
    }
    std::stable_sort(ranges.begin(), ranges.end(),
                     [](const Range& a, const Range& b) { return a.span > b.span; });
    std::string text;
    for (std::size_t i = 0; i < ranges.size() && i < 5; ++i)
      text += (i ? "; " : "") + ranges[i].text;
    const std::vector<double>& times = one.motion.time;
    return fmt::format("The motion from {} to {}: {}{}.", numberText(times.front(), 3),
                       withUnit(times.back(), "s", 3), text,
                       ranges.size() > 5 ? "; and others" : "");
  }

  std::string caption(double largest) const {
    std::string text;
    if (hasMuscles_)
      text += fmt::format(
          "Muscles are coloured by activation, from 0 to {:.2f}, and thicker where the tendon "
          "force is larger. ",
          largest);
    if (hasGrey_)
      text +=
          "What is grey has no activation: muscles that no free coordinate moves, ligaments and "
          "springs. ";
    if (hasGhost_)
      text += "The translucent ghost is the measured posture; where it is not seen, both agree. ";
    if (!unmeasured_.empty()) {
      text +=
          "There is no ghost of the measured posture, since not every free coordinate was "
          "measured: ";
      for (std::size_t i = 0; i < unmeasured_.size() && i < 3; ++i)
        text += (i ? ", " : "") + unmeasured_[i];
      if (unmeasured_.size() > 3) text += fmt::format(" and {} others", unmeasured_.size() - 3);
      text += ". ";
    }
    if (trials_.size() < numTrials_)
      text += fmt::format("Only the first {} of {} trials are here. ", trials_.size(), numTrials_);
    return text + fmt::format("{} moments are drawn exactly, those between them interpolated.",
                              firstFrames_.size());
  }

  static constexpr double infinity_ = std::numeric_limits<double>::infinity();
  const std::vector<std::string>& wrapAsCylinder_;
  std::vector<PlayedTrial> trials_;  ///< with motions that move
  std::size_t numTrials_ = 0;
  std::map<const bio::MusculoskeletalSystem*, std::unique_ptr<DrawnModel>> models_;
  Json modelsJson_ = Json::array();
  bool hasMuscles_ = false, hasGrey_ = false, hasWraps_ = false, hasGhost_ = false;
  std::vector<std::string> unmeasured_;
  double largest_ = 0;
  std::vector<PlayedFrame> firstFrames_;  ///< of the motion shown first
};

}  // namespace

std::vector<std::string> unmeasuredCoordinates(const bio::MusculoskeletalSystem& system,
                                               const bio::Trial& trial) {
  std::vector<std::string> names;
  const auto& coordinates = system.skeleton().coordinates();
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (!isFree(system, i)) continue;
    const auto* channel = trial.measurementOf(bio::ofCoordinate(coordinates[i].name));
    if (channel == nullptr || channel->times.size() < 2) names.push_back(coordinates[i].name);
  }
  return names;
}

std::optional<Playback> playbackOf(const std::string& title, const std::vector<PlayedTrial>& trials,
                                   const std::vector<std::string>& wrapAsCylinder,
                                   std::size_t numTrials) {
  return Maker(trials, wrapAsCylinder, numTrials).make(title);
}

}  // namespace app
