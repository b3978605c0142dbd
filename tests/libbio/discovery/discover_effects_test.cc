#include "bio/discovery/effects.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <set>

#include "bio/discovery/add_effects.h"
#include "bio/discovery/musculoskeletal_problem.h"
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
using info::discover::Candidate;
using support::ScratchFolder;

struct Case {
  explicit Case(double seconds = 0.6, const std::string& model = "elbow8",
                const std::string& trial = "curl_fast")
      : elbow(model, trial),
        data(elbow.model, ShippedElbow::options(), "elbow_flexion", {cut(elbow.trial, seconds)},
             exact()) {}

  static MusculoskeletalProblemOptions exact() {
    MusculoskeletalProblemOptions options;
    options.simulation.newtonTolerance = 1e-12;
    return options;
  }

  VectorXd nominal() const {
    VectorXd values(static_cast<Index>(data.quantities().size()));
    for (Index i = 0; i < values.size(); ++i) {
      values[i] = data.quantities()[static_cast<std::size_t>(i)].nominal;
    }
    return values;
  }
  /// With an effect as a start of its has it.
  VectorXd with(const Candidate& candidate, std::size_t start = 0) const {
    VectorXd values = nominal();
    for (std::size_t i = 0; i < candidate.quantities.size(); ++i) {
      values[static_cast<Index>(candidate.quantities[i])] =
          candidate.starts.at(start)[static_cast<Index>(i)];
    }
    return values;
  }
  const Candidate& find(const std::string& id) const {
    for (const Candidate& candidate : data.candidates()) {
      if (candidate.id == id) return candidate;
    }
    throw std::invalid_argument("no candidate " + id);
  }
  VectorXd outputs(const VectorXd& values) const { return data.outputs(0, values, {}); }

  ShippedElbow elbow;
  MusculoskeletalProblem data;
};

/// Fourth-order central difference of whole simulations.
template <class F>
VectorXd difference(const F& f, double h) {
  return (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h);
}

/// max |column − difference| / max |difference|, of the step that agrees best: a fibre that turns
/// and a path that lifts off put kinks into the motion, which a finer step does not meet.
double problem(const VectorXd& column, const std::function<VectorXd(double)>& f, double scale) {
  double best = std::numeric_limits<double>::infinity();
  for (const double h : {3e-3, 3e-4, 3e-5, 1e-2}) {
    const VectorXd d = difference(f, h * scale);
    const double size = std::max(d.cwiseAbs().maxCoeff(), 1e-6);
    best = std::min(best, (column - d).cwiseAbs().maxCoeff() / size);
    if (best < 1e-5) break;
  }
  return best;
}

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
                         "limit_exp"}) {
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
      EXPECT_GT(largest[static_cast<Index>(j)], 0) << c.data.candidates()[j].id;
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
      const MusculoskeletalSystem arm(setting.model, ShippedElbow::options());
      SimulationOptions options;
      options.duration = 0.9;
      const Trajectory motion = simulateSetting(arm, setting, c.elbow.excitation, options);
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

TEST(LatentForce, NodesMatchDifferencesOfSimulationsWithAnExternalForce) {
  const Case c(0.6);
  const VectorXd values = c.with(c.find("visc"));
  const auto nodes = static_cast<Index>(c.data.latentTimes(0).size());
  VectorXd latent(nodes);
  for (Index k = 0; k < nodes; ++k) latent[k] = 0.5 * std::sin(1.7 * static_cast<double>(k));
  const auto at = c.data.predict(0, values, latent, {}, true);
  EXPECT_EQ(at.outputs, c.data.outputs(0, values, latent));
  ASSERT_EQ(at.latentGamma.cols(), nodes);
  double largest = 0;
  for (Index k = 0; k < nodes; ++k) {
    const auto f = [&](double step) {
      VectorXd moved = latent;
      moved[k] += step;
      return c.data.outputs(0, values, moved);
    };
    largest = std::max(largest, at.latentGamma.col(k).cwiseAbs().maxCoeff());
    EXPECT_LT(problem(at.latentGamma.col(k), f, 1), 1e-5) << "node " << k;
    // nothing moves before the hat begins
    const double begins =
        c.data.latentTimes(0)[static_cast<std::size_t>(std::max<Index>(k - 1, 0))];
    for (std::size_t i = 0; i < c.data.times(0).size() && c.data.times(0)[i] <= begins; ++i) {
      EXPECT_EQ(at.latentGamma(static_cast<Index>(i), k), 0);
    }
  }
  EXPECT_GT(largest, 0.01);
  // 0.1 s/(c₂ + c₁u/2) with c₁ = 7.667, c₂ = 1.46 and excitations of 0 to 0.3
  EXPECT_GT(c.data.latentLag(), 0.038);
  EXPECT_LT(c.data.latentLag(), 0.069);
  // a channel for each muscle, the last of constant size
  ASSERT_EQ(at.latentScale.cols(), 9);
  EXPECT_TRUE((at.latentScale.col(8).array() == 0.5).all());
  EXPECT_GT(at.latentScale.leftCols(8).cwiseAbs().maxCoeff(), 0.5);
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
  const VectorXd latent = VectorXd::Constant(static_cast<Index>(c.data.latentTimes(0).size()), 0.3);
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

TEST(MusculoskeletalProblem, SaysNothingWhereTheSimulationFails) {
  const Case c(0.3);
  VectorXd values = c.nominal();
  values[static_cast<Index>(c.find("lslack_TRI").quantities[0])] = 40;
  EXPECT_FALSE(c.outputs(values).allFinite());
  EXPECT_FALSE(c.data.failure(0, values).empty());
  const auto at = c.data.predict(0, values, {}, {0}, true);
  EXPECT_FALSE(at.outputs.allFinite());
  EXPECT_EQ(at.latentGamma.cols(), static_cast<Index>(c.data.latentTimes(0).size()));
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
  EXPECT_EQ(data.encompassing().proxies().at("BRD"),
            (std::vector<std::string>{"BIClong", "BICshort", "BRA"}));
  const Trial proxied = withProxies(trial, data.encompassing());
  ASSERT_EQ(proxied.muscles.back(), "BRD");
  const auto column = [&](const std::string& muscle) {
    const auto at = std::find(proxied.muscles.begin(), proxied.muscles.end(), muscle);
    return VectorXd(proxied.excitations.col(at - proxied.muscles.begin()));
  };
  EXPECT_LT((3 * column("BRD") - column("BIClong") - column("BICshort") - column("BRA"))
                .cwiseAbs()
                .maxCoeff(),
            1e-15);
  // its own EMG goes before
  EXPECT_EQ(withProxies(c.trial, data.encompassing()).excitations, c.trial.excitations);
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

TEST(Formula, IsAnEffectLikeAnyOther) {
  const Case c;
  const std::vector<info::discover::FormulaTerm> terms = {{"q^3", -1.5, 3},
                                                          {"qdot*abs(qdot)", 0.4, 2}};
  const auto widened = c.data.withFormula(terms, {0, 2});
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
  EXPECT_FALSE(repaired.withFormula(terms, {}));
}

// As forces without a name are written, about a middle on either side of 0.
TEST(Formula, MayBeAPowerAboutAMiddle) {
  const Case c;
  const auto outputs = [&](const char* expression, double amplitude) {
    const auto widened = c.data.withFormula({{expression, 1, 1}}, {});
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

TEST(MusculoskeletalProblem, AKnownMassIsInTheHandBesidesWhatIsMissing) {
  const ShippedElbow elbow;
  const Trial empty = cut(elbow.trial, 0.5);
  Trial loaded = empty;
  loaded.known.massInHand = 0.7;
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
  turned.known.armTurn = -0.4;
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
