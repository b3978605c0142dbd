#include "bio/path/surface/wrap_rule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace bio {

Vec3<double> directionOf(WrapQuadrant quadrant) {
  switch (quadrant) {
    case WrapQuadrant::plusX:
      return Vec3<double>::UnitX();
    case WrapQuadrant::minusX:
      return -Vec3<double>::UnitX();
    case WrapQuadrant::plusY:
      return Vec3<double>::UnitY();
    case WrapQuadrant::minusY:
      return -Vec3<double>::UnitY();
    case WrapQuadrant::plusZ:
      return Vec3<double>::UnitZ();
    case WrapQuadrant::minusZ:
      return -Vec3<double>::UnitZ();
    case WrapQuadrant::all:
      break;
  }
  return Vec3<double>::Zero();
}

WrapQuadrant wrapQuadrant(const std::string& word) {
  if (word == "all" || word == "All" || word == "ALL") return WrapQuadrant::all;
  if (word.size() == 1 || word.size() == 2) {
    const bool minus = word.front() == '-';
    const bool signedWord = word.size() == 2 && (minus || word.front() == '+');
    if (signedWord || word.size() == 1) {
      switch (word.back()) {
        case 'x':
        case 'X':
          return minus ? WrapQuadrant::minusX : WrapQuadrant::plusX;
        case 'y':
        case 'Y':
          return minus ? WrapQuadrant::minusY : WrapQuadrant::plusY;
        case 'z':
        case 'Z':
          return minus ? WrapQuadrant::minusZ : WrapQuadrant::plusZ;
        default:
          break;
      }
    }
  }
  throw std::invalid_argument(
      fmt::format("quadrant is '{}', must be all, x, +x, -x, y, +y, -y, z, +z or -z", word));
}

Side cylinderSide(WrapQuadrant quadrant, const Vec3<double>& p_CP, const Vec3<double>& p_CQ) {
  if (quadrant == WrapQuadrant::plusZ || quadrant == WrapQuadrant::minusZ) {
    throw std::invalid_argument(
        "a cylinder's quadrant is z or -z, which is its axis; must be all, x, -x, y or -y");
  }
  // Counter-clockwise is the shorter way where Q lies to the left of P, seen from the axis.
  const Eigen::Vector2d u = p_CP.head<2>().normalized();
  const Eigen::Vector2d w = p_CQ.head<2>().normalized();
  const bool leftward = u.x() * w.y() - u.y() * w.x() >= 0;
  const Side shorter = leftward ? Side::counterclockwise : Side::clockwise;
  if (quadrant == WrapQuadrant::all) return shorter;
  // The middle of the shorter way is along u + w, of the longer way opposite.
  const Side longer = leftward ? Side::clockwise : Side::counterclockwise;
  return directionOf(quadrant).head<2>().dot(u + w) >= 0 ? shorter : longer;
}

double angleRound(Side side, const Vec3<double>& p_CP, const Vec3<double>& p_CQ) {
  const double sigma = side == Side::counterclockwise ? 1.0 : -1.0;
  const double across = sigma * (p_CP.x() * p_CQ.y() - p_CP.y() * p_CQ.x());
  const double angle = std::atan2(across, p_CP.head<2>().dot(p_CQ.head<2>()));
  return angle < 0 ? angle + 2 * std::numbers::pi : angle;
}

SlipAngle slipAngle(double decided, std::vector<double> angles) {
  constexpr double turn = 2 * std::numbers::pi;
  if (angles.empty()) return {};
  std::sort(angles.begin(), angles.end());
  angles.push_back(angles.front() + turn);
  double encompassing = 0, middle = 0;
  for (std::size_t i = 0; i + 1 < angles.size(); ++i) {
    const double gap = angles[i + 1] - angles[i];
    if (gap > encompassing) {
      encompassing = gap;
      middle = angles[i] + gap / 2;
    }
  }
  if (middle < decided) middle += turn;
  if (middle >= turn) return {};
  middle = std::max(middle, std::numbers::pi);
  return {std::cos(middle), std::sin(middle)};
}

bool hasSlippedOff(const SlipAngle& slip, Side side, const Vec3<double>& p_CP,
                   const Vec3<double>& p_CQ) {
  const double sigma = side == Side::counterclockwise ? 1.0 : -1.0;
  const double across = sigma * (p_CP.x() * p_CQ.y() - p_CP.y() * p_CQ.x());
  if (!(across < 0)) return false;
  const double along = p_CP.x() * p_CQ.x() + p_CP.y() * p_CQ.y();
  return slip.cosine * across - slip.sine * along > 0;
}

Way sphereWay(WrapQuadrant quadrant, const Vec3<double>& p_CP, const Vec3<double>& p_CQ) {
  if (quadrant == WrapQuadrant::all) return Way::shorter;
  const Vec3<double> middle = p_CP.normalized() + p_CQ.normalized();
  return directionOf(quadrant).dot(middle) >= 0 ? Way::shorter : Way::longer;
}

bool cylinderTouches(double radius, double length, Side side, const Vec3<double>& p_CP,
                     const Vec3<double>& p_CQ) {
  if (!(p_CP.head<2>().norm() > radius) || !(p_CQ.head<2>().norm() > radius)) return false;
  if (!cylinderGeometry(radius, side, p_CP, p_CQ).touches) return false;
  const WrapContact<double> contact = wrapCylinderContact(radius, side, p_CP, p_CQ);
  return std::abs(contact.p_CA.z()) <= length / 2 || std::abs(contact.p_CB.z()) <= length / 2;
}

}  // namespace bio
