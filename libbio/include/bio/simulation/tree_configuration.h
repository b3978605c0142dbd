#pragma once

// SystemConfiguration for any number of coordinates.
#include "bio/simulation/musculoskeletal_system.h"

namespace bio {

/// All quantities that depend only on the configuration, for a skeleton that is evaluated as a tree
/// (MusculoskeletalSystem::tree()). A workspace: allocates when constructed, never when moved.
template <>
class SystemConfiguration<Eigen::Dynamic> {
 public:
  using Vector = Eigen::VectorXd;

  /// @throws std::invalid_argument the system's skeleton is not a tree
  explicit SystemConfiguration(const MusculoskeletalSystem& system);
  SystemConfiguration(const SystemConfiguration&) = delete;  // refers to itself
  SystemConfiguration& operator=(const SystemConfiguration&) = delete;

  void moveTo(const Vector& q);
  /// Does not update the lengths.
  void moveSkeletonTo(const Vector& q);

  /// Fixes the active conditional points to those of this configuration.
  void holdConditions(const Vector& at) {
    held_ = at;
    holds_ = true;
  }

  /// The skeleton at q + d; lengths there by their Taylor polynomials at q, which lack terms of
  /// third order in d, their slopes those of second order.
  void shift(const Vector& d);

  /// Energy derivatives that a step needs at speed v; valid until the next call of a function that
  /// moves or evaluates.
  const EnergyDerivatives<Eigen::Dynamic>& energy(const Vector& v);
  /// Evaluates the energy at rest unless it is known.
  const Eigen::MatrixXd& massMatrix() { return known().T_vv; }
  double potential() { return known().potential; }

  const LengthJet<Eigen::Dynamic>& length(std::size_t muscle) const { return lengths_[muscle]; }
  const TreeMotion<double>& motion() const { return motion_; }

  /// Placement of a segment of the skeleton in ground, and its derivative in a coordinate.
  Placement<double> placement(std::size_t segment) const;
  Placement<double> change(std::size_t segment, int coordinate) const;

  /// Segments of the skeleton as places in the tree.
  const TreePlaces& places() const { return places_; }

 private:
  const EnergyDerivatives<Eigen::Dynamic>& known();

  const MusculoskeletalSystem* system_;
  TreePlaces places_;
  TreeMotion<double> motion_;
  TreeEnergy<Eigen::Dynamic> energy_;
  const EnergyDerivatives<Eigen::Dynamic>* evaluated_ = nullptr;
  std::vector<SupportedLength<double>> work_;
  std::vector<LengthJet<Eigen::Dynamic>> lengths_;
  Vector q_, still_;
  Vector held_;
  bool holds_ = false;
};

}  // namespace bio
