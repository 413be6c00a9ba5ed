// The rows of the operations of mills on meshes.
#include "op/mesh/rows.h"

#include "op/base/row_keys.h"

#include "kerf/op/surface.h"

namespace kerf::op_detail {
namespace {

constexpr std::string_view kStock = "0,0,-12 to 60,40,0";
constexpr std::string_view kHill =
    "[surface]                 # or file = \"part.stl\" (.3mf, .obj), with move = [x, y, z] and scale\n"
    "rectangle = [0, 0, 60, 40]\n"
    "heights = [               # Z in rows from low to high Y, at equal distances\n"
    "  [-6, -6, -5, -5, -6, -6, -6],\n"
    "  [-6, -4, -2, -2, -4, -5, -6],\n"
    "  [-5, -2,  0,  0, -3, -4, -5],\n"
    "  [-6, -4, -2, -1, -2, -4, -6],\n"
    "  [-6, -6, -5, -4, -5, -6, -6],\n"
    "]\n\n";

/// Of operations that remove what is above a mesh.
struct ShapingOptions : MeshCutOptions {
  std::optional<double> surface;  ///< nothing: at the highest point of the mesh
  std::optional<int> rest_tool;
  Length overhang{};  ///< how far the axis goes beyond the mesh

  /// Completed by what is known of the mesh; false, with an error, if the earlier tool has no shape.
  bool complete_for(const CutWork& work, Diagnostics& d) {
    cut.top = surface.value_or(work.mesh_box.empty() ? 0.0 : work.mesh_box.high.z);
    if (!rest_tool) return true;
    const Tool* tool = work.tool_of(*rest_tool, d);
    if (tool != nullptr) earlier = *tool;
    return tool != nullptr;
  }
};

template <class Options>
Keys<Options>& surface_and_depth(Keys<Options>& keys) {
  return keys
      .add(
          {.name = "top",
           .meaning = "Z of the surface of the material",
           .example = "0",
           .otherwise = "the highest point of the mesh",
           .unit = "mm"},
          [](Options & o) -> auto& { return o.surface; })
      .own_depth("6", "down to the lowest point of the mesh")
      .stepdown();
}

template <class Options>
Keys<Options>& tolerance(Keys<Options>& keys) {
  return keys.add(
      {.name = "tolerance",
       .meaning = "how far above the mesh the path may be",
       .example = "0.01",
       .range = within(0.0001, 1)},
      [](Options & o) -> auto& { return o.tolerance; });
}

template <class Options>
Keys<Options>& rest(Keys<Options>& keys) {
  return keys.rest_tool().add(
      {.name = "rest-thickness",
       .meaning = "thickness of what rest-tool left: what is thinner is not cut",
       .example = "0.1",
       .range = at_least(0.01)},
      [](Options & o) -> auto& { return o.rest_thickness; });
}

/// The rectangle around the mesh.
std::optional<Region> area_of(const CutWork& work, Length overhang, Diagnostics& d) {
  if (work.mesh_box.empty()) return Region{};
  const Box2 box = Box2{work.mesh_box.low.xy(), work.mesh_box.high.xy()}.grown(overhang.mm());
  Outline outline{box.low, {}};
  for (const Point2 p : {Point2{box.high.x, box.low.y}, box.high, Point2{box.low.x, box.high.y}, box.low})
    outline.segments.push_back({p, {}});
  RegionOptions options;
  options.name = work.operation.name, options.where = work.operation.where;
  return make_region({outline}, FillRule::even_odd, options, d);
}

CutRow raster_row() {
  using Options = ShapingOptions;
  Keys<Options> keys;
  surface_and_depth(keys.selection().tool()).stepover("0.1").rates().allowance().combine();
  keys.add(
          {.name = "angle", .meaning = "direction of the lines, from +X", .example = "0"},
          [](Options & o) -> auto& { return o.angle; })
      .add(
          {.name = "line-distance",
           .meaning = "distance of the lines; 0: by stepover",
           .example = "0",
           .range = at_least(0)},
          [](Options & o) -> auto& { return o.line_distance; })
      .add(
          {.name = "overhang",
           .meaning = "how far the axis goes beyond the mesh where no area is selected",
           .example = "0",
           .range = within(0, limits::kMaxToolSize)},
          [](Options & o) -> auto& { return o.overhang; });
  tolerance(rest(keys));
  return row_of({.name = "raster",
                 .sentence = "Cut a mesh in parallel lines.",
                 .cuts = "the mesh",
                 .input = CutInput::mesh_in_region,
                 .example = {.shapes = kHill, .tool = "ball d=6", .stock = kStock}},
                keys, [](Options o, const CutWork& work, Diagnostics& d) -> std::optional<Operation> {
                  if (!o.complete_for(work, d)) return std::nullopt;
                  const auto area = work.region ? work.region : area_of(work, o.overhang, d);
                  return area ? raster(*work.mesh, *area, *work.tool, o, d) : std::nullopt;
                });
}

CutRow waterline_row() {
  using Options = ShapingOptions;
  Keys<Options> keys;
  surface_and_depth(keys.selection().tool()).rates().allowance().direction();
  tolerance(rest(keys));
  return row_of({.name = "waterline",
                 .sentence = "Cut around a mesh on levels that are the stepdown apart.",
                 .cuts = "the mesh",
                 .input = CutInput::mesh,
                 .example = {.shapes = kHill, .tool = "ball d=6", .stock = kStock}},
                keys, [](Options o, const CutWork& work, Diagnostics& d) {
                  return o.complete_for(work, d) ? waterline(*work.mesh, *work.tool, o, d) : std::nullopt;
                });
}

CutRow project_row() {
  using Options = MeshCutOptions;
  Keys<Options> keys;
  tolerance(keys.selection().tool().levels("0.4").stepdown("0.4").rates());
  return row_of(
      {.name = "project",
       .sentence = "Engrave outlines on a mesh, `depth` below where the tool touches it.",
       .cuts = "the mesh",
       .input = CutInput::mesh_along_outlines,
       .example = {.shapes = kHill,
                   .tool = "V d=6 angle=60",
                   .second_tool = "ball d=6",
                   .before = "[[shape]]                 # shapes of the job itself, besides those of art\n"
                             "name = \"ring\"\n"
                             "circle = [30, 20, 24]     # x, y, diameter\n\n"
                             "[[operation]]             # the surface\n"
                             "op = \"raster\"\n"
                             "tool = 2\n"
                             "rpm = 16000\n"
                             "feed = 1200\n\n",
                   .stock = kStock}},
      keys, [](const Options& o, const CutWork& work, Diagnostics& d) {
        return project(*work.mesh, work.outlines(), *work.tool, o, d);
      });
}

}  // namespace

std::vector<CutRow> mesh_rows() { return {raster_row(), waterline_row(), project_row()}; }

}  // namespace kerf::op_detail
