#pragma once

#include <string>

#include "opensim/xml.h"

namespace bio::osim {

/// Does to `target` what turns `before` into `after`: texts that differ are replaced, elements that
/// only `after` has are added, those that only `before` has are removed, all else stays. Elements
/// belong together when tag and name agree, or the tag alone where there is one of it.
void applyChanges(Element& target, const Element& before, const Element& after);

/// Where two trees of the same form differ, as "…/radius: '0.016', not '0.017'"; empty if they
/// agree, numbers to `tolerance` times their size.
std::string firstDifference(const Element& a, const Element& b, double tolerance);

}  // namespace bio::osim
