#include "bio/forces/body_forces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bio/simulation/simulate_batch.h"
#include "libbio/forces/arm_with_forces.h"
#include "second_ways/simbody_tree.h"
#include "simulation/other_forces.h"
#include "simulation/system_dynamics.h"
#include "support/sensitivity_differences.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using fixtures::ArmOfSeven;
using fixtures::load;
using fixtures::withAll;
using fixtures::withElasticPaths;
using fixtures::withLoads;
using fixtures::withSprings;

struct Found {
  VectorXd passive, load;
};

Found forcesOf(const MusculoskeletalSystem& system, const VectorXd& q, const VectorXd& v,
               double t) {
  return stepping::withCoordinates(system.skeleton(), [&](auto N) -> Found {
    constexpr int n = decltype(N)::value;
    using Vector = Eigen::Matrix<double, n, 1>;
    using Matrix = Eigen::Matrix<double, n, n>;
    SystemConfiguration<n> configuration(system);
    stepping::OtherForces<n> others(system);
    EXPECT_TRUE(others.any());
    configuration.moveTo(q);
    Vector passive = Vector::Zero(q.size());
    Matrix passive_q = Matrix::Zero(q.size(), q.size()), passive_v = passive_q;
    others.add(t, configuration, v, passive, passive_q, passive_v);
    return {passive, others.load()};
  });
}

/// Where Simbody has a body's point; the arm's other coordinates at their defaults.
class Simbody {
 public:
  explicit Simbody(const ArmOfSeven& system) : tree_(system.model), system_(&system) {}
  Vector3d point(const VectorXd& q, const std::string& body, const Vector3d& p_B) const {
    if (body == "ground") return p_B;
    std::map<std::string, double> values;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      values[system_->system.skeleton().coordinates()[static_cast<std::size_t>(i)].name] = q[i];
    }
    return tree_.pointInGround(values, body, p_B);
  }
  Placement<double> frame(const VectorXd& q, const std::string& body,
                          const Placement<double>& X_B = {}) const {
    Placement<double> X;
    X.p = point(q, body, X_B.p);
    for (int i = 0; i < 3; ++i) X.R.col(i) = point(q, body, X_B.p + X_B.R.col(i)) - X.p;
    return X;
  }

 private:
  SimbodyTree tree_;
  const ArmOfSeven* system_;
};

/// ∂f/∂q_j of a function of the posture.
template <class F>
auto slopeOf(const F& f, const VectorXd& q, Eigen::Index j) {
  const double h = 1e-4;
  const auto at = [&](double d) {
    VectorXd moved = q;
    moved[j] += d;
    return f(moved);
  };
  return decltype(f(q))((8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h));
}

const std::vector<std::vector<std::string>> frees{{"elbow_flexion"}, ArmOfSeven::coordinates()};

// Virtual work with Simbody's positions: force times the body's point, couple of forces for torque.
TEST(BodyForces, LoadsDoTheVirtualWorkOfSimbodysPoints) {
  for (const auto& free : frees) {
    const ArmOfSeven c(0.3, free, false, withLoads());
    const Simbody simbody(c);
    const VectorXd q = c.start.q;
    const double t = 0.43;
    VectorXd expected = VectorXd::Zero(q.size());
    for (const BodyLoad& one : c.model.externalLoads) {
      const LoadCourse::At at = LoadCourse(one).at(t);
      const Eigen::Matrix3d R = simbody.frame(q, one.forceFrame).R;
      const Vector3d F = R * Vector3d(at.value[0], at.value[1], at.value[2]);
      const Vector3d T = R * Vector3d(at.value[6], at.value[7], at.value[8]);
      const Vector3d x =
          simbody.point(q, one.pointFrame, Vector3d(at.value[3], at.value[4], at.value[5]));
      const Placement<double> X = simbody.frame(q, one.body);
      const Vector3d p_B = X.R.transpose() * (x - X.p);
      for (Eigen::Index j = 0; j < q.size(); ++j) {
        const auto pointAt = [&](const VectorXd& at_q) {
          return simbody.point(at_q, one.body, p_B);
        };
        const auto axesAt = [&](const VectorXd& at_q) { return simbody.frame(at_q, one.body).R; };
        const Eigen::Matrix3d turn = slopeOf(axesAt, q, j) * X.R.transpose();  // ω×
        expected[j] += F.dot(Vector3d(slopeOf(pointAt, q, j))) +
                       T.dot(Vector3d(turn(2, 1), turn(0, 2), turn(1, 0)));
      }
    }
    const Found found = forcesOf(c.system, q, VectorXd::Zero(q.size()), t);
    EXPECT_GT(expected.cwiseAbs().minCoeff(), 1e-4);
    EXPECT_LT((found.load - expected).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_TRUE(found.passive.isZero(0));
  }
}

// Force is minus the slope of the energy, power minus what dampers burn; both by Simbody's frames.
TEST(BodyForces, SpringsAndBushingsFollowTheirEnergy) {
  for (const auto& free : frees) {
    const ArmOfSeven c(0.3, free, false, withSprings());
    const Simbody simbody(c);
    const VectorXd q = c.start.q;
    const VectorXd v = VectorXd::LinSpaced(q.size(), 0.7, -0.9);
    const BushingForce& b = c.model.bushings[0];
    const auto deflection = [&](const VectorXd& at) {
      const Placement<double> F = simbody.frame(at, b.body[0], placementOf(b.frame[0]));
      const Placement<double> M = simbody.frame(at, b.body[1], placementOf(b.frame[1]));
      Vector6 d;
      d << (F.R.transpose() * M.R).eulerAngles(0, 1, 2), F.R.transpose() * (M.p - F.p);
      for (int i = 0; i < 3; ++i) d[i] = std::remainder(d[i], 2 * std::numbers::pi);
      if (std::abs(d[1]) > std::numbers::pi / 2) {  // Eigen's other triple
        d.head<3>() += Vector3d::Constant(std::numbers::pi);
        d[1] = -d[1];
        for (int i = 0; i < 3; ++i) d[i] = std::remainder(d[i], 2 * std::numbers::pi);
      }
      return d;
    };
    Vector6 K, C;
    K << b.rotationalStiffness, b.translationalStiffness;
    C << b.rotationalDamping, b.translationalDamping;
    const auto energy = [&](const VectorXd& at) {
      double sum = 0;
      for (const PointToPointSpring& s : c.model.pointSprings) {
        const double d =
            (simbody.point(at, s.body[0], s.point[0]) - simbody.point(at, s.body[1], s.point[1]))
                .norm();
        sum += s.stiffness / 2 * (d - s.restLength) * (d - s.restLength);
      }
      const Vector6 d = deflection(at);
      return sum + 0.5 * d.dot(K.cwiseProduct(d));
    };
    Vector6 rate = Vector6::Zero();
    for (Eigen::Index j = 0; j < q.size(); ++j) rate += v[j] * slopeOf(deflection, q, j);
    const Found still = forcesOf(c.system, q, VectorXd::Zero(q.size()), 0);
    const Found moving = forcesOf(c.system, q, v, 0);
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      const double expected = -slopeOf(energy, q, j);
      EXPECT_NEAR(still.passive[j], expected, 1e-9 * (1 + std::abs(expected))) << j;
    }
    EXPECT_NEAR((moving.passive - still.passive).dot(v), -rate.dot(C.cwiseProduct(rate)), 1e-9);
    EXPECT_GT(rate.dot(C.cwiseProduct(rate)), 1e-3);
  }
}

TEST(BodyForces, ElasticPathsPullAlongTheirLengths) {
  const Model model = withElasticPaths();
  const ElasticPathLaw ligament(model.elasticPaths[0]), spring(model.elasticPaths[1]),
      strap(model.elasticPaths[2]);
  EXPECT_NEAR(ligament.tension(0.12, 3).force, 20 * 0.3, 1e-12);
  EXPECT_EQ(ligament.tension(0.0999, 0).force, 0);
  EXPECT_NEAR(spring.tension(0.25, 2).force, 90 * 0.05 * 1.2, 1e-12);
  EXPECT_NEAR(strap.tension(0.11 * 1.03, -1).force, 30 * 0.03 * 0.03 / 0.12, 1e-12);
  EXPECT_NEAR(strap.tension(0.11 * 1.10, 0).force, 30 * (0.10 - 0.03), 1e-12);
  EXPECT_NEAR(strap.tension(0.11 * 1.10, 0.5).force, 30 * 0.07 + 2 * 0.5 / 0.11, 1e-12);
  for (const ElasticPathLaw* law : {&ligament, &spring, &strap}) {
    for (const double length : {0.1105, 0.113, 0.1165, 0.124, 0.23, 0.3}) {
      const double h = 1e-7, speed = 0.3;
      const PathTension at = law->tension(length, speed);
      EXPECT_NEAR(
          at.dForce_dLength,
          (law->tension(length + h, speed).force - law->tension(length - h, speed).force) / (2 * h),
          1e-5 * (1 + std::abs(at.dForce_dLength)))
          << length;
      EXPECT_NEAR(
          at.dForce_dSpeed,
          (law->tension(length, speed + h).force - law->tension(length, speed - h).force) / (2 * h),
          1e-5 * (1 + at.dForce_dSpeed));
    }
  }
}

TEST(BodyForces, ElasticPathsHaveDerivativesInTheirNumbers) {
  constexpr double ElasticPath::*members[] = {&ElasticPath::restLength, &ElasticPath::scale,
                                              &ElasticPath::damping,
                                              &ElasticPath::transitionStrain};
  for (const ElasticPath& path : withElasticPaths().elasticPaths) {
    const int known = path.kind == ElasticPathKind::ligament ? 2
                      : path.kind == ElasticPathKind::spring ? 3
                                                             : 4;
    for (const double length : {0.09, 0.1105, 0.113, 0.1165, 0.124, 0.23, 0.3}) {
      for (const double speed : {0.3, -0.3}) {
        const auto exact = ElasticPathLaw(path).inNumbers(length, speed);
        for (int k = 0; k < 4; ++k) {
          const auto force = [&](double change) {
            ElasticPath moved = path;
            moved.*members[k] += change;
            return ElasticPathLaw(moved).tension(length, speed).force;
          };
          const double d = exact[static_cast<std::size_t>(k)];
          const double h = 1e-7;
          if (k >= known) {
            EXPECT_EQ(d, 0) << path.name << " " << k;
          } else {
            EXPECT_NEAR(d, (force(h) - force(-h)) / (2 * h), 1e-5 * (1 + std::abs(d)))
                << path.name << " " << k << " at " << length;
          }
        }
      }
    }
  }
}

TEST(BodyForces, HaveExactDerivativesInAllCoordinatesAndSpeeds) {
  for (const auto& free : frees) {
    for (const Model& model : {withLoads(), withSprings(), withElasticPaths()}) {
      const ArmOfSeven c(0.3, free, false, model);
      stepping::withCoordinates(c.system.skeleton(), [&](auto N) {
        stepping::SystemDynamics<decltype(N)::value> dynamics(c.system, c.excitation);
        SystemState state = c.start;
        state.qDot = VectorXd::LinSpaced(state.q.size(), 1.2, -0.8);
        state.activation.array() += 0.1;  // away from the kink at fibre speed 0
        state.fibreLength *= 1.001;
        const VectorXd y = dynamics.pack(state);
        MatrixXd J(y.size(), y.size());
        dynamics.jacobian(0.17, y, J);
        // measured: 1e-8 of the column's largest number, at the best step
        for (Eigen::Index j = 0; j < 2 * state.q.size(); ++j) {
          const auto rates = [&](double h) {
            VectorXd shifted = y, rate = y;
            shifted[j] += h;
            dynamics.derivative(0.17, shifted, rate);
            return rate;
          };
          const VectorXd difference = (rates(1e-5) - rates(-1e-5)) / 2e-5;
          EXPECT_LT((difference - J.col(j)).cwiseAbs().maxCoeff(),
                    2e-7 * std::max(1.0, difference.cwiseAbs().maxCoeff()))
              << "column " << j;
        }
      });
    }
  }
}

// Errors of the scheme, and of its energy balance, fall with the square of the step.
TEST(BodyForces, IntegratorsAgreeAndKeepTheEnergy) {
  for (const auto& free : frees) {
    const ArmOfSeven c(0.5, free, false, withAll());
    const auto played = [&](Integrator integrator, double step) {
      SimulationOptions options;
      options.integrator = integrator;
      options.step = step;
      options.duration = 0.4;
      Trajectory motion = simulate(c.system, c.excitation, c.start, options);
      EXPECT_EQ(motion.outcome, Outcome::completed) << motion.why;
      return motion;
    };
    const Trajectory exact = played(Integrator::cvode, 0.4);
    const auto error = [&](const Trajectory& motion) {
      return (motion.q.rightCols(1) - exact.q.rightCols(1)).norm();
    };
    const Trajectory coarse = played(Integrator::variational, 0.004);
    const Trajectory fine = played(Integrator::variational, 0.002);
    EXPECT_GT(exact.externalWork.cwiseAbs().maxCoeff(), 0.01);
    EXPECT_GT((exact.q.rightCols(1) - c.start.q).norm(), 0.1);
    EXPECT_LT(error(played(Integrator::rungeKutta4, 2e-4)), 1e-6);
    EXPECT_LT(error(fine), 1e-3);
    EXPECT_NEAR(std::log2(error(coarse) / error(fine)), 2, 0.2);
    EXPECT_NEAR(std::log2(energyError(c.system, coarse) / energyError(c.system, fine)), 2, 0.3);
    EXPECT_LT(energyError(c.system, exact), 1e-8);
    EXPECT_NEAR(fine.externalWork.tail(1)[0], exact.externalWork.tail(1)[0], 1e-3);
  }
}

TEST(BodyForces, SensitivitiesMatchDifferences) {
  for (const auto& free : frees) {
    const ArmOfSeven c(0.2, free, false, withAll());
    const ParameterCatalogue catalogue(c.model, c.system,
                                       {c.start.q, VectorXd::Constant(c.start.q.size(), 0.3)});
    const auto wanted = catalogue.select({"hand.mass", "BRA.max_isometric_force"});
    SimulationOptions options;
    options.duration = 0.06;
    const fixtures::DiscoveryProblem d = fixtures::compareWithDifferences(
        c.system, c.options, c.excitation, catalogue, wanted, options);
    EXPECT_GT(d.compared, 20);
    EXPECT_LT(d.worst, 1e-5) << d.of;
  }
}

TEST(BodyForces, ABatchOfHingesHasThemToo) {
  const ArmOfSeven c(0.3, {"elbow_flexion"}, false, withAll());
  SimulationOptions options;
  options.duration = 0.1;
  const std::vector<LaneJob> jobs(2, LaneJob{&c.system, &c.excitation, &c.start});
  const Trajectory alone = simulate(c.system, c.excitation, c.start, options);
  for (const Trajectory& one : simulateTogether(jobs, options)) {
    EXPECT_LT((one.q - alone.q).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(LoadCourse, IsANaturalSplineThatGoesThroughItsRows) {
  BodyLoad one = load("one", "hand", "ground", "ground", {0, 0, 0});
  const LoadCourse course(one);
  for (std::size_t k = 0; k + 1 < one.times.size(); ++k) {
    for (std::size_t c = 0; c < 9; ++c) {
      EXPECT_NEAR(course.at(one.times[k]).value[c], one.rows[k][c], 1e-13);
    }
  }
  // 4 sin 3t between knots 0.1 s apart: (0.1)⁴/384·324 = 8e-5 and more near the natural ends
  EXPECT_NEAR(course.at(0.55).value[0], 4 * std::sin(1.65), 2e-4);
  const double h = 1e-5;
  EXPECT_NEAR(course.at(0.52).slope[0],
              (course.at(0.52 + h).value[0] - course.at(0.52 - h).value[0]) / (2 * h), 1e-7);
  EXPECT_EQ(course.at(-0.01).value[0], 0);
  EXPECT_EQ(course.at(1.2).value[1], 0);
  // no bend at the ends: the second difference vanishes
  EXPECT_NEAR(course.at(2e-3).value[0] - 2 * course.at(1e-3).value[0] + course.at(0).value[0], 0,
              1e-6);
  one.times[3] = one.times[2];
  EXPECT_THROW(LoadCourse{one}, std::invalid_argument);
}

}  // namespace
}  // namespace bio
