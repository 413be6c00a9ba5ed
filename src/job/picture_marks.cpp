// Axes, sizes and a legend as lines over a picture: text is made of the strokes of a built-in font.
#include "job/picture_marks.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "job/length_text.h"

#include "kerf/geom/text.h"

namespace kerf {
namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr Colour kInk{40, 44, 52};
constexpr std::array<Colour, 3> kAxisColours{{{196, 40, 36}, {20, 128, 52}, {36, 84, 200}}};  // X, Y, Z

// Fractions of the diagonal of the part.
constexpr double kTextHeight = 0.018, kDistance = 0.04, kAxisLength = 0.14;
constexpr double kNear = 0.5;         // the work zero is shown where it is no farther from the part
constexpr double kMinVisible = 0.15;  // sine of the angle between an edge and the view

// Of a legend, pixels at a picture of 1000 pixels.
constexpr double kLegendText = 13.0, kLegendPitch = 26.0, kSwatch = 18.0, kLegendMargin = 22.0;
constexpr double kUsualSide = 1000.0, kSwatchLine = 1.0;
constexpr std::size_t kMaxEntries = 24;

/// Polylines of a text from its lower left corner, in heights of its capital letters, and its width.
struct Strokes {
  std::vector<std::vector<Point2>> lines;
  double width = 0.0;
};

Strokes strokes_of(const std::string& text) {
  static const std::optional<TextFont> font = stroke_text_font("sans");
  Strokes out;
  Diagnostics ignored;  // a text without a stroke draws nothing
  const auto outlines =
      font ? set_text(text, *font, {.height = mm(1)}, ignored) : std::optional<std::vector<Outline>>();
  if (!outlines) return out;
  for (const Outline& outline : *outlines) {
    std::vector<Point2>& line = out.lines.emplace_back();
    for (std::size_t k = 0; k < outline.elements(); ++k) {
      line.push_back(outline.point(k));
      out.width = std::max(out.width, line.back().x);
    }
  }
  return out;
}

/// Only what the font has.
std::string plain(std::string text) {
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return text;
}

class Marks {
 public:
  Marks(const View& view, const Box3& box)
      : axes_(picture_axes(view)),
        box_(box),
        diagonal_(length(box.size())),
        units_(view.marks.inches ? ProgramUnits::inch : ProgramUnits::mm) {}

  /// From the work zero; where that is far away, from the nearest point of the part, with its position.
  void add_axes() {
    Point3 at{};
    for (int axis = 0; axis < 3; ++axis) {
      const bool far = box_.low[axis] > kNear * diagonal_ || box_.high[axis] < -kNear * diagonal_;
      if (far) at[axis] = box_.low[axis] > 0.0 ? box_.low[axis] : box_.high[axis];
    }
    if (!(at == Point3{})) {
      const std::string words =
          fmt::format("{}, {}, {}", units_.of(at.x, 2), units_.of(at.y, 2), units_.of(at.z, 2));
      text(at - 2.0 * kTextHeight * diagonal_ * axes_.up, words, kInk);
    }
    constexpr std::array<const char*, 3> kNames{"X", "Y", "Z"};
    for (int axis = 0; axis < 3; ++axis) {
      Point3 way{};
      way[axis] = 1.0;
      if (!is_visible(way)) continue;
      const Colour& colour = kAxisColours[static_cast<std::size_t>(axis)];
      const Point3 end = kAxisLength * diagonal_ * way;
      line(at, at + end, colour);
      text(at + (kAxisLength + kTextHeight) * diagonal_ * way, kNames[static_cast<std::size_t>(axis)],
           colour);
    }
  }

  /// One edge of the box along each axis, at its outside as seen from the viewer.
  void add_sizes() {
    const Point3 near = -1.0 * axes_.into;
    const auto side = [&](int axis, bool towards) {
      return (near[axis] > 0.0) == towards ? box_.high[axis] : box_.low[axis];
    };
    const double floor = near.z >= -kMinVisible ? box_.low.z : box_.high.z;
    const Point3 front{0.0, near.y > 0.0 ? 1.0 : -1.0, 0.0}, beside{near.x > 0.0 ? 1.0 : -1.0, 0.0, 0.0};
    const bool upright = is_visible({0.0, 0.0, 1.0});
    const bool from_side = !is_visible(front);  // X and Z only are seen: sizes go below the part
    size(0, {0.0, side(1, true), floor}, from_side ? Point3{0.0, 0.0, -1.0} : front);
    size(1, {side(0, true), 0.0, floor}, is_visible(beside) ? beside : Point3{0.0, 0.0, -1.0});
    if (upright) {
      const bool along_x = is_visible({1.0, 0.0, 0.0});
      const Point3 corner{side(0, !along_x), side(1, along_x), 0.0};
      size(2, corner, along_x ? -1.0 * beside : -1.0 * front);
    }
  }

  void add_legend(const std::vector<LegendEntry>& entries, int width, int height) {
    const double unit = std::max(0.6, std::min(width, height) / kUsualSide);
    double top = height - unit * (kLegendMargin + kLegendPitch * static_cast<double>(entries.size()));
    for (const auto& [name, colour] : entries) {
      const double left = unit * kLegendMargin;
      for (double y = 0.0; y < unit * kSwatch; y += kSwatchLine)
        on_picture({left, top + y}, {left + unit * kSwatch, top + y}, colour);
      const Strokes strokes = strokes_of(plain(name));
      const Point2 at{left + unit * (kSwatch + 8.0), top + unit * 0.5 * (kSwatch + kLegendText)};
      const auto placed = [&](Point2 p) {
        return Point2{at.x + unit * kLegendText * p.x, at.y - unit * kLegendText * p.y};
      };
      for (const auto& stroke : strokes.lines)
        for (std::size_t k = 1; k < stroke.size(); ++k)
          on_picture(placed(stroke[k - 1]), placed(stroke[k]), kInk);
      top += unit * kLegendPitch;
    }
  }

  std::vector<PictureLine> lines;
  std::vector<Point3> room;

 private:
  bool is_visible(const Point3& way) const { return length(cross(way, axes_.into)) > kMinVisible; }

  void line(const Point3& from, const Point3& to, const Colour& colour, bool thin = false) {
    lines.push_back({from, to, colour, thin});
    room.push_back(from);
    room.push_back(to);
  }
  void on_picture(Point2 from, Point2 to, const Colour& colour) {
    lines.push_back({{from.x, from.y, 0.0}, {to.x, to.y, 0.0}, colour, false, true});
  }
  /// A text with its centre at a point, upright in the picture.
  void text(const Point3& centre, const std::string& words, const Colour& colour) {
    const Strokes strokes = strokes_of(words);
    const double height = kTextHeight * diagonal_;
    const auto placed = [&](Point2 p) {
      return centre + height * (p.x - 0.5 * strokes.width) * axes_.right + height * (p.y - 0.5) * axes_.up;
    };
    for (const auto& stroke : strokes.lines)
      for (std::size_t k = 1; k < stroke.size(); ++k) line(placed(stroke[k - 1]), placed(stroke[k]), colour);
  }
  /// The length of the box along `axis`, beside its edge through `at`, on the side `out`.
  void size(int axis, Point3 at, const Point3& out) {
    Point3 way{};
    way[axis] = 1.0;
    if (!is_visible(way)) return;
    Point3 from = at, to = at;
    from[axis] = box_.low[axis];
    to[axis] = box_.high[axis];
    const Point3 away = kDistance * diagonal_ * out;
    for (const Point3& end : {from, to}) line(end + 0.2 * away, end + 1.2 * away, kInk, true);
    line(from + away, to + away, kInk);
    const std::string words = units_.with_unit(to[axis] - from[axis], 2);
    const double height = kTextHeight * diagonal_, half = 0.5 * strokes_of(words).width * height;
    // Beside the line in the picture: farther away where the text lies along the way out.
    const double along = dot(out, axes_.right), up = dot(out, axes_.up), seen = std::hypot(along, up);
    const double distance = (half * std::abs(along) + height * std::abs(up)) / seen + 1.2 * height;
    text(0.5 * (from + to) + away + (distance / seen) * (along * axes_.right + up * axes_.up), words, kInk);
  }

  PictureAxes axes_;
  Box3 box_;
  double diagonal_;
  LengthText units_;
};

/// One entry per colour, with all its names, and no more than fit.
std::vector<LegendEntry> merged(const std::vector<LegendEntry>& legend) {
  std::vector<LegendEntry> out;
  for (const LegendEntry& entry : legend) {
    if (entry.first.empty()) continue;
    const auto known =
        std::find_if(out.begin(), out.end(), [&](const LegendEntry& e) { return e.second == entry.second; });
    if (known == out.end())
      out.push_back(entry);
    else if (known->first != entry.first)
      known->first += ", " + entry.first;
  }
  if (out.size() > kMaxEntries) {
    const std::size_t more = out.size() - kMaxEntries + 1;
    out.resize(kMaxEntries - 1);
    out.push_back({std::to_string(more) + " more", kInk});
  }
  return out;
}

}  // namespace

std::vector<PictureLine> draw_marks(View& view, const Box3& box, const std::vector<LegendEntry>& legend) {
  if (box.empty() || !(length(box.size()) > 0.0)) return {};
  Marks marks(view, box);
  if (view.marks.axes) marks.add_axes();
  if (view.marks.size) marks.add_sizes();
  if (view.marks.legend) marks.add_legend(merged(legend), view.width, view.height);
  view.room = std::move(marks.room);
  return std::move(marks.lines);
}

}  // namespace kerf
