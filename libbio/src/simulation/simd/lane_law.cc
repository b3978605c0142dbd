#include "simulation/simd/lane_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bio/muscle/simulated_muscle.h"

namespace bio::lanes {
namespace {

using muscles::DeGrooteFregly2016;
using muscles::HillMuscle;
using muscles::Millard2012;
using muscles::RigidTendon;
using muscles::Thelen2003;

constexpr double lawInfinity = std::numeric_limits<double>::infinity();

// A piece that holds no x.
template <class Piece>
void holdNothing(Piece& piece, int lane) {
  piece.lower[lane] = piece.upper[lane] = std::numeric_limits<double>::quiet_NaN();
}

template <class Of>
void gatherCubic(const PiecewiseCubic& curve, int lane, CubicPiece<Of>& piece) {
  holdNothing(piece, lane);
  piece.of[lane] = &curve;
}

template <class Of, std::size_t n>
void gatherBezier(const muscles::BezierCurve<double, n>& curve, int lane,
                  BezierPiece<Of, n>& piece) {
  holdNothing(piece, lane);
  piece.of[lane] = &curve;
}

template <class Real, std::size_t n>
void putPlane(const muscles::BezierCurve<double, n>& curve, std::size_t section, int lane,
              Real (&x)[6], Real (&y)[6]) {
  const muscles::PlaneQuintic& plane = curve.plane(section);
  for (std::size_t k = 0; k < 6; ++k) {
    x[k][lane] = plane[k][0];
    y[k][lane] = plane[k][1];
  }
}

template <class Of>
void putCell(const muscles::MillardSpeed<double>::Cell& place, int lane, SpeedPiece<Of>& piece) {
  const muscles::SpeedCell<double> cell = piece.of[lane]->at(place);
  piece.lowX[lane] = cell.lowX;
  piece.lowY[lane] = cell.lowY;
  piece.highX[lane] = cell.highX;
  piece.highY[lane] = cell.highY;
  piece.lowSpeedX[lane] = cell.lowSpeedX;
  piece.lowSpeedY[lane] = cell.lowSpeedY;
  piece.highSpeedX[lane] = cell.highSpeedX;
  piece.highSpeedY[lane] = cell.highSpeedY;
  piece.lowest[lane] = cell.lowest;
  piece.cellWidth[lane] = cell.width;
  putPlane(*piece.curve[lane], place.section, lane, piece.x, piece.y);
}

template <class Of>
void gatherSchutte(const SchutteMuscle<double>& m, int lane, LawNumbers<Of>& law) {
  law.law = LaneClass::schutte;
  law.ignoresTendonCompliance = false;
  law.clampsForce = m.options().clampForce;
  law.hasPassiveCurve = m.curves().passiveForce.has_value();
  const double numbers[] = {m.quantities().maxIsometricForce,
                            m.perFibre(),
                            m.perTendon(),
                            m.speedScale(),
                            m.thickness(),
                            m.quantities().damping,
                            m.options().activationFloor};
  for (std::size_t i = 0; i < std::size(numbers); ++i) law.numbers[i][lane] = numbers[i];
  gatherCubic(m.curves().tendonForce, lane, law.cubics[0]);
  gatherCubic(m.curves().activeForce, lane, law.cubics[1]);
  if (law.hasPassiveCurve) gatherCubic(*m.curves().passiveForce, lane, law.cubics[2]);
}

template <class Of>
void gatherOwn(const Thelen2003<double>&, int, LawNumbers<Of>& law) {
  law.law = LaneClass::thelen;
}
template <class Of>
void gatherOwn(const DeGrooteFregly2016<double>& shape, int, LawNumbers<Of>& law) {
  law.law = LaneClass::deGroote;
  law.ignoresPassiveForce = shape.parameters().ignorePassiveFibreForce;
}
template <class Of>
void gatherOwn(const RigidTendon<double>& shape, int lane, LawNumbers<Of>& law) {
  law.law = LaneClass::rigidTendon;
  gatherCubic(shape.activeSpline(), lane, law.cubics[0]);
  gatherCubic(shape.passiveSpline(), lane, law.cubics[1]);
  gatherCubic(shape.velocitySpline(), lane, law.cubics[2]);
}
template <class Of>
void gatherOwn(const Millard2012<double>& shape, int lane, LawNumbers<Of>& law) {
  law.law = LaneClass::millard;
  law.damping[lane] = shape.damping();
  gatherBezier(shape.tendonCurve(), lane, law.tendon);
  gatherBezier(shape.activeCurve(), lane, law.active);
  gatherBezier(shape.passiveCurve(), lane, law.passive);
  gatherBezier(shape.forceVelocityCurve(), lane, law.forceVelocity);
  const auto putLine = [lane](LineNumbers<Of>& to, const auto& end) {
    to.x[lane] = end.x;
    to.y[lane] = end.y;
    to.slope[lane] = end.slope;
  };
  putLine(law.firstSpeed, shape.forceVelocityCurve().first());
  putLine(law.lastSpeed, shape.forceVelocityCurve().last());
  SpeedPiece<Of>& speed = law.speed;
  speed.curve[lane] = &shape.forceVelocityCurve();
  speed.of[lane] = &shape.speedSolver();
  using Speed = muscles::MillardSpeed<double>;
  putCell(Speed::lastCell(), lane, speed);
  speed.endX[lane] = speed.highX[lane];
  speed.endY[lane] = speed.highY[lane];
  putCell(Speed::firstCell(), lane, speed);
  speed.beginX[lane] = speed.lowX[lane];
  speed.beginY[lane] = speed.lowY[lane];
}

template <class Of, class Shape>
void gatherHill(const HillMuscle<Shape>& muscle, int lane, LawNumbers<Of>& law) {
  using Parameters = typename Shape::Parameters;
  static_assert(Parameters::count <= mostLawNumbers);
  const Parameters& p = muscle.parameters();
  law.ignoresTendonCompliance = p.ignoreTendonCompliance;
  for (std::size_t i = 0; i < Parameters::count; ++i) {
    law.numbers[i][lane] = Parameters::at(p, i);
  }
  gatherOwn(muscle.shape(), lane, law);
}

}  // namespace

bool sameForm(const SimulatedMuscle& a, const SimulatedMuscle& b) {
  if (a.hasFibreState() != b.hasFibreState()) return false;
  if (a.ifSchutte() || b.ifSchutte()) {
    return a.ifSchutte() && b.ifSchutte() &&
           a.schutte().options().clampForce == b.schutte().options().clampForce &&
           a.schutte().curves().passiveForce.has_value() ==
               b.schutte().curves().passiveForce.has_value();
  }
  if (a.ifOther()->index() != b.ifOther()->index()) return false;
  using DeGroote = HillMuscle<DeGrooteFregly2016<double>>;
  const auto* x = std::get_if<DeGroote>(a.ifOther());
  const auto* y = std::get_if<DeGroote>(b.ifOther());
  return !x || x->parameters().ignorePassiveFibreForce == y->parameters().ignorePassiveFibreForce;
}

template <class Of>
void gather(const SimulatedMuscle* const (&of)[Of::width], LawNumbers<Of>& law) {
  for (int lane = 0; lane < Of::width; ++lane) {
    if (of[lane]->ifSchutte()) {
      gatherSchutte(of[lane]->schutte(), lane, law);
    } else {
      std::visit([&](const auto& muscle) { gatherHill(muscle, lane, law); }, *of[lane]->ifOther());
    }
  }
}

template <class Of>
void movePieces(CubicPiece<Of>& curve, const typename Of::Number& x) {
  for (int l = 0; l < Of::width; ++l) {
    if (x[l] >= curve.lower[l] && x[l] < curve.upper[l]) continue;
    const PiecewiseCubic::Piece piece = curve.of[l]->pieceAt(x[l]);
    curve.lower[l] = piece.lower;
    curve.upper[l] = piece.upper;
    curve.start[l] = piece.segment->start;
    curve.value[l] = piece.segment->value;
    curve.slope[l] = piece.segment->slope;
    curve.quadratic[l] = piece.segment->quadratic;
    curve.cubic[l] = piece.segment->cubic;
  }
}

template <class Of, std::size_t n>
void movePieces(BezierPiece<Of, n>& piece, const typename Of::Number& x) {
  for (int l = 0; l < Of::width; ++l) {
    if (x[l] >= piece.lower[l] && x[l] < piece.upper[l]) continue;
    const muscles::BezierCurve<double, n>& curve = *piece.of[l];
    // straight lines hold their ends
    const double begin = std::nextafter(curve.first().x, lawInfinity);
    if (curve.isInside(x[l])) {
      const auto cell = curve.cellAt(x[l]);
      piece.lower[l] = std::max(cell.lower, begin);
      piece.upper[l] = cell.upper;
      piece.start[l] = cell.start;
      piece.per[l] = cell.per;
      for (std::size_t k = 0; k < 6; ++k) piece.place[k][l] = (*cell.place)[k];
      putPlane(curve, cell.section, l, piece.x, piece.y);
      continue;
    }
    const bool before = curve.isBefore(x[l]);
    const auto& end = before ? curve.first() : curve.last();
    piece.lower[l] = before ? -lawInfinity : end.x;
    piece.upper[l] = before ? begin : lawInfinity;
    piece.start[l] = end.x;
    piece.per[l] = 1;
    for (int k = 0; k < 6; ++k) piece.place[k][l] = piece.x[k][l] = piece.y[k][l] = 0;
    piece.place[1][l] = piece.x[1][l] = 1;
    piece.x[0][l] = end.x;
    piece.y[0][l] = end.y;
    piece.y[1][l] = end.slope;
  }
}

template <class Of>
void movePieces(SpeedPiece<Of>& piece, const typename Of::Mask& wanted,
                const typename Of::Number& P, const typename Of::Number& A,
                const typename Of::Number& B) {
  for (int l = 0; l < Of::width; ++l) {
    if (wanted[l] != 0) putCell(piece.of[l]->cellAt(P[l], A[l], B[l]), l, piece);
  }
}

template <class Of, std::size_t n>
void refinePlaces(const BezierPiece<Of, n>& piece, const typename Of::Number& x,
                  typename Of::Number& u) {
  for (int l = 0; l < Of::width; ++l) {
    const muscles::BezierCurve<double, n>& curve = *piece.of[l];
    if (curve.isInside(x[l])) u[l] = curve.placeIn(curve.sectionAt(x[l]), x[l]);
  }
}

template void gather(const SimulatedMuscle* const (&)[4], LawNumbers<Lanes<4>>&);
template void movePieces(CubicPiece<Lanes<4>>&, const Lanes<4>::Number&);
template void movePieces(SpeedPiece<Lanes<4>>&, const Lanes<4>::Mask&, const Lanes<4>::Number&,
                         const Lanes<4>::Number&, const Lanes<4>::Number&);
template void movePieces(BezierPiece<Lanes<4>, 2>&, const Lanes<4>::Number&);
template void refinePlaces(const BezierPiece<Lanes<4>, 2>&, const Lanes<4>::Number&,
                           Lanes<4>::Number&);
template void movePieces(BezierPiece<Lanes<4>, 4>&, const Lanes<4>::Number&);
template void refinePlaces(const BezierPiece<Lanes<4>, 4>&, const Lanes<4>::Number&,
                           Lanes<4>::Number&);
template void movePieces(BezierPiece<Lanes<4>, 5>&, const Lanes<4>::Number&);
template void refinePlaces(const BezierPiece<Lanes<4>, 5>&, const Lanes<4>::Number&,
                           Lanes<4>::Number&);
template void gather(const SimulatedMuscle* const (&)[8], LawNumbers<Lanes<8>>&);
template void movePieces(CubicPiece<Lanes<8>>&, const Lanes<8>::Number&);
template void movePieces(SpeedPiece<Lanes<8>>&, const Lanes<8>::Mask&, const Lanes<8>::Number&,
                         const Lanes<8>::Number&, const Lanes<8>::Number&);
template void movePieces(BezierPiece<Lanes<8>, 2>&, const Lanes<8>::Number&);
template void refinePlaces(const BezierPiece<Lanes<8>, 2>&, const Lanes<8>::Number&,
                           Lanes<8>::Number&);
template void movePieces(BezierPiece<Lanes<8>, 4>&, const Lanes<8>::Number&);
template void refinePlaces(const BezierPiece<Lanes<8>, 4>&, const Lanes<8>::Number&,
                           Lanes<8>::Number&);
template void movePieces(BezierPiece<Lanes<8>, 5>&, const Lanes<8>::Number&);
template void refinePlaces(const BezierPiece<Lanes<8>, 5>&, const Lanes<8>::Number&,
                           Lanes<8>::Number&);

}  // namespace bio::lanes
