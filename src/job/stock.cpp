// The stock of a job: given, described in the program's comments, or assumed around its cuts.
#include <algorithm>
#include <fmt/format.h>

#include "base/codes/files.h"
#include "base/codes/sim.h"
#include "base/number.h"
#include "base/pace.h"
#include "job/choices.h"
#include "path/assumed_stock.h"

#include "kerf/base/limits.h"
#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

const Length kStockMargin = mm(2);  // of an assumed block, beyond the largest tool's radius
const Length kStockFloor = mm(1);   // of an assumed block, below the deepest cut

std::string_view reason_of(AssumedTop top) {
  switch (top) {
    case AssumedTop::passes: return "a pass above the highest one";
    case AssumedTop::plunge: return "at the start of the plunges";
    case AssumedTop::cuts: return "at the highest cut";
    case AssumedTop::zero: break;
  }
  return "at Z0";
}

/// Reports the assumed block and the reason for its top: a note if that is Z0, else a warning, because other
/// tops are less certain.
void report_assumed_stock(const AssumedStock& assumed, const Job& job, Diagnostics& diagnostics) {
  const Box3& b = assumed.stock.block;
  const Point3 size = b.size();
  const auto text = [](Point3 p, std::string_view form) {
    return fmt::format(fmt::runtime(form), number_text(p.x, 3), number_text(p.y, 3), number_text(p.z, 3));
  };
  const std::string block =
      fmt::format("assuming a block of {} around the cuts, from {} to {}", text(size, "{} x {} x {} mm"),
                  text(b.low, "X{} Y{} Z{}"), text(b.high, "X{} Y{} Z{}"));
  const Origin where = TextLocation{job.program.source, 0, 0};
  const Box3& cuts = job.report.all.cut_bounds;
  Diagnostic* reported = nullptr;
  if (job.z_downwards)
    reported = &diagnostics.note(codes::stock_assumed, where, fmt::format("no stock given; {}", block));
  else if (assumed.top != AssumedTop::zero)
    reported =
        &diagnostics.warning(codes::stock_assumed, where,
                             fmt::format("no stock given, and Z0 does not seem to be its top; {}, top {}",
                                         block, reason_of(assumed.top)));
  else if (cuts.low.z >= b.high.z)
    reported = &diagnostics.warning(
        codes::stock_assumed, where,
        fmt::format("no stock given, and the program does not cut below Z0; {}, of which nothing is removed",
                    block));
  else
    reported = &diagnostics.note(codes::stock_assumed, where,
                                 fmt::format("no stock given; {}, top {}", block, reason_of(assumed.top)));
  reported->hint =
      fmt::format("specify it, e.g. --stock \"{} to {}\"", text(b.low, "{},{},{}"), text(b.high, "{},{},{}"));
}

/// Whether an assumed block can be simulated; if not, a warning is appended.
bool is_within_limits(const Box3& block, const Job& job, Diagnostics& diagnostics) {
  const Point3 size = block.size();
  if (std::max({size.x, size.y, size.z}) <= limits::kMaxStockSize) return true;
  diagnostics
      .warning(codes::stock_assumed, TextLocation{job.program.source, 0, 0},
               fmt::format("no stock given, and none is assumed: the cuts extend over {} x {} x {} mm",
                           number_text(size.x, 3), number_text(size.y, 3), number_text(size.z, 3)))
      .hint = "check the units; or specify the stock with --stock";
  return false;
}

void find_stock(Job& job, const JobSettings& settings, Diagnostics& diagnostics) {
  job.stock = settings.stock_file;
  job.stock_source = StockSource::file;
  if (job.stock) return;
  job.stock = settings.stock;
  job.stock_source = StockSource::option;
  if (job.stock) return;
  job.stock = job.program.stock;
  job.stock_source = StockSource::program;
  if (job.stock) return;
  job.stock_source = StockSource::unknown;
  if (job.program.path.has(StepKind::laser_power)) return;  // a beam's heights are no depths in a block
  double radius = 0.0;
  for (const auto& [number, tool] : job.tools.tools()) radius = std::max(radius, tool.diameter.mm() / 2.0);
  const auto assumed = assume_stock(job.program.path, mm(radius) + kStockMargin, kStockFloor);
  if (!assumed || !is_within_limits(assumed->stock.block, job, diagnostics)) return;
  job.stock = assumed->stock;
  job.stock_source = StockSource::assumed;
  report_assumed_stock(*assumed, job, diagnostics);
}

Box3 scaled(const Box3& box, double factor) {
  Box3 out;
  out.add(factor * box.low);
  out.add(factor * box.high);
  return out;
}

/// Whether cuts lie in the block, but for a run-out of a tenth of its size, and cover half of it or more in X
/// and Y.
bool fills(const Box3& cuts, const Box3& block) {
  constexpr double kRunOut = 0.1, kCover = 0.5;
  for (int axis = 0; axis < 2; ++axis) {
    const double size = block.high[axis] - block.low[axis], room = kRunOut * size;
    if (cuts.low[axis] < block.low[axis] - room || cuts.high[axis] > block.high[axis] + room) return false;
    if (cuts.high[axis] - cuts.low[axis] < kCover * size) return false;
  }
  return true;
}

}  // namespace

std::optional<Stock> load_stock(const std::string& path, Diagnostics& diagnostics, Progress* progress) {
  const std::size_t errors = diagnostics.errors();
  const auto file = InputFile::open(path, diagnostics, limits::kMaxProgramBytes, progress);
  auto stock = file ? read_stock_file(file->bytes(), path, diagnostics, progress) : std::nullopt;
  if (!stock) add_if_stopped(path, errors, progress, diagnostics);
  return stock;
}

void choose_stock(Job& job, const JobSettings& settings, Diagnostics& diagnostics) {
  job.bar = settings.bar;
  if (!job.bar && !settings.stock && !settings.stock_file) job.bar = job.program.bar;
  if (job.bar) {
    job.kind = JobKind::rotary;
    return;
  }
  find_stock(job, settings, diagnostics);
  if (job.stock && settings.move) job.stock = moved(*job.stock, *settings.move);
  job.fixtures = settings.fixtures;
  job.fixtures.insert(job.fixtures.end(), job.program.fixtures.begin(), job.program.fixtures.end());
  job.spoilboard = settings.usual_spoilboard;
  for (const Length stated : {job.program.spoilboard, settings.spoilboard})
    if (stated > Length()) job.spoilboard = stated;
}

void warn_units(const Job& job, Diagnostics& diagnostics) {
  const Box3& cuts = job.report.all.cut_bounds;
  if (cuts.empty() || !job.stock || job.stock_source == StockSource::assumed) return;
  const Box3& block = job.stock->block;
  const bool in_inches = !job.program.units_given && fills(scaled(cuts, kMmPerInch), block);
  if (!in_inches && !fills(scaled(cuts, 1.0 / kMmPerInch), block)) return;
  const auto text = [](const Box3& box) {
    const Point3 size = box.size();
    return fmt::format("{} x {}", number_text(size.x, 3), number_text(size.y, 3));
  };
  diagnostics
      .warning(codes::units_doubtful, TextLocation{job.program.source, 0, 0},
               fmt::format("the units seem wrong: the cuts measure {} mm, the stock {} mm{}", text(cuts),
                           text(block), in_inches ? ", and the program has no G20 or G21" : ""))
      .hint = in_inches ? "if the program is in inches, put G20 at its start"
                        : "check G20 and G21, and the unit of the stock (--stock \"4x2x0.5in\")";
}

void warn_untouched(const Job& job, Volume removed, Diagnostics& diagnostics) {
  const Box3& cuts = job.report.all.cut_bounds;
  const bool is_given = job.bar || (job.stock && job.stock_source != StockSource::assumed);
  if (removed > Volume() || cuts.empty() || !is_given) return;
  const auto text = [](const Box3& box) {
    return fmt::format("X{} Y{} Z{} to X{} Y{} Z{}", number_text(box.low.x, 3), number_text(box.low.y, 3),
                       number_text(box.low.z, 3), number_text(box.high.x, 3), number_text(box.high.y, 3),
                       number_text(box.high.z, 3));
  };
  const Box3 block = job.bar ? box_of(*job.bar) : job.stock->block;
  const bool are_apart = cuts.low.x > block.high.x || cuts.high.x < block.low.x ||
                         cuts.low.y > block.high.y || cuts.high.y < block.low.y || cuts.low.z >= block.high.z;
  diagnostics
      .warning(codes::stock_untouched, TextLocation{job.program.source, 0, 0},
               fmt::format("the program removes nothing: its cuts extend from {}, the {} from {}", text(cuts),
                           job.bar ? "bar" : "stock", text(block)))
      .hint = are_apart ? fmt::format("check the work zero, the units, and the position of the {}",
                                      job.bar ? "bar (--rotary)" : "stock")
                        : fmt::format(
                              "its cuts may be narrower than the distance of the {}: use a finer "
                              "--resolution",
                              job.bar ? "rays" : "columns");
}

std::string_view to_string(StockSource source) {
  switch (source) {
    case StockSource::option: return "option";
    case StockSource::file: return "file";
    case StockSource::program: return "program";
    case StockSource::assumed: return "assumed";
    case StockSource::unknown: break;
  }
  return "unknown";
}

}  // namespace kerf
