#include "path/tree_chain.h"

#include "bio/path/compiled_path.h"

namespace bio {
namespace {

/// Adds g·∂²x over the slots of a chain of segments, g a force at the point x.
void addBent(const SegmentChain& chain, const TreeMotion<double>& motion, const Vec3<double>& x,
             const Vec3<double>& g, SupportedLength<double>& work) {
  chainMoves(chain, motion, x, work.moves.data());
  addSecondsAlong(chain, motion, x, work.moves.data(), g, work.second);
}

/// Adds what a wrench on an object has to do with the change of the object's screws. The wrench is
/// that of forces f at points x of the object; its axes stay, the points move with the object:
///     W·∂_i(screw_j) = Σ f·(∂_ijx − ω_j × ∂_ix)
void addBentWrench(const TreePath::OverChain::Member& member, const Screw& wrench,
                   const Vec3<double>& origin, const TreeMotion<double>& motion,
                   const Vec3<double>* linear, const Vec3<double>* angular,
                   SupportedLength<double>& work) {
  const Vec3<double> couple = wrench.angular - origin.cross(wrench.linear);
  const Vec3<double> arm =
      couple.squaredNorm() > 0 ? couple.unitOrthogonal() : Vec3<double>::UnitX();
  const Vec3<double> force = couple.cross(arm);  // arm × force = couple
  const Vec3<double> points[2] = {origin + arm, origin};
  const Vec3<double> forces[2] = {force, wrench.linear - force};
  const Eigen::Index k = work.first.size();
  for (int p = 0; p < 2; ++p) {
    addBent(member.chain, motion, points[p], forces[p], work);
    for (Eigen::Index i = 0; i < k; ++i) {
      const Vec3<double> x_i = linear[i] + angular[i].cross(points[p]);
      const Vec3<double> turned = x_i.cross(forces[p]);  // f·(ω × x_i) = ω·(x_i × f)
      for (Eigen::Index j = 0; j < k; ++j) work.second(i, j) -= angular[j].dot(turned);
    }
  }
}

}  // namespace

TautTreeChain tautTreeChain(const CompiledPath& path, const TreePath::OverChain& over,
                            const TreeMotion<double>& motion, const Vec3<double>& P,
                            const Vec3<double>& Q, unsigned& used) {
  TautTreeChain chain;
  for (std::size_t j = 0; j < over.members.size(); ++j) {
    const TreePath::OverChain::Member& member = over.members[j];
    chain.X_GC[j] = motion.segments[static_cast<std::size_t>(member.segment)] * member.X_TC;
  }
  const PathChain& compiled = path.chains[over.chain];
  chain.placed = placeChain(path, compiled, chain.X_GC);
  chain.taut = tautChain(path, compiled, chain.placed, chain.X_GC, P, Q, used);
  return chain;
}

void fillChainMotions(const TreePath::OverChain& over, const TreeMotion<double>& motion,
                      const Vec3<double>& P, const Vec3<double>& Q, SupportedLength<double>& work) {
  const auto k = static_cast<std::size_t>(work.first.size());
  Vec3<double>* block = work.slotMoves.data();
  for (std::size_t i = 0; i < (2 + 2 * over.members.size()) * k; ++i) block[i].setZero();
  const auto addPoint = [&](const SegmentChain& chain, const Vec3<double>& x) {
    chainMoves(chain, motion, x, work.moves.data());
    for (std::size_t j = 0; j < chain.steps().size(); ++j) {
      block[chain.steps()[j].slot] += work.moves[j];
    }
    block += k;
  };
  addPoint(over.toP, P);
  addPoint(over.toQ, Q);
  for (const TreePath::OverChain::Member& member : over.members) {
    for (const SegmentChain::Step& step : member.chain.steps()) {
      const auto& S = motion.screw[static_cast<std::size_t>(step.mobility)];
      const auto slot = static_cast<std::size_t>(step.slot);
      block[slot] += step.sign * Vec3<double>(S[3], S[4], S[5]);
      block[k + slot] += step.sign * Vec3<double>(S[0], S[1], S[2]);
    }
    block += 2 * k;
  }
}

ChainScrews chainMotionOf(const TreePath::OverChain& over, const SupportedLength<double>& work,
                          std::size_t slot) {
  const auto k = static_cast<std::size_t>(work.first.size());
  const Vec3<double>* at = work.slotMoves.data() + slot;
  ChainScrews motion;
  motion.P = at[0];
  motion.Q = at[k];
  for (std::size_t j = 0; j < over.members.size(); ++j) {
    motion.objects[j] = {at[(2 + 2 * j) * k], at[(3 + 2 * j) * k]};
  }
  return motion;
}

// ∂_ijL = (∂_i∇L)·m_j + ∇L·∂_im_j, m_i the motions of ends and objects with coordinate i
bool addTreeChain(const CompiledPath& path, const TreePath::OverChain& over,
                  const TreeMotion<double>& motion, const Vec3<double>& P, const Vec3<double>& Q,
                  unsigned& used, SupportedLength<double>& work) {
  const PathChain& compiled = path.chains[over.chain];
  if (compiled.inOneSegment) {
    const Placement<double> X_GS =
        motion.segments[static_cast<std::size_t>(over.carrier)] * over.X_TS;
    const SpanToSecondOrder<double> s = spanOver(path, compiled, X_GS.R.transpose() * (P - X_GS.p),
                                                 X_GS.R.transpose() * (Q - X_GS.p), used);
    if (s.span.touches) addSpan(s, X_GS, over.toP, P, over.toQ, Q, motion, work);
    return s.span.touches;
  }
  const TautTreeChain chain = tautTreeChain(path, over, motion, P, Q, used);
  if (chain.taut.numContacts == 0) return false;
  const ChainScrews gradient = chainGradient(chain.taut);
  const ChainChanges changes(chain.taut);
  const std::size_t count = over.members.size();
  const auto k = static_cast<std::size_t>(work.first.size());
  fillChainMotions(over, motion, P, Q, work);
  work.length += chain.taut.length;
  for (std::size_t i = 0; i < k; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const ChainScrews m_i = chainMotionOf(over, work, i);
    work.first[row] += powerOf(gradient, m_i, count);
    const ChainScrews changed = changes.gradientChange(m_i);
    for (std::size_t j = 0; j < k; ++j) {
      work.second(row, static_cast<Eigen::Index>(j)) +=
          powerOf(changed, chainMotionOf(over, work, j), count);
    }
  }
  addBent(over.toP, motion, P, gradient.P, work);
  addBent(over.toQ, motion, Q, gradient.Q, work);
  for (std::size_t j = 0; j < count; ++j) {
    if (chain.taut.passing[j] != Passing::touching) continue;
    const Vec3<double>* linear = work.slotMoves.data() + (2 + 2 * j) * k;
    addBentWrench(over.members[j], gradient.objects[j], chain.X_GC[j].p, motion, linear, linear + k,
                  work);
  }
  return true;
}

}  // namespace bio
