// From a toolpath to the pieces of a drawing.
#include "back/gcmc/strokes.h"

#include <algorithm>

#include "kerf/tolerance.h"
#include "kerf/units.h"

namespace kerf::gcmc_drawing {
namespace {

constexpr double kSamePoint = 1e-12;  // drawing unit; as the real program compares the ends of an arc

constexpr int kMaxChords = 2000;  // of one arc

class Drawer {
 public:
  Drawer(const Toolpath& path, const GcmcDrawingOptions& options)
      : path_(path), scale_(options.imperial ? 1.0 / kMmPerInch : 1.0) {
    out_.layers.push_back("0");
    out_.layers.insert(out_.layers.end(), options.layers.begin(), options.layers.end());
  }
  Drawing run() {
    for (std::size_t i = 0; i < path_.size(); ++i) {
      const Step& s = path_[i];
      if (s.kind() == StepKind::layer)
        set_layer(path_.layer(i).name);
      else if (s.kind() == StepKind::close_path)
        close();
      else if (s.kind() == StepKind::arc)
        arc(s);
      else if (s.is_motion())
        straight(s.to(), s.kind() == StepKind::rapid);
    }
    return std::move(out_);
  }

 private:
  Point3 scaled(Point3 p) const { return scale_ * p; }

  void set_layer(const std::string& name) {
    auto found = std::find(out_.layers.begin() + 1, out_.layers.end(), name);
    if (found == out_.layers.end()) found = out_.layers.insert(out_.layers.end(), name);
    layer_ = static_cast<std::size_t>(found - out_.layers.begin());
    last_was_rapid_ = 2;
  }

  void add(Piece piece, bool rapid) {
    piece.layer = layer_;
    piece.joined = last_was_rapid_ == (rapid ? 1 : 0);
    last_was_rapid_ = rapid ? 1 : 0;
    out_.uses_no_layer = out_.uses_no_layer || (layer_ == 0 && !rapid);
    at_ = piece.to;
    out_.pieces.push_back(piece);
  }

  void straight(Point3 to_mm, bool rapid) {
    Piece piece;
    piece.kind = rapid ? Piece::Kind::rapid : Piece::Kind::line;
    piece.from = at_;
    piece.to = scaled(to_mm);
    at_mm_ = to_mm;
    add(piece, rapid);
  }

  void arc(const Step& s) {
    const step::Arc a = s.arc();
    if (a.plane != Plane::xy) {
      const ArcWalk walk = walk_of(s, at_mm_);
      const int chords = walk.chords(default_tolerance::kDrawingChord, kMaxChords);
      for (int i = 1; i < chords; ++i) straight(walk.at(static_cast<double>(i) / chords), false);
      straight(a.to, false);
      return;
    }
    Piece piece;
    piece.kind = Piece::Kind::arc;
    piece.from = at_;
    piece.to = scaled(a.to);
    piece.centre = scale_ * a.centre;
    piece.turn = a.turn;
    piece.full_circle = a.extra_turns > 0 || distance(piece.from.xy(), piece.to.xy()) < kSamePoint;
    at_mm_ = a.to;
    if (piece.full_circle && distance(piece.from.xy(), piece.to.xy()) >= kSamePoint) {
      Piece circle = piece;
      circle.to = {piece.from.x, piece.from.y, piece.from.z};
      add(circle, false);
      piece.full_circle = false;
    }
    add(piece, false);
  }

  void close() {
    if (out_.pieces.empty() || out_.pieces.back().kind == Piece::Kind::rapid) return;
    Piece piece = out_.pieces.back();
    piece.kind = Piece::Kind::close;
    piece.from = piece.to;
    add(piece, false);
    last_was_rapid_ = 2;
  }

  const Toolpath& path_;
  double scale_;
  Drawing out_;
  Point3 at_, at_mm_;
  std::size_t layer_ = 0;
  int last_was_rapid_ = 2;  // 0 no, 1 yes, 2 nothing to join
};

}  // namespace

Drawing drawing_of(const Toolpath& path, const GcmcDrawingOptions& options) {
  return Drawer(path, options).run();
}

}  // namespace kerf::gcmc_drawing
