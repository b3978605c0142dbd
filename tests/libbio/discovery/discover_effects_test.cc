#include "bio/discovery/effects.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "bio/discovery/add_effects.h"
#include "info/discovery/likelihood/hypothesis.h"
#include "libbio/discovery/effect_cases.h"
#include "support/scratch_folder.h"

namespace bio::discover {
namespace {

using namespace effect_cases;

using support::ScratchFolder;

TEST(Effects, AreAllThereWithTheirWords) {
  const Case c;
  std::set<std::string> ids;
  for (const Candidate& candidate : c.data.candidates()) {
    EXPECT_TRUE(ids.insert(candidate.id).second) << candidate.id << " twice";
    EXPECT_FALSE(candidate.sentence.empty());
    EXPECT_EQ(candidate.sds.size(), candidate.quantities.size()) << candidate.id;
    ASSERT_FALSE(candidate.starts.empty()) << candidate.id;
    for (const VectorXd& start : candidate.starts) {
      ASSERT_EQ(start.size(), static_cast<Index>(candidate.quantities.size())) << candidate.id;
      for (std::size_t i = 0; i < candidate.quantities.size(); ++i) {
        const auto& quantity = c.data.quantities()[candidate.quantities[i]];
        EXPECT_GE(start[static_cast<Index>(i)], quantity.lower) << candidate.id;
        EXPECT_LE(start[static_cast<Index>(i)], quantity.upper) << candidate.id;
      }
    }
  }
  for (const char* id : {"visc",         "coulomb",   "stribeck",   "drag",
                         "powerdamp",    "stiffness", "limit",      "payload",
                         "tilt",         "const",     "handforce",  "spring",
                         "fatigue",      "delay",     "shape",      "crosstalk_BIC_TRI",
                         "gain_TRI",     "gain_BRA",  "offset",     "offset_BIC",
                         "tau",          "mass",      "tendon",     "Fmax_TRI",
                         "Fmax_TRIlong", "lopt_BIC",  "lslack_BRD", "wrap_TRI",
                         "wrap_BIC_BRD", "bias",      "gain",       "clock",
                         "clock_rate",   "lag",       "drift",      "swap_BRA_BRD",
                         "torque_from",  "mass_from", "mass_until", "torque_until",
                         "limit_exp",    "cubic"}) {
    EXPECT_TRUE(ids.contains(id)) << id;
  }
  // what is equivalent to something is equivalent to something there is
  for (const Candidate& candidate : c.data.candidates()) {
    for (const std::string& other : candidate.equivalents)
      EXPECT_TRUE(ids.contains(other)) << other;
  }
  for (const auto& quantity : c.data.quantities()) {
    EXPECT_LE(quantity.lower, quantity.nominal) << quantity.name;
    EXPECT_GE(quantity.upper, quantity.nominal) << quantity.name;
    EXPECT_GT(quantity.sd, 0) << quantity.name;
  }
}

// With no length at rest it would pull as a weight does.
TEST(Effects, AnElasticBandIsNotDrawnOutFurtherThanRubberIs) {
  const Case c(0.3);
  const auto& rest = c.data.quantities()[c.find("spring").quantities.at(1)];
  EXPECT_EQ(rest.name, "spring.rest");
  // from the shoulder to the hand's mass centre, the arm stretched
  EXPECT_NEAR(rest.upper, 0.6, 0.01);
  EXPECT_NEAR(rest.lower, rest.upper / 6, 1e-12);
}

TEST(Effects, ThatTheModelHasAreNoCandidates) {
  const Case c(0.3, "elbow8_passive");
  EXPECT_EQ(c.data.encompassing().present().at("visc"), "elbow_flexion_damping");
  EXPECT_EQ(c.data.encompassing().present().at("limit"), "elbow_flexion_ligaments");
  EXPECT_FALSE(c.data.encompassing().knows("visc"));
  EXPECT_FALSE(c.data.encompassing().knows("limit"));
  EXPECT_TRUE(c.data.encompassing().knows("coulomb"));
}

TEST(Effects, ThatTheModelHasAreOfferedAsTheirNumbers) {
  const Case c(0.3, "elbow8_passive");
  const EncompassingModel& model = c.data.encompassing();
  for (const char* id : {"damping_elbow_flexion_damping", "stiffness_elbow_flexion_ligaments"}) {
    const Candidate& candidate = c.find(id);
    EXPECT_EQ(candidate.kind, info::discover::EffectKind::parameter);
    EXPECT_EQ(model.nominal()[static_cast<Index>(candidate.quantities.at(0))], 1);
    const Model twice = addEffects(c.elbow.model, ShippedElbow::options(), "elbow_flexion",
                                   {{id, VectorXd::Constant(1, 2.0), {}, 0, 0}}, {"a test", {}})
                            .model;
    const bool damps = candidate.id.starts_with("damping");
    const auto& before = c.elbow.model.limitForces.at(damps ? 1 : 0);
    const auto& after = twice.limitForces.at(damps ? 1 : 0);
    EXPECT_EQ(after.damping, damps ? 2 * before.damping : before.damping);
    EXPECT_EQ(after.upperStiffness, damps ? before.upperStiffness : 2 * before.upperStiffness);
    EXPECT_EQ(after.lowerStiffness, damps ? before.lowerStiffness : 2 * before.lowerStiffness);
  }
  EXPECT_GT(
      (c.outputs(c.with(c.find("damping_elbow_flexion_damping"))) - c.outputs(c.nominal())).norm(),
      1e-6);
  // nothing to multiply
  EXPECT_FALSE(model.knows("stiffness_elbow_flexion_damping"));
  EXPECT_FALSE(model.knows("damping_elbow_flexion_ligaments"));
}

// Bit for bit, whatever the quantities that shape it are, and though its law is switched on.
TEST(Effects, ChangeNothingAtAmplitudeZero) {
  const Case c(0.2);
  const VectorXd base = c.outputs(c.nominal());
  SystemOptions tables = ShippedElbow::options();
  tables.tabulatePaths = true;
  SimulationOptions options;
  options.duration = 0.2;
  options.newtonTolerance = 1e-12;
  const Trajectory plain =
      simulateSetting(MusculoskeletalSystem(c.elbow.model, tables), c.elbow.catalogue.nominal(),
                      c.elbow.excitation, options);
  EXPECT_EQ(base[base.size() - 1], plain.q(0, plain.q.cols() - 1));
  for (const Candidate& candidate : c.data.candidates()) {
    VectorXd values = c.with(candidate, candidate.starts.size() - 1);
    const std::size_t amplitude = candidate.quantities.front();
    values[static_cast<Index>(amplitude)] = c.data.quantities()[amplitude].nominal;
    EXPECT_EQ(c.outputs(values), base) << candidate.id;
    EXPECT_EQ(c.data.predict(0, values, {}, candidate.quantities, false).outputs, base)
        << candidate.id;
  }
}

// By a microradian at least, of an amplitude of one prior standard deviation.
TEST(Effects, AllMoveTheArmInAWholeTrial) {
  VectorXd largest;
  for (const char* trial : {"cocontraction", "curl_fast"}) {
    const Case c(4.5, "elbow8", trial);
    std::vector<std::size_t> amplitudes;
    for (const Candidate& candidate : c.data.candidates()) {
      amplitudes.push_back(candidate.quantities.front());
    }
    VectorXd values = c.nominal();
    values[static_cast<Index>(c.data.encompassing().quantities().size())] =
        0.02;  // nearly straight
    const auto at = c.data.predict(0, values, {}, amplitudes, false);
    const VectorXd moved = at.gamma.cwiseAbs().colwise().maxCoeff().transpose();
    largest = largest.size() ? VectorXd(largest.cwiseMax(moved)) : moved;
    for (std::size_t j = 0; j < amplitudes.size() && trial[1] == 'u'; ++j) {
      const double sd = c.data.quantities()[amplitudes[j]].sd;
      EXPECT_GT(largest[static_cast<Index>(j)] * sd, 1e-6) << c.data.candidates()[j].id;
    }
  }
}

TEST(Effects, DerivativesMatchDifferencesOfWholeSimulations) {
  const Case c(0.3);
  for (const Candidate& candidate : c.data.candidates()) {
    for (const bool absent : {false, true}) {
      VectorXd values = c.with(candidate);
      std::vector<std::size_t> quantities = candidate.quantities;
      const std::size_t amplitude = quantities.front();
      if (absent) {
        // muscles at rest are about to fall behind, which has one side only, as a lag has
        const bool oneSided = candidate.id == "fatigue" || candidate.id == "lag";
        values[static_cast<Index>(amplitude)] =
            oneSided ? 1e-3 : c.data.quantities()[amplitude].nominal;
        quantities = {amplitude};
      }
      const auto at = c.data.predict(0, values, {}, quantities, false);
      for (std::size_t i = 0; i < quantities.size(); ++i) {
        const double error = problem(
            at.gamma.col(static_cast<Index>(i)),
            [&](double step) {
              VectorXd moved = values;
              moved[static_cast<Index>(quantities[i])] += step;
              return c.outputs(moved);
            },
            c.data.quantities()[quantities[i]].sd);
        EXPECT_LT(error, 2e-4) << c.data.quantities()[quantities[i]].name
                               << (absent ? ", absent" : "");
      }
    }
  }
}

TEST(Effects, ARecordWithAFlatTopMayBeSaturated) {
  const ShippedElbow elbow("elbow8", "curl_fast");
  Trial trial = cut(elbow.trial, 0.8);
  const Index biceps = static_cast<Index>(
      std::find(trial.muscles.begin(), trial.muscles.end(), "BIClong") - trial.muscles.begin());
  const double top = 0.6 * trial.excitations.col(biceps).maxCoeff();
  trial.excitations.col(biceps) = trial.excitations.col(biceps).cwiseMin(top);
  const MusculoskeletalProblem data(elbow.model, ShippedElbow::options(), "elbow_flexion", {trial},
                                    Case::exact());
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < data.candidates().size(); ++i) {
    if (data.candidates()[i].id.starts_with("saturated_")) found.push_back(i);
  }
  ASSERT_EQ(found.size(), 1u);  // its group has another head, which goes on
  const Candidate& candidate = data.candidates()[found.front()];
  EXPECT_EQ(candidate.id, "saturated_BIClong");
  VectorXd values(static_cast<Index>(data.quantities().size()));
  for (Index i = 0; i < values.size(); ++i)
    values[i] = data.quantities()[static_cast<std::size_t>(i)].nominal;
  const auto at = static_cast<Index>(candidate.quantities.front());
  const VectorXd nominal = data.outputs(0, values, {});
  const auto moved = [&](double by) {
    VectorXd there = values;
    there[at] += by;
    return data.outputs(0, there, {});
  };
  EXPECT_GT((moved(0.7) - nominal).cwiseAbs().maxCoeff(), 0.01);
  for (const double size : {0.0, 0.7}) {  // absent and present
    values[at] = size;
    const auto slopes = data.predict(0, values, {}, {static_cast<std::size_t>(at)}, false);
    EXPECT_LT(problem(slopes.gamma.col(0), moved, 1), 2e-4) << size;
  }
}

TEST(Effects, ThatDissipateTakeEnergyOut) {
  const Case c(0.9);
  for (const char* id : {"visc", "coulomb", "stribeck", "drag", "powerdamp"}) {
    const Candidate& candidate = c.find(id);
    for (const VectorXd& start : candidate.starts) {
      VectorXd values = c.data.encompassing().nominal();
      for (std::size_t i = 0; i < candidate.quantities.size(); ++i) {
        values[static_cast<Index>(candidate.quantities[i])] = start[static_cast<Index>(i)];
      }
      const auto setting = c.data.encompassing().settingAt(values, {});
      const MusculoskeletalSystem system(setting.model, ShippedElbow::options());
      SimulationOptions options;
      options.duration = 0.9;
      const Trajectory motion = simulateSetting(system, setting, c.elbow.excitation, options);
      for (Index k = 1; k < motion.passiveWork.size(); ++k) {
        ASSERT_LE(motion.passiveWork[k], motion.passiveWork[k - 1]) << id;
      }
      EXPECT_LT(motion.passiveWork[motion.passiveWork.size() - 1], -1e-3) << id;
    }
  }
}

TEST(Effects, OfAFileMoveItAsTheyDoHere) {
  const Case c(0.4);
  ScratchFolder folder;
  for (const Candidate& candidate : c.data.candidates()) {
    const bool isOfModel = candidate.kind != info::discover::EffectKind::input &&
                           candidate.kind != info::discover::EffectKind::sensor &&
                           candidate.id != "fatigue";  // acts on the excitation
    const bool isOfTime =
        c.data.encompassing().kindOf(candidate.quantities.front()) == Meaning::Kind::timed;
    if (!isOfModel || isOfTime) continue;
    const Augmented added =
        addEffects(c.elbow.model, ShippedElbow::options(), "elbow_flexion",
                   {{candidate.id, candidate.starts[0], {}, 12.5, 0.99}}, {"a test", {"none"}});
    const auto file = folder / (candidate.id + ".osim");
    writeOsim(added.model, file);
    const Model read = readOsim(file);
    EXPECT_NE(read.credits.find("(" + candidate.id + ")"), std::string::npos) << read.credits;
    EXPECT_TRUE(read.warnings.empty()) << candidate.id;
    const MusculoskeletalProblem again(read, ShippedElbow::options(), "elbow_flexion",
                                       {cut(c.elbow.trial, 0.4)}, Case::exact());
    VectorXd nominal = VectorXd::Zero(static_cast<Index>(again.quantities().size()));
    for (Index i = 0; i < nominal.size(); ++i) {
      nominal[i] = again.quantities()[static_cast<std::size_t>(i)].nominal;
    }
    const VectorXd y = again.outputs(0, nominal, {});
    EXPECT_LT((y - c.outputs(c.with(candidate))).cwiseAbs().maxCoeff(), 1e-9) << candidate.id;
    // and are known again
    if (!read.springForces.empty() || !read.expressionForces.empty() || !read.limitForces.empty()) {
      EXPECT_TRUE(again.encompassing().present().contains(candidate.id)) << candidate.id;
      EXPECT_THROW(addEffects(read, ShippedElbow::options(), "elbow_flexion",
                              {{candidate.id, candidate.starts[0], {}, 0, 0}}, {"a test", {}}),
                   std::invalid_argument);
    }
  }
}

TEST(Effects, WithAPlaceInOpenSimUseItsOwnComponents) {
  const Case c(0.3);
  const auto added = [&](const char* id) {
    return addEffects(c.elbow.model, ShippedElbow::options(), "elbow_flexion",
                      {{id, c.find(id).starts[0], {}, 0, 0}}, {"a test", {}})
        .model;
  };
  EXPECT_EQ(added("visc").springForces.at(0).viscosity, 0.1);
  EXPECT_EQ(added("visc").springForces.at(0).stiffness, 0);
  EXPECT_EQ(added("stiffness").springForces.at(0).stiffness, 0.5);
  EXPECT_EQ(added("limit").limitForces.at(0).upperStiffness, 3);
  EXPECT_EQ(added("limit").limitForces.at(0).lowerStiffness, 3);
  const Model loaded = added("payload");
  Model expected = c.elbow.model;
  expected.credits = loaded.credits;
  for (Body& body : expected.bodies) {
    if (body.name == "hand") body.mass += 0.2;
  }
  EXPECT_EQ(loaded, expected);
  EXPECT_EQ(added("coulomb").expressionForces.at(0).expression,
            "-0.20000000000000001*tanh(qdot/0.05)");
  EXPECT_EQ(added("cubic").expressionForces.at(0).expression, "-0.5*(q-1.134464015)^3");
}

/// Names of the elements in a document.
std::set<std::string> elementsOf(const std::string& text) {
  std::set<std::string> names;
  for (std::size_t at = text.find('<'); at != text.npos; at = text.find('<', at + 1)) {
    names.insert(text.substr(at + 1, text.find_first_of(" >/\n", at + 1) - at - 1));
  }
  return names;
}

TEST(Effects, WithAPlaceInOpenSimWriteNoElementThatItDoesNotKnow) {
  const Case c(0.3);
  ScratchFolder folder;
  const auto written = [&](const Model& model) {
    writeOsim(model, folder / "model.osim");
    std::ifstream file(folder / "model.osim");
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::set<std::string> before = elementsOf(written(c.elbow.model));
  const std::map<const char*, std::set<std::string>> expected = {
      {"visc", {"SpringGeneralizedForce", "coordinate", "stiffness", "rest_length", "viscosity"}},
      {"stiffness",
       {"SpringGeneralizedForce", "coordinate", "stiffness", "rest_length", "viscosity"}},
      {"limit",
       {"CoordinateLimitForce", "coordinate", "upper_stiffness", "upper_limit", "lower_stiffness",
        "lower_limit", "transition"}},
      {"payload", {}},
      {"coulomb", {"ExpressionBasedCoordinateForce", "coordinate", "expression"}}};
  for (const auto& [id, names] : expected) {
    const Augmented added = addEffects(c.elbow.model, ShippedElbow::options(), "elbow_flexion",
                                       {{id, c.find(id).starts[0], {}, 0, 0}}, {"a test", {}});
    std::set<std::string> fresh;
    for (const std::string& name : elementsOf(written(added.model))) {
      if (!before.contains(name)) fresh.insert(name);
    }
    EXPECT_EQ(fresh, names) << id;
  }
}

TEST(Formula, IsAnEffectLikeAnyOther) {
  const Case c;
  const std::vector<info::discover::FormulaTerm> terms = {{"q^3", -1.5, 3},
                                                          {"qdot*abs(qdot)", 0.4, 2}};
  const auto widened = c.data.withFormula(0, terms, {0, 2});
  ASSERT_TRUE(widened);
  ASSERT_EQ(widened->candidates().size(), 3U);
  EXPECT_EQ(widened->candidates()[1].id, c.data.candidates()[2].id);
  const Candidate& formula = widened->candidates()[2];
  EXPECT_EQ(formula.id, "formula");
  ASSERT_EQ(formula.quantities.size(), 2U);
  VectorXd values = info::discover::nominalValues(*widened);
  const auto c1 = static_cast<Index>(formula.quantities[0]),
             r2 = static_cast<Index>(formula.quantities[1]);
  values[r2] = 0.4;
  EXPECT_EQ(widened->outputs(0, values, {}), c.outputs(c.nominal()));  // absent, bit for bit
  values[c1] = -1.5;
  const VectorXd with = widened->outputs(0, values, {});
  EXPECT_GT((with - c.outputs(c.nominal())).cwiseAbs().maxCoeff(), 0.01);
  const auto at = widened->predict(0, values, {}, formula.quantities, false);
  for (Index j = 0; j < 2; ++j) {
    const auto f = [&](double step) {
      VectorXd moved = values;
      moved[j == 0 ? c1 : r2] += step;
      return widened->outputs(0, moved, {});
    };
    EXPECT_LT(problem(at.gamma.col(j), f, 1), 5e-4) << j;
  }
  // and in a model it is OpenSim's force, found again
  const Augmented added =
      addEffects(c.elbow.model, ShippedElbow::options(), "elbow_flexion",
                 {{"formula", Eigen::Vector2d(-1.5, 0.4), {}, 0, 0}}, {"a test", {}}, terms);
  ASSERT_EQ(added.model.expressionForces.size(), c.elbow.model.expressionForces.size() + 1);
  const MusculoskeletalProblem repaired(added.model, ShippedElbow::options(), "elbow_flexion",
                                        {cut(c.elbow.trial, 0.6)}, Case::exact());
  const VectorXd again = repaired.outputs(0, info::discover::nominalValues(repaired), {});
  EXPECT_LT((again - with).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_FALSE(repaired.withFormula(0, terms, {}));
}

// As forces without a name are written, about a middle on either side of 0.
TEST(Formula, MayBeAPowerAboutAMiddle) {
  const Case c;
  const auto outputs = [&](const char* expression, double amplitude) {
    const auto widened = c.data.withFormula(0, {{expression, 1, 1}}, {});
    VectorXd values = info::discover::nominalValues(*widened);
    values[static_cast<Index>(widened->candidates()[0].quantities[0])] = amplitude;
    return widened->outputs(0, values, {});
  };
  const VectorXd plain = outputs("q", -0.7);
  EXPECT_LT((outputs("((q-0)/0.5)^1", -0.35) - plain).cwiseAbs().maxCoeff(), 1e-9);
  // (q + 2)² − (q − 2)² = 8q
  const VectorXd right = outputs("(((q+2)/2)^2-((q-2)/2)^2)", -0.35);
  EXPECT_LT((right - plain).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace bio::discover
