#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bio/discovery/add_effects.h"
#include "bio/discovery/musculoskeletal_problem.h"
#include "bio/opensim/osim_file.h"
#include "info/discovery/likelihood/hypothesis.h"
#include "libbio/discovery/effect_cases.h"
#include "libbio/simulation/arm_of_seven.h"
#include "support/scratch_folder.h"
#include "support/throws_saying.h"

// Discovery of several coordinates, and of channels other than a coordinate.

namespace bio::discover {
namespace {

using effect_cases::problem;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using fixtures::ArmOfSeven;
using Kind = Observable::Kind;
using testing::Contains;
using testing::Not;

constexpr double duration = 0.4;

/// A trial with all these channels, whose values do not matter but for the first of a coordinate.
Trial recorded(const ArmOfSeven& system, const std::vector<Observable>& channels,
               const std::vector<std::string>& prescribed = {}) {
  Trial trial;
  trial.file = "lift";
  trial.times = VectorXd::LinSpaced(41, 0, duration);
  for (const SystemMuscle& muscle : system.system.muscles()) trial.muscles.push_back(muscle.name);
  trial.excitations.resize(41, static_cast<Index>(trial.muscles.size()));
  std::size_t hint = 0;
  VectorXd u(trial.excitations.cols());
  for (Index k = 0; k < 41; ++k) {
    system.excitation.at(trial.times[k], hint, u);
    trial.excitations.row(k) = u.transpose();
  }
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const Index every = i == 1 ? 3 : 2;
    VectorXd times(40 / every);
    for (Index k = 0; k < times.size(); ++k) times[k] = trial.times[every * k + 1];
    const double first = channels[i].object == "shoulder_elv" ? 0.8 : 0.7;
    trial.measured.push_back(
        {channels[i], times, VectorXd::LinSpaced(times.size(), first, first + 0.1)});
  }
  for (const std::string& name : prescribed) {
    const VectorXd course = 0.8 + 0.2 * (5 * trial.times.array()).sin();
    trial.prescribed.push_back({ofCoordinate(name), trial.times, course});
  }
  return trial;
}

MusculoskeletalProblemOptions exact() {
  MusculoskeletalProblemOptions options;
  options.simulation.newtonTolerance = 1e-12;
  options.usableSeries = false;
  return options;
}

std::vector<std::string> idsOf(const MusculoskeletalProblem& data) {
  std::vector<std::string> ids;
  for (const auto& one : data.candidates()) ids.push_back(one.id);
  return ids;
}

std::size_t quantityOf(const MusculoskeletalProblem& data, const std::string& id) {
  for (const auto& one : data.candidates())
    if (one.id == id) return one.quantities.front();
  throw std::invalid_argument("no candidate " + id);
}

/// Every derivative of every output against differences of whole simulations.
void expectDifferences(const MusculoskeletalProblem& data, const VectorXd& values,
                       const std::vector<std::size_t>& wanted, double tolerance) {
  const auto n = static_cast<Index>(data.nodes(0).size());
  VectorXd latent(n);
  for (Index k = 0; k < n; ++k) latent[k] = 0.3 * std::sin(1.7 * static_cast<double>(k));
  const auto at = data.predict(0, values, latent, wanted, true);
  ASSERT_TRUE(at.outputs.allFinite());
  EXPECT_LT((at.outputs - data.outputs(0, values, latent)).cwiseAbs().maxCoeff(), 1e-14);
  const auto& which = data.outputOfSample(0);
  // by output, since a moment of 20 N m would hide a fibre of 0.1 m
  const auto off = [&](const VectorXd& column, const std::function<VectorXd(double)>& f,
                       double scale, int output) {
    std::vector<Index> own;
    for (Index k = 0; k < column.size(); ++k)
      if (which.empty() || which[static_cast<std::size_t>(k)] == output) own.push_back(k);
    return problem(
        column(own), [&](double step) { return VectorXd(f(step)(own)); }, scale);
  };
  const int outputs = static_cast<int>(data.encompassing().sensors().size());
  for (std::size_t j = 0; j < wanted.size(); ++j) {
    const auto& quantity = data.quantities()[wanted[j]];
    const auto f = [&](double step) {
      VectorXd moved = values;
      moved[static_cast<Index>(wanted[j])] += step;
      return data.outputs(0, moved, latent);
    };
    for (int o = 0; o < outputs; ++o)
      EXPECT_LT(off(at.gamma.col(static_cast<Index>(j)), f, quantity.sd, o), tolerance)
          << quantity.name << " of "
          << nameOf(data.encompassing().sensors()[static_cast<std::size_t>(o)]);
  }
  for (Index k = 0; k < n; ++k) {
    const auto f = [&](double step) {
      VectorXd moved = latent;
      moved[k] += step;
      return data.outputs(0, values, moved);
    };
    for (int o = 0; o < outputs; ++o)
      EXPECT_LT(off(at.byNode.col(k), f, 1, o), tolerance) << "node " << k << " of output " << o;
  }
}

struct TwoJoints {
  explicit TwoJoints(const std::vector<Observable>& channels)
      : system(duration, {"elbow_flexion", "shoulder_elv"}),
        data(system.model, system.options,
             std::vector<std::string>{"elbow_flexion", "shoulder_elv"},
             {recorded(system, channels)}, exact()) {}
  ArmOfSeven system;
  MusculoskeletalProblem data;
};

TEST(SeveralCoordinates, EachHasItsEffectsAndEachChannelItsSensor) {
  const TwoJoints c(
      {ofCoordinate("shoulder_elv"), ofCoordinate("elbow_flexion"), {Kind::fibreLength, "BRA", 0}});
  const auto& sensors = c.data.encompassing().sensors();
  ASSERT_EQ(sensors.size(), 3U);
  EXPECT_EQ(nameOf(sensors[0]), "elbow_flexion");  // in the order of the coordinates
  EXPECT_EQ(nameOf(sensors[1]), "shoulder_elv");
  EXPECT_EQ(nameOf(sensors[2]), "BRA.fiber_length");
  const auto ids = idsOf(c.data);
  for (const char* id :
       {"elbow_flexion.visc", "elbow_flexion.coulomb", "shoulder_elv.coulomb",
        "shoulder_elv.torque_from", "payload", "tilt", "Fmax_TRI", "delay", "biarticular_BIC",
        "biarticular_TRI", "elbow_flexion.bias", "shoulder_elv.gain", "BRA.fiber_length.lag"})
    EXPECT_THAT(ids, Contains(id));
  for (const char* id :
       {"visc", "bias", "shoulder_elv.visc", "handforce", "spring", "mass_from", "biarticular_BRA"})
    EXPECT_THAT(ids, Not(Contains(id)));
  EXPECT_TRUE(c.data.encompassing().present().contains("shoulder_elv.visc"));  // of its holder
  const auto& axes = c.data.axes();
  ASSERT_EQ(axes.size(), 2U);
  EXPECT_EQ(axes[1].name, "shoulder_elv");
  const auto& nodes = c.data.nodes(0);
  ASSERT_EQ(nodes.size(), 18U);  // 0, 0.05, …, 0.4 s on each
  EXPECT_EQ(nodes[8].axis, 0U);
  EXPECT_EQ(nodes[9].axis, 1U);
  EXPECT_EQ(nodes[9].time, nodes[0].time);
  // samples by time, and at one time by output
  const auto& times = c.data.times(0);
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  ASSERT_EQ(c.data.outputOfSample(0).size(), times.size());
  EXPECT_EQ(c.data.measured(0).size(), static_cast<Index>(times.size()));
  for (const char* name : {"trial1.initial.elbow_flexion", "trial1.initial.shoulder_elv.speed"})
    EXPECT_TRUE(std::any_of(c.data.quantities().begin(), c.data.quantities().end(),
                            [&](const auto& one) { return one.name == name; }))
        << name;
}

TEST(SeveralCoordinates, DerivativesMatchDifferences) {
  const TwoJoints c({ofCoordinate("elbow_flexion"),
                     ofCoordinate("shoulder_elv"),
                     {Kind::fibreLength, "BRA", 0},
                     {Kind::speed, "elbow_flexion", 0}});
  VectorXd values = info::discover::nominalValues(c.data);
  const auto set = [&](const char* id, double value) {
    values[static_cast<Index>(quantityOf(c.data, id))] = value;
  };
  set("elbow_flexion.gain", 0.1);
  set("shoulder_elv.bias", 0.05);
  set("shoulder_elv.lag", 0.02);
  set("shoulder_elv.coulomb", 0.3);
  set("payload", 0.2);
  set("delay", 0.013);
  set("shoulder_elv.torque_from", 0.5);
  std::vector<std::size_t> wanted;
  for (const char* id :
       {"elbow_flexion.visc", "shoulder_elv.coulomb", "payload", "tilt", "Fmax_TRI", "delay",
        "shoulder_elv.torque_from", "elbow_flexion.gain", "elbow_flexion.bias", "shoulder_elv.bias",
        "shoulder_elv.lag", "shoulder_elv.gain", "elbow_flexion.clock", "elbow_flexion.drift",
        "BRA.fiber_length.bias", "BRA.fiber_length.gain"})
    wanted.push_back(quantityOf(c.data, id));
  for (std::size_t i = 0; i < c.data.quantities().size(); ++i)
    if (c.data.quantities()[i].trial == 0) wanted.push_back(i);
  expectDifferences(c.data, values, wanted, 2e-4);
}

// As the model's moment arms at mid-range say, and only while it is long.
TEST(SeveralCoordinates, BiarticularTissuePullsAllJointsThatItCrosses) {
  const TwoJoints c({ofCoordinate("elbow_flexion"), ofCoordinate("shoulder_elv")});
  const EncompassingModel& encompassing = c.data.encompassing();
  const auto& groups = encompassing.groups();
  const auto group = std::find_if(groups.begin(), groups.end(),
                                  [](const MuscleGroup& one) { return one.name == "BIC"; });
  ASSERT_NE(group, groups.end());
  const auto k = static_cast<Index>(encompassing.find("biarticular_BIC.stiffness")),
             r = static_cast<Index>(encompassing.find("biarticular_BIC.rest"));
  const VectorXd nominal = info::discover::nominalValues(c.data);
  const auto outputs = [&](double stiffness, double rest) {
    VectorXd values = nominal;
    values[k] = stiffness;
    values[r] = rest;
    return c.data.outputs(0, values, {});
  };
  const double middle = nominal[r];
  const VectorXd absent = outputs(0, middle);
  EXPECT_EQ(outputs(0, 0.6 * middle), absent);
  // switched on, but without force: a step computes its last configuration anew, not by a shift
  const std::vector<std::size_t> both = {static_cast<std::size_t>(k), static_cast<std::size_t>(r)};
  EXPECT_LT((c.data.predict(0, nominal, {}, both, false).outputs - absent).cwiseAbs().maxCoeff(),
            1e-12);  // 3e-14
  EXPECT_LT((outputs(500, 1.5 * middle) - absent).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT((outputs(500, 0.6 * middle) - absent).cwiseAbs().maxCoeff(), 1e-3);
  VectorXd values = nominal;
  values[k] = 500;
  values[r] = 0.6 * middle;
  expectDifferences(c.data, values, both, 2e-4);
  // moments of the law itself
  const auto setting =
      encompassing.settingAt(values.head(static_cast<Index>(encompassing.quantities().size())), {});
  const MusculoskeletalSystem system = encompassing.systemOf(setting);
  ASSERT_EQ(system.elasticPaths().size(), 1U);
  VectorXd q = system.skeleton().defaultValues();
  double length = middle;
  for (Index i = 0; i < 2; ++i) {
    const MovingCoordinate& at = encompassing.coordinates()[static_cast<std::size_t>(i)];
    q[at.index] = at.middle() + 0.3;
    length -= group->momentArms[i] * 0.3;  // it pulls as the muscles do
  }
  const auto& path = system.elasticPaths().front();
  EXPECT_NEAR(path.path.compiled().function->at(q.data()).length, length, 1e-12);
  EXPECT_NEAR(path.law.tension(length, 0).force, 500 * (length - 0.6 * middle), 1e-9);
  // as OpenSim's PathSpring, which is known again
  const Augmented added = addEffects(
      encompassing, {{"biarticular_BIC", Eigen::Vector2d(500, 0.6 * middle), {}, 0, 0}}, {"", {}});
  const support::ScratchFolder folder;
  writeOsim(added.model, folder / "biarticular.osim");
  const MusculoskeletalProblem again(
      readOsim(folder / "biarticular.osim"), c.system.options,
      std::vector<std::string>{"elbow_flexion", "shoulder_elv"},
      {recorded(c.system, {ofCoordinate("elbow_flexion"), ofCoordinate("shoulder_elv")})}, exact());
  EXPECT_TRUE(again.encompassing().present().contains("biarticular_BIC"));
  EXPECT_LT(
      (again.outputs(0, info::discover::nominalValues(again), {}) - outputs(500, 0.6 * middle))
          .cwiseAbs()
          .maxCoeff(),
      1e-9);
}

// One error of a muscle pushes every joint that it crosses, by its moments there.
TEST(SeveralCoordinates, AMusclesErrorActsOnAllThatItCrosses) {
  const TwoJoints c({ofCoordinate("elbow_flexion"), ofCoordinate("shoulder_elv")});
  const VectorXd values = info::discover::nominalValues(c.data);
  const auto at = c.data.predict(0, values, {}, {}, true);
  const auto n = static_cast<Index>(c.data.nodes(0).size()) / 2;
  ASSERT_EQ(at.scale.rows(), 2 * n);
  const auto& muscles = c.data.encompassing().system().muscles();
  ASSERT_EQ(at.scale.cols(), static_cast<Index>(muscles.size()) + 2);
  for (std::size_t m = 0; m < muscles.size(); ++m) {
    const auto column = at.scale.col(static_cast<Index>(m));
    EXPECT_GT(column.head(n).cwiseAbs().maxCoeff(), 1e-3) << muscles[m].name;
    const bool isLong = muscles[m].name == "BIClong" || muscles[m].name == "BICshort" ||
                        muscles[m].name == "TRIlong";
    EXPECT_EQ(column.tail(n).cwiseAbs().maxCoeff() > 1e-3, isLong) << muscles[m].name;
  }
  EXPECT_TRUE((at.scale.rightCols(2).topRows(n).col(0).array() == 0.5).all());
  EXPECT_TRUE((at.scale.rightCols(2).topRows(n).col(1).array() == 0).all());
  EXPECT_TRUE((at.scale.rightCols(2).bottomRows(n).col(1).array() == 0.5).all());
}

// A dynamometer moves the shoulder and reads its moment; the elbow is free.
TEST(SeveralCoordinates, AMomentIsAnOutput) {
  ArmOfSeven system(duration, {"elbow_flexion", "shoulder_elv"});
  system.options.prescribed = {"shoulder_elv"};
  const MusculoskeletalProblem data(
      system.model, system.options, std::vector<std::string>{"shoulder_elv"},
      {recorded(system, {{Kind::moment, "shoulder_elv", 0}}, {"shoulder_elv"})}, exact());
  EXPECT_THAT(idsOf(data), Contains("coulomb"));
  VectorXd values = info::discover::nominalValues(data);
  values[static_cast<Index>(quantityOf(data, "gain"))] = 0.1;
  values[static_cast<Index>(quantityOf(data, "coulomb"))] = 0.4;
  values[static_cast<Index>(quantityOf(data, "delay"))] = 0.013;
  std::vector<std::size_t> wanted;
  for (const char* id : {"coulomb", "payload", "Fmax_TRI", "lslack_TRIlong", "delay", "const",
                         "bias", "gain", "drift"})
    wanted.push_back(quantityOf(data, id));
  expectDifferences(data, values, wanted, 5e-4);
  EXPECT_EQ(data.nudged(10), nullptr);  // nothing that is free is measured
}

TEST(SeveralCoordinates, RefusesATrialWithoutAnyOfTheChannels) {
  const ArmOfSeven system(duration, {"elbow_flexion", "shoulder_elv"});
  Trial other = recorded(system, {});
  support::throwsSaying(
      [&] {
        MusculoskeletalProblem(
            system.model, system.options, std::vector<std::string>{"elbow_flexion", "shoulder_elv"},
            {recorded(system, {ofCoordinate("elbow_flexion"), ofCoordinate("shoulder_elv")}),
             other},
            exact());
      },
      "lift: no measured value of 'elbow_flexion', 'shoulder_elv'");
}

}  // namespace
}  // namespace bio::discover
