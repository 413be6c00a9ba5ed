// A run: from a drawing's name to programs.
#include "base/codes/pathdxf.h"

#include <fmt/format.h>
#include <map>

#include "base/file_names.h"
#include "base/names.h"
#include "front/pathdxf/compile/compile.h"
#include "front/pathdxf/model/library.h"
#include "front/pathdxf/pathdxf.h"

namespace kerf {
namespace {

using namespace pathdxf;

constexpr std::size_t kMaxChecked = 10;  // largest paths that one run checks

constexpr Bilingual kNoPath{"DXF file {} contains no error-free path layer",
                            "DXF-Datei {} enthält keinen fehlerfreien Pfad-Layer"};
constexpr Bilingual kNoPathHint{
    "elements are on layers named like the path, e.g. 8001.1P or 8001_1P (expression {}); kerf cut makes a "
    "program of other drawings",
    "Elemente liegen auf Layern mit dem Namen des Pfades, z.B. 8001.1P oder 8001_1P (Ausdruck {})"};
constexpr Bilingual kTwoPaths{"DXF file {} contains more than one path layer: {}",
                              "DXF-Datei {} enthält mehr als einen Pfad-Layer: {}"};
constexpr Bilingual kTwoPathsHint{
    "a program is made of one path: move the others to files of their own; kerf pathdxf /c checks all",
    "Ein Programm entsteht aus einem Pfad: die anderen in eigene Dateien; kerf pathdxf /c prüft alle"};
constexpr Bilingual kTooMuchToCheck{"the paths make more than {} steps; those from {} on are not checked",
                                    "Die Pfade haben mehr als {} Schritte; ab {} wird nicht geprüft"};
constexpr Bilingual kChecking{"Checking {}", "Prüfe {}"};
constexpr Bilingual kNoSegments{"No segments found", "Keine Segmente gefunden"};

PathdxfProgram program_of(Compiled compiled, const Path& path, const Report& report) {
  PathdxfProgram out;
  out.path = path.name;
  out.suffix = path.suffix;
  out.milling = std::move(compiled.milling);
  out.probing = std::move(compiled.probing);
  for (const PlacedProbe& p : compiled.probes)
    out.probes.push_back({p.name, p.label, p.at, p.drawn, mm(p.thickness)});
  out.start = path.start;
  out.tool_diameter = mm(path.tool);
  out.thickness = mm(path.top);
  out.rapid_height = mm(path.sweep);
  out.material = path.material;
  out.top = mm(compiled.top);
  out.is_empty = compiled.is_empty;
  out.statistics = statistics_lines(compiled.statistics, report);
  return out;
}

class Run {
 public:
  Run(const PathdxfOptions& options, Report& report, Library& library, Progress* progress)
      : options_(options), report_(report), library_(library), builder_(library), progress_(progress) {}

  void compile(const std::string& file, PathdxfRun& out) {
    const DrawingPaths& drawing = library_.load(file);
    if (!drawing.usable) return;
    const Origin whole = TextLocation{drawing.file, 0, 0};
    const bool checks = options_.selection == PathdxfSelection::check_all;
    std::vector<const PathDrawing*> usable;
    for (const PathDrawing& path : drawing.paths)
      if (path.usable) usable.push_back(&path);
    if (usable.empty()) {
      report_.error(codes::pathdxf_layer, whole, kNoPath, drawing.file_name);
      if (drawing.paths.empty()) report_.hint(kNoPathHint, library_.names().expression());
      return;
    }
    if (!checks && usable.size() > 1) {
      std::vector<std::string> names;
      for (const PathDrawing* path : usable) names.push_back(path->name);
      report_.error(codes::pathdxf_layer, whole, kTwoPaths, drawing.file_name, joined(names, ", "));
      report_.hint(kTwoPathsHint);
      return;
    }
    const std::size_t max_steps = kMaxChecked * options_.max_steps;
    for (const PathDrawing* path : usable) {
      if (steps_ > max_steps) {
        report_.error(codes::pathdxf_limit, drawing.origin(*path), kTooMuchToCheck, max_steps, path->name);
        return;
      }
      compile({&drawing, path}, checks, out);
    }
  }

 private:
  void compile(const Library::Found& found, bool checks, PathdxfRun& out) {
    if (checks) report_.line(kChecking, found.path->name);
    const std::size_t before = report_.attempts();
    const auto path = builder_.build(found, checks ? PathRole::checked : PathRole::main,
                                     checks ? example_values(found) : main_values(found, options_, report_));
    // An error anywhere, e.g. in a text that no element took, makes the path incomplete.
    if (!path || (!checks && report_.errors() > 0) || report_.attempts() != before) return;
    Compiled compiled = pathdxf::compile(*path, options_, report_, progress_);
    if (compiled.is_empty)
      report_.error(codes::pathdxf_no_segments, TextLocation{found.drawing->file, 0, 0}, kNoSegments);
    steps_ += compiled.milling.size();
    // Of the paths checked only the first is drawn on a sheet.
    if (checks && !out.programs.empty()) compiled.milling = Toolpath();
    out.programs.push_back(program_of(std::move(compiled), *path, report_));
  }

  const PathdxfOptions& options_;
  Report& report_;
  Library& library_;
  PathBuilder builder_;
  std::size_t steps_ = 0;  // of all paths
  Progress* progress_;
};

}  // namespace

PathdxfRun compile_pathdxf(const std::string& file, const PathdxfOptions& options, Diagnostics& diagnostics,
                           Progress* progress) {
  PathdxfRun out;
  Report report(options, diagnostics);
  auto names = PathNames::make(options, report);
  auto restrictions = restrictions_of(options, report);
  if (names && restrictions) {
    Library library(std::move(*names), std::move(*restrictions), options, report);
    Run(options, report, library, progress).compile(file, out);
    out.files = library.files();
  }
  return out;
}

std::string pathdxf_probe_list(const PathdxfProgram& program) {
  const auto point = [](Point2 p) { return fmt::format("[{} {}]", number_text3(p.x), number_text3(p.y)); };
  const auto label = [](const PathdxfProbe& p) {
    return fmt::format("{}/T={}", p.label.empty() ? "" : "/L:" + p.label, number_text3(p.height.mm()));
  };
  // Embeddings of one path have probes of the same position in its drawing: those lines name the position of
  // the workpiece as well.
  std::map<std::string, int> same;
  for (const PathdxfProbe& p : program.probes) ++same[point(p.drawn) + label(p)];
  std::string text;
  for (const PathdxfProbe& p : program.probes) {
    const bool is_repeated = same[point(p.drawn) + label(p)] > 1;
    text += fmt::format("({}{}{}) {}=\n", point(p.drawn), is_repeated ? "/at " + point(p.at) : "", label(p),
                        p.name);
  }
  return text;
}

std::string pathdxf_line(const Diagnostic& d) {
  if (const auto* at = std::get_if<DrawingLocation>(&d.where)) {
    std::string path = at->layer.substr(0, at->layer.find('~'));
    for (char& c : path)
      if (c == '_') c = '.';
    const std::string in_file = fmt::format("{}[{}]", clipped(path), name_in_folder(at->file));
    if (at->entity.empty()) return one_line(fmt::format("{}: {}", in_file, d.message));
    return one_line(
        fmt::format("{} @ [{:.3f} {:.3f}] # {}: {}", at->entity, at->x, at->y, in_file, d.message));
  }
  const std::string where = to_string(d.where);
  return one_line((where.empty() ? "Options" : where) + ": " + d.message);
}

}  // namespace kerf
