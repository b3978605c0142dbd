#pragma once

namespace info::discover {

/// log of the standard normal distribution function, finite far into the tail.
double logNormalBelow(double x);
/// log P(lowest ≤ Z ≤ highest) of a standard normal Z; −∞ if the interval is empty.
double logNormalWithin(double lowest, double highest);
/// log ∫₀^w exp(−g·x − ½h·x²) dx / √(2π): the probability mass next to a bound at which the cost
/// has the slope g ≥ 0 and the density is 1/√(2π).
/// @param g slope of the cost away from the bound, h > 0 its curvature, w > 0 width of the box
double logMassAtBound(double g, double h, double w);

}  // namespace info::discover
