#pragma once

// Plain C++17 interface to Simbody: its 3.7 headers compare objects in a way that C++20 finds
// ambiguous, so simbody_system.cc is compiled as C++17 and sees none of our C++20 headers.

#include <Eigen/Dense>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace bio::simbody {

/// f, f′, f″
using Curve = std::function<std::array<double, 3>(double)>;

struct Frame {
  Eigen::Vector3d translation;
  Eigen::Vector3d orientation;  ///< body-fixed x-y-z
};

struct RigidBody {
  std::string name;
  double mass;
  Eigen::Vector3d massCenter;
  std::array<double, 6> inertia;  ///< about the mass centre
};

struct Axis {
  int coordinate;  ///< of the joint, −1: constant
  Eigen::Vector3d direction;
  Curve amount;
};

enum class Mobility { weld, pin, slider, functions };

struct Link {
  Mobility mobility;
  std::string parent;
  Frame parentFrame;
  RigidBody body;
  Frame bodyFrame;
  std::vector<std::string> coordinates;
  std::vector<Axis> axes;  ///< six, for `functions`
};

/// A tree of mobilised bodies under gravity.
class System {
 public:
  explicit System(const Eigen::Vector3d& gravity);
  ~System();

  bool hasBody(const std::string& name) const;
  void add(const Link& link);  ///< the parent must be there
  void finish();               ///< after the last link

  std::vector<std::string> mobilityNames() const;
  /// Mass matrix and generalised gravity force; `values` holds every coordinate.
  std::pair<Eigen::MatrixXd, Eigen::VectorXd> dynamics(
      const std::map<std::string, double>& values) const;
  Eigen::Vector3d pointInGround(const std::map<std::string, double>& values,
                                const std::string& body, const Eigen::Vector3d& point) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace bio::simbody
