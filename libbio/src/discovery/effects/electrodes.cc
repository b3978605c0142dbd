#include <fmt/format.h>

#include <algorithm>

#include "discovery/effects/effects.h"

// What stands between the recorded EMG and the excitation. Priors: electromechanical delays of
// 10 to 100 ms (Cavanagh & Komi 1979), A of −3 to 0 in Lloyd & Besier 2003, crosstalk of
// neighbouring surface electrodes up to some 20 %.

namespace bio::discover {

using info::discover::EffectKind;
using What = EmgTarget::What;

void addDelay(EncompassingModel& model) {
  if (model.system().numMuscles() == 0) return;
  const std::size_t d =
      model.add(amplitude("delay.time", "s", 0, 0.25, 0.05),
                {Meaning::Kind::shift, {{model.number(EmgTarget{What::delay, ""}, 0)}}});
  model.add(candidate(model, "delay", "electromechanical delay",
                      "The muscles act later than their EMG indicates. EMG that a low-pass filter "
                      "has smoothed may look like this.",
                      EffectKind::input, {d}, {{0.02}}, {"clock"}));
}

void addShape(EncompassingModel& model) {
  if (model.system().numMuscles() == 0) return;
  const std::size_t A =
      model.add(amplitude("shape.A", "", -6, 4, 1.5),
                {Meaning::Kind::shift, {{model.number(EmgTarget{What::nonlinearity, ""}, 0)}}});
  model.add(candidate(model, "shape", "EMG nonlinearity",
                      "Excitation is not proportional to EMG: (e^{Au} - 1)/(e^A - 1).",
                      EffectKind::input, {A}, {{-1.5}, {-0.5}, {0.5}, {1.5}}));
}

namespace {

std::string crosstalkId(const std::string& from, const std::string& to) {
  return fmt::format("crosstalk_{}_{}", from, to);
}

std::string exchangeId(const std::string& one, const std::string& other) {
  return fmt::format("swap_{}_{}", one, other);
}

std::string saturationId(const std::string& name) {
  return "saturated_" + name;
}

}  // namespace

/// Crosstalk to each muscle of one group from the mean of another's.
void addCrosstalk(EncompassingModel& model) {
  for (const MuscleGroup& from : model.groups()) {
    for (const MuscleGroup& to : model.groups()) {
      if ((from.momentArms.array() * to.momentArms.array() >= 0).all()) continue;
      std::vector<Meaning::Part> parts;
      for (const std::size_t i : to.muscles) {
        for (const std::size_t j : from.muscles) {
          const EmgTarget target{What::crosstalk, model.system().muscles()[i].name,
                                 model.system().muscles()[j].name};
          parts.push_back({model.number(target, 0), 1 / static_cast<double>(from.muscles.size())});
        }
      }
      const std::string id = crosstalkId(from.name, to.name);
      const std::size_t c =
          model.add(amplitude(id + ".share", "", 0, 0.5, 0.2), {Meaning::Kind::shift, parts});
      model.add(candidate(model, id, fmt::format("EMG crosstalk from {} to {}", from.name, to.name),
                          fmt::format("The electrodes of {} also pick up a share of the EMG of {}.",
                                      to.name, from.name),
                          EffectKind::input, {c}, {{0.05}}, {crosstalkId(to.name, from.name)}));
    }
  }
}

void addExchangedChannels(EncompassingModel& model) {
  const auto& muscles = model.system().muscles();
  const auto share = [&](std::size_t to, std::size_t from) {
    return model.number(EmgTarget{What::crosstalk, muscles[to].name, muscles[from].name}, 0);
  };
  for (std::size_t i = 0; i < muscles.size(); ++i) {
    for (std::size_t k = i + 1; k < muscles.size(); ++k) {
      const std::string id = exchangeId(muscles[i].name, muscles[k].name);
      const std::size_t s =
          model.add(amplitude(id + ".share", "", 0, 1.2, 0.7),
                    {Meaning::Kind::shift,
                     {{share(i, i)}, {share(i, k), -1}, {share(k, k)}, {share(k, i), -1}}});
      model.add(candidate(
          model, id,
          fmt::format("exchanged channels of {} and {}", muscles[i].name, muscles[k].name),
          fmt::format("The recordings of {} and {} are exchanged.", muscles[i].name,
                      muscles[k].name),
          EffectKind::input, {s}, {{0.9}}));
    }
  }
}

namespace {

/// Calls use(name, muscles) for every muscle, and every group of several.
template <class Use>
void forMusclesAndGroups(const EncompassingModel& model, const Use& use) {
  for (const MuscleGroup& group : model.groups()) {
    std::vector<std::string> all;
    for (const std::size_t i : group.muscles) all.push_back(model.system().muscles()[i].name);
    if (all.size() > 1) use(group.name, all);
    for (const std::string& one : all) use(one, std::vector<std::string>{one});
  }
}

}  // namespace

void addSaturation(EncompassingModel& model) {
  forMusclesAndGroups(model, [&](const std::string& name, const std::vector<std::string>& muscles) {
    std::vector<Meaning::Part> parts;
    for (const std::string& muscle : muscles) {
      parts.push_back({model.number(EmgTarget{What::saturation, muscle}, 0)});
    }
    const std::string id = saturationId(name);
    const std::size_t s =
        model.add(amplitude(id + ".size", "", 0, 5, 1), {Meaning::Kind::shift, parts});
    model.add(candidate(model, id, fmt::format("saturated EMG of {}", name),
                        fmt::format("The recording of {} saturates: its flat tops hide how much "
                                    "stronger the muscle was.",
                                    name),
                        EffectKind::input, {s}, {{1}, {0.3}}));
  });
}

std::vector<std::string> unsaturated(const EncompassingModel& model,
                                     const std::vector<std::string>& flat) {
  std::vector<std::string> ids;
  forMusclesAndGroups(model, [&](const std::string& name, const std::vector<std::string>& muscles) {
    const bool isFlat = std::all_of(muscles.begin(), muscles.end(), [&](const std::string& muscle) {
      return std::find(flat.begin(), flat.end(), muscle) != flat.end();
    });
    if (!isFlat) ids.push_back(saturationId(name));
  });
  return ids;
}

std::vector<std::string> withoutElectrode(const EncompassingModel& model,
                                          const std::vector<std::string>& silent) {
  const auto isSilent = [&](const std::string& muscle) {
    return std::find(silent.begin(), silent.end(), muscle) != silent.end();
  };
  std::vector<std::string> ids, silentGroups;
  forMusclesAndGroups(model, [&](const std::string& name, const std::vector<std::string>& muscles) {
    if (!std::all_of(muscles.begin(), muscles.end(), isSilent)) return;
    ids.push_back(gainId(name));
    ids.push_back(saturationId(name));
  });
  const auto& muscles = model.system().muscles();
  for (const MuscleGroup& group : model.groups()) {
    if (std::all_of(group.muscles.begin(), group.muscles.end(),
                    [&](std::size_t i) { return isSilent(muscles[i].name); }))
      silentGroups.push_back(group.name);
  }
  for (const std::string& silentGroup : silentGroups) {
    for (const MuscleGroup& other : model.groups()) {
      ids.push_back(crosstalkId(silentGroup, other.name));
      ids.push_back(crosstalkId(other.name, silentGroup));
    }
  }
  for (std::size_t i = 0; i < muscles.size(); ++i) {
    for (std::size_t k = i + 1; k < muscles.size(); ++k) {
      if (isSilent(muscles[i].name) || isSilent(muscles[k].name))
        ids.push_back(exchangeId(muscles[i].name, muscles[k].name));
    }
  }
  return ids;
}

void addElectrodeGains(EncompassingModel& model) {
  const auto add = [&](const std::string& id, const std::vector<std::string>& muscles,
                       const std::string& name, const std::string& sentence,
                       const std::vector<std::string>& equivalents) {
    std::vector<Meaning::Part> parts;
    for (const std::string& muscle : muscles) {
      parts.push_back({model.number(EmgTarget{What::gain, muscle}, 1)});
    }
    const std::size_t g =
        model.add(factor(id + ".factor", 0.2, 5, 0.3), {Meaning::Kind::scale, parts});
    model.add(candidate(model, id, name, sentence, EffectKind::input, {g}, {{1.1}}, equivalents));
  };
  forMusclesAndGroups(model, [&](const std::string& name, const std::vector<std::string>& muscles) {
    add(gainId(name), muscles, fmt::format("electrode gain of {}", name),
        fmt::format("The EMG of {} is scaled by a wrong gain.", name), {"Fmax_" + name});
  });
  if (model.groups().size() < 2) return;  // else that of the only group
  std::vector<std::string> all;
  for (const SystemMuscle& muscle : model.system().muscles()) all.push_back(muscle.name);
  add("gain_of_all", all, "electrode gain of all muscles",
      "The EMG of all muscles is scaled by one wrong gain, as by a wrong unit, amplification or "
      "maximum voluntary contraction.",
      {});
}

void addBaselines(EncompassingModel& model) {
  const auto add = [&](const std::string& id, const std::string& of,
                       const std::vector<std::string>& muscles) {
    std::vector<Meaning::Part> parts;
    for (const std::string& muscle : muscles) {
      parts.push_back({model.number(EmgTarget{What::offset, muscle}, 0)});
    }
    const std::size_t o =
        model.add(amplitude(id + ".level", "", -0.1, 0.1, 0.02), {Meaning::Kind::shift, parts});
    model.add(candidate(model, id, "EMG baseline of " + of,
                        fmt::format("The EMG of {} does not return to zero at rest.", of),
                        EffectKind::input, {o}, {{0.005}}));
  };
  std::vector<std::string> all;
  for (const SystemMuscle& muscle : model.system().muscles()) all.push_back(muscle.name);
  if (all.empty()) return;
  add("offset", "all muscles", all);
  for (const MuscleGroup& group : model.groups()) {
    std::vector<std::string> muscles;
    for (const std::size_t i : group.muscles) muscles.push_back(model.system().muscles()[i].name);
    add("offset_" + group.name, group.name, muscles);
  }
}

}  // namespace bio::discover
