#pragma once

#include <Eigen/Dense>

namespace bio {

/// Factor n ≥ 2 by which a series was interpolated linearly to a faster grid; 1 if it was not, or
/// if that cannot be seen.
///
/// From its neighbours' straight line a sample is
///     d_k = y_k − y_{k−1} − (y_{k+1} − y_{k−1})·(t_k − t_{k−1})/(t_{k+1} − t_{k−1})
/// away. The result is the largest n up to 200 for which every |d_k| is at most a tenth of what a
/// quarter of every n-th exceed, at least eight of them, which must exceed 10⁻⁹·max|y|: a straight
/// line up to the digits of a file, but not what a resolution makes of a slow motion, whose steps
/// bend it in neighbouring samples. After a gap (an interval 1.5 times the median one) counting
/// starts again. Not seen: interpolation by a factor that is no whole number, or by curves.
///
/// White noise on such samples is underestimated: a second or third difference is small or zero
/// wherever it lies between two recorded values.
///
/// @param times  [s] strictly rising, as many as values
/// @param values  finite, in any unit
int interpolationFactor(const Eigen::VectorXd& times, const Eigen::VectorXd& values);

}  // namespace bio
