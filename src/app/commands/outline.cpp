// kerf outline: cuts the corners of outlines from a JSON file or a Python script, and draws what changed.
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <unistd.h>

#include "app/options/command.h"
#include "app/report/json.h"
#include "job/python_script.h"

#include "kerf/drawing_files.h"
#include "kerf/files.h"
#include "kerf/outline_drawing.h"
#include "kerf/outline_files.h"

namespace kerf::app {
namespace {

struct Options {
  OutputOptions output;
  std::string file, svg, dxf;
  bool fair = false;
};

/// A file name that does not exist yet, removed again in the end.
class TemporaryFile {
 public:
  TemporaryFile() {
    std::string name = (std::filesystem::temp_directory_path() / "kerf-outlines-XXXXXX").string();
    const int handle = mkstemp(name.data());
    if (handle < 0) return;
    close(handle);
    path_ = name;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove(path_, ignored);
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Runs a script and takes the outlines that it cuts with cnc25d_api.
std::vector<NamedOutline> outlines_of_script(const std::string& script, Diagnostics& diagnostics) {
  const TemporaryFile noted;
  const auto fail = [&](const std::string& message) {
    diagnostics.error(Code::script_failed, TextSpot{script, 0, 0}, message);
    return std::vector<NamedOutline>();
  };
  if (noted.path().empty()) return fail("no temporary file can be made");
  if (!InputFile::open(script, diagnostics)) return {};
  const int status = run_python(script, {{"KERF_OUTLINES", noted.path()}}, diagnostics);
  if (status < 0) return {};
  if (status != 0) return fail(fmt::format("the script ended with status {}", status));
  const auto file = InputFile::open(noted.path(), diagnostics);
  if (!file) return {};
  if (file->bytes().empty()) return fail("the script cut no outline with cnc25d_api.cnc_cut_outline()");
  return read_outline_file(file->bytes(), script, diagnostics);
}

std::vector<NamedOutline> read_outlines(const std::string& name, Diagnostics& diagnostics) {
  if (name.ends_with(".py")) return outlines_of_script(name, diagnostics);
  const auto file = InputFile::open(name, diagnostics);
  return file ? read_outline_file(file->bytes(), name, diagnostics) : std::vector<NamedOutline>();
}

struct Result {
  std::vector<std::string> names;
  std::vector<CutPair> pairs;
};

Result cut_all(const std::vector<NamedOutline>& outlines, const Options& options, Diagnostics& diagnostics) {
  Result result;
  for (const NamedOutline& named : outlines) {
    CornerOptions how;
    how.name = named.name;
    how.where = TextSpot{options.file, 0, 0};
    how.sharing = options.fair ? EdgeSharing::even : EdgeSharing::in_order;
    auto cut = cut_corners(named.outline, how, diagnostics);
    if (!cut) continue;
    result.names.push_back(named.name);
    result.pairs.push_back({named.outline, std::move(*cut)});
  }
  return result;
}

Json point_json(Point2 p) { return Json::array({json_of(p.x), json_of(p.y)}); }

Json outline_json(const std::string& name, const CutPair& pair) {
  Json out{{"name", name}, {"closed", pair.cut.outline.closed()}};
  out["first"] = Json{{"at", point_json(pair.cut.outline.start)}};
  Json& segments = out["segments"] = Json::array();
  for (const Segment& s : pair.cut.outline.segments) {
    Json segment{{"to", point_json(s.to)}};
    if (s.via) segment["via"] = point_json(*s.via);
    segments.push_back(segment);
  }
  Json& corners = out["corners"] = Json::array();
  for (const CornerReport& r : pair.cut.corners) {
    Json corner{{"element", r.element}, {"outcome", to_string(r.outcome)}};
    if (r.outcome == CornerOutcome::sharp) {
      corner["reason"] = to_string(r.reason);
      corner["largest_mm"] = json_of(r.largest.mm());
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
    Json outlines = Json::array();
    for (std::size_t i = 0; i < result.pairs.size(); ++i)
      outlines.push_back(outline_json(result.names[i], result.pairs[i]));
    const Json out{{"source", options.file},
                   {"unit", "mm"},
                   {"outlines", outlines},
                   {"outputs", outputs},
                   {"diagnostics", json_of(diagnostics)}};
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

void write_files(const Options& options, const Result& result, Diagnostics& diagnostics) {
  OutputSet set;
  bool sound = true;
  if (!options.svg.empty()) {
    const std::string title = std::filesystem::path(options.file).filename().string();
    sound = set.write(options.svg, write_svg(corner_picture(result.pairs, title)), diagnostics);
  }
  if (sound && !options.dxf.empty()) {
    Drawing drawing;
    for (const CutPair& pair : result.pairs) draw(drawing, 0, pair.cut.outline, OutlineEntities::polyline);
    sound = set.write(options.dxf, write_dxf(drawing), diagnostics);
  }
  if (sound) set.commit(diagnostics);
}

Status run(Console& console, const Options& options) {
  Diagnostics diagnostics;
  const std::vector<NamedOutline> outlines = read_outlines(options.file, diagnostics);
  const Result result = cut_all(outlines, options, diagnostics);
  if (!diagnostics.has_errors()) write_files(options, result, diagnostics);
  show_result(console, options, result, diagnostics);
  return diagnostics.has_errors() ? Status::input_errors : Status::done;
}

const char* const kExamples = R"(  kerf outline plate.json --svg plate.svg
  kerf outline design.py --svg design.svg     the outlines that a script cuts with cnc25d_api
  kerf outline plate.json --json              the cut outlines and what became of each corner

The picture shows the ideal outlines (dashed), the cut ones over them, and the router bit's circle at each
changed corner. A corner that cannot be cut stays sharp, with a warning that says why.
)";

}  // namespace

Command add_outline(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser =
      new_command(root, "outline", "Make the corners of outlines millable, and draw what changed", kExamples,
                  options->output);
  parser.add_text("FILE", options->file, "Outlines as JSON, or a Python script (.py) that cuts outlines")
      .required()
      .value_name("");
  parser.add_text("--svg", options->svg, "Write the picture of the corners").value_name("PATH");
  parser.add_text("--dxf", options->dxf, "Write the cut outlines as polylines with arcs").value_name("PATH");
  parser.add_flag(
      "--fair", options->fair,
      "Share an edge that is too short for both of its corners evenly, instead of first come first served");
  return {parser, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app
