#include "bio/discovery/effect_names.h"

#include <array>
#include <string_view>

namespace bio::discover {
namespace {

struct LongName {
  std::string_view id;
  std::string_view name;
  bool isPrefix = false;  ///< a muscle or group follows
};

constexpr std::array<LongName, 12> longNames{{
    {"visc", "viscous_damping"},
    {"powerdamp", "sublinear_damping"},
    {"const", "constant_torque"},
    {"spring", "elastic_band"},
    {"tau", "activation_time_scale"},
    {"shape", "emg_nonlinearity"},
    {"gain", "sensor_gain"},
    {"offset", "emg_baseline"},
    {"Fmax_", "max_isometric_force_", true},
    {"lopt_", "optimal_fiber_length_", true},
    {"lslack_", "tendon_slack_length_", true},
    {"offset_", "emg_baseline_", true},
}};

std::string translated(const std::string& word, std::string_view LongName::*from,
                       std::string_view LongName::*to) {
  for (const LongName& name : longNames) {
    if (!name.isPrefix && word == name.*from) return std::string(name.*to);
    if (name.isPrefix && word.size() > (name.*from).size() && word.starts_with(name.*from)) {
      return std::string(name.*to) + word.substr((name.*from).size());
    }
  }
  return word;
}

}  // namespace

std::string effectId(const std::string& name) {
  return translated(name, &LongName::name, &LongName::id);
}

std::vector<std::string> effectIds(const std::vector<std::string>& names) {
  std::vector<std::string> ids;
  for (const std::string& name : names) ids.push_back(effectId(name));
  return ids;
}

std::string effectLongName(const std::string& id) {
  return translated(id, &LongName::id, &LongName::name);
}

}  // namespace bio::discover
