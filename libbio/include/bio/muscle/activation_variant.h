#pragma once

#include <variant>

#include "bio/muscle/first_order_activation.h"
#include "bio/muscle/smooth_activation.h"

namespace bio::muscles {

/// The activation laws that there are.
using AnyActivation =
    std::variant<FirstOrderActivation<double>, SmoothActivation<double>, DirectActivation>;

}  // namespace bio::muscles
