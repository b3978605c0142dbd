#include "bio/path/chain_starts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bio/path/surface/chain_change.h"

namespace bio {
namespace {

using Eigen::Vector3d;

using FourFloats = float __attribute__((vector_size(16)));
constexpr std::size_t leafSize = 6;
constexpr std::size_t perContact = 8;  // x, u, arc and a 0

float squareApart(const ChainEnds& a, const ChainEnds& b, std::size_t numbers) {
  FourFloats sum = {0, 0, 0, 0};
  for (std::size_t i = 0; i < numbers; i += 4) {
    const FourFloats d = {a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2],
                          a[i + 3] - b[i + 3]};
    sum += d * d;
  }
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

// P moves, Q moves, or a member shifts or turns about the origin of the first, along axis k of the
// first member's frame.
ChainScrews unitMotion(const ChainStarts::Known& posture, std::size_t i) {
  const Placement<double>& X = posture.X_GC[0];
  const Vector3d axis = X.R.col(static_cast<Eigen::Index>(i % 3));
  ChainScrews motion;
  if (i < 3) {
    motion.P = axis;
  } else if (i < 6) {
    motion.Q = axis;
  } else if (i % 6 < 3) {
    motion.objects[i / 6].linear = axis;
  } else {
    motion.objects[i / 6] = {X.p.cross(axis), axis};
  }
  return motion;
}

// A contact moved by a share of its change, which is limited where it is too long to trust.
void moveContact(const float* change, double size, ContactMemory& contact) {
  const Vector3d dx(change[0], change[1], change[2]), du(change[3], change[4], change[5]);
  const double longest = std::max({dx.norm() / (0.5 * size), du.norm() / 0.5, 1.0});
  const double share = 1 / longest;
  contact.p_SA += share * dx;
  contact.u_SA += share * du;
  contact.arc += share * change[6];
}

}  // namespace

ChainEnds chainEnds(std::size_t count, const ChainPlacements& X_GC, const Vector3d& P,
                    const Vector3d& Q) {
  ChainEnds ends{};
  for (std::size_t j = 0; j < count; ++j) {
    const Vector3d p = X_GC[j].R.transpose() * (P - X_GC[j].p);
    const Vector3d q = X_GC[j].R.transpose() * (Q - X_GC[j].p);
    for (std::size_t i = 0; i < 3; ++i) {
      ends[6 * j + i] = static_cast<float>(p[static_cast<Eigen::Index>(i)]);
      ends[6 * j + 3 + i] = static_cast<float>(q[static_cast<Eigen::Index>(i)]);
    }
  }
  return ends;
}

ChainStarts::ChainStarts(std::size_t count, bool inOneSegment, const std::vector<Known>& postures)
    : count_(count), numMotions_(inOneSegment ? 6 : 6 * count) {
  std::vector<ChainEnds> ends;
  for (const Known& posture : postures) {
    ends.push_back(chainEnds(count, posture.X_GC, posture.P, posture.Q));
  }
  std::vector<std::size_t> order(postures.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  splits_.resize(postures.size());
  arrange(order, 0, order.size(), ends);
  for (const std::size_t i : order) {
    starts_.push_back(postures[i].memory);
    ends_.push_back(ends[i]);
    for (std::size_t j = 1; 6 * j < numMotions_; ++j) {
      apart_.push_back(inverse(postures[i].X_GC[0]) * postures[i].X_GC[j]);
    }
    addChanges(postures[i]);
  }
}

// Halves the postures by the number that varies most among them, down to leaves.
void ChainStarts::arrange(std::vector<std::size_t>& order, std::size_t first, std::size_t last,
                          const std::vector<ChainEnds>& ends) {
  if (last - first <= leafSize) return;
  std::size_t widest = 0;
  float width = -1;
  for (std::size_t i = 0; i < 6 * count_; ++i) {
    float low = ends[order[first]][i], high = low;
    for (std::size_t k = first; k < last; ++k) {
      low = std::min(low, ends[order[k]][i]);
      high = std::max(high, ends[order[k]][i]);
    }
    if (high - low > width) {
      width = high - low;
      widest = i;
    }
  }
  const std::size_t middle = first + (last - first) / 2;
  const auto at = [&](std::size_t k) { return order.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(at(first), at(middle), at(last),
                   [&](std::size_t a, std::size_t b) { return ends[a][widest] < ends[b][widest]; });
  splits_[middle] = {widest, ends[order[middle]][widest]};
  arrange(order, first, middle, ends);
  arrange(order, middle, last, ends);
}

// How the contacts of a posture follow small motions; 0 where they cannot be followed.
void ChainStarts::addChanges(const Known& posture) {
  const std::size_t begin = changes_.size();
  changes_.resize(begin + numMotions_ * count_ * perContact);
  if (posture.taut.numContacts == 0 || !posture.taut.isShortest) return;
  const ChainChanges changes(posture.taut);
  for (std::size_t i = 0; i < numMotions_; ++i) {
    const auto shifts = changes.shifts(unitMotion(posture, i));
    for (std::size_t c = 0; c < static_cast<std::size_t>(posture.taut.numContacts); ++c) {
      const ChainContact& contact = posture.taut.contacts[c];
      const auto object = static_cast<std::size_t>(contact.object);
      const ContactShift& shift = shifts[c];
      const Eigen::Matrix3d R_SG = posture.X_GC[object].R.transpose();
      const Vector3d dx = R_SG * (shift.alongA * contact.atA.u + shift.aside * contact.atA.b);
      const Vector3d du = R_SG * (shift.turn * contact.atA.b);
      const double arc = shift.alongB - shift.alongA;
      if (!std::isfinite(dx.sum() + du.sum() + arc)) continue;
      float* change = changes_.data() + begin + (i * count_ + object) * perContact;
      for (int k = 0; k < 3; ++k) {
        change[k] = static_cast<float>(dx[k]);
        change[3 + k] = static_cast<float>(du[k]);
      }
      change[6] = static_cast<float>(arc);
    }
  }
}

void ChainStarts::descend(const ChainEnds& ends, std::size_t first, std::size_t last,
                          Nearest& best) const {
  if (last - first <= leafSize) {
    for (std::size_t k = first; k < last; ++k) {
      const float square = squareApart(ends, ends_[k], 6 * count_);
      if (square < best.square) best = {k, square};
    }
    return;
  }
  const std::size_t middle = first + (last - first) / 2;
  const float beyond = ends[splits_[middle].number] - splits_[middle].value;
  if (beyond < 0) {
    descend(ends, first, middle, best);
    if (beyond * beyond < best.square) descend(ends, middle, last, best);
  } else {
    descend(ends, middle, last, best);
    if (beyond * beyond < best.square) descend(ends, first, middle, best);
  }
}

// From the kept posture to this one, as unitMotion counts.
ChainStarts::Motion ChainStarts::motionFrom(std::size_t start, const ChainEnds& ends,
                                            const ChainPlacements& X_GC) const {
  Motion motion{};
  for (std::size_t i = 0; i < 6; ++i) motion[i] = ends[i] - ends_[start][i];
  const std::size_t others = numMotions_ / 6 - 1;
  for (std::size_t j = 1; j <= others; ++j) {
    const Placement<double>& was = apart_[start * others + j - 1];
    const Placement<double> is = inverse(X_GC[0]) * X_GC[j];
    const Eigen::Matrix3d turned = is.R * was.R.transpose();
    const Vector3d angular =
        0.5 * Vector3d(turned(2, 1) - turned(1, 2), turned(0, 2) - turned(2, 0),
                       turned(1, 0) - turned(0, 1));
    const Vector3d linear = is.p - was.p - angular.cross(was.p);
    for (std::size_t k = 0; k < 3; ++k) {
      motion[6 * j + k] = static_cast<float>(linear[static_cast<Eigen::Index>(k)]);
      motion[6 * j + 3 + k] = static_cast<float>(angular[static_cast<Eigen::Index>(k)]);
    }
  }
  return motion;
}

ChainStarts::Start ChainStarts::startFor(std::span<const ChainObject> objects,
                                         const ChainPlacements& X_GC, const Vector3d& P,
                                         const Vector3d& Q) const {
  const ChainEnds ends = chainEnds(count_, X_GC, P, Q);
  Nearest best;
  descend(ends, 0, starts_.size(), best);
  Start start{&starts_[best.start], starts_[best.start]};
  const Motion motion = motionFrom(best.start, ends, X_GC);
  for (std::size_t j = 0; j < count_; ++j) {
    if (start.moved.contacts[j].passing != Passing::touching) continue;
    std::array<float, perContact> change{};
    const float* column = changes_.data() + (best.start * numMotions_ * count_ + j) * perContact;
    for (std::size_t i = 0; i < numMotions_; ++i, column += count_ * perContact) {
      for (std::size_t k = 0; k < perContact; ++k) change[k] += motion[i] * column[k];
    }
    moveContact(change.data(), sizeOf(objects[j].surface), start.moved.contacts[j]);
  }
  return start;
}

}  // namespace bio
