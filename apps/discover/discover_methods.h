#pragma once

#include "discover/discover_verdict.h"
#include "output/methods.h"

namespace app {

/// How the verdict was reached.
void sayDiscovery(const DiscoverFindings& findings, Methods& methods);

}  // namespace app
