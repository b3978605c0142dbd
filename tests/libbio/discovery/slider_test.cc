// A cart between two muscles: the same search on a coordinate that slides, in N and m.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "bio/discovery/musculoskeletal_problem.h"
#include "bio/opensim/osim_file.h"
#include "info/discovery/discover.h"
#include "support/scratch_folder.h"

namespace bio::discover {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

std::string muscle(const char* name, const char* origin, const char* insertion) {
  return std::string("<Thelen2003Muscle name=\"") + name +
         "\"><GeometryPath><PathPointSet><objects><PathPoint name=\"o\"><location>" + origin +
         " 0 0</location><body>ground</body></PathPoint><PathPoint name=\"i\"><location>" +
         insertion +
         " 0 0</location><body>cart</body></PathPoint></objects></PathPointSet></GeometryPath>"
         "<max_isometric_force>60</max_isometric_force><optimal_fiber_length>0.15"
         "</optimal_fiber_length><tendon_slack_length>0.1</tendon_slack_length>"
         "<pennation_angle_at_optimal>0</pennation_angle_at_optimal></Thelen2003Muscle>";
}

Model cart() {
  const support::ScratchFolder folder;
  return readOsim(folder.file(
      "cart.osim",
      "<OpenSimDocument Version=\"30000\"><Model name=\"cart\"><gravity>0 -9.81 0</gravity>"
      "<BodySet><objects><Body name=\"ground\"><mass>0</mass></Body><Body name=\"cart\"><mass>2"
      "</mass><mass_center>0 0 0</mass_center><inertia_xx>0.02</inertia_xx><inertia_yy>0.02"
      "</inertia_yy><inertia_zz>0.02</inertia_zz><inertia_xy>0</inertia_xy><inertia_xz>0"
      "</inertia_xz><inertia_yz>0</inertia_yz><Joint><SliderJoint name=\"rail\"><parent_body>ground"
      "</parent_body><CoordinateSet><objects><Coordinate name=\"x\"><default_value>0"
      "</default_value><range>-0.1 0.1</range></Coordinate></objects></CoordinateSet></SliderJoint>"
      "</Joint></Body></objects></BodySet><ForceSet><objects>" +
          muscle("left", "-0.27", "-0.02") + muscle("right", "0.27", "0.02") +
          "</objects></ForceSet></Model></OpenSimDocument>"));
}

/// Two seconds of alternating excitations, and a place for the measured values.
Trial pulled(double frequency) {
  Trial trial;
  trial.file = "pulled.sto";
  trial.muscles = {"left", "right"};
  trial.times = VectorXd::LinSpaced(301, 0, 3);
  trial.excitations.resize(301, 2);
  for (Index k = 0; k < 301; ++k) {
    const double phase = 2 * std::numbers::pi * frequency * trial.times[k];
    trial.excitations.row(k) << 0.12 + 0.1 * std::sin(phase), 0.12 + 0.1 * std::sin(1.37 * phase);
  }
  trial.measured.push_back({ofCoordinate("x"), trial.times, VectorXd::LinSpaced(301, 0, 0.01)});
  return trial;
}

MusculoskeletalProblem problemOf(const std::vector<Trial>& trials) {
  return MusculoskeletalProblem(cart(), SystemOptions{{{"x"}, {}}, {}, {}}, "x", trials, {});
}

std::size_t candidateOf(const MusculoskeletalProblem& data, const std::string& id) {
  for (std::size_t i = 0; i < data.candidates().size(); ++i)
    if (data.candidates()[i].id == id) return i;
  throw std::invalid_argument(id);
}

TEST(Slider, HasEffectsInNewtonsAndMetres) {
  const MusculoskeletalProblem data = problemOf({pulled(0.5)});
  for (const auto& quantity : data.quantities()) {
    EXPECT_EQ(quantity.unit.find("rad"), std::string::npos) << quantity.name << quantity.unit;
    EXPECT_EQ(quantity.unit.find("N m"), std::string::npos) << quantity.name << quantity.unit;
    EXPECT_EQ(quantity.name.find("torque."), std::string::npos) << quantity.name;
    if (quantity.name == "trial1.initial.x") {
      EXPECT_DOUBLE_EQ(quantity.sd, 0.035 / 8);
    }
    if (quantity.name == "trial1.initial.x.speed") {
      EXPECT_DOUBLE_EQ(quantity.sd, 0.1 / 8);
    }
  }
  const auto amplitudeOf = [&](const char* id) {
    return data.quantities()[data.candidates()[candidateOf(data, id)].quantities.front()];
  };
  EXPECT_EQ(amplitudeOf("visc").unit, "N s/m");
  EXPECT_EQ(amplitudeOf("visc").upper, 24);  // 3 N m s/rad · 8 rad/m · 60 N of 64
  EXPECT_EQ(amplitudeOf("stiffness").unit, "N/m");
  EXPECT_EQ(amplitudeOf("cubic").unit, "N/m^3");
  EXPECT_EQ(amplitudeOf("cubic").upper, 20 * 512);
  EXPECT_EQ(amplitudeOf("coulomb").name, "coulomb.force");
  EXPECT_EQ(amplitudeOf("drag").unit, "N s^2/m^2");
  EXPECT_EQ(data.candidates()[candidateOf(data, "const")].name, "constant joint force");
}

TEST(Slider, FrictionIsNamedWithItsSize) {
  std::vector<Trial> trials = {pulled(0.5), pulled(0.8)};
  const MusculoskeletalProblem still = problemOf(trials);
  VectorXd truth(static_cast<Index>(still.quantities().size()));
  for (Index i = 0; i < truth.size(); ++i)
    truth[i] = still.quantities()[static_cast<std::size_t>(i)].nominal;
  truth[static_cast<Index>(still.candidates()[candidateOf(still, "visc")].quantities.front())] = 6;
  std::mt19937 generator(4);
  std::normal_distribution<double> scatter(0, 2e-4);
  for (int t = 0; t < 2; ++t) {
    VectorXd& values = trials[static_cast<std::size_t>(t)].measured.front().values;
    values = still.outputs(t, truth, {});
    for (double& value : values) value += scatter(generator);
  }
  const MusculoskeletalProblem data = problemOf(trials);
  const info::discover::Verdict verdict = info::discover::run(data, {});
  EXPECT_EQ(verdict.finding, info::discover::Finding::named) << verdict.sentence;
  ASSERT_EQ(verdict.effects.size(), 1u) << verdict.sentence;
  EXPECT_EQ(data.candidates()[verdict.effects[0].candidate].id, "visc");
  const info::discover::Estimate& b = verdict.effects[0].estimates.front();
  EXPECT_NEAR(b.value, 6, 4 * b.sd);
  EXPECT_LT(b.sd, 0.6);
}

}  // namespace
}  // namespace bio::discover
