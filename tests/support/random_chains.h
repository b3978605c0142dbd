#pragma once

#include <random>
#include <vector>

#include "bio/path/surface/chain_change.h"
#include "bio/path/surface/way.h"

namespace support {

/// Ends and objects of a random path, made so that most of the objects are touched.
struct RandomChain {
  Eigen::Vector3d P, Q;
  std::vector<bio::ChainObject> objects;
};

class RandomChains {
 public:
  explicit RandomChains(unsigned seed) : random_(seed) {}

  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Eigen::Vector3d direction() {
    std::normal_distribution<double> normal;
    return Eigen::Vector3d(normal(random_), normal(random_), normal(random_)).normalized();
  }
  Eigen::Matrix3d rotation() {
    return Eigen::AngleAxis<double>(between(0, 3), direction()).toRotationMatrix();
  }

  /// Semi-axes of 10 to 60 mm, every third one long or flat.
  bio::EllipsoidSurface ellipsoid() {
    Eigen::Vector3d axes(between(0.02, 0.06), between(0.02, 0.06), between(0.02, 0.06));
    const double kind = between(0, 6);
    if (kind < 1) axes[2] = between(0.08, 0.1);
    if (kind > 5) axes[2] = between(0.01, 0.02);
    return bio::EllipsoidSurface(axes);
  }

  /// A path over `count` ellipsoids in a row, 0.22 m apart.
  RandomChain ellipsoids(int count) {
    for (;;) {
      RandomChain chain;
      chain.P = {-between(0.05, 0.2), between(-0.05, 0.05), between(-0.05, 0.05)};
      chain.Q = {0.22 * (count - 1) + between(0.05, 0.2), between(-0.05, 0.05),
                 between(-0.05, 0.05)};
      for (int j = 0; j < count; ++j) {
        bio::ChainObject object{bio::Surface(ellipsoid())};
        object.R_GS = rotation();
        object.p_GS = {0.22 * j, between(-0.02, 0.02), between(-0.02, 0.02)};
        chain.objects.push_back(object);
      }
      if (isOutside(chain)) return withNearHints(chain);
    }
  }

  /// A path through the hole of a torus.
  RandomChain torus() {
    for (;;) {
      const double ring = between(0.03, 0.06);
      bio::ChainObject object{bio::Surface(bio::TorusSurface(ring, ring * between(0.1, 0.5)))};
      object.R_GS = rotation();
      object.p_GS = 0.05 * direction();
      const double side = between(0, 6.28);
      const auto end = [&](double turn, double height) {
        const double rho = ring * between(0.2, 2);
        return Eigen::Vector3d(object.R_GS * Eigen::Vector3d(rho * std::cos(side + turn),
                                                             rho * std::sin(side + turn), height) +
                               object.p_GS);
      };
      RandomChain chain{end(between(-0.6, 0.6), between(0.03, 0.1)),
                        end(between(-0.6, 0.6), -between(0.03, 0.1)),
                        {object}};
      if (isOutside(chain)) return withNearHints(chain);
    }
  }

  /// One of four kinds: an ellipsoid, a torus, two and three ellipsoids.
  RandomChain ofKind(int kind) { return kind == 1 ? torus() : ellipsoids(kind == 0 ? 1 : kind); }

 private:
  static bool isOutside(const RandomChain& chain) {
    for (const bio::ChainObject& o : chain.objects) {
      for (const Eigen::Vector3d& end : {chain.P, chain.Q}) {
        if (bio::isInside(o.surface, o.R_GS.transpose() * (end - o.p_GS))) return false;
      }
    }
    return true;
  }

  // On the side where the chord is nearest to the surface.
  static RandomChain withNearHints(RandomChain chain) {
    for (bio::ChainObject& o : chain.objects) {
      const Eigen::Vector3d P = o.R_GS.transpose() * (chain.P - o.p_GS);
      const Eigen::Vector3d Q = o.R_GS.transpose() * (chain.Q - o.p_GS);
      const Eigen::Vector3d lowest = bio::lowestOnSegment(o.surface, P, Q).point;
      const Eigen::Vector3d out =
          std::visit([&](const auto& s) { return s.gradient(lowest); }, o.surface);
      o.hint = bio::hintTowards(o.surface, out, P, Q);
    }
    return chain;
  }

  std::mt19937 random_;
};

}  // namespace support
