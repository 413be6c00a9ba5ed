// `kerf adjustz`.
#include "app/commands/adjustz.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <utility>

#include "app/commands/drop_in_output.h"
#include "app/options/adjustz_options.h"
#include "app/options/slash_options.h"
#include "app/report/console.h"
#include "base/pattern.h"

#include "kerf/adjust_z.h"
#include "kerf/files.h"
#include "kerf/measured.h"

namespace kerf::app {
namespace {

constexpr Length kSamePosition = mm(0.2);  // of a measured position and the probe's

/// The name without what is appended to it: "part.dxf", "part_Clean.gcode", "part_Z.txt".
std::string base_of(const std::string& name) {
  for (const std::string_view ending : {".dxf", "_clean.gcode", "_z.txt", "_milling.gcode", ".gcode"})
    if (has_ending(name, ending)) return name.substr(0, name.size() - ending.size());
  return name;
}

class AdjustzCommand {
 public:
  AdjustzCommand(AdjustzCommandLine line, Progress* progress) : line_(std::move(line)), progress_(progress) {}

  int run() {
    if (compile_shown_lines())
      for (const std::string& name : line_.files) {
        if (stop_requested(progress_)) break;
        process(base_of(name));
      }
    print_messages(diagnostics_, stderr_is_terminal());
    return diagnostics_.has_errors() || stop_requested(progress_) ? kDropInErrors : 0;
  }

 private:
  bool compile_shown_lines() {
    if (!line_.shown_lines) return true;
    std::string problem;
    shown_ = Pattern::compile(*line_.shown_lines, LetterCase::distinct, problem);
    if (!shown_) diagnostics_.error(Code::pathdxf_pattern, {}, "Invalid expression for /x: " + problem);
    return shown_.has_value();
  }
  std::optional<InputFile> open(const std::string& name) {
    print_line("Reading " + name);
    return InputFile::open(name, diagnostics_, limits::kMaxProgramBytes, progress_);
  }
  void process(const std::string& base);
  std::optional<std::map<int, double>> values(const std::string& base, const MeasuredFile& list);
  std::vector<HeightTarget> targets(const std::string& base, const MeasuredFile& list);
  void show(std::string_view program);

  AdjustzCommandLine line_;
  Progress* progress_;
  std::optional<Pattern> shown_;
  Diagnostics diagnostics_;
};

/// The probes of a list, with the positions where the probing program measures them.
std::vector<HeightTarget> AdjustzCommand::targets(const std::string& base, const MeasuredFile& list) {
  std::vector<HeightTarget> out;
  for (const MeasuredHeight& h : list.heights) out.push_back({*h.variable, {}, h.expected});
  if (line_.measured.empty()) return out;
  const auto probing = open(base + "_Probing.gcode");
  if (!probing) return {};
  const auto positions = probed_positions(probing->bytes());
  if (positions.size() != out.size()) {
    diagnostics_.error(Code::heights_unmatched, TextLocation{probing->path(), 0, 0},
                       fmt::format("the program measures {} positions, {} lists {} probes", positions.size(),
                                   list.file, out.size()));
    return {};
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i].at = positions[i];
  return out;
}

std::optional<std::map<int, double>> AdjustzCommand::values(const std::string& base,
                                                            const MeasuredFile& list) {
  const auto of = [&](const MeasuredFile& measured) {
    return heights_of(measured, targets(base, list), kSamePosition, line_.max_correction, line_.language,
                      diagnostics_);
  };
  if (line_.measured.empty()) return of(list);
  const auto file = open(line_.measured);
  if (!file) return std::nullopt;
  const MeasuredFile measured =
      read_measured(file->bytes(), line_.measured, {line_.language, line_.work_offset}, diagnostics_);
  if (diagnostics_.has_errors()) return std::nullopt;
  return of(measured);
}

void AdjustzCommand::process(const std::string& base) {
  const auto list_file = open(base + "_Z.txt");
  if (!list_file) return;
  MeasuredFile list =
      read_measured(list_file->bytes(), base + "_Z.txt", {line_.language, std::nullopt}, diagnostics_);
  if (list.format != HeightsFormat::probe_list && !list.heights.empty())
    diagnostics_.error(Code::heights_format, TextLocation{list.file, 0, 0},
                       "this is no list of probes; specify files with positions with --measured");
  if (diagnostics_.has_errors()) return;
  const auto heights = values(base, list);
  if (!heights || diagnostics_.has_errors()) return;
  const auto program = open(base + "_Clean.gcode");
  if (!program) return;
  // Lists in the form of the document have no T: the formulas have it.
  for (const auto& [variable, expected] : expected_heights(program->bytes())) {
    const auto height = heights->find(variable);
    if (height == heights->end() || std::abs(height->second - expected) <= line_.max_correction.mm())
      continue;
    diagnostics_.error(Code::heights_deviation, TextLocation{list.file, 0, 0},
                       fmt::format("Value {} for #{} differs from {} by more than /m={}", expected, variable,
                                   height->second, line_.max_correction.mm()));
  }
  const auto text = adjust_z(program->bytes(), base + "_Clean.gcode", *heights, line_.language, diagnostics_);
  if (!text || diagnostics_.has_errors()) return;
  print_line("Writing " + base + "_Milling.gcode");
  OutputSet files;
  if (files.write(base + "_Milling.gcode", *text, diagnostics_)) files.commit(diagnostics_);
  show(program->bytes());
}

/// Prints the lines that match /x on standard output.
void AdjustzCommand::show(std::string_view program) {
  for (std::size_t i = 0; shown_ && i < program.size();) {
    const std::size_t end = std::min(program.find('\n', i), program.size());
    const std::string_view line = program.substr(i, end - i);
    if (shown_->search(line)) fmt::print("{}\n", line);
    i = end + 1;
  }
}

}  // namespace

int adjustz_command(const std::vector<std::string>& arguments, Progress* progress) {
  AdjustzCommandLine line = parse_adjustz_options(arguments);
  print_line("Kerf " KERF_VERSION " adjustz\n");
  if (line.help || line.problems.has_errors()) {
    if (!line.help) print_messages(line.problems, true);
    fmt::print(stderr, "{}", adjustz_usage(line.language));
    return kDropInUsage;
  }
  if (line.files.empty()) return kDropInNoFile;
  return AdjustzCommand(std::move(line), progress).run();
}

}  // namespace kerf::app
