// The program of a job: the shapes of each operation, and the operation on them.
#include <algorithm>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "base/names.h"
#include "front/cut/keys.h"

#include "kerf/base/limits.h"
#include "kerf/drawing/svg.h"

namespace kerf {
namespace {

constexpr double kRetract = 5.0;   // mm above the highest surface
constexpr double kMinFloor = 0.1;  // mm2, of a floor that is reported

/// The shapes of one operation.
struct Selection {
  std::vector<Outline> closed, open;
  std::vector<PaintedOutline> painted;  // all of them
  std::vector<Circle> circles;
  std::vector<Point2> points;
  std::vector<std::shared_ptr<const PlacedPicture>> pictures;
};

/// Operations that follow each other are run in this order if they are all a laser's: what is cut out moves.
int rank_of(const CutOperation& operation) {
  if (operation.kind == CutKind::laser_frame) return 0;
  return operation.kind == CutKind::laser_cut ? 2 : 1;
}

/// The operations in the order in which they are run.
std::vector<const CutOperation*> in_order(const std::vector<CutOperation>& operations) {
  std::vector<const CutOperation*> order;
  for (const CutOperation& operation : operations) order.push_back(&operation);
  for (auto first = order.begin(); first != order.end();) {
    const bool laser = is_laser((*first)->kind);
    const auto last =
        std::find_if(first, order.end(), [&](const CutOperation* o) { return is_laser(o->kind) != laser; });
    if (laser)
      std::stable_sort(first, last, [](const CutOperation* a, const CutOperation* b) {
        return rank_of(*a) < rank_of(*b);
      });
    first = last;
  }
  return order;
}

Box2 box_of(const PlacedPicture& placed) {
  const double width = placed.width.mm();
  const double height = width * placed.picture.height / placed.picture.width;
  return {placed.at, placed.at + Point2{width, height}};
}

/// Around all that is selected.
Box2 box_of(const Selection& chosen) {
  Box2 box;
  for (const auto* outlines : {&chosen.closed, &chosen.open})
    for (const Outline& outline : *outlines) box.add(bounds(outline));
  for (const Point2 point : chosen.points) box.add(point);
  for (const auto& placed : chosen.pictures) box.add(box_of(*placed));
  return box;
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
      top = std::max(top, top_of(operation));
      if (cuts_mesh(operation.kind) && !mesh_box_.empty()) top = std::max(top, mesh_box_.high.z);
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
    if (spindle_) path_.add(step::Spindle{}, OriginId::none);
    path_.add(step::End{}, OriginId::none);
    return std::move(path_);
  }

 private:
  /// The surface of the material; that of a mesh is at its highest point unless given.
  double top_of(const CutOperation& operation) const {
    const bool cut = cuts_mesh(operation.kind) && operation.kind != CutKind::project;
    const bool assumed = cut && !operation.top_given && !mesh_box_.empty();
    return assumed ? mesh_box_.high.z : operation.cut.top;
  }

  Selection select(const CutOperation& operation) {
    Selection chosen;
    const Length weld = operation.cut.tolerance.weld;
    std::vector<std::string> found;
    const std::vector<std::string> layers = layer_names(operation.layers, art_);
    for (const ArtShape& shape : art_) {
      const bool by_layer = listed(layers, shape.layer), by_name = listed(operation.outlines, shape.name);
      if (by_layer) found.push_back(fold_name(shape.layer));
      if (by_name) found.push_back(fold_name(shape.name));
      if (!by_layer && !by_name && !(operation.layers.empty() && operation.outlines.empty())) continue;
      if (shape.point) chosen.points.push_back(*shape.point);
      if (shape.picture) chosen.pictures.push_back(shape.picture);
      if (!shape.outline) continue;
      (shape.outline->closed() ? chosen.closed : chosen.open).push_back(*shape.outline);
      chosen.painted.push_back({*shape.outline, shape.fill});
      if (const auto circle = shape.circle ? shape.circle : circle_of(*shape.outline, weld))
        chosen.circles.push_back(*circle);
    }
    for (const auto* names : {&layers, &operation.outlines})
      for (const std::string& name : *names)
        if (std::find(found.begin(), found.end(), fold_name(name)) == found.end())
          nothing(operation, fmt::format("no {} \"{}\" in the art", names == &layers ? "layer" : "outline",
                                         name.substr(0, 60)))
              .hint = "kerf outline --list-layers prints the layers of a drawing";
    return chosen;
  }
  Diagnostic& nothing(const CutOperation& operation, const std::string& message) {
    failed_ = true;
    return diagnostics_.error(codes::cut_job_outlines, operation.cut.where, operation.name + ": " + message);
  }

  /// The region of the closed and the filled outlines; open ones are reported and left out.
  std::optional<Region> region_of(const CutOperation& operation, const Selection& chosen) {
    const auto is_open = [](const PaintedOutline& o) { return o.fill.figure == 0 && !o.outline.closed(); };
    const auto open = std::count_if(chosen.painted.begin(), chosen.painted.end(), is_open);
    if (open > 0) {
      const Point2 at = std::find_if(chosen.painted.begin(), chosen.painted.end(), is_open)->outline.start;
      const std::string message =
          fmt::format("{}: {} of {} outlines {} open and not cut, the first at {:.6g}, {:.6g}",
                      operation.name, open, chosen.painted.size(), open == 1 ? "is" : "are", at.x, at.y);
      diagnostics_.warning(codes::cut_job_outlines, operation.cut.where, message).hint =
          "close them, or cut along them with engrave";
    }
    if (static_cast<std::size_t>(open) == chosen.painted.size()) {
      nothing(operation, "no closed outline is selected");
      return std::nullopt;
    }
    RegionOptions options;
    options.name = operation.name, options.where = operation.cut.where, options.progress = progress_;
    return painted_region(chosen.painted, operation.combining, options, diagnostics_);
  }

  std::optional<Operation> made(const CutOperation& operation, const Tool& tool, const Selection& chosen) {
    CutOptions cut = operation.cut;
    cut.retract_plane = retract_, cut.progress = progress_, cut.top = top_of(operation);
    if (cuts_mesh(operation.kind)) return on_mesh(operation, tool, chosen, cut);
    switch (operation.kind) {
      case CutKind::engrave: return contour_on(all_of(chosen), tool, cut, diagnostics_);
      case CutKind::bore: return bore(chosen.circles, tool, {cut, operation.stepover}, diagnostics_);
      case CutKind::drill: return drilled(operation, tool, chosen);
      case CutKind::keyhole:
        return keyhole(points_of(chosen), tool,
                       {cut, operation.length, operation.angle, operation.slot_clearance}, diagnostics_);
      case CutKind::slot: {
        SlotOptions options{.cut = cut, .stepover = operation.stepover, .width = operation.width};
        return slot(chosen.open, tool, options, diagnostics_);
      }
      case CutKind::trochoidal_slot: {
        const TrochoidalSlotOptions options{cut, operation.width, operation.stepover, operation.engagement};
        return trochoidal_slot(all_of(chosen), tool, options, diagnostics_);
      }
      case CutKind::thread: {
        ThreadOptions options = operation.thread;
        options.cut = cut;
        options.side = operation.side == ContourSide::inside ? ThreadSide::inside : ThreadSide::outside;
        return thread(chosen.circles, tool, options, diagnostics_);
      }
      case CutKind::countersink:
        return countersink(chosen.circles, tool, {.cut = cut, .angle = operation.cone.value_or(degrees(90))},
                           diagnostics_);
      default: break;
    }
    const auto region = region_of(operation, chosen);
    if (!region) return std::nullopt;
    if (operation.kind == CutKind::vcarve) return carved(operation, tool, *region, cut);
    if (operation.kind == CutKind::vcarve_floor) return carved_floor(operation, tool, *region, cut);
    if (operation.kind == CutKind::contour)
      return contour(*region, tool, contour_options(operation, cut), diagnostics_);
    if (operation.kind == CutKind::face)
      return facing(*region, tool, {.cut = cut, .stepover = operation.stepover, .angle = operation.angle},
                    diagnostics_);
    return pocketed(operation, tool, *region, cut);
  }

  static std::vector<Outline> all_of(const Selection& chosen) {
    std::vector<Outline> all = chosen.closed;
    all.insert(all.end(), chosen.open.begin(), chosen.open.end());
    return all;
  }

  std::optional<Operation> on_mesh(const CutOperation& operation, const Tool& tool, const Selection& chosen,
                                   const CutOptions& cut) {
    if (mesh_ == nullptr) {
      diagnostics_
          .error(codes::op_option, operation.cut.where, fmt::format("{}: no mesh is given", operation.name))
          .hint = "--mesh part.stl, or in a job file [surface] with file = \"part.stl\"";
      return std::nullopt;
    }
    MeshCutOptions options{.cut = cut,
                           .stepover = operation.stepover,
                           .line_distance = operation.line_distance,
                           .angle = operation.angle,
                           .tolerance = operation.surface_tolerance,
                           .rest_thickness = operation.rest_thickness};
    if (operation.rest_tool) {
      const auto earlier = tools_.find(*operation.rest_tool);
      if (earlier == tools_.end()) return no_shape(operation, *operation.rest_tool), std::nullopt;
      options.earlier = earlier->second;
    }
    if (operation.kind == CutKind::project)
      return project(*mesh_, all_of(chosen), tool, options, diagnostics_);
    if (operation.kind == CutKind::waterline) return waterline(*mesh_, tool, options, diagnostics_);
    const bool whole = operation.layers.empty() && operation.outlines.empty();
    const auto region = whole ? area_of_mesh(operation) : region_of(operation, chosen);
    if (!region) return std::nullopt;
    return raster(*mesh_, *region, tool, options, diagnostics_);
  }

  /// The rectangle around the mesh.
  std::optional<Region> area_of_mesh(const CutOperation& operation) {
    const double overhang = operation.overhang.mm();
    if (!(overhang >= 0.0 && overhang <= limits::kMaxToolSize)) {
      diagnostics_.error(
          codes::op_option, operation.cut.where,
          fmt::format("{}: overhang is {:g}; it must be 0 mm or more", operation.name, overhang));
      return std::nullopt;
    }
    if (mesh_box_.empty()) return Region{};
    const Box2 box = Box2{mesh_box_.low.xy(), mesh_box_.high.xy()}.grown(overhang);
    Outline outline{box.low, {}, {}};
    for (const Point2 p : {Point2{box.high.x, box.low.y}, box.high, Point2{box.low.x, box.high.y}, box.low})
      outline.segments.push_back({p, {}, {}});
    RegionOptions options;
    options.name = operation.name, options.where = operation.cut.where;
    return make_region({outline}, FillRule::even_odd, options, diagnostics_);
  }

  /// A pocket, or what an earlier tool has left of it.
  std::optional<Operation> pocketed(const CutOperation& operation, const Tool& tool, const Region& region,
                                    const CutOptions& cut) {
    const PocketOptions options = pocket_options(operation, cut);
    if (!operation.rest_tool) return pocket(region, tool, options, diagnostics_);
    const auto earlier = tools_.find(*operation.rest_tool);
    if (earlier == tools_.end()) return no_shape(operation, *operation.rest_tool), std::nullopt;
    return rest_pocket(region, earlier->second, tool, options, diagnostics_);
  }

  static PocketOptions pocket_options(const CutOperation& operation, const CutOptions& cut) {
    return {
        cut, operation.stepover, operation.pattern, operation.angle, operation.finish, operation.engagement};
  }

  static InlayOptions plug_options(const CutOperation& operation, const CutOptions& cut) {
    return {cut, operation.glue_gap, operation.base_gap, operation.margin};
  }

  std::optional<Operation> carved(const CutOperation& operation, const Tool& tool, const Region& region,
                                  const CutOptions& cut) {
    const bool pocket = operation.part == InlayPart::pocket;
    auto made = pocket ? v_carve(region, tool, {.cut = cut}, diagnostics_)
                       : inlay_plug(region, tool, plug_options(operation, cut), diagnostics_);
    if (made) note_floor(operation, *made);
    return made;
  }

  /// Reports the floor that a V-carving leaves, unless an operation of the job clears it.
  void note_floor(const CutOperation& operation, const Operation& made) {
    const auto clears = [&](const CutOperation& o) {
      return o.kind == CutKind::vcarve_floor && o.carve_tool == operation.tool && o.part == operation.part;
    };
    const double left = area(made.unreached);
    if (!(left > kMinFloor) || std::any_of(job_.operations.begin(), job_.operations.end(), clears)) return;
    diagnostics_
        .note(codes::op_tool_wide, operation.cut.where,
              fmt::format("{}: a floor of {:.4g} mm2 is left", operation.name, left))
        .hint = "op = \"vcarve-floor\" with another tool clears it";
  }

  /// The floor that the carving tool leaves, by this one.
  std::optional<Operation> carved_floor(const CutOperation& operation, const Tool& tool, const Region& region,
                                        CutOptions cut) {
    const auto carver = tools_.find(operation.carve_tool);
    if (carver == tools_.end()) return no_shape(operation, operation.carve_tool), std::nullopt;
    const bool plug = operation.part == InlayPart::plug;
    const InlayOptions options = plug_options(operation, cut);
    const auto floor = plug ? inlay_plug_floor(region, carver->second, options, diagnostics_)
                            : v_carve_floor(region, carver->second, {.cut = cut}, diagnostics_);
    if (!floor) return std::nullopt;
    if (plug) cut.depth = inlay_plug_depth(options);
    return pocketed(operation, tool, *floor, cut);
  }

  static ContourOptions contour_options(const CutOperation& operation, const CutOptions& cut) {
    ContourOptions options;
    options.cut = cut, options.side = operation.side, options.overlap = operation.overlap;
    options.lead_in = {operation.lead_kind, operation.lead};
    options.lead_out = {operation.lead_kind, operation.lead_out.value_or(operation.lead)};
    options.finish = operation.finish, options.tabs = operation.tabs;
    return options;
  }

  /// Points, and the centres of circles.
  static std::vector<Point2> points_of(const Selection& chosen) {
    std::vector<Point2> points = chosen.points;
    for (const Circle& circle : chosen.circles) points.push_back(circle.centre);
    return points;
  }

  std::optional<Operation> drilled(const CutOperation& operation, const Tool& tool, const Selection& chosen) {
    DrillOptions options;
    options.kind = operation.cycle, options.top = operation.cut.top, options.depth = operation.cut.depth;
    options.peck = operation.peck, options.dwell = operation.dwell, options.feed = operation.cut.feed;
    options.retract_plane = retract_, options.clearance = operation.cut.clearance;
    options.name = operation.name, options.where = operation.cut.where;
    return drill(points_of(chosen), tool, options, diagnostics_);
  }

  void no_shape(const CutOperation& operation, int tool) {
    failed_ = true;
    diagnostics_
        .error(codes::cut_job_key, operation.cut.where,
               fmt::format("{}: tool {} has no shape", operation.name, tool))
        .hint = fmt::format("[tools]\n{} = \"square d=6\"", tool);
  }

  LaserOptions laser_options(const CutOperation& operation) const {
    LaserOptions laser = operation.beam.laser;
    laser.feed = operation.cut.feed, laser.name = operation.name, laser.where = operation.cut.where;
    laser.progress = progress_;
    return laser;
  }

  std::optional<Operation> burnt(const CutOperation& operation, const Selection& chosen) {
    const LaserOptions laser = laser_options(operation);
    switch (operation.kind) {
      case CutKind::laser_frame: return laser_frame(box_of(chosen), laser, diagnostics_);
      case CutKind::laser_test: return laser_test(test_options(operation, laser), diagnostics_);
      case CutKind::laser_picture: return pictured(operation, chosen, laser);
      case CutKind::laser: {
        std::vector<Outline> all = chosen.closed;
        all.insert(all.end(), chosen.open.begin(), chosen.open.end());
        return laser_lines(all, laser, diagnostics_);
      }
      default: break;
    }
    const auto region = region_of(operation, chosen);
    if (!region) return std::nullopt;
    if (operation.kind == CutKind::laser_fill)
      return laser_fill(*region, operation.angle, operation.beam.scan, laser, diagnostics_);
    LaserCutOptions options{laser, operation.beam.kerf, operation.side, {}, {}, operation.overlap};
    options.lead_in = {operation.lead_kind, operation.lead};
    options.lead_out = {operation.lead_kind, operation.lead_out.value_or(operation.lead)};
    return laser_cut(*region, options, diagnostics_);
  }

  std::optional<Operation> pictured(const CutOperation& operation, const Selection& chosen,
                                    const LaserOptions& laser) {
    const LaserKeys& keys = operation.beam;
    if (chosen.pictures.empty()) {
      nothing(operation, "no picture is selected").hint = "[[shape]]\npicture = \"photo.png\"";
      return std::nullopt;
    }
    Operation all;
    for (const auto& placed : chosen.pictures) {
      const LaserPictureOptions options{laser,      keys.scan,      placed->at, placed->width,
                                        keys.tones, keys.min_power, keys.gamma, keys.negative};
      const auto piece = laser_picture(placed->picture, options, diagnostics_);
      if (!piece) return std::nullopt;
      append(all.path, piece->path);
    }
    return all;
  }

  static LaserTestOptions test_options(const CutOperation& operation, const LaserOptions& laser) {
    const LaserKeys& keys = operation.beam;
    LaserTestOptions options{laser,    keys.scan,        {}, {}, {}, keys.cell_width, keys.cell_height,
                             keys.gap, keys.label_height};
    const auto between = [](double from, double to, int i, int count) {
      return count > 1 ? from + (to - from) * i / (count - 1) : from;
    };
    const double power_to = keys.power_to >= 0.0 ? keys.power_to : laser.power;
    for (int i = 0; i < keys.columns; ++i)
      options.powers.push_back(between(laser.power, power_to, i, keys.columns));
    const Feed feed_to = keys.feed_to != Feed{} ? keys.feed_to : laser.feed;
    for (int i = 0; i < keys.rows; ++i)
      options.feeds.push_back(
          mm_per_min(between(laser.feed.mm_per_min(), feed_to.mm_per_min(), i, keys.rows)));
    return options;
  }

  void add(const CutOperation& operation) {
    const auto tool = tools_.find(operation.tool);
    if (!is_laser(operation.kind) && tool == tools_.end()) {
      no_shape(operation, operation.tool);
      return;
    }
    const Selection chosen = operation.kind == CutKind::laser_test ? Selection{} : select(operation);
    if (failed_) return;
    const auto piece =
        is_laser(operation.kind) ? burnt(operation, chosen) : made(operation, tool->second, chosen);
    if (!piece) {
      failed_ = true;
      return;
    }
    const OriginId origin = path_.origins().add(operation.cut.where);
    path_.add(step::Note{operation.name}, origin);
    if (is_laser(operation.kind)) return append(path_, piece->path);
    if (tool_ != operation.tool) {
      if (tool_ && spindle_) path_.add(step::Spindle{}, origin);
      path_.add(step::ToolChange{operation.tool}, origin);
      spindle_.reset();
    }
    tool_ = operation.tool;
    if (operation.speed > SpindleSpeed{} && spindle_ != operation.speed) {
      path_.add(step::Spindle{operation.speed, SpindleTurn::cw}, origin);
      spindle_ = operation.speed;
    }
    append(path_, piece->path);
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
  bool failed_ = false;
};

}  // namespace

std::optional<Toolpath> compile_cut_job(const CutJob& job, const std::vector<ArtShape>& art,
                                        const std::map<int, Tool>& tools, Diagnostics& diagnostics,
                                        Progress* progress, const SurfaceMesh* mesh) {
  return JobCompiler(job, art, tools, diagnostics, progress, mesh).run();
}

}  // namespace kerf
