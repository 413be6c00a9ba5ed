// The mesh of the columns, moved to where the sweeps end: which vertices, which sweeps are near them, and all
// tiles on all threads.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "sim/feed.h"
#include "sim/mesh_build.h"
#include "sim/parallel.h"
#include "sim/sharpen.h"
#include "sim/tile.h"

#include "kerf/exact_mesh.h"

namespace kerf {
namespace sim {
namespace {

/// Vertices that are nearer than this to their surfaces are left alone, mm.
constexpr double kGoodEnough = 0.0005;
/// Columns along the side of a block of columns that share a list of sweeps.
constexpr int kBlock = 8;
constexpr int kBlocksAcross = kTileColumns / kBlock;
/// How far from a vertex surfaces are looked for, in pitches.
constexpr double kReach = 1.3;

class Sharpener {
 public:
  Sharpener(Mesh& mesh, const Workpiece::Body& body, const Toolpath& path, Survey survey,
            const ToolTable& tools, unsigned threads, Progress* progress);
  bool run();

 private:
  struct Place {
    std::uint32_t tile, block, vertex;
    bool operator<(const Place& other) const {
      return std::tie(tile, block, vertex) < std::tie(other.tile, other.block, other.vertex);
    }
  };
  bool is_wanted(std::uint32_t vertex) const;
  void find_places();
  void gather_sweeps();
  void do_tile(std::size_t first, std::size_t end);
  void near_block(const Place& place, std::vector<const Sweep*>& near) const;
  bool turns_over(std::size_t triangle) const;
  void take_back_folds();
  bool stopped() { return stopped_ = stopped_ || stop_requested(progress_); }

  Mesh& mesh_;
  const Workpiece::Body& body_;
  const Toolpath& path_;
  Survey survey_;
  unsigned threads_;
  Progress* progress_;
  bool stopped_ = false;
  Fans fans_;
  std::vector<ToolDistance> tools_;
  std::vector<Place> places_;  // vertices that are looked at, by tile and block
  std::vector<float> moved_;   // positions
  std::vector<Sweep> sweeps_;
  std::vector<std::vector<std::uint32_t>> of_tile_;
};

Sharpener::Sharpener(Mesh& mesh, const Workpiece::Body& body, const Toolpath& path, Survey survey,
                     const ToolTable& tools, unsigned threads, Progress* progress)
    : mesh_(mesh),
      body_(body),
      path_(path),
      survey_(std::move(survey)),
      threads_(threads),
      progress_(progress),
      fans_(mesh, body.bounds.low, threads) {
  std::vector<const Silhouette*> silhouettes(survey_.solids.size());
  for (const auto& [number, index] : survey_.index) silhouettes[index] = &tools.find(number)->silhouette;
  for (const Silhouette* silhouette : silhouettes) tools_.emplace_back(*silhouette);
}

/// Whether the triangles around a vertex bend, and something was cut there. What is flat is right already.
bool Sharpener::is_wanted(std::uint32_t vertex) const {
  std::optional<Point3> first;
  double most = 0.0;
  bool was_cut = false;
  fans_.around(vertex, [&](std::uint32_t triangle) {
    const Point3 normal = fans_.normal(triangle);
    if (dot(normal, normal) == 0.0) return;
    was_cut = was_cut || fans_.step(triangle) != kStockSurface;
    if (!first) first = normal;
    const Point3 turn = normal - *first;
    most = std::max(most, dot(turn, turn));
  });
  // A surface that turns by an angle over two pitches is an eighth of it times the pitch from its chord.
  const double least = 8.0 * kGoodEnough / body_.pitch;
  return was_cut && most > least * least;
}

void Sharpener::find_places() {
  constexpr std::size_t kAtATime = 1 << 14;
  const std::size_t count = fans_.vertices(), pieces = (count + kAtATime - 1) / kAtATime;
  std::vector<std::vector<Place>> found(pieces);
  const double per_pitch = 1.0 / body_.pitch;
  const auto column = [&](double v, int columns) {
    return std::clamp(static_cast<int>(std::floor(v * per_pitch)), 0, columns - 1);
  };
  const auto work = [&](std::size_t piece) {
    for (std::size_t v = piece * kAtATime; v < std::min(count, (piece + 1) * kAtATime); ++v) {
      const auto vertex = static_cast<std::uint32_t>(v);
      if (!is_wanted(vertex)) continue;
      const Point3 at = fans_.point(vertex);
      const int i = column(at.x, body_.nx), j = column(at.y, body_.ny);
      const int tile = j / kTileColumns * body_.tiles_x + i / kTileColumns;
      const int block = j % kTileColumns / kBlock * kBlocksAcross + i % kTileColumns / kBlock;
      found[piece].push_back({static_cast<std::uint32_t>(tile), static_cast<std::uint32_t>(block), vertex});
    }
  };
  parallel_for(threads_, pieces, work, [&] { return stopped(); });
  for (const std::vector<Place>& some : found) places_.insert(places_.end(), some.begin(), some.end());
  std::sort(places_.begin(), places_.end());
}

/// All sweeps that can have cut near the vertices that are looked at.
void Sharpener::gather_sweeps() {
  std::vector<bool> wanted(body_.tiles.size(), false);
  for (const Place& place : places_) wanted[place.tile] = true;
  of_tile_.resize(body_.tiles.size());
  const PlanScope scope{.margin = 2.0 * kReach * body_.pitch, .tiles = &wanted};
  Feeder feeder(body_, path_, survey_,
                {.plan = scope, .steps = {StepRange{0, path_.size()}}, .hazard_depth = Length()});
  Batch batch;
  do {
    feeder.fill(batch);
    std::vector<std::uint32_t> number(batch.sweeps.size(), meshing::kNone);
    for (const Batch::Pair& pair : batch.pairs) {
      std::uint32_t& mine = number[pair.sweep];
      if (mine == meshing::kNone) {
        mine = static_cast<std::uint32_t>(sweeps_.size());
        sweeps_.push_back(batch.sweeps[pair.sweep]);
      }
      of_tile_[pair.tile].push_back(mine);
    }
  } while (!batch.is_last && !stopped());
}

void Sharpener::near_block(const Place& place, std::vector<const Sweep*>& near) const {
  const auto tiles_x = static_cast<std::uint32_t>(body_.tiles_x);
  const double i = place.tile % tiles_x * kTileColumns + (place.block % kBlocksAcross + 0.5) * kBlock;
  const double j = place.tile / tiles_x * kTileColumns + (place.block / kBlocksAcross + 0.5) * kBlock;
  const double x = i * body_.pitch, y = j * body_.pitch;
  const double half = (std::numbers::sqrt2 * 0.5 * kBlock + kReach) * body_.pitch;
  near.clear();
  for (const std::uint32_t n : of_tile_[place.tile]) {
    const Sweep& sweep = sweeps_[n];
    if (distance_in_plan(sweep, {x, y}) <= tools_[sweep.tool].rim() + half) near.push_back(&sweep);
  }
}

/// The vertices of one tile, which are places_[first] to places_[end - 1].
void Sharpener::do_tile(std::size_t first, std::size_t end) {
  const double reach = kReach * body_.pitch;
  Nearby nearby(tools_, reach);
  Placer placer(fans_, body_, nearby);
  std::vector<const Sweep*> near;
  for (std::size_t n = first; n < end; ++n) {
    const Place& place = places_[n];
    if (n == first || place.block != places_[n - 1].block) near_block(place, near);
    nearby.gather(near, fans_.point(place.vertex));
    if (nearby.empty()) continue;
    const Point3 to = placer.place(place.vertex) + body_.bounds.low;
    for (int axis = 0; axis < 3; ++axis)
      moved_[std::size_t{3} * place.vertex + static_cast<std::size_t>(axis)] = static_cast<float>(to[axis]);
  }
}

/// Whether a triangle faces the other way than before.
bool Sharpener::turns_over(std::size_t triangle) const {
  const std::uint32_t* c = mesh_.triangles.data() + 3 * triangle;
  const Point3 a = fans_.point(c[0]), b = fans_.point(c[1]), d = fans_.point(c[2]);
  return dot(cross(b - a, d - a), fans_.normal(static_cast<std::uint32_t>(triangle))) < 0.0;
}

/// Where triangles would face the other way their vertices stay where they were.
void Sharpener::take_back_folds() {
  constexpr int kMostRounds = 4;
  for (int round = 0; round < kMostRounds; ++round) {
    std::vector<std::uint32_t> back;
    for (std::size_t t = 0; t < mesh_.triangles.size() / 3; ++t) {
      if (!turns_over(t)) continue;
      back.insert(back.end(), &mesh_.triangles[3 * t], &mesh_.triangles[3 * t] + 3);
    }
    if (back.empty()) return;
    for (const std::uint32_t v : back)
      std::copy_n(moved_.begin() + 3 * std::ptrdiff_t{v}, 3, mesh_.positions.begin() + 3 * std::ptrdiff_t{v});
  }
}

bool Sharpener::run() {
  if (progress_ != nullptr) progress_->phase("sharpening");
  find_places();
  if (!stopped()) gather_sweeps();
  moved_ = mesh_.positions;
  std::vector<std::size_t> begins;
  for (std::size_t n = 0; n < places_.size(); ++n)
    if (n == 0 || places_[n].tile != places_[n - 1].tile) begins.push_back(n);
  begins.push_back(places_.size());
  std::atomic<std::size_t> done{0};
  const auto work = [&](std::size_t k) {
    do_tile(begins[k], begins[k + 1]);
    ++done;
  };
  const auto stop = [&] {
    report(progress_, static_cast<double>(done) / static_cast<double>(begins.size()));
    return stopped();
  };
  if (!stopped()) parallel_for(threads_, begins.size() - 1, work, stop);
  if (stopped()) return false;
  mesh_.positions.swap(moved_);
  meshing::unfold_triangles(mesh_, fans_.normals(), threads_);
  take_back_folds();
  meshing::mend_flat_triangles(mesh_, threads_);
  report(progress_, 1.0);
  return true;
}

}  // namespace
}  // namespace sim

bool sharpen_mesh(Mesh& mesh, const Workpiece& workpiece, const Toolpath& path, const ToolTable& tools,
                  const Stock& stock, const SharpenOptions& options, Progress* progress) {
  SimulationOptions of_simulation;
  of_simulation.resolution = workpiece.pitch();
  of_simulation.threads = options.threads;
  Diagnostics said_before;
  std::optional<sim::Setup> setup = sim::set_up(path, tools, stock, of_simulation, said_before);
  if (!setup || mesh.triangles.empty()) return true;  // nothing was cut
  return sim::Sharpener(mesh, workpiece.body(), path, std::move(setup->survey), tools,
                        sim::thread_count(options.threads), progress)
      .run();
}

}  // namespace kerf
