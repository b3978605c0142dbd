#pragma once

// What Newton's method of a step goes by, in single simulations and in lanes; not public.

namespace bio::stepping::newton {

/// Reach of shift() [rad] or [m]: it changes the motion by at most 1e-11 rad; with 1e-5
/// it would be more (elbow8, three trials).
constexpr double near = 7e-6;
constexpr double worthwhile = 1e-4;        ///< corrections above are always followed
constexpr double largestTurn = 0.3;        ///< [rad] per iteration
constexpr double largestFibreStep = 0.25;  ///< of ℓ0 per iteration
/// A fibre's own correction, of ℓ0, above which its equation is solved first, until it is below the
/// second; in the first iteration of a step and later (decision 095).
constexpr double boldAtFirst = 1e-4, bold = 1e-6;
/// Rates of a fibre for that. Needed were at most 10 in steps of 10 ms (MoBL-ARMS v3, two curls,
/// also in steps of 50 ms; the shipped elbows, curls and co-contraction) and 17 of 20 ms (the
/// elbows); of 50 ms an elbow takes all.
constexpr int mostTries = 20;

}  // namespace bio::stepping::newton
