#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "parameters/parameter_list.h"

namespace bio {

void addEmgParameters(const MusculoskeletalSystem& system, const EmgMapping& mapping,
                      ParameterList& list) {
  if (system.muscles().empty()) return;
  for (const SystemMuscle& muscle : system.muscles()) {
    const auto at = mapping.gain.find(muscle.name);
    const double gain = at == mapping.gain.end() ? 1.0 : at->second;
    list.add(fmt::format("emg.{}.gain", muscle.name), "", "factor on the trial's excitation", gain,
             {0, 5, 0.2}, {EmgTarget{EmgTarget::What::gain, muscle.name}});
  }
  list.add("emg.delay", "s", "electromechanical delay", mapping.delay, {0, 0.2, 0.02},
           {EmgTarget{EmgTarget::What::delay, ""}});
  list.add("emg.nonlinearity", "", "shape A of the EMG–excitation relation; 0: linear",
           mapping.nonlinearity, {-3, 0, 1}, {EmgTarget{EmgTarget::What::nonlinearity, ""}});
}

void addLatentParameters(const EmgMapping& mapping, ParameterList& list) {
  constexpr double most = 10;
  for (const auto& [muscle, latent] : mapping.latent) {
    for (std::size_t k = 0; k < latent.knots.size(); ++k) {
      list.add(fmt::format("emg.{}.latent{}", muscle, k + 1), "",
               fmt::format("correction of the excitation's log-odds at {:.4g} s", latent.knots[k]),
               latent.values[static_cast<Eigen::Index>(k)], {-most, most, latent.sd},
               {EmgTarget{EmgTarget::What::latent, muscle, "", k}});
    }
  }
}

void addStartParameters(const MusculoskeletalSystem& system, const StartPoint& start,
                        ParameterList& list) {
  const auto& coordinates = system.skeleton().coordinates();
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (system.isPrescribed(static_cast<int>(i))) continue;
    const bool turns = coordinates[i].isRotation;
    const double value = start.q[k];
    const double wide = turns ? std::numbers::pi : 1;
    list.add("initial." + coordinates[i].name, turns ? "rad" : "m", "coordinate at the start",
             value,
             {std::max(coordinates[i].rangeMin, value - wide),
              std::min(coordinates[i].rangeMax, value + wide), turns ? 0.035 : 0.005},
             {InitialTarget{static_cast<int>(i), false}});
  }
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (system.isPrescribed(static_cast<int>(i))) continue;
    const bool turns = coordinates[i].isRotation;
    const double least = turns ? 0.1 : 0.02;
    list.add("initial." + coordinates[i].name + ".speed", turns ? "rad/s" : "m/s",
             "speed at the start", start.qDot.size() ? start.qDot[k] : 0.0,
             {turns ? -10.0 : -2.0, turns ? 10.0 : 2.0,
              start.speedSd.size() ? std::max(least, start.speedSd[k]) : least},
             {InitialTarget{static_cast<int>(i), true}});
  }
}

}  // namespace bio
