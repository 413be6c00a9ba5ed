// kerf level: writes a program that measures the heights of a grid over a part.
#include <algorithm>
#include <fmt/format.h>
#include <memory>

#include "app/commands/commands.h"
#include "app/options/common.h"
#include "app/options/program_options.h"
#include "base/codes/files.h"
#include "base/codes/gcode.h"
#include "base/codes/pathdxf.h"
#include "base/number.h"
#include "job/heights.h"
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

Status run(Console& console, const Options& options) {
  Diagnostics diagnostics;
  const auto target = find_post_target(options.to);
  if (!target || !target->profile) {
    diagnostics.error(codes::post_unknown, CallLocation{"", 0, "--to"},
                      fmt::format("there is no post \"{}\"", options.to.substr(0, 60)));
    return fail(console, diagnostics, Status::wrong_usage);
  }
  const auto program = load_program(options.file, read_reading_options(options.reading), diagnostics);
  if (!program || diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  const Box3 cuts = report_on(program->path, {}).all.cut_bounds;
  if (cuts.empty()) {
    diagnostics.error(codes::nothing_to_cut, TextLocation{program->source, 0, 0},
                      "the program has no cuts over which heights could be measured");
    return fail(console, diagnostics, Status::input_errors);
  }
  if (2.0 * options.margin <= -std::min(cuts.high.x - cuts.low.x, cuts.high.y - cuts.low.y)) {
    diagnostics
        .error(codes::level_map, TextLocation{program->source, 0, 0},
               fmt::format("--margin {} leaves no area of the cuts, which are {} x {} mm",
                           number_text(options.margin, 3), number_text(cuts.high.x - cuts.low.x, 3),
                           number_text(cuts.high.y - cuts.low.y, 3)))
        .hint = "specify a positive margin, so that there are points beside the cuts";
    return fail(console, diagnostics, Status::input_errors);
  }
  if (program->stock && program->stock->block.high.z != 0.0)
    diagnostics
        .warning(codes::heights_unmatched, TextLocation{program->source, 0, 0},
                 fmt::format("the top of the material is at Z{}, but heights are measured around Z0",
                             number_text(program->stock->block.high.z, 3)))
        .hint = "set the work zero to the top of the material while the heights are measured";
  const GridSize size = *parse_grid(options.grid);
  ProbingGrid grid;
  grid.columns = size.columns;
  grid.rows = size.rows;
  grid.area.add(Point2{cuts.low.x - options.margin, cuts.low.y - options.margin});
  grid.area.add(Point2{cuts.high.x + options.margin, cuts.high.y + options.margin});
  grid.clearance = mm(options.clearance);
  grid.depth = mm(options.depth);
  grid.feed = mm_per_min(options.feed);
  Program probing;
  probing.source = program->source;
  probing.path = probing_program(grid);
  const auto files = post_program(probing, *target, {}, diagnostics);
  if (diagnostics.has_errors() || files.empty()) return fail(console, diagnostics, Status::input_errors);
  if (options.out.empty()) {
    console.show(diagnostics, Console::Channel::always_text);
    console.print_json(files.front().text);
    return Status::done;
  }
  OutputSet set;
  if (!set.write(options.out, files.front().text, diagnostics) || !set.commit(diagnostics))
    return fail(console, diagnostics, Status::input_errors);
  console.show(diagnostics);
  if (console.json())
    console.print_json(text_of(Record{{"outputs", {options.out}},
                                      {"columns", grid.columns},
                                      {"rows", grid.rows},
                                      {"diagnostics", record_of(diagnostics)}},
                               Layout::indented));
  else
    console.summary(fmt::format("wrote    {} ({} points, X {} to {}, Y {} to {})", options.out,
                                grid.columns * grid.rows, number_text(grid.area.low.x, 3),
                                number_text(grid.area.high.x, 3), number_text(grid.area.low.y, 3),
                                number_text(grid.area.high.y, 3)));
  return Status::done;
}

const char* const kExamples =
    R"(  kerf level --grid 5x4 --over part.nc -o probe.nc       5 columns, 4 rows over the cuts of part.nc
  kerf level --grid 5x4 --over part.nc --to linuxcnc -o probe.ngc
  kerf post --level log.txt --to grbl part.nc -o out.nc  after measuring: log.txt is the saved console log

The work zero is on the surface when the program starts. Each point is approached at --clearance above it and
measured with G38.2.
)";

}  // namespace

Command add_level(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser = new_command(root, "level", "Write a program that measures heights over a part",
                                     kExamples, options->output);
  parser.add_text("--over", options->file, "The program whose cuts are covered")
      .value_name("FILE")
      .required();
  parser.add_text("--grid", options->grid, "Columns and rows of the grid (default: 5x5)")
      .value_name("NxM")
      .check([](const std::string& text) {
        return parse_grid(text) ? std::string()
                                : fmt::format("expected columns x rows, each 2 to {}: 5x4", kMaxLines);
      });
  parser.add_text("--to", options->to, "The controller: a name from kerf post --list (default: grbl)")
      .value_name("POST");
  parser.add_text("-o,--output", options->out, "The file to write (default: standard output)")
      .value_name("PATH");
  add_length(parser, "--margin", options->margin, -1e4, 1e4, "Margin around the cuts");
  add_length(parser, "--clearance", options->clearance, 1e-3, 1e3, "Height of rapids (default: 5)");
  add_length(parser, "--depth", options->depth, 1e-3, 1e3, "Depth where probing ends (default: 2)");
  add_number(parser, "--feed", options->feed, 1e-3, 1e5, "MM/MIN", "Feed of probing (default: 50)");
  add_reading_options(parser, options->reading);
  return {parser, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app
