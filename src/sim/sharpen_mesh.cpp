// The mesh of the columns, moved to where the sweeps end: which vertices, which sweeps are near them, and all
// tiles on all threads.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "sim/edges.h"
#include "sim/mesh_build.h"
#include "sim/parallel.h"
#include "sim/relabel.h"
#include "sim/sharpen.h"

#include "kerf/exact_mesh.h"

namespace kerf {
namespace sim {
namespace {

/// Vertices that are nearer than this share of the tolerance to their surfaces are left alone.
constexpr double kGoodEnough = 0.5;
/// How far from a vertex surfaces are looked for, in pitches.
constexpr double kReach = 0.95;

/// Each round turns edges or halves them.
constexpr int kMostRounds = 13;

class Sharpener {
 public:
  Sharpener(Mesh& mesh, const Workpiece::Body& body, const Toolpath& path, Survey survey,
            const ToolTable& tools, const SharpenOptions& options, Progress* progress);
  bool run();

 private:
  bool is_wanted(const Fans& fans, std::uint32_t vertex) const;
  std::vector<Spot> find_spots(const Fans& fans) const;
  void place_vertices();
  void split_edges();
  bool is_folded(std::size_t triangle, const MeshState& before) const;
  void settle(MeshState& before);
  bool stopped() { return stopped_ = stopped_ || stop_requested(progress_); }

  Mesh& mesh_;
  const Workpiece::Body& body_;
  const Toolpath& path_;
  Survey survey_;
  double tolerance_;
  unsigned threads_;
  Progress* progress_;
  bool stopped_ = false;
  std::vector<ToolDistance> tools_;
  SweepsByTile sweeps_;
  std::vector<bool> bends_;  // vertices that were looked at
};

Sharpener::Sharpener(Mesh& mesh, const Workpiece::Body& body, const Toolpath& path, Survey survey,
                     const ToolTable& tools, const SharpenOptions& options, Progress* progress)
    : mesh_(mesh),
      body_(body),
      path_(path),
      survey_(std::move(survey)),
      tolerance_(options.tolerance.mm()),
      threads_(thread_count(options.threads)),
      progress_(progress),
      sweeps_(body, tools_, kReach * body.pitch) {
  std::vector<const Silhouette*> silhouettes(survey_.solids.size());
  for (const auto& [number, index] : survey_.index) silhouettes[index] = &tools.find(number)->silhouette;
  for (const Silhouette* silhouette : silhouettes) tools_.emplace_back(*silhouette);
}

/// Whether the triangles around a vertex bend. What is flat is right already.
bool Sharpener::is_wanted(const Fans& fans, std::uint32_t vertex) const {
  std::optional<Point3> first;
  double most = 0.0;
  fans.around(vertex, [&](std::uint32_t triangle) {
    const Point3 normal = fans.normal(triangle);
    if (dot(normal, normal) == 0.0) return;
    if (!first) first = normal;
    const Point3 turn = normal - *first;
    most = std::max(most, dot(turn, turn));
  });
  // A surface that turns by an angle over two pitches is an eighth of it times the pitch from its chord.
  const double least = 8.0 * kGoodEnough * tolerance_ / body_.pitch;
  return most > least * least;
}

std::vector<Spot> Sharpener::find_spots(const Fans& fans) const {
  constexpr std::size_t kAtATime = 1 << 14;
  const std::size_t count = fans.vertices(), pieces = (count + kAtATime - 1) / kAtATime;
  std::vector<std::vector<Spot>> found(pieces);
  const auto work = [&](std::size_t piece) {
    for (std::size_t v = piece * kAtATime; v < std::min(count, (piece + 1) * kAtATime); ++v) {
      const auto vertex = static_cast<std::uint32_t>(v);
      if (is_wanted(fans, vertex)) found[piece].push_back(sweeps_.spot_at(fans.point(vertex), vertex));
    }
  };
  parallel_for(threads_, pieces, work, [] { return false; });
  std::vector<Spot> spots;
  for (const std::vector<Spot>& some : found) spots.insert(spots.end(), some.begin(), some.end());
  std::sort(spots.begin(), spots.end());
  return spots;
}

void Sharpener::place_vertices() {
  const Fans fans(mesh_, body_.bounds.low, threads_);
  const std::vector<Spot> spots = find_spots(fans);
  bends_.assign(fans.vertices(), false);
  for (const Spot& spot : spots) bends_[spot.number] = true;
  sweeps_.gather(path_, survey_, spots, [&] { return stopped(); });
  std::vector<Point3> places(spots.size());
  std::atomic<std::size_t> done{0};
  const auto stop = [&] {
    report(progress_, 0.6 * static_cast<double>(done) / static_cast<double>(spots.size()));
    return stopped();
  };
  sweeps_.visit(
      spots, threads_,
      [&](std::size_t n, Around& around) {
        places[n] = Placer(fans, body_, tolerance_).place(spots[n].number, around);
        ++done;
      },
      stop);
  if (stopped()) return;
  MeshState before{mesh_.positions, fans.normals()};
  for (std::size_t n = 0; n < spots.size(); ++n) {
    const Point3 place = places[n] + body_.bounds.low;
    for (int axis = 0; axis < 3; ++axis)
      mesh_.positions[std::size_t{3} * spots[n].number + static_cast<std::size_t>(axis)] =
          static_cast<float>(place[axis]);
  }
  settle(before);
}

void Sharpener::split_edges() {
  EdgeSplitter splitter(mesh_, body_, sweeps_, std::move(bends_), tolerance_, threads_);
  for (int round = 0; round < kMostRounds; ++round) {
    MeshState straight;
    const EdgeRound done = splitter.split(straight, [&] { return stopped(); });
    if (done == EdgeRound::nothing) return;
    if (done == EdgeRound::parted) settle(straight);
    report(progress_, 0.6 + 0.3 * (round + 1) / kMostRounds);
  }
}

/// Whether a triangle faces the other way than it did.
bool Sharpener::is_folded(std::size_t triangle, const MeshState& before) const {
  const auto point = [&](std::size_t k) {
    const float* p = mesh_.positions.data() + std::size_t{3} * mesh_.triangles[3 * triangle + k];
    return Point3{p[0], p[1], p[2]};
  };
  const float* facing = before.outwards.data() + 3 * triangle;
  const Point3 a = point(0);
  return dot(cross(point(1) - a, point(2) - a), Point3{facing[0], facing[1], facing[2]}) < 0.0;
}

/// Where triangles face the other way than before, others get their sides, or their vertices go back.
void Sharpener::settle(MeshState& before) {
  constexpr int kMostReturns = 4;
  meshing::unfold_triangles(mesh_, before.outwards, threads_);
  for (int round = 0; round < kMostReturns; ++round) {
    std::vector<std::uint32_t> back;
    for (std::size_t t = 0; t < mesh_.step.size(); ++t)
      if (is_folded(t, before)) back.insert(back.end(), &mesh_.triangles[3 * t], &mesh_.triangles[3 * t] + 3);
    if (back.empty()) return;
    for (const std::uint32_t v : back) {
      const auto first = static_cast<std::ptrdiff_t>(std::size_t{3} * v);
      std::copy_n(before.positions.begin() + first, 3, mesh_.positions.begin() + first);
    }
  }
}

bool Sharpener::run() {
  if (progress_ != nullptr) progress_->phase("sharpening");
  Mesh rough = mesh_;
  place_vertices();
  if (!stopped() && !body_.start) relabel_triangles(mesh_, body_.bounds);
  if (!stopped()) split_edges();
  if (stopped()) {
    mesh_ = std::move(rough);
    return false;
  }
  meshing::mend_flat_triangles(mesh_, threads_);
  if (!body_.start) relabel_triangles(mesh_, body_.bounds);
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
  of_simulation.max_columns = SIZE_MAX;  // they are there already
  Diagnostics said_before;
  std::optional<sim::Setup> setup = sim::set_up(path, tools, stock, of_simulation, said_before);
  if (!setup || mesh.triangles.empty()) return true;  // nothing was cut
  return sim::Sharpener(mesh, workpiece.body(), path, std::move(setup->survey), tools, options, progress)
      .run();
}

}  // namespace kerf
