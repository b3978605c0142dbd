#include "simulation/moved_mass.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "bio/skeleton/tree_energy.h"
#include "simulation/integrators.h"

namespace bio {
namespace {

constexpr double negligible = 1e-14;  ///< [kg m²] or [kg]; a grain of sand at a millimetre has more
/// Share of the largest moment that rounded numbers, or a derivative's step, make of a flat body.
constexpr double roundingShare = 0.05;
constexpr double singular = 1e-10;  ///< least eigenvalue of a mass matrix with ones on its diagonal

Eigen::MatrixXd massMatrixOf(const Skeleton& skeleton, const Eigen::VectorXd& posture) {
  return stepping::withCoordinates(skeleton, [&](auto N) -> Eigen::MatrixXd {
    constexpr int count = decltype(N)::value;
    const Eigen::Matrix<double, count, 1> q = posture;
    if constexpr (count == Eigen::Dynamic) {
      TreeMotion<double> motion = skeleton.tree()->newMotion<double>();
      skeleton.tree()->place(q.data(), motion);
      TreeEnergy<count> energy(*skeleton.tree());
      const Eigen::VectorXd still = Eigen::VectorXd::Zero(q.size());
      return energy.evaluate(motion, still.data()).T_vv;
    } else {
      std::vector<RigidMotion<double, count>> moved(skeleton.numSegments());
      skeleton.motions<double, count>(q, moved.data());
      return skeleton.inertia<count>(q, moved.data()).massMatrix;
    }
  });
}

/// What moves no mass in a posture.
struct MovesNoMass {
  std::string what;           ///< empty: all coordinates move some
  bool onlyTogether = false;  ///< several coordinates, each of which moves some alone
};

MovesNoMass movesNoMassAt(const Skeleton& skeleton, const Eigen::VectorXd& q) {
  const Eigen::MatrixXd M = massMatrixOf(skeleton, q);
  if (!M.allFinite()) return {"mass matrix: a value is not finite"};
  const std::vector<Coordinate>& free = skeleton.coordinates();
  for (Eigen::Index k = 0; k < M.rows(); ++k) {
    if (M(k, k) > negligible) continue;
    const Coordinate& c = free[static_cast<std::size_t>(k)];
    return {fmt::format("coordinate '{}' moves no mass (inertia = {:.4g} {})", c.name, M(k, k),
                        c.isRotation ? "kg m²" : "kg")};
  }
  const Eigen::VectorXd scale = M.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * M * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(scaled);
  if (modes.eigenvalues()[0] > singular) return {};
  std::string names;
  for (Eigen::Index k = 0; k < M.rows(); ++k) {
    if (std::abs(modes.eigenvectors()(k, 0)) < 1e-3) continue;
    names += (names.empty() ? "'" : ", '") + free[static_cast<std::size_t>(k)].name + "'";
  }
  return {fmt::format("coordinates {} can move together without moving any mass", names), true};
}

}  // namespace

std::string whatMovesNoMassAt(const Skeleton& skeleton, const Eigen::VectorXd& q) {
  return movesNoMassAt(skeleton, q).what;
}

std::string whatMovesNoMass(const Skeleton& skeleton) {
  Eigen::VectorXd q = skeleton.defaultValues();
  const std::string atDefault = whatMovesNoMassAt(skeleton, q);
  if (atDefault.empty()) return "";
  for (Eigen::Index k = 0; k < q.size(); ++k) {  // any posture where no axes coincide
    const bool turns = skeleton.coordinates()[static_cast<std::size_t>(k)].isRotation;
    q[k] += (turns ? 0.5 : 0.01) * (1 + 0.3 * std::sin(static_cast<double>(k)));
  }
  const MovesNoMass elsewhere = movesNoMassAt(skeleton, q);
  if (elsewhere.what.empty()) return "";
  return elsewhere.what +
         (elsewhere.onlyTogether
              ? ", must not: one of them has to be locked"
              : ", must move some: the bodies behind it need mass, or it has to be locked");
}

bool requireMovedMass(const Model& model, const Skeleton& skeleton) {
  for (const Body& body : model.bodies) {
    const Eigen::Vector3d principal = principalMoments(body);
    const bool isRounding =
        principal.minCoeff() >= -roundingShare * principal.cwiseAbs().maxCoeff();
    if (skeleton.placeOf(body.name).segment == 0 || isRounding) continue;
    throw std::invalid_argument(
        fmt::format("body '{}': least principal moment of inertia = {:.4g} kg m², must be ≥ 0 for "
                    "a body that moves",
                    body.name, principal.minCoeff()));
  }
  const std::string nothing = whatMovesNoMass(skeleton);
  if (!nothing.empty()) throw std::invalid_argument(nothing);
  return whatMovesNoMassAt(skeleton, skeleton.defaultValues()).empty();
}

}  // namespace bio
