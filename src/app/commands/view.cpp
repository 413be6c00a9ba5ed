// kerf view: shows a program and what it cuts in a browser, and follows the file while it is edited.
#include <chrono>
#include <cstdlib>
#include <fmt/format.h>
#include <memory>
#include <thread>

#include "app/commands/burn.h"
#include "app/commands/commands.h"
#include "app/options/common.h"
#include "app/options/job_options.h"
#include "app/report/sent_files.h"
#include "app/report/terminal_progress.h"
#include "app/shown/file_name.h"
#include "app/view/access.h"
#include "app/view/open_page.h"
#include "app/view/page.h"
#include "app/view/server.h"
#include "base/codes/files.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"
#include "kerf/drawing/svg.h"

namespace kerf::app {
namespace {

constexpr const char* kTokenForm = "expected 16 to 100 letters, digits, - or _";
constexpr const char* kOriginForm =
    "expected http:// or https:// and a host in small letters, with a port if need be";
constexpr double kMaxPort = 65535;
constexpr double kMinLimit = 0.1, kMaxLimit = 86400;  // s, --limit
constexpr std::chrono::milliseconds kTick{50};        // between checks for interrupts

struct Options {
  OutputOptions output;
  JobOptions job;
  double resolution = 0.0, threads = 0.0, port = 0.0, limit = 60.0;
  std::string token, token_file, export_to, target, unit;
  std::vector<std::string> frame_origins;
  BurnCommand burn;
  bool columns = false;  // edges stay those of the columns
  bool open = false;     // in the browser
};

/// Reads the options again: files of tools and stock may have changed.
view::Inputs read_inputs(const Options& options, Diagnostics& diagnostics, Progress* progress) {
  Diagnostics usage;
  JobInputs inputs = read_job_options(options.job, usage, diagnostics, progress);
  for (const Diagnostic& d : usage.list()) diagnostics.add(d);
  inputs.program.unknown_diameter = UnknownDiameter::assume;
  view::Inputs out{std::move(inputs.job), std::move(inputs.program)};
  out.burn = {{.beam = mm(options.burn.beam), .full_power = options.burn.power, .full_s = options.burn.max_s},
              options.burn.black};
  if (!options.unit.empty()) out.unit = drawing_unit(options.unit);
  if (options.target.empty()) return out;
  const auto target = load_stock(options.target, diagnostics, progress);
  if (target) out.target = view::Target{options.target, target->body};
  return out;
}

view::SessionOptions session_options(const Options& options) {
  view::SessionOptions out;
  out.file = options.job.file;
  out.other_files = input_files(options.job);
  out.other_files.insert(out.other_files.end(), options.job.tools.files.begin(),
                         options.job.tools.files.end());
  if (!options.target.empty()) out.other_files.push_back(options.target);
  if (!options.job.machine.empty()) out.other_files.push_back(options.job.machine);
  out.read_inputs = [options](Diagnostics& diagnostics, Progress* progress) {
    return read_inputs(options, diagnostics, progress);
  };
  out.frame_origins = options.frame_origins;
  out.resolution = mm(options.resolution);
  out.threads = static_cast<unsigned>(options.threads);
  out.edges = options.columns ? view::IdleEdges::columns : view::IdleEdges::exact;
  out.reading_limit = std::chrono::milliseconds(static_cast<long>(options.limit * 1e3));
  return out;
}

Status write_export(Console& console, const Options& options) {
  view::Events events;
  view::Session session(session_options(options), events);
  session.load_once();
  const auto shown = session.shown();
  if (interrupted()) return report_stopped(console);
  Diagnostics diagnostics = session.last_diagnostics();
  if (shown->state != view::State::ready) return fail(console, diagnostics, Status::input_errors);
  SentFiles set(console, shown->job->program.files);
  if (!set.write(options.export_to, view::exported_page(session), diagnostics) || !set.commit(diagnostics))
    return fail(console, diagnostics, Status::input_errors);
  console.show(diagnostics);
  console.summary(fmt::format("written  {}", options.export_to));
  if (console.json())
    console.print_json(text_of(
        Record{{"outputs", Record::array({options.export_to})}, {"diagnostics", record_of(diagnostics)}},
        Layout::indented));
  return Status::done;
}

bool is_token(const std::string& text) { return text.size() >= 16 && view::download_name(text) == text; }

/// The secret: the option's, a file's, the environment's, else a random one. Other accounts can read the
/// options of a process, but neither its environment nor the file.
std::string token_of(const Options& options, Diagnostics& diagnostics) {
  if (!options.token.empty()) return options.token;
  const char* given = std::getenv("KERF_VIEW_TOKEN");
  std::string token = given != nullptr ? given : "";
  if (!options.token_file.empty()) {
    const auto file = InputFile::open(options.token_file, diagnostics);
    if (!file) return "";
    token = std::string(file->bytes().substr(0, file->bytes().find_first_of("\r\n")));
  }
  if (token.empty() && options.token_file.empty()) return view::random_token();
  if (!is_token(token))
    diagnostics.error(codes::usage,
                      CallLocation{"", 0, options.token_file.empty() ? "KERF_VIEW_TOKEN" : "--token-file"},
                      kTokenForm);
  return token;
}

Status serve(Console& console, const Options& options) {
  Diagnostics diagnostics;
  const std::string token = token_of(options, diagnostics);
  if (diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  view::Events events;
  view::Session session(session_options(options), events);
  view::Server server(session, events, token);
  if (token.empty() || !server.bind(static_cast<int>(options.port))) {
    diagnostics
        .error(codes::usage, CallLocation{"", 0, "--port"},
               fmt::format("port {} is in use", static_cast<int>(options.port)))
        .hint = "without --port a free one is used";
    return fail(console, diagnostics, Status::input_errors);
  }
  server.start();
  session.start();
  const std::string address = fmt::format("http://127.0.0.1:{}/?t={}", server.port(), token);
  if (console.json()) {
    console.print_json(text_of(Record{{"address", address}, {"port", server.port()}}, Layout::line));
  } else {
    console.print(address + "\n");
    if (!view::has_full_page())
      console.summary("this build has a simple page without controls: it was made without Node.js");
  }
  console.finish();
  view::OpenedPage page;
  if (options.open && !page.open(address)) console.error("cannot start a browser");
  while (!interrupted()) {
    std::this_thread::sleep_for(kTick);
    if (const auto failure = session.take_failure()) console.show(*failure);
  }
  session.end();
  server.stop();
  return Status::done;
}

Status run(Console& console, const Options& options) {
  Diagnostics usage, diagnostics;
  TerminalProgress progress(console);
  read_job_options(options.job, usage, diagnostics, &progress);
  progress.clear();
  if (interrupted()) return report_stopped(console);
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  return options.export_to.empty() ? serve(console, options) : write_export(console, options);
}

const char* const kExamples =
    R"(  kerf view part.nc                      open the printed address in a browser
  kerf view --open part.nc               in the default browser at once
  kerf view part.gcmc --port 8000        at this port instead of a free one
  kerf view part.nc --export part.html   one file to keep or to send; it needs no server

The page shows the part, the toolpath, the source and the hazards, and follows the file: after each save, of
an included file too, only what has changed is cut again. Errors are shown with their lines; the last good
part stays. The server answers this machine alone, and only pages opened with the printed address. Ctrl-C
ends it.
)";

}  // namespace

Command add_view(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser =
      new_command(root, "view", "Show a program and what it cuts in a browser while it is edited",
                  kExamples + std::string(kToolHelp) + kStockHelp + kBodyHelp + kRotaryHelp, options->output);
  add_job_options(parser, options->job);
  add_setup_options(parser, options->job.bodies);
  add_machine_option(parser, options->job);
  parser
      .add_text("--target", options->target,
                "The nominal part, a closed mesh: colours show what is left of it and what is gouged")
      .value_name("MESH");
  parser.add_text("--unit", options->unit, "Unit of a drawing that specifies none")
      .one_of({"mm", "inch", "px", "pt"});
  add_burn_options(parser, options->burn);
  add_length(parser, "--resolution", options->resolution, limits::kFinestResolution,
             limits::kCoarsestResolution,
             "Distance of the dexel columns, e.g. 0.1 or 0.002in (default: by the stock's size)");
  parser.add_flag("--columns", options->columns,
                  "Keep edges as the columns show them, instead of making them exact once the file rests");
  parser.add_flag("--open", options->open, "Open the page in a browser: $BROWSER, else the default one");
  add_number(parser, "--port", options->port, 0, kMaxPort, "PORT",
             "Port of the server (default: 8347, or a free one)");
  parser
      .add_text("--token", options->token,
                "Secret of the address, for a page that stays open over a restart (default: random)")
      .value_name("TEXT")
      .check(
          [](const std::string& text) { return is_token(text) ? std::string() : std::string(kTokenForm); });
  parser
      .add_text("--token-file", options->token_file,
                "File whose first line is the secret; $KERF_VIEW_TOKEN is one, too")
      .value_name("PATH");
  add_number(parser, "--limit", options->limit, kMinLimit, kMaxLimit, "SECONDS",
             "A program that is not read by then is stopped (default: 60)");
  add_other_output(parser, "--export", options->export_to, options->output,
                   "Write one HTML file that needs no server, instead of serving");
  add_repeated(parser, "--frame-in", options->frame_origins, "ORIGIN",
               "Pages of this origin, e.g. https://shop.example, may have the page in a frame and steer it")
      .check([](const std::string& text) {
        return view::is_page_origin(text) ? std::string() : std::string(kOriginForm);
      });
  add_threads(parser, options->threads);
  return {parser, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app
