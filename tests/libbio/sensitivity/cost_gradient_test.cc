#include "bio/sensitivity/cost_gradient.h"

#include <gtest/gtest.h>

#include "bio/model/convert_muscles.h"
#include "bio/observation/least_squares_cost.h"
#include "libbio/forces/arm_with_forces.h"
#include "simulation/step_tape.h"
#include "support/shipped_elbow.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using Eigen::Index;
using fixtures::ArmOfSeven;
using fixtures::forSeconds;
using fixtures::ShippedElbow;
using Kind = Observable::Kind;

/// Times that are not those of the rows, up to the end.
Eigen::VectorXd between(const SimulationOptions& options) {
  return Eigen::VectorXd::LinSpaced(17, options.startTime, options.startTime + options.duration);
}

/// Of every coordinate and its speed, away from what is measured.
struct Measurement {
  Measurement(const MusculoskeletalSystem& system, const SimulationOptions& options,
              const std::string& marker = "") {
    const auto add = [&](Kind kind, const std::string& of, int axis) {
      series.push_back({{kind, of, axis}, between(options)});
    };
    for (const auto& coordinate : system.skeleton().coordinates()) {
      add(Kind::coordinate, coordinate.name, 0);
      add(Kind::speed, coordinate.name, 0);
    }
    if (!marker.empty()) add(Kind::marker, marker, 2);
    const Index size = ObservedMotion(system, series).size();
    measured = 0.3 * Eigen::VectorXd::LinSpaced(size, -1, 2).array().sin();
    sd = Eigen::VectorXd::LinSpaced(size, 0.02, 0.05);
  }
  MotionCost cost(const MusculoskeletalSystem& system) const {
    return leastSquaresCost(system, series, measured, sd);
  }
  std::vector<ObservedSeries> series;
  Eigen::VectorXd measured, sd;
};

/// How far the gradient of a cost is from Γᵀ W r of the forward sensitivities, relative to the sum
/// of the sizes of its terms; the largest over parameters.
double offForward(const MusculoskeletalSystem& system, const ParameterCatalogue& catalogue,
                  const std::vector<std::size_t>& wanted, const ExcitationSignal& excitation,
                  const SimulationOptions& options, const std::string& marker = "") {
  const Measurement measurement(system, options, marker);
  const ParameterCatalogue::Setting setting = catalogue.nominal();
  const SensitivityTrajectory s =
      simulateWithSensitivities(system, catalogue, setting, wanted, excitation, {options});
  const auto [values, gamma] = ObservedMotion(system, measurement.series).linearised(s);
  const Eigen::VectorXd weighted =
      (values - measurement.measured).cwiseQuotient(measurement.sd.cwiseAbs2());
  const CostGradient g = simulateWithGradient(system, catalogue, setting, wanted, excitation,
                                              options, measurement.cost(system));
  EXPECT_EQ(g.motion.q, s.motion.q);
  const double cost = weighted.dot(values - measurement.measured) / 2;
  EXPECT_NEAR(g.cost, cost, 1e-12 * cost);
  double worst = 0;
  for (Index j = 0; j < gamma.cols(); ++j) {
    const ModelParameter& parameter = catalogue.parameters()[wanted[static_cast<std::size_t>(j)]];
    // what a prior deviation changes of the cost by 1e-12 of it is rounding
    const double scale =
        gamma.col(j).cwiseAbs().dot(weighted.cwiseAbs()) + 1e-3 * cost / parameter.sd;
    const double off = std::abs(gamma.col(j).dot(weighted) - g.gradient[j]);
    worst = std::max(worst, off / scale);
    EXPECT_LE(off, 1e-9 * scale) << parameter.name << ": " << g.gradient[j] << ", forward "
                                 << gamma.col(j).dot(weighted);
  }
  return worst;
}

// 2e-13
TEST(CostGradient, IsTheForwardOneForEveryParameterOfTheShippedModel) {
  const ShippedElbow elbow;
  const auto all = elbow.catalogue.select({"all"});
  EXPECT_EQ(all.size(), 285u);
  EXPECT_LT(offForward(elbow.system, elbow.catalogue, all, elbow.excitation, forSeconds(1)), 1e-9);
}

TEST(CostGradient, IsTheForwardOneForPassiveForcesAndAcrossASwitch) {
  const ShippedElbow elbow("elbow8_passive", "curl_fast");
  EXPECT_LT(offForward(elbow.system, elbow.catalogue, elbow.catalogue.select({"all"}),
                       elbow.excitation, forSeconds(0.8)),
            1e-9);
}

TEST(CostGradient, IsTheForwardOneForTheLeftForcedScheme) {
  const ShippedElbow elbow("elbow8_passive", "curl_fast");
  SimulationOptions options = forSeconds(0.8);
  options.integrator = Integrator::variationalLeft;
  EXPECT_LT(offForward(elbow.system, elbow.catalogue, elbow.catalogue.select({"all"}),
                       elbow.excitation, options),
            1e-9);
}

TEST(CostGradient, IsTheForwardOneForPartsOfStepsByTheirErrors) {
  const ShippedElbow elbow("elbow8_passive", "curl_fast");
  SimulationOptions options = forSeconds(0.8);
  options.integrator = Integrator::variationalAdaptive;
  EXPECT_LT(offForward(elbow.system, elbow.catalogue, elbow.catalogue.select({"all"}),
                       elbow.excitation, options),
            1e-9);
}

TEST(CostGradient, IsTheForwardOneForEmgThatIsDelayedAndShaped) {
  const ShippedElbow elbow("elbow8", "curl_slow", EmgMapping{{{"BRA", 1.1}}, 0.0123, -0.8});
  SimulationOptions options = forSeconds(0.4);
  options.startTime = 0.317;
  EXPECT_LT(offForward(elbow.system, elbow.catalogue,
                       elbow.catalogue.select({"emg.*", "BRA.activation*", "TRIlat.time_scale"}),
                       elbow.excitation, options),
            1e-9);
}

TEST(CostGradient, IsTheForwardOneWhereStepsAreHalvedAndSplit) {
  const ShippedElbow elbow;
  std::vector<double> times;
  Eigen::MatrixXd u(12, static_cast<Index>(elbow.system.numMuscles()));
  for (int k = 0; k < 12; ++k) {
    times.push_back(0.05 * k);
    for (Index i = 0; i < u.cols(); ++i) u(k, i) = (k / 3 + i) % 2 == 0 ? 0.02 : 0.9;
  }
  const ExcitationSignal excitation(times, u);
  const ParameterCatalogue catalogue(elbow.model, elbow.system,
                                     {Eigen::VectorXd::Constant(1, 0.75), {}});
  SimulationOptions options = forSeconds(0.5);
  options.step = 0.05;
  options.maxIterations = 3;
  stepping::StepTape tape;
  stepping::simulateVariational(elbow.system, excitation,
                                startOf(elbow.system, catalogue.nominal(), excitation, 0), options,
                                &tape);
  const auto have = [&](stepping::StepTape::Time::Law law) {
    return std::any_of(tape.times().begin(), tape.times().end(),
                       [&](const auto& time) { return time.law == law; });
  };
  EXPECT_TRUE(have(stepping::StepTape::Time::Law::middle));
  EXPECT_TRUE(have(stepping::StepTape::Time::Law::onSwitch));
  EXPECT_LT(offForward(elbow.system, catalogue, catalogue.select({"all"}), excitation, options),
            1e-9);
}

TEST(CostGradient, IsTheForwardOneForEveryClassOfMuscle) {
  for (const char* name :
       {"Thelen2003", "Millard2012", "DeGrooteFregly2016", "RigidTendon", "RigidTendonMuscle"}) {
    SCOPED_TRACE(name);
    Model model = readOsim(ShippedElbow::root() + "/models/elbow8.osim");
    convertMuscles(model, name);
    const MusculoskeletalSystem system(model, ShippedElbow::options());
    const Trial trial = readTrial(ShippedElbow::root() + "/emg_data/curl_slow.sto", model);
    const ParameterCatalogue catalogue(
        model, system, {startCoordinates(trial, system, {}), Eigen::VectorXd::Constant(1, 0.3)});
    EXPECT_LT(offForward(system, catalogue, catalogue.select({"all"}), excitationOf(trial, system),
                         forSeconds(0.3)),
              1e-9);
  }
}

TEST(CostGradient, IsTheForwardOneOnAnArmOfSeven) {
  Model model = ArmOfSeven::heldModel();
  model.markers.push_back({"M", "hand", {0.02, -0.05, 0.01}});
  const ArmOfSeven c(0.2, ArmOfSeven::coordinates(), false, model);
  const Eigen::VectorXd speeds = Eigen::VectorXd::LinSpaced(7, -0.6, 0.7);
  const ParameterCatalogue catalogue(c.model, c.system, {c.start.q, speeds});
  EXPECT_LT(offForward(c.system, catalogue, catalogue.select({"all"}), c.excitation,
                       forSeconds(0.15), "hand.M"),
            1e-9);
}

TEST(CostGradient, IsTheForwardOneBesideASwungShoulder) {
  const ArmOfSeven c(0.2, {"elbow_flexion", "shoulder_elv", "pro_sup"});
  SystemOptions systemOptions = c.options;
  systemOptions.prescribed = {"shoulder_elv"};
  const MusculoskeletalSystem system(c.model, systemOptions);
  SimulationOptions options = forSeconds(0.12);
  options.prescribed.add(1, {0, 0.05, 0.1, 0.15}, {0.8, 0.9, 0.93, 0.85});
  StartPoint start{c.start.q, Eigen::VectorXd::Zero(3)};
  options.prescribed.place(0, start.q, start.qDot);
  const ParameterCatalogue catalogue(c.model, system, start);
  EXPECT_LT(offForward(system, catalogue, catalogue.select({"all"}), c.excitation, options), 1e-9);
}

TEST(CostGradient, IsTheForwardOneForNumbersOfForcesOnBodies) {
  for (const auto& free : {std::vector<std::string>{"elbow_flexion"}, ArmOfSeven::coordinates()}) {
    const ArmOfSeven c(0.2, free, false, fixtures::withMotor(fixtures::withAll()));
    const ParameterCatalogue catalogue(c.model, c.system, {c.start.q, {}});
    SimulationOptions options = forSeconds(0.15);
    options.externalForce = fixtures::motorForce(c.system.skeleton().numCoordinates());
    const auto wanted = catalogue.select(
        {"band.*", "cord.*", "sleeve.*", "ligament.*", "spring.*", "strap.*", "motor.*"});
    EXPECT_EQ(wanted.size(), 26u);
    EXPECT_LT(offForward(c.system, catalogue, wanted, c.excitation, options), 1e-9);
  }
}

// Whole simulations: of a model changed and compiled anew, from another start, with another sample
// of the excitation.
TEST(CostGradient, IsTheDifferenceOfWholeSimulations) {
  const ShippedElbow elbow;
  SimulationOptions options = forSeconds(0.6);
  options.startTime = 1;  // before, excitations rest, and activations with them: on a kink
  options.newtonTolerance = 1e-13;
  const Measurement measurement(elbow.system, options);
  const auto wanted =
      elbow.catalogue.select({"TRIlat.max_isometric_force", "BIClong.tendon_slack_length",
                              "BRA.point2.x", "TRI.radius", "TRI.translation.x", "hand.mass",
                              "ulna.mass_center.x", "emg.BRA.gain", "activation.time_scale"});
  const ParameterCatalogue::Setting setting = elbow.catalogue.nominal();
  const CostGradient g =
      simulateWithGradient(elbow.system, elbow.catalogue, setting, wanted, elbow.excitation,
                           options, measurement.cost(elbow.system));
  const auto costOf = [&](const ParameterCatalogue::Setting& at, const ExcitationSignal& trial) {
    const MusculoskeletalSystem system(at.model, ShippedElbow::options());
    return measurement.cost(system)(simulateSetting(system, at, trial, options)).value;
  };
  const auto expectSlope = [](double slope, double h, const auto& f, const std::string& name) {
    const double difference = (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h);
    EXPECT_NEAR(slope, difference, 1e-6 * std::abs(difference)) << name;
  };
  for (std::size_t j = 0; j < wanted.size(); ++j) {
    const ModelParameter& parameter = elbow.catalogue.parameters()[wanted[j]];
    const auto at = [&](double change) {
      const Eigen::VectorXd value = Eigen::VectorXd::Constant(1, parameter.value + change);
      return costOf(elbow.catalogue.at({wanted[j]}, value), elbow.excitation);
    };
    expectSlope(g.gradient[static_cast<Index>(j)], 1e-5 * parameter.sd, at, parameter.name);
  }
  const auto started = [&](Eigen::VectorXd StartPoint::*part) {
    return [&, part](double change) {
      ParameterCatalogue::Setting at = setting;
      at.start.qDot.conservativeResize(1);
      if (setting.start.qDot.size() == 0) at.start.qDot.setZero();
      (at.start.*part)[0] += change;
      return costOf(at, elbow.excitation);
    };
  };
  expectSlope(g.startCoordinate[0], 1e-5, started(&StartPoint::q), "start");
  expectSlope(g.startSpeed[0], 1e-3, started(&StartPoint::qDot), "speed at the start");
  constexpr Index muscle = 2, row = 131;
  const auto driven = [&](double change) {
    const std::vector<double>& times = elbow.excitation.times();
    Eigen::MatrixXd u(times.size(), elbow.system.numMuscles());
    std::size_t hint = 0;
    for (std::size_t k = 0; k < times.size(); ++k) {
      elbow.excitation.at(times[k], hint, u.row(static_cast<Index>(k)).transpose());
    }
    u(row, muscle) += change;
    return costOf(setting, {times, u});
  };
  expectSlope(g.excitation(muscle, row), 1e-6, driven, "excitation");
}

TEST(CostGradient, OfAMotionThatFailsIsUnknown) {
  const ShippedElbow elbow;
  SimulationOptions options = forSeconds(1);
  options.progress = [](double t) { return t < 0.5; };
  const CostGradient g =
      simulateWithGradient(elbow.system, elbow.catalogue, elbow.catalogue.nominal(),
                           elbow.catalogue.select({"TRI.radius"}), elbow.excitation, options,
                           Measurement(elbow.system, options).cost(elbow.system));
  EXPECT_EQ(g.motion.outcome, Outcome::stopped);
  EXPECT_TRUE(std::isnan(g.cost) && std::isnan(g.gradient[0]) && std::isnan(g.startSpeed[0]));
}

TEST(CostGradient, WhatHasNoAdjointIsRefused) {
  const ShippedElbow elbow;
  SimulationOptions options = forSeconds(0.1);
  const Measurement measurement(elbow.system, options);
  const auto run = [&](const MotionCost& cost) {
    simulateWithGradient(elbow.system, elbow.catalogue, elbow.catalogue.nominal(), {},
                         elbow.excitation, options, cost);
  };
  const auto squares = [&](ObservedSeries series, double value, double sd) {
    const Index n = series.times.size();
    leastSquaresCost(elbow.system, {std::move(series)}, Eigen::VectorXd::Constant(n, value),
                     Eigen::VectorXd::Constant(n, sd));
  };
  const ObservedSeries angle = measurement.series.front();
  support::throwsSaying(
      [&] {
        squares({{Kind::tendonForce, "BRA", 0}, angle.times}, 1, 1);
      },
      "'BRA.tendon_force' has no adjoint");
  support::throwsSaying([&] { squares(angle, 1, 0); }, "standard deviation");
  support::throwsSaying([&] { squares(angle, std::nan(""), 1); }, "not finite");
  support::throwsSaying(
      [&] { leastSquaresCost(elbow.system, {angle}, Eigen::VectorXd::Zero(3), angle.times); },
      "must be as many");
  support::throwsSaying([&] { run([](const Trajectory&) { return CostOfMotion{}; }); },
                        "slopes of the cost");
  options.integrator = Integrator::cvode;
  support::throwsSaying([&] { run(measurement.cost(elbow.system)); }, "vi or vi-left");
}

}  // namespace
}  // namespace bio
