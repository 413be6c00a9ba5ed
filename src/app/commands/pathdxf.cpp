// `kerf pathdxf`.
#include "app/commands/pathdxf.h"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <utility>

#include "app/commands/drop_in_output.h"
#include "app/options/pathdxf_options.h"
#include "app/options/slash_options.h"
#include "app/report/console.h"
#include "app/report/sent_files.h"
#include "app/report/text_out.h"
#include "base/codes/files.h"
#include "base/codes/pathdxf.h"
#include "base/ending.h"
#include "job/path_programs.h"

#include "kerf/base/files.h"

namespace kerf::app {
namespace {

constexpr Bilingual kNoFiles{"No dxf files provided", "Keine DXF-Dateien angegeben"};
constexpr Bilingual kStale{
    "the file is of an earlier run of this drawing; this run does not write it",
    "Die Datei stammt von einem früheren Lauf dieser Zeichnung; dieser Lauf schreibt sie nicht"};

constexpr Bilingual kNotOnly{"the program has several files, as it probes heights",
                             "Das Programm hat mehrere Dateien, denn es misst Höhen"};
constexpr Bilingual kIsDrawing{"the output would replace the drawing",
                               "Die Ausgabe würde die Zeichnung ersetzen"};

/// One DXF file after the other; after an error nothing more is written.
class PathdxfCommand {
 public:
  explicit PathdxfCommand(PathdxfCommandLine line, Progress* progress)
      : line_(std::move(line)), progress_(progress) {
    line_.run.report = [](std::string_view text) { print_line(text); };
  }

  int run() {
    for (const std::string& name : line_.files) {
      if (stop_requested(progress_)) break;
      process(has_ending(name, ".dxf") ? name : name + ".dxf");
    }
    print_messages(diagnostics_, line_.explain || stderr_is_terminal());
    return diagnostics_.has_errors() || stop_requested(progress_) ? kDropInErrors : 0;
  }

 private:
  void process(const std::string& file) {
    const bool failed_before = diagnostics_.has_errors();
    const PathdxfRun compiled = compile_pathdxf(file, line_.run, diagnostics_, progress_);
    const bool writes = line_.run.selection == PathdxfSelection::only_path && !failed_before && is_whole();
    for (const PathdxfProgram& program : compiled.programs) {
      if (writes && !stop_requested(progress_)) write(file, program);
      print_statistics(program);
    }
    if (!line_.sheet.empty()) write_sheet(file, compiled);
  }

  /// Elements without depth or infeed are left out of a program, as by the original. With other errors it is
  /// not written.
  bool is_whole() const {
    return std::none_of(diagnostics_.list().begin(), diagnostics_.list().end(), [](const Diagnostic& d) {
      return d.severity == Severity::error && d.code != codes::pathdxf_value_missing &&
             d.code != codes::pathdxf_no_segments;
    });
  }

  void print_writing(const std::string& file) const {
    print_line(fmt::format(fmt::runtime(kWritingFile.in(line_.run.language)), file));
  }

  static void print_statistics(const PathdxfProgram& program) {
    std::string text;
    for (std::size_t i = 0; i < program.statistics.size(); ++i)
      text += fmt::format("{};{}", program.statistics[i],
                          i == 2 || i + 1 == program.statistics.size() ? "\n" : " ");
    fmt::print(stderr, "{}", text);
  }

  /// Writes the only file of a program for --output.
  void write_only(const std::string& drawing, const std::vector<PathFile>& files) {
    const Origin where = CallLocation{"", 0, "--output"};
    if (files.size() != 1) {
      diagnostics_.error(codes::file_unwritable, where, std::string(kNotOnly.in(line_.run.language)));
    } else if (line_.output != "-" && is_same_file(line_.output, drawing)) {
      diagnostics_.error(codes::output_is_input, where, std::string(kIsDrawing.in(line_.run.language)));
    } else {
      print_writing(line_.output);
      TextOut out(line_.output == "-" ? "" : line_.output);
      out.write(files.front().text);
      if (!out.finish()) diagnostics_.error(codes::file_unwritable, where, out.error_text());
    }
  }

  void write(const std::string& file, const PathdxfProgram& program) {
    const std::string base = file.substr(0, file.size() - 4);
    OutputSet files;
    bool good = true;
    const std::vector<PathFile> written = path_files(program, file, diagnostics_);
    if (!line_.output.empty()) return write_only(file, written);
    for (const PathFile& made : written) {
      print_writing(base + made.ending);
      good = good && files.write(base + made.ending, made.text, diagnostics_);
    }
    if (good) files.commit(diagnostics_);
    for (const std::string& stale : stale_path_files(base, program, written))
      diagnostics_.note(codes::pathdxf_stale, TextLocation{stale, 0, 0},
                        std::string(kStale.in(line_.run.language)));
  }

  void write_sheet(const std::string& file, const PathdxfRun& compiled) {
    Console console({});
    SentFiles files(console);
    print_writing(line_.sheet);
    if (files.write(line_.sheet, path_sheet_svg(file, compiled, diagnostics_), diagnostics_))
      files.commit(diagnostics_);
  }

  PathdxfCommandLine line_;
  Progress* progress_;
  Diagnostics diagnostics_;
};

}  // namespace

int pathdxf_command(const std::vector<std::string>& arguments, Progress* progress) {
  PathdxfCommandLine line = parse_pathdxf_options(arguments);
  print_line("Kerf " KERF_VERSION " pathdxf\n");
  if (line.help || line.problems.has_errors()) {
    if (!line.help) print_messages(line.problems, true);
    fmt::print(stderr, "{}", pathdxf_usage(line.run.language));
    return kDropInUsage;
  }
  if (line.files.empty()) {
    fmt::print(stderr, "**** Options: {}\n", kNoFiles.in(line.run.language));
    return kDropInNoFile;
  }
  return PathdxfCommand(std::move(line), progress).run();
}

}  // namespace kerf::app
