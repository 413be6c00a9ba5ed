// The layout of the shapes of a job: its keys, and the shapes as they are laid out.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "op/base/row_keys.h"

#include "kerf/base/limits.h"
#include "kerf/program/cut_job.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxShapes = 1'000'000;

double height_of(const PlacedPicture& picture) {
  return picture.width.mm() * static_cast<double>(picture.picture.height) /
         std::max(1.0, static_cast<double>(picture.picture.width));
}

Box2 box_of(const std::vector<ArtShape>& shapes) {
  Box2 box;
  for (const ArtShape& shape : shapes) {
    if (shape.outline) box.add(bounds(*shape.outline));
    if (shape.point) box.add(*shape.point);
    if (shape.picture) {
      box.add(shape.picture->at);
      box.add(shape.picture->at + Point2{shape.picture->width.mm(), height_of(*shape.picture)});
    }
  }
  return box;
}

/// Scaled about the origin, then moved; mirroring is a negative factor.
ArtShape placed(const ArtShape& shape, const Placement& at) {
  ArtShape made = shape;
  const auto moved = [&](Point2 p) {
    return Point2{at.offset.x + at.factor.x * p.x, at.offset.y + at.factor.y * p.y};
  };
  if (shape.outline) made.outline = placed(*shape.outline, at);
  if (shape.circle) made.circle = placed(*shape.circle, at);
  if (shape.point) made.point = moved(*shape.point);
  if (shape.picture) {
    auto picture = std::make_shared<PlacedPicture>(*shape.picture);
    picture->at = moved(picture->at), picture->width = std::abs(at.factor.x) * picture->width;
    made.picture = std::move(picture);
  }
  return made;
}

ArtShape turned(const ArtShape& shape, Angle angle) {
  ArtShape made = shape;
  if (shape.outline) made.outline = rotated(*shape.outline, {}, angle);
  if (shape.circle) made.circle = rotated(*shape.circle, {}, angle);
  if (shape.point) made.point = rotated(Circle{*shape.point, mm(1)}, {}, angle).centre;
  return made;
}

class LayoutRun {
 public:
  LayoutRun(const CutLayout& layout, std::vector<ArtShape>& shapes) : layout_(layout), shapes_(shapes) {
    // The point that becomes work zero goes along with the shapes.
    shapes_.push_back({"", "", {}, {}, layout.zero.value_or(Point2{})});
  }

  Box2 run() {
    if (layout_.mirror != ArtMirror::none)
      arrange({{}, layout_.mirror == ArtMirror::x ? Point2{-1, 1} : Point2{1, -1}});
    if (layout_.rotate != Angle{})
      for (ArtShape& shape : shapes_) shape = turned(shape, layout_.rotate);
    const double factor = layout_.scale * fit();
    if (factor != 1.0) arrange({{}, {factor, factor}});
    const Point2 zero = *shapes_.back().point;
    shapes_.pop_back();
    repeat();
    Box2 box = box_of(shapes_);
    if (box.empty()) return box;
    const double margin = layout_.margin.mm();
    box = {box.low - Point2{margin, margin}, box.high + Point2{margin, margin}};
    const Point2 shift = layout_.move - (layout_.origin ? corner(box, *layout_.origin) : zero);
    if (shift.x != 0.0 || shift.y != 0.0) arrange({shift});
    return {box.low + shift, box.high + shift};
  }

 private:
  void arrange(const Placement& at) {
    for (ArtShape& shape : shapes_) shape = placed(shape, at);
  }
  /// The factor at which all copies have the width or height that is asked for.
  double fit() const {
    const Point2 size = size_of_one();
    double factor = INFINITY;
    const auto side = [&](Length wanted, double one, int count) {
      const double space = wanted.mm() - (count - 1) * layout_.gap.mm();
      if (wanted > Length{} && one > 0.0) factor = std::min(factor, space / (count * one * layout_.scale));
    };
    side(layout_.fit_width, size.x, layout_.columns);
    side(layout_.fit_height, size.y, layout_.rows);
    return std::isfinite(factor) && factor > 0.0 ? factor : 1.0;
  }
  Point2 size_of_one() const {
    const Box2 box = box_of({shapes_.begin(), shapes_.end() - 1});
    return box.empty() ? Point2{} : box.high - box.low;
  }
  void repeat() {
    const std::vector<ArtShape> one = shapes_;
    const Box2 box = box_of(one);
    if (box.empty()) return;
    const Point2 pitch = box.high - box.low + Point2{layout_.gap.mm(), layout_.gap.mm()};
    std::uint32_t figures = 0;
    for (const ArtShape& shape : one) figures = std::max(figures, shape.fill.figure);
    for (int i = 1; i < layout_.columns * layout_.rows; ++i)
      for (const ArtShape& shape : one) {
        const Point2 offset{(i % layout_.columns) * pitch.x, (i / layout_.columns) * pitch.y};
        shapes_.push_back(placed(shape, {offset}));
        // Each copy is filled by itself.
        if (shape.fill.figure != 0) shapes_.back().fill.figure += figures * static_cast<std::uint32_t>(i);
      }
  }
  static Point2 corner(const Box2& box, ZeroCorner which) {
    const Point2 part = fraction_of(which), size = box.high - box.low;
    return {box.low.x + part.x * size.x, box.low.y + part.y * size.y};
  }

  const CutLayout& layout_;
  std::vector<ArtShape>& shapes_;
};

std::string fault_of(const CutLayout& layout, const std::vector<ArtShape>& shapes) {
  const bool picture = std::any_of(shapes.begin(), shapes.end(), [](const ArtShape& s) { return s.picture; });
  if (picture && (layout.mirror != ArtMirror::none || layout.rotate != Angle{}))
    return "a picture is neither mirrored nor rotated";
  if (layout.change.touch_off == TouchOff::probe && !layout.change.height)
    return "touch-off by a probe needs change-height, from which the tool goes down";
  if (layout.change.height && *layout.change.height <= layout.change.probe_height)
    return "change-height is not above probe-height";
  if (layout.zero && layout.origin) return "origin and zero both state where work zero is";
  const auto count = static_cast<std::size_t>(layout.columns) * static_cast<std::size_t>(layout.rows);
  if (count * shapes.size() > kMaxShapes) return fmt::format("more than {} shapes", kMaxShapes);
  const auto fits = [&](Length wanted, int copies) {
    return !(wanted > Length{}) || wanted > (copies - 1.0) * layout.gap;
  };
  if (!fits(layout.fit_width, layout.columns)) return "the gaps alone are wider than fit-width";
  if (!fits(layout.fit_height, layout.rows)) return "the gaps alone are higher than fit-height";
  return {};
}

using Keys = std::vector<CutLayoutKey>;
using L = CutLayout;
using op_detail::above;
using op_detail::at_least;
using op_detail::key_at;
using op_detail::Names;
using op_detail::within;

Keys placing_keys() {
  return {key_at<L>(
              {.name = "mirror", .meaning = "mirrors the shapes: the sign of X or Y changes"},
              [](L & l) -> auto& { return l.mirror; },
              Names<ArtMirror>{{"none", ArtMirror::none}, {"x", ArtMirror::x}, {"y", ArtMirror::y}}),
          key_at<L>(
              {.name = "rotate", .meaning = "turns the shapes counter-clockwise", .example = "90"},
              [](L & l) -> auto& { return l.rotate; }),
          key_at<L>(
              {.name = "scale", .meaning = "scales the shapes", .example = "1", .range = {1e-6, 1e6}},
              [](L & l) -> auto& { return l.scale; }),
          key_at<L>(
              {.name = "fit-width",
               .meaning = "scales the shapes, all copies together, to this width; 0: not",
               .example = "0",
               .range = at_least(0)},
              [](L & l) -> auto& { return l.fit_width; }),
          key_at<L>(
              {.name = "fit-height",
               .meaning = "likewise to this height; with both, the smaller scale holds",
               .example = "0",
               .range = at_least(0)},
              [](L & l) -> auto& { return l.fit_height; }),
          key_at<L>(
              {.name = "grid-columns",
               .meaning = "copies beside each other",
               .example = "1",
               .range = within(1, 1000)},
              [](L & l) -> auto& { return l.columns; }),
          key_at<L>(
              {.name = "grid-rows",
               .meaning = "copies above each other",
               .example = "1",
               .range = within(1, 1000)},
              [](L & l) -> auto& { return l.rows; }),
          key_at<L>(
              {.name = "grid-gap", .meaning = "between copies", .example = "5", .range = at_least(0)},
              [](L & l) -> auto& { return l.gap; })};
}

Names<std::optional<ZeroCorner>> origin_names() {
  Names<std::optional<ZeroCorner>> names{{"drawing", std::nullopt}};
  for (const std::string& name : zero_corner_names()) names.emplace_back(name, parse_zero_corner(name));
  return names;
}

Keys origin_keys() {
  return {
      key_at<L>(
          {.name = "art-margin",
           .meaning = "around the shapes, for origin and thickness",
           .example = "0",
           .range = at_least(0)},
          [](L & l) -> auto& { return l.margin; }),
      key_at<L>(
          {.name = "origin", .meaning = "point of the shapes and their margin that becomes work zero"},
          [](L & l) -> auto& { return l.origin; }, origin_names()),
      key_at<L>(
          {.name = "zero", .meaning = "X,Y of the drawing that becomes work zero", .example = "[0, 0]"},
          [](L & l) -> auto& { return l.zero; }),
      key_at<L>(
          {.name = "move", .meaning = "X,Y by which the shapes are moved at last", .example = "[0, 0]"},
          [](L & l) -> auto& { return l.move; }),
      key_at<L>(
          {.name = "thickness",
           .meaning = "thickness of the stock below the shapes and their margin, its top at Z0; 0: none",
           .example = "0",
           .range = at_least(0)},
          [](L & l) -> auto& { return l.thickness; }),
      key_at<L>(
          {.name = "spoilboard",
           .meaning = "thickness of the board below the stock, into which cuts may go; 0: none",
           .example = "0",
           .range = within(0, limits::kThickestSpoilboard)},
          [](L & l) -> auto& { return l.spoilboard; }),
      key_at<L>(
          {.name = "order",
           .meaning = "order of the operations: as written, but work before it is cut out; by few tool "
                      "changes; all on one part before the next one; or just as written"},
          [](L & l) -> auto& { return l.order; },
          Names<CutOrder>{{"inner-first", CutOrder::inner_first},
                          {"by-tool", CutOrder::by_tool},
                          {"by-part", CutOrder::by_part},
                          {"as-written", CutOrder::as_written}}),
      key_at<L>(
          {.name = "park",
           .meaning = "X,Y to which the tool moves at the end, on the retract plane",
           .example = "[0, 0]"},
          [](L & l) -> auto& { return l.park; }),
      key_at<L>(
          {.name = "wrap",
           .meaning = "diameter of a bar along X that the program is wrapped around: Y becomes turns of A",
           .example = "\"d=40\""},
          [](L & l) -> auto& { return l.wrap; })};
}

Keys change_keys() {
  return {key_at<L>(
              {.name = "change-height", .meaning = "Z of tool changes", .example = "40"},
              [](L & l) -> auto& { return l.change.height; }),
          key_at<L>(
              {.name = "change-at", .meaning = "X,Y of tool changes", .example = "[0, 0]"},
              [](L & l) -> auto& { return l.change.at; }),
          key_at<L>(
              {.name = "touch-off",
               .meaning = "how the zero in Z of a further tool is set: not, by the operator, whom a message "
                          "asks, or by a probe (G38.2)"},
              [](L & l) -> auto& { return l.change.touch_off; },
              Names<TouchOff>{
                  {"none", TouchOff::none}, {"message", TouchOff::message}, {"probe", TouchOff::probe}}),
          key_at<L>(
              {.name = "probe-at",
               .meaning = "X,Y of the touch-off; else that of tool changes",
               .example = "[0, 0]"},
              [](L & l) -> auto& { return l.change.probe_at; }),
          key_at<L>(
              {.name = "probe-height",
               .meaning = "Z of what the touch-off touches: the thickness of a plate on the zero",
               .example = "0"},
              [](L & l) -> auto& { return l.change.probe_height; })};
}

}  // namespace

const std::vector<CutLayoutKey>& cut_layout_keys() {
  static const Keys keys = [] {
    Keys all = placing_keys();
    for (CutLayoutKey& key : origin_keys()) all.push_back(std::move(key));
    for (CutLayoutKey& key : change_keys()) all.push_back(std::move(key));
    return all;
  }();
  return keys;
}

std::optional<Box2> lay_out(const CutLayout& layout, std::vector<ArtShape>& shapes, const Origin& where,
                            Diagnostics& diagnostics) {
  if (const std::string fault = fault_of(layout, shapes); !fault.empty()) {
    diagnostics.error(codes::cut_job_key, where, fault);
    return std::nullopt;
  }
  return LayoutRun(layout, shapes).run();
}

}  // namespace kerf
