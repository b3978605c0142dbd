#pragma once

#include <cmath>
#include <random>
#include <string>

#include "support/arm_models.h"

namespace bio::fixtures {

/// Makes trees of any size with every kind of joint motion: free, pin, ball by three oblique turns,
/// slider, planar, universal, a knee whose one coordinate shifts, turns and rolls by splines and a
/// polynomial, and a coupled pin. Oblique frames on both sides; always the same for one seed.
class TreeModelMaker {
 public:
  explicit TreeModelMaker(unsigned seed) : random_(seed) { model_.name = "made tree"; }

  enum class Kind { free, pin, ball, slider, planar, universal, knee, coupled, weld };

  /// Hangs a body by a joint on a body made before; returns the body's name.
  std::string add(const std::string& parent, Kind kind) {
    const std::string tag = std::to_string(model_.bodies.size());
    Body b = body("body" + tag, 0.5 + 2 * unit(), {0.1 * unit(), -0.2 * unit(), 0.1 * unit()});
    model_.bodies.push_back(b);
    Joint joint;
    joint.name = "joint" + tag;
    joint.parentBody = parent;
    joint.childBody = b.name;
    joint.parentFrame = {vector(0.15), vector(0.6)};
    joint.childFrame = {vector(0.1), vector(0.5)};
    switch (kind) {
      case Kind::weld:
        break;
      case Kind::pin:
      case Kind::slider:
        joint.kind = kind == Kind::pin ? JointKind::pin : JointKind::slider;
        joint.coordinates = {coordinate("q" + tag, 0.3)};
        break;
      case Kind::coupled:
        joint.kind = JointKind::pin;
        joint.coordinates = {coordinate("follow" + tag)};
        model_.couplers.push_back(
            {"coupler" + tag, lastCoordinate(), "follow" + tag,
             Function{0.9, SplineFunction{{-3, -1, 0, 1, 3}, {-1, -0.5, 0.1, 0.8, 1.1}}}});
        break;
      case Kind::free:
        straight(joint, tag, {0, 1, 2, 3, 4, 5});
        break;
      case Kind::ball:
        straight(joint, tag, {0, 1, 2});
        for (std::size_t i = 0; i < 3; ++i) joint.axes[i].axis += vector(0.3);
        break;
      case Kind::planar:
        straight(joint, tag, {2, 3, 4});
        break;
      case Kind::universal:
        straight(joint, tag, {0, 1});
        break;
      case Kind::knee:
        straight(joint, tag, {});
        knee(joint, "q" + tag);
        break;
    }
    model_.joints.push_back(joint);
    return b.name;
  }

  const Model& model() const { return model_; }

 private:
  double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  Eigen::Vector3d vector(double size) {
    return size * Eigen::Vector3d(2 * unit() - 1, 2 * unit() - 1, 2 * unit() - 1);
  }
  /// The independent coordinate made last.
  std::string lastCoordinate() const {
    for (auto joint = model_.joints.rbegin(); joint != model_.joints.rend(); ++joint) {
      if (joint->coordinates.empty()) continue;
      if (joint->coordinates.back().name.front() == 'q') return joint->coordinates.back().name;
    }
    return {};
  }
  /// A custom joint whose chosen axes move by coordinates of their own; the others are constant.
  static void straight(Joint& joint, const std::string& tag, std::initializer_list<int> moving) {
    joint.kind = JointKind::custom;
    for (int i = 0; i < 6; ++i) {
      auto& axis = joint.axes[static_cast<std::size_t>(i)];
      axis.axis = Eigen::Vector3d::Unit(i % 3);
      axis.function = Function{1, ConstantFunction{i == 4 ? 0.02 : 0}};
    }
    for (const int i : moving) {
      Coordinate c = coordinate("q" + tag + std::string(1, static_cast<char>('a' + i)), 0.2);
      c.isRotation = i < 3;
      joint.coordinates.push_back(c);
      joint.axes[static_cast<std::size_t>(i)].coordinate = c.name;
      joint.axes[static_cast<std::size_t>(i)].function = Function{1, LinearFunction{1, 0}};
    }
  }
  void knee(Joint& joint, const std::string& name) {
    joint.coordinates = {coordinate(name, 0.4)};
    const auto spline = [&](double size) {
      SplineFunction f{{-3, -1.7, -0.6, 0.5, 1.4, 3}, {}};
      for (std::size_t i = 0; i < f.x.size(); ++i) f.y.push_back(size * (2 * unit() - 1));
      return f;
    };
    joint.axes[0] = {name, {0.1, -0.2, 0.95}, Function{1.1, LinearFunction{-0.9, 0.1}}};
    joint.axes[1] = {name, {0.9, 0.2, 0.1}, Function{1, PolynomialFunction{{0.1, -0.2, 0.3, 0}}}};
    joint.axes[2] = {name, {0, 1, 0}, Function{0.5, spline(0.4)}};
    joint.axes[3] = {name, {1, 0, 0}, Function{1, spline(0.03)}};
    joint.axes[4] = {name, {0, 1, 0}, Function{2, spline(0.02)}};
  }

  Model model_;
  std::mt19937 random_;
};

/// A serial chain of 7 coordinates, like an arm on a fixed trunk.
inline Model chainOfSeven() {
  using Kind = TreeModelMaker::Kind;
  TreeModelMaker made(7);
  std::string at = made.add("ground", Kind::ball);
  at = made.add(at, Kind::knee);
  at = made.add(at, Kind::weld);
  at = made.add(at, Kind::pin);
  made.add(at, Kind::universal);
  return made.model();
}

/// A floating trunk with two legs, a head and two arms: 37 coordinates, 2 of them knees, and two
/// coupled kneecaps.
inline Model bodyOfThirtySeven() {
  using Kind = TreeModelMaker::Kind;
  TreeModelMaker made(37);
  const std::string pelvis = made.add("ground", Kind::free);  // 6
  for (int side = 0; side < 2; ++side) {
    const std::string thigh = made.add(pelvis, Kind::ball);
    const std::string shank = made.add(thigh, Kind::knee);
    made.add(thigh, Kind::coupled);
    std::string foot = made.add(shank, Kind::pin);
    foot = made.add(foot, Kind::pin);
    made.add(foot, Kind::pin);  // 7 a leg
  }
  const std::string trunk = made.add(pelvis, Kind::ball);  // 3
  for (int side = 0; side < 2; ++side) {
    std::string arm = made.add(trunk, Kind::ball);
    arm = made.add(arm, Kind::pin);
    arm = made.add(arm, Kind::slider);
    made.add(arm, Kind::universal);  // 7 an arm
  }
  return made.model();
}

/// A platform on rails that carries three branches: 16 coordinates.
inline Model branchesOfSixteen() {
  using Kind = TreeModelMaker::Kind;
  TreeModelMaker made(16);
  const std::string base = made.add("ground", Kind::planar);  // 3
  std::string a = made.add(base, Kind::knee);                 // 1
  a = made.add(a, Kind::knee);                                // 1
  made.add(a, Kind::slider);                                  // 1
  std::string b = made.add(base, Kind::universal);            // 2
  b = made.add(b, Kind::coupled);
  made.add(b, Kind::ball);                        // 3
  std::string c = made.add("ground", Kind::pin);  // 1
  c = made.add(c, Kind::planar);                  // 3
  made.add(c, Kind::pin);                         // 1
  return made.model();
}

}  // namespace bio::fixtures
