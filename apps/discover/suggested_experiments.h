#pragma once

#include <set>
#include <string>
#include <vector>

#include "bio/discovery/encompassing_model.h"
#include "info/discovery/discover.h"

namespace app {

/// An experiment that distinguishes effects which the data at hand cannot.
struct Intervention {
  /// Prefixes of the ids that it distinguishes; it helps if a class has at least two of them.
  std::set<std::string> separates;
  std::string sentence;
};

/// The experiments that are possible with one kind of system.
struct FollowUps {
  std::vector<Intervention> interventions;
  std::string otherwise;  ///< for a class that none of them separates
  std::string ifUnknown, ifNamed;
};
FollowUps followUpsOfModels(const bio::discover::EncompassingModel& model);

/// The experiment to do after this verdict, in words: the one that distinguishes most members of a
/// class of effects, or what to record if no effect was named. It is chosen by the ids of the
/// effects, not by simulation.
std::string followUp(const info::discover::DiscoveryProblem& data,
                     const info::discover::Verdict& verdict, const FollowUps& known);

}  // namespace app
