// Cutting and meshing after each change; the bodies of the protocol's answers.
#include "app/shown/shown.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "app/shown/changed_tiles.h"
#include "app/shown/model.h"
#include "app/shown/motions.h"
#include "app/shown/stage_times.h"
#include "app/shown/viewable.h"
#include "base/file_names.h"
#include "job/record/record.h"

#include "kerf/job/outputs.h"

namespace kerf::app::view {
namespace {

constexpr std::size_t kMaxExactSteps = 200'000;        // of longer programs it would take minutes
constexpr std::size_t kMaxExactTriangles = 3'000'000;  // that pages can draw
constexpr double kColumns = 600'000;                   // by default, of a milled part
constexpr double kFinestDefault = 0.02;                // mm
constexpr double kCoarsestDefault = 1.0;               // mm

/// The stock's pitch if none is given: coarser than for files, for speed.
Length resolution_for(const Job& job, Length given) {
  if (given > Length() || !job.stock || (job.stock->body && job.stock->body->pitch())) return given;
  const Point3 size = job.stock->block.size();
  return mm(std::clamp(std::sqrt(size.x * size.y / kColumns), kFinestDefault, kCoarsestDefault));
}

std::string_view name_of(State state) {
  switch (state) {
    case State::ready: return "ready";
    case State::failed: return "failed";
    case State::loading: break;
  }
  return "loading";
}

}  // namespace

namespace {

std::string model_body_with(const Shown& shown, const std::string& files) {
  std::string out = fmt::format(R"({{"protocol":1,"revision":{},"input":{},"state":"{}","errors":{})",
                                shown.revision, shown.input, name_of(shown.state), shown.errors);
  if (!shown.console.empty()) out += ",\"console\":" + Record(shown.console).text(Layout::line);
  if (!shown.failed.empty()) out += ",\"failed\":" + shown.failed;
  if (!shown.model.empty()) out += "," + shown.model + ",\"files\":" + files;
  return out + "}";
}

}  // namespace

std::string model_body(const Shown& shown) { return model_body_with(shown, shown.files); }

std::string exported_model_body(const Shown& shown) {
  return model_body_with(shown, shown.sources->record_with_texts().text(Layout::line));
}

std::shared_ptr<const std::string> Shown::source_block(std::uint32_t id) const {
  auto found = sources->find(id);
  return found ? found : failed_sources->find(id);
}

std::string model_event(const Shown& shown, std::size_t tiles) {
  return fmt::format(R"({{"revision":{},"input":{},"tiles":{},"path":true}})", shown.revision, shown.input,
                     tiles);
}

std::string exact_event(const Shown& shown) { return fmt::format(R"({{"revision":{}}})", shown.revision); }

std::string errors_event(const Shown& shown) {
  return fmt::format(R"({{"revision":{},"input":{},"diagnostics":{}}})", shown.revision, shown.input,
                     shown.errors);
}

Shown with_errors(const Shown& before, const std::string& file, const Diagnostics& diagnostics,
                  std::size_t whole) {
  Shown next = before;
  next.state = State::failed;
  std::vector<std::string> files{file};
  for (const Diagnostic& d : diagnostics.list()) {
    const auto* where = std::get_if<TextLocation>(&d.where);
    if (where == nullptr || where->file.empty() || !exists(where->file)) continue;
    if (std::find(files.begin(), files.end(), where->file) == files.end()) files.push_back(where->file);
  }
  Sources sources;
  sources.read(files, whole);
  sources.take_ids({before.sources.get(), before.failed_sources.get()});
  const Record failed{{"name", file_name_of(file)}, {"files", sources.record()}};
  next.failed_sources = std::make_shared<const Sources>(std::move(sources));
  next.failed = failed.text(Layout::line);
  next.errors = record_of(diagnostics).text(Layout::line);
  return next;
}

LivePart::Apart LivePart::make_apart(const Job& job, const Inputs& inputs, const Shown& before) const {
  Apart out;
  StageTimes times;
  out.path = path_blocks(job.program.path, {.files = job.program.files,
                                            .machine = inputs.program.machine,
                                            .before = *before.path,
                                            .revision = before.revision + 1});
  out.path_ms = times.ms();
  out.sources.read(job.program.files, options_.whole_text);
  out.sources.take_ids({before.sources.get(), before.failed_sources.get()});
  out.sources_ms = times.ms() - out.path_ms;
  return out;
}

std::optional<LivePart::Update> LivePart::update(Job job, const Inputs& inputs, const Shown& before,
                                                 Diagnostics& diagnostics, Progress* progress) {
  const auto kept = std::make_shared<const Job>(std::move(job));
  JobCheckOptions check;
  check.machine = inputs.program.machine ? &*inputs.program.machine : nullptr;
  const RunOptions how{.resolution = resolution_for(*kept, options_.resolution), .threads = options_.threads};
  std::future<Apart> apart = std::async(options_.threads == 1 ? std::launch::deferred : std::launch::async,
                                        [&, kept] { return make_apart(*kept, inputs, before); });
  StageTimes times;
  const auto change = live_.update(kept, how, check, diagnostics, progress);
  if (!change) return std::nullopt;
  times.note("cut");
  std::optional<Update> made;
  if (!diagnostics.has_errors() && !stop_requested(progress))
    made = publish(*change, inputs, before, std::move(apart), diagnostics, progress);
  if (made) made->shown.timing = times.text() + ", " + made->shown.timing;
  if (!made) tiling_ = {};  // the tiles do not have this change: the next update makes all of them
  return made;
}

std::optional<LivePart::Update> LivePart::publish(const LiveJobChange& change, const Inputs& inputs,
                                                  const Shown& before, std::future<Apart> apart,
                                                  Diagnostics& diagnostics, Progress* progress) {
  Update made;
  StageTimes times;
  Shown& next = made.shown;
  next.state = State::ready;
  next.revision = before.revision + 1;
  next.tiles = before.tiles;
  next.job = live_.job();
  next.inputs = inputs;
  made.changed_tiles =
      update_tiles(live_, change, {next.revision, options_.threads}, tiling_, next.tiles, progress);
  times.note("tiles");
  std::optional<TargetResult> compared;
  if (inputs.target)
    compared = compare_with_target(live_, *inputs.target, next.revision, diagnostics, progress);
  if (diagnostics.has_errors() || stop_requested(progress)) return std::nullopt;
  if (compared) next.target = std::make_shared<const std::string>(std::move(compared->body));
  times.note("target");
  Apart done = apart.get();
  times.note("waiting");
  next.path = std::make_shared<const PathBlocks>(std::move(done.path));
  next.files = done.sources.record().text(Layout::line);
  next.sources = std::make_shared<const Sources>(std::move(done.sources));
  const Record model = model_record({.live = live_,
                                     .diagnostics = diagnostics,
                                     .machine = inputs.program.machine,
                                     .motions = next.path->motions(),
                                     .tiles = next.tiles.tiles().size(),
                                     .target = compared ? &compared->figures : nullptr});
  const std::string text = model.text(Layout::line);
  next.model = text.substr(1, text.size() - 2);
  times.note("model");
  times.add("path", done.path_ms);
  times.add("sources", done.sources_ms);
  next.timing = times.text();
  return made;
}

std::optional<Shown> LivePart::exact(const Shown& before, Progress* progress) const {
  if (before.state != State::ready || live_.cut() == nullptr ||
      before.job->program.path.size() > kMaxExactSteps || !is_program(*before.job))
    return std::nullopt;
  Diagnostics ignored;
  const RunOptions how{.resolution = live_.cut()->workpiece()->pitch(), .threads = options_.threads};
  const auto run = run_job(*before.job, how, ignored, progress);
  if (!run || stop_requested(progress)) return std::nullopt;
  const auto surface = make_surface(*before.job, *run, {.cut_finer = false}, ignored, progress);
  if (!surface || surface->mesh.step.size() > kMaxExactTriangles || stop_requested(progress))
    return std::nullopt;
  const std::string tile = tile_bytes(0, 0, surface->mesh);
  Shown next = before;
  MeshBody body{.revision = next.revision, .forget_others = true};
  body.tiles.push_back(&tile);
  next.exact = std::make_shared<const std::string>(bytes_of(body));
  return next;
}

std::optional<std::string> LivePart::at(std::uint32_t step, std::uint32_t from,
                                        std::uint32_t revision) const {
  const LiveSimulation* cut = live_.cut();
  if (cut == nullptr || cut->workpiece() == nullptr || tiling_.size() == 0) return std::nullopt;
  const auto steps = static_cast<std::uint32_t>(cut->path().size());
  const std::uint32_t now = std::min(step, steps), then = std::min(from, steps);
  const std::optional<Workpiece> part = cut->at(now);
  if (!part) return std::nullopt;
  const std::vector<std::uint32_t> numbers =
      tiles_between(*cut, live_.job()->tools, tiling_, std::min(now, then), std::max(now, then));
  std::vector<std::string> made;
  for (const MeshTile& tile : extract_mesh_tiles(*part, tiling_, numbers, mesh_options(options_.threads)))
    made.push_back(tile_bytes(tile.number, 0, tile.mesh));
  MeshBody body{.revision = revision, .at_step = now == steps ? kWholeJob : now};
  for (const std::string& tile : made) body.tiles.push_back(&tile);
  return bytes_of(body);
}

}  // namespace kerf::app::view
