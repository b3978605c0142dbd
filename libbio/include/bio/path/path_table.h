#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

namespace bio {

/// A muscle–tendon length over the one free coordinate q: quintic polynomials between the nodes of
/// a uniform grid, which match ℓ, ∂ℓ/∂q and ∂²ℓ/∂q² there (docs/decisions/048-tabulated-paths.md).
///
/// A piece is used only if it agrees with the path at its centre, where the error of a quintic in ℓ
/// and ∂²ℓ is largest and where a kink anywhere within it shows. If it does not agree (lift-off
/// from a wrap object, switch of a conditional point), there is no piece and the path itself has to
/// be evaluated. Constant.
class PathTable {
 public:
  struct Value {
    double length = 0;     ///< ℓ [m]
    double slope = 0;      ///< ∂ℓ/∂q [m/rad]; per m if q is a translation
    double curvature = 0;  ///< ∂²ℓ/∂q² [m/rad²]
    bool wrapped = false;  ///< a moving span touches a wrap object
  };
  /// Largest difference between piece and path where they are compared [m, m/rad, m/rad²].
  static constexpr double lengthError = 1e-13, slopeError = 1e-11, curvatureError = 1e-9;

  /// @param pieces number of pieces of equal width between lowest and highest
  /// @throws std::invalid_argument unless lowest < highest, finite, and pieces > 0
  PathTable(double lowest, double highest, std::size_t pieces,
            const std::function<Value(double q)>& exact);

  /// False, with `value` unchanged, if there is no piece.
  bool find(double q, Value& value) const {
    const double at = (q - lowest_) * perWidth_;
    if (!(at >= 0 && at < static_cast<double>(pieces_.size()))) return false;
    const auto which = static_cast<std::size_t>(at);
    const Piece& piece = pieces_[which];
    if (!piece.stands) return false;
    const double x = at - static_cast<double>(which);
    const std::array<double, 6>& c = piece.c;
    value.length = c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
    value.slope =
        perWidth_ * (c[1] + x * (2 * c[2] + x * (3 * c[3] + x * (4 * c[4] + x * 5 * c[5]))));
    value.curvature =
        perWidth_ * perWidth_ * (2 * c[2] + x * (6 * c[3] + x * (12 * c[4] + x * 20 * c[5])));
    value.wrapped = piece.wrapped;
    return true;
  }

  std::size_t pieces() const { return pieces_.size(); }
  /// Number of pieces that agree with the path.
  std::size_t standing() const;

 private:
  struct Piece {
    std::array<double, 6> c{};  ///< of powers of x, 0 to 1 over the piece [m]
    bool stands = false;
    bool wrapped = false;
  };

  double lowest_ = 0;
  double perWidth_ = 0;
  std::vector<Piece> pieces_;
};

}  // namespace bio
