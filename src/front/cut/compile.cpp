// The program of a job: its operations on their shapes, in their order.
#include <algorithm>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "front/cut/order.h"
#include "front/cut/tool_fit.h"

#include "kerf/program/cut_job.h"

namespace kerf {
namespace {

constexpr double kProbeBelow = 30.0;  // mm below what a touch-off touches: a tool may be shorter
constexpr double kProbeFeed = 100.0;  // mm/min
constexpr double kRetract = 5.0;      // mm above the highest surface

/// Whether an outline has no area.
bool is_open(const PaintedOutline& o) { return o.fill.figure == 0 && !o.outline.closed(); }

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
    const auto selected = cut_detail::select_shapes(job_, art_, stock_top_, diagnostics_);
    if (!selected) return std::nullopt;
    const auto units = cut_detail::in_order(*selected, job_, tools_, diagnostics_);
    for (const cut_detail::CutUnit& unit : units) {
      if (stop_requested(progress_)) return std::nullopt;
      add(unit);
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
  /// Adds the shapes that an operation is run on; the outlines as they are filled.
  static std::vector<PaintedOutline> add_shapes(const std::vector<const ArtShape*>& shapes, CutWork& work) {
    std::vector<PaintedOutline> painted;
    for (const ArtShape* shape : shapes) {
      if (shape->point) work.points.push_back(*shape->point);
      if (shape->picture) work.pictures.push_back(shape->picture);
      if (!shape->outline) continue;
      (shape->outline->closed() ? work.closed : work.open).push_back(*shape->outline);
      painted.push_back({*shape->outline, shape->fill});
      if (const auto circle = cut_detail::circle_of(*shape)) work.circles.push_back(*circle);
    }
    for (const Circle& circle : work.circles) work.points.push_back(circle.centre);
    return painted;
  }
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
  bool prepare(CutWork& work, const std::vector<const ArtShape*>& shapes) {
    const CutRow& row = *work.operation.row;
    if (!row.laser && (work.tool = work.tool_of(work.operation.tool, diagnostics_)) == nullptr) return false;
    if (work.tool != nullptr && !cut_detail::suits(*work.tool, work.operation, diagnostics_)) return false;
    const std::vector<PaintedOutline> painted = add_shapes(shapes, work);
    if (row.cuts_mesh() && mesh_ == nullptr) {
      diagnostics_
          .error(codes::op_option, work.operation.where,
                 fmt::format("{}: no mesh is given", work.operation.name))
          .hint = "--mesh part.stl, or in a job file [surface] with file = \"part.stl\"";
      return false;
    }
    const bool in_region = row.input == CutInput::mesh_in_region && !cut_detail::selects_all(work.operation);
    if (!row.cuts_region() && !in_region) return true;
    work.region = region_of(work.operation, painted);
    return work.region.has_value();
  }

  void add(const cut_detail::CutUnit& unit) {
    const CutOperation& operation = *unit.operation;
    CutWork work{.operation = operation, .job = job_.operations, .tools = tools_};
    work.retract_plane = retract_, work.progress = progress_, work.mesh = mesh_, work.mesh_box = mesh_box_;
    const auto piece = prepare(work, unit.shapes) ? operation.row->run(work, diagnostics_) : std::nullopt;
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
    if (tool_ != operation.tool) change_tool(operation.tool, origin);
    if (operation.speed > SpindleSpeed{} && spindle_ != operation.speed) {
      path_.add(step::Spindle{operation.speed, SpindleTurn::cw}, origin);
      spindle_ = operation.speed;
    }
    cool(operation.coolant, origin);
    cross(piece->path, origin);
    append(path_, piece->path);
  }
  /// From a higher plane, that of tool changes, the tool goes across there before it goes down.
  void cross(const Toolpath& next, OriginId origin) {
    const auto last = path_.motion_before(path_.size());
    if (!last) return;
    const Point3 here = path_[*last].to();
    for (std::size_t i = 0; i < next.size(); ++i) {
      if (next[i].kind() != StepKind::rapid || next[i].unknown_axes() != 0) continue;
      const Point3 to = next[i].to();
      if (here.z > to.z && (here.x != to.x || here.y != to.y))
        path_.add(step::Rapid{{to.x, to.y, here.z}}, origin);
      return;
    }
  }
  void change_tool(int number, OriginId origin) {
    cool(CutCoolant::none, origin);
    const ChangePosition& change = job_.layout.change;
    const auto last = path_.motion_before(path_.size());
    if (tool_ && last && (change.height || change.at)) {
      const double height = std::max(change.height.value_or(retract_), retract_);
      const Point3 here = path_[*last].to();
      path_.add(step::Rapid{{here.x, here.y, height}}, origin);
      if (change.at) path_.add(step::Rapid{{change.at->x, change.at->y, height}}, origin);
    }
    if (tool_ && spindle_) path_.add(step::Spindle{}, origin);
    if (tool_ && change.touch_off == TouchOff::message)
      path_.add(step::Note{fmt::format("tool {}: set its zero in Z as for tool {}", number, *tool_),
                           NoteKind::message},
                origin);
    path_.add(step::ToolChange{number}, origin);
    if (tool_ && last && change.touch_off == TouchOff::probe) touch_off(number, origin);
    tool_ = number, spindle_.reset();
  }
  /// The new tool touches what is at a known height; the zero is set by that. Reading it back relies on the
  /// words of the note.
  void touch_off(int number, OriginId origin) {
    constexpr unsigned kZ = 4, kAll = 7;
    const ChangePosition& change = job_.layout.change;
    Point3 at = path_[*path_.motion_before(path_.size())].to();
    const double height = at.z;
    if (const auto xy = change.probe_at) at = {xy->x, xy->y, at.z}, path_.add(step::Rapid{at}, origin);
    path_.add(step::Note{fmt::format("touch-off of tool {}: the zero in Z stays", number)}, origin);
    at.z = change.probe_height - kProbeBelow;
    path_.add(step::Probe{at, mm_per_min(kProbeFeed)}, origin);
    path_.set_probed_axes(path_.size() - 1, kZ, kAll, 0);
    at.z = change.probe_height;
    path_.add(step::WorkZero{.kind = ZeroKind::here, .axes = kZ, .at = at, .known = kZ}, origin);
    at.z = height;
    path_.add(step::Rapid{at}, origin);
  }
  void cool(CutCoolant coolant, OriginId origin) {
    if (coolant != coolant_)
      path_.add(step::Coolant{coolant == CutCoolant::mist, coolant == CutCoolant::flood}, origin);
    coolant_ = coolant;
  }

  const CutJob& job_;
  const std::vector<ArtShape>& art_;
  ArtShape stock_top_ = job_.stock_box ? cut_detail::top_of(*job_.stock_box) : ArtShape{};
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
