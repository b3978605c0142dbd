#pragma once

#include <string>
#include <vector>

#include "bio/tables/trial.h"

namespace bio {

/// A file, or a trial from memory, by its content.
struct TrialIdentity {
  std::string file;    ///< name, for messages
  std::string sha256;  ///< of the content; empty: not known, so it is like no other
};

/// No trial may be given twice, since it would count twice, and no held-out trial may be used for
/// estimation.
/// @param trials  those for estimation, then those held out
/// @param training  number of those for estimation
/// @throws std::invalid_argument naming both of the first pair with the same content
void requireDifferentTrials(const std::vector<TrialIdentity>& trials, std::size_t training);
void requireDifferentTrials(const std::vector<Trial>& training, const std::vector<Trial>& heldOut);

}  // namespace bio
