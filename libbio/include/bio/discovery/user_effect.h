#pragma once

#include <string>
#include <vector>

#include "info/discovery/likelihood/discovery_problem.h"

namespace bio::discover {

/// An effect that the catalogue lacks and the user has a formula for: a force on a coordinate. It
/// is raced like the others and written as OpenSim's ExpressionBasedCoordinateForce.
struct UserEffect {
  std::string file;                  ///< for messages
  std::string id;                    ///< small letters, digits and _, a letter first
  std::string name, sentence;        ///< as of Candidate
  std::string coordinate;            ///< on which it acts; empty: one of each in question
  std::string expression;            ///< of the force [N m] or [N], in q, qdot and the parameters
  std::vector<std::string> symbols;  ///< of the parameters in it, the amplitude first
  std::vector<info::discover::Quantity> quantities;  ///< as many, named "id.symbol"
  std::vector<std::vector<double>> starts;           ///< values of all, from which fits start
};

/// Reads a TOML file of effects (docs/files.md): [[effect]] with id, name, sentence, coordinate and
/// expression, and in each [[effect.parameter]] with name, unit, nominal, lower, upper, sd, starts.
/// The first parameter is the amplitude: without it (0) there is no force.
/// @throws FileError naming file, line and key: what cannot be parsed, an expression with another
///   name in it or that does not vanish with its amplitude, bounds that do not enclose the nominal
///   value, an id that is given twice
std::vector<UserEffect> readUserEffects(const std::string& file);

}  // namespace bio::discover
