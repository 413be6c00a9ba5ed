// kerf outline: rounds the inside corners of outlines for a router bit and draws the changes. The outlines
// are from a JSON file or a Python script; for drawings see outline_drawing.h.
#include <fmt/format.h>
#include <memory>

#include "app/commands/commands.h"
#include "app/commands/outline_drawing.h"
#include "app/options/common.h"
#include "app/report/sent_files.h"
#include "back/drawing/outline_drawing.h"
#include "base/codes/files.h"
#include "base/file_names.h"
#include "job/record/record.h"

#include "kerf/base/files.h"
#include "kerf/drawing/drawing_files.h"
#include "kerf/job/program.h"

namespace kerf::app {
namespace {

struct Options {
  OutputOptions output;
  std::string file, svg, dxf;
  bool fair = false;
  DrawingOptions drawing;
};

struct Result {
  std::vector<std::string> names;
  std::vector<CutPair> pairs;
};

Result cut_all(const std::vector<NamedOutline>& outlines, const Options& options, Diagnostics& diagnostics) {
  Result result;
  for (const NamedOutline& named : outlines) {
    CornerOptions how;
    how.name = named.name;
    how.where = TextLocation{options.file, 0, 0};
    how.sharing = options.fair ? EdgeSharing::even : EdgeSharing::in_order;
    auto cut = cut_corners(named.outline, named.corners, how, diagnostics);
    if (!cut) continue;
    result.names.push_back(named.name);
    result.pairs.push_back({named.outline, std::move(*cut)});
  }
  return result;
}

Record outline_record(const std::string& name, const CutPair& pair) {
  Record out{{"name", name}, {"closed", pair.cut.outline.closed()}};
  out["first"] = Record{{"at", record_of(pair.cut.outline.start)}};
  Record& segments = out["segments"] = Record::array();
  for (const Segment& s : pair.cut.outline.segments) {
    Record segment{{"to", record_of(s.to)}};
    if (s.via) segment["via"] = record_of(*s.via);
    segments.push_back(segment);
  }
  Record& corners = out["corners"] = Record::array();
  for (const CornerReport& r : pair.cut.corners) {
    Record corner{{"element", r.element}, {"outcome", to_string(r.outcome)}};
    if (r.outcome == CornerOutcome::sharp) {
      corner["reason"] = to_string(r.reason);
      corner["largest_mm"] = record_of(r.largest.mm());
    }
    corners.push_back(corner);
  }
  return out;
}

void show_result(Console& console, const Options& options, const Result& result,
                 const Diagnostics& diagnostics) {
  console.show(diagnostics);
  std::vector<std::string> outputs;
  for (const std::string& path : {options.svg, options.dxf})
    if (!path.empty() && !diagnostics.has_errors()) outputs.push_back(path);
  if (console.json()) {
    Record outlines = Record::array();
    for (std::size_t i = 0; i < result.pairs.size(); ++i)
      outlines.push_back(outline_record(result.names[i], result.pairs[i]));
    const Record out{{"source", options.file},
                     {"unit", "mm"},
                     {"outlines", outlines},
                     {"outputs", outputs},
                     {"diagnostics", record_of(diagnostics)}};
    return console.print_json(text_of(out, Layout::indented));
  }
  for (std::size_t i = 0; i < result.pairs.size(); ++i) {
    int count[3] = {};
    for (const CornerReport& r : result.pairs[i].cut.corners) ++count[static_cast<int>(r.outcome)];
    console.summary(fmt::format("{}: {} segments; corners: {} smoothed, {} enlarged, {} left sharp",
                                result.names[i], result.pairs[i].cut.outline.segments.size(), count[0],
                                count[1], count[2]));
  }
  for (const std::string& path : outputs) console.summary("wrote " + path);
}

void write_files(Console& console, const Options& options, const Result& result, Diagnostics& diagnostics) {
  SentFiles set(console);
  bool written = true;
  if (!options.svg.empty()) {
    const std::string title = file_name_of(options.file);
    written = set.write(options.svg, write_svg(corner_picture(result.pairs, title)), diagnostics);
  }
  if (written && !options.dxf.empty()) {
    Drawing drawing;
    for (const CutPair& pair : result.pairs) draw(drawing, 0, pair.cut.outline, OutlineEntities::polyline);
    written = set.write(options.dxf, write_dxf(drawing), diagnostics);
  }
  if (written) set.commit(diagnostics);
}

Status run(Console& console, const Options& options, const std::vector<std::string>& drawing_only) {
  if (is_drawing(options.file))
    return run_drawing(console, options.file, options.svg, options.dxf, options.drawing);
  Diagnostics diagnostics;
  for (const std::string& name : drawing_only)
    diagnostics.warning(codes::option_unused, {}, name + " has an effect on DXF drawings only");
  const std::vector<NamedOutline> outlines = load_outlines(options.file, diagnostics);
  const Result result = cut_all(outlines, options, diagnostics);
  if (!diagnostics.has_errors()) write_files(console, options, result, diagnostics);
  show_result(console, options, result, diagnostics);
  return diagnostics.has_errors() ? Status::input_errors : Status::done;
}

const char* const kExamples = R"(  kerf outline plate.json --svg plate.svg
  kerf outline design.py --svg design.svg     the outlines that a script cuts with cnc25d_api
  kerf outline plate.json --json              the cut outlines and the result at each corner
  kerf outline part.dxf --list-layers         the layers of a drawing and their entities
  kerf outline part.dxf --layer CUT --json    the outlines of a layer; open ends with their coordinates
  kerf outline part.dxf --layer CUT --region --dxf clean.dxf
  kerf outline art.svg --unit px --dxf art.dxf

The picture shows the ideal outlines (dashed), the cut ones over them, and the router bit's circle at each
changed corner. A corner that cannot be cut stays sharp, with a warning that gives the reason.
)";

}  // namespace

Command add_outline(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser =
      new_command(root, "outline",
                  "Round the inside corners of outlines for a router bit; read outlines from DXF and SVG",
                  kExamples, options->output);
  parser
      .add_text("FILE", options->file,
                "Outlines as JSON, a Python script (.py) that cuts outlines, or a drawing (.dxf, .svg)")
      .required()
      .value_name("");
  add_other_output(parser, "--svg", options->svg, options->output, "Write the picture of the corners");
  add_other_output(parser, "--dxf", options->dxf, options->output,
                   "Write the cut outlines as polylines with arcs");
  parser.add_flag("--fair", options->fair,
                  "Divide an edge that is too short for both of its corners evenly (default: the first "
                  "corner has priority)");
  add_drawing_options(parser, options->drawing);
  return {parser, &options->output, [options, parser](Console& console) {
            return run(console, *options, given_drawing_options(parser));
          }};
}

}  // namespace kerf::app
