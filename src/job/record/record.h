// What Kerf reports, each kind as one record: the JSON of the command, the dicts of Python and the model of
// the page are written from these alone. Members keep their order; "-0" is 0, and an undefined number is
// null.
#pragma once

#include <optional>
#include <string>

#include "job/record/value.h"

#include "kerf/base/diagnostics.h"
#include "kerf/path/report.h"
#include "kerf/path/toolpath.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf {

Record record_of(double value);
Record record_of(Point2 p);
Record record_of(Point3 p);
/// [[x, y, z low], [x, y, z high]], null for an empty box.
Record record_of(const Box3& box);
/// {"min": .., "max": ..}, null for an empty range.
Record record_of(const Range& range);
/// {"file":..,"line":..,"column":..}, {"file":..,"layer":..,"handle":..,"at":[x,y]},
/// {"file":..,"line":..,"call":..}, or null.
Record record_of(const Origin& origin);
Record record_of(const Diagnostic& diagnostic);
/// The kept ones, then an entry for each code with dropped ones.
Record record_of(const Diagnostics& diagnostics);
Record record_of(const Profile& profile);

/// Step `i` as one line of `kerf steps` and `path[i]` of Python; `tool`: the number in force.
Record record_of_step(const Toolpath& path, std::size_t i, std::optional<int> tool);

using Layout = Record::Layout;
/// The object as text with a line end.
std::string text_of(const Record& json, Layout layout);

}  // namespace kerf
