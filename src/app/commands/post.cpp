// kerf post: a program written for a controller, or drawn.
#include "kerf/post.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

#include "app/job.h"
#include "app/options/command.h"
#include "app/options/reading.h"
#include "app/post_drawing.h"
#include "app/report/json.h"
#include "app/report/terminal_progress.h"

#include "kerf/files.h"
#include "kerf/number.h"
#include "kerf/passes.h"
#include "kerf/program.h"
#include "kerf/tool_files.h"

namespace kerf::app {
namespace {

struct Options {
  OutputOptions output;
  std::string file, to, post_file, out, tool_change;
  bool list = false, inch = false, mm = false;
  double feed = 0.0;
  double fit_arcs = 0.0, join = 0.0;
  bool shorten = false;
  std::string dxf_version = "r2000";
  bool rapids = false;
  ToolOptions tools;
  ReadingOptions reading;
};

Status show_list(Console& console) {
  Json list = Json::array();
  const auto show = [&](std::string_view name, std::string_view title, std::string_view ending) {
    list.push_back(Json{{"name", name}, {"title", title}, {"file_ending", ending}});
    if (!console.json()) console.print(fmt::format("{:<10} {:<22} {}\n", name, title, ending));
  };
  for (const PostProfile& p : built_in_posts()) show(p.name, p.title, p.file_ending);
  for (const DrawingFormat& d : drawing_formats()) show(d.name, d.title, d.file_ending);
  if (console.json()) console.print_json(text_of(list, Layout::indented));
  return Status::done;
}

std::vector<std::string> post_names() {
  std::vector<std::string> names;
  for (const PostProfile& p : built_in_posts()) names.push_back(p.name);
  for (const DrawingFormat& d : drawing_formats()) names.emplace_back(d.name);
  return names;
}

std::optional<PostProfile> choose_profile(const Options& options, Diagnostics& usage,
                                          Diagnostics& diagnostics) {
  if (!options.post_file.empty()) {
    const auto file = InputFile::open(options.post_file, diagnostics);
    return file ? read_post_profile(file->bytes(), options.post_file, diagnostics) : std::nullopt;
  }
  if (const PostProfile* profile = find_post(options.to)) return *profile;
  Diagnostic& d =
      usage.error(Code::post_unknown, CallSpot{"", 0, "--to"},
                  options.to.empty() ? "say with --to for which controller"
                                     : fmt::format("no post is called \"{}\"", options.to.substr(0, 60)));
  const auto meant = did_you_mean(options.to, post_names());
  d.hint = meant ? fmt::format("did you mean \"{}\"?", *meant) : "kerf post --list shows them";
  return std::nullopt;
}

std::optional<ToolChangePolicy> read_policy(const std::string& text) {
  if (text == "command") return ToolChangePolicy::command;
  if (text == "pause") return ToolChangePolicy::pause;
  if (text == "files") return ToolChangePolicy::files;
  if (text == "ignore") return ToolChangePolicy::ignore;
  return std::nullopt;
}

std::string title_of(const LoadedProgram& program) {
  return program.source == "-" ? "" : std::filesystem::path(program.source).stem().string();
}

PostOptions post_options(const Options& options, const LoadedProgram& program,
                         const std::map<int, Tool>& tools, LengthUnit unit) {
  PostOptions out;
  out.program_name = title_of(program);
  out.unit = unit;
  out.tool_change = read_policy(options.tool_change);
  out.missing_feed = mm_per_min(options.feed);
  for (const auto& [number, tool] : tools) {
    out.tool_names[number] = short_name(tool);
    // Such comments are in the program's units; their rounding is for mm.
    if (const auto text = write_tool_comment(tool.shape); text && unit == LengthUnit::mm)
      out.tool_comments[number] = *text;
  }
  return out;
}

/// Applies the passes asked for; what each saved is added to `savings`.
Toolpath improved(Toolpath path, const Options& options, Json& savings, Console& console) {
  const auto keep = [&](const char* name, PassResult result) {
    savings.push_back(Json{{"pass", name},
                           {"steps_before", result.before.steps},
                           {"steps_after", result.after.steps},
                           {"rapid_mm_before", result.before.rapid_mm},
                           {"rapid_mm_after", result.after.rapid_mm}});
    if (!console.json() && !options.out.empty())
      console.summary(fmt::format("{:<9}{} steps -> {}, rapids {:.0f} -> {:.0f} mm", name,
                                  result.before.steps, result.after.steps, result.before.rapid_mm,
                                  result.after.rapid_mm));
    return std::move(result.path);
  };
  if (options.fit_arcs > 0.0) path = keep("arcs", fit_arcs(path, {.tolerance = mm(options.fit_arcs)}));
  if (options.join > 0.0) path = keep("join", join_straight(path, mm(options.join)));
  if (options.shorten) path = keep("rapids", shorten_rapids(path));
  return path;
}

/// "part.nc" for tool 201 is "part-T201.nc"; where that tool comes again, "part-T201-2.nc".
std::vector<std::string> names_for(const std::string& out, const std::vector<PostedFile>& files) {
  const std::filesystem::path path(out);
  std::vector<std::string> names;
  std::map<int, int> used;
  for (const PostedFile& file : files) {
    const int tool = file.tool.value_or(0), time = ++used[tool];
    std::string name = fmt::format("{}-T{}", path.stem().string(), tool);
    if (time > 1) name += fmt::format("-{}", time);
    names.push_back((path.parent_path() / (name + path.extension().string())).string());
  }
  if (files.size() == 1) names = {out};
  return names;
}

Status write(Console& console, const Options& options, const std::vector<PostedFile>& files, Json result,
             Diagnostics& diagnostics) {
  if (options.out.empty()) {
    console.show(diagnostics, Console::Channel::always_text);
    for (const PostedFile& file : files) console.print_json(file.text);
    return Status::done;
  }
  const std::vector<std::string> names = names_for(options.out, files);
  OutputSet set;
  for (std::size_t i = 0; i < files.size(); ++i)
    if (!set.write(names[i], files[i].text, diagnostics))
      return fail(console, diagnostics, Status::input_errors);
  if (!set.commit(diagnostics)) return fail(console, diagnostics, Status::input_errors);
  console.show(diagnostics);
  result["outputs"] = names;
  result["diagnostics"] = json_of(diagnostics);
  if (console.json()) console.print_json(text_of(result, Layout::indented));
  for (std::size_t i = 0; i < files.size() && !console.json(); ++i)
    console.summary(fmt::format("wrote    {} ({} lines)", names[i], files[i].lines));
  return Status::done;
}

void check_usage(const Options& options, Diagnostics& usage) {
  if (options.file.empty())
    usage.error(Code::file_unreadable, CallSpot{"", 0, "FILE"}, "say which program to write");
  if (!options.out.empty() && options.out == options.file)
    usage.error(Code::output_is_input, CallSpot{"", 0, "-o"}, "the output would replace the input");
  if (!options.tool_change.empty() && !read_policy(options.tool_change))
    usage.error(Code::post_value_bad, CallSpot{"", 0, "--tool-change"},
                "say command, pause, files or ignore");
  if (!read_dxf_version(options.dxf_version))
    usage.error(Code::post_value_bad, CallSpot{"", 0, "--dxf-version"}, "say r2000 or r12");
}

/// What is to be written: one of the two.
struct Target {
  std::optional<PostProfile> profile;
  const DrawingFormat* drawing = nullptr;
};

std::vector<PostedFile> written(const Target& target, const Options& options, const LoadedProgram& program,
                                const std::map<int, Tool>& tools, Diagnostics& diagnostics,
                                Progress& progress) {
  if (target.drawing == nullptr) {
    const LengthUnit unit = options.inch ? LengthUnit::inch
                            : options.mm ? LengthUnit::mm
                                         : target.profile->unit;
    auto files = post(program.path, *target.profile, post_options(options, program, tools, unit), diagnostics,
                      &progress);
    for (const PostedFile& file : files) lint_gcode(file.text, *target.profile, "output", diagnostics);
    return files;
  }
  DrawingRequest request;
  request.unit = options.inch ? DrawingUnit::inch : DrawingUnit::mm;
  request.rapids = options.rapids ? RapidLines::drawn : RapidLines::left_out;
  request.version = *read_dxf_version(options.dxf_version);
  request.title = title_of(program);
  request.tools = tools;
  PostedFile file;
  file.text = draw_program(program, *target.drawing, request);
  file.lines = static_cast<std::size_t>(std::count(file.text.begin(), file.text.end(), '\n'));
  return {std::move(file)};
}

Status run(Console& console, const Options& options) {
  if (options.list) return show_list(console);
  Diagnostics usage, diagnostics;
  Target target;
  if (options.post_file.empty()) target.drawing = find_drawing_format(options.to);
  if (target.drawing == nullptr) target.profile = choose_profile(options, usage, diagnostics);
  check_usage(options, usage);
  const ToolSettings tools = read_tool_options(options.tools, usage, diagnostics);
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  if (diagnostics.has_errors() || (target.drawing == nullptr && !target.profile))
    return fail(console, diagnostics, Status::input_errors);

  TerminalProgress progress(console);
  InputOptions input;
  apply(options.reading, input);
  input.tool_diameter = diameters_of(tools);
  auto program = load_program(options.file, diagnostics, &progress, input);
  if (interrupted()) return tell_stopped(console);
  if (!program || diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  const std::string name(target.profile ? target.profile->name : target.drawing->name);
  Json result{{"source", program->source}, {"post", name}};
  program->path = improved(std::move(program->path), options, result["passes"] = Json::array(), console);
  progress.phase("writing");
  const auto files = written(target, options, *program, used_tools(*program, tools), diagnostics, progress);
  progress.clear();
  if (interrupted()) return tell_stopped(console);
  if (diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  if (options.out.empty() && files.size() > 1) {
    usage.error(Code::file_unwritable, CallSpot{"", 0, "-o"},
                "each tool gets a file of its own; say with -o which");
    return fail(console, usage, Status::wrong_usage);
  }
  return write(console, options, files, std::move(result), diagnostics);
}

const char* const kExamples =
    R"(  kerf post --to grbl part.ngc -o part.nc           for GRBL
  kerf post --to linuxcnc --inch part.nc -o part.ngc
  kerf post --to grbl --tool-change files part.nc -o part.nc    part-T1.nc, part-T2.nc ...
  kerf post --post mymill.toml part.nc -o out.nc    for a machine of one's own
  kerf post --to grbl --tool 1="square d=6" part.nc -o out.nc    G41 and G42 need the tool
  kerf post --to dxf part.nc -o part.dxf            the cuts as seen from above
  kerf post --list

The controller's rules are checked on what is written; nothing is written where one is broken.
)";

void add_pass_options(CommandParser& parser, Options& options) {
  add_number(parser, "--fit-arcs", options.fit_arcs, 1e-4, 1, "MM",
             "Turn chains of chords into arcs that stray no more than MM");
  add_number(parser, "--join", options.join, 1e-6, 1, "MM",
             "Join straight cuts whose corners stray no more than MM");
  parser.add_flag("--shorten-rapids", options.shorten, "Leave out rapids that come back to where they began");
}

void add_drawing_options(CommandParser& parser, Options& options) {
  parser.add_text("--dxf-version", options.dxf_version, "r2000 or r12, for --to dxf").value_name("VERSION");
  parser.add_flag("--rapids", options.rapids, "Draw rapids too, for --to dxf and svg");
}

}  // namespace

Command add_post(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser = new_command(root, "post", "Write a program for a controller",
                                     kExamples + std::string(kToolHelp), options->output);
  add_program(parser, options->file).optional();
  parser.add_text("--to", options->to, "The controller: a name of --list").value_name("POST");
  parser.add_text("--post", options->post_file, "A post file of one's own instead").value_name("FILE");
  parser.add_flag("--list", options->list, "Show the posts that Kerf knows");
  parser.add_text("-o,--output", options->out, "Where to write (default: standard output)")
      .value_name("PATH");
  const Option inch = parser.add_flag("--inch", options->inch, "Write in inches");
  parser.add_flag("--mm", options->mm, "Write in mm").excludes(inch);
  parser
      .add_text("--tool-change", options->tool_change,
                "command, pause, files or ignore (default: the post's)")
      .value_name("HOW");
  add_number(parser, "--feed", options->feed, 1e-3, 1e6, "MM/MIN", "For cutting moves that have no feed");
  add_pass_options(parser, *options);
  add_drawing_options(parser, *options);
  add_tool_options(parser, options->tools);
  add_reading_options(parser, options->reading);
  return {parser, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app
