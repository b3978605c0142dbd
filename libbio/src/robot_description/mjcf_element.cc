#include <fmt/format.h>

#include <cctype>
#include <cmath>

#include "robot_description/mjcf.h"

namespace bio::robot {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

std::string MjcfElement::text(const char* attribute, const char* fallback) const {
  const char* found = find(attribute);
  return found ? found : fallback;
}

double MjcfElement::number(const char* attribute, Rule rule, double fallback) const {
  const char* found = find(attribute);
  if (!found) return fallback;
  return documents_.ruled(element_, attribute,
                          documents_.numbers(element_, attribute, found, 1).front(), rule);
}

std::vector<double> MjcfElement::numbers(const char* attribute) const {
  const char* found = find(attribute);
  return found ? documents_.numbers(element_, attribute, found) : std::vector<double>{};
}

Vector3d MjcfElement::vector(const char* attribute, const Vector3d& fallback) const {
  const char* found = find(attribute);
  if (!found) return fallback;
  const auto v = documents_.numbers(element_, attribute, found, 3);
  return {v[0], v[1], v[2]};
}

Transform MjcfElement::placement(const MjcfSettings& settings) const {
  Transform X{Matrix3d::Identity(), vector("pos", Vector3d::Zero())};
  // the element's own turn replaces that of a default, whatever it is given as
  const char* chosen = nullptr;
  for (const bool own : {true, false}) {
    if (chosen) break;
    for (const char* each : {"quat", "axisangle", "xyaxes", "zaxis", "euler"}) {
      if (own ? !element_.Attribute(each) : !has(each)) continue;
      if (chosen) {
        documents_.fail(element_,
                        fmt::format("is turned by {} and {}, must be by one", chosen, each));
      }
      chosen = each;
    }
  }
  if (chosen) X.R = turn(settings, chosen);
  return X;
}

Matrix3d MjcfElement::turn(const MjcfSettings& settings, const char* attribute) const {
  const std::string_view kind = attribute;
  const std::size_t count = kind == "xyaxes" ? 6 : kind == "quat" || kind == "axisangle" ? 4 : 3;
  const auto v = documents_.numbers(element_, attribute, find(attribute), count);
  const auto three = [&](std::size_t at) { return Vector3d(v[at], v[at + 1], v[at + 2]); };
  const auto unit = [&](const Vector3d& direction) {
    const Vector3d normed = direction.stableNormalized();
    if (!(normed.norm() > 0.5)) {
      documents_.fail(element_,
                      fmt::format("{} = '{}', must have a length > 0", attribute, find(attribute)));
    }
    return normed;
  };
  if (kind == "quat") {
    const double norm = Eigen::Vector4d(v[0], v[1], v[2], v[3]).stableNorm();
    if (!(norm > 0)) documents_.fail(element_, "quat = 0 0 0 0, must have a length > 0");
    if (v[1] == 0 && v[2] == 0 && v[3] == 0) return Matrix3d::Identity();
    return Eigen::Quaterniond(v[0] / norm, v[1] / norm, v[2] / norm, v[3] / norm)
        .toRotationMatrix();
  }
  if (kind == "axisangle") {
    return AngleAxisd(v[3] * settings.angle, unit(three(0))).toRotationMatrix();
  }
  if (kind == "zaxis") return carryingZTo(unit(three(0)));
  Matrix3d R = Matrix3d::Identity();
  if (kind == "xyaxes") {
    R.col(0) = unit(three(0));
    R.col(1) = unit(three(3) - three(3).dot(R.col(0)) * R.col(0));
    R.col(2) = R.col(0).cross(R.col(1));
    return R;
  }
  // small letters turn about axes that move along, capitals about those of the parent
  for (std::size_t i = 0; i < 3; ++i) {
    if (v[i] == 0) continue;
    const char letter = settings.eulerOrder[i];
    const bool moves = std::islower(static_cast<unsigned char>(letter)) != 0;
    const Vector3d axis = Vector3d::Unit(std::tolower(static_cast<unsigned char>(letter)) - 'x');
    const Matrix3d one = AngleAxisd(v[i] * settings.angle, axis).toRotationMatrix();
    R = moves ? (R * one).eval() : (one * R).eval();
  }
  return R;
}

}  // namespace bio::robot
