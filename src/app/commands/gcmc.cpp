// `kerf gcmc`: runs the compiler as the command gcmc does.
#include "app/commands/gcmc.h"

#include <cstdio>
#include <ctime>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <string_view>

#include "app/options/gcmc_options.h"
#include "app/report/text_out.h"
#include "back/drawing/gcmc_drawing.h"
#include "base/codes/gcmc.h"
#include "base/system.h"
#include "front/gcmc/gcmc.h"
#include "job/record/record.h"

#include "kerf/base/files.h"

namespace kerf::app {
namespace {

constexpr std::size_t kLargestProgram = std::size_t{4} << 30;  // bytes

std::string date_now() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
#if defined(__unix__) || defined(__APPLE__)
  localtime_r(&now, &local);
#else
  local = *std::localtime(&now);
#endif
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &local);
  return text;
}

/// The compiler's text to `out`, its messages to stderr in gcmc's form; with `explain` followed by the source
/// line, notes and hint.
class CommandOutput final : public GcmcOutput {
 public:
  CommandOutput(TextOut& out, bool explain) : out_(out), explain_(explain) {}

  /// Text of a source that is not a file, for `explain`.
  void add_source(const std::string& name, std::string_view text) { texts_[name] = text; }
  void message(const Diagnostic& m) override {
    if (silent || (drops_messages && m.severity == Severity::note)) return;
    std::fflush(stdout);
    std::string text = gcmc_line(m) + "\n";
    if (explain_ && m.severity != Severity::note) text += explanation(m);
    std::fwrite(text.data(), 1, text.size(), stderr);
  }
  void text(std::string_view piece) override { out_.write(piece); }
  bool is_broken() const override { return !out_.good(); }
  bool silent = false, drops_messages = false;  // message() of the program

 private:
  std::string explanation(const Diagnostic& m) {
    std::string text;
    const auto* where = std::get_if<TextLocation>(&m.where);
    const std::string line = where == nullptr ? "" : line_of(*where);
    if (!line.empty() && where->column > 0) {
      // gcmc reports errors of syntax at the column after the word.
      const bool is_after = m.code == codes::gcmc_syntax || m.code == codes::gcmc_word ||
                            m.code == codes::gcmc_text_end || m.code == codes::gcmc_defined_twice;
      const std::size_t at =
          std::min<std::size_t>(where->column - (is_after && where->column > 1 ? 2 : 1), line.size());
      std::string space = line.substr(0, at);
      for (char& c : space) c = c == '\t' ? '\t' : ' ';
      text += fmt::format("    {}\n    {}^\n", line, space);
    }
    for (const DiagnosticNote& n : m.notes)
      text += fmt::format("  {}: note: {}\n", to_string(n.where), n.text);
    if (!m.hint.empty()) text += fmt::format("  hint: {}\n", m.hint);
    return text;
  }

  std::string line_of(const TextLocation& where) {
    constexpr std::size_t kMaxLength = 200;
    auto known = texts_.find(where.file);
    if (known == texts_.end()) {
      Diagnostics ignored;
      const auto file = InputFile::open(where.file, ignored);
      known = texts_.emplace(where.file, file ? std::string(file->bytes()) : std::string()).first;
    }
    const std::string& text = known->second;
    std::size_t start = 0;
    for (std::uint32_t i = 1; i < where.line; ++i) {
      start = text.find('\n', start);
      if (start == std::string::npos) return {};
      ++start;
    }
    return text.substr(start, std::min(std::min(text.find('\n', start), text.size()) - start, kMaxLength));
  }

  TextOut& out_;
  bool explain_;
  std::map<std::string, std::string> texts_;
};

void complain(std::string_view text) { fmt::print(stderr, "kerf gcmc: {}\n", text); }

/// Whether the output would replace a file that was read; complains.
bool replaces(const std::string& output, const std::string& input) {
  if (output.empty() || input.empty() || !is_same_file(output, input)) return false;
  complain(fmt::format("the output would replace the input {}", input));
  return true;
}

bool read_text(const std::string& path, std::string& text) {
  if (path.empty()) return true;
  Diagnostics diagnostics;
  const auto file = InputFile::open(path, diagnostics);
  if (!file) {
    complain(to_string(diagnostics.list().front()));
    return false;
  }
  text = std::string(file->bytes());
  return true;
}

/// --check: the diagnostics of a file, as lines or as JSON, for editors. A program without errors of syntax
/// is run, and what it writes is dropped.
int check(GcmcCommandLine& line, std::string_view text, CommandOutput& output, Progress* progress) {
  Diagnostics diagnostics(1000);
  output.silent = line.json;
  output.drops_messages = true;
  line.run.want_path = line.run.want_text = false;
  const GcmcRun run = run_gcmc(text, line.run, output, diagnostics, progress);
  const bool good = run.completed && diagnostics.errors() == 0;
  if (line.json) {
    Record list = Record::array();
    for (const Diagnostic& d : diagnostics.list()) {
      const auto* where = std::get_if<TextLocation>(&d.where);
      list.push_back({{"code", static_cast<int>(d.code)},
                      {"column", where != nullptr ? where->column : 0},
                      {"file", where != nullptr ? where->file : ""},
                      {"hint", d.hint},
                      {"line", where != nullptr ? where->line : 0},
                      {"message", d.message},
                      {"name", name_of(d.code)},
                      {"severity", to_string(d.severity)}});
    }
    const std::string out = text_of(Record{{"diagnostics", list}}, Layout::indented);
    std::fwrite(out.data(), 1, out.size(), stdout);
  }
  return good ? 0 : 1;
}

int run_program(GcmcCommandLine& line, std::string_view text, TextOut& out, CommandOutput& output,
                Progress* progress) {
  const bool draws = line.run.target != GcmcTarget::gcode;
  line.run.want_path = draws;
  line.run.want_text = !draws;
  line.run.date = date_now();
  Diagnostics diagnostics;
  const GcmcRun run = run_gcmc(text, line.run, output, diagnostics, progress);
  for (const auto& [name, source] : run.sources)
    if (replaces(line.output, name)) return 1;
  const bool complete = run.completed;
  if (complete && draws) {
    line.drawing.layers = run.layers;
    out.write(line.run.target == GcmcTarget::svg ? gcmc_svg(run.path, line.drawing)
                                                 : gcmc_dxf(run.path, line.drawing));
  }
  if (!complete && !line.output.empty() && out.good()) return run.status;  // nothing is written
  if (!out.finish()) {
    complain(out.error_text());
    return 1;
  }
  if (complete && line.warnings_are_errors && run.warnings > 0) {
    fmt::print(stderr, "error: Runtime warnings considered to be errors\n");
    return 1;
  }
  return run.status;
}

}  // namespace

int gcmc_command(const std::vector<std::string>& arguments, Progress* progress) {
  GcmcCommandLine line = parse_gcmc_options(arguments);
  if (line.version) {
    fmt::print("gcmc version {}, as implemented by Kerf {}\nKerf is licensed under the Apache License 2.0\n",
               gcmc_version_text(line.run.version), KERF_VERSION);
    return 0;
  }
  for (const std::string& error : line.errors) complain(error);
  if (line.help || !line.errors.empty()) {
    fmt::print(stderr, "{}", line.help ? gcmc_usage() : "Try: kerf gcmc --help\n");
    return 1;
  }
  if (!read_text(line.prologue_file, line.run.prologue) || !read_text(line.epilogue_file, line.run.epilogue))
    return 1;

  Diagnostics diagnostics;
  const auto file =
      InputFile::open(line.input.empty() ? "-" : line.input, diagnostics, kLargestProgram, progress);
  if (!file) {
    complain(to_string(diagnostics.list().front()));
    return 1;
  }
  if (!line.input.empty()) line.run.file_name = line.input;
  for (const std::string& input : {line.input, line.prologue_file, line.epilogue_file})
    if (replaces(line.output, input)) return 1;
  TextOut out(line.check ? std::string() : line.output);
  if (!out.good()) {
    complain(out.error_text());
    return 1;
  }
  const bool explain = line.explain || is_terminal(Stream::error);
  // Bare text for another program comes with the messages of the real program only.
  line.run.own_warnings = explain || line.check || line.run.frame != GcmcFrame::bare;
  CommandOutput output(out, explain);
  output.add_source(line.run.file_name, file->bytes());
  if (line.check) return check(line, file->bytes(), output, progress);
  return run_program(line, file->bytes(), out, output, progress);
}

}  // namespace kerf::app
