// kerf post: writes a program for a controller, or as a drawing.
#include <algorithm>
#include <fmt/format.h>
#include <memory>

#include "app/commands/commands.h"
#include "app/options/common.h"
#include "app/options/job_options.h"
#include "app/options/map_options.h"
#include "app/options/output_options.h"
#include "app/options/printer_option.h"
#include "app/report/terminal_progress.h"
#include "base/codes/files.h"
#include "base/codes/gcode.h"
#include "base/codes/pathdxf.h"
#include "base/ending.h"
#include "base/file_names.h"
#include "base/number.h"
#include "job/heights.h"
#include "job/named.h"
#include "job/record/figures.h"
#include "job/record/record.h"

#include "kerf/base/files.h"
#include "kerf/job/posting.h"
#include "kerf/op/rework.h"

namespace kerf::app {
namespace {

struct Options {
  OutputOptions output;
  std::string file, to, post_file, out, tool_change;
  bool list = false, inch = false, mm = false;
  double feed = 0.0;
  double fit_arcs = 0.0, join = 0.0;
  bool shorten = false;
  ReworkOptions rework;
  bool order = false, reverse_loops = false;
  std::string dxf_version = "r2000";
  bool rapids = false, allow_left_out = false;
  std::string level;  // file of measured heights
  MapOptions map;
  double level_max = 2.0;   // mm
  double keep_above = 0.0;  // mm
  bool keep_above_given = false;
  std::string printer;
  std::vector<std::string> variables, thumbnails;  // "bed=60", "220x124"
  ToolOptions tools;
  ReadingOptions reading;
};

Status show_list(Console& console) {
  Record list = Record::array();
  for (const std::string& file : used_configuration().files_in("posts")) {
    Diagnostics unused;  // a file with errors is named, too; its errors are those of its use
    const auto own = load_post_target(file, unused);
    const std::string title = own && own->profile ? own->profile->title : "", name = stem_of(file);
    const std::string ending = own && own->profile ? own->profile->file_ending : "";
    list.push_back(Record{{"name", name}, {"title", title}, {"file_ending", ending}, {"file", file}});
    if (!console.json()) console.print(fmt::format("{:<10} {:<22} {}\n", name, title, file));
  }
  const auto show = [&](std::string_view name, std::string_view title, std::string_view ending) {
    list.push_back(Record{{"name", name}, {"title", title}, {"file_ending", ending}});
    if (!console.json()) console.print(fmt::format("{:<10} {:<22} {}\n", name, title, ending));
  };
  for (const PostProfile& p : built_in_posts()) show(p.name, p.title, p.file_ending);
  for (const NativeFormat& n : native_formats()) show(n.name, n.title, n.file_ending);
  for (const DrawingFormat& d : drawing_formats()) show(d.name, d.title, d.file_ending);
  show(program_format().name, program_format().title, program_format().file_ending);
  if (console.json()) console.print_json(text_of(list, Layout::indented));
  return Status::done;
}

std::optional<PostTarget> choose_target(const Options& options, Diagnostics& usage,
                                        Diagnostics& diagnostics) {
  if (!options.printer.empty()) {
    const auto printer = printer_called(options.printer, diagnostics);
    return printer ? printer_post_target(*printer, diagnostics) : std::nullopt;
  }
  if (!options.post_file.empty())
    return load_post_target(located(Named::post, options.post_file, used_configuration()), diagnostics);
  if (!options.to.empty()) return post_named(options.to, usage);
  auto target = post_target_of_ending(options.out);
  const std::string ending = ending_of(options.out);
  if (!target && ending != ".svg" && ending != ".dxf") target = configured_post(diagnostics);
  if (!target && !usage.has_errors() && !diagnostics.has_errors())
    usage
        .error(codes::post_unknown, CallLocation{"", 0, "--to"},
               "no controller is given; specify one with --to")
        .hint = ending == ".svg" ? "--to svg for the paths from above, --to sheet for a setup sheet"
                                 : "kerf post --list prints their names";
  return target;
}

/// Applies the passes and reports the savings of each.
Record improved(Toolpath& path, const Options& options, Console& console) {
  Record savings = Record::array();
  const PassChoices passes{mm(options.fit_arcs), mm(options.join), options.shorten};
  for (const PassSaving& saving : improve(path, passes)) {
    savings.push_back(Record{{"pass", saving.name},
                             {"steps_before", saving.before.steps},
                             {"steps_after", saving.after.steps},
                             {"rapid_mm_before", saving.before.rapid_mm},
                             {"rapid_mm_after", saving.after.rapid_mm}});
    if (!console.json() && !options.out.empty())
      console.summary(fmt::format("{:<9}{} steps -> {}, rapids {:.0f} -> {:.0f} mm", saving.name,
                                  saving.before.steps, saving.after.steps, saving.before.rapid_mm,
                                  saving.after.rapid_mm));
  }
  return savings;
}

void report_alignment(const Alignment& found, const Options& options, Console& console, Record& result) {
  const PathTransform& t = found.transform;
  result["align"] = Record{{"rotated_deg", t.rotate.deg()}, {"farthest_mm", found.farthest.mm()}};
  if (!console.json() && !options.out.empty())
    console.summary(fmt::format(
        "align    rotated by {:.4f} degrees, moved by {:.3f}, {:.3f} mm at {:.3f}, {:.3f}; points "
        "within {:.3f} mm",
        t.rotate.deg(), t.move.x, t.move.y, t.centre.x, t.centre.y, found.farthest.mm()));
}

/// Changes of what is cut where; false with errors.
bool reworked(Program& program, const Options& options, const std::map<int, Tool>& tools, Console& console,
              Record& result, Diagnostics& diagnostics) {
  ReworkOptions how = options.rework;
  how.order = options.order, how.reverse_loops = options.reverse_loops;
  auto changed = rework(std::move(program.path), tools, how, diagnostics);
  if (!changed) return false;
  program.path = std::move(changed->path);
  if (moves_part(how)) program.stock.reset();  // it is not that of the result
  if (changed->alignment) report_alignment(*changed->alignment, options, console, result);
  if (!changed->ordered) return true;
  const Ordered& order = *changed->ordered;
  result["order"] = Record{{"blocks", order.blocks},
                           {"rapid_mm_before", order.rapid_before},
                           {"rapid_mm_after", order.rapid_after}};
  if (!console.json() && !options.out.empty())
    console.summary(fmt::format("order    {} blocks, rapids between them {:.0f} -> {:.0f} mm", order.blocks,
                                order.rapid_before, order.rapid_after));
  return true;
}

/// Lets the program follow measured heights, and reports the corrections. False with errors.
bool levelled(Program& program, const Options& options, Console& console, Record& result,
              Diagnostics& diagnostics, Progress* progress) {
  if (options.level.empty()) return true;
  LevelOptions how;
  how.max_correction = mm(options.level_max);
  if (options.keep_above_given) how.keep_above = options.keep_above;
  const auto report =
      level_program(program, options.level, surface_reading(options.map, options.reading.work_offset), how,
                    diagnostics, progress);
  if (!report) return false;
  result["level"] = record_of(*report);
  if (!console.json() && !options.out.empty())
    console.summary(fmt::format("level    corrections of cuts {} to {} mm, {} motions divided",
                                fixed_text(report->lowest, 3), fixed_text(report->highest, 3),
                                report->divided));
  return true;
}

/// `inputs`: files that must not be replaced, also under the names of files per tool.
Status write(Console& console, const Options& options, const std::vector<PostedFile>& files,
             std::vector<std::string> inputs, Record result, Diagnostics& diagnostics) {
  if (options.out.empty()) {
    console.show(diagnostics, Console::Channel::always_text);
    for (const PostedFile& file : files) console.print_json(file.text);
    return Status::done;
  }
  const std::vector<std::string> names = posted_file_names(options.out, files);
  OutputSet set(std::move(inputs));
  for (std::size_t i = 0; i < files.size(); ++i)
    if (!set.write(names[i], files[i].text, diagnostics))
      return fail(console, diagnostics, Status::input_errors);
  if (!set.commit(diagnostics)) return fail(console, diagnostics, Status::input_errors);
  console.show(diagnostics);
  result["outputs"] = names;
  result["diagnostics"] = record_of(diagnostics);
  if (console.json()) console.print_json(text_of(result, Layout::indented));
  for (std::size_t i = 0; i < files.size() && !console.json(); ++i)
    console.summary(text_of_written(names[i], files[i]));
  return Status::done;
}

void check_usage(const Options& options, Diagnostics& usage) {
  if (options.file.empty())
    usage.error(codes::file_unreadable, CallLocation{"", 0, "FILE"}, "no program is given");
  if (!options.out.empty() && is_same_file(options.out, options.file))
    usage.error(codes::output_is_input, CallLocation{"", 0, "-o"}, "the output would replace the input");
  if (!options.level.empty() && !options.reading.measured.empty() &&
      is_same_file(options.level, options.reading.measured))
    usage
        .error(codes::level_twice, CallLocation{"", 0, "--level"},
               "--measured corrects the heights by the same file; the program would be corrected twice")
        .hint = "leave out --level";
}

/// An error if the output would replace a file that the program includes.
void refuse_input(const Options& options, const Program& program, Diagnostics& usage) {
  if (options.out.empty()) return;
  if (std::any_of(program.files.begin(), program.files.end(),
                  [&](const std::string& file) { return is_same_file(options.out, file); }))
    usage.error(codes::output_is_input, CallLocation{"", 0, "-o"},
                "the output would replace an included file");
}

/// The unit of the written program: that of an option; else that of the configuration, where the target has
/// it; nothing: that of the target.
std::optional<LengthUnit> written_unit(const Options& options, const PostTarget& target) {
  if (options.inch || options.mm) return options.inch ? LengthUnit::inch : LengthUnit::mm;
  const ConfigValue* const usual = used_configuration().find("units");
  if (usual == nullptr) return std::nullopt;
  const LengthUnit unit = usual->texts.front() == "inch" ? LengthUnit::inch : LengthUnit::mm;
  return has_unit(target, unit) ? std::optional(unit) : std::nullopt;
}

PostingOptions posting_options(const Options& options, const PostTarget& target, std::map<int, Tool> tools) {
  PostingOptions out;
  out.unit = written_unit(options, target);
  out.tool_change = tool_change_policy_named(options.tool_change);
  out.missing_feed = mm_per_min(options.feed);
  if (options.allow_left_out) out.left_out = LeftOutCodes::skipped;
  out.tools = std::move(tools);
  out.rapids = options.rapids ? RapidLines::drawn : RapidLines::left_out;
  out.dxf_version = *dxf_version_named(options.dxf_version);
  for (const std::string& text : options.variables) {
    const std::size_t sign = text.find('=');
    out.variables[text.substr(0, sign)] = text.substr(sign + 1);
  }
  for (const std::string& text : options.thumbnails) out.thumbnails.push_back(*thumbnail_size(text));
  return out;
}

Status run(Console& console, const Options& options) {
  if (options.list) return show_list(console);
  Diagnostics usage, diagnostics;
  auto target = choose_target(options, usage, diagnostics);
  choose_sheet_form(target, options.out);
  check_usage(options, usage);
  check_program_file(target, options.out, usage);
  const ToolChoices tools = read_tool_options(options.tools, usage, diagnostics);
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  if (diagnostics.has_errors() || !target) return fail(console, diagnostics, Status::input_errors);

  TerminalProgress progress(console);
  ProgramOptions reading = program_options(options.reading, tools);
  if (options.feed > 0.0) reading.drawing.feed = mm_per_min(options.feed);
  auto program = load_program(options.file, reading, diagnostics, &progress);
  if (interrupted()) return report_stopped(console);
  if (!program || diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  refuse_input(options, *program, usage);
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  if (!fits_tools_of_job(*program, tools, diagnostics))
    return fail(console, diagnostics, Status::input_errors);
  Record result{{"source", program->source}, {"post", target->name()}};
  const std::map<int, Tool> known = used_tools(*program, tools);
  if (!reworked(*program, options, known, console, result, diagnostics))
    return fail(console, diagnostics, Status::input_errors);
  result["passes"] = improved(program->path, options, console);
  if (!levelled(*program, options, console, result, diagnostics, &progress))
    return fail(console, diagnostics, Status::input_errors);
  if (target->is_program) keep_tools(*program, tools);
  PostingOptions posting = posting_options(options, *target, known);
  posting.start_tool = start_tool(*program, tools);
  const auto files = post_program(*program, *target, posting, diagnostics, &progress);
  progress.clear();
  if (interrupted()) return report_stopped(console);
  if (diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  if (options.out.empty() && files.size() > 1) {
    usage.error(codes::file_unwritable, CallLocation{"", 0, "-o"},
                "one file per tool is written; specify their name with -o");
    return fail(console, usage, Status::wrong_usage);
  }
  return write(console, options, files, program->files, std::move(result), diagnostics);
}

const char* const kExamples =
    R"(  kerf post --to grbl part.ngc -o part.nc           for GRBL
  kerf post --to linuxcnc --inch part.nc -o part.ngc
  kerf post --to grbl --tool-change files part.nc -o part.nc    part-T1.nc, part-T2.nc ...
  kerf post --post mymill.toml part.nc -o out.nc    with your own post file
  kerf post --to grbl --tool 1="square d=6" part.nc -o out.nc    G41 and G42 need the tool
  kerf post --to shopbot part.nc -o part.sbp        OpenSBP; --to rml and rml100 for Roland's mills
  kerf post --to dxf part.nc -o part.dxf            the cuts seen from above
  kerf post part.nc -o sheet.html                   a setup sheet: stock, zero, tools, operations, times
  kerf post --to grbl --step-down 2 part.nc -o part.nc           at most 2 mm deep at a time
  kerf post --to grbl --tab-height 1.5 --tabs 4 --tool 1="square d=6" part.nc -o part.nc
  kerf post --to grbl --rotate 90 --move 100,0 --columns 3 --rows 2 --pitch 60,40 part.nc -o panel.nc
  kerf post --to grbl --order part.nc -o part.nc    short rapids, inner contours first
  kerf post --to grbl --from-line 1200 --safe-z 10 part.nc -o rest.nc
  kerf post --to grbl --level map.txt part.nc -o out.nc    heights follow a measured surface
  kerf post --to klipper --thumbnail 300x300 print.gcode -o out.gcode    with a picture for the display
  kerf post --post printer.toml --set bed=65 print.gcode -o out.gcode    a variable of its templates
  kerf post part.nc --tool 1="square d=6 holder=30 holder_length=20" -o part.kerf    all of it, for Kerf
  kerf post --list

The result is checked against the rules of the controller; if it violates one, nothing is written.
)";

void add_pass_options(CommandParser& parser, Options& options) {
  add_length(parser, "--fit-arcs", options.fit_arcs, 1e-4, 1,
             "Replace chains of chords by arcs that deviate by at most MM");
  add_length(parser, "--join", options.join, 1e-6, 1,
             "Join straight cuts whose corners deviate by at most MM");
  parser.add_flag("--shorten-rapids", options.shorten, "Remove rapids that return to their start point");
}

/// The options of kerf/op/rework.h.
void add_rework_options(CommandParser& parser, const std::shared_ptr<Options>& options) {
  std::map<std::string_view, Option> added;
  for (const ReworkKey& key : rework_keys()) {
    const std::string name = "--" + std::string(key.name), meaning(key.meaning);
    if (key.value.empty()) {
      parser.add_flag(name, key.name == "order" ? options->order : options->reverse_loops, meaning);
      continue;
    }
    Option option = parser
                        .add_parsed(
                            name,
                            [options, key](const std::string& text) {
                              return set_rework(options->rework, key.name, text);
                            },
                            meaning)
                        .value_name(std::string(key.value));
    added.emplace(key.name, option);
  }
  for (const ReworkKey& key : rework_keys())
    if (!key.needs.empty()) added.at(key.name).needs(added.at(key.needs));
}

/// Returns --keep-above, which has no value that means "not given".
Option add_level_options(CommandParser& parser, Options& options) {
  parser
      .add_text("--level", options.level,
                "Follow the surface of this file of measured heights: a log with [PRB:...], x y z lines, a "
                "height map")
      .value_name("MAP");
  add_map_options(parser, options.map);
  add_length(parser, "--level-max", options.level_max, 1e-3, 100,
             "Maximum correction of a height (default: 2)");
  return add_length(parser, "--keep-above", options.keep_above, -1e5, 1e5,
                    "Leave motions at this Z and above as they are");
}

void add_printing_options(CommandParser& parser, Options& options) {
  add_printer_option(parser, options.printer);
  parser
      .add_repeated("--set", options.variables,
                    "The value of {NAME} in the templates of the post; may be given several times")
      .value_name("NAME=VALUE");
  parser
      .add_repeated("--thumbnail", options.thumbnails,
                    "Put a picture of the print into its program; may be given several times")
      .value_name("WxH");
}

void add_drawing_options(CommandParser& parser, Options& options) {
  parser.add_text("--dxf-version", options.dxf_version, "Version of the drawing, for --to dxf")
      .one_of({"r2000", "r12"});
  parser.add_flag("--rapids", options.rapids, "Draw rapids too, for --to dxf and svg");
}

}  // namespace

Command add_post(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser = new_command(root, "post", "Write a program for a controller",
                                     kExamples + std::string(kToolHelp), options->output);
  add_program(parser, options->file).optional();
  parser.add_text("--to", options->to, "The controller: a name from --list").value_name("POST");
  parser.add_text("--post", options->post_file, "Your own post file instead").value_name("FILE");
  parser.add_flag("--list", options->list, "List the posts: your own ones, then the built-in ones");
  add_output(parser, options->out, options->output, "The file to write (default: -, standard output)");
  Option inch = parser.add_flag("--inch", options->inch, "Write in inches");
  inch.without_default();  // which targets have it: written_unit()
  parser.add_flag("--mm", options->mm, "Write in mm").excludes(inch).without_default();
  parser.add_text("--tool-change", options->tool_change, "How tools are changed (default: the post's)")
      .one_of({"command", "pause", "files", "ignore"});
  add_feed(parser, "--feed", options->feed, 1e-3, 1e6, "Feed of cuts that have none");
  parser.add_flag("--allow-left-out", options->allow_left_out,
                  "Write the program although codes that may move the tool are unknown and left out");
  add_pass_options(parser, *options);
  add_rework_options(parser, options);
  add_drawing_options(parser, *options);
  add_printing_options(parser, *options);
  const Option keep_above = add_level_options(parser, *options);
  add_tool_options(parser, options->tools);
  add_reading_options(parser, options->reading);
  return {parser, &options->output, [options, keep_above](Console& console) {
            options->keep_above_given = keep_above.is_given();
            return run(console, *options);
          }};
}

}  // namespace kerf::app
