// What the parts of the poster have in common: the toolpath, the profile, units, and the lines.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "back/gcode/arc_plan.h"
#include "back/gcode/line_writer.h"
#include "path/state.h"

#include "kerf/base/units.h"
#include "kerf/program/post.h"

namespace kerf::gcode {

/// The unit of the written program.
struct PostUnits {
  PostUnits(const PostProfile& profile, LengthUnit written);

  LengthUnit unit;
  double unit_mm;
  int decimals;
  Grid grid;
  double counts_per_feed;  // of mm/min
};

struct PostContext {
  PostContext(const Toolpath& steps, const PostProfile& controller, const PostOptions& given,
              Diagnostics& reports)
      : path(steps),
        profile(controller),
        options(given),
        diagnostics(reports),
        units(controller, given.unit.value_or(controller.unit)),
        lines(steps, controller, reports) {}

  const Toolpath& path;
  const PostProfile& profile;
  const PostOptions& options;
  Diagnostics& diagnostics;
  PostUnits units;
  LineWriter lines;
  PathPosition position;  // in the toolpath
  bool moved = false;     // in this file
};

/// A part of the poster: it writes steps of one kind and owns the state that they alone change.
class PostPart {
 protected:
  explicit PostPart(PostContext& c)
      : path_(c.path),
        profile_(c.profile),
        options_(c.options),
        diagnostics_(c.diagnostics),
        units_(c.units),
        lines_(c.lines),
        position_(c.position),
        moved_(c.moved) {}

  /// True if the controller has the M code; else an error about `what`.
  bool can_m(std::size_t i, int tenths, std::string_view what);
  void report_unsupported(std::size_t i, std::string message);
  void report_skipped(std::size_t i, std::string message);

  const Toolpath& path_;
  const PostProfile& profile_;
  const PostOptions& options_;
  Diagnostics& diagnostics_;
  const PostUnits& units_;
  LineWriter& lines_;
  PathPosition& position_;
  bool& moved_;
};

}  // namespace kerf::gcode
