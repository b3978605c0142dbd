#include "bio/path/surface/chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bio/path/surface/taut_polygon.h"
#include "chain_newton.h"

namespace bio {
namespace {

using detail::ContactGuess;
using detail::ContactGuesses;
using Eigen::Vector3d;

// The second variation of the length over sideways shifts and turns (β, θ) of the contacts,
//   Σ (displacement across a piece)²/d + Σ ∫ (y′² − K y²) ds,
// is positive: the path is the shortest among its neighbours.
bool isShortest(const ChainPath& path) {
  constexpr int size = 2 * maxChain;
  double H[size][size] = {};
  const int n = 2 * path.numContacts;
  for (int j = 0; 2 * j < n; ++j) {
    const auto sj = static_cast<std::size_t>(j);
    const ChainContact& c = path.contacts[sj];
    const double perIn = 1 / path.pieces[sj].length, perOut = 1 / path.pieces[sj + 1].length;
    double(*block)[size] = H + 2 * j;
    block[0][2 * j] += c.a * c.aSlope + perIn + perOut * c.a * c.a;
    block[0][2 * j + 1] += c.aSlope * c.r + perOut * c.a * c.r;
    block[1][2 * j] += c.aSlope * c.r + perOut * c.a * c.r;
    block[1][2 * j + 1] += c.r * c.rSlope + perOut * c.r * c.r;
    if (2 * j + 2 < n) {
      const double couple = -perOut * c.atB.b.dot(path.contacts[sj + 1].atA.b);
      block[0][2 * j + 2] += couple * c.a;
      block[1][2 * j + 2] += couple * c.r;
      block[2][2 * j] += couple * c.a;
      block[2][2 * j + 1] += couple * c.r;
    }
  }
  for (int k = 0; k < n; ++k) {
    if (!(H[k][k] > -1e-14)) return false;
    if (!(H[k][k] > 1e-14)) continue;  // an arc of no length
    for (int i = k + 1; i < n; ++i) {
      for (int j = k + 1; j < n; ++j) H[i][j] -= H[i][k] * H[k][j] / H[k][k];
    }
  }
  return true;
}

// A contact half the object's size from where it was, or run through in the other sense, belongs to
// another way.
bool hasLeapt(std::span<const ChainObject> objects, const std::array<ContactMemory, maxChain>& was,
              const std::array<ContactMemory, maxChain>& is) {
  for (std::size_t j = 0; j < objects.size(); ++j) {
    if (was[j].passing != Passing::touching || is[j].passing != Passing::touching) continue;
    const double size = sizeOf(objects[j].surface);
    if ((was[j].p_SA - is[j].p_SA).norm() > 0.5 * size || was[j].u_SA.dot(is[j].u_SA) < 0) {
      return true;
    }
  }
  return false;
}

// Contacts of two polygons from which Newton's method would go the same way. Measured (MoBL_ARMS
// v3): with four times as many rounds what rests moves by at most 0.4 mm, what slides down by 17
// mm.
bool isSame(std::span<const ChainObject> objects, const std::array<ContactMemory, maxChain>& was,
            const std::array<ContactMemory, maxChain>& is) {
  for (std::size_t j = 0; j < objects.size(); ++j) {
    if (was[j].passing != is[j].passing) return false;
    if (is[j].passing != Passing::touching) continue;
    const double little = 0.01 * sizeOf(objects[j].surface);
    if ((was[j].p_SA - is[j].p_SA).norm() > little || std::abs(was[j].arc - is[j].arc) > little ||
        was[j].u_SA.dot(is[j].u_SA) < 0.999) {
      return false;
    }
  }
  return true;
}

class Search {
 public:
  Search(const Vector3d& P, const Vector3d& Q, std::span<const ChainObject> objects,
         const ChainMemory& memory, unsigned leftOut)
      : P_(P),
        Q_(Q),
        objects_(objects),
        contacts_(memory.contacts),
        isFresh_(!memory.known),
        leftOut_(leftOut) {
    for (std::size_t j = 0; j < objects.size(); ++j) {
      if (isLeftOut(j)) continue;
      const ChainObject& object = objects[j];
      inPlay_[j] = !isInside(object.surface, object.intoFrame(P)) &&
                   !isInside(object.surface, object.intoFrame(Q));
    }
  }

  ChainPath run() {
    if (isFresh_) contacts_ = polygon_ = tautPolygon(P_, Q_, objects_, inPlay_, 400);
    constexpr int maxRounds = 60;
    for (int round = 0; round < maxRounds; ++round) {
      if (!solve()) {
        if (isFresh_ && (settleEach() || dropMostDoubtful())) continue;
        if (!startAfresh()) break;
        continue;
      }
      if (liftOff() || touchDown()) continue;
      // a polygon may rest on a ridge; given more rounds it slides down
      if (isFresh_ && !isShortest(path_) && slides() && startAfresh()) continue;
      return finish(path_.event);
    }
    return finish(ChainEvent::notFound);
  }

  const std::array<ContactMemory, maxChain>& contacts() const { return contacts_; }

 private:
  bool isLeftOut(std::size_t object) const { return ((leftOut_ >> object) & 1u) != 0; }

  bool solve() {
    ContactGuesses guesses;
    for (std::size_t j = 0; j < objects_.size(); ++j) {
      const ContactMemory& c = contacts_[j];
      if (!inPlay_[j] || c.passing != Passing::touching) continue;
      guesses.each[static_cast<std::size_t>(guesses.count++)] = {static_cast<int>(j), c.p_SA,
                                                                 c.u_SA, c.arc};
    }
    if (!detail::solveContacts(P_, Q_, objects_, guesses, path_)) return false;
    for (int i = 0; i < guesses.count; ++i) {
      const ContactGuess& guess = guesses.each[static_cast<std::size_t>(i)];
      contacts_[static_cast<std::size_t>(guess.object)] = {Passing::touching, guess.x, guess.u,
                                                           guess.arc};
    }
    return true;
  }

  // Each object by itself between its neighbours' contacts, a few times over: brings together what
  // is too far apart for Newton's method on all of them. False if that has been done, or fails.
  bool settleEach() {
    if (objects_.size() < 2 || ++numSettled_ > 8) return false;
    ChainPath alone;
    for (int sweep = 0; sweep < 6; ++sweep) {
      Vector3d from = P_;
      for (std::size_t j = 0; j < objects_.size(); ++j) {
        ContactMemory& c = contacts_[j];
        if (!inPlay_[j] || c.passing != Passing::touching) continue;
        Vector3d to = Q_;
        for (std::size_t k = objects_.size() - 1; k > j; --k) {
          if (inPlay_[k] && contacts_[k].passing == Passing::touching) {
            to = objects_[k].outOfFrame(contacts_[k].p_SA);
          }
        }
        ContactGuesses guess;
        guess.count = 1;
        guess.each[0] = {static_cast<int>(j), c.p_SA, c.u_SA, c.arc};
        if (!detail::solveContacts(from, to, objects_, guess, alone)) return false;
        c.p_SA = guess.each[0].x;
        c.u_SA = guess.each[0].u;
        c.arc = guess.each[0].arc;
        if (c.arc < 0) {
          c.passing = Passing::clear;
        } else {
          from = alone.contacts[0].B;
        }
      }
    }
    path_.iterations += alone.iterations;
    return true;
  }

  // A polygon's shortest contact may be none; if it is, its object is touched again when it is cut.
  bool dropMostDoubtful() {
    ContactMemory* shortest = nullptr;
    for (std::size_t j = 0; j < objects_.size(); ++j) {
      ContactMemory& c = contacts_[j];
      if (!inPlay_[j] || c.passing != Passing::touching) continue;
      if (shortest == nullptr || c.arc < shortest->arc) shortest = &c;
    }
    if (shortest == nullptr) return false;
    shortest->passing = Passing::clear;
    return ++numDropped_ <= 12;
  }

  // From the hints; a second time with more rounds.
  bool startAfresh() {
    if (++numFresh_ > 3) return false;
    if (!isFresh_) path_.event = ChainEvent::jumped;
    isFresh_ = true;
    timesLeft_ = {};
    before_ = polygon_;
    contacts_ = polygon_ = tautPolygon(P_, Q_, objects_, inPlay_, 400 << (2 * numFresh_));
    return true;
  }

  // Whether the last additional rounds moved the polygon.
  bool slides() const { return numFresh_ == 0 || !isSame(objects_, before_, polygon_); }

  // Leaves the object whose arc is most negative.
  bool liftOff() {
    double least = 0;
    const ChainContact* leaves = nullptr;
    for (int i = 0; i < path_.numContacts; ++i) {
      const ChainContact& c = path_.contacts[static_cast<std::size_t>(i)];
      if (c.arc < least) {
        least = c.arc;
        leaves = &c;
      }
    }
    if (leaves == nullptr) return false;
    const auto j = static_cast<std::size_t>(leaves->object);
    contacts_[j].passing = Passing::clear;
    ++timesLeft_[j];
    return true;
  }

  // Touches the first object that the straight piece beside it cuts.
  bool touchDown() {
    std::size_t piece = 0;
    for (std::size_t j = 0; j < objects_.size(); ++j) {
      if (!inPlay_[j]) continue;
      if (contacts_[j].passing == Passing::touching) {
        ++piece;
        continue;
      }
      if (timesLeft_[j] > 1) continue;  // left for good: its arc is negative or next to nothing
      const ChainObject& object = objects_[j];
      const ChainPiece& straight = path_.pieces[piece];
      const LowestPoint lowest = lowestOnSegment(object.surface, object.intoFrame(straight.from),
                                                 object.intoFrame(straight.to));
      const double size = sizeOf(object.surface);
      if (!(lowest.height < -1e-12 * size)) continue;
      ContactMemory& contact = contacts_[j];
      if (lowest.height < -0.02 * size) {
        contact = tautPolygon(straight.from, straight.to, objects_.subspan(j, 1), {true}, 400)[0];
      }
      if (contact.passing != Passing::touching) {
        contact = {Passing::touching, lowest.point, object.R_GS.transpose() * straight.t, 0};
      }
      return true;
    }
    return false;
  }

  // A surface that is convex everywhere is not cut by its tangents.
  bool cutsAgain() const {
    for (std::size_t i = 0; i < static_cast<std::size_t>(path_.numContacts); ++i) {
      const ChainObject& object = objects_[static_cast<std::size_t>(path_.contacts[i].object)];
      if (!std::holds_alternative<TorusSurface>(object.surface)) continue;
      for (const ChainPiece& piece : {path_.pieces[i], path_.pieces[i + 1]}) {
        const LowestPoint lowest = lowestOnSegment(object.surface, object.intoFrame(piece.from),
                                                   object.intoFrame(piece.to));
        if (lowest.height < -1e-7 * sizeOf(object.surface)) return true;
      }
    }
    return false;
  }

  ChainPath finish(ChainEvent event) {
    path_.event = event;
    path_.length = path_.pieces[0].length;
    for (std::size_t i = 0; i < static_cast<std::size_t>(path_.numContacts); ++i) {
      path_.length += path_.contacts[i].arc + path_.pieces[i + 1].length;
    }
    for (std::size_t j = 0; j < objects_.size(); ++j) {
      path_.passing[j] = inPlay_[j]     ? contacts_[j].passing
                         : isLeftOut(j) ? Passing::clear
                                        : Passing::endInside;
    }
    path_.isShortest = isShortest(path_);
    if (event != ChainEvent::notFound && cutsAgain()) path_.event = ChainEvent::cutsAgain;
    return path_;
  }

  const Vector3d &P_, &Q_;
  std::span<const ChainObject> objects_;
  std::array<ContactMemory, maxChain> contacts_;
  std::array<ContactMemory, maxChain> polygon_, before_;  // the last polygon and the one before
  bool isFresh_;
  unsigned leftOut_;
  int numFresh_ = 0, numDropped_ = 0, numSettled_ = 0;
  std::array<bool, maxChain> inPlay_{};
  std::array<int, maxChain> timesLeft_{};
  ChainPath path_;
};

// A path that rests on a ridge, from where it would slide to either side: the shorter of the two
// that it slides to, from hints beside it.
void slideDown(const Vector3d& P, const Vector3d& Q, std::span<const ChainObject> objects,
               unsigned leftOut, ChainPath& path, ChainMemory& memory) {
  std::array<ChainObject, maxChain> aside = {
      ChainObject{SphereSurface(1)}, ChainObject{SphereSurface(1)}, ChainObject{SphereSurface(1)},
      ChainObject{SphereSurface(1)}};
  const ChainPath ridge = path;
  for (const double share : {0.5, -0.5, 1.0, -1.0}) {
    std::copy(objects.begin(), objects.end(), aside.begin());
    for (std::size_t i = 0; i < static_cast<std::size_t>(ridge.numContacts); ++i) {
      const ChainContact& c = ridge.contacts[i];
      ChainObject& object = aside[static_cast<std::size_t>(c.object)];
      const double far = share * sizeOf(object.surface);
      object.hint = object.intoFrame(0.5 * (c.A + c.B) + far * c.atA.b);
    }
    Search search(P, Q, {aside.data(), objects.size()}, {}, leftOut);
    const ChainPath found = search.run();
    if (found.event == ChainEvent::notFound || !found.isShortest) continue;
    if (path.isShortest && !(found.length < path.length)) continue;
    path = found;
    memory.contacts = search.contacts();
  }
}

}  // namespace

ChainPath solveChain(const Vector3d& P, const Vector3d& Q, std::span<const ChainObject> objects,
                     ChainMemory& memory, unsigned leftOut) {
  if (objects.size() > maxChain) {
    throw std::invalid_argument(fmt::format("a span of a path passes {} surfaces, must be <= {}",
                                            objects.size(), maxChain));
  }
  Search search(P, Q, objects, memory, leftOut);
  ChainPath path = search.run();
  if (path.event == ChainEvent::none && memory.known &&
      hasLeapt(objects, memory.contacts, search.contacts())) {
    path.event = ChainEvent::jumped;
  }
  const bool isFresh = !memory.known;
  memory.known = path.event != ChainEvent::notFound;
  memory.contacts = search.contacts();
  if (isFresh && memory.known && !path.isShortest) {
    slideDown(P, Q, objects, leftOut, path, memory);
  }
  return path;
}

}  // namespace bio
