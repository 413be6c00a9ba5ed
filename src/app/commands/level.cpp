// kerf level: writes a program that measures the heights of a grid over a part, and shows what was measured.
#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <memory>

#include "app/commands/commands.h"
#include "app/options/common.h"
#include "app/options/map_options.h"
#include "app/options/output_options.h"
#include "app/options/program_options.h"
#include "base/codes/files.h"
#include "base/codes/gcode.h"
#include "base/codes/pathdxf.h"
#include "base/ending.h"
#include "base/file_names.h"
#include "base/names.h"
#include "base/number.h"
#include "job/height_picture.h"
#include "job/heights.h"
#include "job/probing.h"
#include "job/record/record.h"

#include "kerf/base/files.h"
#include "kerf/job/posting.h"
#include "kerf/path/report.h"

namespace kerf::app {
namespace {

constexpr int kMaxLines = 200;  // columns or rows

struct Options {
  OutputOptions output;
  std::string file, grid = "5x5", to = "grbl", out;
  std::string measured;  // --read
  MapOptions map;
  double margin = 0.0, clearance = 5.0, depth = 2.0, feed = 50.0;
  ReadingOptions reading;
};

struct GridSize {
  int columns = 0, rows = 0;
};

/// "5x4"
std::optional<GridSize> parse_grid(const std::string& text) {
  const std::size_t x = text.find_first_of("xX");
  if (x == std::string::npos) return std::nullopt;
  const auto columns = parse_number(text.substr(0, x)), rows = parse_number(text.substr(x + 1));
  const auto is_count = [](const std::optional<double>& n) {
    return n && *n >= 2.0 && *n <= kMaxLines && *n == static_cast<int>(*n);
  };
  if (!is_count(columns) || !is_count(rows)) return std::nullopt;
  return GridSize{static_cast<int>(*columns), static_cast<int>(*rows)};
}

/// Warnings of programs over which a grid may not be measured as the user expects; false with errors.
bool check_program(const Program& program, const Box3& cuts, const Options& options,
                   Diagnostics& diagnostics) {
  const TextLocation where{program.source, 0, 0};
  if (cuts.empty()) {
    diagnostics.error(codes::nothing_to_cut, where,
                      "the program has no cuts over which heights could be measured");
    return false;
  }
  if (2.0 * options.margin <= -std::min(cuts.high.x - cuts.low.x, cuts.high.y - cuts.low.y)) {
    diagnostics
        .error(codes::level_map, where,
               fmt::format("--margin {} leaves no area of the cuts, which are {} x {} mm",
                           number_text(options.margin, 3), number_text(cuts.high.x - cuts.low.x, 3),
                           number_text(cuts.high.y - cuts.low.y, 3)))
        .hint = "specify a positive margin, so that there are points beside the cuts";
    return false;
  }
  if (program.stock && program.stock->block.high.z != 0.0)
    diagnostics
        .warning(codes::heights_unmatched, where,
                 fmt::format("the top of the material is at Z{}, but heights are measured around Z0",
                             number_text(program.stock->block.high.z, 3)))
        .hint = "set the work zero to the top of the material while the heights are measured";
  return true;
}

/// The name of a file without folder and ending.
std::string title_of(const std::string& path) {
  const std::string name = name_in_folder(path);
  return name.empty() ? "heights" : name.substr(0, std::max<std::size_t>(name.rfind('.'), 1));
}

bool write_file(const std::string& path, const std::string& text, std::vector<std::string> inputs,
                Diagnostics& diagnostics) {
  OutputSet set(std::move(inputs));
  return set.write(path, text, diagnostics) && set.commit(diagnostics);
}

Status write_program(Console& console, const Options& options) {
  Diagnostics diagnostics;
  const auto target = post_named(options.to, diagnostics);
  if (target && !target->profile)
    diagnostics.error(codes::post_unknown, CallLocation{"", 0, "--to"},
                      fmt::format("{} is no controller, and cannot probe", options.to));
  if (const std::string ending = ending_of(options.out); ending == ".png" || ending == ".svg")
    diagnostics
        .error(codes::output_kind_unknown, CallLocation{"", 0, "-o"},
               fmt::format("{} is for pictures of heights, with --read; a program that measures is G-code",
                           ending))
        .hint = "use an ending of the controller's programs, such as .nc";
  if (diagnostics.has_errors()) return fail(console, diagnostics, Status::wrong_usage);
  const auto program = load_program(options.file, read_reading_options(options.reading), diagnostics);
  if (!program || diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  const Box3 cuts = report_on(program->path, {}).all.cut_bounds;
  if (!check_program(*program, cuts, options, diagnostics))
    return fail(console, diagnostics, Status::input_errors);
  const GridSize size = *parse_grid(options.grid);
  ProbingGrid grid;
  grid.columns = size.columns;
  grid.rows = size.rows;
  grid.area.add(Point2{cuts.low.x - options.margin, cuts.low.y - options.margin});
  grid.area.add(Point2{cuts.high.x + options.margin, cuts.high.y + options.margin});
  grid.clearance = mm(options.clearance);
  grid.depth = mm(options.depth);
  grid.feed = mm_per_min(options.feed);
  const auto probing = write_probing(grid, *target, title_of(options.out), diagnostics);
  if (!probing) return fail(console, diagnostics, Status::input_errors);
  if (options.out.empty()) {
    console.show(diagnostics, Console::Channel::always_text);
    console.print_json(probing->text);
    return Status::done;
  }
  if (!write_file(options.out, probing->text, {options.file}, diagnostics))
    return fail(console, diagnostics, Status::input_errors);
  console.show(diagnostics);
  if (console.json()) {
    console.print_json(text_of(Record{{"outputs", {options.out}},
                                      {"columns", grid.columns},
                                      {"rows", grid.rows},
                                      {"seconds", probing_time(grid).seconds()},
                                      {"result", probing->result},
                                      {"diagnostics", record_of(diagnostics)}},
                               Layout::indented));
    return Status::done;
  }
  console.summary(fmt::format(
      "wrote    {} ({} points, X {} to {}, Y {} to {}, about {} min)", options.out, grid.columns * grid.rows,
      number_text(grid.area.low.x, 3), number_text(grid.area.high.x, 3), number_text(grid.area.low.y, 3),
      number_text(grid.area.high.y, 3), number_text(probing_time(grid).seconds() / 60.0, 1)));
  if (!probing->result.empty()) console.summary("then     " + probing->result);
  return Status::done;
}

/// The points as lines "x y z".
std::string lines_of(const std::vector<Point3>& points) {
  std::string out;
  for (const Point3& p : points)
    out += fmt::format("{} {} {}\n", fixed_text(p.x, 4), fixed_text(p.y, 4), fixed_text(p.z, 4));
  return out;
}

/// False, with an error, for an output of another form than those that are written.
bool check_ending(const std::string& out, Diagnostics& usage) {
  constexpr std::array<std::string_view, 4> kEndings{".png", ".svg", ".txt", ".xyz"};
  const std::string ending = ending_of(out);
  if (out.empty() || ending.empty() || std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end())
    return true;
  usage
      .error(codes::output_kind_unknown, CallLocation{"", 0, "-o"},
             fmt::format("{} is no form of measured heights; possible endings are {}", ending,
                         joined(kEndings, ", ")))
      .hint = ".png and .svg are pictures, the others lines x y z";
  return false;
}

Status show_measured(Console& console, const Options& options) {
  Diagnostics diagnostics;
  if (!check_ending(options.out, diagnostics)) return fail(console, diagnostics, Status::wrong_usage);
  const auto surface =
      read_surface(options.measured, surface_reading(options.map, options.reading.work_offset), diagnostics);
  if (!surface) return fail(console, diagnostics, Status::input_errors);
  if (console.sends_output()) {
    console.show(diagnostics);
    console.print_json(lines_of(surface->points));
    return Status::done;
  }
  if (!options.out.empty()) {
    const std::string ending = ending_of(options.out);
    const std::string bytes = ending == ".png"   ? height_png(*surface)
                              : ending == ".svg" ? height_svg(*surface)
                                                 : lines_of(surface->points);
    if (!write_file(options.out, bytes, {options.measured}, diagnostics))
      return fail(console, diagnostics, Status::input_errors);
  }
  const auto [low, high] = std::minmax_element(surface->points.begin(), surface->points.end(),
                                               [](const Point3& a, const Point3& b) { return a.z < b.z; });
  double mean = 0.0;
  for (const Point3& p : surface->points) mean += p.z / static_cast<double>(surface->points.size());
  const Box2& area = surface->map.bounds();
  console.show(diagnostics);
  if (console.json()) {
    Record outliers = Record::array();
    for (const std::size_t i : surface->outliers) {
      const Point3& p = surface->points[i];
      outliers.push_back(Record{p.x, p.y, p.z});
    }
    console.print_json(text_of(Record{{"points", surface->points.size()},
                                      {"low", {area.low.x, area.low.y}},
                                      {"high", {area.high.x, area.high.y}},
                                      {"lowest", low->z},
                                      {"highest", high->z},
                                      {"mean", mean},
                                      {"outliers", std::move(outliers)},
                                      {"diagnostics", record_of(diagnostics)}},
                               Layout::indented));
    return Status::done;
  }
  console.summary(fmt::format("heights  {} points, X {} to {}, Y {} to {}", surface->points.size(),
                              number_text(area.low.x, 3), number_text(area.high.x, 3),
                              number_text(area.low.y, 3), number_text(area.high.y, 3)));
  console.summary(fmt::format("         {} at {}, {} to {} at {}, {}; mean {}", fixed_text(low->z, 3),
                              number_text(low->x, 3), number_text(low->y, 3), fixed_text(high->z, 3),
                              number_text(high->x, 3), number_text(high->y, 3), fixed_text(mean, 3)));
  if (!options.out.empty()) console.summary("wrote    " + options.out);
  return Status::done;
}

Status run(Console& console, const Options& options) {
  if (!options.measured.empty()) return show_measured(console, options);
  if (!options.file.empty()) return write_program(console, options);
  Diagnostics diagnostics;
  diagnostics.error(codes::file_unreadable, CallLocation{"", 0, "--over"},
                    "specify the program to be covered with --over, or a file of heights with --read");
  return fail(console, diagnostics, Status::wrong_usage);
}

const char* const kExamples =
    R"(  kerf level --grid 5x4 --over part.nc -o probe.nc       5 columns, 4 rows over the cuts of part.nc
  kerf level --grid 5x4 --over part.nc --to linuxcnc -o probe.ngc
  kerf level --read log.txt -o map.png                   what was measured: log.txt is the saved console log
  kerf post --level log.txt --to grbl part.nc -o out.nc  the program follows the measured surface

The work zero is on the surface when the program starts. Each point is approached at --clearance above it and
measured with G38.2.
)";

}  // namespace

Command add_level(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser = new_command(root, "level", "Measure heights over a part, and show what was measured",
                                     kExamples, options->output);
  const Option over =
      parser.add_text("--over", options->file, "The program whose cuts are covered").value_name("FILE");
  parser.add_text("--read", options->measured, "Show what was measured: a log, or another file of heights")
      .value_name("FILE")
      .excludes(over);
  parser.add_text("--grid", options->grid, "Columns and rows of the grid (default: 5x5)")
      .value_name("NxM")
      .check([](const std::string& text) {
        return parse_grid(text) ? std::string()
                                : fmt::format("expected columns x rows, each 2 to {}: 5x4", kMaxLines);
      });
  parser.add_text("--to", options->to, "The controller: a name from kerf post --list (default: grbl)")
      .value_name("POST");
  add_output(
      parser, options->out, options->output,
      "The program (default: -, standard output); with --read a picture (.png, .svg) or lines x y z (.txt, "
      ".xyz)");
  add_length(parser, "--margin", options->margin, -1e4, 1e4, "Margin around the cuts");
  add_length(parser, "--clearance", options->clearance, 1e-3, 1e3, "Height of rapids (default: 5)");
  add_length(parser, "--depth", options->depth, 1e-3, 1e3, "Depth where probing ends (default: 2)");
  add_feed(parser, "--feed", options->feed, 1e-3, 1e5, "Feed of probing (default: 50)");
  add_map_options(parser, options->map);
  add_reading_options(parser, options->reading);
  return {parser, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app
