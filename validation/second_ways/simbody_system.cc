#include "second_ways/simbody_system.h"

#include <Simbody.h>

namespace bio::simbody {
namespace {

/// Our curves as a function Simbody can differentiate.
class CurveFunction : public SimTK::Function {
 public:
  explicit CurveFunction(Curve curve) : curve_(std::move(curve)) {}
  SimTK::Real calcValue(const SimTK::Vector& x) const override { return curve_(x[0])[0]; }
  SimTK::Real calcDerivative(const SimTK::Array_<int>& order,
                             const SimTK::Vector& x) const override {
    return order.size() <= 2 ? curve_(x[0])[order.size()] : 0;
  }
  int getArgumentSize() const override { return 1; }
  int getMaxDerivativeOrder() const override { return 2; }
  CurveFunction* clone() const override { return new CurveFunction(*this); }

 private:
  Curve curve_;
};

SimTK::Vec3 toSimbody(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

SimTK::Transform toSimbody(const Frame& frame) {
  SimTK::Rotation R;
  R.setRotationToBodyFixedXYZ(toSimbody(frame.orientation));
  return {R, toSimbody(frame.translation)};
}

/// About the body origin, as Simbody wants it; bodies of files are often not quite physical, so
/// Simbody's own check of that is not asked for.
SimTK::MassProperties massProperties(const RigidBody& body) {
  const auto& I = body.inertia;
  const SimTK::Vec3 c = toSimbody(body.massCenter);
  const double m = body.mass;
  const double cc = c.normSqr();
  if (m == 0) return {0, SimTK::Vec3(0), SimTK::UnitInertia(0, 0, 0)};
  const SimTK::SymMat33 about(I[0] + m * (cc - c[0] * c[0]),                          //
                              I[3] - m * c[0] * c[1], I[1] + m * (cc - c[1] * c[1]),  //
                              I[4] - m * c[0] * c[2], I[5] - m * c[1] * c[2],
                              I[2] + m * (cc - c[2] * c[2]));
  SimTK::UnitInertia unit;

  const_cast<SimTK::SymMat33&>(unit.asSymMat33()) = about / m;
  return {m, c, unit};
}

}  // namespace

struct System::Parts {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  SimTK::GeneralForceSubsystem forces{system};
  std::map<std::string, SimTK::MobilizedBodyIndex> bodies;
  std::map<std::string, std::pair<SimTK::MobilizedBodyIndex, int>> coordinates;
  SimTK::State initial;

  SimTK::State stateAt(const std::map<std::string, double>& values) const {
    SimTK::State state = initial;
    for (const auto& [name, where] : coordinates) {
      matter.getMobilizedBody(where.first).setOneQ(state, where.second, values.at(name));
    }
    system.realize(state, SimTK::Stage::Dynamics);
    return state;
  }
};

System::System(const Eigen::Vector3d& gravity) : parts_(std::make_unique<Parts>()) {
  parts_->bodies["ground"] = parts_->matter.getGround().getMobilizedBodyIndex();
  SimTK::Force::Gravity(parts_->forces, parts_->matter, toSimbody(gravity));
}

System::~System() = default;

bool System::hasBody(const std::string& name) const {
  return parts_->bodies.count(name) > 0;
}

void System::add(const Link& link) {
  SimTK::MobilizedBody& parent = parts_->matter.updMobilizedBody(parts_->bodies.at(link.parent));
  const SimTK::Transform X_PF = toSimbody(link.parentFrame);
  const SimTK::Transform X_BM = toSimbody(link.bodyFrame);
  const SimTK::Body::Rigid body(massProperties(link.body));
  SimTK::MobilizedBodyIndex index;
  switch (link.mobility) {
    case Mobility::weld:
      index = SimTK::MobilizedBody::Weld(parent, X_PF, body, X_BM).getMobilizedBodyIndex();
      break;
    case Mobility::pin:
      index = SimTK::MobilizedBody::Pin(parent, X_PF, body, X_BM).getMobilizedBodyIndex();
      break;
    case Mobility::slider:
      index = SimTK::MobilizedBody::Slider(parent, X_PF, body, X_BM).getMobilizedBodyIndex();
      break;
    case Mobility::functions: {
      SimTK::Array_<const SimTK::Function*> functions;
      SimTK::Array_<SimTK::Array_<int>> indices;
      SimTK::Array_<SimTK::Vec3> axes;
      for (const Axis& axis : link.axes) {
        SimTK::Array_<int> used;
        if (axis.coordinate >= 0) {
          used.push_back(axis.coordinate);
          functions.push_back(new CurveFunction(axis.amount));
        } else {
          functions.push_back(new SimTK::Function::Constant(axis.amount(0)[0], 0));
        }
        indices.push_back(used);
        axes.push_back(toSimbody(axis.direction));
      }
      index = SimTK::MobilizedBody::FunctionBased(parent, X_PF, body, X_BM,
                                                  static_cast<int>(link.coordinates.size()),
                                                  functions, indices, axes)
                  .getMobilizedBodyIndex();
      break;
    }
  }
  parts_->bodies[link.body.name] = index;
  for (std::size_t i = 0; i < link.coordinates.size(); ++i) {
    parts_->coordinates[link.coordinates[i]] = {index, static_cast<int>(i)};
  }
}

void System::finish() {
  parts_->initial = parts_->system.realizeTopology();
  parts_->system.realizeModel(parts_->initial);
}

std::vector<std::string> System::mobilityNames() const {
  std::vector<std::string> names(static_cast<std::size_t>(parts_->matter.getNumMobilities()));
  for (const auto& [name, where] : parts_->coordinates) {
    const auto& body = parts_->matter.getMobilizedBody(where.first);
    names[static_cast<std::size_t>(body.getFirstUIndex(parts_->initial) + where.second)] = name;
  }
  return names;
}

std::pair<Eigen::MatrixXd, Eigen::VectorXd> System::dynamics(
    const std::map<std::string, double>& values) const {
  const SimTK::State state = parts_->stateAt(values);
  SimTK::Matrix M;
  parts_->matter.calcM(state, M);
  SimTK::Vector generalised;
  parts_->matter.multiplyBySystemJacobianTranspose(
      state, parts_->system.getRigidBodyForces(state, SimTK::Stage::Dynamics), generalised);
  Eigen::MatrixXd mass(M.nrow(), M.ncol());
  Eigen::VectorXd gravity(generalised.size());
  for (int i = 0; i < M.nrow(); ++i) {
    gravity[i] = generalised[i];
    for (int j = 0; j < M.ncol(); ++j) mass(i, j) = M(i, j);
  }
  return {mass, gravity};
}

Eigen::Vector3d System::pointInGround(const std::map<std::string, double>& values,
                                      const std::string& body, const Eigen::Vector3d& point) const {
  const SimTK::State state = parts_->stateAt(values);
  const SimTK::Vec3 p = parts_->matter.getMobilizedBody(parts_->bodies.at(body))
                            .findStationLocationInGround(state, toSimbody(point));
  return {p[0], p[1], p[2]};
}

}  // namespace bio::simbody
