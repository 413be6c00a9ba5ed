// kerf printer list, kerf printer import: the printers that are known, and the one of a sliced program.
#include <fmt/format.h>
#include <memory>

#include "app/commands/commands.h"
#include "app/options/common.h"
#include "app/report/terminal_progress.h"
#include "base/codes/files.h"
#include "base/file_names.h"
#include "base/number.h"
#include "job/configuration.h"
#include "job/record/record.h"

#include "kerf/base/files.h"
#include "kerf/formats/printer_files.h"
#include "kerf/job/program.h"

namespace kerf::app {
namespace {

struct Options {
  OutputOptions output;
  std::string file, out;
};

/// The printers of the configuration's folder, each by the name of its file.
void list_own(Console& console, Record& printers) {
  for (const std::string& file : used_configuration().files_in("printers")) {
    const std::string name(file_name_of(with_extension(file, "")));
    printers.push_back(Record{{"name", name}, {"file", file}});
    if (!console.json()) console.print(fmt::format("{:<16} {}\n", name, file));
  }
}

Status list(Console& console) {
  const PrinterTable& table = built_in_printers();
  Record printers = Record::array(), filaments = Record::array();
  list_own(console, printers);
  for (const PrinterProfile& p : table.printers) {
    const std::string size =
        p.bed ? fmt::format("{} x {} x {} mm", number_text(p.bed->high.x - p.bed->low.x, 1),
                            number_text(p.bed->high.y - p.bed->low.y, 1), number_text(p.bed->high.z, 1))
              : std::string("size unknown");
    const double flow = in_mm3_per_s(p.max_flow);
    Record entry{{"name", p.name}, {"names", p.names}, {"firmware", p.firmware}};
    entry["max_flow_mm3_s"] = flow > 0.0 ? record_of(flow) : Record(nullptr);
    printers.push_back(entry);
    if (!console.json())
      console.print(fmt::format("{:<16} {:<15} {:<22} {}\n", p.name, p.firmware, size,
                                flow > 0.0 ? number_text(flow, 2) + " mm3/s" : "flow unknown"));
  }
  for (const FilamentProfile& f : table.filaments) {
    filaments.push_back(
        Record{{"name", f.name}, {"nozzle_c", record_of(f.nozzle)}, {"bed_c", record_of(f.bed)}});
    if (!console.json())
      console.print(fmt::format("{:<16} nozzle {} C, bed {} C\n", f.name, number_text(f.nozzle, 1),
                                number_text(f.bed, 1)));
  }
  if (console.json())
    console.print_json(text_of(Record{{"printers", printers}, {"filaments", filaments}}, Layout::indented));
  return Status::done;
}

Status import(Console& console, const Options& options) {
  Diagnostics usage, diagnostics;
  if (!options.out.empty() && is_same_file(options.out, options.file))
    usage.error(codes::output_is_input, CallLocation{"", 0, "-o"}, "the output would replace the input");
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  TerminalProgress progress(console);
  const auto file = InputFile::open(options.file, diagnostics);
  const auto program = file ? load_program(options.file, {}, diagnostics, &progress) : std::nullopt;
  progress.clear();
  if (interrupted()) return report_stopped(console);
  if (!program || diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  if (!program->path.has(StepKind::extrude)) {
    diagnostics.error(codes::nothing_to_cut, TextLocation{options.file, 0, 0},
                      "the program does not print; a printer is imported from a sliced program");
    return fail(console, diagnostics, Status::input_errors);
  }
  const std::string text = write_printer_file(import_printer(file->bytes(), program->path));
  if (options.out.empty()) {
    console.print_json(text);
    return Status::done;
  }
  OutputSet set({options.file});
  if (!set.write(options.out, text, diagnostics) || !set.commit(diagnostics))
    return fail(console, diagnostics, Status::input_errors);
  console.show(diagnostics);
  if (console.json())
    console.print_json(
        text_of(Record{{"outputs", Record::array({options.out})}, {"diagnostics", record_of(diagnostics)}},
                Layout::indented));
  else
    console.summary("wrote    " + options.out);
  return Status::done;
}

const char* const kImportExamples = R"(  kerf printer import sliced.gcode -o printer.toml
  kerf check print.gcode --printer printer.toml
  kerf post --printer printer.toml print.gcode -o out.gcode

Bed, bead sizes, speeds and temperatures are those of the slicer's comments and of the steps; the lines before
the first layer and after the last one become the start and the end of written programs.
)";

}  // namespace

Command add_printer_list(CommandParser& printer) {
  auto options = std::make_shared<Options>();
  CommandParser parser = new_command(printer, "list", "The printers and filaments that --printer knows",
                                     "  kerf printer list\n", options->output);
  return {parser, &options->output, [](Console& console) { return list(console); }};
}

Command add_printer_import(CommandParser& printer) {
  auto options = std::make_shared<Options>();
  CommandParser parser = new_command(printer, "import", "Make a printer file of a sliced program",
                                     kImportExamples, options->output);
  add_program(parser, options->file);
  add_output(parser, options->out, options->output, "The file to write (default: -, standard output)");
  return {parser, &options->output, [options](Console& console) { return import(console, *options); }};
}

}  // namespace kerf::app
