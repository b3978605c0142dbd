#include "bio/path/surface/chain_change.h"

#include <algorithm>

#include "chain_newton.h"

namespace bio {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d motionOf(const Screw& screw, const Vector3d& x) {
  return screw.linear + screw.angular.cross(x);
}

std::size_t objectOf(const ChainPath& path, std::size_t contact) {
  return static_cast<std::size_t>(path.contacts[contact].object);
}

}  // namespace

ChainScrews chainGradient(const ChainPath& path) {
  ChainScrews gradient;
  gradient.P = -path.tangentP();
  gradient.Q = path.tangentQ();
  for (std::size_t j = 0; j < static_cast<std::size_t>(path.numContacts); ++j) {
    const ChainContact& c = path.contacts[j];
    const Vector3d& in = path.pieces[j].t;
    const Vector3d& out = path.pieces[j + 1].t;
    Screw& screw = gradient.objects[objectOf(path, j)];
    screw.linear = in - out;
    screw.angular = c.A.cross(in) - c.B.cross(out);
  }
  return gradient;
}

double powerOf(const ChainScrews& gradient, const ChainScrews& motion, std::size_t count) {
  double sum = gradient.P.dot(motion.P) + gradient.Q.dot(motion.Q);
  for (std::size_t j = 0; j < count; ++j) {
    const Screw &g = gradient.objects[j], &m = motion.objects[j];
    sum += g.linear.dot(m.linear) + g.angular.dot(m.angular);
  }
  return sum;
}

ChainChanges::ChainChanges(const ChainPath& path) : path_(path) {
  // rows: the sides at the first and at the last contact; columns: β, θ
  detail::LinearSystem matrix;
  matrix.n = 2 * path.numContacts;
  const auto n = static_cast<std::size_t>(matrix.n);
  for (std::size_t i = 0; i < n; ++i) std::fill_n(matrix.A[i], n, 0.0);
  for (std::size_t j = 0; 2 * j < n; ++j) {
    const ChainContact& c = path.contacts[j];
    const double perIn = 1 / path.pieces[j].length, perOut = 1 / path.pieces[j + 1].length;
    double* first = matrix.A[2 * j];
    double* last = matrix.A[2 * j + 1];
    first[2 * j] = perIn;
    first[2 * j + 1] = -1;
    last[2 * j] = -c.aSlope - perOut * c.a;
    last[2 * j + 1] = -c.rSlope - perOut * c.r;
    if (j > 0) {
      const ChainContact& before = path.contacts[j - 1];
      const double couple = -perIn * c.atA.b.dot(before.atB.b);
      first[2 * j - 2] = couple * before.a;
      first[2 * j - 1] = couple * before.r;
    }
    if (2 * j + 2 < n) last[2 * j + 2] = perOut * c.atB.b.dot(path.contacts[j + 1].atA.b);
  }
  if (n == 2) {
    const auto& A = matrix.A;
    const double per = 1 / (A[0][0] * A[1][1] - A[0][1] * A[1][0]);
    inverse_[0][0] = per * A[1][1];
    inverse_[0][1] = -per * A[0][1];
    inverse_[1][0] = -per * A[1][0];
    inverse_[1][1] = per * A[0][0];
    return;
  }
  for (std::size_t k = 0; k < n; ++k) {
    detail::LinearSystem column = matrix;
    std::fill_n(column.b, n, 0.0);
    column.b[k] = 1;
    detail::solveInPlace(column);
    for (std::size_t i = 0; i < n; ++i) inverse_[i][k] = column.b[i];
  }
}

// How the ends of a piece move with what they belong to.
Vector3d ChainChanges::startMotion(std::size_t piece, const ChainScrews& motion) const {
  if (piece == 0) return motion.P;
  return motionOf(motion.objects[objectOf(path_, piece - 1)], path_.pieces[piece].from);
}
Vector3d ChainChanges::endMotion(std::size_t piece, const ChainScrews& motion) const {
  if (piece == static_cast<std::size_t>(path_.numContacts)) return motion.Q;
  return motionOf(motion.objects[objectOf(path_, piece)], path_.pieces[piece].to);
}

double ChainChanges::asideAtB(std::size_t contact, const ContactShift& shift) const {
  const ChainContact& c = path_.contacts[contact];
  return c.a * shift.aside + c.r * shift.turn;
}

std::array<ContactShift, maxChain> ChainChanges::shifts(const ChainScrews& motion) const {
  std::array<ContactShift, maxChain> result;
  const auto m = static_cast<std::size_t>(path_.numContacts);
  double push[maxShifts];
  for (std::size_t j = 0; j < m; ++j) {
    const ChainContact& c = path_.contacts[j];
    const ChainPiece& in = path_.pieces[j];
    const ChainPiece& out = path_.pieces[j + 1];
    const Vector3d& turning = motion.objects[objectOf(path_, j)].angular;
    const Vector3d across = (endMotion(j, motion) - startMotion(j, motion)) / in.length;
    const Vector3d acrossOut = (endMotion(j + 1, motion) - startMotion(j + 1, motion)) / out.length;
    push[2 * j] = -(turning.cross(c.atA.b).dot(in.t) + c.atA.b.dot(across));
    push[2 * j + 1] = -(turning.cross(c.atB.b).dot(out.t) + c.atB.b.dot(acrossOut));
  }
  for (std::size_t j = 0; j < m; ++j) {
    for (std::size_t k = 0; k < 2 * m; ++k) {
      result[j].aside += inverse_[2 * j][k] * push[k];
      result[j].turn += inverse_[2 * j + 1][k] * push[k];
    }
  }
  // the normals' equations give the shifts along
  for (std::size_t j = 0; j < m; ++j) {
    const ChainContact& c = path_.contacts[j];
    const ChainPiece& in = path_.pieces[j];
    const ChainPiece& out = path_.pieces[j + 1];
    const Vector3d& turning = motion.objects[objectOf(path_, j)].angular;
    Vector3d span = endMotion(j, motion) - startMotion(j, motion);
    if (j > 0) span -= asideAtB(j - 1, result[j - 1]) * path_.contacts[j - 1].atB.b;
    result[j].alongA = (-c.atA.twist * result[j].aside + turning.cross(c.atA.n).dot(in.t) +
                        c.atA.n.dot(span) / in.length) /
                       c.atA.normal;
    span = endMotion(j + 1, motion) - startMotion(j + 1, motion);
    if (j + 1 < m) span += result[j + 1].aside * path_.contacts[j + 1].atA.b;
    result[j].alongB = (-c.atB.twist * asideAtB(j, result[j]) + turning.cross(c.atB.n).dot(out.t) +
                        c.atB.n.dot(span) / out.length) /
                       c.atB.normal;
  }
  return result;
}

ChainChanges::PieceChange ChainChanges::pieceChange(std::size_t piece, const ChainScrews& motion,
                                                    std::span<const ContactShift> shifts) const {
  const ChainPiece& straight = path_.pieces[piece];
  Vector3d from = startMotion(piece, motion), to = endMotion(piece, motion);
  if (piece > 0) {
    from += asideAtB(piece - 1, shifts[piece - 1]) * path_.contacts[piece - 1].atB.b;
  }
  if (piece < static_cast<std::size_t>(path_.numContacts)) {
    to += shifts[piece].aside * path_.contacts[piece].atA.b;
  }
  const Vector3d span = (to - from) / straight.length;
  PieceChange change;
  change.t = span - straight.t * straight.t.dot(span);
  change.moment = from.cross(straight.t) + straight.from.cross(change.t);
  return change;
}

ChainScrews ChainChanges::gradientChange(const ChainScrews& motion) const {
  const std::array<ContactShift, maxChain> shifted = shifts(motion);
  const auto m = static_cast<std::size_t>(path_.numContacts);
  ChainScrews result;
  PieceChange before = pieceChange(0, motion, shifted);
  result.P = -before.t;
  for (std::size_t j = 0; j < m; ++j) {
    const PieceChange after = pieceChange(j + 1, motion, shifted);
    Screw& screw = result.objects[objectOf(path_, j)];
    screw.linear = before.t - after.t;
    screw.angular = before.moment - after.moment;
    before = after;
  }
  result.Q = before.t;
  return result;
}

EndHessian ChainChanges::ends() const {
  EndHessian hessian;
  const auto m = static_cast<std::size_t>(path_.numContacts);
  const ChainPiece& first = path_.pieces[0];
  if (m == 0) {
    const Matrix3d across = (Matrix3d::Identity() - first.t * first.t.transpose()) / first.length;
    return {across, -across, across};
  }
  const ChainPiece& last = path_.pieces[m];
  const SurfaceFrame& A = path_.contacts[0].atA;
  const SurfaceFrame& B = path_.contacts[m - 1].atB;
  const double perFirst = 1 / first.length, perLast = 1 / last.length;
  // P moved along the side pushes the first row, Q the last
  const auto asideB = [&](std::size_t column, double push) {
    const ChainContact& c = path_.contacts[m - 1];
    return push * (c.a * inverse_[2 * m - 2][column] + c.r * inverse_[2 * m - 1][column]);
  };
  const double asideA = inverse_[0][0] * perFirst;
  hessian.PP = perFirst * (A.n * A.n.transpose() + (1 - asideA) * A.b * A.b.transpose());
  hessian.QQ =
      perLast * (B.n * B.n.transpose() + (1 - asideB(2 * m - 1, -perLast)) * B.b * B.b.transpose());
  hessian.PQ = -perLast * asideB(0, perFirst) * A.b * B.b.transpose();
  return hessian;
}

std::array<NumberIntegral, maxSurfaceNumbers> contactNumbers(const ChainObject& object,
                                                             const ChainContact& contact) {
  const Vector3d x = object.intoFrame(contact.A);
  return numberIntegrals(object.surface, x, object.R_GS.transpose() * contact.atA.u, contact.arc);
}

double numberChange(const NumberIntegral& number, const ContactShift& shift) {
  return -shift.alongA * number.first + shift.alongB * number.last + shift.aside * number.sideways +
         shift.turn * number.turned;
}

}  // namespace bio
