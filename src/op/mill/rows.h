// The rows of the operations of mills and drills.
#pragma once

#include "kerf/op/rows.h"

namespace kerf::op_detail {

std::vector<CutRow> mill_rows();

}  // namespace kerf::op_detail
