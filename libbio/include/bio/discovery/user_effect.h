#pragma once

#include <string>
#include <vector>

#include "info/discovery/likelihood/discovery_problem.h"

namespace bio::discover {

/// An effect that is a force on a coordinate, given by a formula in q, qdot and its quantities; in
/// a model OpenSim's ExpressionBasedCoordinateForce.
struct ExpressionEffect {
  std::string id, name, sentence;      ///< as of Candidate
  std::string expression;              ///< of the force [N m] or [N]
  std::vector<std::string> constants;  ///< the quantities' names in it, the amplitude first
  std::vector<info::discover::Quantity> quantities;  ///< as many
  std::vector<std::vector<double>> starts;           ///< values of all, from which fits start
  std::vector<std::string> equivalents = {};
};

/// One that the catalogue lacks and the user has a formula for. It is raced like the others.
struct UserEffect : ExpressionEffect {
  std::string file;        ///< for messages
  std::string coordinate;  ///< on which it acts; empty: one of each in question
};

/// Reads TOML files of effects (docs/files.md): [[effect]] with id, name, sentence, coordinate and
/// expression, and in each [[effect.parameter]] with name, unit, nominal, lower, upper, sd, starts.
/// The first parameter is the amplitude: without it (0) there is no force. Quantities are called
/// "id.name".
/// @throws FileError naming file, line and key: what cannot be parsed, an expression with another
///   name in it or that does not vanish with its amplitude, bounds that do not enclose the nominal
///   value, an id that a file gives twice
std::vector<UserEffect> readUserEffects(const std::vector<std::string>& files);

}  // namespace bio::discover
