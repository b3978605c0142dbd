#pragma once

namespace support {

/// How often this program has taken memory so far, from any thread: by malloc(), as Eigen does, or
/// by operator new. What shared libraries take by malloc() themselves is not counted.
long allocations();

}  // namespace support
