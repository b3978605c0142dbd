#pragma once

namespace bio::schutte {

// The constants of the force–velocity relation: f_v(−1) = 0, f_v(0) = 1, f_v(∞) = 1.4.
inline constexpr double shapeShortening = 0.15;     ///< k_v
inline constexpr double maxLengtheningForce = 1.4;  ///< f_v(∞)
inline constexpr double shapeLengthening = 0.13 * shapeShortening / (shapeShortening + 1);  ///< σ

}  // namespace bio::schutte
