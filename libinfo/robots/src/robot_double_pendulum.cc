#include "robot_catalogue.h"
#include "robots/cart_double_pendulum.h"
#include "step_sensitivity.h"

namespace info::robot {
namespace {

using discover::EffectKind;

constexpr double kStillAir = 1e-4;   // [m/s], likewise drag
constexpr double kLockLoss = 2e-3;   // [s], damping over stiffness of a locked joint
constexpr double kSwivelLoss = 0.5;  // [1/s], damping over inertia of the third link's joint

enum : std::size_t {
  kMass1,
  kMass2,
  kCom1,
  kCom2,
  kInertia1,
  kInertia2,
  kPivots,
  kDamping,
  kViscous1,
  kViscous2,
  kCoulomb1,
  kCoulomb2,
  kStribeck1,
  kStribeckRate1,
  kStribeck2,
  kStribeckRate2,
  kDrag,
  kTilt,
  kLag,
  kBias1,
  kBias2,
  kGain1,
  kGain2,
  kClock,
  kLock2,
  kMass3,
  kLength3,
  kCount
};

// Where a third link would hang: from the second joint, L2 − 2·offset [m].
double endOfLink2() {
  const CartDoublePendulum<> rig;
  return rig.length2 - 2 * rig.offset;
}

// State (α, β, α̇, β̇, cart speed, cart acceleration), with γ, γ̇ before the cart's where the third
// link is looked at.
//
// The third link is a point mass m3 on a rod of length ℓ below the end of link 2. Its own equation,
// divided by m3 ℓ, gives ℓ γ̈ whatever m3 is; put into the other two, it leaves terms in m3 alone.
template <bool Third>
struct Pendulum {
  static constexpr int stateSize = Third ? 8 : 6, startSize = 4, rate1 = 2;
  static constexpr std::size_t sharedSize = kCount, lag = kLag, clock = kClock;
  template <class T>
  using Numbers = std::array<T, kCount>;

  template <class T>
  using State = std::array<T, stateSize>;

  // The third link starts in line with the second.
  template <class T>
  static State<T> start(const std::array<T, 4>& s, const T&, const Numbers<T>&) {
    if constexpr (Third)
      return {s[0], s[1], s[2], s[3], s[1], s[3], T(0.0), T(0.0)};
    else
      return {s[0], s[1], s[2], s[3], T(0.0), T(0.0)};
  }

  // The moment that a joint's friction makes at its rate w.
  template <class T>
  static T friction(const Numbers<T>& p, std::size_t joint, const T& w) {
    using std::exp, std::tanh;
    const T& viscous = p[kViscous1 + joint];
    const T& stribeck = p[kStribeck1 + 2 * joint];
    const T ratio = w / p[kStribeckRate1 + 2 * joint];
    const T dry = p[kCoulomb1 + joint] + stribeck * (1.0 + exp(-(ratio * ratio)));
    return -(p[kDamping] + viscous) * w - dry * tanh(w * (1 / kFrictionRate));
  }

  template <class T>
  static State<T> rate(const State<T>& x, const T& u, const Numbers<T>& p) {
    using std::cos, std::sin, std::sqrt;
    constexpr double g = 9.81;
    const T &m1 = p[kMass1], &m2 = p[kMass2], &s1 = p[kCom1], &s2 = p[kCom2], &d = p[kPivots];
    const T cosA = cos(x[0]), sinA = sin(x[0]), cosB = cos(x[1]), sinB = sin(x[1]);
    const T &wA = x[2], &wB = x[3], &V = x[stateSize - 2];
    const T cosAB = cosA * cosB + sinA * sinB, sinBA = sinB * cosA - cosB * sinA;
    // A α̈ + C β̈ = a, C α̈ + B β̈ = b
    T A = m1 * (s1 * s1) + p[kInertia1] + m2 * (d * d);
    T B = m2 * (s2 * s2) + p[kInertia2];
    const T arm = m2 * d * s2;
    T C = arm * cosAB;
    const T coupling = arm * sinBA;
    const T first = m1 * s1 + m2 * d, second = m2 * s2;
    // gravity, tilted
    const T cosT = cos(p[kTilt]), sinT = sin(p[kTilt]);
    const T downA = sinA * cosT + cosA * sinT, downB = sinB * cosT + cosB * sinT;
    T a = coupling * (wB * wB) - first * (g * downA + u * cosA);
    T b = -(coupling * (wA * wA)) - second * (g * downB + u * cosB);
    // joints
    const T joint1 = friction(p, 0, wA);
    const T joint2 = friction(p, 1, T(wB - wA)) - p[kLock2] * (x[1] - x[0] + kLockLoss * (wB - wA));
    a += joint1 - joint2;
    b += joint2;
    // air: velocities of both mass centres, x along the cart's travel, z up
    const T x1 = V + s1 * cosA * wA, z1 = s1 * sinA * wA;
    const T x2 = V + d * cosA * wA + s2 * cosB * wB, z2 = d * sinA * wA + s2 * sinB * wB;
    const T push1 = p[kDrag] * sqrt(x1 * x1 + z1 * z1 + kStillAir * kStillAir);
    const T push2 = p[kDrag] * sqrt(x2 * x2 + z2 * z2 + kStillAir * kStillAir);
    a -= push1 * s1 * (x1 * cosA + z1 * sinA) + push2 * d * (x2 * cosA + z2 * sinA);
    b -= push2 * s2 * (x2 * cosB + z2 * sinB);
    if constexpr (!Third) {
      const T determinant = A * B - C * C;
      return {wA, wB, (B * a - C * b) / determinant, (A * b - C * a) / determinant, u, T(0.0)};
    } else {
      static const double e = endOfLink2();
      // the third link: ℓ γ̈ = c − d cos(α−γ) α̈ − e cos(β−γ) β̈
      const T &m3 = p[kMass3], &l = p[kLength3], &wC = x[5];
      const T cosC = cos(x[4]), sinC = sin(x[4]), downC = sinC * cosT + cosC * sinT;
      const T cosAC = cosA * cosC + sinA * sinC, sinCA = sinC * cosA - cosC * sinA;
      const T cosBC = cosB * cosC + sinB * sinC, sinCB = sinC * cosB - cosC * sinB;
      const T bendA = d * (wA * wA), bendB = e * (wB * wB), bendC = l * (wC * wC);
      const T swivel = kSwivelLoss * l * (wC - wB);
      const T c = -(sinCA * bendA) - sinCB * bendB - g * downC - u * cosC - swivel;
      const T a3 = sinBA * bendB + sinCA * bendC - g * downA - u * cosA;
      const T b3 = sinCB * bendC - sinBA * bendA - g * downB - u * cosB;
      A += m3 * (d * d * (1.0 - cosAC * cosAC));
      B += m3 * (e * e * (1.0 - cosBC * cosBC));
      C += m3 * (d * e * (cosAB - cosAC * cosBC));
      a += m3 * (d * (a3 - cosAC * c));
      b += m3 * (e * (b3 - cosBC * c) + l * swivel);
      const T determinant = A * B - C * C;
      const T alpha = (B * a - C * b) / determinant, beta = (A * b - C * a) / determinant;
      const T gamma = (c - d * cosAC * alpha - e * cosBC * beta) / l;
      return {wA, wB, alpha, beta, wC, gamma, u, T(0.0)};
    }
  }

  template <class T>
  static State<T> step(const State<T>& x, const std::array<T, 3>& u, double h,
                       const Numbers<T>& p) {
    const auto f = [&](const State<T>& y, const T& v) { return rate(y, v, p); };
    return rungeKutta(f, x, u, h);
  }

  template <class T>
  static std::array<T, 2> outputs(const State<T>& x, const T&, const Numbers<T>& p) {
    return {(1.0 + p[kGain1]) * x[0] + p[kBias1], (1.0 + p[kGain2]) * x[1] + p[kBias2]};
  }
};

// Tolerances of parameters: parts are weighed to 3 %, balanced on an edge to 2 %, their inertia is
// that of a plate with screws and bearings (5 %), holes are drilled to 0.5 %; the damping of
// bearings scatters by a third from day to day. Nominal values: cart_double_pendulum.h, equation
// (4.5). Amplitudes: of the size of what they stand beside: the weight's moment is 0.35 N·m, the
// damping's at 5 rad/s 0.0025 N·m; sensors and clocks as data sheets allow, a few degrees, 5 %, 50
// ms. Link 2 weighs 0.1 N·m about its joint: at 3 N·m/rad it sags by 2°, no more than is seen, and
// a wider prior than 1 N·m/rad makes nothing of such a joint but a larger deviation
// (docs/decisions/034-nested-link-models.md). What is left hanging on a rig, a hook or a screw
// clamp, weighs some grams.
std::vector<discover::Quantity> quantitiesOfPendulum() {
  constexpr double mass1 = 0.085, damping = 5e-4;
  const CartDoublePendulum<> rig;
  const auto plate = [](double mass, double length, double width) {
    return mass * (length * length + width * width) / 12;
  };
  const double plate1 = plate(mass1, rig.length1, rig.width1);
  const double plate2 = plate(rig.mass2, rig.length2, rig.width2);
  const double pivots = rig.length1 - 2 * rig.offset;
  return {
      {"mass of link 1", "kg", mass1, 0.02, 0.35, 0.03, true},
      {"mass of link 2", "kg", rig.mass2, 0.02, 0.35, 0.03, true},
      {"mass centre of link 1", "m", rig.com1, 0.04, 0.28, 0.02, true},
      {"mass centre of link 2", "m", rig.com2, 0.03, 0.28, 0.02, true},
      {"inertia of link 1", "kg·m²", plate1, plate1 / 4, plate1 * 4, 0.05, true},
      {"inertia of link 2", "kg·m²", plate2, plate2 / 4, plate2 * 4, 0.05, true},
      {"distance of the pivots", "m", pivots, pivots / 2, pivots * 2, 0.005, true},
      {"damping of both joints", "N·m·s/rad", damping, 2e-5, 1e-2, 0.3, true},
      {"viscosity 1", "N·m·s/rad", 0, 0, 0.05, 2e-3},
      {"viscosity 2", "N·m·s/rad", 0, 0, 0.05, 2e-3},
      {"dry moment 1", "N·m", 0, 0, 0.1, 5e-3},
      {"dry moment 2", "N·m", 0, 0, 0.1, 5e-3},
      {"sticking moment 1", "N·m", 0, 0, 0.1, 5e-3},
      {"sticking rate 1", "rad/s", 0.5, 0.05, 4, 0.5, true},
      {"sticking moment 2", "N·m", 0, 0, 0.1, 5e-3},
      {"sticking rate 2", "rad/s", 0.5, 0.05, 4, 0.5, true},
      {"drag", "N·s²/m²", 0, 0, 0.5, 0.02},
      {"tilt", "rad", 0, -0.5, 0.5, 0.05},
      {"lag", "s", 0, 0, 0.3, 0.03},
      {"bias of sensor 1", "rad", 0, -0.5, 0.5, 0.05},
      {"bias of sensor 2", "rad", 0, -0.5, 0.5, 0.05},
      {"gain of sensor 1", "", 0, -0.5, 0.5, 0.05},
      {"gain of sensor 2", "", 0, -0.5, 0.5, 0.05},
      {"clock offset", "s", 0, 0, 0.3, 0.03},
      {"stiffness of joint 2", "N·m/rad", 0, 0, 30, 1},
      {"mass of link 3", "kg", 0, 0, 0.1, 0.01},
      {"length of link 3", "m", 0.1, 0.03, 0.5, 0.5, true},
  };
}

void addEffectsOfPendulum(Model& model) {
  auto& list = model.candidates;
  for (std::size_t joint = 0; joint < 2; ++joint) {
    const std::string n = std::to_string(joint + 1);
    const std::string where = joint == 0 ? "between cart and link 1" : "between the links";
    list.push_back(effectOf(
        model, "visc_" + n, "viscous friction in joint " + n,
        "The joint " + where +
            " resists its motion in proportion to the rate, in addition to the model's damping.",
        EffectKind::structure, kViscous1 + joint, 2e-4));
    list.push_back(
        effectOf(model, "coulomb_" + n, "dry friction in joint " + n,
                 "The joint " + where +
                     " resists its motion with a moment that does not depend on the rate.",
                 EffectKind::structure, kCoulomb1 + joint, 5e-4));
    discover::Candidate sticking = effectOf(
        model, "stribeck_" + n, "dry friction that sticks in joint " + n,
        "The joint " + where +
            " resists its motion with a dry moment that is up to twice as large at low rates.",
        EffectKind::structure, kStribeck1 + 2 * joint, 5e-4);
    sticking.quantities.push_back(kStribeckRate1 + 2 * joint);
    sticking.sds.push_back(0.5);
    sticking.starts = {startsAt({5e-4, 0.5})};
    list.push_back(std::move(sticking));
  }
  discover::Candidate locked =
      effectOf(model, "locked_2", "joint 2 is locked",
               "The joint between the links is locked, up to a small compliance.",
               EffectKind::structure, kLock2, 0.02);
  // what is locked behaves unlike what springs: fits do not always cross the resonance between
  locked.starts.push_back(startsAt({2}));
  list.push_back(std::move(locked));
  discover::Candidate third = effectOf(model, "link_3", "a third link",
                                       "A further link swings from the lower end of link 2.",
                                       EffectKind::structure, kMass3, 5e-4);
  third.quantities.push_back(kLength3);
  third.sds.push_back(model.quantities[kLength3].sd);
  third.starts = {startsAt({5e-4, 0.05}), startsAt({5e-4, 0.1}), startsAt({5e-4, 0.2})};
  list.push_back(std::move(third));
  list.push_back(effectOf(model, "drag", "air drag",
                          "Air resists both links in proportion to the square of their speed.",
                          EffectKind::structure, kDrag, 2e-3));
  list.push_back(effectOf(model, "tilt", "tilt of the pivots",
                          "The rig is not level: its vertical is off by an angle.",
                          EffectKind::structure, kTilt, 0));
  list.push_back(effectOf(model, "lag", "lag of the cart",
                          "The cart's speed follows its command with a first-order lag.",
                          EffectKind::input, kLag, 2e-3));
  for (std::size_t sensor = 0; sensor < 2; ++sensor) {
    const std::string n = std::to_string(sensor + 1);
    list.push_back(effectOf(model, "bias_" + n, "bias of angle sensor " + n,
                            "The sensor of link " + n + " is off by a constant angle.",
                            EffectKind::sensor, kBias1 + sensor, 0));
    list.push_back(effectOf(model, "gain_" + n, "gain of angle sensor " + n,
                            "The sensor of link " + n + " reads a multiple of the angle.",
                            EffectKind::sensor, kGain1 + sensor, 0));
  }
  list.push_back(effectOf(model, "clock", "clock offset of the sensors",
                          "The sensors' readings are delayed.", EffectKind::sensor, kClock, 2e-3));
  const char* ids[] = {"m_1", "m_2", "com_1", "com_2", "I_1", "I_2", "pivots", "damping"};
  for (std::size_t q = kMass1; q <= kDamping; ++q) list.push_back(errorOf(model, ids[q], q));
}

// The third link costs two states, so only those who ask for it pay. Model::states has it in any
// case, 0 where it is not simulated.
Response simulatePendulum(const Request& request) {
  const bool third = request.shared[kMass3] != 0 ||
                     std::any_of(request.wanted.begin(), request.wanted.end(),
                                 [](std::size_t q) { return q == kMass3 || q == kLength3; });
  if (third) return walk<Pendulum<true>>(request);
  Response response = walk<Pendulum<false>>(request);
  Eigen::MatrixXd states = Eigen::MatrixXd::Zero(response.states.rows(), 8);
  states.leftCols(4) = response.states.leftCols(4);
  states.rightCols(2) = response.states.rightCols(2);
  response.states = std::move(states);
  return response;
}

}  // namespace

Model doublePendulum() {
  Model model;
  model.name = "double-pendulum";
  model.channels = {{"link1", "rad"}, {"link2", "rad"}};
  model.quantities = quantitiesOfPendulum();
  for (std::size_t q = kMass1; q <= kDamping; ++q) model.nuisances.push_back(q);
  model.starts = {{"start angle of link 1", "rad", 0, 0.05, 2},
                  {"start angle of link 2", "rad", 1, 0.05, 2},
                  {"start rate of link 1", "rad/s", -1, 0.3, 20},
                  {"start rate of link 2", "rad/s", -1, 0.3, 20}};
  model.states = {
      "link1 [rad]", "link2 [rad]",           "rate of link1 [rad/s]", "rate of link2 [rad/s]",
      "link3 [rad]", "rate of link3 [rad/s]", "cart speed [m/s]",      "cart acceleration [m/s²]"};
  addEffectsOfPendulum(model);
  model.simulate = simulatePendulum;
  return model;
}

}  // namespace info::robot
