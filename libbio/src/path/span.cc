#include "bio/path/span.h"

#include <fmt/format.h>

#include <stdexcept>

namespace bio {

void throwEndInside(const char* center, double distanceP, double distanceQ, double radius) {
  throw std::domain_error(
      fmt::format("the ends of a wrapped path are {} m and {} m from the {}, must be outside its "
                  "radius of {} m",
                  distanceP, distanceQ, center, radius));
}

}  // namespace bio
