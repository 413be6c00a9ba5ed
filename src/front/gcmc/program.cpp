// Runs a program: sources, parser, compiler, virtual machine, sinks.
#include <algorithm>
#include <deque>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "base/codes/files.h"
#include "base/codes/gcmc.h"
#include "base/file_names.h"
#include "embedded_gcmc_library.h"
#include "front/gcmc/code/compiler.h"
#include "front/gcmc/gcmc.h"
#include "front/gcmc/out/path_sink.h"
#include "front/gcmc/out/text_sink.h"
#include "front/gcmc/run/builtins.h"
#include "front/gcmc/run/vm.h"
#include "front/gcmc/text/parser.h"

#include "kerf/base/files.h"

namespace kerf {
namespace gcmc {
namespace {

constexpr std::size_t kLargestSource = std::size_t{256} << 20;

/// Passes the messages of lexer and parser to output and diagnostics, and counts them.
class Reporter final : public SourceReport {
 public:
  Reporter(const std::deque<Source>& sources, GcmcOutput& output, Diagnostics& diagnostics)
      : sources_(sources), output_(output), diagnostics_(diagnostics) {}
  void error(SourceLocation at, Code code, std::string message, std::string hint) override {
    report(Severity::error, at, code, std::move(message), std::move(hint));
    ++errors;
  }
  void warning(SourceLocation at, Code code, std::string message) override {
    report(Severity::warning, at, code, std::move(message), {});
    ++warnings;
  }
  void fatal(SourceLocation at, Code code, std::string message) override {
    report(Severity::error, at, code, std::move(message), {});
    ++errors;
    over_ = true;  // further messages would be consequences of this one
  }
  std::size_t errors = 0, warnings = 0;

 private:
  void report(Severity severity, SourceLocation at, Code code, std::string text, std::string hint) {
    if (over_) return;
    Diagnostic d;
    d.severity = severity;
    d.code = code;
    d.where = TextLocation{sources_[at.file].name, at.line, at.column};
    d.message = std::move(text);
    d.hint = std::move(hint);
    output_.message(d);
    diagnostics_.add(std::move(d));
  }
  const std::deque<Source>& sources_;
  GcmcOutput& output_;
  Diagnostics& diagnostics_;
  bool over_ = false;
};

/// The text of a file; nothing if there is none. For a file that cannot be read, `problem` becomes the reason
/// if it is empty.
std::optional<std::string> file_text(const std::string& path, std::string& problem) {
  if (!exists(path)) return std::nullopt;
  Diagnostics diagnostics;
  std::optional<InputFile> file;
  if (is_device(path))
    diagnostics.error(codes::file_unreadable, TextLocation{path, 0, 0}, "it is a device, not a regular file");
  else
    file = InputFile::open(path, diagnostics, kLargestSource);
  if (file) return std::string(file->bytes());
  if (problem.empty()) problem = diagnostics.list().front().message;
  return std::nullopt;
}

/// Searches an included file in the current folder, the given paths and the built-in library.
bool find_include(const GcmcOptions& options, const std::string& name, Source& found, std::string& problem) {
  if (name.empty() || name == "-" || name.find('\0') != std::string::npos) return false;
  std::vector<std::string> candidates{name};
  if (!is_absolute(name))
    for (const std::string& folder : options.include_paths)
      candidates.push_back(folder + (!folder.empty() && folder.back() == '/' ? "" : "/") + name);
  for (const std::string& path : candidates) {
    if (auto text = file_text(path, problem)) {
      found = {path, std::move(*text)};
      return true;
    }
  }
  for (std::size_t i = 0; i < embedded::gcmc_library_count; ++i) {
    if (embedded::gcmc_library[i].name != name) continue;
    found = {std::string(kGcmcLibraryPrefix) + name, std::string(embedded::gcmc_library[i].bytes)};
    return true;
  }
  return false;
}

/// Parses the defines, then the program. False after an error.
bool parse_all(std::string_view text, const GcmcOptions& options, Tree& tree, std::deque<Source>& sources,
               Reporter& report) {
  std::string defines;
  for (const std::string& d : options.defines) defines += d + ";\n";
  sources.push_back({std::string(kGcmcDefinesName), std::move(defines)});
  sources.push_back({options.file_name, std::string(text)});
  const Includer includer = [&](const std::string& name, Source& found, std::string& problem) {
    return find_include(options, name, found, problem);
  };
  const IsBuiltin is_builtin = [](std::string_view name) { return builtin_index(name) >= 0; };
  Parser parser(tree, sources, report, includer, is_builtin);
  parser.parse(0);
  parser.parse(1);
  return report.errors == 0;
}

std::vector<NameId> declare_constants(Tree& tree, const std::vector<LanguageConstant>& constants) {
  std::vector<NameId> names;
  for (const LanguageConstant& c : constants) names.push_back(tree.intern(c.name));
  return names;
}

TextLocation last_line(const std::string& file, std::string_view text) {
  const auto breaks = static_cast<std::uint32_t>(std::count(text.begin(), text.end(), '\n'));
  const bool is_open = text.empty() || text.back() != '\n';
  return {file, breaks + (is_open ? 1u : 0u), 0};
}

int exit_status(const Vm& vm, int returned) { return vm.script_failed() ? 1 : returned & 255; }

void run_code(const Tree& tree, const std::deque<Source>& sources, Program& code,
              const std::vector<NameId>& names, const GcmcOptions& options, GcmcOutput& output,
              Diagnostics& diagnostics, Progress* progress, GcmcRun& run) {
  Vm vm(tree, sources, code, options, output, diagnostics, progress);
  std::vector<LanguageConstant> constants = language_constants(vm.meter, options.version);
  for (std::size_t i = 0; i < names.size(); ++i) vm.define_constant(names[i], std::move(constants[i].value));
  TextSink text(vm, output);
  PathSink path(run.path, vm);
  if (options.want_text) vm.machine().sinks.push_back(&text);
  if (options.want_path) vm.machine().sinks.push_back(&path);
  try {
    if (options.want_text) text.start();
    run.status = exit_status(vm, vm.run());
    if (options.want_path) path.finish(last_line(options.file_name, sources[1].bytes));
    if (options.want_text) text.end();
    run.completed = true;
  } catch (const Stop&) {
    run.status = 1;
    run.stopped = vm.was_stopped();
    text.flush_after_error();
  }
  run.warnings += vm.warnings();
  run.layers = vm.machine().layers;
}

}  // namespace
}  // namespace gcmc

std::string gcmc_line(const Diagnostic& d) {
  const bool of_program = d.code == codes::gcmc_script;
  std::string_view word = "error: ";
  if (of_program)
    word = d.severity == Severity::note      ? "Runtime message(): "
           : d.severity == Severity::warning ? "Runtime warning(): "
                                             : "Runtime error(): ";
  else if (d.severity == Severity::warning)
    word = "warning: ";
  else if (d.code == codes::gcmc_text_end)
    word = "fatal: ";
  const auto* where = std::get_if<TextLocation>(&d.where);
  if (where == nullptr) return fmt::format("{}{}", word, d.message);
  return fmt::format("{}:{}:{}: {}{}", where->file, where->line, where->column, word, d.message);
}

GcmcRun run_gcmc(std::string_view text, const GcmcOptions& options, GcmcOutput& output,
                 Diagnostics& diagnostics, Progress* progress) {
  using namespace gcmc;
  GcmcRun run;
  Tree tree;
  std::deque<Source> sources;
  Reporter report(sources, output, diagnostics);
  if (!parse_all(text, options, tree, sources, report)) {
    run.status = 1;
  } else {
    Meter meter;
    meter.limit = options.max_memory;
    const std::vector<NameId> names = declare_constants(tree, language_constants(meter, options.version));
    try {
      Program code = compile(tree, names, builtin_index, meter);
      run_code(tree, sources, code, names, options, output, diagnostics, progress, run);
    } catch (const TooManySlots&) {
      report.error({1, 1, 1}, codes::gcmc_limit,
                   "The program is too large: too many variables or instructions", {});
      run.status = 1;
    } catch (const OutOfMemory&) {
      report.error({1, 1, 1}, codes::gcmc_limit, "The program's constants do not fit into memory", {});
      run.status = 1;
    }
  }
  run.warnings += report.warnings;
  for (Source& s : sources) run.sources.emplace_back(std::move(s.name), std::move(s.bytes));
  return run;
}

bool check_gcmc(std::string_view text, const GcmcOptions& options, GcmcOutput& output,
                Diagnostics& diagnostics) {
  gcmc::Tree tree;
  std::deque<gcmc::Source> sources;
  gcmc::Reporter report(sources, output, diagnostics);
  return gcmc::parse_all(text, options, tree, sources, report);
}

}  // namespace kerf
