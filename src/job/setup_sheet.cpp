// The contents of a setup sheet.
#include "job/setup_sheet.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

#include "back/drawing/setup_plan.h"
#include "base/clock_text.h"
#include "base/codes/gcode.h"
#include "base/file_names.h"
#include "base/names.h"
#include "base/number.h"
#include "job/length_text.h"
#include "path/operation_times.h"

#include "kerf/path/report.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxOperations = 200, kMaxFindings = 60;  // rows; the program itself has them all
constexpr double kNoTime = 0.5;                                 // seconds; less is no operation of its own
constexpr double kSame = 1e-6;                                  // mm
constexpr std::size_t kMaxText = 200;                           // bytes of a user's text
const char* const kUnknown = "not known";

/// "left edge", "centre" or "right edge" of [low, high], or how far inside of it the zero is.
std::string edge_text(double low, double high, const char* low_name, const char* high_name,
                      const LengthText& lengths) {
  if (std::abs(low) <= kSame) return fmt::format("at the {} edge", low_name);
  if (std::abs(high) <= kSame) return fmt::format("at the {} edge", high_name);
  if (std::abs(low + high) <= kSame) return fmt::format("in the centre, {} to {}", low_name, high_name);
  return fmt::format("{} from the {} edge, {}", lengths.with_unit(std::abs(low), 3), low_name,
                     low < 0.0 ? "inside" : "outside");
}

std::string height_text(double low, double high, const LengthText& lengths) {
  if (std::abs(high) <= kSame) return "on top of the stock";
  if (std::abs(low) <= kSame) return "at the bottom of the stock";
  return fmt::format("{} {} the top of the stock", lengths.with_unit(std::abs(high), 3),
                     high > 0.0 ? "below" : "above");
}

class SheetWriter {
 public:
  SheetWriter(const Job& job, const SetupSheetOptions& options)
      : job_(job),
        times_(times_of(job, options.machine)),
        lengths_(options.unit ? (*options.unit == LengthUnit::inch ? ProgramUnits::inch : ProgramUnits::mm)
                              : job.program.units) {
    if (!times_.planned())
      times_.estimate.operations = operation_times(job.program.path, reported_seconds(job.program.path, {}));
    for (const OperationTime& o : times_.estimate.operations)
      if (o.tool || !o.name.empty() || o.time.total().seconds() >= kNoTime) operations_.push_back(o);
    if (job.bar)
      block_ = box_of(*job.bar);
    else if (job.stock)
      block_ = job.stock->block;
  }

  SetupSheet write(const std::vector<Finding>& findings, const Diagnostics& diagnostics) {
    const std::string& source = job_.program.source;
    sheet_.title =
        clipped(source.empty() || source == "-" ? "Setup sheet" : name_in_folder(source), kMaxText);
    add_facts();
    add_operations();
    draw_plan();
    add_tools();
    std::swap(sheet_.tables.front(), sheet_.tables.back());  // the tools first
    add_fixtures();
    add_findings(findings, diagnostics);
    sheet_.tables.erase(std::remove_if(sheet_.tables.begin(), sheet_.tables.end(),
                                       [](const SetupSheet::Table& table) { return table.rows.empty(); }),
                        sheet_.tables.end());
    return std::move(sheet_);
  }

 private:
  void add_facts();
  void add_stock_facts();
  void add_tools();
  void add_operations();
  void add_fixtures();
  void add_findings(const std::vector<Finding>& findings, const Diagnostics& diagnostics);
  void draw_plan();

  std::string box_text(const Box3& box) const {
    return fmt::format("X {} to {}, Y {} to {}, Z {} to {} {}", lengths_.of(box.low.x, 3),
                       lengths_.of(box.high.x, 3), lengths_.of(box.low.y, 3), lengths_.of(box.high.y, 3),
                       lengths_.of(box.low.z, 3), lengths_.of(box.high.z, 3), lengths_.unit());
  }
  std::string feed_text(const Range& feed) const {
    const double unit = lengths_.unit() == "mm" ? 1.0 : kMmPerInch;
    if (feed.empty()) return "none";
    const std::string low = number_text(feed.low / unit, 1), high = number_text(feed.high / unit, 1);
    return low == high ? low : fmt::format("{} to {}", low, high);
  }
  static std::string speed_text(const Range& speed) {
    if (speed.empty()) return "not given";
    const std::string low = number_text(speed.low, 0), high = number_text(speed.high, 0);
    return low == high ? low : fmt::format("{} to {}", low, high);
  }
  /// The figures of an operation.
  MotionFigures figures_of(std::size_t operation) const {
    ReportOptions section;
    section.first = operations_[operation].first_step;
    if (operation + 1 < operations_.size()) section.end = operations_[operation + 1].first_step;
    return report_on(job_.program.path, section).all;
  }

  const Job& job_;
  JobTimes times_;
  LengthText lengths_;
  std::vector<OperationTime> operations_;
  std::optional<Box3> block_;
  std::vector<SetupPlan::Mark> starts_;  // of the operations
  SetupSheet sheet_;
};

void SheetWriter::add_stock_facts() {
  const auto fact = [&](const char* name, std::string text) {
    sheet_.facts.emplace_back(name, std::move(text));
  };
  if (!block_) return fact("Stock", kUnknown);
  if (job_.bar)
    fact("Stock",
         fmt::format("round bar, diameter {}, X {} to {} {}", lengths_.with_unit(job_.bar->diameter, 3),
                     lengths_.of(job_.bar->x_low, 3), lengths_.of(job_.bar->x_high, 3), lengths_.unit()));
  else
    fact("Stock", fmt::format("{}{}", lengths_.size(block_->size()),
                              job_.stock_source == StockSource::assumed
                                  ? " (assumed around the cuts: the program states none)"
                                  : ""));
  const Box3& b = *block_;
  fact("Work zero",
       job_.bar ? fmt::format("axis of the bar at Y {}, Z {} {}", lengths_.of(job_.bar->axis_y, 3),
                              lengths_.of(job_.bar->axis_z, 3), lengths_.unit())
                : fmt::format("X0 {}; Y0 {}; Z0 {}", edge_text(b.low.x, b.high.x, "left", "right", lengths_),
                              edge_text(b.low.y, b.high.y, "front", "back", lengths_),
                              height_text(b.low.z, b.high.z, lengths_)));
  if (job_.spoilboard > Length())
    fact("Spoilboard", lengths_.with_unit(job_.spoilboard.mm(), 3) + " thick, may be cut into");
}

void SheetWriter::add_facts() {
  const auto fact = [&](const char* name, std::string text) {
    sheet_.facts.emplace_back(name, std::move(text));
  };
  fact("Units", lengths_.unit() == "mm" ? "mm, mm/min" : "inches, in/min");
  add_stock_facts();
  const MotionFigures& all = job_.report.all;
  fact("Cuts", all.cut_bounds.empty() ? "none" : box_text(all.cut_bounds));
  Box3 moves = all.cut_bounds;
  for_each_motion(job_.program.path, [&](const Step& s, const MotionContext&) {
    if (s.unknown_axes() == 0 && s.reference() != Reference::end_switches) moves.add(s.to());
  });
  if (!moves.empty()) fact("Motion", box_text(moves));
  const TimeFigures& time = times_.estimate.all;
  fact("Time", fmt::format("about {}, {}", clock_text(time.total().seconds()),
                           times_.planned() ? "planned for " + times_.machine
                                            : "by the feeds alone, without acceleration"));
  std::size_t changes = 0;
  for (const Step& s : job_.program.path.steps()) changes += s.kind() == StepKind::tool_change;
  fact("Tool changes", std::to_string(changes));
}

void SheetWriter::add_operations() {
  SetupSheet::Table table{"operations",
                          "Operations",
                          {{"No", 0.5},
                           {"Operation", 3.6},
                           {"Tool", 0.8},
                           {"Z from", 1},
                           {"Z to", 1},
                           {"Feed", 1.6},
                           {"Time", 1}},
                          {},
                          {}};
  std::optional<int> tool;
  std::size_t number = 0;
  for (std::size_t i = 0; i < operations_.size(); ++i) {
    const OperationTime& o = operations_[i];
    if (table.rows.size() >= kMaxOperations) {
      table.rows.push_back({fmt::format("... and {} more", operations_.size() - i)});
      break;
    }
    const MotionFigures figures = figures_of(i);
    if (o.tool && o.tool != tool) table.rows.push_back({fmt::format("Tool {}", *o.tool)});
    tool = o.tool;
    const bool cuts = !figures.cut_bounds.empty();
    const std::string label = std::to_string(++number);
    const double top =
        std::min(figures.cut_bounds.high.z, block_ ? block_->high.z : figures.cut_bounds.high.z);
    table.rows.push_back({label, o.name.empty() ? "(no name)" : clipped(o.name, kMaxText),
                          o.tool ? fmt::format("T{}", *o.tool) : "none",
                          cuts ? lengths_.of(top, 3) : "no cut",
                          cuts ? lengths_.of(figures.cut_bounds.low.z, 3) : "no cut", feed_text(figures.feed),
                          clock_text(o.time.total().seconds())});
    const auto first = [&]() -> std::optional<Point2> {
      const std::size_t end =
          i + 1 < operations_.size() ? operations_[i + 1].first_step : job_.program.path.size();
      for (std::size_t k = o.first_step; k < end; ++k)
        if (job_.program.path[k].is_cutting() && (job_.program.path[k].unknown_axes() & 3u) == 0)
          return job_.program.path[k].to().xy();
      return std::nullopt;
    }();
    if (first) starts_.push_back({*first, label});
  }
  sheet_.tables.push_back(std::move(table));
}

void SheetWriter::add_tools() {
  SetupSheet::Table table{"tools",
                          "Tools",
                          {{"Tool", 1.1},
                           {"Shape", 2},
                           {"Diameter", 1.1},
                           {"Flutes", 1},
                           {"Flute length", 1.5},
                           {"Stick-out, at least", 1.4},
                           {"Deepest Z", 1},
                           {"Spindle rpm", 1.3},
                           {"Feed", 1.6},
                           {"Time", 1}},
                          {},
                          {}};
  for (const ToolFigures& t : job_.report.tools) {
    const double seconds = times_.of_tool(t.tool).total().seconds();
    if (!t.tool && t.figures.cut_mm == 0.0 && seconds < kNoTime) continue;
    const Tool* tool = t.tool ? job_.tools.find(*t.tool) : nullptr;
    const bool assumed = t.tool && job_.tool_sources.at(*t.tool) == ToolSource::assumed;
    const bool known = tool != nullptr && !assumed;
    std::string flute = known ? lengths_.of(tool->flute.mm(), 3) : kUnknown;
    if (known && tool->flute_assumed) flute += " (assumed)";
    if (deeper_than_flute(job_, t)) flute += ", less than the cut";
    std::string flutes = known ? std::to_string(tool->teeth) : kUnknown;
    if (known && tool->teeth_assumed) flutes += " (assumed)";
    const bool reaches = t.deepest && block_ && !job_.bar && job_.stock_source != StockSource::assumed;
    table.rows.push_back({t.tool ? fmt::format("T{}", *t.tool) : "none",
                          known ? std::string(name_of(tool->shape)) : kUnknown,
                          known ? lengths_.of(tool->diameter.mm(), 3) : kUnknown, flutes, flute,
                          reaches ? lengths_.of(std::max(block_->high.z - *t.deepest, 0.0), 3) : kUnknown,
                          t.deepest ? lengths_.of(*t.deepest, 3) : "no cut", speed_text(t.figures.speed),
                          feed_text(t.figures.feed), clock_text(seconds)});
    const auto layer = t.tool ? layer_of_tool(sheet_.plan, *t.tool) : std::nullopt;
    table.layers.push_back(layer.value_or(SetupSheet::kNoLayer));
  }
  sheet_.tables.push_back(std::move(table));
}

void SheetWriter::add_fixtures() {
  SetupSheet::Table table{"fixtures", "Fixtures", {{"Fixture", 1}, {"Position", 3}}, {}, {}};
  for (const Fixture& fixture : job_.fixtures)
    table.rows.push_back({clipped(fixture.name, kMaxText), box_text(fixture.solid.block)});
  sheet_.tables.push_back(std::move(table));
}

void SheetWriter::add_findings(const std::vector<Finding>& findings, const Diagnostics& diagnostics) {
  SetupSheet::Table table{"findings", "To be checked", {{"Kind", 1}, {"Where", 2}, {"What", 6}}, {}, {}};
  const auto add = [&](std::string_view kind, const Origin& where, std::string what,
                       const std::string& hint) {
    if (!hint.empty()) what += fmt::format(" ({})", hint);
    table.rows.push_back({std::string(kind), clipped(to_string(where), kMaxText), lengths_.message(what)});
  };
  const std::vector<Finding> lines = grouped(findings);
  for (const Finding& f : lines)
    if (table.rows.size() < kMaxFindings)
      add("hazard", f.origin,
          f.steps > 1 ? fmt::format("{}, in {} motions from here", f.message, f.steps) : f.message, f.hint);
  std::size_t count = lines.size();
  for (const Severity severity : {Severity::error, Severity::warning, Severity::note})
    for (const Diagnostic& d : diagnostics.list()) {
      if (d.severity != severity) continue;
      ++count;
      if (table.rows.size() < kMaxFindings) add(to_string(severity), d.where, d.message, d.hint);
    }
  if (count > table.rows.size())
    table.rows.push_back({fmt::format("... and {} more", count - table.rows.size())});
  sheet_.tables.push_back(std::move(table));
}

void SheetWriter::draw_plan() {
  const auto flat = [](const Box3& box) {
    Box2 out;
    if (!box.empty()) out.add(box.low.xy()), out.add(box.high.xy());
    return out;
  };
  SetupPlan plan;
  plan.path = &job_.program.path;
  double widest = 0.0;
  for (const auto& [number, tool] : job_.tools.tools()) {
    plan.tool_diameters[number] = tool.diameter;
    widest = std::max(widest, tool.diameter.mm());
  }
  if (block_) plan.stock = flat(*block_);
  plan.cuts = flat(job_.report.all.cut_bounds);
  if (!plan.cuts.empty() && !block_) plan.cuts = plan.cuts.grown(0.5 * widest);
  plan.operations = starts_;
  for (const Fixture& fixture : job_.fixtures)
    plan.fixtures.emplace_back(fixture.name, flat(fixture.solid.block));
  plan.unit = lengths_.unit() == "mm" ? 1.0 : kMmPerInch;
  sheet_.plan = setup_plan(plan);
}

}  // namespace

std::optional<SetupSheet> setup_sheet(const Job& job, const SetupSheetOptions& options,
                                      Diagnostics& diagnostics, Progress* progress) {
  if (job.kind == JobKind::print) {
    diagnostics.error(codes::post_cannot, TextLocation{job.program.source, 0, 0},
                      "a setup sheet is for programs that cut; this one prints");
    return std::nullopt;
  }
  Diagnostics found = diagnostics;  // the check moves what are findings out of it
  JobCheckOptions how;
  how.machine = options.machine;
  const std::vector<Finding> findings = check_job(job, how, found, progress);
  if (stop_requested(progress)) return std::nullopt;
  return SheetWriter(job, options).write(findings, found);
}

}  // namespace kerf
