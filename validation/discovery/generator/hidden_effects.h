#pragma once

#include <string>
#include <vector>

#include "generator/elbow_numbers.h"
#include "generator/random_numbers.h"
#include "generator/true_elbow.h"

namespace hidden {

/// Between the elbow's angle and what is recorded of it: y(t) = (1 + gain)·q(t − clock) + bias.
struct Sensor {
  double bias = 0;   ///< [rad]
  double gain = 0;   ///< [1]
  double clock = 0;  ///< [s] ≥ 0
};

/// A time in which two channels record next to nothing while their muscles go on.
struct Dropout {
  bool present = false;
  double level = 1;         ///< what is left of the EMG
  double from = 0, to = 0;  ///< [s]
};

/// Everything about the elbow that made the data.
struct Truth {
  ElbowNumbers numbers;
  InputChain chain;
  Extras extras;
  Sensor sensor;
  Dropout dropout;
};

/// Where an estimate of this effect's size may be found: the same truth under several names.
struct Reading {
  std::string name, unit;
  double value;
};

/// One thing that can be hidden.
struct EffectRow {
  std::string id, name;
  std::string kind;      ///< structure, input, geometry, sensor, parameter
  bool inCatalogue;      ///< false: nothing of that name is in the tool's catalogue
  std::string formula;   ///< with the sign convention; τ + for flexion, q angle, w rate
  std::string quantity;  ///< the amplitude's name
  std::string unit;
  double fullSize;  ///< amplitude at --size 1, in that unit
  bool relative;    ///< a relative change: the quantity is multiplied by 1 + amplitude
  std::vector<std::string> equivalents;  ///< names that count as right (design, declared)
  void (*apply)(Truth&, double amplitude, RandomNumbers&);
  /// The nuisances whose place this takes, "TRI*.max_isometric_force": a parameter is off by just
  /// the amplitude, whatever the person's own draw
  std::string inPlaceOf = {};
  /// The muscle that the model has switched off, and whose EMG nobody recorded
  std::string leftOut = {};

  double amplitude(double size) const { return size * fullSize; }
  std::vector<Reading> readings(double amplitude) const;
};

/// All of them, catalogue first.
const std::vector<EffectRow>& hiddenEffects();
/// @throws std::invalid_argument for an unknown id
const EffectRow& hiddenEffect(const std::string& id);

/// The table as Markdown, which validation/discovery/effects.md holds.
std::string effectsAsMarkdown();

/// A nuisance: by how much a quantity of the subject departs from the nominal model.
struct Nuisance {
  std::string name;
  double factor;
};

/// Standard deviations of the logarithms of what differs between a person and the nominal model:
/// F0, ℓ0 and ℓs of every muscle by itself, the mass of everything beyond the elbow, the activation
/// time constants of all muscles together.
struct Departures {
  double force = 0.15, fibreLength = 0.04, slackLength = 0.01, mass = 0.05, activation = 0.2;
};

/// Makes the nominal elbow a person; draws beyond 2.5 deviations are repeated.
/// @param share     of these deviations; 0: the nominal model, which no person is
/// @param notDrawn  nuisances that stay nominal, `*` for any middle; the others are what they would
///                  be without this list
std::vector<Nuisance> drawNuisances(Truth& truth, RandomNumbers& random, double share = 1,
                                    const std::vector<std::string>& notDrawn = {},
                                    const Departures& departures = {});

}  // namespace hidden
