#include "bio/discovery/musculoskeletal_problem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bio/discovery/add_effects.h"
#include "info/discovery/likelihood/joint_fit.h"
#include "libbio/discovery/effect_cases.h"

namespace bio::discover {
namespace {

using namespace effect_cases;

TEST(LatentForce, NodesMatchDifferencesOfSimulationsWithAnExternalForce) {
  const Case c(0.6);
  const VectorXd values = c.with(c.find("visc"));
  const auto nodes = static_cast<Index>(c.data.nodes(0).size());
  VectorXd latent(nodes);
  for (Index k = 0; k < nodes; ++k) latent[k] = 0.5 * std::sin(1.7 * static_cast<double>(k));
  const auto at = c.data.predict(0, values, latent, {}, true);
  EXPECT_EQ(at.outputs, c.data.outputs(0, values, latent));
  ASSERT_EQ(at.byNode.cols(), nodes);
  double largest = 0;
  for (Index k = 0; k < nodes; ++k) {
    const auto f = [&](double step) {
      VectorXd moved = latent;
      moved[k] += step;
      return c.data.outputs(0, values, moved);
    };
    largest = std::max(largest, at.byNode.col(k).cwiseAbs().maxCoeff());
    EXPECT_LT(problem(at.byNode.col(k), f, 1), 1e-5) << "node " << k;
    // nothing moves before the hat begins
    const double begins = c.data.nodes(0)[static_cast<std::size_t>(std::max<Index>(k - 1, 0))].time;
    for (std::size_t i = 0; i < c.data.times(0).size() && c.data.times(0)[i] <= begins; ++i) {
      EXPECT_EQ(at.byNode(static_cast<Index>(i), k), 0);
    }
  }
  EXPECT_GT(largest, 0.01);
  // 0.1 s/(c₂ + c₁u/2) with c₁ = 7.667, c₂ = 1.46 and excitations of 0 to 0.3
  EXPECT_GT(c.data.latentLag(), 0.038);
  EXPECT_LT(c.data.latentLag(), 0.069);
  // a channel for each muscle, the last of constant size
  ASSERT_EQ(at.scale.cols(), 9);
  EXPECT_TRUE((at.scale.col(8).array() == 0.5).all());
  EXPECT_GT(at.scale.leftCols(8).cwiseAbs().maxCoeff(), 0.5);
}

// The state itself at the nodes, whatever the sensor shows; the last node lies behind the end.
TEST(LatentForce, CourseIsThatOfTheSimulationAndItsDerivativesMatchDifferences) {
  const Case c(0.57);
  VectorXd values = c.with(c.find("visc"));
  for (const char* id : {"bias", "gain", "lag", "drift"}) {
    values[static_cast<Index>(c.find(id).quantities[0])] = 0.05;
  }
  const std::vector<info::discover::Node>& nodes = c.data.nodes(0);
  const auto n = static_cast<Index>(nodes.size());
  const auto free = c.data.predict(0, values, VectorXd::Zero(n), {}, true);
  const Trajectory motion = c.data.motion(0, values);
  ASSERT_EQ(free.course.q.size(), n);
  const auto last = static_cast<Index>(motion.time.size()) - 1;
  const int coordinate = c.data.encompassing().coordinates().front().index;
  for (Index k = 0; k < n; ++k) {
    const auto behind = std::lower_bound(motion.time.begin(), motion.time.end(),
                                         nodes[static_cast<std::size_t>(k)].time - 1e-9);
    const Index row = std::min<Index>(behind - motion.time.begin(), last);
    EXPECT_NEAR(free.course.q[k], motion.q(coordinate, row), 1e-9) << k;
    EXPECT_NEAR(free.course.qDot[k], motion.qDot(coordinate, row), 1e-9) << k;
  }
  EXPECT_GT((free.course.q.array() - free.course.q[0]).abs().maxCoeff(), 0.01);
  VectorXd latent(n);
  for (Index k = 0; k < n; ++k) latent[k] = 0.5 * std::sin(1.7 * static_cast<double>(k));
  const auto at = c.data.predict(0, values, latent, {}, true);
  ASSERT_EQ(at.courseByNode.rows(), n);
  ASSERT_EQ(at.courseByNode.cols(), n);
  for (Index k = 0; k < n; ++k) {
    const auto f = [&](double step) {
      VectorXd moved = latent;
      moved[k] += step;
      return c.data.predict(0, values, moved, {}, true).course.q;
    };
    EXPECT_LT(problem(at.courseByNode.col(k), f, 1), 1e-5) << "node " << k;
  }
  const auto without = c.data.predict(0, values, latent, {}, false);
  EXPECT_EQ(without.course.q.size(), 0);
  EXPECT_EQ(without.courseByNode.size(), 0);
  ASSERT_EQ(c.data.axes().size(), 1U);
  EXPECT_EQ(c.data.axes()[0].name, "elbow_flexion");
  EXPECT_EQ(c.data.axes()[0].forceUnit, "N·m");
}

TEST(MusculoskeletalProblem, DerivativesInNuisancesMatchDifferencesUnderALatentForceAndASensor) {
  const Case c(0.5);
  VectorXd values = c.nominal();
  values[static_cast<Index>(c.find("clock").quantities[0])] = 0.013;
  values[static_cast<Index>(c.find("gain").quantities[0])] = 0.1;
  values[static_cast<Index>(c.find("Fmax_TRI").quantities[0])] = 1.1;
  values[static_cast<Index>(c.find("Fmax_TRIlong").quantities[0])] = 0.9;
  values[static_cast<Index>(c.find("mass").quantities[0])] = 1.05;
  values[static_cast<Index>(c.find("payload").quantities[0])] = 0.1;
  const VectorXd latent = VectorXd::Constant(static_cast<Index>(c.data.nodes(0).size()), 0.3);
  std::vector<std::size_t> wanted = c.data.nuisances();
  for (const char* id : {"clock", "gain", "bias", "Fmax_TRI", "payload"}) {
    wanted.push_back(c.find(id).quantities[0]);
  }
  const auto at = c.data.predict(0, values, latent, wanted, false);
  for (std::size_t j = 0; j < wanted.size(); ++j) {
    const auto& quantity = c.data.quantities()[wanted[j]];
    const double error = problem(
        at.gamma.col(static_cast<Index>(j)),
        [&](double step) {
          VectorXd moved = values;
          moved[static_cast<Index>(wanted[j])] += step;
          return c.data.outputs(0, moved, latent);
        },
        quantity.sd);
    EXPECT_LT(error, 2e-4) << quantity.name;
  }
}

// The prior of a trial's start is about the first measured value, which a sensor that is off has
// shown.
TEST(MusculoskeletalProblem, StartsWhereTheSensorShowsTheFirstAngle) {
  const Case c(0.3);
  VectorXd values = c.nominal();
  const double shown = c.outputs(values)[0];
  values[static_cast<Index>(c.find("bias").quantities[0])] = 0.07;
  values[static_cast<Index>(c.find("gain").quantities[0])] = -0.1;
  const VectorXd off = c.outputs(values);
  EXPECT_NEAR(off[0], shown, 1e-12);
  EXPECT_GT(std::abs(off.tail(1)[0] - c.outputs(c.nominal()).tail(1)[0]), 1e-3);
}

bool areSame(const MusculoskeletalProblem::Prediction& a,
             const MusculoskeletalProblem::Prediction& b) {
  return a.outputs == b.outputs && a.gamma == b.gamma && a.byNode == b.byNode &&
         a.scale == b.scale && a.speeds == b.speeds && a.course.q == b.course.q &&
         a.course.qDot == b.course.qDot && a.courseByNode == b.courseByNode;
}

TEST(MusculoskeletalProblem, DerivativesThatComeLaterAreThoseOfPredict) {
  const Case c(0.4);
  VectorXd values = c.nominal();
  for (const char* id : {"clock", "gain", "lag"}) {
    values[static_cast<Index>(c.find(id).quantities[0])] = 0.01;
  }
  const VectorXd latent = VectorXd::Constant(static_cast<Index>(c.data.nodes(0).size()), 0.3);
  std::vector<std::size_t> wanted = c.data.nuisances();
  for (const char* id : {"clock", "gain", "lag", "bias", "payload"}) {
    wanted.push_back(c.find(id).quantities[0]);
  }
  const auto nudged = c.data.nudged(3);
  const info::discover::DiscoveryProblem& free = c.data;
  for (const auto* data : {&free, static_cast<decltype(&free)>(nudged.get())}) {
    for (const bool latentToo : {false, true}) {
      const auto simulation = data->simulated(0, values, latent, wanted, latentToo);
      EXPECT_TRUE(simulation->outputs() == data->outputs(0, values, latent));
      EXPECT_TRUE(
          areSame(simulation->predict(), data->predict(0, values, latent, wanted, latentToo)));
    }
  }
  values[static_cast<Index>(c.find("lslack_TRI").quantities[0])] = 40;
  const auto failed = c.data.simulated(0, values, latent, wanted, true);
  EXPECT_FALSE(failed->outputs().allFinite());
  EXPECT_FALSE(failed->predict().gamma.allFinite());
}

/// A problem whose derivatives come later or at once, and how many were computed.
class Counted final : public info::discover::DiscoveryProblem {
 public:
  Counted(const MusculoskeletalProblem& of, bool later) : of_(of), later_(later) {}
  const std::vector<info::discover::Quantity>& quantities() const override {
    return of_.quantities();
  }
  const std::vector<std::size_t>& nuisances() const override { return of_.nuisances(); }
  const std::vector<Candidate>& candidates() const override { return of_.candidates(); }
  int numTrials() const override { return of_.numTrials(); }
  std::string trialName(int trial) const override { return of_.trialName(trial); }
  const std::vector<double>& times(int trial) const override { return of_.times(trial); }
  const VectorXd& measured(int trial) const override { return of_.measured(trial); }
  const std::vector<info::discover::Node>& nodes(int trial) const override {
    return of_.nodes(trial);
  }
  Prediction predict(int trial, const VectorXd& values, const VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override {
    ++derivatives;
    return of_.predict(trial, values, latent, wanted, latentToo);
  }
  std::unique_ptr<Simulation> simulated(int trial, const VectorXd& values, const VectorXd& latent,
                                        const std::vector<std::size_t>& wanted,
                                        bool latentToo) const override {
    if (!later_) return nullptr;
    return std::make_unique<Later>(of_.simulated(trial, values, latent, wanted, latentToo), *this);
  }
  VectorXd outputs(int trial, const VectorXd& values, const VectorXd& latent) const override {
    return of_.outputs(trial, values, latent);
  }
  Eigen::MatrixXd inputs(int trial) const override { return of_.inputs(trial); }
  std::vector<std::string> inputNames() const override { return of_.inputNames(); }

  mutable int derivatives = 0;

 private:
  struct Later final : Simulation {
    Later(std::unique_ptr<Simulation> given, const Counted& by) : all(std::move(given)), of(by) {}
    const VectorXd& outputs() const override { return all->outputs(); }
    Prediction predict() override {
      ++of.derivatives;
      return all->predict();
    }
    std::unique_ptr<Simulation> all;
    const Counted& of;
  };

  const MusculoskeletalProblem& of_;
  bool later_;
};

TEST(MusculoskeletalProblem, AFitIsTheSameWithDerivativesOnlyWhereAStepIsTaken) {
  const Case c(1.2);
  VectorXd start = c.nominal();
  for (const char* id : {"Fmax_TRI", "Fmax_BRA"}) {
    start[static_cast<Index>(c.find(id).quantities[0])] = id[5] == 'T' ? 0.55 : 1.6;
  }
  int saved = 0;
  for (const double latent : {0.0, 0.05}) {
    const Counted atOnce(c.data, false), later(c.data, true);
    const auto fitted = [&](const Counted& data) {
      const info::discover::Likelihood likelihood(data, {0}, c.nominal());
      return likelihood.fit(info::discover::makeHypothesis(data, {}, {0}), {0.002, latent, 0.08},
                            start);
    };
    const info::discover::Fit one = fitted(atOnce), other = fitted(later);
    EXPECT_TRUE(one.values == other.values && one.eta == other.eta);
    EXPECT_EQ(one.logEvidence, other.logEvidence);
    EXPECT_EQ(one.iterations, other.iterations);
    EXPECT_LE(later.derivatives, atOnce.derivatives);
    saved += atOnce.derivatives - later.derivatives;
  }
  EXPECT_GT(saved, 0);  // steps that were refused
}

TEST(MusculoskeletalProblem, SaysNothingWhereTheSimulationFails) {
  const Case c(0.3);
  VectorXd values = c.nominal();
  values[static_cast<Index>(c.find("lslack_TRI").quantities[0])] = 40;
  EXPECT_FALSE(c.outputs(values).allFinite());
  EXPECT_FALSE(c.data.failure(0, values).empty());
  const auto at = c.data.predict(0, values, {}, {0}, true);
  EXPECT_FALSE(at.outputs.allFinite());
  EXPECT_EQ(at.byNode.cols(), static_cast<Index>(c.data.nodes(0).size()));
}

TEST(MusculoskeletalProblem, RefusesWhatItCannotUse) {
  const ShippedElbow elbow;
  const auto make = [&](const std::string& coordinate, std::vector<Trial> trials,
                        MusculoskeletalProblemOptions options) {
    return MusculoskeletalProblem(elbow.model, ShippedElbow::options(), coordinate,
                                  std::move(trials), std::move(options));
  };
  EXPECT_THROW(make("elbow_flexion", {}, {}), std::invalid_argument);
  EXPECT_THROW(make("pro_sup", {elbow.trial}, {}), std::invalid_argument);
  Trial unmeasured = elbow.trial;
  unmeasured.measured.clear();
  EXPECT_THROW(make("elbow_flexion", {unmeasured}, {}), std::invalid_argument);
  MusculoskeletalProblemOptions options;
  options.latentFloor = std::nan("");
  EXPECT_THROW(make("elbow_flexion", {elbow.trial}, options), std::invalid_argument);
  options = {};
  options.simulation.integrator = Integrator::cvode;
  EXPECT_THROW(make("elbow_flexion", {elbow.trial}, options), std::invalid_argument);
}

TEST(MusculoskeletalProblem, TellsDelayFromClockWhereSomethingPushes) {
  const ShippedElbow elbow;
  Trial trial = cut(elbow.trial, 0.2);
  const auto equivalentsOf = [&](const std::string& id) {
    const MusculoskeletalProblem data(elbow.model, ShippedElbow::options(), "elbow_flexion",
                                      {trial});
    for (const Candidate& candidate : data.candidates()) {
      if (candidate.id == id) return candidate.equivalents;
    }
    return std::vector<std::string>{"not there"};
  };
  EXPECT_EQ(equivalentsOf("delay"), std::vector<std::string>{"clock"});
  trial.applied = {{"elbow_flexion", VectorXd::Constant(trial.times.size(), 0.5)}};
  EXPECT_EQ(equivalentsOf("delay"), std::vector<std::string>{"clock"});  // always the same push
  trial.applied[0].values[3] = 0;
  EXPECT_TRUE(equivalentsOf("delay").empty());
  EXPECT_TRUE(equivalentsOf("clock").empty());
}

TEST(MusculoskeletalProblem, AKnownMassIsInTheHandBesidesWhatIsMissing) {
  const ShippedElbow elbow;
  const Trial empty = cut(elbow.trial, 0.5);
  Trial loaded = empty;
  loaded.conditions.massInHand = 0.7;
  const auto make = [&](std::vector<Trial> trials) {
    return MusculoskeletalProblem(elbow.model, ShippedElbow::options(), "elbow_flexion",
                                  std::move(trials));
  };
  const MusculoskeletalProblem data = make({empty, loaded});
  const auto mass = static_cast<Index>(data.encompassing().find("payload.mass"));
  VectorXd values = info::discover::nominalValues(data), heavier = values;
  values[mass] = 0.2;
  heavier[mass] = 0.9;
  EXPECT_EQ(data.outputs(1, values, {}), data.outputs(0, heavier, {}));
  EXPECT_NE(data.outputs(1, values, {}), data.outputs(0, values, {}));
  const auto known = static_cast<std::size_t>(mass);
  EXPECT_EQ(data.predict(1, values, {}, {known}, false).gamma,
            data.predict(0, heavier, {}, {known}, false).gamma);
  // a force on the hand does not grow with a mass, a tilt's moment does: where the mass differs
  const auto equivalents = [](const MusculoskeletalProblem& of) {
    for (const Candidate& candidate : of.candidates()) {
      if (candidate.id == "tilt") return candidate.equivalents;
    }
    return std::vector<std::string>{"not there"};
  };
  EXPECT_TRUE(equivalents(data).empty());
  EXPECT_EQ(equivalents(make({loaded, loaded})), std::vector<std::string>{"handforce"});
  // whoever leaves the payload out of the catalogue may still know of a mass
  MusculoskeletalProblemOptions without;
  without.without = {"payload"};
  const MusculoskeletalProblem less(elbow.model, ShippedElbow::options(), "elbow_flexion", {loaded},
                                    without);
  EXPECT_EQ(less.outputs(0, info::discover::nominalValues(less), {}),
            make({loaded}).outputs(0, info::discover::nominalValues(make({loaded})), {}));
}

// Gravity is that of q + turn; the force on the hand, and what a tilt adds, follow.
TEST(MusculoskeletalProblem, AnArmThatIsKnownToBeTurned) {
  const ShippedElbow elbow;
  const Trial upright = cut(elbow.trial, 0.5);
  Trial turned = upright;
  turned.conditions.armTurn = -0.4;
  const MusculoskeletalProblem data(elbow.model, ShippedElbow::options(), "elbow_flexion",
                                    {upright, turned}, Case::exact());
  const auto index = [&](const char* name) {
    return static_cast<Index>(data.encompassing().find(name));
  };
  const Index tilt = index("tilt.angle"), force = index("handforce.force");
  const VectorXd nominal = info::discover::nominalValues(data);
  VectorXd tilted = nominal;
  tilted[tilt] = -0.4;
  EXPECT_EQ(data.outputs(1, nominal, {}), data.outputs(0, tilted, {}));
  EXPECT_GT((data.outputs(1, nominal, {}) - data.outputs(0, nominal, {})).norm(), 0.1);
  // a force on the hand is not that of an arm whose gravity alone is turned
  VectorXd pushed = nominal, pushedAndTilted = tilted;
  pushed[force] = pushedAndTilted[force] = 3;
  EXPECT_GT((data.outputs(1, pushed, {}) - data.outputs(0, pushedAndTilted, {})).norm(), 0.01);
  // derivatives where both are there
  VectorXd values = pushed;
  values[tilt] = 0.1;
  for (const Index quantity : {tilt, force}) {
    const auto f = [&](double step) {
      VectorXd moved = values;
      moved[quantity] += step;
      return data.outputs(1, moved, {});
    };
    const auto gamma = data.predict(1, values, {}, {static_cast<std::size_t>(quantity)}, false);
    EXPECT_LT(problem(gamma.gamma.col(0), f, 1), 5e-4) << quantity;
  }
  // the law of a model that has the force already would turn with the arm
  const Augmented added =
      addEffects(elbow.model, ShippedElbow::options(), "elbow_flexion",
                 {{"handforce", VectorXd::Constant(1, 2), {}, 0, 0}}, {"a test", {}});
  EXPECT_NO_THROW(
      MusculoskeletalProblem(added.model, ShippedElbow::options(), "elbow_flexion", {upright}));
  try {
    MusculoskeletalProblem(added.model, ShippedElbow::options(), "elbow_flexion", {turned});
    ADD_FAILURE() << "was simulated";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("elbow_flexion_handforce"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace bio::discover
