#include "bio/discovery/repaired.h"

#include <gmock/gmock.h>

#include "bio/analysis/replay.h"
#include "bio/discovery/with_experimental_conditions.h"
#include "bio/opensim/osim_file.h"
#include "bio/tables/trial_table.h"
#include "info/discovery/likelihood/hypothesis.h"
#include "support/cut_trial.h"
#include "support/scratch_folder.h"
#include "support/shipped_elbow.h"

namespace bio::discover {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using fixtures::cut;
using fixtures::ShippedElbow;
using info::discover::Verdict;

constexpr double hundredth = 0.01 / 180 * 3.14159265358979;  // of a degree

/// Two trials, one of them held out, and a verdict as a search might give it: every nuisance and
/// start moved, with one effect.
struct Found {
  explicit Found(const std::string& id, double step = 0.01, double knownMass = 0) {
    trials = {cut(elbow.trial, 1.5), cut(ShippedElbow("elbow8", "curl_fast").trial, 1.0)};
    trials[0].sha256 = std::string(64, '0');
    trials[1].sha256 = std::string(64, '1');
    trials[1].conditions.massInHand = knownMass;
    MusculoskeletalProblemOptions options;
    options.simulation.step = step;
    data = std::make_unique<MusculoskeletalProblem>(elbow.model, ShippedElbow::options(),
                                                    "elbow_flexion", trials, options);
    verdict.reached = info::discover::Stage::finished;
    verdict.finding = info::discover::Finding::named;
    verdict.sds = 0.009;
    verdict.values = info::discover::nominalValues(*data);
    double sign = 1;
    for (const std::size_t q : data->nuisances()) {
      const auto& quantity = data->quantities()[q];
      const double size = quantity.logarithmic ? 0.4 * quantity.sd : quantity.sd;
      verdict.values[static_cast<Index>(q)] += sign * size;
      const info::discover::Estimate estimate{q, verdict.values[static_cast<Index>(q)], 0.01, 0.4,
                                              false};
      (quantity.trial == 1 ? verdict.heldOutStarts : verdict.nuisancesAfter).push_back(estimate);
      sign = -sign;
    }
    verdict.base = verdict.values;
    for (std::size_t c = 0; c < data->candidates().size(); ++c) {
      const auto& candidate = data->candidates()[c];
      if (candidate.id != id) continue;
      info::discover::NamedEffect effect;
      effect.candidate = c;
      for (std::size_t i = 0; i < candidate.quantities.size(); ++i) {
        const double value = candidate.starts[0][static_cast<Index>(i)];
        verdict.values[static_cast<Index>(candidate.quantities[i])] = value;
        effect.estimates.push_back({candidate.quantities[i], value, 0.1, 1, false});
      }
      verdict.effects = {effect};
    }
    repaired = repairedModel(*data, verdict, {1}, {}, {"a test", {"none"}});
  }

  /// What `fisherhill replay` makes of the file and the trial.
  double replay(const std::filesystem::path& file, const Trial& recorded) const {
    const Model model = readOsim(file);
    const SystemOptions options = ShippedElbow::options();
    const MusculoskeletalSystem system(
        withExperimentalConditions(model, options, "elbow_flexion", recorded), options);
    SimulationOptions simulation;
    simulation.step = stepOf(model, simulation.integrator, {});
    return replayTrial(system, recorded, simulation, beginningOf(recorded, model, system, {}))
        .errors.at(0)
        .second.rms;
  }

  ShippedElbow elbow;
  std::vector<Trial> trials;
  std::unique_ptr<MusculoskeletalProblem> data;
  Verdict verdict;
  Repaired repaired;
};

TEST(Repaired, ReplaysOfTheWrittenModelGiveItsFiguresAndTheFits) {
  const support::ScratchFolder folder;
  for (const char* id : {"visc", "payload", "Fmax_TRI", "wrap_TRI", "tilt"}) {
    for (const double step : {0.01, 0.0025}) {
      if (step != 0.01 && std::string(id) != "visc") continue;
      const Found f(id, step, 0.4);
      ASSERT_EQ(f.repaired.trials.size(), 2U);
      const auto file = folder / "with_effect.osim";
      rewriteOsim(ShippedElbow::root() + "/models/elbow8.osim", f.repaired.added.model, file);
      for (const RepairedTrial& one : f.repaired.trials) {
        EXPECT_FALSE(one.driven) << id;
        EXPECT_EQ(one.isHeldOut, one.index == 1);
        EXPECT_NEAR(one.after, one.fitted, hundredth) << id << " " << step;
        EXPECT_NEAR(f.replay(file, f.trials[one.index]), one.after, 1e-9) << id << " " << step;
        // the model as it came is further away or nearer, but not the same
        EXPECT_GT(std::abs(one.nominal - one.after), 10 * hundredth) << id;
      }
      EXPECT_EQ(f.repaired.added.model.fitted.step, step);
    }
  }
}

TEST(Repaired, WhereEmgOrSensorAreAtFaultDrivenTrialsGiveTheFigures) {
  const support::ScratchFolder folder;
  for (const char* id : {"delay", "gain_TRI", "fatigue", "bias", "gain", "clock"}) {
    const Found f(id);
    Model model = f.repaired.added.model;
    for (const RepairedTrial& one : f.repaired.trials) {
      ASSERT_TRUE(one.driven) << id;
      const auto file = folder / "with_effect.osim";
      const auto table = folder / "driven.sto";
      writeTable(*one.driven, table);
      Trial driven = readTrial(table, model, {.experimentalConditions = true});
      driven.sha256 = std::string(64, 'd');  // as the program says of the file
      model.fitted.starts = one.starts;
      model.fitted.starts[0].sha256 = driven.sha256;
      rewriteOsim(ShippedElbow::root() + "/models/elbow8.osim", model, file);
      EXPECT_NEAR(f.replay(file, driven), one.after, 1e-9) << id;
      // a corrected recording is another one; otherwise the fit has the same
      const bool isCorrected = std::string(id) == "gain" || std::string(id) == "clock";
      if (!isCorrected) {
        EXPECT_NEAR(one.after, one.fitted, hundredth) << id;
      } else {
        EXPECT_NEAR(one.after, one.fitted, 0.1 * one.fitted) << id;
      }
      EXPECT_NEAR(one.floor, std::string(id) == "gain" ? 0.009 / 1.02 : 0.009, 1e-9) << id;
    }
  }
}

TEST(Repaired, TheGapHasTheFiguresOfTheReplays) {
  Found f("gain");
  f.verdict.excess.floor = 0.009;
  f.verdict.excess.calibrated = 0.3;
  f.verdict.heldOut = f.verdict.excess;
  takeReplays(f.verdict, f.repaired);
  EXPECT_EQ(f.verdict.excess.after, f.repaired.trials[0].after);
  EXPECT_EQ(f.verdict.heldOut->after, f.repaired.trials[1].after);
  EXPECT_EQ(f.verdict.excess.nominal, f.repaired.trials[0].nominal);
  ASSERT_TRUE(f.verdict.excess.closedFromCalibrated);
  const double shown = 1.02 * f.repaired.trials[0].after;
  EXPECT_NEAR(*f.verdict.excess.closedFromCalibrated,
              1 - (shown * shown - 0.009 * 0.009) / (0.3 * 0.3 - 0.009 * 0.009), 1e-9);
}

TEST(Repaired, EveryFittedNumberIsTheModels) {
  const Found f("Fmax_TRI");
  const auto numbers = fittedNumbers(*f.data, f.verdict);
  // the effect, 8 muscles with 3 numbers, mass, activation, 2 starts
  EXPECT_EQ(numbers.size(), 1U + 24U + 2U + 4U);
  const auto find = [&](const std::string& name) {
    for (const auto& one : numbers)
      if (one.name == name) return one;
    throw std::invalid_argument("no number " + name);
  };
  const Model& model = f.repaired.added.model;
  const auto force = find("TRIlong.max_isometric_force");
  EXPECT_EQ(force.unit, "N");
  EXPECT_EQ(force.nominal, findMuscle(f.elbow.model, "TRIlong").schutte->maxIsometricForce);
  EXPECT_NEAR(force.estimate, findMuscle(model, "TRIlong").schutte->maxIsometricForce, 1e-9);
  EXPECT_NEAR(force.prior, 0.15 * force.nominal, 1e-9);
  EXPECT_EQ(force.priorZ, 0.4);
  EXPECT_NEAR(find("BRA.tendon_slack_length").estimate,
              findMuscle(model, "BRA").schutte->tendonSlackLength, 1e-12);
  EXPECT_EQ(find("mass factor").nominal, 1);
  EXPECT_EQ(find("trial2.initial.elbow_flexion.speed").unit, "rad/s");
}

TEST(WithKnownChanges, PutsTheMassInTheHandAndTurnsGravity) {
  const ShippedElbow elbow;
  Trial trial = cut(elbow.trial, 0.3);
  const auto changed = [&](const Model& model) {
    return withExperimentalConditions(model, ShippedElbow::options(), "elbow_flexion", trial);
  };
  EXPECT_EQ(changed(elbow.model), elbow.model);
  trial.conditions.massInHand = 0.7;
  EXPECT_NEAR(findBody(changed(elbow.model), "hand").mass, findBody(elbow.model, "hand").mass + 0.7,
              1e-12);
  trial.conditions.armTurn = 0.5;
  EXPECT_GT((changed(elbow.model).gravity - elbow.model.gravity).norm(), 1);
}

}  // namespace
}  // namespace bio::discover
