// The keys of operations by name and kind.
#pragma once

#include "kerf/program/cut_job.h"

namespace kerf::cut_detail {

std::optional<CutKind> kind_named(std::string_view name);
const CutKey* key_named(std::string_view name);
bool is_required(CutKind kind, std::string_view key);
/// Whether a key has an effect on operations of a kind.
bool applies(CutKind kind, std::string_view key);

}  // namespace kerf::cut_detail
