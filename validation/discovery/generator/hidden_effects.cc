#include "generator/hidden_effects.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hidden {
namespace {

// clang-format off
template <double Extras::*field>
void extra(Truth& truth, double amplitude, RandomNumbers&) { truth.extras.*field = amplitude; }
template <double InputChain::*field>
void input(Truth& truth, double amplitude, RandomNumbers&) { truth.chain.*field = amplitude; }
template <double Sensor::*field>
void sensor(Truth& truth, double amplitude, RandomNumbers&) { truth.sensor.*field = amplitude; }
// clang-format on

// Muscles are called by group: TRI, BIC, BRA, BRD, ANC.
template <double HillMuscle::*field>
void scale(Truth& truth, const std::string& group, double amplitude) {
  for (HillMuscle& m : truth.numbers.muscles) {
    if (m.name.starts_with(group)) m.*field *= 1 + amplitude;
  }
}

void widen(Truth& truth, const std::string& cylinder, double amplitude) {
  auto& c = truth.numbers.cylinders;
  for (std::size_t i = 0; i < c.names.size(); ++i) {
    if (c.names[i] == cylinder) c.shapes[i].radius += amplitude;
  }
}

void slowActivation(Truth& truth, double factor) {
  for (HillMuscle& m : truth.numbers.muscles) m.activation1 /= factor, m.activation2 /= factor;
}

void scaleMass(Truth& truth, double factor) {
  for (Body& body : truth.numbers.forearm) body.mass *= factor, body.inertia *= factor;
}

void holdMass(Truth& truth, double mass) {
  truth.numbers.forearm.push_back({"payload", mass, truth.numbers.hand, Eigen::Matrix3d::Zero()});
}

// "TRI*.max_isometric_force": any text where the star stands.
bool matches(const std::string& pattern, const std::string& name) {
  const std::size_t star = std::min(pattern.find('*'), pattern.size());
  if (star == pattern.size()) return pattern == name;
  return name.starts_with(pattern.substr(0, star)) && name.ends_with(pattern.substr(star + 1));
}

void driveBrachioradialis(Truth& truth, double strength, RandomNumbers&) {
  scale<&HillMuscle::maxForce>(truth, "BRD", strength - 1);
  truth.chain.commonDrive = true;
}

void amplifyTriceps(Truth& truth, double change, RandomNumbers&) {
  truth.chain.gain.assign(8, 1.0);
  for (std::size_t i = 0; i < 3; ++i) truth.chain.gain[i] = 1 + change;
}

void startTremor(Truth& truth, double amplitude, RandomNumbers& random) {
  truth.extras.tremor = amplitude;
  truth.extras.tremorFrequency = random.between(4, 6);
  truth.extras.tremorPhase = random.between(0, 2 * std::numbers::pi);
}

void loseEmg(Truth& truth, double share, RandomNumbers& random) {
  truth.dropout.present = true;
  truth.dropout.level = 1 - share;
  truth.dropout.from = random.between(1, 2.5);
  truth.dropout.to = truth.dropout.from + random.between(0.6, 1.2);
}

class EffectTable {
 public:
  // In this order: suites take them in turn.
  static std::vector<EffectRow> make() {
    EffectTable table;
    table.addForces();
    table.addInputsAndParameters();
    table.addGeometrySensorsAndUnnamed();
    return std::move(table.rows_);
  }

 private:
  // clang-format off
  void addForces() {
    add({"visc", "viscous joint damping", s, true, "−b·w", "b", "N m s", 0.3, false, {},
         extra<&Extras::viscous>});
    add({"coulomb", "dry friction", s, true, "−τ_c·tanh(w/0.05 rad/s)", "tau_c", "N m", 0.4, false,
         {}, extra<&Extras::coulomb>});
    add({"stribeck", "Stribeck friction", s, true,
         "−τ_c·[1 + e^{−(w/0.3 rad/s)²}]·tanh(w/0.05 rad/s)", "tau_c", "N m", 0.3, false, {},
         extra<&Extras::stribeck>});
    add({"drag", "quadratic drag", s, true, "−c·w·abs(w)", "c", "N m s²", 0.1, false, {},
         extra<&Extras::drag>});
    add({"powerdamp", "sub-linear damping", s, true,
         "−b·w·(w² + (0.01 rad/s)²)^(−1/4): ~ sgn(w)·√abs(w)", "b", "N m s^½", 0.35, false, {},
         extra<&Extras::powerDamping>});
    add({"stiffness", "joint stiffness", s, true, "−k·(q − 1.2 rad)", "k", "N m/rad", 0.8, false, {},
         extra<&Extras::stiffness>});
    add({"limit", "passive joint limits", s, true,
         "−K·s((q − 90°)/30°)·(q − 90°) above, +K·s((40° − q)/30°)·(40° − q) below, s the quintic "
         "step: OpenSim's CoordinateLimitForce without damping",
         "stiffness", "N m/rad", 7.0, false, {}, extra<&Extras::limit>});
    add({"payload", "mass in the hand", s, true,
         "a point mass at the hand's mass centre: inertia and weight", "mass", "kg", 0.5, false,
         {"mass"}, [](Truth& truth, double a, RandomNumbers&) { holdMass(truth, a); }});
    add({"tilt", "arm tilt", s, true, "gravity's moment is that of the angle q + δ", "delta", "rad",
         0.12, false, {"handforce"}, extra<&Extras::tilt>});
    add({"const", "constant torque", s, true, "+τ_0", "tau_0", "N m", 0.4, false, {},
         extra<&Extras::constant>});
    add({"handforce", "force on the hand", s, true,
         "a force F along the ground's +x (forward) at the hand's mass centre", "F", "N", 2.0, false,
         {"tilt"}, extra<&Extras::handForce>});
    add({"spring", "elastic band", s, true,
         "−k·max(0, L − 0.28 m)·∂L/∂q, L from the hand's mass centre to the shoulder", "k", "N/m",
         40.0, false, {}, extra<&Extras::band>});
    add({"missing_BRD", "missing brachioradialis", s, true,
         "the model has the brachioradialis switched off, its EMG is not recorded; the person's has F0 "
         "times r and the mean EMG of biceps and brachialis",
         "strength", "", 1.0, false, {},
         driveBrachioradialis,
         "BRD*.max_isometric_force", "BRD"});
    add({"fatigue", "muscle fatigue", s, true,
         "contractile force × [1 − φ·(1 − e^{−∫a dt/T})], T = 0.3 s, a its own activation, every muscle",
         "phi", "", 0.3, false, {}, extra<&Extras::fatigue>});
  }

  void addInputsAndParameters() {
    add({"delay", "electromechanical delay", in, true,
         "excitation(t) = EMG(t − τ), held before the start", "tau", "s", 0.04, false, {"clock"},
         input<&InputChain::delay>});
    add({"shape", "EMG nonlinearity", in, true, "excitation = (e^{Au} − 1)/(e^A − 1), all muscles",
         "A", "", -1.5, false, {}, input<&InputChain::shape>});
    add({"crosstalk_BIC_TRI", "EMG crosstalk, biceps into triceps", in, true,
         "excitation of each triceps head = its EMG − c·mean EMG of the two biceps heads, not below 0",
         "c", "", 0.06, false, {"crosstalk_TRI_BIC"}, input<&InputChain::crosstalk>});
    add({"gain_TRI", "electrode gain of the triceps", in, true,
         "excitation = (1 + g)·EMG, three heads", "g", "", -0.4, true, {"Fmax_TRI"},
         amplifyTriceps});
    add({"offset", "EMG baseline", in, true, "excitation = EMG + o, all muscles, not below 0", "o",
         "", -0.01, false, {}, input<&InputChain::offset>});
    add({"tau", "activation time constants", p, true, "both time constants of every muscle × (1 + a)",
         "change", "", 1.0, true, {},
         [](Truth& truth, double a, RandomNumbers&) { slowActivation(truth, 1 + a); },
         "activation.time"});
    add({"Fmax_TRI", "strength of the triceps", p, true, "F0 of the three heads × (1 + a)", "change",
         "", -0.4, true, {"gain_TRI"},
         [](Truth& truth, double a, RandomNumbers&) {
           scale<&HillMuscle::maxForce>(truth, "TRI", a);
         },
         "TRI*.max_isometric_force"});
    add({"Fmax_BIC", "strength of the biceps", p, true, "F0 of both heads × (1 + a)", "change", "",
         -0.4, true, {"gain_BIC"},
         [](Truth& truth, double a, RandomNumbers&) {
           scale<&HillMuscle::maxForce>(truth, "BIC", a);
         },
         "BIC*.max_isometric_force"});
    add({"Fmax_BRA", "strength of the brachialis", p, true, "F0 × (1 + a)", "change", "", -0.4, true,
         {"gain_BRA"},
         [](Truth& truth, double a, RandomNumbers&) {
           scale<&HillMuscle::maxForce>(truth, "BRA", a);
         },
         "BRA*.max_isometric_force"});
    add({"lopt_BRA", "optimal fibre length of the brachialis", p, true, "ℓ0 × (1 + a)", "change", "",
         0.15, true, {},
         [](Truth& truth, double a, RandomNumbers&) {
           scale<&HillMuscle::fibreLength>(truth, "BRA", a);
         },
         "BRA*.optimal_fiber_length"});
    add({"lslack_TRI", "tendon slack length of the triceps", p, true,
         "ℓs of the three heads × (1 + a)", "change", "", 0.036, true, {},
         [](Truth& truth, double a, RandomNumbers&) {
           scale<&HillMuscle::slackLength>(truth, "TRI", a);
         },
         "TRI*.tendon_slack_length"});
    add({"mass", "mass of forearm and hand", p, true,
         "mass and inertia of every body beyond the elbow × (1 + a)", "change", "", 0.2, true,
         {"payload"}, [](Truth& truth, double a, RandomNumbers&) { scaleMass(truth, 1 + a); },
         "forearm.mass"});
    add({"tendon", "tendon compliance", s, true,
         "tendon force at strain ε is the curve's at ε/(1 + a), every muscle", "change", "", 1.0,
         true, {},
         [](Truth& truth, double a, RandomNumbers&) {
           scale<&HillMuscle::tendonStretch>(truth, "", a);
         }});
  }

  void addGeometrySensorsAndUnnamed() {
    add({"wrap_TRI", "wrap radius of the triceps", g, true, "radius of cylinder TRI + Δr", "dr", "m",
         0.003, false, {}, [](Truth& truth, double a, RandomNumbers&) { widen(truth, "TRI", a); }});
    add({"wrap_BIC", "wrap radius of biceps and brachioradialis", g, true,
         "radius of cylinder BIC_BRD + Δr; touched below 20° only, so not drawn by seed", "dr", "m",
         0.003, false, {},
         [](Truth& truth, double a, RandomNumbers&) { widen(truth, "BIC_BRD", a); }});
    add({"bias", "angle sensor bias", se, true, "y = q + b", "b", "rad", 0.08, false, {},
         sensor<&Sensor::bias>});
    add({"gain", "angle sensor gain", se, true, "y = (1 + s)·q", "s", "", 0.08, true, {},
         sensor<&Sensor::gain>});
    add({"clock", "clock offset", se, true, "y(t) = q(t − s), held before the start", "s", "s", 0.04,
         false, {"delay"}, sensor<&Sensor::clock>});
    add({"cubic", "cubic stiffness", s, true, "−k·(q − 1.2 rad)³", "k", "N m/rad³", 1.5, false, {},
         extra<&Extras::cubic>});
    add({"hysteresis", "Bouc–Wen hysteresis", s, false, "−α·z, ż = (w − abs(w)·z)/0.15 rad, z(0) = 0",
         "alpha", "N m", 0.6, false, {}, extra<&Extras::hysteresis>});
    add({"tremor", "tremor", s, false, "+α·sin(2πft + φ), f in 4–6 Hz and φ drawn", "alpha", "N m",
         1.0, false, {},
         startTremor});
    add({"angledamping", "damping that grows with the angle", s, false, "−b·(q/1.2 rad)²·w", "b",
         "N m s", 0.2, false, {}, extra<&Extras::angleDamping>});
    add({"dropout", "EMG dropout", in, false,
         "EMG of both biceps heads × (1 − d) for 0.6 to 1.2 s, their muscles go on", "d", "", 0.5,
         false, {},
         loseEmg});
    add({"contact", "contact that comes and goes", s, false,
         "+k·max(0, q_c − q) from 1.2 to 2.8 s, q_c = 1.2 rad: something to rest on, then taken away",
         "k", "N m/rad", 3.0, false, {}, extra<&Extras::contact>});
  }
  // clang-format on

  void add(EffectRow row) { rows_.push_back(std::move(row)); }

  const std::string s = "structure", in = "input", g = "geometry", se = "sensor", p = "parameter";
  std::vector<EffectRow> rows_;
};

}  // namespace

std::vector<Reading> EffectRow::readings(double amplitude) const {
  // a baseline is what must be taken off the EMG
  if (id == "offset") return {{quantity, unit, amplitude}, {"level", unit, -amplitude}};
  if (!relative) return {{quantity, unit, amplitude}};
  return {{quantity, "", amplitude},
          {"factor", "", 1 + amplitude},
          {"log_factor", "", std::log(1 + amplitude)}};
}

const std::vector<EffectRow>& hiddenEffects() {
  static const std::vector<EffectRow> table = EffectTable::make();
  return table;
}

const EffectRow& hiddenEffect(const std::string& id) {
  for (const EffectRow& row : hiddenEffects()) {
    if (row.id == id) return row;
  }
  throw std::invalid_argument(fmt::format("no hidden effect is called '{}'", id));
}

std::string effectsAsMarkdown() {
  std::string text =
      "# What can be hidden\n\n"
      "Made by `make_hidden_elbow --list`. τ is a torque on the elbow, + for flexion; q the "
      "flexion angle [rad], w its\n"
      "rate; u an EMG channel, a an activation. Amplitude = size × full size. A relative change is "
      "given as a, the\n"
      "quantity being multiplied by 1 + a.\n\n"
      "| id | what | kind | law | amplitude | full size | equivalents "
      "|\n|---|---|---|---|---|---|---|\n";
  bool beyond = false;
  for (const EffectRow& row : hiddenEffects()) {
    if (!row.inCatalogue && !beyond) {
      beyond = true;
      text +=
          "\nOut of the catalogue, which no name fits:\n\n"
          "| id | what | kind | law | amplitude | full size | equivalents "
          "|\n|---|---|---|---|---|---|---|\n";
    }
    text += fmt::format(
        "| `{}` | {} | {} | {} | {} | {:g}{}{} | {} |\n", row.id, row.name, row.kind, row.formula,
        row.quantity, row.fullSize, row.unit.empty() ? "" : " ", row.unit,
        row.equivalents.empty() ? "–" : fmt::format("{}", fmt::join(row.equivalents, ", ")));
  }
  return text;
}

std::vector<Nuisance> drawNuisances(Truth& truth, RandomNumbers& random, double share,
                                    const std::vector<std::string>& notDrawn,
                                    const Departures& departures) {
  std::vector<Nuisance> drawn;
  const auto draw = [&](const std::string& name, double deviation) {
    const double factor = std::exp(share * deviation * random.normalWithin(2.5));
    const bool stays = std::any_of(notDrawn.begin(), notDrawn.end(),
                                   [&](const auto& pattern) { return matches(pattern, name); });
    drawn.push_back({name, stays ? 1 : factor});
    return drawn.back().factor;
  };
  for (HillMuscle& m : truth.numbers.muscles) {
    m.maxForce *= draw(m.name + ".max_isometric_force", departures.force);
    m.fibreLength *= draw(m.name + ".optimal_fiber_length", departures.fibreLength);
    m.slackLength *= draw(m.name + ".tendon_slack_length", departures.slackLength);
  }
  scaleMass(truth, draw("forearm.mass", departures.mass));
  slowActivation(truth, draw("activation.time", departures.activation));
  return drawn;
}

}  // namespace hidden
