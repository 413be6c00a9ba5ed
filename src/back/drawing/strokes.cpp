// The walk along the steps of a toolpath.
#include "back/drawing/strokes.h"

namespace kerf::drawings {
namespace {

void walk_arc(const Step& s, Stroke stroke, const StrokeOptions& options, StrokeSink& sink) {
  const ArcWalk walk = walk_of(s, stroke.from);
  if (walk.plane == Plane::xy && walk.sweep != 0.0) {
    stroke.arc = &walk;
    return sink.stroke(stroke);
  }
  const int count = walk.chords(options.chord, options.max_chords);
  stroke.is_chord = true;
  for (int i = 1; i <= count; ++i) {
    stroke.ends_step = i == count;
    stroke.to = i == count ? s.to() : walk.at(static_cast<double>(i) / count);
    sink.stroke(stroke);
    stroke.from = stroke.to;
  }
}

}  // namespace

void walk_strokes(const Toolpath& path, const StrokeOptions& options, StrokeSink& sink) {
  PathPosition position;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Step& s = path[i];
    if (!s.is_motion()) {
      position.pass(s);
      sink.setting(i);
      continue;
    }
    Stroke stroke;
    stroke.step = i;
    stroke.from = position.at;
    stroke.to = s.to();
    stroke.unknown_from = position.unknown;
    stroke.unknown_to = s.unknown_axes();
    if (s.kind() == StepKind::arc)
      walk_arc(s, stroke, options, sink);
    else
      sink.stroke(stroke);
    position.pass(s);
  }
}

}  // namespace kerf::drawings
