#pragma once

namespace info::discover {

/// log of the standard normal distribution function, finite far into the tail.
double logNormalBelow(double x);
/// log P(lowest ≤ Z ≤ highest) of a standard normal Z; −∞ where there is no such number.
double logNormalWithin(double lowest, double highest);
/// log ∫₀^w exp(−g·x − ½h·x²) dx / √(2π): mass beside a bound that the slope g ≥ 0 pushes against,
/// as a share of that of a whole normal distribution of unit density at its peak.
/// @param g slope of the cost away from the bound, h > 0 its curvature, w > 0 width of the box
double logMassAtBound(double g, double h, double w);

}  // namespace info::discover
