// A configuration as `kerf config --json` and kerf.config() of Python show it.
#pragma once

#include "job/configuration.h"
#include "job/record/value.h"

namespace kerf {

/// {"files": [..], "values": {key: {"value": .., "file": .., "line": ..}}}
Record record_of(const Configuration& configuration);

}  // namespace kerf
