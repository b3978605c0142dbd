#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <stdexcept>

#include "robots/hidden_robots.h"

// The robots of the blind benchmark, and what can be hidden in them.
namespace hidden {
namespace {

RobotKind pendulumKind() {
  RobotKind k;
  k.name = "double-pendulum";
  k.nominal = {{"m_1", 0.085},
               {"m_2", 0.0847},
               {"com_1", 0.146},
               {"com_2", 0.125},
               {"I_1", 0.085 * (0.305 * 0.305 + 0.0445 * 0.0445) / 12},
               {"I_2", 0.0847 * (0.305 * 0.305 + 0.0381 * 0.0381) / 12},
               {"pivots", 0.2796},
               {"damping", 5e-4}};
  k.tolerance = {{"m_1", 0.03}, {"m_2", 0.03}, {"com_1", 0.02},   {"com_2", 0.02},
                 {"I_1", 0.05}, {"I_2", 0.05}, {"pivots", 0.005}, {"damping", 0.3}};
  const std::string s = "structure", in = "input", se = "sensor", p = "parameter";
  k.effects = {
      {"visc_1", s, true, "moment −b·w in joint 1", "N m s", 2e-3, {}, false},
      {"visc_2", s, true, "moment −b·w in joint 2", "N m s", 1e-3, {}, false},
      {"coulomb_1", s, true, "moment −c·tanh(w/0.05 rad/s) in joint 1", "N m", 3e-3, {}, false},
      {"coulomb_2", s, true, "moment −c·tanh(w/0.05 rad/s) in joint 2", "N m", 1.5e-3, {}, false},
      {"stribeck_1",
       s,
       true,
       "moment −c·[1 + e^{−(w/0.5 rad/s)²}]·tanh(w/0.05 rad/s) in joint 1",
       "N m",
       3e-3,
       {},
       false},
      {"stribeck_2",
       s,
       true,
       "moment −c·[1 + e^{−(w/0.5 rad/s)²}]·tanh(w/0.05 rad/s) in joint 2",
       "N m",
       1.5e-3,
       {},
       false},
      {"drag", s, true, "force −k·abs(v)·v at each link's mass centre", "N s²/m²", 0.02, {}, false},
      {"tilt", s, true, "gravity's moments are those of the angles + δ", "rad", 0.05, {}, true},
      {"lag", in, true, "T·da_c/dt = a − a_c between command and cart", "s", 0.03, {}, false},
      {"bias_1", se, true, "angle 1 + b is read", "rad", 0.05, {}, true},
      {"bias_2", se, true, "angle 2 + b is read", "rad", 0.08, {}, true},
      {"gain_1", se, true, "(1 + g)·angle 1 is read", "", 0.1, {}, true},
      {"gain_2", se, true, "(1 + g)·angle 2 is read", "", 0.15, {}, true},
      {"clock", se, true, "both angles of T before are read", "s", 0.03, {}, false},
      {"m_1", p, true, "× (1 + a)", "change", 0.4, {}, true},
      {"com_1", p, true, "× (1 + a)", "change", 0.2, {}, true},
      {"com_2", p, true, "× (1 + a)", "change", 0.2, {}, true},
      {"I_2", p, true, "× (1 + a)", "change", 0.5, {}, true},
      {"damping", p, true, "of both joints × (1 + a)", "change", 3, {}, false},
      {"cable_1", s, false, "moment −k·angle of a cable in joint 1", "N m/rad", 0.04, {}, false},
      {"cogging_1", s, false, "moment −k·sin(6·angle) in joint 1", "N m", 0.02, {}, false},
      {"locked_2",
       s,
       true,
       "moment −k·(angle + w·2 ms) in joint 2: towards one link fewer",
       "N m/rad",
       1,
       {},
       false,
       false},
      {"welded_2",
       s,
       true,
       "joint 2 does not turn: one link fewer",
       "",
       1,
       {"locked_2"},
       false,
       false},
      {"link_3",
       s,
       true,
       "a mass on a light rod of 0.1 m ± 30 %, hung from link 2 at 0.2796 m; its joint brakes with "
       "0.5/s of its inertia",
       "kg",
       0.005,
       {},
       false,
       false},
  };
  k.columns = {"link1_deg", "link2_deg"};
  k.noise = {std::sqrt(1.12e-4), std::sqrt(4.79e-4)};
  k.inDegrees = true;
  k.interval = 0.02;
  k.observe = observeDoublePendulum;
  return k;
}

RobotKind massKind() {
  RobotKind k;
  k.name = "suspended-mass";
  k.nominal = {{"mass", 0.12}, {"length", 0.5}};
  k.tolerance = {{"mass", 0.03}, {"length", 0.02}};
  const std::string s = "structure", in = "input", se = "sensor", p = "parameter";
  k.effects = {
      {"drag", s, true, "force −k·abs(v)·v on the mass", "N s²/m²", 0.04, {}, false},
      {"elastic",
       s,
       true,
       "a string longer by C·(F − m g) than it hangs, inner damping 0.2 N s/m",
       "m/N",
       0.02,
       {},
       false},
      {"lag", in, true, "T·da_c/dt = a − a_c between command and cart", "s", 0.04, {}, false},
      {"saturation",
       se,
       true,
       "the share s of all force beyond 1.4 N is not read",
       "",
       1,
       {},
       false},
      {"bias", se, true, "F + b is read", "N", 0.3, {}, true},
      {"gain", se, true, "(1 + g)·F is read", "", 0.2, {"mass"}, true},
      {"clock", se, true, "the force of T before is read", "s", 0.04, {}, false},
      {"mass", p, true, "× (1 + a)", "change", 0.2, {"gain"}, true},
      {"length", p, true, "× (1 + a)", "change", 0.15, {}, true},
      {"creep",
       s,
       false,
       "the string grows by the share c of its length per second",
       "1/s",
       0.05,
       {},
       false},
      {"drift", se, false, "F + d·t is read", "N/s", 0.08, {}, true},
      {"visc", s, true, "moment −b·w of the pivot", "N m s", 0.02, {}, false, false},
      {"coulomb",
       s,
       true,
       "moment −c·tanh(w/0.05 rad/s) of the pivot",
       "N m",
       0.02,
       {},
       false,
       false},
      {"tilt", s, true, "gravity's parts are those of the angle + δ", "rad", 0.2, {}, true, false},
  };
  k.columns = {"force_N"};
  k.noise = {std::sqrt(500.0 / 33044)};
  k.inDegrees = false;
  k.interval = 0.01;
  k.observe = observeSuspendedMass;
  return k;
}

}  // namespace

const RobotKind& robotKind(const std::string& name) {
  static const RobotKind pendulum = pendulumKind(), mass = massKind();
  if (name == pendulum.name) return pendulum;
  if (name == mass.name) return mass;
  throw std::invalid_argument(
      fmt::format("system '{}', must be double-pendulum or suspended-mass", name));
}

std::string robotEffectsAsMarkdown() {
  std::string text =
      "# What can be hidden in the robots\n\nMade by `make_hidden_robot --list`. Angles from "
      "hanging "
      "down [rad], w the rate of a joint, v a velocity, F the string's force.\nAmplitude = size × "
      "full size; a parameter is multiplied by 1 + amplitude.\n";
  for (const char* name : {"double-pendulum", "suspended-mass"}) {
    text += fmt::format(
        "\n## {}\n\n| id | kind | law | full size | equivalents |\n|---|---|---|---|---|\n", name);
    for (const RobotEffect& e : robotKind(name).effects)
      text += fmt::format(
          "| `{}` | {}{}{} | {} | {}{:g} {} | {} |\n", e.id, e.kind,
          e.inCatalogue ? "" : ", no name in the catalogue", e.bySeed ? "" : ", only by name",
          e.law, e.eitherSign ? "±" : "", e.fullSize, e.unit,
          e.equivalents.empty() ? "–" : fmt::format("{}", fmt::join(e.equivalents, ", ")));
  }
  return text;
}

}  // namespace hidden
