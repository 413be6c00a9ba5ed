// Machines, posts, printers and materials by name, and the check of such names in a configuration.
#include "job/named.h"

#include <algorithm>
#include <fmt/format.h>
#include <variant>
#include <vector>

#include "base/codes/files.h"
#include "base/codes/gcode.h"
#include "base/file_names.h"
#include "base/guess.h"
#include "base/names.h"
#include "base/number.h"
#include "base/system.h"
#include "job/load_material.h"
#include "job/load_printer.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"
#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

std::string_view folder_of(Named what) {
  switch (what) {
    case Named::machine: return "machines";
    case Named::post: return "posts";
    case Named::printer: return "printers";
    case Named::material: break;
  }
  return "materials";
}

/// The file in "birch.toml:oak"; of a text without such an ending all of it.
std::size_t end_of_file(const std::string& text) { return end_of_material_file(text).value_or(text.size()); }

/// The names of the posts that are known: those of the folder, then the built-in ones.
std::vector<std::string> post_names(const Configuration& names) {
  std::vector<std::string> known;
  for (const std::string& file : names.files_in(folder_of(Named::post))) known.push_back(stem_of(file));
  for (std::string& name : post_target_names()) known.push_back(std::move(name));
  return known;
}

constexpr std::size_t kMaxBeside = 100;  // files that are read in search of posts

/// The names of the post files in the folder of a program. Jobs, machines and others have the same ending.
std::vector<std::string> posts_beside(const std::string& program) {
  const std::string parent = parent_of(program), folder = parent.empty() ? "." : parent;
  std::vector<std::string> files;
  for (std::string& name : names_in(folder).value_or(std::vector<std::string>()))
    if (extension_of(name) == ".toml" && is_regular_file(path_in(folder, name)) &&
        file_stamp(path_in(folder, name)).size <= limits::kMaxProfileBytes)
      files.push_back(std::move(name));
  std::sort(files.begin(), files.end());
  if (files.size() > kMaxBeside) files.resize(kMaxBeside);
  const auto is_other = [&](const std::string& name) {
    Diagnostics found;
    return !load_post_target(path_in(folder, name), found) || found.has_errors();
  };
  files.erase(std::remove_if(files.begin(), files.end(), is_other), files.end());
  return files;
}

class ValueCheck {
 public:
  ValueCheck(const Configuration& all, Diagnostics& diagnostics) : all_(all), diagnostics_(diagnostics) {}

  void check(const ConfigValue& value) {
    const std::string& text = value.texts.front();
    Diagnostics found;
    if (value.key == "machine")
      machine_called(text, found, all_);
    else if (value.key == "post")
      post_called(text, found, all_);
    else if (value.key == "material")
      material_called(text, found, all_);
    else if (value.key == "spoilboard")
      check_length(value, 0.0, limits::kThickestSpoilboard);
    else if (value.key == "resolution")
      check_length(value, limits::kFinestResolution, limits::kCoarsestResolution);
    else if (value.key == "tools")
      check_files(value);
    else if (value.is_folder && !is_folder(text))
      error(value, fmt::format("there is no folder \"{}\"", clipped(text, 200)));
    for (const Diagnostic& d : found.list())
      if (d.severity == Severity::error) pass_on(value, d);
  }

 private:
  Diagnostic& error(const ConfigValue& value, const std::string& message) {
    return diagnostics_.error(codes::config_file, TextLocation{value.file, value.line, value.column},
                              fmt::format("{}: {}", value.key, message));
  }

  void check_length(const ConfigValue& value, double low, double high) {
    const std::string& text = value.texts.front();
    const auto length = parse_length(text, 1.0);
    if (length && *length >= low && *length <= high) return;
    error(value, fmt::format("\"{}\" is not a length in mm, or with \"in\", from {:g} to {:g} mm",
                             clipped(text, 60), low, high));
  }

  void check_files(const ConfigValue& value) {
    for (const std::string& file : value.texts)
      if (!is_regular_file(file)) error(value, fmt::format("there is no file \"{}\"", clipped(file, 200)));
  }

  /// What is wrong in a file stays at its line there; that there is none is an error of the configuration.
  void pass_on(const ConfigValue& value, const Diagnostic& d) {
    const auto* const where = std::get_if<TextLocation>(&d.where);
    if (where != nullptr && where->line > 0)
      diagnostics_.add(d);
    else
      error(value, fmt::format("\"{}\": {}", clipped(value.texts.front(), 200), d.message)).hint = d.hint;
  }

  const Configuration& all_;
  Diagnostics& diagnostics_;
};

}  // namespace

std::string located(Named what, const std::string& text, const Configuration& names,
                    const std::string& user) {
  if (auto own = names.file_named(folder_of(what), text)) return *own;
  if (user.empty()) return text;
  const std::size_t end = end_of_file(text);
  const std::string beside = path_beside(user, text.substr(0, end));
  return is_regular_file(beside) ? beside + text.substr(end) : text;
}

std::optional<Machine> machine_called(const std::string& text, Diagnostics& diagnostics,
                                      const Configuration& names) {
  return load_machine(located(Named::machine, text, names), diagnostics);
}

std::optional<Material> material_called(const std::string& text, Diagnostics& diagnostics,
                                        const Configuration& names) {
  return load_material(located(Named::material, text, names), diagnostics);
}

std::optional<PrinterChoice> printer_called(const std::string& text, Diagnostics& diagnostics,
                                            const Configuration& names) {
  return load_printer(located(Named::printer, text, names), diagnostics);
}

std::optional<PostTarget> post_called(const std::string& text, Diagnostics& diagnostics,
                                      const Configuration& names) {
  const std::string file = located(Named::post, text, names);
  if (extension_of(file) == ".toml") return load_post_target(file, diagnostics);
  auto target = find_post_target(text);
  if (!target)
    diagnostics
        .error(codes::post_unknown, CallLocation{"", 0, "--to"},
               fmt::format("there is no post \"{}\"", text.substr(0, 60)))
        .hint = guess(text, post_names(names), "kerf post --list prints their names");
  return target;
}

std::vector<std::string> offered_posts(const std::string& program, const Configuration& names) {
  std::vector<std::string> offered = posts_beside(program);
  for (std::string& name : post_names(names))
    if (std::find(offered.begin(), offered.end(), name) == offered.end()) offered.push_back(std::move(name));
  return offered;
}

std::optional<PostTarget> offered_post(const std::string& name, const std::string& program,
                                       Diagnostics& diagnostics, const Configuration& names) {
  const std::vector<std::string> beside = posts_beside(program);
  if (std::find(beside.begin(), beside.end(), name) != beside.end())
    return load_post_target(path_beside(program, name), diagnostics);
  const std::vector<std::string> others = post_names(names);
  if (std::find(others.begin(), others.end(), name) != others.end())
    return post_called(name, diagnostics, names);
  diagnostics
      .error(codes::post_unknown, CallLocation{"", 0, "post"},
             fmt::format("there is no post \"{}\"", clipped(name, 60)))
      .hint = guess(name, others, "kerf post --list prints their names");
  return std::nullopt;
}

CutDefaults cut_defaults(const Configuration& names) {
  const auto text_of = [&](std::string_view key) {
    const ConfigValue* const value = names.find(key);
    return value == nullptr ? std::string() : value->texts.front();
  };
  CutDefaults out{.machine = text_of("machine"), .material = text_of("material"), .spoilboard = {}};
  out.spoilboard = mm(parse_length(text_of("spoilboard"), 1.0).value_or(0.0));
  return out;
}

void check_values(const Configuration& configuration, Diagnostics& diagnostics) {
  ValueCheck check(configuration, diagnostics);
  for (const ConfigValue& value : configuration.values()) check.check(value);
}

}  // namespace kerf
