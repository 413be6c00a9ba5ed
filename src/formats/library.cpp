// Tool libraries: detects the kind of a file and adds its tools to the table.
#include "formats/library.h"

#include <fmt/format.h>
#include <vector>

#include "base/codes/tools.h"
#include "base/ending.h"
#include "base/file_names.h"
#include "base/names.h"
#include "base/number.h"
#include "codec/zip/zip.h"
#include "formats/settings.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"
#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace detail {
namespace {

void add_setting(std::vector<Setting>& settings, const ToolShape& blank, std::string_view key, double value,
                 const Origin& where) {
  if (value == 0.0) return;
  if (has_measure(blank, key)) settings.push_back({std::string(key), where, value});
}

void add_part(std::vector<Setting>& settings, const std::string& name, double diameter, double length,
              const Origin& where) {
  if (diameter == 0.0) return;
  settings.push_back({name + "_diameter", where, diameter});
  if (length > 0.0) settings.push_back({name + "_length", where, length});
}

std::vector<Setting> settings_of(const LibraryTool& tool, const ToolShape& blank) {
  std::vector<Setting> settings;
  add_setting(settings, blank, "diameter", tool.diameter, tool.where);
  add_setting(settings, blank, "flute", tool.flute, tool.where);
  add_setting(settings, blank, "corner_radius", tool.corner_radius, tool.where);
  add_setting(settings, blank, "tip_diameter", tool.tip_diameter, tool.where);
  add_setting(settings, blank, "neck_diameter", tool.neck_diameter, tool.where);
  add_setting(settings, blank, "angle", tool.angle, tool.where);
  add_setting(settings, blank, "minor_diameter", tool.neck_diameter, tool.where);
  add_setting(settings, blank, "major_diameter", tool.diameter, tool.where);
  add_setting(settings, blank, "cut_height", tool.cut_height, tool.where);
  add_setting(settings, blank, "length", tool.flute, tool.where);
  if (tool.neck_length != 0.0) {
    if (!has_measure(blank, "neck_diameter"))
      settings.push_back({"neck_diameter", tool.where, tool.neck_diameter});
    settings.push_back({"neck_length", tool.where, tool.neck_length});
  }
  add_part(settings, "shank", tool.shank_diameter, tool.shank_length, tool.where);
  if (tool.holder_length > 0.0)
    add_part(settings, "holder", tool.holder_diameter, tool.holder_length, tool.where);
  if (tool.teeth > 0) settings.push_back({"teeth", tool.where, static_cast<double>(tool.teeth)});
  if (!tool.name.empty()) settings.push_back({"name", tool.where, tool.name});
  if (!tool.description.empty() && tool.description != short_name(tool))
    settings.push_back({"description", tool.where, tool.description});
  return settings;
}

}  // namespace

std::string short_name(const LibraryTool& tool) {
  constexpr int kDecimals = 3;  // of mm; a form may hold a size that was computed
  return fmt::format("{} {} mm", tool.shape, number_text(tool.diameter, kDecimals));
}

LibraryWriter::LibraryWriter(std::string_view file_name, const ToolLibraryOptions& options, ToolTable& table,
                             Diagnostics& diagnostics)
    : file_(file_name),
      options_(options),
      table_(table),
      diagnostics_(diagnostics),
      next_(std::max(options.first_number, 0)) {}

Origin LibraryWriter::location(std::size_t line) const {
  return TextLocation{file_, static_cast<std::uint32_t>(line), 0};
}

void LibraryWriter::skip(const Origin& where, std::string_view name, std::string_view reason) {
  diagnostics_.warning(codes::tool_library_shape, where,
                       fmt::format("the tool \"{}\" is skipped: {}", name.substr(0, 60), reason));
}

void LibraryWriter::finish() {
  for (Waiting& waiting : waiting_) {
    while (table_.find(next_) != nullptr) ++next_;
    diagnostics_.note(
        codes::tool_library_number, waiting.where,
        waiting.twice ? fmt::format("number {} is given twice; this tool becomes {}", *waiting.twice, next_)
                      : fmt::format("the tool has no number; it becomes {}", next_));
    keep(next_, std::move(waiting.tool));
  }
  waiting_.clear();
}

void LibraryWriter::keep(int number, Tool tool) {
  tool.number = number;
  table_.set(number, std::move(tool));
}

void LibraryWriter::add(const LibraryTool& described) {
  const std::string& name = described.name.empty() ? described.description : described.name;
  const auto blank = shape_named(described.shape);
  if (!blank) return skip(described.where, name, fmt::format("unknown shape \"{}\"", described.shape));
  Diagnostics faults;
  std::optional<Tool> tool = tool_of(*blank, settings_of(described, *blank), 1.0, described.where, faults);
  if (!tool) {
    const std::string reason =
        faults.list().empty() ? "its dimensions are inconsistent" : faults.list()[0].message;
    return skip(described.where, name, reason);
  }
  add(std::move(*tool), described);
}

void LibraryWriter::add(Tool tool, const LibraryTool& described) {
  const auto& number = described.number;
  const bool usable = number && *number >= 0 && *number <= limits::kMaxTableToolNumber;
  if (usable && given_.insert(*number).second) return keep(*number, std::move(tool));
  waiting_.push_back({std::move(tool), usable ? number : std::nullopt, described.where});
}

}  // namespace detail

namespace {

constexpr std::string_view kZipMark = "PK\x03\x04";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string_view without_mark(std::string_view text) {
  return text.substr(0, 3) == kByteOrderMark ? text.substr(3) : text;
}

bool is_kerf_file(std::string_view text) { return text.find("[[tool]]") != std::string_view::npos; }

bool is_linuxcnc_table(std::string_view text) {
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const std::string_view line = trim(text.substr(start, end - start));
    start = end + 1;
    if (line.empty() || line.front() == ';') continue;
    return line.size() > 1 && (line[0] == 'T' || line[0] == 't') && line[1] >= '0' && line[1] <= '9';
  }
  return false;
}

bool is_carbide_csv(std::string_view text) {
  const std::string_view first = text.substr(0, text.find('\n'));
  return first.find("diameter") != std::string_view::npos && first.find("number") != std::string_view::npos &&
         first.find(',') != std::string_view::npos;
}

}  // namespace

std::string_view to_string(ToolLibraryKind kind) {
  switch (kind) {
    case ToolLibraryKind::kerf: return "Kerf tool file";
    case ToolLibraryKind::linuxcnc: return "LinuxCNC tool table";
    case ToolLibraryKind::carbide_create: return "Carbide Create library";
    case ToolLibraryKind::fusion: return "Fusion library";
    case ToolLibraryKind::freecad: return "FreeCAD tool bit";
    case ToolLibraryKind::freecad_library: return "FreeCAD library";
    case ToolLibraryKind::vectric: return "Vectric tool database";
    case ToolLibraryKind::camotics: break;
  }
  return "CAMotics project";
}

std::optional<ToolLibraryKind> library_kind_of(std::string_view bytes) {
  if (bytes.substr(0, 4) == kZipMark) return ToolLibraryKind::fusion;
  if (bytes.substr(0, detail::kDatabaseMark.size()) == detail::kDatabaseMark) return ToolLibraryKind::vectric;
  const std::string_view text = without_mark(bytes);
  const std::string_view begin = trim(text.substr(0, 4096));
  if (!begin.empty() && begin.front() == '{') return detail::json_library_kind(text);
  if (is_linuxcnc_table(text)) return ToolLibraryKind::linuxcnc;
  if (is_kerf_file(text)) return ToolLibraryKind::kerf;
  if (is_carbide_csv(text)) return ToolLibraryKind::carbide_create;
  return std::nullopt;
}

std::function<std::optional<std::string>(const std::string&)> tool_bits_of(const std::string& library_path) {
  const std::string folder = parent_of(library_path);
  return [folder](const std::string& name) -> std::optional<std::string> {
    for (const char* searched : {"", "Bit", "../Bit"}) {
      const std::string file = path_in(path_in(folder, searched), file_name_of(name));
      Diagnostics ignored;  // the next folder may have it
      if (const auto bit = InputFile::open(file, ignored, limits::kMaxToolLibraryBytes))
        return std::string(bit->bytes());
    }
    return std::nullopt;
  };
}

void read_tool_library(std::string_view bytes, std::string_view file_name, const ToolLibraryOptions& options,
                       ToolTable& table, Diagnostics& diagnostics) {
  const Origin where = TextLocation{std::string(file_name), 0, 0};
  if (has_ending(file_name, ".vtdb") && library_kind_of(bytes) != ToolLibraryKind::vectric) {
    diagnostics
        .error(codes::tool_database_damaged, where,
               "the file is not a database, as Vectric's .vtdb files are")
        .hint = "export the tool database from VCarve or Aspire again";
    return;
  }
  std::string unpacked;
  if (bytes.substr(0, 4) == kZipMark) {
    auto inner = zip::Reader(bytes).first(limits::kMaxToolLibraryBytes);
    if (!inner) {
      diagnostics.error(codes::tool_library_unreadable, where, "the zip archive is damaged, or too large");
      return;
    }
    unpacked = std::move(*inner);
    bytes = unpacked;
  }
  const auto kind = bytes.size() > limits::kMaxToolLibraryBytes ? std::nullopt : library_kind_of(bytes);
  if (!kind) {
    diagnostics.error(codes::tool_library_unknown, where, "unknown format of a tool library").hint =
        "supported: LinuxCNC tool.tbl, Carbide Create CSV, Fusion JSON and .tools, FreeCAD .fctb and .fctl, "
        "CAMotics JSON, Vectric .vtdb";
    return;
  }
  const std::string_view text = without_mark(bytes);
  detail::LibraryWriter out(file_name, options, table, diagnostics);
  switch (*kind) {
    case ToolLibraryKind::kerf: return read_tool_file(text, file_name, table, diagnostics);
    case ToolLibraryKind::linuxcnc: detail::read_linuxcnc_table(text, out); break;
    case ToolLibraryKind::carbide_create: detail::read_carbide_csv(text, out); break;
    case ToolLibraryKind::vectric: detail::read_vectric_database(bytes, out); break;
    default: detail::read_json_library(text, *kind, out); break;
  }
  out.finish();
}

}  // namespace kerf
