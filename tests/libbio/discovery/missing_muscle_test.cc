#include <gtest/gtest.h>

#include <algorithm>

#include "bio/discovery/add_effects.h"
#include "bio/discovery/effects.h"
#include "info/discovery/likelihood/hypothesis.h"
#include "libbio/discovery/effect_cases.h"

namespace bio::discover {
namespace {

using namespace effect_cases;

/// The shipped elbow as someone has it who left the brachioradialis out.
struct WithoutBRD {
  WithoutBRD() {
    for (Muscle& muscle : model.muscles) muscle.enabled = muscle.name != "BRD";
  }
  MusculoskeletalProblem data(const Trial& of, const Model& in) const {
    return {in, ShippedElbow::options(), "elbow_flexion", {of}, Case::exact()};
  }
  ShippedElbow elbow;
  Model model = elbow.model;
  Trial trial = cut(elbow.trial, 0.5);
};

TEST(MissingMuscle, IsTheOneThatTheModelSwitchedOff) {
  const WithoutBRD c;
  const MusculoskeletalProblem data = c.data(c.trial, c.model);
  ASSERT_TRUE(data.encompassing().knows("missing_BRD"));
  EXPECT_FALSE(c.data(c.trial, c.elbow.model).encompassing().knows("missing_BRD"));
  const auto strength = static_cast<Index>(data.encompassing().find("missing_BRD.strength"));
  VectorXd values = info::discover::nominalValues(data);
  const VectorXd without = data.outputs(0, values, {});
  // absent, even where its derivative is asked for
  const auto at = data.predict(0, values, {}, {static_cast<std::size_t>(strength)}, false);
  EXPECT_LT((at.outputs - without).cwiseAbs().maxCoeff(), 1e-12);
  values[strength] = 1;
  const VectorXd with = data.outputs(0, values, {});
  EXPECT_GT((with - without).cwiseAbs().maxCoeff(), 0.01);
  // as strong as in the file, with its own EMG: the model with that muscle, but for path tables
  const MusculoskeletalProblem whole = c.data(c.trial, c.elbow.model);
  const VectorXd there = whole.outputs(0, info::discover::nominalValues(whole), {});
  EXPECT_LT((with - there).cwiseAbs().maxCoeff(), 1e-10);
  for (const double r : {0.0, 0.6}) {
    values[strength] = r;
    const VectorXd gamma =
        data.predict(0, values, {}, {static_cast<std::size_t>(strength)}, true).gamma;
    const auto f = [&](double step) {
      VectorXd moved = values;
      moved[strength] += step;
      return data.outputs(0, moved, {});
    };
    const VectorXd slope = r > 0 ? difference(f, 1e-4) : VectorXd((f(1e-5) - f(0)) / 1e-5);
    EXPECT_LT((gamma - slope).cwiseAbs().maxCoeff() / slope.cwiseAbs().maxCoeff(),
              r > 0 ? 1e-5 : 1e-3);
  }
}

TEST(MissingMuscle, HasTheMeanEmgOfThoseThatPullAsItDoesIfItHasNone) {
  const WithoutBRD c;
  Trial trial = c.trial;
  const auto own = std::find(trial.muscles.begin(), trial.muscles.end(), "BRD");
  ASSERT_EQ(own + 1, trial.muscles.end());
  trial.muscles.pop_back();
  trial.excitations.conservativeResize(Eigen::NoChange, trial.excitations.cols() - 1);
  const MusculoskeletalProblem data = c.data(trial, c.model);
  EXPECT_EQ(data.encompassing().synergists().at("BRD"),
            (std::vector<std::string>{"BIClong", "BICshort", "BRA"}));
  const Trial with = withSynergists(trial, data.encompassing());
  ASSERT_EQ(with.muscles.back(), "BRD");
  const auto column = [&](const std::string& muscle) {
    const auto at = std::find(with.muscles.begin(), with.muscles.end(), muscle);
    return VectorXd(with.excitations.col(at - with.muscles.begin()));
  };
  EXPECT_LT((3 * column("BRD") - column("BIClong") - column("BICshort") - column("BRA"))
                .cwiseAbs()
                .maxCoeff(),
            1e-15);
  // its own EMG goes before
  EXPECT_EQ(withSynergists(c.trial, data.encompassing()).excitations, c.trial.excitations);
}

TEST(MissingMuscle, IsSwitchedOnInTheModelWithTheEffect) {
  const WithoutBRD c;
  const auto added = [&](double strength) {
    return addEffects(c.model, ShippedElbow::options(), "elbow_flexion",
                      {{"missing_BRD", Eigen::Vector3d(strength, 1, 1), {}, 0, 0}}, {"a test", {}});
  };
  Augmented whole = added(1);
  EXPECT_EQ(whole.muscles, std::vector<std::string>{"BRD"});
  whole.model.credits = c.elbow.model.credits;
  EXPECT_EQ(whole.model, c.elbow.model);
  const EncompassingModel encompassing =
      encompassingModel(c.model, ShippedElbow::options(), "elbow_flexion");
  EXPECT_EQ(augmentedModel(encompassing, encompassing.nominal()).model, c.model);
}

}  // namespace
}  // namespace bio::discover
