// kerf post: a program written for a controller.
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

#include "app/command.h"
#include "app/input.h"
#include "app/job.h"
#include "app/json.h"
#include "app/reading.h"
#include "app/terminal_progress.h"

#include "kerf/files.h"
#include "kerf/number.h"
#include "kerf/passes.h"
#include "kerf/post.h"
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
  ReadingOptions reading;
};

Status show_list(Console& console) {
  Json list = Json::array();
  for (const PostProfile& p : built_in_posts()) {
    list.push_back(Json{{"name", p.name}, {"title", p.title}, {"file_ending", p.file_ending}});
    if (!console.json()) console.print(fmt::format("{:<10} {:<20} {}\n", p.name, p.title, p.file_ending));
  }
  if (console.json()) console.print_json(text_of(list, Layout::indented));
  return Status::done;
}

std::vector<std::string> post_names() {
  std::vector<std::string> names;
  for (const PostProfile& p : built_in_posts()) names.push_back(p.name);
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

PostOptions post_options(const Options& options, const LoadedProgram& program, LengthUnit unit) {
  PostOptions out;
  const std::string stem = std::filesystem::path(program.source).stem().string();
  out.program_name = program.source == "-" ? "" : stem;
  out.unit = unit;
  out.tool_change = read_policy(options.tool_change);
  out.missing_feed = mm_per_min(options.feed);
  const auto name_tool = [&](int number, const Tool& tool) {
    out.tool_names[number] = short_name(tool);
    // Such comments are in the program's units; their rounding is for mm.
    if (const auto text = write_tool_comment(tool.shape); text && unit == LengthUnit::mm)
      out.tool_comments[number] = *text;
  };
  for (const Step& s : program.path.steps())
    if (s.kind() == StepKind::tool_change)
      if (const Tool* tool = built_in_tools().find(s.tool_change().tool))
        name_tool(s.tool_change().tool, *tool);
  for (const auto& [number, tool] : program.tools) name_tool(number, tool);
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

/// "part.nc" for tool 201 is "part-T201.nc".
std::string name_for(const std::string& out, const PostedFile& file, std::size_t files) {
  if (files < 2 || !file.tool) return out;
  const std::filesystem::path path(out);
  return (path.parent_path() /
          fmt::format("{}-T{}{}", path.stem().string(), *file.tool, path.extension().string()))
      .string();
}

Status write(Console& console, const Options& options, const std::vector<PostedFile>& files, Json result,
             Diagnostics& diagnostics) {
  Json& outputs = result["outputs"] = Json::array();
  if (options.out.empty()) {
    console.show(diagnostics, Console::Channel::always_text);
    for (const PostedFile& file : files) console.print_json(file.text);
    return Status::done;
  }
  OutputSet set;
  for (const PostedFile& file : files) {
    const std::string name = name_for(options.out, file, files.size());
    outputs.push_back(name);
    if (!set.write(name, file.text, diagnostics)) return fail(console, diagnostics, Status::input_errors);
  }
  if (!set.commit(diagnostics)) return fail(console, diagnostics, Status::input_errors);
  console.show(diagnostics);
  result["diagnostics"] = json_of(diagnostics);
  if (console.json()) console.print_json(text_of(result, Layout::indented));
  if (!console.json())
    for (std::size_t i = 0; i < files.size(); ++i)
      console.summary(fmt::format("wrote    {} ({} lines)", outputs[i].get<std::string>(), files[i].lines));
  return Status::done;
}

Status run(Console& console, const Options& options) {
  if (options.list) return show_list(console);
  Diagnostics usage, diagnostics;
  const auto profile = choose_profile(options, usage, diagnostics);
  if (options.file.empty())
    usage.error(Code::file_unreadable, CallSpot{"", 0, "FILE"}, "say which program to write");
  if (!options.out.empty() && options.out == options.file)
    usage.error(Code::output_is_input, CallSpot{"", 0, "-o"}, "the output would replace the input");
  if (!options.tool_change.empty() && !read_policy(options.tool_change))
    usage.error(Code::post_value_bad, CallSpot{"", 0, "--tool-change"},
                "say command, pause, files or ignore");
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  if (!profile) return fail(console, diagnostics, Status::input_errors);

  TerminalProgress progress(console);
  InputOptions input;
  apply(options.reading, input);
  auto program = load_program(options.file, diagnostics, &progress, input);
  if (interrupted()) return tell_stopped(console);
  if (!program || diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  const LengthUnit unit = options.inch ? LengthUnit::inch : options.mm ? LengthUnit::mm : profile->unit;
  Json result{{"source", program->source}, {"post", profile->name}};
  program->path = improved(std::move(program->path), options, result["passes"] = Json::array(), console);
  progress.phase("writing");
  const auto files =
      post(program->path, *profile, post_options(options, *program, unit), diagnostics, &progress);
  progress.clear();
  if (interrupted()) return tell_stopped(console);
  for (const PostedFile& file : files) lint_gcode(file.text, *profile, "output", diagnostics);
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
  kerf post --list

The controller's rules are checked on what is written; nothing is written where one is broken.
)";

void add_pass_options(CLI::App& app, Options& options) {
  add_number(app, "--fit-arcs", options.fit_arcs, 1e-4, 1, "MM",
             "Turn chains of chords into arcs that stray no more than MM");
  add_number(app, "--join", options.join, 1e-6, 1, "MM",
             "Join straight cuts whose corners stray no more than MM");
  app.add_flag("--shorten-rapids", options.shorten, "Leave out rapids that come back to where they began");
}

}  // namespace

Command add_post(CLI::App& root) {
  auto options = std::make_shared<Options>();
  CLI::App* app = new_command(root, "post", "Write a program for a controller", kExamples, options->output);
  add_program(*app, options->file)->required(false);
  app->add_option("--to", options->to, "The controller: a name of --list")->type_name("POST");
  app->add_option("--post", options->post_file, "A post file of one's own instead")->type_name("FILE");
  app->add_flag("--list", options->list, "Show the posts that Kerf knows");
  app->add_option("-o,--output", options->out, "Where to write (default: standard output)")
      ->type_name("PATH");
  auto* inch = app->add_flag("--inch", options->inch, "Write in inches");
  app->add_flag("--mm", options->mm, "Write in mm")->excludes(inch);
  app->add_option("--tool-change", options->tool_change,
                  "command, pause, files or ignore (default: the post's)")
      ->type_name("HOW");
  add_number(*app, "--feed", options->feed, 1e-3, 1e6, "MM/MIN", "For cutting moves that have no feed");
  add_pass_options(*app, *options);
  add_reading_options(*app, options->reading);
  return {app, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app
