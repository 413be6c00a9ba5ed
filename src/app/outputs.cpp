// Meshes and pictures of a simulation.
#include "app/outputs.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fmt/format.h>
#include <limits>
#include <set>
#include <unistd.h>

#include "kerf/exact_mesh.h"
#include "kerf/image_files.h"
#include "kerf/number.h"
#include "kerf/stock_files.h"

namespace kerf::app {
namespace {

using Colour = std::array<std::uint8_t, 3>;

// Index 0 is the stock's own surface, 1 a surface made by a hazard, the rest one a tool (and round again).
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
constexpr int kMostPixels = 16384;  // a side of a picture

bool same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  if (std::filesystem::equivalent(a, b, ignored)) return true;
  return std::filesystem::path(a).lexically_normal() == std::filesystem::path(b).lexically_normal();
}

bool is_png(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".png";
}

/// Says early what would otherwise be said only after a long simulation.
void test_folder(const std::string& path, Diagnostics& diagnostics) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    diagnostics.error(Code::file_unwritable, TextSpot{path, 0, 0}, "cannot write the file: it is a folder");
    return;
  }
  std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (folder.empty()) folder = ".";
  if (!std::filesystem::is_directory(folder, ignored)) {
    diagnostics.error(Code::file_unwritable, TextSpot{path, 0, 0},
                      fmt::format("cannot write the file: there is no folder {}", folder.string()));
  } else if (access(folder.c_str(), W_OK) != 0) {
    diagnostics.error(
        Code::file_unwritable, TextSpot{path, 0, 0},
        fmt::format("cannot write the file: the folder {} may not be written to", folder.string()));
  }
}

/// The colours of a part's surface: of each triangle, and what they stand for.
struct Colouring {
  std::vector<std::uint8_t> of_triangle;
  std::vector<std::string> names;  // of the palette, as far as it is used
};

/// The palette's index of every step: of the tool in force, or of a hazard. Names the colours used.
std::vector<std::uint8_t> colours_of_steps(const Toolpath& path,
                                           const std::vector<std::uint32_t>& hazard_steps,
                                           std::vector<std::string>& names) {
  names = {"stock", "hazard"};
  std::vector<std::uint8_t> colours(path.size(), kFirstToolColour);
  std::vector<int> seen;
  std::uint8_t now = kFirstToolColour;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i].kind() == StepKind::tool_change) {
      const int tool = path[i].tool_change().tool;
      const auto it = std::find(seen.begin(), seen.end(), tool);
      const auto place = static_cast<std::size_t>(it - seen.begin());
      now = static_cast<std::uint8_t>(kFirstToolColour + place % (kPalette.size() - kFirstToolColour));
      if (it == seen.end()) {
        seen.push_back(tool);
        if (now == names.size()) names.emplace_back();
        names[now] += fmt::format("{}tool {}", names[now].empty() ? "" : ", ", tool);
      }
    }
    colours[i] = now;
  }
  for (const std::uint32_t step : hazard_steps) colours[step] = kHazardColour;
  if (names.size() == kFirstToolColour) names.emplace_back("part");
  return colours;
}

Colouring colours_of(const Mesh& mesh, const Toolpath& path, const std::vector<std::uint32_t>& hazard_steps) {
  Colouring colouring;
  const auto of_step = colours_of_steps(path, hazard_steps, colouring.names);
  colouring.of_triangle.reserve(mesh.step.size());
  for (const std::uint32_t step : mesh.step)
    colouring.of_triangle.push_back(step < of_step.size() ? of_step[step] : kStockColour);
  return colouring;
}

std::string picture_of(const Mesh& mesh, const std::vector<std::uint8_t>& colours, const View& view) {
  std::vector<Colour> rgb;
  rgb.reserve(colours.size());
  for (const std::uint8_t c : colours) rgb.push_back(kPalette[c]);
  const Image image = render(mesh, rgb, view);
  return write_png({image.width, image.height, image.rgba});
}

std::string mesh_file_of(const Mesh& mesh, const Colouring& colours, MeshFormat format,
                         const std::string& source) {
  MeshView view;
  view.positions = mesh.positions;
  view.triangles = mesh.triangles;
  view.colour_index = colours.of_triangle;
  view.palette = kPalette;
  view.palette_names = colours.names;
  view.step = mesh.step;
  view.name = std::filesystem::path(source).stem().string();
  return write_mesh(view, format);
}

std::optional<std::pair<double, double>> split_pair(const std::string& text, char separator) {
  const std::size_t at = text.find(separator);
  if (at == std::string::npos) return std::nullopt;
  const auto a = parse_number(std::string_view(text).substr(0, at));
  const auto b = parse_number(std::string_view(text).substr(at + 1));
  if (!a || !b) return std::nullopt;
  return {{*a, *b}};
}

constexpr std::string_view kAxes = "xyz";
constexpr std::array<Plane, 3> kAcross{Plane::yz, Plane::xz, Plane::xy};  // by the axis

std::string text_of(const Section& section) {
  return fmt::format("{}={}", kAxes[static_cast<std::size_t>(axes_of(section.plane).w)],
                     exact_text(section.at));
}

/// "x=25"
std::optional<Section> parse_section(std::string_view text) {
  const std::size_t axis =
      text.empty() ? std::string_view::npos
                   : kAxes.find(static_cast<char>(std::tolower(static_cast<unsigned char>(text[0]))));
  if (axis == std::string_view::npos || text.size() < 3 || text[1] != '=') return std::nullopt;
  const auto at = parse_length(text.substr(2), 1.0);
  if (!at) return std::nullopt;
  return Section{kAcross[axis], *at};
}

bool read_section(const std::string& text, View& view, std::string& problem) {
  view.section = parse_section(text);
  if (!view.section) {
    problem = fmt::format(
        "--section: \"{}\" is no plane; expected an axis and a place on it in mm or with \"in\", as x=25, "
        "y=-3.5 or z=0.25in",
        text.substr(0, 40));
    return false;
  }
  if (faces(view, *view.section)) return true;
  problem = fmt::format("--section: this view sees no more of {} than its edge; choose another --view",
                        text_of(*view.section));
  return false;
}

}  // namespace

std::vector<OutputFile> read_outputs(const std::vector<std::string>& names,
                                     const std::vector<std::string>& inputs, Diagnostics& usage,
                                     Diagnostics& diagnostics) {
  std::vector<OutputFile> files;
  for (const std::string& name : names) {
    const auto mesh = mesh_format_of(name);
    if (!mesh && !is_png(name) && !is_left_file(name)) {
      usage
          .error(Code::output_kind_unknown, CallSpot{"", 0, "-o"},
                 fmt::format("\"{}\" ends in no format that can be written", name))
          .hint =
          "known endings: .stl .3mf .glb .obj for the part's surface, .png for a picture, .kstock for the "
          "next job";
      continue;
    }
    const auto is_name = [&name](const std::string& input) {
      return !input.empty() && same_file(input, name);
    };
    const auto again = [&name](const OutputFile& other) { return same_file(other.path, name); };
    if (std::any_of(inputs.begin(), inputs.end(), is_name) ||
        std::any_of(files.begin(), files.end(), again)) {
      usage.error(Code::output_is_input, CallSpot{"", 0, "-o"},
                  fmt::format("\"{}\" is an input, or stands twice among the outputs", name));
      continue;
    }
    test_folder(name, diagnostics);
    files.push_back({name, mesh, is_left_file(name)});
  }
  return files;
}

std::optional<View> read_view(const PictureOptions& options, std::string& problem) {
  View out;
  if (const auto named = named_view(options.view)) {
    out = *named;
  } else if (const auto angles = split_pair(options.view, ',')) {
    if (std::abs(angles->first) > 360.0 || std::abs(angles->second) > 90.0) {
      problem = "--view: the azimuth goes from -360 to 360 degrees and the elevation from -90 to 90";
      return std::nullopt;
    }
    out.azimuth = degrees(angles->first);
    out.elevation = degrees(angles->second);
  } else {
    problem = fmt::format(
        "--view: \"{}\" is neither top, bottom, front, back, left, right or iso nor AZIMUTH,ELEVATION",
        options.view.substr(0, 40));
    if (const auto close =
            did_you_mean(options.view, {"top", "bottom", "front", "back", "left", "right", "iso"}))
      problem += fmt::format("; did you mean {}?", *close);
    return std::nullopt;
  }
  const auto pixels = split_pair(options.size, 'x');
  const auto good = [](double v) {
    return v >= 16 && v <= kMostPixels && v == static_cast<double>(static_cast<int>(v));
  };
  if (!pixels || !good(pixels->first) || !good(pixels->second)) {
    problem = fmt::format("--size: \"{}\" is no WIDTHxHEIGHT in pixels, each from 16 to {}",
                          options.size.substr(0, 40), kMostPixels);
    return std::nullopt;
  }
  out.width = static_cast<int>(pixels->first);
  out.height = static_cast<int>(pixels->second);
  if (!options.section.empty() && !read_section(options.section, out, problem)) return std::nullopt;
  return out;
}

Option add_section(CommandParser& parser, PictureOptions& options) {
  return parser
      .add_text("--section", options.section,
                "Picture of the part cut open at x=25, y=-3.5 or z=1in: without the viewer's side of that")
      .value_name("PLANE");
}

bool section_meets(const Mesh& mesh, const View& view, Diagnostics& diagnostics) {
  if (!view.section) return true;
  const auto axis = static_cast<std::size_t>(axes_of(view.section->plane).w);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t k = axis; k < mesh.positions.size(); k += 3) {
    low = std::min<double>(low, mesh.positions[k]);
    high = std::max<double>(high, mesh.positions[k]);
  }
  if (view.section->at > low && view.section->at < high) return true;
  const std::string part = low < high ? fmt::format("the part, which lies from {}={} to {}", kAxes[axis],
                                                    number_text(low, 3), number_text(high, 3))
                                      : "anything: nothing is left";
  diagnostics.error(Code::section_outside, CallSpot{"", 0, "--section"},
                    fmt::format("{} does not go through {}", text_of(*view.section), part));
  return false;
}

std::vector<std::uint8_t> colour_groups(const Toolpath& path,
                                        const std::vector<std::uint32_t>& hazard_steps) {
  std::vector<std::string> names;
  return colours_of_steps(path, hazard_steps, names);
}

bool write_surface(const std::vector<OutputFile>& files, const LoadedProgram& program, const Mesh& mesh,
                   const VolumeRange& volume, const std::vector<std::uint32_t>& hazard_steps,
                   const View& view, OutputSet& set, Diagnostics& diagnostics, Progress& progress) {
  const auto is_mesh = [](const OutputFile& file) { return file.mesh.has_value(); };
  if (std::any_of(files.begin(), files.end(), is_mesh) && !verify_mesh(mesh, volume, diagnostics))
    return false;
  if (mesh.triangles.empty())
    diagnostics
        .warning(Code::nothing_left, TextSpot{program.source, 0, 0},
                 "nothing of the stock is left, so that meshes and pictures are empty")
        .hint = "look at the stock's size and place, and at the program's units";
  const Colouring colours = colours_of(mesh, program.path, hazard_steps);
  progress.phase("writing");
  for (std::size_t i = 0; i < files.size(); ++i) {
    progress.report(static_cast<double>(i) / static_cast<double>(files.size()));
    const OutputFile& file = files[i];
    if (file.is_picture() && !section_meets(mesh, view, diagnostics)) return false;
    const std::string bytes = file.mesh ? mesh_file_of(mesh, colours, *file.mesh, program.source)
                                        : picture_of(mesh, colours.of_triangle, view);
    if (!set.write(file.path, bytes, diagnostics) || progress.stop_requested()) return false;
  }
  return true;
}

void refuse_left(const std::vector<OutputFile>& files, std::string_view what, Diagnostics& diagnostics) {
  for (const OutputFile& file : files)
    if (file.is_left)
      diagnostics
          .error(Code::output_kind_unknown, CallSpot{"", 0, "-o"},
                 fmt::format("\"{}\": {} cannot be the stock of a next job yet", file.path, what))
          .hint = "write it as a mesh, and take that as --stock-mesh";
}

std::optional<Status> finish_outputs(Console& console, TerminalProgress& progress, bool written,
                                     OutputSet& set, Diagnostics& diagnostics) {
  progress.clear();
  if (interrupted()) return tell_stopped(console);
  if (!written || !set.commit(diagnostics)) return fail(console, diagnostics, Status::input_errors);
  return std::nullopt;
}

Json json_of(const std::vector<OutputFile>& files) {
  Json list = Json::array();
  for (const OutputFile& file : files) list.push_back(file.path);
  return list;
}

void show_written(Console& console, const std::vector<OutputFile>& files) {
  for (const OutputFile& file : files) console.summary(fmt::format("wrote    {}", file.path));
}

namespace {

/// Whether anybody can see how the columns stand: in a mesh, and in a picture where they are larger than its
/// pixels.
bool shows_columns(const std::vector<OutputFile>& surfaces, const Workpiece& workpiece, const View& view) {
  const auto is_mesh = [](const OutputFile& file) { return !file.is_picture(); };
  if (std::any_of(surfaces.begin(), surfaces.end(), is_mesh)) return true;
  const Point3 size = workpiece.bounds().size();
  return workpiece.pitch().mm() * std::min(view.width, view.height) > std::max(size.x, size.y);
}

}  // namespace

bool write_outputs(const std::vector<OutputFile>& files, const Job& job, const Simulation& simulation,
                   const View& view, OutputSet& set, Diagnostics& diagnostics, Progress& progress) {
  std::vector<OutputFile> surfaces;
  for (const OutputFile& file : files) {
    if (!file.is_left) {
      surfaces.push_back(file);
    } else if (!set.write(file.path, write_left_file(left_columns(simulation.workpiece)), diagnostics)) {
      return false;
    }
  }
  if (surfaces.empty()) return true;
  progress.phase("making the surface");
  const std::vector<std::uint32_t> hazards = steps_of(simulation.hazards);
  const auto step_colours = colour_groups(job.program.path, hazards);
  const MeshOptions options{.tolerance = kMeshTolerance, .step_groups = step_colours};
  const MeshColumns columns(simulation.workpiece);
  std::optional<Mesh> mesh;
  if (shows_columns(surfaces, simulation.workpiece, view)) {
    mesh = extract_exact_mesh(columns, options, simulation.workpiece, job.program.path, job.tools, *job.stock,
                              diagnostics, &progress);
  } else {
    mesh = extract_mesh(columns, options, &progress);
    relabel_mesh(*mesh, simulation.workpiece);
  }
  if (!mesh || progress.stop_requested()) return false;
  const VolumeRange volume = mesh_volume(columns, {.tolerance = kMeshTolerance + SharpenOptions().tolerance});
  return write_surface(surfaces, job.program, *mesh, volume, hazards, view, set, diagnostics, progress);
}

}  // namespace kerf::app
