// The rows of the operations of mills on meshes.
#pragma once

#include "kerf/op/rows.h"

namespace kerf::op_detail {

std::vector<CutRow> mesh_rows();

}  // namespace kerf::op_detail
