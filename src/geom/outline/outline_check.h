// What every function that takes an outline from a user refuses.
#pragma once

#include <string>

#include "kerf/geom/outline.h"

namespace kerf::outline_detail {

/// False, with an error appended that names the element, where the outline has no segment, is closed with
/// only one, has a number that is not usable, or an arc that ends at its start.
bool check_outline(const Outline& outline, const std::string& name, const Origin& where,
                   Diagnostics& diagnostics);

/// False, with an error appended that names the element, where a request is not usable.
bool check_requests(const CornerRequests& requests, const std::string& name, const Origin& where,
                    Diagnostics& diagnostics);

}  // namespace kerf::outline_detail
