#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bio/analysis/sensitivity_study.h"
#include "systems.h"

/// What functions of parameters of several trials begin with.
namespace python {

struct Studies {
  SystemChoice choice;
  std::unique_ptr<bio::MusculoskeletalSystem> system = {};
  std::vector<bio::StudiedTrial> trials = {};
  bio::SensitivityQuestion question = {};

  const bio::ParameterCatalogue& catalogue() const { return trials.front().catalogue; }
};

/// The four arguments that choose a system, as defineWithChoice() has them, and the start.
struct Choosing {
  std::map<std::string, double> initial;
  Names coordinate;
  std::map<std::string, double> lock;
  std::string integrator;
  std::optional<double> step;
};

/// @throws std::invalid_argument for no trial, one given twice or recorded with something changed
/// on purpose, and what systemChoice() throws
Studies begun(const bio::Model& model, const std::vector<bio::Trial>& trials,
              const Choosing& chosen);

/// Systems are made here: within interruptible().
void prepare(Studies& studies, const bio::Model& model, const std::vector<bio::Trial>& trials,
             const Choosing& chosen, const std::atomic<bool>& goOn);

/// @param otherwise  what could be done, behind the message's first sentence
/// @throws std::invalid_argument if all coordinates are prescribed
void mustHaveFreeCoordinate(const Studies& studies, const char* otherwise);

}  // namespace python
