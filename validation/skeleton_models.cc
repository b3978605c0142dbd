// The skeletons of whole models against Simbody, with every coordinate free:
//     skeleton_models MODEL.osim…
// For each model, over ten postures within the coordinates' ranges: the largest deviation of the
// mass matrix, the gravity force, the momenta Mv and the points of all bodies from Simbody's, each
// relative to the largest value of its kind, and of the second derivatives of T and V from central
// differences of the first ones. Ends with 1 if any is above 1e-12 (differences: 1e-7).
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "bio/opensim/osim_file.h"
#include "bio/skeleton/articulated_tree.h"
#include "bio/skeleton/tree_energy.h"
#include "second_ways/simbody_tree.h"

namespace {

using Vector = Eigen::VectorXd;
using Energies = bio::EnergyDerivatives<Eigen::Dynamic>;

struct Deviations {
  double mass = 0, gravity = 0, momentum = 0, point = 0, difference = 0;
};

template <class A, class B>
void keepLargest(double& kept, const A& a, const B& b, double least = 0) {
  const double largest = std::max(least, b.cwiseAbs().maxCoeff());
  const double deviation = (a - b).cwiseAbs().maxCoeff() / (largest > 0 ? largest : 1);
  if (!(deviation <= kept)) kept = deviation;  // NaN stays
}

Vector drawnPosture(const bio::ArticulatedTree& tree, std::mt19937& random) {
  Vector q(tree.numCoordinates());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const bio::Coordinate& c = tree.coordinates()[static_cast<std::size_t>(i)];
    const double limit = c.isRotation ? 1.5 : 1;
    const double low = std::clamp(c.rangeMin, -limit, limit);
    const double high = std::clamp(c.rangeMax, low, std::max(low, limit));
    q[i] = std::uniform_real_distribution<double>(low, std::max(high, low + 1e-3))(random);
  }
  return q;
}

Energies energiesAt(const bio::ArticulatedTree& tree, const Vector& q, const Vector& v) {
  auto motion = tree.newMotion<double>();
  tree.place(q.data(), motion);
  return bio::TreeEnergy<Eigen::Dynamic>(tree).evaluate(motion, v.data());
}

void compareDifferences(const bio::ArticulatedTree& tree, const Vector& q, const Vector& v,
                        const Energies& jet, Deviations& largest) {
  const Eigen::Index n = q.size();
  Eigen::MatrixXd T_vq(n, n), T_qq(n, n), V_qq(n, n);
  const double h = 1e-5;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vector step = h * Vector::Unit(n, i);
    const Energies plus = energiesAt(tree, q + step, v), minus = energiesAt(tree, q - step, v);
    T_vq.col(i) = (plus.T_v - minus.T_v) / (2 * h);
    T_qq.col(i) = (plus.T_q - minus.T_q) / (2 * h);
    V_qq.col(i) = (plus.V_q - minus.V_q) / (2 * h);
  }
  // what is exactly 0, as for a hinge, is measured by the energies
  keepLargest(largest.difference, jet.T_vq, T_vq, jet.kinetic);
  keepLargest(largest.difference, jet.T_qq, T_qq, jet.kinetic);
  keepLargest(largest.difference, jet.V_qq, V_qq, jet.V_q.cwiseAbs().maxCoeff());
}

/// Raises inertias that no rigid body has, since Simbody refuses them; returns how many.
int makePhysical(bio::Model& model) {
  int raised = 0;
  for (bio::Body& body : model.bodies) {
    auto& I = body.inertia;
    const double half = 0.5 * (I[0] + I[1] + I[2]);
    const double excess = std::max({I[0], I[1], I[2]}) - half;
    if (!(excess > 0)) continue;
    for (std::size_t i = 0; i < 3; ++i) I[i] += 2 * excess + 1e-9;
    ++raised;
  }
  return raised;
}

bool agrees(const std::string& file) {
  bio::Model model = bio::readOsim(file);
  const int raised = makePhysical(model);
  const std::vector<std::string> free = bio::independentCoordinates(model);
  const bio::ArticulatedTree tree(model, {free, {}});
  const bio::SimbodyTree reference(model);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> rate(-3, 3);
  Deviations largest;
  for (int trial = 0; trial < 10; ++trial) {
    const Vector q = drawnPosture(tree, random);
    Vector v(q.size());
    for (double& x : v) x = rate(random);
    std::map<std::string, double> values;
    for (std::size_t i = 0; i < free.size(); ++i) {
      values[free[i]] = q[static_cast<Eigen::Index>(i)];
    }
    const Energies jet = energiesAt(tree, q, v);
    const auto expected = reference.reducedTo(free, values);
    keepLargest(largest.mass, jet.T_vv, expected.massMatrix);
    keepLargest(largest.gravity, -jet.V_q, expected.gravityForce);
    keepLargest(largest.momentum, jet.T_v, expected.massMatrix * v);
    auto motion = tree.newMotion<double>();
    tree.place(q.data(), motion);
    for (const bio::Body& body : model.bodies) {
      const bio::BodyPlacement& place = tree.placeOf(body.name);
      const auto X = motion.segments[place.segment] * place.X_SB;
      const Eigen::Vector3d p(0.1, -0.2, 0.05);
      const Eigen::Vector3d x = X.R * p + X.p;
      keepLargest(largest.point, x, reference.pointInGround(values, body.name, p));
    }
    compareDifferences(tree, q, v, jet, largest);
  }
  fmt::print("{:38} {:3} {:3}   {:.1e}   {:.1e}   {:.1e}   {:.1e}   {:.1e}{}\n",
             file.substr(file.find_last_of('/') + 1), free.size(), tree.mobilities().size(),
             largest.mass, largest.gravity, largest.momentum, largest.point, largest.difference,
             raised > 0 ? fmt::format("   {} inertias made physical", raised) : "");
  return std::max({largest.mass, largest.gravity, largest.momentum, largest.point}) <= 1e-12 &&
         largest.difference <= 1e-7;
}

}  // namespace

int main(int argc, char** argv) {
  fmt::print("{:38} {:>3} {:>3}   {:7}   {:7}   {:7}   {:7}   {:7}\n", "largest deviation of", "q",
             "mob", "M", "gravity", "M v", "points", "differences");
  bool allAgree = true;
  for (int i = 1; i < argc; ++i) {
    try {
      allAgree = agrees(argv[i]) && allAgree;
    } catch (const std::exception& error) {
      fmt::print("{}: {}\n", argv[i], error.what());
      allAgree = false;
    }
  }
  return allAgree ? 0 : 1;
}
