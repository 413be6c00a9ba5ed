// The options of the outputs.
#include "app/options/output_options.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "app/options/common.h"
#include "base/codes/files.h"
#include "base/codes/gcode.h"
#include "base/ending.h"
#include "base/file_names.h"
#include "base/guess.h"
#include "base/number.h"
#include "base/system.h"
#include "job/named.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"

namespace kerf::app {
namespace {

/// Checks before a long simulation whether the file can be written after it.
void test_folder(const std::string& path, Diagnostics& diagnostics) {
  if (is_folder(path)) {
    diagnostics.error(codes::file_unwritable, TextLocation{path, 0, 0},
                      "cannot write the file: it is a folder");
    return;
  }
  std::string folder = parent_of(path);
  if (folder.empty()) folder = ".";
  if (!is_folder(folder)) {
    diagnostics.error(codes::file_unwritable, TextLocation{path, 0, 0},
                      fmt::format("cannot write the file: the folder {} does not exist", folder));
  } else if (!is_writable(folder)) {
    diagnostics.error(codes::file_unwritable, TextLocation{path, 0, 0},
                      fmt::format("cannot write the file: the folder {} is not writable", folder));
  }
}

/// The temporary file of "-o -"; false with errors.
bool add_sent(Outputs& outputs, const std::string& to, Diagnostics& usage, Diagnostics& diagnostics) {
  const CallLocation where{"", 0, "-o"};
  if (to.empty())
    usage.error(codes::output_kind_unknown, where, "standard output has no ending for the format").hint =
        "specify the format with --to, such as --to png, or a file";
  else if (!outputs.sent.empty())
    usage.error(codes::output_is_input, where, "\"-\" is given twice as an output");
  if (usage.has_errors()) return false;
  outputs.folder = TemporaryFolder("kerf-output");
  if (outputs.folder.path().empty())
    diagnostics.error(codes::file_unwritable, where, "no temporary folder can be made");
  else
    outputs.sent = outputs.folder.path() + "/output." + to;
  return !outputs.sent.empty();
}

std::optional<std::pair<double, double>> split_pair(const std::string& text, char separator) {
  const std::size_t at = text.find(separator);
  if (at == std::string::npos) return std::nullopt;
  const auto a = parse_number(std::string_view(text).substr(0, at));
  const auto b = parse_number(std::string_view(text).substr(at + 1));
  if (!a || !b) return std::nullopt;
  return {{*a, *b}};
}

bool read_section(const std::string& text, View& view, std::string& problem) {
  view.section = parse_section(text);
  if (!view.section) {
    problem = fmt::format(
        "--section: \"{}\" is not a plane; expected x, y or z and a position in mm or with \"in\", such as "
        "x=25, y=-3.5 or z=0.25in",
        text.substr(0, 40));
    return false;
  }
  if (faces(view, *view.section)) return true;
  problem = fmt::format("--section: the view is parallel to the plane {}; choose another --view",
                        to_string(*view.section));
  return false;
}

}  // namespace

Outputs read_outputs(const std::vector<std::string>& names, const std::string& to,
                     const std::vector<std::string>& inputs, Diagnostics& usage, Diagnostics& diagnostics) {
  Outputs outputs;
  std::vector<PartFile>& files = outputs.files;
  for (std::string name : names) {
    if (name == "-" && !add_sent(outputs, to, usage, diagnostics)) continue;
    if (name == "-") name = outputs.sent;
    const std::optional<PartFile> file = part_file(name);
    if (!file) {
      usage
          .error(codes::output_kind_unknown, CallLocation{"", 0, "-o"},
                 fmt::format("\"{}\" has an unsupported file name extension", name))
          .hint =
          "supported: .stl .3mf .glb .obj (mesh of the part), .png (picture), .html or .svg (setup "
          "sheet), .kstock (stock of the next job), .kerf (the program with its tools and stock)";
      continue;
    }
    const auto is_name = [&name](const std::string& input) {
      return !input.empty() && is_same_file(input, name);
    };
    const auto again = [&name](const PartFile& other) { return is_same_file(other.path, name); };
    if (std::any_of(inputs.begin(), inputs.end(), is_name) ||
        std::any_of(files.begin(), files.end(), again)) {
      usage.error(codes::output_is_input, CallLocation{"", 0, "-o"},
                  fmt::format("\"{}\" is an input, or is given twice as an output", name));
      continue;
    }
    test_folder(name, diagnostics);
    files.push_back(*file);
  }
  return outputs;
}

Option add_output_format(CommandParser& parser, std::string& to, const std::vector<std::string>& endings) {
  return parser.add_text("--to", to, "The format of -o -, standard output").one_of(endings);
}

void warn_without_mesh(const std::vector<Option>& options, const std::vector<PartFile>& files,
                       Diagnostics& diagnostics) {
  if (std::none_of(files.begin(), files.end(), [](const PartFile& file) { return file.mesh.has_value(); }))
    warn_unused(options, "no mesh is written", "write one with -o FILE.stl", diagnostics);
}

Status send(Console& console, Outputs outputs, Status status) {
  if (status != Status::done || outputs.sent.empty()) return status;
  Diagnostics diagnostics;
  std::string bytes;
  if (const auto file = InputFile::open(outputs.sent, diagnostics)) bytes = file->bytes();
  outputs.folder = TemporaryFolder();  // writing to a closed pipe may end the process
  console.print_json(bytes);
  return diagnostics.has_errors() ? fail(console, diagnostics, Status::input_errors) : status;
}

std::optional<PostTarget> post_named(const std::string& name, Diagnostics& usage) {
  return post_called(name, usage);
}

void choose_sheet_form(std::optional<PostTarget>& target, const std::string& out) {
  if (target && target->drawing != nullptr && is_setup_sheet(*target->drawing) && ending_of(out) == ".svg")
    target = find_post_target("sheet-svg");
}

std::optional<PostTarget> configured_post(Diagnostics& diagnostics) {
  const ConfigValue* const value = used_configuration().find("post");
  return value == nullptr ? std::nullopt : post_called(value->texts.front(), diagnostics);
}

void check_program_file(const std::optional<PostTarget>& target, const std::string& out, Diagnostics& usage) {
  const auto of_ending = post_target_of_ending(out);
  if (!target || target->is_program == (of_ending && of_ending->is_program)) return;
  Diagnostic& error = usage.error(codes::output_kind_unknown, CallLocation{"", 0, "-o"}, "");
  error.message = target->is_program ? "a program file is written with -o to a name that ends in .kerf"
                                     : "the ending .kerf is for program files";
  error.hint = target->is_program ? "-o part.kerf" : "without --to such a file is written";
}

std::string text_of_written(const std::string& name, const PostedFile& file) {
  if (file.lines == 0) return fmt::format("wrote    {}", name);
  return fmt::format("wrote    {} ({} lines)", name, file.lines);
}

std::optional<View> read_view(const PictureOptions& options, std::string& problem) {
  View out;
  if (const auto named = named_view(options.view)) {
    out = *named;
  } else if (const auto angles = split_pair(options.view, ',')) {
    if (std::abs(angles->first) > 360.0 || std::abs(angles->second) > 90.0) {
      problem = "--view: the azimuth must be from -360 to 360 degrees, the elevation from -90 to 90";
      return std::nullopt;
    }
    out.azimuth = degrees(angles->first);
    out.elevation = degrees(angles->second);
  } else {
    problem = fmt::format(
        "--view: \"{}\" is neither top, bottom, front, back, left, right or iso nor AZIMUTH,ELEVATION",
        options.view.substr(0, 40));
    problem += guess_at_end(options.view, {"top", "bottom", "front", "back", "left", "right", "iso"});
    return std::nullopt;
  }
  const auto pixels = split_pair(options.size, 'x');
  const auto good = [](double v) {
    return v >= 16 && v <= limits::kMaxPictureSide && v == static_cast<double>(static_cast<int>(v));
  };
  if (!pixels || !good(pixels->first) || !good(pixels->second)) {
    problem = fmt::format("--size: \"{}\" is not WIDTHxHEIGHT in pixels, each from 16 to {}",
                          options.size.substr(0, 40), limits::kMaxPictureSide);
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
                "Section plane of the picture, such as x=25, y=-3.5 or z=1in; the viewer's side is removed")
      .value_name("PLANE");
}

}  // namespace kerf::app
