// kerf check: what would break a tool, a part or the machine's patience, found without writing any file.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <memory>

#include "app/findings.h"
#include "app/job.h"
#include "app/options/command.h"
#include "app/report/terminal_progress.h"

#include "kerf/material_files.h"
#include "kerf/number.h"
#include "kerf/rotary.h"

namespace kerf::app {
namespace {

constexpr double kColumns = 500'000;                // of the coarse simulation that finds hazards
constexpr double kFinestDefault = 0.05;             // mm
constexpr double kCoarsestDefault = 1.0;            // mm
constexpr double kMostColumns = 50'000'000;         // more only if the user asks for a resolution
constexpr double kFinest = 0.0005, kCoarsest = 50;  // mm, --resolution

struct Options {
  OutputOptions output;
  JobOptions job;
  double resolution = 0.0, threads = 0.0;
  std::string material;
};

Length resolution_for(const Stock& stock, double told) {
  if (told > 0.0) return mm(told);
  const Point3 size = stock.block.size();
  const double area = size.x * size.y;
  const double usual = std::clamp(std::sqrt(area / kColumns), kFinestDefault, kCoarsestDefault);
  return mm(std::max(usual, std::sqrt(area / kMostColumns)));
}

/// Calls visit(step, context) for every cut with a tool whose shape nobody knows.
template <class Visit>
void for_each_unknown_cut(const Job& job, Visit&& visit) {
  const bool one_tool = job.tools.tools().size() == 1;  // stands in until the program chooses one
  for_each_motion(job.program.path, [&](const Step& s, const MotionContext& context) {
    if (s.is_cutting() && (context.tool ? job.tools.find(*context.tool) == nullptr : !one_tool))
      visit(s, context);
  });
}

/// A hazard for each tool whose shape nobody knows: what it cuts, nobody can look at. Cuts before any tool
/// change are a hazard of the toolpath.
std::vector<Finding> unknown_tools(const Job& job) {
  std::map<int, Finding> found;
  for_each_unknown_cut(job, [&](const Step& s, const MotionContext& context) {
    if (!context.tool) return;
    const auto [it, is_new] = found.try_emplace(*context.tool);
    if (!is_new) return void(++it->second.steps);
    it->second = {.kind = "unknown_tool",
                  .step = context.index,
                  .at = s.to(),
                  .origin = job.program.path.origin_of(context.index),
                  .message = fmt::format("nobody knows the shape of tool {}, which cuts here", *context.tool),
                  .callers = job.program.path.origins().callers(s.origin()),
                  .hint = hint_for_unknown(*context.tool)};
  });
  std::vector<Finding> list;
  for (auto& [tool, finding] : found) list.push_back(std::move(finding));
  return list;
}

/// A hazard for each G code that nobody knows: it may be a move, and the toolpath is looked at without it.
std::vector<Finding> left_out_codes(const Diagnostics& diagnostics) {
  std::vector<Finding> list;
  for (const Diagnostic& d : diagnostics.list())
    if (d.code == Code::unknown_g_code && d.severity != Severity::error)
      list.push_back({.kind = "left_out",
                      .at = {},
                      .origin = d.where,
                      .message = d.message + ", and nobody knows whether it moves the tool",
                      .callers = {},
                      .hint = d.hint});
  return list;
}

bool is_at_or_behind(const Origin& origin, const Origin& place) {
  const auto *at = std::get_if<TextSpot>(&origin), *spot = std::get_if<TextSpot>(&place);
  return at != nullptr && spot != nullptr && at->line >= spot->line && at->file == spot->file;
}

/// Gives findings that have a line only their step: the next motion, else the last one.
void place_on_path(std::vector<Finding>& findings, const Toolpath& path) {
  std::size_t placed = 0;  // they are in the order of lines
  for (std::size_t i = 0; i < path.size() && placed < findings.size(); ++i) {
    if (!path[i].is_motion()) continue;
    const Origin origin = path.origin_of(i);
    for (std::size_t k = placed; k < findings.size(); ++k) {
      findings[k].step = i;
      findings[k].at = path[i].to();
    }
    while (placed < findings.size() && is_at_or_behind(origin, findings[placed].origin)) ++placed;
  }
}

/// What can be cut: the toolpath up to the first cut with an unknown tool, after which nobody knows what is
/// left of the stock. Says so where that is not all.
Toolpath known_part(const Job& job, Diagnostics& diagnostics) {
  const Toolpath& path = job.program.path;
  std::size_t end = path.size();
  for_each_unknown_cut(job, [&](const Step&, const MotionContext& c) { end = std::min(end, c.index); });
  if (end == path.size()) return path;
  const auto& steps = path.steps();
  const bool any = std::any_of(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(end),
                               [](const Step& s) { return s.is_cutting(); });
  diagnostics.warning(Code::not_simulated, path.origin_of(end),
                      any ? "from here on the material was not looked at, because the tool is not known"
                          : "the material was not looked at, because the tool is not known");
  Toolpath part;
  part.origins() = path.origins();
  for (std::size_t i = 0; any && i < end; ++i) part.add_copy(path, i);
  return part;
}

/// The hazards met in the material, as far as it can be simulated (`diagnostics` says how far).
std::vector<Finding> findings_in_material(const Job& job, const Options& options, Diagnostics& diagnostics,
                                          Progress& progress) {
  if (!job.stock && !job.bar) {
    diagnostics.warning(Code::not_simulated, TextSpot{job.program.source, 0, 0},
                        "nothing is cut and no stock is told, so the material was not looked at");
    return {};
  }
  const Toolpath path = known_part(job, diagnostics);
  if (path.size() == 0) return {};
  SimulationOptions how;
  how.threads = static_cast<unsigned>(options.threads);
  if (job.bar) {
    how.resolution = mm(options.resolution);
    const auto simulation = simulate_rotary(path, job.tools, *job.bar, how, diagnostics, &progress);
    return simulation ? findings_of(simulation->hazards, path) : std::vector<Finding>{};
  }
  how.resolution = resolution_for(*job.stock, options.resolution);
  progress.phase("checking");
  const auto simulation = simulate(path, job.tools, *job.stock, how, diagnostics, &progress);
  if (!simulation) return {};
  if (!simulation->stopped) tell_untouched(job, simulation->removed, diagnostics);
  return merged(findings_at_fixtures(path, job.tools, job.fixtures, how, diagnostics, progress),
                findings_of(simulation->hazards, path));
}

/// All hazards of a job, in the order of steps.
std::vector<Finding> findings_in(const Job& job, const CheckOptions& checks, const Options& options,
                                 Diagnostics& diagnostics, Progress& progress) {
  const std::vector<PathHazard> of_path = check_path(job.program.path, checks);
  std::vector<Finding> findings = merged(findings_of(of_path, job.program.path), unknown_tools(job));
  std::vector<Finding> left_out = left_out_codes(diagnostics);
  place_on_path(left_out, job.program.path);
  findings = merged(std::move(findings), std::move(left_out));
  if (diagnostics.has_errors()) return findings;
  const bool downwards = std::any_of(of_path.begin(), of_path.end(),
                                     [](const PathHazard& h) { return h.code == Code::path_z_downwards; });
  if (downwards) {
    diagnostics.warning(Code::not_simulated, TextSpot{job.program.source, 0, 0},
                        "the material was not looked at, as Z seems to count downwards");
    return findings;
  }
  std::vector<Finding> in_material = findings_in_material(job, options, diagnostics, progress);
  tell_assumed_flutes(in_material, job.program.path, job.tools, diagnostics);
  return merged(std::move(findings), std::move(in_material));
}

/// What the reader said, without what is a hazard of its own: a missing feed or end, a code that is left out
/// are told once.
Diagnostics without_hazards(const Diagnostics& all) {
  Diagnostics rest = all;
  rest.remove_if([](const Diagnostic& d) {
    const bool is_hazard =
        d.code == Code::no_feed || d.code == Code::no_program_end || d.code == Code::unknown_g_code;
    return d.severity != Severity::error && is_hazard;
  });
  return rest;
}

void show_result(Console& console, const LoadedProgram& program, const std::vector<Finding>& findings,
                 const Diagnostics& diagnostics) {
  console.show(diagnostics);
  if (console.json()) {
    const Json out{
        {"source", program.source}, {"hazards", json_of(findings)}, {"diagnostics", json_of(diagnostics)}};
    console.print_json(text_of(out, Layout::indented));
    return;
  }
  show(console, findings);
  if (findings.empty() && !diagnostics.has_errors())
    console.summary(fmt::format("{}: {} steps, no hazard found", program.source, program.path.size()));
}

Status run(Console& console, const Options& options) {
  Diagnostics usage, diagnostics;
  const JobSettings settings = read_job_options(options.job, usage, diagnostics);
  std::optional<Material> material;
  if (!options.material.empty()) material = material_named(options.material, usage);
  if (usage.has_errors()) return fail(console, usage, Status::wrong_usage);
  TerminalProgress progress(console);
  std::optional<LoadedProgram> program;
  if (!diagnostics.has_errors())
    program = load_program(options.job.file, diagnostics, &progress, settings.input);
  progress.clear();
  if (!program) {
    show_result(console, LoadedProgram{}, {}, diagnostics);
    return Status::input_errors;
  }
  const ProgramEnd end = program->end;
  const Job job = make_job(std::move(*program), settings, {}, UnknownTool::told_elsewhere, diagnostics);
  CheckOptions checks;
  checks.end = end;
  checks.machine = settings.input.machine ? &*settings.input.machine : nullptr;
  checks.material = material ? &*material : nullptr;
  checks.tools = &job.tools;
  if (job.stock) checks.stock = job.stock->block;
  const std::vector<Finding> findings = findings_in(job, checks, options, diagnostics, progress);
  progress.clear();
  if (interrupted()) return tell_stopped(console);
  show_result(console, job.program, findings, without_hazards(diagnostics));
  if (diagnostics.has_errors()) return Status::input_errors;
  return findings.empty() ? Status::done : Status::hazards;
}

const char* const kExamples =
    R"(  kerf check part.nc && echo "good to cut"
  kerf check part.nc --json --stock "100x60x12 at lower-left top"
  kerf check part.nc --machine data/machines/grbl_router.toml --material plywood

Looks for rapids through the stock, shank and holder contact, cuts deeper than the flute or below the floor,
cuts without feed, tool or turning spindle, arcs that controllers refuse, plunges with tools that cannot,
tool changes below the stock's top, G codes that nobody knows, a missing program end; with --machine also
moves out of its travel and speeds that its spindle has not; with --material feeds that the teeth cannot
take.
Exit status: 0 nothing found, 1 errors in the program, 2 wrong usage, 3 hazards.
)";

}  // namespace

Command add_check(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser =
      new_command(root, "check", "Look for hazards in a program, without writing files; status 3 if any",
                  kExamples + std::string(kToolHelp) + kStockHelp + kBodyHelp + kRotaryHelp, options->output);
  add_job_options(parser, options->job);
  add_body_options(parser, options->job.bodies);
  add_rotary_option(parser, options->job.bodies);
  add_machine_option(parser, options->job);
  parser
      .add_text("--material", options->material,
                "The stock's material, for the chip load: plywood, aluminium ...")
      .value_name("NAME");
  add_length(parser, "--resolution", options->resolution, kFinest, kCoarsest,
             "Distance of the material columns, mm or 0.01in (default: coarse, by the stock's size)");
  add_threads(parser, options->threads);
  return {parser, &options->output, [options](Console& console) { return run(console, *options); }};
}

}  // namespace kerf::app
