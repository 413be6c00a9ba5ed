// kerf cut: runs operations on the outlines of a drawing, and writes the program for a controller.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>

#include "app/commands/commands.h"
#include "app/options/common.h"
#include "app/options/output_options.h"
#include "app/report/terminal_progress.h"
#include "base/codes/files.h"
#include "base/codes/gcode.h"
#include "base/codes/op.h"
#include "base/ending.h"
#include "base/file_names.h"
#include "base/guess.h"
#include "base/names.h"
#include "base/number.h"
#include "job/named.h"
#include "job/record/record.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"
#include "kerf/drawing/drawing_outlines.h"
#include "kerf/drawing/svg.h"
#include "kerf/formats/mesh_files.h"
#include "kerf/formats/workshop_files.h"
#include "kerf/job/cut_program.h"
#include "kerf/job/posting.h"

namespace kerf::app {
namespace {

struct Options {
  OutputOptions output;
  std::string file, out, to, tool_change, unit, strokes, texts, stock, tool, example, mesh, mesh_move;
  std::string op;
  bool schema = false;
  CutValues values;  // keys of the operation that are given

  bool has(std::string_view key) const {
    return std::any_of(values.begin(), values.end(), [&](const auto& v) { return v.first == key; });
  }
};

bool is_job(const std::string& file) { return file.ends_with(".toml"); }
bool is_picture(const std::string& file) {
  return has_ending(file, ".png") || has_ending(file, ".jpg") || has_ending(file, ".jpeg");
}

Status show_text(Console& console, const std::string& text) {
  console.print_json(text);
  return Status::done;
}

Status show_example(Console& console, const Options& options) {
  if (const auto text = cut_job_example(options.example)) return show_text(console, *text);
  Diagnostics usage;
  usage
      .error(codes::cut_job_key, CallLocation{"", 0, "--example"},
             fmt::format("there is no operation \"{}\"{}", options.example.substr(0, 60),
                         guess_at_end(options.example, cut_operation_names())))
      .hint = "one of: " + joined(cut_operation_names(), ", ");
  return fail(console, usage, Status::wrong_usage);
}

/// The mesh of the command line: --mesh, or the file if that is one.
bool add_surface(const Options& options, CutJob& job, Diagnostics& usage) {
  const bool is_mesh = mesh_format_of(options.file).has_value();
  const std::string& name = options.mesh.empty() && is_mesh ? options.file : options.mesh;
  if (!name.empty()) job.surface = CutSurface{.file = absolute_path(name)};
  if (options.mesh_move.empty()) return true;
  std::vector<double> move;
  for (std::string_view rest = options.mesh_move; move.size() <= 3;) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    const auto value = parse_number(trim(rest.substr(0, end)));
    if (!value || !(std::abs(*value) <= limits::kMaxCoordinate)) break;
    move.push_back(*value);
    rest.remove_prefix(end);
    if (rest.empty()) break;
    rest.remove_prefix(1);
  }
  if (job.surface && move.size() == 3) {
    job.surface->move = {move[0], move[1], move[2]};
    return true;
  }
  usage.error(
      codes::cut_job_key, CallLocation{"", 0, "--mesh-move"},
      job.surface ? "\"" + options.mesh_move.substr(0, 60) + "\" is not X,Y,Z in mm" : "there is no mesh");
  return false;
}

/// The job of the command line: a file, or one operation.
std::optional<CutJob> job_of(const Options& options, Diagnostics& usage) {
  CutValues values = options.values;
  if (!options.op.empty()) values.emplace_back("op", options.op);
  if (is_picture(options.file)) values.emplace_back("picture", options.file);
  const CutRow* row = cut_row(options.op);
  if (options.tool.empty() && !(row != nullptr && row->laser))
    usage.error(codes::cut_job_key, CallLocation{"", 0, "--tool"}, "the tool is missing").hint =
        "--tool \"square d=6\"";
  Diagnostics unused;  // what is wrong with the stock is reported with the job
  const auto stock = options.stock.empty()
                         ? std::nullopt
                         : read_stock_option(options.stock, CallLocation{"", 0, "--stock"}, unused);
  auto job = cut_job_of(values, usage, stock ? std::optional(stock->block) : std::nullopt, cut_defaults());
  if (!job) return std::nullopt;
  // What does not fit, does not fit the drawing.
  if (!options.file.empty()) job->operations.front().where = TextLocation{options.file, 0, 0};
  if (!options.unit.empty()) job->unit = drawing_unit(options.unit);
  job->strokes = stroke_shapes_of(options.strokes).value_or(StrokeShapes::lines);
  if (!options.texts.empty()) job->drawing_texts = options.texts;
  if (job->drawing_texts.find('.') != std::string::npos)
    job->drawing_texts = absolute_path(job->drawing_texts);
  // Fonts are files beside the current folder, not beside the drawing.
  for (TextShape& text : job->texts)
    if (has_font_file(text)) text.font = absolute_path(text.font);
  if (!add_surface(options, *job, usage)) return std::nullopt;
  for (PictureShape& picture : job->pictures)
    if (!picture.file.empty()) picture.file = absolute_path(picture.file);
  if (!options.tool.empty()) job->tools[1] = options.tool;
  job->stock = options.stock;
  return job;
}

bool writes_sheet(const Options& options) {
  const std::string ending = ending_of(options.out);
  return ending == ".html" || ending == ".svg" || options.to == "sheet";
}

/// The machine whose times a setup sheet has. Nothing, with errors, if it cannot be read.
std::optional<Machine> machine_of(const Options& options, Diagnostics& diagnostics) {
  const auto given = std::find_if(options.values.begin(), options.values.end(),
                                  [](const auto& value) { return value.first == "machine"; });
  const auto* text = given == options.values.end() ? nullptr : std::get_if<std::string>(&given->second);
  const std::string name = text != nullptr ? *text : cut_defaults().machine;
  if (name.empty() || !writes_sheet(options)) return std::nullopt;
  return machine_called(name, diagnostics);
}

/// Options that a job file decides itself.
void check_job_usage(const Options& options, Diagnostics& usage) {
  const auto refuse = [&](std::string_view name, const std::string& value, std::string_view why) {
    if (value.empty()) return;
    usage.error(codes::option_unused, CallLocation{"", 0, "--" + std::string(name)}, std::string(why));
  };
  constexpr std::string_view kOperations = "a job file contains its operations";
  refuse("tool", options.tool, "a job file names its tools in [tools], which decide");
  refuse("op", options.op, kOperations);
  refuse("stock", options.stock, "a job file states its stock (stock = ...)");
  refuse("unit", options.unit, "a job file states the unit of its art (unit = ...)");
  refuse("strokes", options.strokes, "a job file states what its strokes are (strokes = ...)");
  refuse("texts", options.texts, "a job file states what its texts are (texts = ...)");
  refuse(options.mesh.empty() ? "mesh-move" : "mesh", options.mesh + options.mesh_move,
         "a job file names its mesh in [surface]");
  for (const auto& [key, text] : options.values)
    if (key != "machine" || !writes_sheet(options)) refuse(key, "given", kOperations);
}

void check_usage(const Options& options, Diagnostics& usage) {
  const CutRow* row = cut_row(options.op);
  const bool needs_shapes = (row == nullptr || row->needs_shapes()) && options.mesh.empty() &&
                            !options.has("text") && !options.has("picture") && !options.has("pixels");
  if (options.file.empty() && needs_shapes)
    usage.error(codes::file_unreadable, CallLocation{"", 0, "FILE"},
                "no drawing, outline file, picture, mesh, job or --text is given");
  if (!options.out.empty() && !options.file.empty() && is_same_file(options.out, options.file))
    usage.error(codes::output_is_input, CallLocation{"", 0, "-o"}, "the output would replace the input");
  if (is_job(options.file)) check_job_usage(options, usage);
}

Status write(Console& console, const Options& options, const std::vector<PostedFile>& files,
             Diagnostics& diagnostics) {
  if (options.out.empty()) {
    console.show(diagnostics, Console::Channel::always_text);
    for (const PostedFile& file : files) console.print_json(file.text);
    return Status::done;
  }
  const std::vector<std::string> names = posted_file_names(options.out, files);
  OutputSet set;
  for (std::size_t i = 0; i < files.size(); ++i)
    if (!set.write(names[i], files[i].text, diagnostics))
      return fail(console, diagnostics, Status::input_errors);
  if (!set.commit(diagnostics)) return fail(console, diagnostics, Status::input_errors);
  console.show(diagnostics);
  if (console.json())
    console.print_json(
        text_of(Record{{"outputs", names}, {"diagnostics", record_of(diagnostics)}}, Layout::indented));
  for (std::size_t i = 0; i < files.size() && !console.json(); ++i)
    console.summary(text_of_written(names[i], files[i]));
  return Status::done;
}

/// A mill that does not turn breaks at the first cut.
void warn_of_spindle(const Options& options, const Toolpath& path, Diagnostics& diagnostics) {
  if (path.has(StepKind::spindle) || path.has(StepKind::laser_power)) return;
  const Origin where =
      is_job(options.file) ? Origin(TextLocation{options.file, 0, 0}) : Origin(CallLocation{"", 0, "--rpm"});
  diagnostics.warning(codes::cut_job_key, where, "no rpm is given: the program does not start the spindle")
      .hint = "specify rpm, e.g. 16000, or start the spindle by hand before the program";
}

Status run(Console& console, const Options& options) {
  if (options.schema) return show_text(console, cut_job_schema());
  if (!options.example.empty()) return show_example(console, options);
  Diagnostics usage, diagnostics;
  check_usage(options, usage);
  auto target = options.to.empty() ? post_target_of_ending(options.out) : post_named(options.to, usage);
  if (!target && options.to.empty() && ending_of(options.out) == ".svg") target = find_post_target("sheet");
  if (!target && options.to.empty()) target = configured_post(diagnostics);
  if (!target && options.to.empty()) target = find_post_target("grbl");
  choose_sheet_form(target, options.out);
  check_program_file(target, options.out, usage);
  std::optional<CutJob> job;
  if (!usage.has_errors() && !is_job(options.file)) job = job_of(options, usage);
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  for (const Diagnostic& d : usage.list()) diagnostics.add(d);

  TerminalProgress progress(console);
  const std::string art = is_picture(options.file) || mesh_format_of(options.file) ? "" : options.file;
  auto program = job ? load_cut_job(*job, art, options.file, diagnostics, &progress)
                     : load_program(options.file, {}, diagnostics, &progress);
  if (interrupted()) return report_stopped(console);
  if (!program || diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  for (const std::string& file : program->files)
    if (!options.out.empty() && is_same_file(options.out, file)) {
      usage.error(codes::output_is_input, CallLocation{"", 0, "-o"}, "the output would replace the input");
      return fail(console, usage, Status::wrong_usage);
    }
  warn_of_spindle(options, program->path, diagnostics);
  auto machine = machine_of(options, diagnostics);
  if (diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  program->source = options.file.empty() ? "text" : options.file;
  const bool is_chosen = !options.to.empty() || used_configuration().find("post") != nullptr;
  const bool laser = !is_chosen && !target->is_program && target->drawing == nullptr &&
                     program->path.has(StepKind::laser_power);
  if (target->is_program) keep_tools(*program, {});
  const auto files = post_program(
      *program, laser ? *find_post_target("laser") : *target,
      {.tool_change = tool_change_policy_named(options.tool_change), .machine = std::move(machine)},
      diagnostics, &progress);
  progress.clear();
  if (interrupted()) return report_stopped(console);
  if (diagnostics.has_errors() || files.empty()) return fail(console, diagnostics, Status::input_errors);
  return write(console, options, files, diagnostics);
}

const char* const kExamples =
    R"(  kerf cut a.dxf --op pocket --tool "square d=6" --depth 6 --stepdown 2 --feed 900 --rpm 16000 -o a.nc
  kerf cut part.dxf --op contour --tool "square d=3" --depth 3 --feed 600 --rpm 16000 -o part.nc
  kerf cut part.dxf --op drill --layers HOLES --tool "drill d=3 angle=118" --depth 10 --feed 100 --rpm 3000
  kerf cut --op engrave --text "WORD" --height 10 --tool "V d=6 angle=60" --depth 0.4 --feed 600 --rpm 16000
  kerf cut --op vcarve --text "Word" --height 20 --font "DejaVu Serif" --tool "V d=12 angle=60" --feed 900
  kerf cut part.stl --op raster --tool "ball d=6" --stepover 0.1 --feed 1200 --rpm 16000 -o part.nc
  kerf cut part.svg --op laser-cut --layers red --power 90 --feed 300 --kerf 0.15 --lead 1 -o part.nc
  kerf cut photo.png --op laser-picture --picture-width 80 --power 40 --feed 3000 -o photo.nc
  kerf cut --example pocket > job.toml              a job file to start from
  kerf cut job.toml -o part.nc                      all operations of a job
  kerf cut job.toml -o part.kerf                    the same as Kerf's own file, with its tools and stock
  kerf cut job.toml -o sheet.html                   its setup sheet: stock, zero, tools, operations, times
  kerf simulate job.toml -o part.png                what they leave

Lengths in mm, feeds in mm/min, angles in degrees.
)";

/// An option for a key of an operation, a text or a picture.
void add_key(CommandParser& parser, const std::shared_ptr<Options>& options, const CutKeyText& key,
             const std::string& meaning, const std::string& usual) {
  const std::string name(key.name);
  const std::string choices = key.choices.empty() ? "" : fmt::format(" ({})", joined(key.choices, ", "));
  parser
      .add_parsed(
          "--" + name,
          [options, name](const std::string& text) {
            options->values.emplace_back(name, text);
            return std::string();
          },
          meaning + choices + (usual.empty() ? "" : fmt::format(" (default: {})", usual)))
      .without_default()  // cut_defaults()
      .value_name(!key.is_number()   ? key.type == CutKeyText::Type::list ? "NAMES" : "NAME"
                  : key.unit.empty() ? "N"
                                     : std::string(key.unit));
}

}  // namespace

Command add_cut(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser =
      new_command(root, "cut", "Cut pockets, contours and holes of a drawing", kExamples, options->output);
  parser
      .add_text("FILE", options->file,
                "A drawing (.dxf, .svg), an outline file (.json), a mesh (.stl, .3mf, .obj), a picture "
                "(.png, .jpg) or a job (.toml)")
      .optional();
  parser.add_text("--op", options->op, "The operation: " + joined(cut_operation_names(), ", "))
      .value_name("NAME");
  parser.add_text("--tool", options->tool, "The tool, as \"square d=6\"").value_name("SPEC");
  parser.add_text("--stock", options->stock, "The stock, as \"100x60x12\"").value_name("SPEC");
  for (const CutOption& option : cut_options())
    if (option.key->name != "tool" && option.key->name != "name")
      add_key(parser, options, *option.key, option.meaning, option.usual);
  for (const CutTextKey& key : cut_text_keys()) add_key(parser, options, key, std::string(key.meaning), "");
  for (const CutPictureKey& key : cut_picture_keys())
    if (key.name != "at") add_key(parser, options, key, std::string(key.meaning), "");
  for (const CutLayoutKey& key : cut_layout_keys())
    add_key(parser, options, key, std::string(key.meaning), "");
  parser.add_text("--mesh", options->mesh, "A mesh to cut, where FILE is a drawing").value_name("PATH");
  parser.add_text("--mesh-move", options->mesh_move, "Moves the mesh, mm").value_name("X,Y,Z");
  parser.add_text("--unit", options->unit, "Unit of a drawing that specifies none")
      .one_of({"mm", "inch", "px", "pt"});
  parser
      .add_text(
          "--strokes", options->strokes,
          "Strokes and wide polylines of a drawing: their centre lines (default), or the areas they cover")
      .one_of({"lines", "areas"});
  parser.add_text("--texts", options->texts, std::string(kTextsMeaning)).value_name("HOW");
  parser
      .add_text(
          "--to", options->to,
          "The controller: a name of kerf post --list (default grbl, for lasers laser); sheet: a setup sheet")
      .value_name("POST");
  parser.add_text("--tool-change", options->tool_change, "How tools are changed (default: the post's)")
      .one_of({"command", "pause", "files", "ignore"});
  add_output(parser, options->out, options->output, "The file to write (default: -, standard output)");
  parser.add_text("--example", options->example, "Print a job file for an operation").value_name("OP");
  parser.add_flag("--schema", options->schema, "Print the JSON schema of job files");
  return {parser, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app
