// Effects that the catalogue lacks, by formulas of the user's.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "bio/discovery/effects.h"
#include "bio/discovery/user_effect.h"
#include "bio/discovery/workflow.h"
#include "bio/tables/file_error.h"
#include "libbio/discovery/free_swing.h"
#include "support/throws_saying.h"

namespace bio::discover {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string example = std::string(FISHERHILL_SOURCE_DIR) + "/emg_data/effects.toml";

TEST(UserEffects, AreReadFromTheShippedExample) {
  const std::vector<UserEffect> all = readUserEffects({example});
  ASSERT_EQ(all.size(), 1u);
  const UserEffect& thinning = all.front();
  EXPECT_EQ(thinning.id, "thinning");
  EXPECT_EQ(thinning.name, "damping that thins");
  EXPECT_EQ(thinning.coordinate, "");
  EXPECT_THAT(thinning.constants, ElementsAre("c", "v"));
  ASSERT_EQ(thinning.quantities.size(), 2u);
  EXPECT_EQ(thinning.quantities[0].name, "thinning.c");
  EXPECT_EQ(thinning.quantities[0].nominal, 0);
  EXPECT_EQ(thinning.quantities[0].upper, 5);
  EXPECT_EQ(thinning.quantities[1].nominal, 1);
  EXPECT_EQ(thinning.quantities[1].unit, "rad/s");
  EXPECT_THAT(thinning.starts, ElementsAre(ElementsAre(0.15, 1)));
}

TEST(UserEffects, AreRefusedWithTheirKey) {
  const std::string amplitude =
      "[[effect.parameter]]\nname = \"c\"\nlower = 0\nupper = 1\nsd = 0.5\n";
  const auto with = [](const std::string& key, const std::string& value) {
    return "[[effect.parameter]]\nname = \"v\"\n" +
           (key == "nominal" ? "" : std::string("nominal = 1\n")) +
           (key == "lower" ? "" : std::string("lower = 0.5\n")) + "upper = 2\n" +
           (key == "sd" ? "" : std::string("sd = 1\n")) +
           (value.empty() ? "" : key + " = " + value) + "\n";
  };
  const std::string head = "[[effect]]\nid = \"a\"\nexpression = \"-c*qdot\"\n";
  const std::string both = "[[effect]]\nid = \"a\"\nexpression = \"-c*qdot*v\"\n" + amplitude;
  const std::vector<std::pair<std::string, const char*>> bad = {
      {"", "needs a key 'effect'"},
      {"[[effect]]\nexpression = \"c\"\n" + amplitude, "needs a key 'id'"},
      {"[[effect]]\nid = \"A\"\nexpression = \"c\"\n" + amplitude, "id = \"A\", must be small"},
      {"[[effect]]\nid = \"a\"\n" + amplitude, "needs a key 'expression'"},
      {head, "needs a [[effect.parameter]]"},
      {"[[effect]]\nid = \"a\"\nexpression = \"-c*speed\"\n" + amplitude, "speed"},
      {"[[effect]]\nid = \"a\"\nexpression = \"-c*(qdot\"\n" + amplitude, "expression = "},
      {"[[effect]]\nid = \"a\"\nexpression = \"1-c*qdot\"\n" + amplitude, "must vanish where c"},
      {head + amplitude + head + amplitude, "is given twice"},
      {head + amplitude + "nominal = 1\n", "nominal = 1, must be 0"},
      {head + amplitude + "starts = [0.5, 2]\n", "must lie within the bounds"},
      {head + amplitude + "weight = 3\n", "weight"},
      {both + with("nominal", ""), "needs a key 'nominal'"},
      {both + with("lower", "1.5"), "at most the nominal value"},
      {both + with("lower", "-inf"), "must be finite"},
      {both + with("sd", "0"), "must be finite and > 0"},
      {both + with("starts", "[1]"), "is for the first parameter"},
      {head + amplitude + "[[effect.parameter]]\nname = \"qdot\"\n", "has a meaning already"},
      {head + amplitude + "[[effect.parameter]]\nname = \"c\"\n", "has a meaning already"},
  };
  const support::ScratchFolder folder;
  for (const auto& [text, words] : bad) {
    const std::string file = folder.file("bad.toml", text);
    EXPECT_THAT(support::refusalIn<FileError>(folder.path(), [&] { readUserEffects({file}); }),
                HasSubstr(words))
        << text;
  }
  EXPECT_NO_THROW(readUserEffects({folder.file("good.toml", both + with("lower", "0.5"))}));
}

TEST(UserEffects, StandBesideTheCatalogueUnderTheirOwnNamesOnly) {
  const Model model = freePendulum(0.1);
  const SystemOptions system{{{"swing"}, {}}, {}, {}};
  std::vector<UserEffect> own = readUserEffects({example});
  const auto build = [&] { return encompassingModel(model, system, "swing", {.own = own}); };
  EXPECT_TRUE(build().knows("thinning"));
  EXPECT_EQ(build().candidates().size(),
            encompassingModel(model, system, "swing").candidates().size() + 1);
  own.push_back(own.front());
  support::throwsSaying(build, "id = \"thinning\", there is another effect of this name");
  own.pop_back();
  for (const char* taken : {"visc", "biarticular"}) {
    own.front().id = taken;
    support::throwsSaying(build, "there is another effect of this name");
  }
  own.front().id = "thinning";
  own.front().coordinate = "knee";
  support::throwsSaying(build, "coordinate = \"knee\", which is not in question");
}

TEST(UserEffects, AreOfEveryCoordinateWhereNoneIsGiven) {
  const std::string robot =
      std::string(FISHERHILL_SOURCE_DIR) + "/models/robots/cart_double_pendulum.osim";
  const std::vector<std::string> links = {"link1", "link2"};
  const SystemOptions system{{links, {}}, {}, {}};
  std::vector<UserEffect> own = readUserEffects({example});
  const auto build = [&] {
    return encompassingModel(readOsim(robot), system, links, {.own = own});
  };
  std::vector<std::string> ids;
  const EncompassingModel model = build();
  for (const auto& candidate : model.candidates())
    if (candidate.id.find("thinning") != std::string::npos) ids.push_back(candidate.id);
  EXPECT_THAT(ids, ElementsAre("link1.thinning", "link2.thinning"));
  own.push_back(own.front());
  support::throwsSaying(build, "id = \"thinning\", there is another effect of this name");
}

// The pendulum is damped by what the catalogue has no word for.
TEST(UserEffects, AreFoundAndWritten) {
  const double mass = 2, amplitude = 0.12, speed = 0.8;
  const auto thins = [&](double w) { return amplitude * w / (1 + std::abs(w) / speed) / mass; };
  const Model model = freePendulum(mass);
  DiscoveryRequest request{
      model,
      SystemOptions{{{"swing"}, {}}, {}, {}},
      "swing",
      {freeSwing(1.2, 1, thins), freeSwing(0.7, 2, thins), freeSwing(0.3, 3, thins)},
      1,
      0.005,
      {},
      {},
      {"a test", {}}};
  request.problem.own = readUserEffects({example});
  const DiscoveryResult result = discover(request);
  const info::discover::Verdict& verdict = result.found.verdict;
  ASSERT_EQ(verdict.effects.size(), 1u) << verdict.sentence;
  EXPECT_EQ(result.data->candidates()[verdict.effects[0].candidate].id, "thinning")
      << verdict.sentence;
  for (const auto& [index, truth] : {std::pair(0u, amplitude), {1u, speed}}) {
    const info::discover::Estimate& found = verdict.effects[0].estimates[index];
    EXPECT_NEAR(found.value, truth, 3 * found.sd) << index;
  }
  ASSERT_TRUE(result.repaired && result.effectOnly);
  ASSERT_EQ(result.repaired->added.model.expressionForces.size(), 1u);
  EXPECT_EQ(result.repaired->added.model.expressionForces[0].name, "swing_thinning");
  for (const RepairedTrial& trial : result.trials)
    EXPECT_NEAR(trial.after, trial.fitted, 1e-4) << trial.index;
  // in a model that has it, it is no candidate
  EXPECT_EQ(encompassingModel(result.effectOnly->model, request.system, "swing",
                              {.own = request.problem.own})
                .present()
                .count("thinning"),
            1u);
}

}  // namespace
}  // namespace bio::discover
