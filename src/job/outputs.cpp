// Meshes, pictures and the left-over stock of a job.
#include "kerf/job/outputs.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "base/codes/files.h"
#include "base/codes/sim.h"
#include "base/ending.h"
#include "base/file_names.h"
#include "base/number.h"
#include "codec/picture/image_files.h"
#include "job/bead_colours.h"
#include "job/picture_marks.h"
#include "job/setup_sheet.h"

#include "kerf/formats/workshop_files.h"
#include "kerf/job/program_file.h"
#include "kerf/sim/exact_mesh.h"

namespace kerf {
namespace {

using Colour = std::array<std::uint8_t, 3>;

// Index 0: surface of the stock; 1: surface cut by a hazard; from 2: one per tool, cyclically.
constexpr std::array<Colour, 12> kPalette{{{222, 196, 156},
                                           {214, 40, 40},
                                           {86, 140, 190},
                                           {106, 168, 110},
                                           {232, 160, 64},
                                           {146, 112, 180},
                                           {72, 170, 170},
                                           {204, 130, 160},
                                           {150, 150, 70},
                                           {120, 130, 150},
                                           {176, 112, 80},
                                           {60, 110, 130}}};
constexpr std::uint8_t kStockColour = 0;
constexpr std::uint8_t kHazardColour = 1;
constexpr std::size_t kFirstToolColour = 2;
constexpr std::size_t kMaxPalette = 255;  // an index is a byte
constexpr int kMapPixels = 1600;          // width and height of the map of a comparison

constexpr std::string_view kAxes = "xyz";
constexpr std::array<Plane, 3> kAcross{Plane::yz, Plane::xz, Plane::xy};  // normal to X, Y and Z

/// The number that a step sets and that has a colour: of the extruder in a print with several, else of the
/// tool.
std::optional<int> coloured_number(const Toolpath& path, const Step& s) {
  if (path.has(StepKind::extruder))
    return s.kind() == StepKind::extruder ? std::optional(s.extruder().number) : std::nullopt;
  return s.kind() == StepKind::tool_change ? std::optional(s.tool_change().tool) : std::nullopt;
}

/// By the tool in force.
StepColours colour_tools(const Toolpath& path) {
  StepColours out;
  out.palette.assign(kPalette.begin(), kPalette.end());
  out.names = {"stock", "hazard"};
  out.of_step.assign(path.size(), kFirstToolColour);
  std::map<int, std::uint8_t> colours;
  const std::string_view noun = path.has(StepKind::extruder) ? "extruder" : "tool";
  for (const auto& [tool, colour] : tool_colours(path)) {
    colours[tool] = colour;
    if (colour == out.names.size()) out.names.emplace_back();
    out.names[colour] += fmt::format("{}{} {}", out.names[colour].empty() ? "" : ", ", noun, tool);
  }
  std::uint8_t now = kFirstToolColour;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (const auto tool = coloured_number(path, path[i])) now = colours.at(*tool);
    out.of_step[i] = now;
  }
  if (out.names.size() == kFirstToolColour) out.names.emplace_back("part");
  return out;
}

StepColours colour_steps(const Job& job, BeadColours beads, const std::vector<std::uint32_t>& hazard_steps) {
  const bool by_bead = job.kind == JobKind::print && beads != BeadColours::tool;
  StepColours out = by_bead ? colour_beads(job.program.path, beads) : colour_tools(job.program.path);
  for (const std::uint32_t step : hazard_steps) out.of_step[step] = kHazardColour;
  return out;
}

/// By the colours that the program sets: of cuts, or where a hazard is a contact, of what touches.
void colour_motions(StepColours& out, const Simulation& s, const std::vector<MotionColours>& motions) {
  const Toolpath& path = *s.job.path;
  std::vector<bool> shaft(path.size());
  for (const Hazard& h : s.hazards)
    if (h.kind == HazardKind::neck_contact || h.kind == HazardKind::shank_contact ||
        h.kind == HazardKind::holder_contact)
      shaft[h.step] = true;
  std::map<Colour, std::uint8_t> known;
  const auto index = [&](const Colour& colour, const char* name) {
    const auto [at, is_new] = known.emplace(colour, static_cast<std::uint8_t>(out.palette.size()));
    if (is_new && out.palette.size() < kMaxPalette) {
      out.names.resize(out.palette.size());
      out.palette.push_back(colour);
      out.names.emplace_back(name);
    }
    return std::min<std::uint8_t>(at->second, kMaxPalette - 1);
  };
  for (std::size_t k = 0; k < motions.size(); ++k) {
    const MotionColours& m = motions[k];
    const std::size_t end = k + 1 < motions.size() ? motions[k + 1].first_step : path.size();
    for (std::size_t i = m.first_step; i < std::min(end, path.size()); ++i)
      out.of_step[i] = shaft[i]                            ? index(m.shaft, "shaft")
                       : path[i].kind() == StepKind::rapid ? index(m.rapid, "rapid")
                                                           : index(m.cut, "cut");
  }
}
template <class Other>
void colour_motions(StepColours&, const Other&, const std::vector<MotionColours>&) {}

std::vector<std::uint8_t> colour_triangles(const Mesh& mesh, const StepColours& colours) {
  std::vector<std::uint8_t> out;
  out.reserve(mesh.step.size());
  for (const std::uint32_t step : mesh.step)
    out.push_back(step < colours.of_step.size() ? colours.of_step[step] : kStockColour);
  return out;
}

template <class Hazards>
std::vector<std::uint32_t> steps_of(const Hazards& hazards) {
  std::vector<std::uint32_t> steps;
  for (const auto& hazard : hazards) steps.push_back(hazard.step);
  return steps;
}

/// The steps whose surface is red. Of a print only those that damage something: bridges are permitted.
std::vector<std::uint32_t> red_steps(const Simulation& s) { return steps_of(s.hazards); }
std::vector<std::uint32_t> red_steps(const RotarySimulation& s) { return steps_of(s.hazards); }
std::vector<std::uint32_t> red_steps(const PrintSimulation& s) {
  std::vector<std::uint32_t> steps;
  for (const PrintHazard& h : s.hazards)
    if (h.kind == PrintHazardKind::nozzle_contact || h.kind == PrintHazardKind::in_air)
      steps.push_back(h.step);
  return steps;
}

/// The same job with smaller columns. Nothing if they are not smaller, or if stopped.
std::optional<Simulation> finer_cut(const Simulation& cut, Length pitch, Progress* progress) {
  if (pitch >= cut.workpiece.pitch()) return std::nullopt;
  SimulationJob job = cut.job;
  job.options.resolution = pitch;
  Diagnostics reported_before;
  std::optional<Simulation> finer = simulate(std::move(job), reported_before, progress);
  if (!finer || finer->stopped) return std::nullopt;
  return finer;
}

constexpr double kSmallRadius = 0.6;  // mm, of a small mill

/// The tolerance of a mesh for which none is given: the sagitta of an edge as long as a column that was asked
/// for, at the radius of a small mill.
Length implied_tolerance(const Simulation& cut) {
  const double column = cut.job.options.resolution.mm();  // 0: by the stock's size
  constexpr double kCoarsest = 0.1;                       // mm
  const double sagitta = column * column / (8.0 * kSmallRadius);
  return std::max(default_tolerance::kExactMesh, mm(std::min(sagitta, kCoarsest)));
}

/// Columns that are no wider than this show the cuts of all tools.
Length finest_tool(const Simulation& cut) {
  constexpr double kColumnsAcross = 3.0;
  double finest = std::numeric_limits<double>::infinity();
  for (const auto& [number, tool] : cut.job.tools.tools()) finest = std::min(finest, tool.diameter.mm());
  return mm(finest / kColumnsAcross);
}

/// Columns of which an exact mesh takes about the shortest time. Larger ones are split at most surfaces, and
/// each split examines more sweeps: 1,000,000 moves of a relief at 0.4 mm took 85 s, at 0.1 mm 1 s. See
/// docs/benchlog/first-picture.md.
Length mesh_pitch(const Simulation& cut, Length tolerance) {
  constexpr double kColumnsPerStep = 6.0;
  constexpr double kMaxColumns = 6e6;  // for the memory
  const Point3 size = cut.workpiece.bounds().size();
  const double area = size.x * size.y;
  const double edge = std::sqrt(8.0 * tolerance.mm() * kSmallRadius);  // whose sagitta is the tolerance
  const double steps = static_cast<double>(std::max<std::size_t>(cut.job.path->size(), 1));
  const double dense = std::sqrt(area / (kColumnsPerStep * steps));
  const double wanted = std::min({edge, dense, finest_tool(cut).mm()});
  return mm(std::max(wanted, std::sqrt(area / kMaxColumns)));
}

std::optional<CheckedMesh> mesh_of(const Simulation& s, MeshOptions options, const SurfaceOptions& how,
                                   Diagnostics& diagnostics, Progress* progress) {
  constexpr double kWorthwhile = 1.2;
  constexpr double kMerging = 0.5;  // of the tolerance, for triangles that are merged before they are fitted
  if (how.detail == SurfaceDetail::exact) {
    const Length tolerance = how.tolerance.value_or(implied_tolerance(s));
    const Length pitch = mesh_pitch(s, tolerance);
    options.tolerance = std::max(std::min(options.tolerance, tolerance), kMerging * tolerance);
    const auto finer = how.cut_finer && kWorthwhile * pitch < s.workpiece.pitch()
                           ? finer_cut(s, pitch, progress)
                           : std::nullopt;
    return extract_exact_mesh(finer ? *finer : s, options, diagnostics, progress, {.tolerance = tolerance});
  }
  options.tolerance = how.tolerance.value_or(options.tolerance);
  const MeshColumns columns(s.workpiece);
  CheckedMesh made{extract_mesh(columns, options, progress), mesh_volume(columns, options)};
  relabel_mesh(made.mesh, s.workpiece);
  return made;
}

std::optional<CheckedMesh> mesh_of(const RotarySimulation& s, const MeshOptions&, const SurfaceOptions&,
                                   Diagnostics&, Progress* progress) {
  return CheckedMesh{extract_mesh(s.workpiece, progress), mesh_volume(s.workpiece)};
}

std::optional<CheckedMesh> mesh_of(const PrintSimulation& s, MeshOptions options, const SurfaceOptions& how,
                                   Diagnostics&, Progress* progress) {
  options.tolerance = how.tolerance.value_or(options.tolerance);
  Length layer;
  for (const PrintLayer& l : s.layers) layer = std::max(layer, l.height);
  const bool kept = how.grooves == Grooves::kept;
  const ColumnGrid closed = kept ? ColumnGrid{} : without_grooves(s.columns, layer);
  const ColumnGrid& columns = kept ? s.columns : closed;
  return CheckedMesh{extract_print_mesh(columns, options, progress), mesh_volume(columns, options)};
}

std::string mesh_bytes(const PartSurface& surface, MeshFormat format, std::string_view name) {
  MeshView view;
  view.positions = surface.mesh.positions;
  view.triangles = surface.mesh.triangles;
  view.colour_index = surface.colours;
  view.palette = surface.palette;
  view.palette_names = surface.colour_names;
  view.step = surface.mesh.step;
  view.name = name;
  return write_mesh(view, format);
}

/// The size on the part, about, of one of `pixels` across it.
Length pixel_size(const Workpiece& workpiece, int pixels) {
  const Point3 size = workpiece.bounds().size();
  return mm(std::max(size.x, size.y) / pixels);
}
Length pixel_size(const Workpiece& workpiece, const View& view) {
  return pixel_size(workpiece, std::min(view.width, view.height));
}

/// Whether the columns would be visible in a picture.
bool shows_columns(const Simulation& simulation, const View& view) {
  return simulation.workpiece.pitch() > pixel_size(simulation.workpiece, view);
}

bool has_mesh(const std::vector<PartFile>& files) {
  return std::any_of(files.begin(), files.end(), [](const PartFile& file) { return file.mesh.has_value(); });
}

/// Whether all files are for viewers: GLB, without pictures, which show more than such a viewer.
bool only_viewed(const std::vector<PartFile>& files) {
  return std::all_of(files.begin(), files.end(),
                     [](const PartFile& file) { return file.mesh == MeshFormat::glb; });
}

/// The surface that the files show. Where all are pictures, that of the columns if they are smaller than the
/// pixels, else an exact one within a fraction of a pixel. GLB files alone are coarser.
SurfaceOptions surface_of(const std::vector<PartFile>& files, const JobRun& run,
                          const PartFileOptions& options) {
  constexpr double kVisible =
      0.03;  // pixels; more in the position would hardly show, but does in the shading
  SurfaceOptions surface{.grooves = options.grooves, .beads = options.beads, .motions = options.motions};
  if (options.tolerance) surface.tolerance = fitted_tolerance(*options.tolerance);
  const auto* cut = std::get_if<Simulation>(&run.result);
  if (options.detail) {
    surface.detail = *options.detail;
    return surface;
  }
  if (cut == nullptr || surface.tolerance) return surface;
  if (only_viewed(files)) surface.tolerance = std::max(kViewedMeshTolerance, implied_tolerance(*cut));
  if (has_mesh(files)) return surface;
  if (!shows_columns(*cut, options.view)) surface.detail = SurfaceDetail::columns;
  surface.tolerance =
      std::max(default_tolerance::kExactMesh, kVisible * pixel_size(cut->workpiece, options.view));
  return surface;
}

/// Columns that are fine enough for a picture without an exact surface.
Length picture_pitch(const Workpiece& workpiece, const View& view) {
  constexpr int kMaxAcross = 1600;  // pixels; of larger pictures the surface is exact instead
  constexpr double kColumn = 0.7;   // pixels: walls and rims are smooth
  return kColumn * pixel_size(workpiece, std::min({view.width, view.height, kMaxAcross}));
}

/// The same job with columns smaller than a pixel, if only pictures are written and the columns would be
/// visible in them: cutting again takes less time than an exact surface of coarse columns, and shows more.
/// Its hazards are those of both runs. Nothing otherwise, or if stopped.
std::optional<JobRun> finer_run(const std::vector<PartFile>& files, const JobRun& run, const View& view,
                                Progress* progress) {
  const auto* cut = std::get_if<Simulation>(&run.result);
  if (cut == nullptr || has_mesh(files) || !shows_columns(*cut, view)) return std::nullopt;
  std::optional<Simulation> finer = finer_cut(*cut, picture_pitch(cut->workpiece, view), progress);
  if (!finer) return std::nullopt;
  finer->hazards.insert(finer->hazards.end(), cut->hazards.begin(), cut->hazards.end());
  return JobRun{std::move(*finer), {}};
}

std::vector<PartFile> surfaces_of(const std::vector<PartFile>& files) {
  std::vector<PartFile> out;
  std::copy_if(files.begin(), files.end(), std::back_inserter(out),
               [](const PartFile& file) { return !file.is_left && !file.is_program && !file.is_sheet; });
  return out;
}

/// False, with an error, if the section plane does not intersect the mesh.
bool section_intersects(const Mesh& mesh, const View& view, Diagnostics& diagnostics) {
  if (!view.section) return true;
  const auto axis = static_cast<std::size_t>(axes_of(view.section->plane).w);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t k = axis; k < mesh.positions.size(); k += 3) {
    low = std::min<double>(low, mesh.positions[k]);
    high = std::max<double>(high, mesh.positions[k]);
  }
  if (view.section->at > low && view.section->at < high) return true;
  const std::string part = low < high ? fmt::format("the part, which extends from {}={} to {}", kAxes[axis],
                                                    number_text(low, 3), number_text(high, 3))
                                      : "anything: no material is left";
  diagnostics.error(codes::section_outside, CallLocation{"", 0, "--section"},
                    fmt::format("{} does not intersect {}", to_string(*view.section), part));
  return false;
}

/// The colour of each triangle, from the comparison's map.
std::vector<Colour> comparison_colours(const Mesh& mesh, const Simulation& simulation, const Comparison& c,
                                       Length full) {
  constexpr Colour kOnTarget{176, 206, 160};
  const Box3& block = simulation.workpiece.bounds();
  const double pitch = simulation.workpiece.pitch().mm();
  const auto column = [pitch](double v, double low, int count) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>((v - low) / pitch), 0, count - 1));
  };
  std::vector<Colour> colours;
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    double x = 0.0, y = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      x += static_cast<double>(mesh.positions[std::size_t{3} * mesh.triangles[t + k]]) / 3.0;
      y += static_cast<double>(mesh.positions[std::size_t{3} * mesh.triangles[t + k] + 1]) / 3.0;
    }
    const std::size_t n =
        column(y, block.low.y, c.ny) * static_cast<std::size_t>(c.nx) + column(x, block.low.x, c.nx);
    const auto depth = static_cast<double>(c.map[n]);
    colours.push_back(depth == 0.0 ? kOnTarget : difference_colour(depth, full));
  }
  return colours;
}

/// Whether pictures show the toolpath instead of the part.
bool shows_path(const JobRun& run, PictureContent content) {
  if (content != PictureContent::automatic) return content == PictureContent::path;
  const auto* cut = std::get_if<Simulation>(&run.result);
  return cut != nullptr && !(cut->removed > Volume());
}

Box3 box_of(const Mesh& mesh) {
  Box3 box;
  for (std::size_t k = 0; k + 2 < mesh.positions.size(); k += 3)
    box.add(Point3{mesh.positions[k], mesh.positions[k + 1], mesh.positions[k + 2]});
  return box;
}

/// The colours that triangles have.
std::vector<LegendEntry> legend_of(const PartSurface& surface) {
  std::vector<bool> used(surface.palette.size(), false);
  for (const std::uint8_t colour : surface.colours) used[colour] = true;
  std::vector<LegendEntry> legend;
  for (std::size_t k = 0; k < used.size(); ++k)
    if (used[k] && k < surface.colour_names.size())
      legend.emplace_back(surface.colour_names[k], surface.palette[k]);
  return legend;
}

std::string png_of(const Image& image) { return write_png({image.width, image.height, image.rgba}); }

}  // namespace

std::optional<Section> parse_section(std::string_view text) {
  const std::size_t axis =
      text.empty() ? std::string_view::npos
                   : kAxes.find(static_cast<char>(std::tolower(static_cast<unsigned char>(text[0]))));
  if (axis == std::string_view::npos || text.size() < 3 || text[1] != '=') return std::nullopt;
  const auto at = parse_length(text.substr(2), 1.0);
  if (!at) return std::nullopt;
  return Section{kAcross[axis], *at};
}

std::string to_string(const Section& section) {
  return fmt::format("{}={}", kAxes[static_cast<std::size_t>(axes_of(section.plane).w)],
                     exact_text(section.at));
}

std::vector<std::pair<int, std::uint8_t>> tool_colours(const Toolpath& path) {
  std::vector<std::pair<int, std::uint8_t>> colours;
  std::set<int> seen;
  for (const Step& s : path.steps()) {
    const auto tool = coloured_number(path, s);
    if (!tool || !seen.insert(*tool).second) continue;
    const std::size_t colour = kFirstToolColour + colours.size() % (kPalette.size() - kFirstToolColour);
    colours.emplace_back(*tool, static_cast<std::uint8_t>(colour));
  }
  return colours;
}

std::span<const std::array<std::uint8_t, 3>> part_palette() { return kPalette; }

std::optional<BeadColours> bead_colours_named(std::string_view name) {
  constexpr std::array<std::string_view, 6> kNames{"tool", "kind", "layer", "speed", "flow", "temperature"};
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<BeadColours>(found - kNames.begin());
}

std::vector<std::pair<std::string, std::array<std::uint8_t, 3>>> bead_legend(const Toolpath& path,
                                                                             BeadColours by) {
  std::vector<std::pair<std::string, std::array<std::uint8_t, 3>>> legend;
  if (by == BeadColours::tool) return legend;
  const StepColours colours = colour_beads(path, by);
  std::vector<bool> used(colours.palette.size(), false);
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path[i].kind() == StepKind::extrude && path.extrude(i).volume > Volume())
      used[colours.of_step[i]] = true;
  for (std::size_t k = 0; k < used.size(); ++k)
    if (used[k] || k == kHazardColour) legend.emplace_back(colours.names[k], colours.palette[k]);
  return legend;
}

std::optional<PartSurface> make_surface(const Job& job, const JobRun& run, const SurfaceOptions& how,
                                        Diagnostics& diagnostics, Progress* progress) {
  if (progress != nullptr) progress->phase("extracting the surface");
  StepColours colours = std::visit(
      [&](const auto& result) {
        StepColours made = colour_steps(job, how.beads, red_steps(result));
        colour_motions(made, result, how.motions);
        return made;
      },
      run.result);
  const MeshOptions options{.tolerance = kMeshTolerance, .step_groups = colours.of_step};
  std::optional<CheckedMesh> made = std::visit(
      [&](const auto& result) { return mesh_of(result, options, how, diagnostics, progress); }, run.result);
  if (!made || (progress != nullptr && progress->stop_requested())) return std::nullopt;
  PartSurface surface{std::move(*made), {}, std::move(colours.names), std::move(colours.palette)};
  surface.colours = colour_triangles(surface.mesh, colours);
  if (surface.mesh.triangles.empty())
    diagnostics
        .warning(codes::nothing_left, TextLocation{job.program.source, 0, 0},
                 "the whole stock is cut away; meshes and pictures are empty")
        .hint = "check size and position of the stock, and the units of the program";
  return surface;
}

std::optional<std::string> mesh_file(const PartSurface& surface, MeshFormat format, std::string_view name,
                                     Diagnostics& diagnostics) {
  if (!verify_mesh(surface, diagnostics)) return std::nullopt;
  return mesh_bytes(surface, format, name);
}

std::optional<std::string> picture_file(const PartSurface& surface, const View& view,
                                        Diagnostics& diagnostics) {
  if (!section_intersects(surface.mesh, view, diagnostics)) return std::nullopt;
  std::vector<Colour> rgb;
  rgb.reserve(surface.colours.size());
  for (const std::uint8_t c : surface.colours) rgb.push_back(surface.palette[c]);
  if (!view.marks.any()) return png_of(render(surface.mesh, rgb, view));
  View shown = view;
  const auto marks = draw_marks(shown, box_of(surface.mesh), legend_of(surface));
  return png_of(render(surface.mesh, rgb, shown, [&](const auto& draw) {
    for (const PictureLine& line : marks) draw(line);
  }));
}

std::string burn_picture(const BurnMap& map, double black, int width, int height) {
  return png_of(draw_burn(map, black, width, height));
}

std::optional<std::string> comparison_picture(const Simulation& simulation, const Comparison& comparison,
                                              Length full, const std::optional<View>& view,
                                              Diagnostics& diagnostics, Progress* progress) {
  if (!view) return png_of(draw_map(comparison, full, kMapPixels));
  const Mesh mesh = extract_mesh(MeshColumns(simulation.workpiece), {}, progress);
  if (progress != nullptr && progress->stop_requested()) return std::nullopt;
  if (!section_intersects(mesh, *view, diagnostics)) return std::nullopt;
  return png_of(render(mesh, comparison_colours(mesh, simulation, comparison, full), *view));
}

std::optional<PartFile> part_file(const std::string& path) {
  const std::string ending = ending_of(path);
  PartFile file{path, mesh_format_of(path), is_left_file(path), ending == ".kerf",
                ending == ".html" || ending == ".svg"};
  if (file.is_picture() && ending != ".png") return std::nullopt;
  return file;
}

namespace {

bool write_sheets(const std::vector<PartFile>& files, const Job& job, const Machine* machine, OutputSet& set,
                  Diagnostics& diagnostics, Progress* progress) {
  std::optional<SetupSheet> sheet;
  for (const PartFile& file : files) {
    if (!file.is_sheet) continue;
    if (!sheet) sheet = setup_sheet(job, {.machine = machine}, diagnostics, progress);
    if (!sheet) return false;
    const bool drawn = ending_of(file.path) == ".svg";
    if (!set.write(file.path, drawn ? setup_sheet_svg(*sheet) : setup_sheet_html(*sheet), diagnostics))
      return false;
  }
  return true;
}

}  // namespace

bool can_write(const std::vector<PartFile>& files, JobKind kind, Diagnostics& diagnostics) {
  if (kind == JobKind::milling) return true;
  bool can = true;
  for (const PartFile& file : files) {
    if (file.is_sheet && kind == JobKind::print) {
      can = false;
      diagnostics.error(
          codes::output_kind_unknown, CallLocation{"", 0, "-o"},
          fmt::format("\"{}\": a setup sheet is for programs that cut; this one prints", file.path));
    }
    if (!file.is_left) continue;
    can = false;
    diagnostics
        .error(codes::output_kind_unknown, CallLocation{"", 0, "-o"},
               fmt::format("\"{}\": {} cannot be stored as left-over stock", file.path,
                           kind == JobKind::print ? "a print" : "the rest of a bar"))
        .hint = "write a mesh instead, and use it with --stock-mesh";
  }
  return can;
}

bool write_part(const std::vector<PartFile>& files, const Job& job, const JobRun& run,
                const PartFileOptions& options, OutputSet& set, Diagnostics& diagnostics,
                Progress* progress) {
  if (!can_write(files, job.kind, diagnostics)) return false;
  const auto* cut = std::get_if<Simulation>(&run.result);
  for (const PartFile& file : files) {
    if (file.is_left && !set.write(file.path, write_left_file(left_columns(cut->workpiece)), diagnostics))
      return false;
    if (file.is_program && !set.write(file.path, write_program(program_of(job)), diagnostics)) return false;
  }
  if (!write_sheets(files, job, options.machine, set, diagnostics, progress)) return false;
  std::vector<PartFile> surfaces = surfaces_of(files);
  if (shows_path(run, options.content)) {
    const auto first = std::stable_partition(surfaces.begin(), surfaces.end(),
                                             [](const PartFile& file) { return !file.is_picture(); });
    const bool drawn = first != surfaces.end();
    if (!write_path({first, surfaces.end()}, job, options.view, set, diagnostics)) return false;
    surfaces.erase(first, surfaces.end());
    if (drawn && options.content == PictureContent::automatic)
      diagnostics.note(codes::path_shown, TextLocation{job.program.source, 0, 0},
                       "no material is removed: the picture shows the toolpath");
  }
  if (surfaces.empty()) return true;
  const std::optional<JobRun> finer =
      options.detail ? std::nullopt : finer_run(surfaces, run, options.view, progress);
  if (progress != nullptr && progress->stop_requested()) return false;
  const JobRun& shown = finer ? *finer : run;
  const auto surface = make_surface(job, shown, surface_of(surfaces, shown, options), diagnostics, progress);
  if (!surface) return false;
  if (has_mesh(surfaces) && !verify_mesh(*surface, diagnostics)) return false;
  const std::string name = stem_of(job.program.source);
  if (progress != nullptr) progress->phase("writing");
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (progress != nullptr) progress->report(static_cast<double>(i) / static_cast<double>(surfaces.size()));
    const std::optional<std::string> bytes =
        surfaces[i].mesh ? std::optional(mesh_bytes(*surface, *surfaces[i].mesh, name))
                         : picture_file(*surface, options.view, diagnostics);
    if (!bytes || !set.write(surfaces[i].path, *bytes, diagnostics)) return false;
    if (progress != nullptr && progress->stop_requested()) return false;
  }
  return true;
}

std::optional<Length> mesh_tolerance(const std::vector<PartFile>& files, const JobRun& run,
                                     const PartFileOptions& options) {
  const auto* cut = std::get_if<Simulation>(&run.result);
  if (cut == nullptr || !has_mesh(files)) return std::nullopt;
  if (options.tolerance) return options.tolerance;
  return surface_of(surfaces_of(files), run, options).tolerance.value_or(implied_tolerance(*cut));
}

}  // namespace kerf
