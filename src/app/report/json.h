// Kerf's types as JSON: one function per type, used by every subcommand. Keys keep the order in which they
// are set; "-0" is written as 0, and an undefined number is null.
#pragma once

#include <optional>
#include <string>

#include "app/report/json_value.h"

#include "kerf/base/diagnostics.h"
#include "kerf/path/report.h"
#include "kerf/path/toolpath.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf::app {

Json json_of(double value);
Json json_of(Point3 p);
/// [[x, y, z low], [x, y, z high]], null for an empty box.
Json json_of(const Box3& box);
/// {"min": .., "max": ..}, null for an empty range.
Json json_of(const Range& range);
/// {"file":..,"line":..,"column":..}, {"file":..,"layer":..,"handle":..,"at":[x,y]},
/// {"file":..,"line":..,"call":..}, or null.
Json json_of(const Origin& origin);
Json json_of(const Diagnostic& diagnostic);
/// The kept ones, then an entry for each code with dropped ones.
Json json_of(const Diagnostics& diagnostics);
Json json_of(const Profile& profile);

/// Step `i` as one line of `kerf steps`; `tool`: the number in force.
Json step_json(const Toolpath& path, std::size_t i, std::optional<int> tool);

using Layout = Json::Layout;
/// The object as text with a line end.
std::string text_of(const Json& json, Layout layout);

}  // namespace kerf::app
