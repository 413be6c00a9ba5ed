// The rows of the operations of lasers.
#pragma once

#include "kerf/op/rows.h"

namespace kerf::op_detail {

std::vector<CutRow> laser_rows();

}  // namespace kerf::op_detail
