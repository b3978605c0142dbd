#pragma once

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace bio::bench {

/// As the program does (apps/program/main.cc): freed memory stays with the process. Otherwise the
/// system clears it again and again, which takes up to six times as long as 285 sensitivities.
inline const bool keepsFreedMemory = [] {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
  return true;
}();

}  // namespace bio::bench
