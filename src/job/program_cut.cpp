// Cutting jobs as a way in: the art and the tools of a job file, and the program made of them.
#include <utility>

#include "base/codes/op.h"
#include "base/codes/stock.h"
#include "base/ending.h"
#include "base/file_names.h"
#include "base/pace.h"
#include "codec/picture/image_files.h"
#include "job/cut_feeds.h"
#include "job/front_ends.h"
#include "job/named.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"
#include "kerf/drawing/drawing_outlines.h"
#include "kerf/drawing/svg.h"
#include "kerf/formats/mesh_files.h"
#include "kerf/formats/workshop_files.h"
#include "kerf/job/cut_program.h"
#include "kerf/op/rework.h"

namespace kerf {
namespace {

bool looks_like_job(std::string_view text) { return text.find("[[operation]]") != std::string_view::npos; }

std::vector<ArtShape> shapes_of(DrawingOutlines drawn) {
  std::vector<ArtShape> shapes;
  for (DrawnOutline& outline : drawn.outlines)
    shapes.push_back(
        {outline.name, outline.layer, std::move(outline.outline), outline.circle, {}, {}, outline.fill});
  for (const DrawnPoint& point : drawn.points) shapes.push_back({"", point.layer, {}, {}, point.at});
  return shapes;
}

/// The outlines of a text; a font file is relative to the folder of the job.
void add_text(const TextShape& text, const std::string& job, std::vector<ArtShape>& shapes,
              std::vector<std::string>& files, Diagnostics& diagnostics) {
  const auto where = font_file_of(text, diagnostics);
  if (!where) return;
  std::optional<InputFile> font;
  if (!where->file.empty()) {
    const std::string name = path_beside(job, where->file);
    font = InputFile::open(name, diagnostics);
    if (!font) return;
    files.push_back(name);
  }
  auto made = shapes_of_text(text, font ? font->bytes() : std::string_view{}, diagnostics, where->face);
  if (!made) return;
  for (ArtShape& shape : *made) shapes.push_back(std::move(shape));
}

/// The shape of a picture; its file is relative to the folder of the job.
void add_picture(const PictureShape& picture, const std::string& job, std::vector<ArtShape>& shapes,
                 std::vector<std::string>& files, Diagnostics& diagnostics) {
  GreyImage image;
  if (!picture.file.empty()) {
    const std::string name = path_beside(job, picture.file);
    const auto file = InputFile::open(name, diagnostics);
    if (!file) return;
    files.push_back(name);
    auto read = read_picture(file->bytes(), name, diagnostics);
    if (!read) return;
    image = std::move(*read);
  }
  GreyPicture pixels{image.width, image.height, std::move(image.grey)};
  if (auto shape = shape_of_picture(picture, std::move(pixels), image.pixels_per_mm, diagnostics))
    shapes.push_back(std::move(*shape));
}

/// The mesh of a job as it is moved and scaled, from its file or its heights; nothing, with errors, if it
/// cannot be read.
std::optional<SurfaceMesh> mesh_of(const CutSurface& surface, const std::string& job,
                                   std::vector<std::string>& files, Diagnostics& diagnostics,
                                   Progress* progress) {
  SurfaceMesh mesh = surface.mesh;
  if (!surface.file.empty()) {
    const std::string name = path_beside(job, surface.file);
    const auto format = mesh_format_of(name);
    if (!format) {
      diagnostics.error(codes::mesh_file, TextLocation{name, 0, 0}, "the file is not a mesh").hint =
          "its name ends in .stl, .3mf, .obj or .glb";
      return std::nullopt;
    }
    const std::size_t errors = diagnostics.errors();
    const auto file = InputFile::open(name, diagnostics, limits::kMaxProgramBytes, progress);
    auto data = file ? read_mesh(file->bytes(), *format, name, diagnostics, {}, progress) : std::nullopt;
    if (!data) {
      add_if_stopped(name, errors, progress, diagnostics);
      return std::nullopt;
    }
    files.push_back(name);
    mesh.points.resize(data->positions.size() / 3);
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      mesh.points[i] = {data->positions[3 * i], data->positions[3 * i + 1], data->positions[3 * i + 2]};
    mesh.triangles.resize(data->triangles.size() / 3);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      mesh.triangles[i] = {data->triangles[3 * i], data->triangles[3 * i + 1], data->triangles[3 * i + 2]};
  }
  for (Point3& p : mesh.points) p = surface.scale * p + surface.move;
  return mesh;
}

/// Lays out the shapes of a job, and the stock that it makes of them.
void lay_out_shapes(const CutJob& job, std::vector<ArtShape>& shapes, const Origin& where,
                    std::optional<Stock>& stock, Diagnostics& diagnostics) {
  const auto box = lay_out(job.layout, shapes, where, diagnostics);
  const double thickness = job.layout.thickness.mm();
  if (box && !(thickness > 0.0) && job.layout.margin > Length{} && job.stock.empty())
    diagnostics
        .note(codes::cut_job_key, where,
              "art-margin without thickness makes no stock: one around the cuts is assumed")
        .hint = "thickness = 18";
  if (!box || !(thickness > 0.0)) return;
  if (stock || !job.stock.empty())
    diagnostics.error(codes::cut_job_key, where, "stock and thickness both state the stock");
  else if (!(box->low.x < box->high.x && box->low.y < box->high.y))
    diagnostics.error(codes::cut_job_key, where, "the shapes have no area that a stock could lie below")
        .hint = "art-margin = 10";
  else
    stock = Stock{{{box->low.x, box->low.y, -thickness}, {box->high.x, box->high.y, 0.0}}};
}

/// Wraps the program around a bar, if the job asks for it; the bar is as long as the stock. False with an
/// error.
bool wrap_around(const std::string& wrap, const Origin& where, Program& program, Diagnostics& diagnostics) {
  if (wrap.empty()) return true;
  ReworkOptions options;
  if (const std::string fault = set_rework(options, "wrap", wrap); !fault.empty()) {
    diagnostics.error(codes::cut_job_key, where, "wrap: " + fault).hint = "wrap = \"d=40\"";
    return false;
  }
  auto around = wrapped(program.path, options.wrap, diagnostics);
  if (!around) return false;
  program.path = std::move(*around);
  const double diameter = options.wrap.diameter.mm();
  if (const auto flat = std::exchange(program.stock, std::nullopt))
    program.bar = RoundBar{diameter, flat->block.low.x, flat->block.high.x, 0.0, -0.5 * diameter};
  return true;
}

/// The unit of a drawing that specifies none: of one that is fitted to a size any will do.
std::optional<Length> unit_of(const CutJob& job) {
  const bool fitted = job.layout.fit_width > Length{} || job.layout.fit_height > Length{};
  return job.unit || !fitted ? job.unit : std::optional(mm(1));
}

/// The block of a stock; what is wrong with it is reported where it is used.
std::optional<Box3> stock_box_of(const std::string& text) {
  Diagnostics unused;
  const auto stock = read_stock_option(text, {}, unused);
  return stock ? std::optional(stock->block) : std::nullopt;
}

Program read(const InputFile& file, const ProgramOptions&, Diagnostics& diagnostics, Progress* progress) {
  Program program;
  const auto job = read_cut_job(file.bytes(), file.path(), diagnostics, stock_box_of, cut_defaults());
  if (!job) return program;
  const std::string art = job->art.empty() ? "" : path_beside(file.path(), job->art);
  if (auto made = load_cut_job(*job, art, file.path(), diagnostics, progress)) program = std::move(*made);
  if (!art.empty()) program.files.push_back(art);
  return program;
}

}  // namespace

std::vector<ArtShape> load_art(const std::string& name, const ArtOptions& how, Diagnostics& diagnostics,
                               Progress* progress) {
  const std::size_t errors = diagnostics.errors();
  std::vector<ArtShape> shapes;
  if (const std::string ending = ending_of(name); ending != ".dxf" && ending != ".svg") {
    for (NamedOutline& named : load_outlines(name, diagnostics))
      shapes.push_back({named.name, "", std::move(named.outline), {}, {}});
  } else if (const auto file = InputFile::open(name, diagnostics, limits::kMaxProgramBytes, progress)) {
    const auto drawing = read_drawing(file->bytes(), name, diagnostics, progress);
    DrawingOutlineOptions options;
    options.unit = how.unit;
    options.strokes = how.strokes;
    options.stroke_layers = how.stroke_layers;
    options.texts = how.texts;
    options.progress = progress;
    auto drawn = drawing ? drawn_outlines(*drawing, options, diagnostics) : std::nullopt;
    if (drawn) shapes = shapes_of(std::move(*drawn));
  }
  add_if_stopped(name, errors, progress, diagnostics);
  if (diagnostics.errors() > errors) shapes.clear();
  return shapes;
}

std::optional<Program> load_cut_job(const CutJob& job, const std::string& art, const std::string& where,
                                    Diagnostics& diagnostics, Progress* progress) {
  const std::size_t errors = diagnostics.errors();
  const Origin origin = TextLocation{where, 0, 0};
  Program program;
  program.tools = job.made_tools;
  for (const auto& [number, text] : job.tools)
    if (auto tool = read_tool_option(text, origin, diagnostics)) {
      tool->number = number;
      program.tools.emplace(number, std::move(*tool));
    }
  if (!job.stock.empty()) program.stock = read_stock_option(job.stock, origin, diagnostics);
  std::vector<ArtShape> shapes = job.shapes;
  for (const TextShape& text : job.texts) add_text(text, where, shapes, program.files, diagnostics);
  for (const PictureShape& picture : job.pictures)
    add_picture(picture, where, shapes, program.files, diagnostics);
  const bool is_font_file = job.drawing_texts.find('.') != std::string::npos;
  const std::string texts = is_font_file ? path_beside(where, job.drawing_texts) : job.drawing_texts;
  if (is_font_file) program.files.push_back(texts);
  if (!art.empty())
    for (ArtShape& shape :
         load_art(art, {unit_of(job), job.strokes, texts, job.stroke_layers}, diagnostics, progress))
      shapes.push_back(std::move(shape));
  lay_out_shapes(job, shapes, origin, program.stock, diagnostics);
  std::optional<SurfaceMesh> mesh;
  if (job.surface) mesh = mesh_of(*job.surface, where, program.files, diagnostics, progress);
  program.spoilboard = job.layout.spoilboard;
  CutJob complete = job;
  resolve_formulas(complete, program.stock ? std::optional(program.stock->block) : std::nullopt, diagnostics);
  job_detail::choose_feeds(complete, program.tools, where, program.files, diagnostics);
  if (diagnostics.errors() > errors) return std::nullopt;
  auto path =
      compile_cut_job(complete, shapes, program.tools, diagnostics, progress, mesh ? &*mesh : nullptr);
  if (!path) return std::nullopt;
  program.path = std::move(*path);
  if (!wrap_around(complete.layout.wrap, origin, program, diagnostics)) return std::nullopt;
  program.end = ProgramEnd::seen;
  return program;
}

FrontEnd cut_front_end() { return {"cutting job", {".toml"}, looks_like_job, read}; }

}  // namespace kerf
