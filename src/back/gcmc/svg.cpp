// The SVG drawing.
#include <fmt/format.h>
#include <iterator>

#include "back/gcmc/strokes.h"

#include "kerf/gcmc_drawing.h"
#include "kerf/units.h"

namespace kerf {
namespace {

using gcmc_drawing::Drawing;
using gcmc_drawing::Piece;

constexpr double kDotsPerInch = 90.0;
constexpr double kMoveWidth = 0.1;  // dots, of the line that shows a rapid

class Writer {
 public:
  Writer(const Drawing& drawing, const GcmcDrawingOptions& options) : drawing_(drawing), options_(options) {
    scale_ = options.imperial ? kDotsPerInch : kDotsPerInch / kMmPerInch;
    tool_ = options.tool_width > 0.0 ? options.tool_width : options.imperial ? 0.125 : 3.0;
    measure();
  }

  std::string run() {
    head();
    const std::size_t layers = drawing_.layers.size();
    for (std::size_t i = 0; i < layers; ++i) {
      if (i == 0 && layers > 1 && !drawing_.uses_no_layer) continue;
      const std::string name = i == 0 ? "cutpath" : drawing_.layers[i];
      begin_layer(name, name);
      paths(i, false);
      out_ += "</g>\n";
    }
    if (options_.show_moves) {
      begin_layer("Move Path", "movepath");
      paths(0, true);
      out_ += "</g>\n";
    }
    out_ += "</svg>\n";
    return std::move(out_);
  }

 private:
  template <class... Args>
  void put(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Args>(args)...);
  }

  void measure() {
    box_.add(Point3{0, 0, 0});
    for (const Piece& p : drawing_.pieces) {
      box_.add(Point3{p.to.x, p.to.y, 0});
      if (p.kind != Piece::Kind::arc) continue;
      const ArcWalk walk = walk_arc(p.from, p.to, p.centre, Plane::xy, p.turn, 0);
      Box3 arc = walk.bounds();
      arc.low.z = arc.high.z = 0;
      box_.add(arc);
    }
  }

  void head() {
    const double width = box_.size().x + tool_, height = box_.size().y + tool_;
    const char* unit = options_.imperial ? "in" : "mm";
    out_ +=
        "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"no\"?>\n"
        "<!-- Created with Kerf -->\n"
        "<svg\n"
        "  xmlns=\"http://www.w3.org/2000/svg\"\n"
        "  xmlns:sodipodi=\"http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd\"\n"
        "  xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"\n"
        "  version=\"1.1\"\n";
    put("  width=\"{:f}{}\"\n  height=\"{:f}{}\"\n", width, unit, height, unit);
    put("  viewBox=\"0.0 0.0 {:f} {:f}\"\n>\n", width * scale_, height * scale_);
    put("<sodipodi:namedview\n  inkscape:document-units=\"{0}\"\n  units=\"{0}\"\n  showgrid=\"{1}\">\n",
        unit, options_.show_grid ? "true" : "false");
    if (options_.show_grid) {
      put("  <inkscape:grid\n    type=\"xygrid\"\n    units=\"{}\"\n    empspacing=\"4\"\n    "
          "visible=\"true\"\n"
          "    enabled=\"true\"\n    snapvisiblegridlinesonly=\"true\" />\n",
          unit);
    }
    out_ += "</sodipodi:namedview>\n";
  }

  void begin_layer(const std::string& label, const std::string& id) {
    const double x = tool_ / 2 - box_.low.x;
    const double y = tool_ / 2 + (options_.flip ? box_.high.y : -box_.low.y);
    put("<g inkscape:label=\"{}\" inkscape:groupmode=\"layer\" id=\"{}\" transform=\"scale({:f}) "
        "translate({:f} {:f})",
        label, id, scale_, x, y);
    out_ += options_.flip ? " scale(1 -1)\">\n" : "\">\n";
  }

  void begin_path(const Piece& p, bool moves) {
    ++count_;
    if (moves) {
      put("<path style=\"stroke:{};stroke-width:{:f};fill:none\" id=\"path{}\" d=\"",
          any_move_ ? "#000000" : "#ff0000", kMoveWidth / scale_, count_);
      any_move_ = true;
    } else {
      put("<path "
          "style=\"stroke:#000000;stroke-width:{:f};fill:none;stroke-linecap:round;stroke-linejoin:round;"
          "stroke-opacity:{:f}\" id=\"path{}\" d=\"",
          tool_, options_.opacity, count_);
    }
    put("M {:f},{:f}", p.from.x, p.from.y);
  }

  void arc_to(const Piece& p, Point2 to, bool large) {
    const double radius = distance(p.from.xy(), p.centre);
    put(" A {:f},{:f} 0 {},{} {:f},{:f}", radius, radius, large ? 1 : 0, p.turn == Turn::ccw ? 1 : 0, to.x,
        to.y);
  }

  void arc(const Piece& p) {
    if (p.full_circle) {  // in two halves, as one arc cannot end where it begins
      arc_to(p, p.centre + (p.centre - p.from.xy()), false);
      arc_to(p, p.to.xy(), false);
      return;
    }
    const Point2 a = p.from.xy() - p.centre, b = p.to.xy() - p.centre;
    const bool left = cross(a, b) >= 0.0;  // the end is less than half a turn counter-clockwise of the begin
    arc_to(p, p.to.xy(), left != (p.turn == Turn::ccw));
  }

  /// The paths of one layer, or all rapids.
  void paths(std::size_t layer, bool moves) {
    bool open = false;
    for (const Piece& p : drawing_.pieces) {
      const bool is_move = p.kind == Piece::Kind::rapid;
      if (is_move != moves || (!moves && p.layer != layer)) continue;
      if (!open || !p.joined) {
        if (open) out_ += "\"/>\n";
        begin_path(p, moves);
        open = true;
      }
      if (p.kind == Piece::Kind::arc)
        arc(p);
      else if (p.kind == Piece::Kind::close)
        out_ += " Z";
      else
        put(" L {:f},{:f}", p.to.x, p.to.y);
    }
    if (open) out_ += "\"/>\n";
  }

  const Drawing& drawing_;
  const GcmcDrawingOptions& options_;
  double scale_, tool_;
  Box3 box_;
  std::string out_;
  int count_ = 0;
  bool any_move_ = false;
};

}  // namespace

std::string gcmc_svg(const Toolpath& path, const GcmcDrawingOptions& options) {
  const Drawing drawing = gcmc_drawing::drawing_of(path, options);
  return Writer(drawing, options).run();
}

}  // namespace kerf
