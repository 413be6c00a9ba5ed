// kerf tools list, kerf tools show: the tool table, and one tool with its profile.
#include <fmt/format.h>
#include <memory>

#include "app/commands/commands.h"
#include "app/options/common.h"
#include "app/options/job_options.h"
#include "app/report/sketch.h"
#include "base/names.h"
#include "base/number.h"
#include "job/record/figures.h"
#include "job/record/record.h"

#include "kerf/base/files.h"
#include "kerf/formats/workshop_files.h"

namespace kerf::app {
namespace {

struct Options {
  OutputOptions output;
  std::vector<std::string> files;
  std::string asked;
};

/// The built-in tools and those of --tools files.
ToolTable read_table(const std::vector<std::string>& names, Diagnostics& diagnostics) {
  ToolTable table = built_in_tools();
  for (const std::string& name : names)
    if (const auto file = InputFile::open(name, diagnostics))
      read_tool_file(file->bytes(), name, table, diagnostics);
  return table;
}

std::string_view key_of(ToolPart part) {
  switch (part) {
    case ToolPart::cutting: return "cutting";
    case ToolPart::neck: return "neck";
    case ToolPart::shank: return "shank";
    case ToolPart::holder: break;
  }
  return "holder";
}

Record shown_record(int number, const Tool& tool) {
  Record out = record_of_tool(number, tool);
  const auto encoded = encode_tool_number(tool);
  out["encoded_number"] = encoded ? Record(*encoded) : Record(nullptr);
  const auto comment = write_tool_comment(tool.shape);
  out["comment"] = comment ? Record(*comment) : Record(nullptr);
  Record& profile = out["profile_mm"] = Record::object();
  for (const ToolPart part : {ToolPart::cutting, ToolPart::neck, ToolPart::shank, ToolPart::holder})
    if (!tool.silhouette.part(part).empty())
      profile[std::string(key_of(part))] = record_of(tool.silhouette.part(part));
  return out;
}

// ---- list

void print_list(Console& console, const ToolTable& table) {
  console.print("number  shape          diameter     flute  names (mm)\n");
  for (const auto& [number, tool] : table.tools())
    console.print(fmt::format("{:>6}  {:<13}{:>10}{:>10}  {}\n", number, name_of(tool.shape),
                              number_text(tool.diameter.mm(), 4), number_text(tool.flute.mm(), 4),
                              tool.names.empty() ? tool.description : joined(tool.names, ", ")));
}

Status run_list(Console& console, const Options& options) {
  Diagnostics diagnostics;
  const ToolTable table = read_table(options.files, diagnostics);
  console.show(diagnostics);
  if (console.json()) {
    Record tools = Record::array();
    for (const auto& [number, tool] : table.tools()) tools.push_back(record_of_tool(number, tool));
    console.print_json(
        text_of(Record{{"tools", tools}, {"diagnostics", record_of(diagnostics)}}, Layout::indented));
  } else if (!diagnostics.has_errors()) {
    print_list(console, table);
  }
  return diagnostics.has_errors() ? Status::input_errors : Status::done;
}

// ---- show

/// The tool of a number or a name of the table, else of a description such as "V d=12.7 angle=90".
std::optional<Tool> find(const std::string& asked, const ToolTable& table, Diagnostics& diagnostics) {
  const auto number = parse_number(asked);
  if (number && *number >= 0 && *number <= 999'999'999)
    if (const Tool* tool = table.find(static_cast<int>(*number))) return *tool;
  if (const Tool* tool = table.find_name(asked)) return *tool;
  return read_tool_option(asked, CallLocation{"", 0, fmt::format("\"{}\"", asked.substr(0, 80))},
                          diagnostics);
}

void print_parts(Console& console, const Silhouette& silhouette) {
  for (const ToolPart part : {ToolPart::cutting, ToolPart::neck, ToolPart::shank, ToolPart::holder}) {
    const Profile& profile = silhouette.part(part);
    if (profile.empty()) continue;
    std::string line = fmt::format("{:<13}", to_string(part));
    for (const Knot& knot : profile.knots) {
      line += fmt::format(" r{} z{}", number_text(knot.r, 4), number_text(knot.z, 4));
      if (knot.bulge != 0.0) line += fmt::format(" bulge {}", number_text(knot.bulge, 4));
      if (&knot != &profile.knots.back()) line += ",";
    }
    console.print(line + "\n");
  }
}

void print_tool(Console& console, const Tool& tool) {
  const std::string title = tool.description.empty() ? short_name(tool) : tool.description;
  console.print(tool.number == 0 ? title + "\n\n" : fmt::format("{} {}\n\n", tool.number, title));
  console.print(fmt::format("shape         {}\n", name_of(tool.shape)));
  console.print(fmt::format("diameter      {} mm\n", number_text(tool.diameter.mm(), 4)));
  console.print(fmt::format("flute         {} mm, {}{}\n", number_text(tool.flute.mm(), 4), teeth_text(tool),
                            tool.plunges ? "" : ", must not plunge"));
  if (!tool.names.empty()) console.print(fmt::format("names         {}\n", joined(tool.names, ", ")));
  if (const auto encoded = encode_tool_number(tool))
    console.print(fmt::format("encoded       {}\n", *encoded));
  if (const auto comment = write_tool_comment(tool.shape))
    console.print(fmt::format("comment       ({})\n", *comment));
  print_parts(console, tool.silhouette);
  console.print("\n" + sketch(tool.silhouette));
  console.print("          # cuts   = neck   | shank   H holder; heights in mm above the tip\n");
}

Status run_show(Console& console, const Options& options) {
  Diagnostics diagnostics;
  const ToolTable table = read_table(options.files, diagnostics);
  const std::optional<Tool> tool =
      diagnostics.has_errors() ? std::nullopt : find(options.asked, table, diagnostics);
  console.show(diagnostics);
  if (console.json()) {
    Record out = tool ? shown_record(tool->number, *tool) : Record::object();
    out["diagnostics"] = record_of(diagnostics);
    console.print_json(text_of(out, Layout::indented));
  } else if (tool) {
    print_tool(console, *tool);
  }
  return tool ? Status::done : Status::input_errors;
}

const char* const kListExamples = R"(  kerf tools list
  kerf tools list --json --tools shop.toml
)";
const char* const kShowExamples = R"(  kerf tools show 102
  kerf tools show "V d=12.7 angle=90"
  kerf tools show 374 --json
)";

}  // namespace

Command add_tools_list(CommandParser& tools) {
  auto options = std::make_shared<Options>();
  CommandParser parser = new_command(tools, "list", "List the tool table", kListExamples, options->output);
  add_repeated(parser, "--tools", options->files, "PATH", "A tool file (TOML) to add");
  return {parser, &options->output, [options](Console& console) { return run_list(console, *options); }};
}

Command add_tools_show(CommandParser& tools) {
  auto options = std::make_shared<Options>();
  CommandParser parser = new_command(tools, "show", "Show one tool: its dimensions, its profile, a sketch",
                                     kShowExamples, options->output);
  parser
      .add_text("TOOL", options->asked,
                "A number or vendor's name in the table, or a description: \"square d=3.175\"")
      .required()
      .value_name("");
  add_repeated(parser, "--tools", options->files, "PATH", "A tool file (TOML) to add");
  return {parser, &options->output, [options](Console& console) { return run_show(console, *options); }};
}

}  // namespace kerf::app
