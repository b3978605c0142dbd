#pragma once

#include "bio/tables/trial.h"

namespace bio::fixtures {

/// The beginning of a trial.
inline Trial cut(Trial trial, double seconds) {
  Eigen::Index rows = 0;
  while (rows < trial.times.size() && trial.times[rows] <= seconds + 1e-9) ++rows;
  trial.times.conservativeResize(rows);
  trial.excitations.conservativeResize(rows, Eigen::NoChange);
  for (MeasuredMotion& motion : trial.measured) {
    Eigen::Index samples = 0;
    while (samples < motion.times.size() && motion.times[samples] <= seconds + 1e-9) ++samples;
    motion.times.conservativeResize(samples);
    motion.values.conservativeResize(samples);
  }
  return trial;
}

}  // namespace bio::fixtures
