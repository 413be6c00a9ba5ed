// The rows of the operations of lasers.
#include "op/laser/rows.h"

#include <fmt/format.h>

#include "base/codes/op.h"
#include "op/base/row_keys.h"

#include "kerf/op/laser.h"

namespace kerf::op_detail {
namespace {

/// Only the beam.
struct BeamOptions {
  LaserOptions laser{};
};

/// Options with a member `laser`: feed, power and passes.
template <class Options>
Keys<Options>& beam_keys(Keys<Options>& keys, bool needs_power = true) {
  return keys
      .add(
          {.name = "feed", .meaning = "feed of cuts", .example = "900", .range = above(0), .required = true},
          [](Options & o) -> auto& { return o.laser.feed; })
      .add(
          {.name = "power",
           .meaning = "power of the laser",
           .example = needs_power ? "80" : "0",
           .range = within(0, 100),
           .required = needs_power,
           .unit = "%"},
          [](Options & o) -> auto& { return o.laser.power; })
      .add(
          {.name = "max-s",
           .meaning = "the S of full power, $30 in GRBL",
           .example = "1000",
           .range = {0, limits::kMaxSpeed, true}},
          [](Options & o) -> auto& { return o.laser.full_s; })
      .add(
          {.name = "beam", .meaning = "M4, whose power follows the speed, or M3"},
          [](Options & o) -> auto& { return o.laser.mode; },
          Names<LaserMode>{{"dynamic", LaserMode::dynamic}, {"constant", LaserMode::constant}})
      .add(
          {.name = "passes", .meaning = "number of passes", .example = "1", .range = within(1, 1000)},
          [](Options & o) -> auto& { return o.laser.passes; });
}

/// Options with a member `scan`.
template <class Options>
Keys<Options>& scan_keys(Keys<Options>& keys) {
  return keys
      .add(
          {.name = "interval",
           .meaning = "distance of scan lines, and size of a picture's pixels",
           .example = "0.1",
           .range = at_least(0.001)},
          [](Options & o) -> auto& { return o.scan.interval; })
      .add(
          {.name = "overscan",
           .meaning = "length of scan lines beyond both ends, with power 0",
           .example = "2",
           .range = within(0, 1000)},
          [](Options & o) -> auto& { return o.scan.overscan; })
      .add(
          {.name = "scan", .meaning = "directions of scan lines"},
          [](Options & o) -> auto& { return o.scan.one_way; },
          Names<bool>{{"both", false}, {"one-way", true}});
}

CutRow laser_row() {
  using Options = BeamOptions;
  Keys<Options> keys;
  beam_keys(keys.selection());
  return row_of({.name = "laser",
                 .sentence = "Burn along outlines, open or closed.",
                 .cuts = "lists of points and arcs as in `Region`",
                 .input = CutInput::outlines,
                 .example = {.shapes = kLineAndText},
                 .order = 1,
                 .laser = true},
                keys, [](const Options& o, const CutWork& work, Diagnostics& d) {
                  return laser_lines(work.outlines(), o.laser, d);
                });
}

struct LeadCutOptions : LaserCutOptions, LeadKeys {};

CutRow cut_row() {
  using Options = LeadCutOptions;
  Keys<Options> keys;
  beam_keys(keys.selection())
      .add(
          {.name = "kerf",
           .meaning = "width of the slot that the beam leaves",
           .example = "0.15",
           .range = at_least(0)},
          [](Options & o) -> auto& { return o.kerf; })
      .side("side of the outlines that is cut")
      .leads("1");
  return row_of(
      {.name = "laser-cut",
       .sentence = "Cut a region out with a laser, half a kerf beside it.",
       .cuts = "the part (side 'outside': around it and inside its holes) or the opening ('inside')",
       .example = {.shapes = kPlateShapes},
       .order = 2,
       .laser = true,
       .cuts_out = true},
      keys, [](Options o, const CutWork& work, Diagnostics& d) {
        o.lead_in = o.in(), o.lead_out = o.out();
        return laser_cut(*work.region, o, d);
      });
}

struct FillOptions {
  LaserOptions laser{};
  ScanOptions scan{};
  Angle angle{};
};

CutRow fill_row() {
  using Options = FillOptions;
  Keys<Options> keys;
  scan_keys(beam_keys(keys.selection())
                .add(
                    {.name = "angle", .meaning = "direction of the lines, from +X", .example = "0"},
                    [](Options & o) -> auto& { return o.angle; }));
  return row_of({.name = "laser-fill",
                 .sentence = "Burn all inside a region by parallel lines.",
                 .cuts = "what is burnt",
                 .example = {.shapes = kStarShape},
                 .order = 1,
                 .laser = true},
                keys, [](const Options& o, const CutWork& work, Diagnostics& d) {
                  return laser_fill(*work.region, o.angle, o.scan, o.laser, d);
                });
}

std::optional<Operation> pictured(LaserPictureOptions options, const CutWork& work, Diagnostics& d) {
  if (work.pictures.empty()) {
    d.error(codes::cut_job_outlines, work.operation.where, work.operation.name + ": no picture is selected")
        .hint = "[[shape]]\npicture = \"photo.png\"";
    return std::nullopt;
  }
  Operation all;
  for (const auto& placed : work.pictures) {
    options.at = placed->at, options.width = placed->width;
    const auto piece = laser_picture(placed->picture, options, d);
    if (!piece) return std::nullopt;
    append(all.path, piece->path);
  }
  return all;
}

CutRow picture_row() {
  using Options = LaserPictureOptions;
  Keys<Options> keys;
  scan_keys(beam_keys(keys.selection()))
      .add(
          {.name = "tones", .meaning = "tones of a picture: power per pixel, or points at full power"},
          [](Options & o) -> auto& { return o.tones; },
          Names<PictureTones>{{"grey", PictureTones::grey}, {"dither", PictureTones::dither}})
      .add(
          {.name = "min-power",
           .meaning = "power of the lightest tone of a picture that is not white",
           .example = "0",
           .range = within(0, 100),
           .unit = "%"},
          [](Options & o) -> auto& { return o.min_power; })
      .add(
          {.name = "gamma",
           .meaning = "exponent of the darkness of a picture",
           .example = "1",
           .range = within(0.1, 10)},
          [](Options & o) -> auto& { return o.gamma; })
      .add(
          {.name = "negative", .meaning = "picture in negative: white is burnt instead of black"},
          [](Options & o) -> auto& { return o.negative; }, Names<bool>{{"no", false}, {"yes", true}});
  return row_of({.name = "laser-picture",
                 .sentence = "Burn a picture by lines.",
                 .cuts = "a PNG file, or rows of digits from 0, white, to 9, black",
                 .input = CutInput::picture,
                 .example = {.shapes = "[[shape]]                 # or picture = \"photo.png\"\n"
                                       "pixels = [\"00000000\", \"03777300\", \"07999730\", \"03777370\", "
                                       "\"00037770\", \"00000000\"]\n"
                                       "picture-width = 40        # mm\n"
                                       "at = [0, 0]               # lower left corner\n\n"},
                 .order = 1,
                 .laser = true},
                keys, pictured);
}

struct GridOptions : LaserTestOptions {
  int columns = 1, rows = 1;
  std::optional<double> power_to;  ///< of the last column; nothing: as the first
  Feed feed_to{};                  ///< of the last row; 0: as the first
};

CutRow test_row() {
  using Options = GridOptions;
  Keys<Options> keys;
  const auto count = [](std::string_view name, std::string_view meaning) {
    return CutKeyText{.name = name, .meaning = meaning, .example = "5", .range = within(1, 1000)};
  };
  const auto size = [](std::string_view name, std::string_view meaning, std::string_view example) {
    return CutKeyText{.name = name, .meaning = meaning, .example = example, .range = at_least(0)};
  };
  // Without shapes: only a name.
  keys.name();
  scan_keys(beam_keys(keys))
      .add(
          count("rows", "rows of a test grid, from feed at the top to feed-to"),
          [](Options & o) -> auto& { return o.rows; })
      .add(
          size("feed-to", "feed of the last row of a test grid; 0: as feed", "400"),
          [](Options & o) -> auto& { return o.feed_to; })
      .add(
          count("columns", "columns of a test grid, from power on the left to power-to"),
          [](Options & o) -> auto& { return o.columns; })
      .add(
          {.name = "power-to",
           .meaning = "power of the last column of a test grid",
           .example = "20",
           .range = within(0, 100),
           .otherwise = "as power",
           .unit = "%"},
          [](Options & o) -> auto& { return o.power_to; })
      .add(
          {.name = "cell-width",
           .meaning = "width of a cell of a test grid",
           .example = "10",
           .range = above(0)},
          [](Options & o) -> auto& { return o.cell_width; })
      .add(
          size("cell-height", "height of a cell of a test grid; 0: a cell is one line", "10"),
          [](Options & o) -> auto& { return o.cell_height; })
      .add(
          size("gap", "between the cells of a test grid", "4"), [](Options & o) -> auto& { return o.gap; })
      .add(
          size("label-height", "height of the feeds and powers beside a test grid; 0: none", "3"),
          [](Options & o) -> auto& { return o.label_height; });
  return row_of({.name = "laser-test",
                 .sentence = "Burn a grid of cells with increasing power and speed.",
                 .input = CutInput::nothing,
                 .order = 1,
                 .laser = true},
                keys, [](Options o, const CutWork&, Diagnostics& d) {
                  const auto between = [](double from, double to, int i, int n) {
                    return n > 1 ? from + (to - from) * i / (n - 1) : from;
                  };
                  const double power = o.laser.power, feed = o.laser.feed.mm_per_min();
                  const double feed_to = o.feed_to != Feed{} ? o.feed_to.mm_per_min() : feed;
                  for (int i = 0; i < o.columns; ++i)
                    o.powers.push_back(between(power, o.power_to.value_or(power), i, o.columns));
                  for (int i = 0; i < o.rows; ++i)
                    o.feeds.push_back(mm_per_min(between(feed, feed_to, i, o.rows)));
                  return laser_test(o, d);
                });
}

struct FrameOptions {
  LaserOptions laser{.power = 0.0};
};

/// Around all that is selected.
Box2 box_of(const CutWork& work) {
  Box2 box;
  for (const Outline& outline : work.outlines()) box.add(bounds(outline));
  for (const Point2 point : work.points) box.add(point);
  for (const auto& placed : work.pictures) {
    const double width = placed->width.mm();
    const double height = width * placed->picture.height / placed->picture.width;
    box.add(Box2{placed->at, placed->at + Point2{width, height}});
  }
  return box;
}

CutRow frame_row() {
  using Options = FrameOptions;
  Keys<Options> keys;
  beam_keys(keys.selection(), false);
  return row_of({.name = "laser-frame",
                 .sentence = "Move around shapes, to show where the work will be.",
                 .cuts = "the shapes",
                 .input = CutInput::shapes,
                 .example = {.shapes = kPlateShapes},
                 .laser = true},
                keys, [](const Options& o, const CutWork& work, Diagnostics& d) {
                  return laser_frame(box_of(work), o.laser, d);
                });
}

}  // namespace

std::vector<CutRow> laser_rows() {
  return {laser_row(), cut_row(), fill_row(), picture_row(), test_row(), frame_row()};
}

}  // namespace kerf::op_detail
