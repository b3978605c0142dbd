#include "reduced/reduced_quantities.h"

#include <algorithm>

namespace reduced {

using info::discover::Candidate;
using info::discover::EffectKind;
using info::discover::Quantity;

std::vector<Quantity> sharedQuantities() {
  return {
      {"F0 of BIC", "N", 550, 100, 3000, 0.15, true},
      {"F0 of BRA", "N", 850, 150, 5000, 0.15, true},
      {"F0 of BRD", "N", 250, 50, 1500, 0.15, true},
      {"F0 of TRI", "N", 1100, 200, 6000, 0.15, true},
      {"optimal length of BIC", "m", 0.13, 0.08, 0.2, 0.04, true},
      {"optimal length of BRA", "m", 0.09, 0.055, 0.15, 0.04, true},
      {"optimal length of BRD", "m", 0.17, 0.1, 0.3, 0.04, true},
      {"optimal length of TRI", "m", 0.10, 0.06, 0.16, 0.04, true},
      {"mass of the forearm", "kg", 1.5, 0.7, 3, 0.05, true},
      {"activation time", "s", 0.03, 0.01, 0.1, 0.2, true},
      {"viscous damping", "N·m·s/rad", 0, 0, 3, 0.3},
      {"Coulomb friction", "N·m", 0, 0, 3, 0.6},
      {"Stribeck friction", "N·m", 0, 0, 3, 0.6},
      {"Stribeck speed", "rad/s", 0.5, 0.1, 2, 0.4, true},
      {"drag", "N·m·s²/rad²", 0, 0, 1, 0.1},
      {"joint stiffness", "N·m/rad", 0, 0, 10, 2},
      {"torque of the limits", "N·m", 0, 0, 5, 1},
      {"limit in flexion", "rad", 2.2, 1.6, 2.8, 0.2},
      {"limit in extension", "rad", 0.35, -0.2, 0.9, 0.2},
      {"payload", "kg", 0, -0.4, 5, 0.7},
      {"tilt", "rad", 0, -0.5, 0.5, 0.3},
      {"constant torque", "N·m", 0, -5, 5, 1},
      {"hand force", "N", 0, -20, 20, 3},
      {"fatigue", "", 0, 0, 0.9, 0.3},
      {"fatigue time", "s", 0.5, 0.05, 5, 0.7, true},
      {"delay", "s", 0, 0, 0.1, 0.05},
      {"EMG shape", "", 0, -6, 4, 1.5},
      {"BIC in TRI", "", 0, 0, 0.5, 0.2},
      {"TRI in BIC", "", 0, 0, 0.5, 0.2},
      {"wrap radius of BIC", "m", 0, -0.012, 0.012, 0.006},
      {"wrap radius of TRI", "m", 0, -0.012, 0.012, 0.006},
      {"sensor bias", "rad", 0, -0.5, 0.5, 0.1},
      {"sensor gain", "", 0, -0.4, 0.4, 0.1},
      {"clock offset", "s", 0, 0, 0.1, 0.05},
  };
}

std::vector<Candidate> catalogue(const std::vector<std::string>& hidden) {
  std::vector<Candidate> all;
  const auto vec = [](std::vector<double> x) {
    return Eigen::VectorXd(Eigen::VectorXd::Map(x.data(), static_cast<Eigen::Index>(x.size())));
  };
  const auto add = [&](std::string id, std::string sentence, EffectKind kind,
                       std::vector<std::size_t> quantities, std::vector<double> sds,
                       const std::vector<std::vector<double>>& starts,
                       std::vector<std::string> equivalents = {}) {
    Candidate c{id, sentence, sentence, kind, std::move(quantities), std::move(sds), {}, {}};
    for (const auto& s : starts) c.starts.push_back(vec(s));
    c.equivalents = std::move(equivalents);
    all.push_back(std::move(c));
  };
  const auto structure = EffectKind::structure, input = EffectKind::input;
  const auto sensor = EffectKind::sensor, parameter = EffectKind::parameter;
  add("visc", "viscous joint damping", structure, {kViscous}, {0.3}, {{0.05}});
  add("coulomb", "dry friction in the joint", structure, {kCoulomb}, {0.6}, {{0.1}});
  add("stribeck", "dry friction that sticks", structure, {kStribeck, kStribeckSpeed}, {0.6, 0.4},
      {{0.05, 0.5}});
  add("drag", "quadratic drag", structure, {kDrag}, {0.1}, {{0.02}});
  add("stiffness", "joint stiffness", structure, {kStiffness}, {2}, {{0.2}});
  add("limit", "passive limits of the joint", structure, {kLimit, kLimitFlexed, kLimitExtended},
      {1, 0.2, 0.2}, {{0.1, 2.2, 0.35}, {0.1, 1.9, 0.35}, {0.1, 2.2, 0.65}, {0.1, 1.9, 0.65}});
  add("payload", "mass in the hand", structure, {kPayload}, {0.7}, {{0.0}}, {"mass"});
  add("tilt", "tilted arm", structure, {kTilt}, {0.3}, {{0.0}}, {"handforce"});
  add("const", "constant torque", structure, {kConstant}, {1}, {{0.0}});
  add("handforce", "constant horizontal force on the hand", structure, {kHandForce}, {3}, {{0.0}},
      {"tilt"});
  add("fatigue", "muscle fatigue", structure, {kFatigue, kFatigueTime}, {0.3, 0.7},
      {{0.05, 0.5}, {0.05, 0.15}});
  add("delay", "electromechanical delay", input, {kDelay}, {0.05}, {{0.01}}, {"clock"});
  add("shape", "nonlinear relation of EMG and excitation", input, {kShape}, {1.5}, {{0.0}});
  add("tri<bic", "crosstalk of BIC in TRI's electrode", input, {kTriFromBic}, {0.2}, {{0.02}});
  add("bic<tri", "crosstalk of TRI in BIC's electrode", input, {kBicFromTri}, {0.2}, {{0.02}});
  add("wrapBIC", "moment arm of BIC", EffectKind::geometry, {kWrapBic}, {0.006}, {{0.0}});
  add("wrapTRI", "moment arm of TRI", EffectKind::geometry, {kWrapTri}, {0.006}, {{0.0}});
  add("bias", "bias of the angle sensor", sensor, {kBias}, {0.1}, {{0.0}});
  add("gain", "gain of the angle sensor", sensor, {kGain}, {0.1}, {{0.0}});
  add("clock", "clock offset of the angle sensor", sensor, {kClock}, {0.05}, {{0.01}}, {"delay"});
  add("tau", "activation time", parameter, {kTau}, {0.8}, {{0.03}});
  const char* muscles[] = {"BIC", "BRA", "BRD", "TRI"};
  const double forces[] = {550, 850, 250, 1100}, lengths[] = {0.13, 0.09, 0.17, 0.10};
  for (std::size_t m = 0; m < 4; ++m) {
    add(std::string("Fmax") + muscles[m], std::string("strength of ") + muscles[m], parameter,
        {kForce + m}, {0.6}, {{forces[m]}});
    add(std::string("lopt") + muscles[m], std::string("optimal length of ") + muscles[m], parameter,
        {kLength + m}, {0.2}, {{lengths[m]}});
  }
  add("mass", "mass of the forearm", parameter, {kMass}, {0.3}, {{1.5}}, {"payload"});
  std::erase_if(all, [&](const Candidate& c) {
    return std::find(hidden.begin(), hidden.end(), c.id) != hidden.end();
  });
  return all;
}

}  // namespace reduced
