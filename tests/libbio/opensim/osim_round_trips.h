#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "bio/opensim/osim_file.h"
#include "support/scratch_folder.h"

/// What writing a model back and reading it again must leave as it was, for any document.
namespace osim_round_trips {

using bio::Model;
using bio::readOsim;
using bio::rewriteOsim;
using File = std::filesystem::path;

/// Number of XML elements called `tag` in the text.
inline std::size_t countTag(const std::string& text, const std::string& tag) {
  std::size_t count = 0;
  for (auto at = text.find("<" + tag); at != std::string::npos; at = text.find("<" + tag, at + 1)) {
    const char after = text[at + 1 + tag.size()];
    if (after == ' ' || after == '>' || after == '/') ++count;
  }
  return count;
}

inline void writesTheSameFile(const File& file) {
  const support::ScratchFolder folder;
  const Model model = readOsim(file);
  rewriteOsim(file, model, folder / "copy.osim");
  EXPECT_EQ(support::contentOf(folder / "copy.osim"), support::contentOf(file)) << file;
  EXPECT_EQ(readOsim(folder / "copy.osim"), model) << file;
}

inline void leavesAllElseAsItWas(const File& file) {
  const support::ScratchFolder folder;
  Model model = readOsim(file);
  model.bodies.back().mass *= 1.25;
  rewriteOsim(file, model, folder / "copy.osim");
  EXPECT_EQ(readOsim(folder / "copy.osim"), model) << file;
  EXPECT_NE(readOsim(file), model) << file;
  // What FisherHill does not know is still there, as often as before.
  const std::string before = support::contentOf(file),
                    after = support::contentOf(folder / "copy.osim");
  for (const char* tag : {"Appearance", "ControlLinear", "Ligament", "mesh_file", "VisibleObject",
                          "FrameGeometry", "TransformAxis", "prescribed_function", "Marker"}) {
    EXPECT_EQ(countTag(after, tag), countTag(before, tag)) << file << " " << tag;
  }
  EXPECT_EQ(countTag(after, "!--"), countTag(before, "!--")) << file;
}

template <class Items, class Which>
auto* firstWhere(Items& items, Which which) {
  const auto found = std::find_if(items.begin(), items.end(), which);
  return found == items.end() ? nullptr : &*found;
}

inline void changeWrapObjects(Model& model) {
  using bio::WrapObject, bio::WrapShape;
  const auto is = [](WrapShape shape) {
    return [shape](const WrapObject& w) { return w.shape == shape; };
  };
  WrapObject* cylinder = firstWhere(model.wrapObjects, is(WrapShape::cylinder));
  ASSERT_NE(cylinder, nullptr);
  cylinder->radius = 0.0171;
  cylinder->frame.translation.x() = 0.003;
  if (WrapObject* ellipsoid = firstWhere(model.wrapObjects, is(WrapShape::ellipsoid))) {
    ellipsoid->shape = WrapShape::cylinder;
    ellipsoid->radius = ellipsoid->semiAxes.x();
    ellipsoid->length = 0.2;
    ellipsoid->semiAxes.setZero();
  }
}

/// One change of every kind: the model's own numbers, a body, the coordinate, wrap objects, muscles
/// (one of which is Schutte's and wraps, one has a conditional point), forces, what was fitted.
inline void changeEverything(Model& model, const std::string& coordinate) {
  model.name = "changed";
  model.credits = "someone <else>";
  model.gravity = {0, -9.7, 0};
  model.bodies.back().inertia = {0.0021, 0.0022, 0.0023, 1e-5, -7.5e-5, 2e-5};
  model.bodies.back().massCenter.y() = -0.05;
  bool found = false;
  for (bio::Joint& joint : model.joints) {
    for (bio::Coordinate& c : joint.coordinates) {
      if (c.name != coordinate) continue;
      c.locked = true, c.defaultValue = 0.7, c.rangeMax = 2.3;
      found = true;
    }
  }
  ASSERT_TRUE(found) << coordinate;
  changeWrapObjects(model);
  bio::Muscle* muscle = firstWhere(
      model.muscles, [](const bio::Muscle& m) { return m.schutte && !m.path.wraps.empty(); });
  ASSERT_NE(muscle, nullptr);
  muscle->schutte->tendonSlackLength = 0.15;
  muscle->schutte->activeForceLength.y.front() = 0.01;
  muscle->path.points[1].location.z() = 0.01;
  muscle->path.wraps[0].firstPoint = 1;
  bio::PathPoint* conditional = nullptr;
  for (bio::Muscle& m : model.muscles) {
    for (bio::PathPoint& point : m.path.points) {
      if (point.condition) conditional = &point;
    }
  }
  ASSERT_NE(conditional, nullptr);
  conditional->condition->upper = 0.8;
  model.muscles.back().enabled = false;
  model.limitForces.push_back({"new_stop", coordinate, 2, 100, 0.1, 50, 0.2, 0.3, true});
  model.springForces.push_back({"new_spring", coordinate, 1.5, 0.4, 0.2, true});
  model.expressionForces.push_back({"new_push", coordinate, "-0.1*q*q<2", false});
  model.fitted = {0.005, {{"curl.sto", std::string(64, 'c'), coordinate, 0.6, 0.1}}};
}

inline void writesEveryKindOfChange(const File& file, const std::string& coordinate) {
  const support::ScratchFolder folder;
  Model model = readOsim(file);
  const std::size_t springs = model.springForces.size();
  changeEverything(model, coordinate);
  rewriteOsim(file, model, folder / "copy.osim");
  Model again = readOsim(folder / "copy.osim");

  // Degrees and radians round differently in the last digit; all else is exact.
  bio::CoordinateLimitForce& stop = again.limitForces.back();
  EXPECT_EQ(stop.name, "new_stop");
  EXPECT_NEAR(stop.upperLimit, 2, 1e-15);
  EXPECT_NEAR(stop.upperStiffness, 100, 1e-12);
  EXPECT_NEAR(stop.damping, 0.2, 1e-15);
  stop = model.limitForces.back();
  // Rewriting a curve drops a point that was there twice, and so the remark on it.
  again.remarks = model.remarks;
  EXPECT_EQ(again, model) << file;

  // Taking the three forces away again leaves none of them behind.
  model.limitForces.pop_back();
  model.springForces.pop_back();
  model.expressionForces.pop_back();
  rewriteOsim(folder / "copy.osim", model, folder / "copy.osim");
  const std::string text = support::contentOf(folder / "copy.osim");
  EXPECT_EQ(countTag(text, "SpringGeneralizedForce"), springs);
  EXPECT_EQ(text.find("new_"), std::string::npos);
  EXPECT_EQ(readOsim(folder / "copy.osim").limitForces.size(), model.limitForces.size());
}

inline void aFreshDocumentSaysTheSame(const File& file) {
  const support::ScratchFolder folder;
  const Model model = readOsim(file);
  writeOsim(model, folder / "fresh.osim");
  Model again = readOsim(folder / "fresh.osim");
  ASSERT_EQ(again.limitForces.size(), model.limitForces.size());
  for (std::size_t i = 0; i < again.limitForces.size(); ++i) {
    EXPECT_NEAR(again.limitForces[i].upperStiffness / model.limitForces[i].upperStiffness, 1,
                1e-14);
    EXPECT_NEAR(again.limitForces[i].transition / model.limitForces[i].transition, 1, 1e-14);
  }
  again.limitForces = model.limitForces;
  again.remarks = model.remarks;
  EXPECT_EQ(again, model) << file;
}

}  // namespace osim_round_trips
