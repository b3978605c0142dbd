#include "robots/robot_discovery.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "support/throws_saying.h"

namespace {

using namespace info::robot;
using support::throwsSaying;

bool isCandidate(const Model& model, const std::string& id) {
  return std::any_of(model.candidates.begin(), model.candidates.end(),
                     [&](const auto& c) { return c.id == id; });
}

double nominalOf(const Model& model, const std::string& name) {
  for (const auto& quantity : model.quantities)
    if (quantity.name == name) return quantity.nominal;
  return std::nan("");
}

Trial forces(const std::vector<double>& values) {
  Trial trial{"trial", {}, std::vector<double>(values.size(), 0.0), {}};
  trial.measured.resize(std::ssize(values), 1);
  for (std::size_t k = 0; k < values.size(); ++k) {
    trial.times.push_back(0.01 * static_cast<double>(k));
    trial.measured(static_cast<Eigen::Index>(k), 0) = values[k];
  }
  return trial;
}

TEST(RobotDiscovery, AnEffectThatIsBuiltInIsNoCandidateAnyMore) {
  Model model = suspendedMass(0, 2);
  ASSERT_TRUE(isCandidate(model, "bias"));
  EXPECT_THAT(buildIn({{"bias", {{"bias", 0.2}}}}, model), testing::ElementsAre("bias"));
  EXPECT_FALSE(isCandidate(model, "bias"));
  EXPECT_EQ(nominalOf(model, "bias"), 0.2);
}

TEST(RobotDiscovery, AnErrorOfAParameterStaysACandidateFromItsNewValue) {
  Model model = suspendedMass(0, 2);
  EXPECT_THAT(buildIn({{"length", {{"length", 0.6}}}}, model), testing::IsEmpty());
  EXPECT_EQ(nominalOf(model, "length"), 0.6);
  const auto length = std::find_if(model.candidates.begin(), model.candidates.end(),
                                   [](const auto& c) { return c.id == "length"; });
  ASSERT_NE(length, model.candidates.end());
  EXPECT_EQ(length->starts.front()[0], 0.6);
}

TEST(RobotDiscovery, RefusesEffectsThatItCannotBuildIn) {
  Model model = suspendedMass(0, 2);
  throwsSaying([&] { buildIn({{"visc_1", {}}}, model); }, "visc_1 is not in the catalogue");
  throwsSaying([&] { buildIn({{"bias", {}}}, model); }, "bias has no value of bias");
  throwsSaying([&] { buildIn({{"bias", {{"bias", std::nan("")}}}}, model); }, "bias: nan N, must");
}

TEST(RobotDiscovery, KnowsTwoRobots) {
  EXPECT_EQ(channelsOf("double-pendulum").size(), 2u);
  EXPECT_EQ(channelsOf("suspended-mass").front().unit, "N");
  throwsSaying([] { channelsOf("baxter"); }, "must be double-pendulum or suspended-mass");
  throwsSaying([] { modelFor("baxter", {}); }, "must be double-pendulum or suspended-mass");
  throwsSaying([] { modelFor("suspended-mass", {forces({1, 1, 1})}); }, "force is constant");
  EXPECT_EQ(modelFor("suspended-mass", {forces({1, std::nan(""), 2})}).name, "suspended-mass");
}

TEST(RobotDiscovery, RefusesAStepLongerThanATrial) {
  DiscoveryRequest request;
  request.trials = {forces({1, 2, 1, 2, 1, 2, 1, 2, 1, 2})};
  request.model = modelFor("suspended-mass", request.trials);
  request.step = 0.2;
  throwsSaying([&] { info::robot::discover(request); },
               "step: 0.2 s, must not be longer than trial");
}

}  // namespace
