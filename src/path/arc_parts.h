// Arcs in parts: all passes that divide arcs of a toolpath do so here.
//
// The sweeps of the parts sum to that of the arc. A part whose ends coincide, or are too near to each other
// to state its sweep, is a straight cut: as an arc it would be a whole turn.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "kerf/path/toolpath.h"

namespace kerf {

/// Whether the points between the ends of arc `s` are known, except for one height of all of them.
bool can_be_divided(const Step& s, const PathPosition& from);

/// The ends of chords within `chord` of arc `s`, which starts at `from`; the last one is its end.
std::vector<Point3> chords_of(const Step& s, Point3 from, Length chord, int limit = 1 << 20);

/// The part of `arc`, which has the walk `walk`, between the path parameters `t0` and `t1` of it, from `from`
/// to `to`: points at these parameters, of any height. Nothing if they coincide.
using ArcPart = std::variant<std::monostate, step::Arc, step::Cut>;
ArcPart arc_part(const step::Arc& arc, const ArcWalk& walk, double t0, double t1, Point3 from, Point3 to);
/// Appends it; false if there is nothing to append.
bool add_part(Toolpath& out, const ArcPart& part, OriginId origin);

}  // namespace kerf
