// Writing programs for controllers and as drawings.
#include "kerf/job/posting.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "back/native/native.h"
#include "base/codes/gcode.h"
#include "base/ending.h"
#include "base/file_names.h"
#include "base/names.h"
#include "base/number.h"
#include "job/setup_sheet.h"
#include "tool/tool_comments.h"
#include "tool/tool_description.h"

#include "kerf/formats/workshop_files.h"
#include "kerf/job/job.h"
#include "kerf/job/outputs.h"
#include "kerf/job/program_file.h"

namespace kerf {
namespace {

std::string title_of(const Program& program) { return program.source == "-" ? "" : stem_of(program.source); }

/// Whether the steps themselves describe the stock, as those of gcodepreview do.
bool has_stock_notes(const Toolpath& path) {
  if (!path.has(StepKind::note)) return false;
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path[i].kind() == StepKind::note && path.text(i).substr(0, 5) == "stock") return true;
  return false;
}

PostOptions post_options(const Program& program, const PostingOptions& options, LengthUnit unit) {
  PostOptions out;
  out.program_name = title_of(program);
  out.unit = unit;
  out.tool_change = options.tool_change;
  out.missing_feed = options.missing_feed;
  out.left_out = options.left_out;
  out.variables = options.variables;
  if (program.states_tool_lengths) out.tool_lengths = ToolLengths::by_path;
  for (const auto& [number, tool] : options.tools) {
    out.tool_names[number] = write_tool_description(tool);
    // The comments are in the program's units.
    const double scale = unit == LengthUnit::inch ? kMmPerInch : 1.0;
    if (const auto text = write_tool_comment(tool.shape, scale)) out.tool_comments[number] = *text;
  }
  if (options.start_tool && !is_print(program.path))
    out.start_tool = fmt::format("tool {} at the start: {}", options.start_tool->first,
                                 write_tool_description(options.start_tool->second));
  if (program.filament_diameter) out.filament = mm(*program.filament_diameter);
  if (program.stock && program.stock->body == nullptr && !has_stock_notes(program.path))
    out.stock_comments = write_stock_comments(*program.stock);
  if (unit == LengthUnit::inch && !out.stock_comments.empty())
    out.stock_comments.pop_back();  // STOCK/BLOCK is in the unit of the program
  if (program.spoilboard > Length() && !has_stock_notes(program.path))
    out.stock_comments.push_back(fmt::format("spoilboard: {:.2f}mm", program.spoilboard.mm()));
  return out;
}

/// Pictures of the print, which is simulated once. Errors are appended.
std::vector<Thumbnail> make_thumbnails(const Program& program, const std::vector<ThumbnailSize>& sizes,
                                       Diagnostics& diagnostics, Progress* progress) {
  std::vector<Thumbnail> pictures;
  if (sizes.empty()) return pictures;
  if (!is_print(program.path)) {
    diagnostics.error(codes::post_cannot, {}, "a thumbnail shows a print; this program does not print");
    return pictures;
  }
  const Job job = make_print_job(program);
  const auto run = run_job(job, {}, diagnostics, progress);
  const auto surface =
      run ? make_surface(job, *run, {.detail = SurfaceDetail::columns}, diagnostics, progress) : std::nullopt;
  if (!surface) return pictures;
  for (const ThumbnailSize& size : sizes) {
    View view;
    view.width = size.width;
    view.height = size.height;
    auto png = picture_file(*surface, view, diagnostics);
    if (png) pictures.push_back({size.width, size.height, std::move(*png)});
  }
  return pictures;
}

std::vector<PostedFile> post_gcode(const Program& program, const PostProfile& profile,
                                   const PostingOptions& options, Diagnostics& diagnostics,
                                   Progress* progress) {
  const LengthUnit unit = options.unit.value_or(profile.unit);
  PostOptions how = post_options(program, options, unit);
  how.thumbnails = make_thumbnails(program, options.thumbnails, diagnostics, progress);
  if (stop_requested(progress)) return {};
  auto files = post(program.path, profile, how, diagnostics, progress);
  for (const PostedFile& file : files) lint_gcode(file.text, profile, "output", diagnostics);
  return files;
}

std::optional<NativeToolChange> native_tool_change(std::optional<ToolChangePolicy> given) {
  if (!given) return std::nullopt;
  switch (*given) {
    case ToolChangePolicy::command: return NativeToolChange::command;
    case ToolChangePolicy::pause: return NativeToolChange::pause;
    case ToolChangePolicy::files: return NativeToolChange::files;
    case ToolChangePolicy::ignore: break;
  }
  return NativeToolChange::ignore;
}

/// A program in a machine's own language.
std::vector<PostedFile> post_native(const Program& program, const NativeFormat& format,
                                    const PostingOptions& options, Diagnostics& diagnostics,
                                    Progress* progress) {
  const PostOptions common = post_options(program, options, options.unit.value_or(LengthUnit::mm));
  NativeOptions how;
  how.title = common.program_name;
  how.writer = "Kerf " KERF_VERSION;
  how.tool_change = native_tool_change(options.tool_change);
  how.inch = options.unit == LengthUnit::inch;
  how.skip_left_out = options.left_out == LeftOutCodes::skipped;
  how.missing_feed = options.missing_feed;
  how.tool_names = common.tool_names;
  how.comments = common.stock_comments;
  if (!common.start_tool.empty()) how.comments.push_back(common.start_tool);
  if (format.language == NativeLanguage::rml && how.inch) {
    diagnostics.error(codes::post_cannot, {}, "RML-1 counts steps of a fraction of a mm: it has no inches");
    return {};
  }
  auto written = format.language == NativeLanguage::opensbp
                     ? write_opensbp(program.path, how, diagnostics, progress)
                     : write_rml(program.path, {format.step, format.fastest}, how, diagnostics, progress);
  std::vector<PostedFile> files;
  for (NativeFile& file : written) {
    const auto lines = std::count(file.text.begin(), file.text.end(), '\n');
    files.push_back({file.tool, std::move(file.text), static_cast<std::size_t>(lines)});
  }
  return files;
}

std::vector<PostedFile> draw(const Program& program, const DrawingFormat& format,
                             const PostingOptions& options) {
  ToolpathDrawingOptions how;
  how.unit = options.unit == LengthUnit::inch ? DrawingUnit::inch : DrawingUnit::mm;
  how.rapids = options.rapids;
  how.title = title_of(program);
  for (const auto& [number, tool] : options.tools) {
    how.tool_names[number] = short_name(tool);
    how.tool_diameters[number] = tool.diameter;
  }
  const Drawing drawing = toolpath_drawing(program.path, how);
  PostedFile file;
  file.text = format.name == "svg" ? write_svg(drawing) : write_dxf(drawing, options.dxf_version);
  file.lines = static_cast<std::size_t>(std::count(file.text.begin(), file.text.end(), '\n'));
  return {std::move(file)};
}

/// The sheet of the job that the program makes with these tools.
std::vector<PostedFile> write_sheet(const Program& program, const DrawingFormat& format,
                                    const PostingOptions& options, Diagnostics& diagnostics,
                                    Progress* progress) {
  JobSettings settings;
  settings.tools.numbered = options.tools;
  const Job job = make_job_or_print(program, settings, UnknownTool::assume, diagnostics);
  SetupSheetOptions how;
  how.machine = options.machine ? &*options.machine : nullptr;
  how.unit = options.unit;
  const auto sheet = setup_sheet(job, how, diagnostics, progress);
  if (!sheet) return {};
  PostedFile file;
  file.text = format.file_ending == ".svg" ? setup_sheet_svg(*sheet) : setup_sheet_html(*sheet);
  return {std::move(file)};
}

}  // namespace

const std::vector<DrawingFormat>& drawing_formats() {
  static const std::vector<DrawingFormat> all{{"dxf", "DXF drawing from above", ".dxf"},
                                              {"svg", "SVG drawing from above", ".svg"},
                                              {"sheet", "Setup sheet", ".html"},
                                              {"sheet-svg", "Setup sheet as a drawing", ".svg"}};
  return all;
}

bool is_setup_sheet(const DrawingFormat& format) { return format.name.substr(0, 5) == "sheet"; }

const std::vector<NativeFormat>& native_formats() {
  static const std::vector<NativeFormat> all{
      {"shopbot", "ShopBot OpenSBP", ".sbp", NativeLanguage::opensbp},
      {"rml", "Roland RML-1, 0.025 mm", ".rml", NativeLanguage::rml, 0.025, 15.0},
      {"rml100", "Roland RML-1, 0.01 mm", ".rml", NativeLanguage::rml, 0.01, 50.0}};
  return all;
}

const DrawingFormat& program_format() {
  static const DrawingFormat format{"kerf", "Kerf's own program file", ".kerf"};
  return format;
}

std::string PostTarget::name() const {
  if (is_program) return std::string(program_format().name);
  if (native != nullptr) return std::string(native->name);
  return drawing != nullptr ? std::string(drawing->name) : profile ? profile->name : std::string();
}

std::optional<PostTarget> find_post_target(std::string_view name) {
  const std::string folded = fold_name(name);
  for (const DrawingFormat& format : drawing_formats())
    if (fold_name(format.name) == folded) return PostTarget{{}, &format, false};
  if (program_format().name == folded) return PostTarget{{}, nullptr, true};
  for (const NativeFormat& format : native_formats())
    if (format.name == folded) return PostTarget{{}, nullptr, false, &format};
  if (const PostProfile* profile = find_post(name)) return PostTarget{*profile, nullptr, false};
  return std::nullopt;
}

std::optional<PostTarget> post_target_of_ending(const std::string& file) {
  const std::string ending = ending_of(file);
  if (ending == program_format().file_ending) return find_post_target(program_format().name);
  if (ending == ".html") return find_post_target("sheet");
  return std::nullopt;
}

bool has_unit(const PostTarget& target, LengthUnit unit) {
  if (unit == LengthUnit::mm) return true;
  if (target.profile) return target.profile->has_g(200);
  return target.native == nullptr || target.native->language != NativeLanguage::rml;
}

std::vector<std::string> post_target_names() {
  std::vector<std::string> names;
  for (const PostProfile& p : built_in_posts()) names.push_back(p.name);
  for (const NativeFormat& n : native_formats()) names.emplace_back(n.name);
  for (const DrawingFormat& d : drawing_formats()) names.emplace_back(d.name);
  names.emplace_back(program_format().name);
  return names;
}

std::optional<PostTarget> load_post_target(const std::string& name, Diagnostics& diagnostics) {
  const auto file = InputFile::open(name, diagnostics);
  if (!file) return std::nullopt;
  auto profile = read_post_profile(file->bytes(), name, diagnostics);
  return profile ? std::optional(PostTarget{std::move(profile), nullptr, false}) : std::nullopt;
}

std::optional<PostTarget> printer_post_target(const PrinterChoice& printer, Diagnostics& diagnostics) {
  auto profile = read_post_profile(post_of(printer), printer.printer.name, diagnostics);
  return profile ? std::optional(PostTarget{std::move(profile), nullptr, false}) : std::nullopt;
}

std::optional<ToolChangePolicy> tool_change_policy_named(std::string_view name) {
  if (name == "command") return ToolChangePolicy::command;
  if (name == "pause") return ToolChangePolicy::pause;
  if (name == "files") return ToolChangePolicy::files;
  if (name == "ignore") return ToolChangePolicy::ignore;
  return std::nullopt;
}

std::optional<DxfVersion> dxf_version_named(std::string_view name) {
  const std::string folded = fold_name(name);
  if (folded == "r2000") return DxfVersion::r2000;
  if (folded == "r12") return DxfVersion::r12;
  return std::nullopt;
}

std::optional<ThumbnailSize> thumbnail_size(std::string_view text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos) return std::nullopt;
  const auto whole = [](std::string_view digits) {
    const auto value = parse_number(digits);
    const bool fits = value && *value >= 1.0 && *value <= kMaxThumbnailSide && *value == std::floor(*value);
    return fits ? static_cast<int>(*value) : 0;
  };
  const ThumbnailSize size{whole(text.substr(0, cross)), whole(text.substr(cross + 1))};
  return size.width > 0 && size.height > 0 ? std::optional(size) : std::nullopt;
}

std::vector<PassSaving> improve(Toolpath& path, const PassChoices& passes) {
  std::vector<PassSaving> savings;
  const auto keep = [&](const char* name, PassResult result) {
    savings.push_back({name, result.before, result.after});
    path = std::move(result.path);
  };
  if (passes.fit_arcs > Length()) keep("arcs", chords_to_arcs(path, {.tolerance = passes.fit_arcs}));
  if (passes.join > Length()) keep("join", join_straight(path, passes.join));
  if (passes.shorten_rapids) keep("rapids", shorten_rapids(path));
  return savings;
}

std::vector<PostedFile> post_program(const Program& program, const PostTarget& target,
                                     const PostingOptions& given, Diagnostics& diagnostics,
                                     Progress* progress) {
  if (progress != nullptr) progress->phase("writing");
  if (target.is_program) return {PostedFile{.tool = {}, .text = write_program(program)}};
  if (target.drawing != nullptr && is_setup_sheet(*target.drawing))
    return write_sheet(program, *target.drawing, given, diagnostics, progress);
  PostingOptions options = given;
  if (options.tools.empty()) options.tools = used_tools(program, {});
  if (!options.start_tool) options.start_tool = start_tool(program, {});
  if (target.drawing != nullptr) return draw(program, *target.drawing, options);
  if (target.native != nullptr) return post_native(program, *target.native, options, diagnostics, progress);
  return post_gcode(program, *target.profile, options, diagnostics, progress);
}

std::vector<std::string> posted_file_names(const std::string& name, const std::vector<PostedFile>& files) {
  std::vector<std::string> names;
  std::map<int, int> used;
  for (const PostedFile& file : files) {
    const int tool = file.tool.value_or(0), time = ++used[tool];
    std::string file_name = fmt::format("{}-T{}", stem_of(name), tool);
    if (time > 1) file_name += fmt::format("-{}", time);
    names.push_back(path_in(parent_of(name), file_name + extension_of(name)));
  }
  if (files.size() == 1) names = {name};
  return names;
}

}  // namespace kerf
