// The known values of options: one table, by command and option.
#include "app/help/values.h"

#include <algorithm>
#include <string_view>

#include "base/names.h"

#include "kerf/formats/printer_files.h"
#include "kerf/formats/workshop_files.h"
#include "kerf/job/program.h"
#include "kerf/program/cut_job.h"
#include "kerf/program/gcode_options.h"
#include "kerf/program/post.h"

namespace kerf::app {
namespace {

using Words = std::vector<KnownWord>;

Words words_of(const std::vector<std::string>& names) {
  Words words;
  for (const std::string& name : names) words.push_back({name, ""});
  return words;
}

Words posts() {
  Words words;
  for (const PostProfile& post : built_in_posts()) words.push_back({post.name, post.title});
  words.push_back({"dxf", "drawing"});
  words.push_back({"svg", "drawing"});
  return words;
}
Words controllers() {
  Words words = posts();
  words.resize(words.size() - 2);
  return words;
}
Words machines() { return words_of(built_in_machine_names()); }
Words dialects() { return words_of(dialect_names()); }
Words operations() { return words_of(cut_operation_names()); }
Words views() { return words_of({"top", "bottom", "front", "back", "left", "right", "iso"}); }
Words planes() { return words_of({"XY", "XZ", "YZ"}); }
Words languages() { return words_of({"en", "de"}); }

Words tools() {
  Words words;
  for (const auto& [number, tool] : built_in_tools().tools())
    words.push_back({std::to_string(number), tool.description});
  return words;
}

Words materials() {
  Words words;
  for (const Material& material : built_in_materials()) words.push_back({material.name, ""});
  return words;
}

Words printers() {
  Words words;
  for (const PrinterProfile& printer : built_in_printers().printers)
    words.push_back({printer.name, printer.firmware});
  return words;
}

constexpr std::string_view kMeshes = ".stl .3mf .glb .obj", kPrograms = "programs", kFolders = "folders";
constexpr std::string_view kParts = ".stl .3mf .glb .obj .png .kstock .kerf";  // of a simulation

struct Row {
  std::string_view command;  // empty: any
  std::string_view option;
  Words (*words)();        // nullptr: none
  std::string_view files;  // endings, kPrograms or kFolders; empty: no file
};

/// The first row that fits counts.
constexpr Row kRows[] = {
    {"level", "--to", controllers, ""},
    {"cut", "--to", controllers, ""},
    {"", "--to", posts, ""},
    {"", "--post", nullptr, ".toml"},
    {"", "--machine", machines, ".toml .txt"},
    {"", "--printer", printers, ".toml"},
    {"", "--material", materials, ""},
    {"", "--tools", nullptr, ".toml .tbl .csv .json .tools .fctb .fctl"},
    {"", "--tool", tools, ""},
    {"", "TOOL", tools, ""},
    {"", "--stock-mesh", nullptr, kMeshes},
    {"", "--stock-left", nullptr, ".kstock"},
    {"", "--fixture", nullptr, kMeshes},
    {"", "--target", nullptr, kMeshes},
    {"", "TARGET", nullptr, kMeshes},
    {"", "--mesh", nullptr, kMeshes},
    {"", "--picture", nullptr, ".png .jpg .jpeg"},
    {"", "--font", nullptr, ".ttf .otf"},
    {"", "--dialect", dialects, ""},
    {"", "--view", views, ""},
    {"", "--op", operations, ""},
    {"", "--example", operations, ""},
    {"", "--plane", planes, ""},
    {"", "--language", languages, ""},
    {"", "--include", nullptr, kFolders},
    {"", "--folder", nullptr, kFolders},
    {"", "FOLDER", nullptr, kFolders},
    {"", "--parameters", nullptr, ".json"},
    {"simulate", "--output", nullptr, kParts},
    {"run", "--output", nullptr, kParts},
    {"compare", "--output", nullptr, ".png"},
    {"tools import", "--output", nullptr, ".toml .tbl"},
    {"tools export", "--output", nullptr, ".toml .tbl"},
    {"printer import", "--output", nullptr, ".toml"},
    {"view", "--export", nullptr, ".html"},
    {"outline", "--svg", nullptr, ".svg"},
    {"outline", "--dxf", nullptr, ".dxf"},
    {"pathdxf", "--svg", nullptr, ".svg"},
    {"pathdxf", "--output", nullptr, ".gcode .nc"},
    {"outline", "FILE", nullptr, ".json .dxf .svg .py"},
    {"cut", "FILE", nullptr, ".dxf .svg .json .stl .3mf .obj .png .jpg .jpeg .toml"},
    {"tools import", "FILE", nullptr, ".json .csv .tbl .tools .fctb .fctl .toml"},
    {"gcmc", "FILE", nullptr, ".gcmc"},
    {"pathdxf", "FILE", nullptr, ".dxf"},
    {"adjustz", "FILE", nullptr, ".dxf .gcode .txt"},
    {"run", "SCRIPT", nullptr, ".py .scad"},
    {"", "FILE", nullptr, kPrograms},
    {"", "--over", nullptr, kPrograms},
};

std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> out;
  while (!text.empty()) {
    const std::size_t blank = std::min(text.find(' '), text.size());
    out.emplace_back(text.substr(0, blank));
    text.remove_prefix(std::min(blank + 1, text.size()));
  }
  return out;
}

std::vector<std::string> program_endings(const std::string& command) {
  std::vector<std::string> endings;
  for (const FrontEnd& front_end : front_ends())
    endings.insert(endings.end(), front_end.endings.begin(), front_end.endings.end());
  if (command == "view")
    for (const char* ending : {".py", ".json", ".svg", ".stl", ".3mf", ".obj", ".glb"})
      endings.emplace_back(ending);
  return endings;
}

/// Of options without a row: the name of the value says whether it is a file.
KnownValues by_value_name(const OptionDescription& option) {
  KnownValues out;
  for (const std::string& word : option.choices) out.words.push_back({word, ""});
  out.folders = option.value == "FOLDER";
  for (const char* name : {"PATH", "FILE", "file", "MAP", "MESH"})
    out.files = out.files || option.value == name;
  return out;
}

}  // namespace

KnownValues known_values(const std::string& command, const OptionDescription& option) {
  const auto row = std::find_if(std::begin(kRows), std::end(kRows), [&](const Row& r) {
    const bool fits = r.command.empty() || r.command == command;
    return fits && std::find(option.names.begin(), option.names.end(), r.option) != option.names.end();
  });
  KnownValues out = by_value_name(option);
  if (row == std::end(kRows) || !option.choices.empty()) return out;
  if (row->words != nullptr) out.words = row->words();
  out.files = !row->files.empty() && row->files != kFolders;
  out.folders = row->files == kFolders;
  out.endings = row->files == kPrograms ? program_endings(command) : split(row->files);
  if (out.folders) out.endings.clear();
  // A word with a blank would have to be quoted.
  std::erase_if(out.words, [](const KnownWord& w) { return w.word.find(' ') != std::string::npos; });
  return out;
}

}  // namespace kerf::app
