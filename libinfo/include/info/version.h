#pragma once

namespace info {

/// Version of the toolkit, "major.minor.patch"; written into every result.
const char* version();

}  // namespace info
