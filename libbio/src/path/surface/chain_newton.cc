#include "chain_newton.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bio::detail {
namespace {

using Eigen::Vector3d;

constexpr int maxIterations = 60;
constexpr double goal = 1e-12;
// a step so small, in curvatures and turns, leaves an error of its square
constexpr double smallStep = 3e-9;

// The frame at a point of an object, turned into G.
SurfaceFrame frameInG(const ChainObject& object, const Vector3d& x, const Vector3d& u) {
  SurfaceFrame frame =
      std::visit([&](const auto& surface) { return surfaceFrame(surface, x, u); }, object.surface);
  frame.n = object.R_GS * frame.n;
  frame.u = object.R_GS * frame.u;
  frame.b = object.R_GS * frame.b;
  return frame;
}

// A guess, put onto its surface, and the geodesic from there.
ChainContact shootFrom(std::span<const ChainObject> objects, ContactGuess& guess,
                       double tolerance) {
  const ChainObject& object = objects[static_cast<std::size_t>(guess.object)];
  guess.x = std::visit([&](const auto& surface) { return ontoSurface(surface, guess.x); },
                       object.surface);
  ChainContact contact;
  contact.object = guess.object;
  contact.atA = frameInG(object, guess.x, guess.u);
  guess.u = object.R_GS.transpose() * contact.atA.u;
  contact.A = object.outOfFrame(guess.x);
  contact.arc = guess.arc;
  const GeodesicPoint end = shootGeodesic(object.surface, guess.x, guess.u, guess.arc, tolerance);
  contact.atB = frameInG(object, end.x, end.u);
  contact.B = object.outOfFrame(end.x);
  contact.a = end.a;
  contact.aSlope = end.aSlope;
  contact.r = end.r;
  contact.rSlope = end.rSlope;
  return contact;
}

ChainPiece pieceBetween(const Vector3d& from, const Vector3d& to) {
  const Vector3d d = to - from;
  const double length = d.norm();
  return {from, to, Vector3d(d / length), length};
}

// The path that the guesses make.
void draw(const Vector3d& P, const Vector3d& Q, std::span<const ChainObject> objects,
          ContactGuesses& guesses, double tolerance, ChainPath& path) {
  const auto m = static_cast<std::size_t>(guesses.count);
  path.numContacts = guesses.count;
  for (std::size_t j = 0; j < m; ++j) {
    path.contacts[j] = shootFrom(objects, guesses.each[j], tolerance);
    path.pieces[j] = pieceBetween(j == 0 ? P : path.contacts[j - 1].B, path.contacts[j].A);
  }
  path.pieces[m] = pieceBetween(m == 0 ? P : path.contacts[m - 1].B, Q);
}

// How the cosines of a normal or side with a piece change as the frame moves along its direction,
// aside, and turns; `end` is +1 where the piece ends there and −1 where it starts.
struct FrameChanges {
  double along, aside, turn;
};
FrameChanges ofNormal(const SurfaceFrame& f, const ChainPiece& piece, double end) {
  const Vector3d& t = piece.t;
  const double ut = f.u.dot(t), bt = f.b.dot(t), nt = f.n.dot(t);
  const double per = end / piece.length;
  return {-f.normal * ut - f.twist * bt - per * nt * ut,
          -f.twist * ut - f.sideways * bt - per * nt * bt, 0};
}
FrameChanges ofSide(const SurfaceFrame& f, const ChainPiece& piece, double end) {
  const Vector3d& t = piece.t;
  const double ut = f.u.dot(t), bt = f.b.dot(t), nt = f.n.dot(t);
  const double per = end / piece.length;
  return {f.twist * nt - per * bt * ut, f.sideways * nt + per * (1 - bt * bt), -ut};
}
// How the cosine of w with a piece changes as the piece's other end moves by v.
double ofOtherEnd(const Vector3d& w, const ChainPiece& piece, const Vector3d& v, double end) {
  return -end / piece.length * (w.dot(v) - w.dot(piece.t) * piece.t.dot(v));
}

double largest(const LinearSystem& system) {
  double most = 0;
  for (int i = 0; i < system.n; ++i) {
    if (!(std::abs(system.b[i]) <= most)) most = std::abs(system.b[i]);
  }
  return most;
}

// Right-hand sides: the cosines that should be 0, with the sign that Newton's step needs.
double assembleCosines(const ChainPath& path, LinearSystem& system) {
  system.n = 4 * path.numContacts;
  for (std::size_t j = 0; j < static_cast<std::size_t>(path.numContacts); ++j) {
    const ChainContact& c = path.contacts[j];
    double* b = system.b + 4 * j;
    b[0] = -c.atA.n.dot(path.pieces[j].t);
    b[1] = -c.atA.b.dot(path.pieces[j].t);
    b[2] = -c.atB.n.dot(path.pieces[j + 1].t);
    b[3] = -c.atB.b.dot(path.pieces[j + 1].t);
  }
  return largest(system);
}

// Rows 4j … 4j + 3 of the matrix, columns α, β, θ, σ of each contact.
void assembleMatrix(const ChainPath& path, LinearSystem& system) {
  for (int i = 0; i < system.n; ++i) std::fill_n(system.A[i], system.n, 0.0);
  const auto m = static_cast<std::size_t>(path.numContacts);
  // what moves the last contact: e along, y aside, φ turned, as sums over the unknowns
  const auto addEnd = [&](double* row, std::size_t j, double e, double y, double phi) {
    const ChainContact& c = path.contacts[j];
    row[4 * j] += e;
    row[4 * j + 1] += y * c.a + phi * c.aSlope;
    row[4 * j + 2] += y * c.r + phi * c.rSlope;
    row[4 * j + 3] += e;
  };
  for (std::size_t j = 0; j < m; ++j) {
    const ChainContact& c = path.contacts[j];
    const ChainPiece& in = path.pieces[j];
    const ChainPiece& out = path.pieces[j + 1];
    for (int k = 0; k < 2; ++k) {
      const FrameChanges first = k == 0 ? ofNormal(c.atA, in, 1) : ofSide(c.atA, in, 1);
      const Vector3d& wA = k == 0 ? c.atA.n : c.atA.b;
      double* row = system.A[4 * j + static_cast<std::size_t>(k)];
      row[4 * j] += first.along;
      row[4 * j + 1] += first.aside;
      row[4 * j + 2] += first.turn;
      if (j > 0) {
        const SurfaceFrame& before = path.contacts[j - 1].atB;
        addEnd(row, j - 1, ofOtherEnd(wA, in, before.u, 1), ofOtherEnd(wA, in, before.b, 1), 0);
      }
      const FrameChanges last = k == 0 ? ofNormal(c.atB, out, -1) : ofSide(c.atB, out, -1);
      const Vector3d& wB = k == 0 ? c.atB.n : c.atB.b;
      row = system.A[4 * j + 2 + static_cast<std::size_t>(k)];
      addEnd(row, j, last.along, last.aside, last.turn);
      if (j + 1 < m) {
        const SurfaceFrame& after = path.contacts[j + 1].atA;
        row[4 * j + 4] += ofOtherEnd(wB, out, after.u, -1);
        row[4 * j + 5] += ofOtherEnd(wB, out, after.b, -1);
      }
    }
  }
}

// The largest share of Newton's step that no contact finds too long to trust.
double trustedShare(const ChainPath& path, std::span<const ChainObject> objects,
                    const LinearSystem& step) {
  double share = 1;
  for (std::size_t j = 0; j < static_cast<std::size_t>(path.numContacts); ++j) {
    const ChainContact& c = path.contacts[j];
    const double* d = step.b + 4 * j;
    const double size = sizeOf(objects[static_cast<std::size_t>(c.object)].surface);
    const auto limitTo = [&](double value, double limit) {
      if (std::abs(value) * share > limit) share = limit / std::abs(value);
    };
    const double trusted = 0.5 * std::min(size, 1 / (std::abs(c.atA.normal) + 1e-9));
    limitTo(d[0], trusted);
    limitTo(d[1], 0.5 * std::min(size, 1 / (std::abs(c.atA.sideways) + 1e-9)));
    limitTo(d[2], 0.5);
    limitTo(d[3], 0.5 * size + 0.5 * std::abs(c.arc));
  }
  return share;
}

ContactGuesses moved(const ContactGuesses& guesses, const ChainPath& path,
                     std::span<const ChainObject> objects, const LinearSystem& step) {
  ContactGuesses to = guesses;
  for (std::size_t j = 0; j < static_cast<std::size_t>(guesses.count); ++j) {
    const ChainContact& c = path.contacts[j];
    const double* d = step.b + 4 * j;
    const Eigen::Matrix3d& R = objects[static_cast<std::size_t>(c.object)].R_GS;
    ContactGuess& guess = to.each[j];
    guess.x += R.transpose() * (d[0] * c.atA.u + d[1] * c.atA.b);
    guess.u += R.transpose() * (d[2] * c.atA.b);
    guess.arc += d[3];
  }
  return to;
}

// A share of the way from one to the other.
ContactGuesses shareOfTheWay(const ContactGuesses& from, const ContactGuesses& to, double share) {
  ContactGuesses at = from;
  for (std::size_t j = 0; j < static_cast<std::size_t>(from.count); ++j) {
    at.each[j].x += share * (to.each[j].x - from.each[j].x);
    at.each[j].u += share * (to.each[j].u - from.each[j].u);
    at.each[j].arc += share * (to.each[j].arc - from.each[j].arc);
  }
  return at;
}

// Whether geodesics are integrated: closed forms cost nothing to be walked again.
bool isIntegrated(const ChainPath& path, std::span<const ChainObject> objects) {
  for (std::size_t j = 0; j < static_cast<std::size_t>(path.numContacts); ++j) {
    const Surface& surface = objects[static_cast<std::size_t>(path.contacts[j].object)].surface;
    if (std::holds_alternative<EllipsoidSurface>(surface)) return true;
    if (std::holds_alternative<TorusSurface>(surface)) return true;
  }
  return false;
}

// The largest shift and turn of a step: lengths relative to the curves and pieces that they bend.
double sizeOfStep(const ChainPath& path, const LinearSystem& step) {
  double most = 0;
  for (std::size_t j = 0; j < static_cast<std::size_t>(path.numContacts); ++j) {
    const ChainContact& c = path.contacts[j];
    const double* d = step.b + 4 * j;
    const double perLength = std::max({std::abs(c.atA.normal), std::abs(c.atA.sideways),
                                       std::abs(c.atB.normal), std::abs(c.atB.sideways),
                                       1 / path.pieces[j].length, 1 / path.pieces[j + 1].length});
    const double aside = c.a * d[1] + c.r * d[2];
    const double turn = c.aSlope * d[1] + c.rSlope * d[2];
    const double shift = std::abs(d[0]) + std::abs(d[1]) + std::abs(d[3]) + std::abs(aside);
    most = std::max({most, shift * perLength, std::abs(d[2]), std::abs(turn)});
    if (!std::isfinite(shift)) return shift;
  }
  return most;
}

// Goes a step of at most smallStep without walking the geodesics again: their ends follow by the
// Jacobi fields.
void finishBy(const LinearSystem& step, const Vector3d& P, const Vector3d& Q,
              std::span<const ChainObject> objects, ContactGuesses& guesses, ChainPath& path) {
  const auto m = static_cast<std::size_t>(path.numContacts);
  for (std::size_t j = 0; j < m; ++j) {
    ChainContact& c = path.contacts[j];
    const ChainObject& object = objects[static_cast<std::size_t>(c.object)];
    const double* d = step.b + 4 * j;
    const double along = d[0] + d[3], aside = c.a * d[1] + c.r * d[2];
    const double turn = c.aSlope * d[1] + c.rSlope * d[2];
    c.A += d[0] * c.atA.u + d[1] * c.atA.b;
    c.B += along * c.atB.u + aside * c.atB.b;
    c.arc += d[3];
    ContactGuess& guess = guesses.each[j];
    guess.x = object.intoFrame(c.A);
    c.atA = frameInG(object, guess.x, object.R_GS.transpose() * Vector3d(c.atA.u + d[2] * c.atA.b));
    c.atB = frameInG(object, object.intoFrame(c.B),
                     object.R_GS.transpose() * Vector3d(c.atB.u + turn * c.atB.b));
    guess.u = object.R_GS.transpose() * c.atA.u;
    guess.arc = c.arc;
  }
  for (std::size_t j = 0; j <= m; ++j) {
    path.pieces[j] =
        pieceBetween(j == 0 ? P : path.contacts[j - 1].B, j == m ? Q : path.contacts[j].A);
  }
}

// Every piece runs on in the direction of the geodesics, not against it.
bool runsOn(const ChainPath& path) {
  for (std::size_t j = 0; j < static_cast<std::size_t>(path.numContacts); ++j) {
    const ChainContact& c = path.contacts[j];
    if (!(c.atA.u.dot(path.pieces[j].t) > 0.5)) return false;
    if (!(c.atB.u.dot(path.pieces[j + 1].t) > 0.5)) return false;
  }
  return true;
}

// Goes Newton's step, or less of it until the error falls; `error` and the next right-hand sides in
// `system` are those of where it ends. Guesses stay as they are if it does not fall.
bool shorten(const Vector3d& P, const Vector3d& Q, std::span<const ChainObject> objects,
             LinearSystem& system, double tolerance, ContactGuesses& guesses, ChainPath& path,
             double& error) {
  double share = trustedShare(path, objects, system);
  const ContactGuesses full = moved(guesses, path, objects, system);
  const double before = error;
  for (int i = 0; i < 8; ++i, share *= 0.4) {
    ContactGuesses trial = share == 1 ? full : shareOfTheWay(guesses, full, share);
    draw(P, Q, objects, trial, tolerance, path);
    error = assembleCosines(path, system);
    if (error < before * (1 - 0.1 * share)) {
      guesses = trial;
      return true;
    }
  }
  return false;
}

}  // namespace

bool solveInPlace(LinearSystem& system) {
  const int n = system.n;
  auto& A = system.A;
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i) {
      if (std::abs(A[i][k]) > std::abs(A[pivot][k])) pivot = i;
    }
    if (!(std::abs(A[pivot][k]) > 0)) return false;
    if (pivot != k) {
      for (int j = k; j < n; ++j) std::swap(A[k][j], A[pivot][j]);
      std::swap(system.b[k], system.b[pivot]);
    }
    const double perPivot = 1 / A[k][k];
    for (int i = k + 1; i < n; ++i) {
      const double factor = A[i][k] * perPivot;
      if (factor == 0) continue;
      for (int j = k + 1; j < n; ++j) A[i][j] -= factor * A[k][j];
      system.b[i] -= factor * system.b[k];
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int j = k + 1; j < n; ++j) system.b[k] -= A[k][j] * system.b[j];
    system.b[k] /= A[k][k];
  }
  return true;
}

bool solveContacts(const Vector3d& P, const Vector3d& Q, std::span<const ChainObject> objects,
                   ContactGuesses& guesses, ChainPath& path) {
  // the geodesics need no more digits than the next two steps will leave
  constexpr double coarse = 1e-6, fine = 1e-13;
  double tolerance = coarse;
  LinearSystem system;
  draw(P, Q, objects, guesses, tolerance, path);
  double error = assembleCosines(path, system);
  for (int i = 0; i < maxIterations; ++i) {
    if (tolerance > fine && !(error > 10 * tolerance)) {
      tolerance = fine;
      draw(P, Q, objects, guesses, tolerance, path);
      error = assembleCosines(path, system);
    }
    if (!std::isfinite(error)) return false;
    if (error <= goal) return runsOn(path);
    assembleMatrix(path, system);
    if (!solveInPlace(system)) return false;
    ++path.iterations;
    if (tolerance == fine && sizeOfStep(path, system) < smallStep && isIntegrated(path, objects)) {
      finishBy(system, P, Q, objects, guesses, path);
      return runsOn(path);
    }
    // the last step but one starts from fine ones
    tolerance = error < 1e-3 ? fine : std::min(coarse, 1e-2 * error * error * error * error);
    const double before = error;
    if (!shorten(P, Q, objects, system, tolerance, guesses, path, error)) {
      // the error does not fall: no solution near, or where rounding ends
      if (before > 1e-10) return false;
      draw(P, Q, objects, guesses, fine, path);
      return runsOn(path);
    }
  }
  return false;
}

}  // namespace bio::detail
