// Writing tools in the forms of other programs. What is written is read again, and what differs is named: so
// no form holds less than it says.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <utility>

#include "base/codes/tools.h"
#include "base/ending.h"
#include "base/file_names.h"
#include "base/names.h"
#include "codec/zip/zip.h"
#include "formats/library.h"
#include "formats/tool_libraries.h"

#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

constexpr double kSame = 1e-5;           // mm, between a tool and what a form holds of it
constexpr std::size_t kNamedTools = 12;  // of one kind in the warning

using detail::LibraryTools;

std::string packed(std::string_view text) {
  zip::Writer archive;
  archive.begin("tools.json");
  archive.write(text);
  archive.end();
  return archive.finish();
}

std::string bit_name(const std::string& library, int number) {
  return fmt::format("{}-T{}.fctb", stem_of(library), number);
}

/// A library with its bits beside it; of one tool, the bit alone where that is its name's ending.
std::vector<LibraryFile> freecad_files(const LibraryTools& tools, const std::string& name) {
  if (has_ending(name, ".fctb"))
    return tools.size() == 1 ? std::vector<LibraryFile>{{name, detail::freecad_bit(tools[0])}}
                             : std::vector<LibraryFile>{};
  LibraryTools known;
  std::vector<std::string> files;
  std::vector<LibraryFile> out(1);
  for (const detail::LibraryTool& tool : tools) {
    std::string bit = detail::freecad_bit(tool);
    if (bit.empty()) continue;
    known.push_back(tool);
    files.push_back(bit_name(name, tool.number.value_or(0)));
    out.push_back({path_in(parent_of(name), files.back()), std::move(bit)});
  }
  out[0] = {name, detail::freecad_library(known, files)};
  return out;
}

std::vector<LibraryFile> files_of(const ToolTable& table, const LibraryForm& form, const std::string& name,
                                  double unit_mm, Diagnostics& diagnostics) {
  LibraryTools tools;
  for (const auto& [number, tool] : table.tools()) tools.push_back(detail::described(number, tool));
  switch (form.kind) {
    case ToolLibraryKind::kerf: return {{name, write_tool_file(table)}};
    case ToolLibraryKind::linuxcnc: return {{name, write_linuxcnc_table(table, unit_mm, diagnostics)}};
    case ToolLibraryKind::carbide_create: return {{name, detail::carbide_csv(tools)}};
    case ToolLibraryKind::camotics: return {{name, detail::camotics_project(tools)}};
    case ToolLibraryKind::fusion: {
      std::string text = detail::fusion_library(tools);
      return {{name, has_ending(name, ".tools") ? packed(text) : std::move(text)}};
    }
    case ToolLibraryKind::vectric:
      if (auto bytes = detail::vectric_database(tools, diagnostics)) return {{name, std::move(*bytes)}};
      return {};
    case ToolLibraryKind::freecad:
    case ToolLibraryKind::freecad_library: break;
  }
  return freecad_files(tools, name);
}

/// The tools as the form's reader understands the files.
ToolTable read_again(const std::vector<LibraryFile>& files, double unit_mm, int first) {
  ToolLibraryOptions options{unit_mm, first};
  options.read_bit = [&](const std::string& wanted) -> std::optional<std::string> {
    for (const LibraryFile& file : files)
      if (file_name_of(file.name) == wanted) return file.bytes;
    return std::nullopt;
  };
  ToolTable table;
  Diagnostics ignored;  // what is skipped is not in the table
  if (!files.empty()) read_tool_library(files[0].bytes, files[0].name, options, table, ignored);
  return table;
}

bool near(double x, double y) { return std::abs(x - y) <= kSame; }

/// Without the points that rounding makes of one: the end of a cone at the end of its flutes.
std::vector<Knot> corners(const Profile& profile) {
  std::vector<Knot> out;
  for (const Knot& knot : profile.knots) {
    const bool again = !out.empty() && near(out.back().r, knot.r) && near(out.back().z, knot.z);
    if (again)
      out.back() = knot;
    else
      out.push_back(knot);
  }
  return out;
}

bool same(const Profile& a, const Profile& b) {
  const std::vector<Knot> of_a = corners(a), of_b = corners(b);
  return std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), [](const Knot& p, const Knot& q) {
    return near(p.r, q.r) && near(p.z, q.z) && near(p.bulge, q.bulge);
  });
}

std::vector<std::string> own_names(const Tool& tool) {
  std::vector<std::string> names;
  for (const std::string& name : tool.names)
    if (name != std::to_string(tool.number)) names.push_back(name);
  return names;
}

/// Numbers of tools by what a form has not kept of them.
using Losses = std::map<std::string, std::vector<int>>;

/// What a form has not kept of a tool whose cutting part it has kept.
void compare(int number, const Tool& tool, const Tool& read, Losses& losses) {
  const auto lost = [&](bool is_lost, std::string what) {
    if (is_lost) losses["without " + std::move(what)].push_back(number);
  };
  if (name_of(tool.shape) != name_of(read.shape))
    losses[fmt::format("the {} as a {}", name_of(tool.shape), name_of(read.shape))].push_back(number);
  lost(!same(tool.silhouette.neck, read.silhouette.neck), "the neck");
  lost(!same(tool.silhouette.shank, read.silhouette.shank), "the exact shank");
  lost(!same(tool.silhouette.holder, read.silhouette.holder), "the holder");
  lost(tool.teeth != read.teeth, "the number of teeth");
  lost(tool.plunges != read.plunges, "the mark of plunging");
  lost(own_names(tool) != own_names(read), "all names");
  lost(!tool.description.empty() && tool.description != read.description, "the exact description");
}

std::vector<int> numbers_of(const ToolTable& table) {
  std::vector<int> numbers;
  for (const auto& [number, tool] : table.tools()) numbers.push_back(number);
  return numbers;
}

std::string numbers_text(const std::vector<int>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size() && i < kNamedTools; ++i)
    text += fmt::format("{}{}", text.empty() ? "" : ", ", numbers[i]);
  if (numbers.size() > kNamedTools) text += fmt::format(" and {} more", numbers.size() - kNamedTools);
  return text;
}

void warn(const Losses& losses, const LibraryForm& form, Diagnostics& diagnostics) {
  if (losses.empty()) return;
  std::vector<std::string> parts;
  for (const auto& [what, numbers] : losses)
    parts.push_back(
        fmt::format("{} ({} {})", what, numbers.size() == 1 ? "tool" : "tools", numbers_text(numbers)));
  diagnostics.warning(
      codes::tool_library_lost, {},
      fmt::format("a {} cannot hold all that is known of the tools: {}", form.title, joined(parts, "; ")));
}

/// The tools that read back with the same cutting part; the others are named.
ToolTable kept(const ToolTable& table, const ToolTable& again, Losses& losses) {
  ToolTable out;
  for (const auto& [number, tool] : table.tools()) {
    const Tool* read = again.find(number);
    if (read != nullptr && same(read->silhouette.cutting, tool.silhouette.cutting))
      out.set(number, tool);
    else
      losses[fmt::format("{} left out", name_of(tool.shape))].push_back(number);
  }
  return out;
}

/// One .fctb holds one tool.
bool fits_bit(const ToolTable& table, const LibraryForm& form, const std::string& name,
              Diagnostics& diagnostics) {
  const bool bit = form.kind == ToolLibraryKind::freecad && has_ending(name, ".fctb");
  if (!bit || table.tools().size() == 1) return true;
  diagnostics
      .error(codes::tool_not_written, {},
             fmt::format("a .fctb file holds one tool; there are {}", table.tools().size()))
      .hint = "write a library, -o tools.fctl: its tools are beside it, tools-T1.fctb and so on";
  return false;
}

}  // namespace

const std::vector<LibraryForm>& library_forms() {
  static const std::vector<LibraryForm> forms{
      {"kerf", "Kerf tool file", {".toml"}, ToolLibraryKind::kerf},
      {"linuxcnc", "LinuxCNC tool table", {".tbl"}, ToolLibraryKind::linuxcnc},
      {"carbide", "Carbide Create library", {".csv"}, ToolLibraryKind::carbide_create},
      {"fusion", "Fusion library", {".json", ".tools"}, ToolLibraryKind::fusion},
      {"freecad", "FreeCAD library", {".fctl", ".fctb"}, ToolLibraryKind::freecad},
      {"camotics", "CAMotics project", {".json", ".camotics"}, ToolLibraryKind::camotics},
      {"vectric", "Vectric tool database", {".vtdb"}, ToolLibraryKind::vectric}};
  return forms;
}

const LibraryForm* library_form_named(std::string_view name) {
  for (const LibraryForm& form : library_forms())
    if (form.name == name) return &form;
  return nullptr;
}

const LibraryForm* library_form_of_ending(std::string_view file_name) {
  for (const LibraryForm& form : library_forms())
    for (const std::string_view ending : form.endings)
      if (has_ending(file_name, ending)) return &form;
  return nullptr;
}

WrittenLibrary write_tool_library(const ToolTable& table, const LibraryForm& form, const std::string& name,
                                  double unit_mm, Diagnostics& diagnostics) {
  const bool own = form.kind == ToolLibraryKind::kerf || form.kind == ToolLibraryKind::linuxcnc;
  if (own) return {files_of(table, form, name, unit_mm, diagnostics), numbers_of(table)};
  if (!fits_bit(table, form, name, diagnostics)) return {};
  Losses losses;
  auto files = files_of(table, form, name, unit_mm, diagnostics);
  if (diagnostics.has_errors()) return {};
  const int first = table.tools().empty() ? 1 : table.tools().begin()->first;  // a bit has no number
  const ToolTable fitting = kept(table, read_again(files, unit_mm, first), losses);
  if (fitting.tools().empty()) {
    diagnostics
        .error(codes::tool_not_written, {}, fmt::format("a {} can hold none of these tools", form.title))
        .hint = "kerf tools export -o tools.toml writes all of them";
    return {};
  }
  if (fitting.tools().size() != table.tools().size())
    files = files_of(fitting, form, name, unit_mm, diagnostics);
  const ToolTable again = read_again(files, unit_mm, first);
  for (const auto& [number, tool] : fitting.tools()) {
    if (const Tool* read = again.find(number)) compare(number, tool, *read, losses);
    const bool numberless = form.kind == ToolLibraryKind::vectric && number == 0;
    if (numberless || has_ending(name, ".fctb")) losses["without the number"].push_back(number);
  }
  warn(losses, form, diagnostics);
  return {std::move(files), numbers_of(fitting)};
}

}  // namespace kerf
