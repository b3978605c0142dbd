#pragma once

#include <set>
#include <string>
#include <vector>

#include "info/discover/discover.h"

namespace app {

/// What one intervention does to a class of effects that cannot be told apart.
struct Intervention {
  std::set<std::string> separates;  ///< ids or their beginnings; two of them in a class: useful
  std::string sentence;
};

/// What can be done with one kind of system.
struct FollowUps {
  std::vector<Intervention> interventions;
  std::string otherwise;  ///< for a class that none of them separates
  std::string ifUnknown, ifNamed;
};
const FollowUps& followUpsOfArms();

/// The experiment that would tell most after this verdict, in words: what separates most members of
/// a class, or what to record where nothing could be said. Chosen by what the effects are, not
/// simulated.
std::string followUp(const info::discover::Disagreement& data,
                     const info::discover::Verdict& verdict, const FollowUps& known);

}  // namespace app
