// The program of a job: the shapes of each operation, and the operation on them.
#include <algorithm>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "base/names.h"

#include "kerf/drawing/svg.h"
#include "kerf/program/cut_job.h"

namespace kerf {
namespace {

constexpr double kRetract = 5.0;                  // mm above the highest surface
constexpr std::string_view kStockName = "stock";  // of an outline: the stock, seen from above

/// Whether an outline has no area.
bool is_open(const PaintedOutline& o) { return o.fill.figure == 0 && !o.outline.closed(); }

/// The operations in the order in which they are run: those of lasers that follow each other by their rows.
std::vector<const CutOperation*> in_order(const std::vector<CutOperation>& operations) {
  std::vector<const CutOperation*> order;
  for (const CutOperation& operation : operations) order.push_back(&operation);
  for (auto first = order.begin(); first != order.end();) {
    const bool laser = (*first)->row->laser;
    const auto last =
        std::find_if(first, order.end(), [&](const CutOperation* o) { return o->row->laser != laser; });
    if (laser)
      std::stable_sort(first, last, [](const CutOperation* a, const CutOperation* b) {
        return a->row->order < b->row->order;
      });
    first = last;
  }
  return order;
}

bool listed(const std::vector<std::string>& names, const std::string& name) {
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& n) { return fold_name(n) == fold_name(name); });
}

/// The names of layers, those of colours as drawings name them.
std::vector<std::string> layer_names(const std::vector<std::string>& names,
                                     const std::vector<ArtShape>& art) {
  std::vector<std::string> out = names;
  for (std::string& name : out) {
    const bool is_layer = std::any_of(art.begin(), art.end(), [&](const ArtShape& shape) {
      return fold_name(shape.layer) == fold_name(name);
    });
    if (!is_layer) name = colour_layer(name);
  }
  return out;
}

/// The circle that an outline is, if all its segments are arcs of one.
std::optional<Circle> circle_of(const Outline& outline, Length weld) {
  if (!outline.closed()) return std::nullopt;
  std::optional<Circle> circle;
  Point2 from = outline.start;
  double turned = 0.0;
  for (const Segment& segment : outline.segments) {
    const auto arc = arc_circle(from, segment);
    if (!arc) return std::nullopt;
    if (!circle) circle = Circle{arc->centre, mm(arc->radius)};
    if (distance(circle->centre, arc->centre) > weld.mm() ||
        std::abs(circle->radius.mm() - arc->radius) > weld.mm())
      return std::nullopt;
    turned += (arc->turn == Turn::ccw ? 1.0 : -1.0) * arc->sweep.deg();
    from = segment.to;
  }
  return std::abs(std::abs(turned) - 360.0) < 1e-3 ? circle : std::nullopt;
}

class JobCompiler {
 public:
  JobCompiler(const CutJob& job, const std::vector<ArtShape>& art, const std::map<int, Tool>& tools,
              Diagnostics& diagnostics, Progress* progress, const SurfaceMesh* mesh)
      : job_(job), art_(art), tools_(tools), diagnostics_(diagnostics), progress_(progress), mesh_(mesh) {
    if (mesh != nullptr) mesh_box_ = bounds(*mesh);
    double top = -INFINITY;
    for (const CutOperation& operation : job.operations) {
      const auto given = number_of(operation, "top");
      const bool on_mesh = operation.row->cuts_mesh() && !mesh_box_.empty();
      if (given || !on_mesh) top = std::max(top, given.value_or(0.0));
      if (on_mesh) top = std::max(top, mesh_box_.high.z);
    }
    // All operations have the highest retract plane, so that the way from one to the next is level.
    retract_ = top + kRetract;
    bool given = false;
    for (const CutOperation& operation : job.operations)
      if (operation.retract)
        retract_ = given ? std::max(retract_, *operation.retract) : *operation.retract, given = true;
  }

  std::optional<Toolpath> run() {
    for (const CutOperation* operation : in_order(job_.operations)) {
      if (stop_requested(progress_)) return std::nullopt;
      add(*operation);
    }
    if (failed_) return std::nullopt;
    const auto last = path_.motion_before(path_.size());
    if (const auto park = job_.layout.park; park && last)
      path_.add(step::Rapid{{park->x, park->y, path_[*last].to().z}}, OriginId::none);
    cool(CutCoolant::none, OriginId::none);
    if (spindle_) path_.add(step::Spindle{}, OriginId::none);
    path_.add(step::End{}, OriginId::none);
    return std::move(path_);
  }

 private:
  /// Adds the shapes that an operation selects; the outlines as they are filled.
  std::vector<PaintedOutline> select(CutWork& work) {
    const CutOperation& operation = work.operation;
    std::vector<PaintedOutline> painted;
    const Length weld = Tolerance{}.weld;
    std::vector<std::string> found;
    const std::vector<std::string> layers = layer_names(operation.layers, art_);
    const auto take = [&](const ArtShape& shape) {
      if (shape.point) work.points.push_back(*shape.point);
      if (shape.picture) work.pictures.push_back(shape.picture);
      if (!shape.outline) return;
      (shape.outline->closed() ? work.closed : work.open).push_back(*shape.outline);
      painted.push_back({*shape.outline, shape.fill});
      if (const auto circle = shape.circle ? shape.circle : circle_of(*shape.outline, weld))
        work.circles.push_back(*circle);
    };
    for (const ArtShape& shape : art_) {
      const bool by_layer = listed(layers, shape.layer), by_name = listed(operation.outlines, shape.name);
      if (by_layer) found.push_back(fold_name(shape.layer));
      if (by_name) found.push_back(fold_name(shape.name));
      if (by_layer || by_name || selects_all(operation)) take(shape);
    }
    if (takes_stock(operation, found, painted)) {
      painted.clear();
      take(top_of(*job_.stock_box));
      found.push_back(std::string(kStockName));
    }
    for (const Circle& circle : work.circles) work.points.push_back(circle.centre);
    for (const auto* names : {&layers, &operation.outlines})
      for (const std::string& name : *names)
        if (std::find(found.begin(), found.end(), fold_name(name)) == found.end())
          nothing(operation, fmt::format("no {} \"{}\" in the art", names == &layers ? "layer" : "outline",
                                         name.substr(0, 60)))
              .hint = "kerf outline --list-layers prints the layers of a drawing";
    return painted;
  }
  /// Whether the top of the stock is cut: by its name, or by an operation that has no area otherwise.
  bool takes_stock(const CutOperation& operation, const std::vector<std::string>& found,
                   const std::vector<PaintedOutline>& painted) const {
    if (!job_.stock_box) return false;
    const std::string name(kStockName);
    if (listed(operation.outlines, name)) return std::find(found.begin(), found.end(), name) == found.end();
    return operation.row->input == CutInput::region_or_stock && selects_all(operation) &&
           std::all_of(painted.begin(), painted.end(), is_open);
  }
  static ArtShape top_of(const Box3& stock) {
    ArtShape shape;
    shape.name = kStockName;
    Outline& outline = shape.outline.emplace();
    outline.start = stock.low.xy();
    for (const Point2 p : {Point2{stock.high.x, stock.low.y}, stock.high.xy(),
                           Point2{stock.low.x, stock.high.y}, stock.low.xy()})
      outline.segments.push_back({p, {}});
    return shape;
  }
  static bool selects_all(const CutOperation& o) { return o.layers.empty() && o.outlines.empty(); }
  Diagnostic& nothing(const CutOperation& operation, const std::string& message) {
    failed_ = true;
    return diagnostics_.error(codes::cut_job_outlines, operation.where, operation.name + ": " + message);
  }

  /// The region of the closed and the filled outlines; open ones are reported and left out.
  std::optional<Region> region_of(const CutOperation& operation, const std::vector<PaintedOutline>& painted) {
    const auto open = std::count_if(painted.begin(), painted.end(), is_open);
    if (open > 0) {
      const Point2 at = std::find_if(painted.begin(), painted.end(), is_open)->outline.start;
      const std::string message =
          fmt::format("{}: {} of {} outlines {} open and not cut, the first at {:.6g}, {:.6g}",
                      operation.name, open, painted.size(), open == 1 ? "is" : "are", at.x, at.y);
      diagnostics_.warning(codes::cut_job_outlines, operation.where, message).hint =
          "close them, or cut along them with engrave";
    }
    if (static_cast<std::size_t>(open) == painted.size()) {
      Diagnostic& missing = nothing(operation, "no closed outline is selected");
      if (operation.row->input == CutInput::region_or_stock)
        missing.hint = "stock = \"100x60x12\", whose whole top is cut then";
      return std::nullopt;
    }
    RegionOptions options;
    options.name = operation.name, options.where = operation.where, options.progress = progress_;
    return painted_region(painted, operation.combining, options, diagnostics_);
  }

  /// Whether the operation has what it needs; region, mesh and tool are added.
  bool prepare(CutWork& work) {
    const CutRow& row = *work.operation.row;
    if (!row.laser && (work.tool = work.tool_of(work.operation.tool, diagnostics_)) == nullptr) return false;
    std::vector<PaintedOutline> painted;
    if (row.input != CutInput::nothing) painted = select(work);
    if (failed_) return false;
    if (row.cuts_mesh() && mesh_ == nullptr) {
      diagnostics_
          .error(codes::op_option, work.operation.where,
                 fmt::format("{}: no mesh is given", work.operation.name))
          .hint = "--mesh part.stl, or in a job file [surface] with file = \"part.stl\"";
      return false;
    }
    const bool in_region = row.input == CutInput::mesh_in_region && !selects_all(work.operation);
    if (!row.cuts_region() && !in_region) return true;
    work.region = region_of(work.operation, painted);
    return work.region.has_value();
  }

  void add(const CutOperation& operation) {
    CutWork work{.operation = operation, .job = job_.operations, .tools = tools_};
    work.retract_plane = retract_, work.progress = progress_, work.mesh = mesh_, work.mesh_box = mesh_box_;
    const auto piece = prepare(work) ? operation.row->run(work, diagnostics_) : std::nullopt;
    if (!piece) {
      failed_ = true;
      return;
    }
    const OriginId origin = path_.origins().add(operation.where);
    path_.add(step::Note{operation.name}, origin);
    if (operation.row->laser) {
      cool(CutCoolant::none, origin);
      return append(path_, piece->path);
    }
    if (tool_ != operation.tool) {
      cool(CutCoolant::none, origin);
      if (tool_ && spindle_) path_.add(step::Spindle{}, origin);
      path_.add(step::ToolChange{operation.tool}, origin);
      spindle_.reset();
    }
    tool_ = operation.tool;
    if (operation.speed > SpindleSpeed{} && spindle_ != operation.speed) {
      path_.add(step::Spindle{operation.speed, SpindleTurn::cw}, origin);
      spindle_ = operation.speed;
    }
    cool(operation.coolant, origin);
    append(path_, piece->path);
  }
  void cool(CutCoolant coolant, OriginId origin) {
    if (coolant != coolant_)
      path_.add(step::Coolant{coolant == CutCoolant::mist, coolant == CutCoolant::flood}, origin);
    coolant_ = coolant;
  }

  const CutJob& job_;
  const std::vector<ArtShape>& art_;
  const std::map<int, Tool>& tools_;
  Diagnostics& diagnostics_;
  Progress* progress_;
  const SurfaceMesh* mesh_;
  Box3 mesh_box_;
  double retract_ = 0.0;
  Toolpath path_;
  std::optional<int> tool_;
  std::optional<SpindleSpeed> spindle_;
  CutCoolant coolant_ = CutCoolant::none;
  bool failed_ = false;
};

}  // namespace

std::optional<Toolpath> compile_cut_job(const CutJob& job, const std::vector<ArtShape>& art,
                                        const std::map<int, Tool>& tools, Diagnostics& diagnostics,
                                        Progress* progress, const SurfaceMesh* mesh) {
  return JobCompiler(job, art, tools, diagnostics, progress, mesh).run();
}

}  // namespace kerf
