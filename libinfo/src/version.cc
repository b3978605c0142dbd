#include "info/version.h"

namespace info {

const char* version() { return "0.1.0"; }

}  // namespace info
