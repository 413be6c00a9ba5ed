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

#include "base/parallel.h"
#include "sim/exact/edge_splitter.h"
#include "sim/exact/relabel.h"
#include "sim/exact/sharpen.h"
#include "sim/mesh/mesh_build.h"

#include "kerf/exact_mesh.h"

namespace kerf {
namespace sim {
namespace {

/// Vertices that are nearer than this share of the tolerance to their surfaces are left alone.
constexpr double kGoodEnough = 0.5;
/// How far from a vertex surfaces are looked for, in pitches.
constexpr double kReach = 0.95;

/// Each round turns edges and then halves those that still stray.
constexpr int kMaxRounds = 5;

class Sharpener {
 public:
  Sharpener(Mesh& mesh, const Workpiece::Body& body, const Toolpath& path, Survey survey,
            const ToolTable& tools, const SharpenOptions& options, Progress* progress);
  bool run();

 private:
  bool is_wanted(std::uint32_t vertex) const;
  std::vector<Spot> find_spots() const;
  void place_vertices();
  void split_edges();
  void move(const std::vector<Spot>& spots, const std::vector<Point3>& places);
  bool stopped() { return stopped_ = stopped_ || stop_requested(progress_); }

  LinkedMesh mesh_;
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
    : mesh_(mesh, body.bounds.low, thread_count(options.threads)),
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
bool Sharpener::is_wanted(std::uint32_t vertex) const {
  std::optional<Point3> first;
  double most = 0.0;
  mesh_.around(vertex, [&](std::uint32_t triangle) {
    const Point3 normal = mesh_.normal(triangle);
    if (dot(normal, normal) == 0.0) return;
    if (!first) first = normal;
    const Point3 turn = normal - *first;
    most = std::max(most, dot(turn, turn));
  });
  // A surface that turns by an angle over two pitches is an eighth of it times the pitch from its chord.
  const double least = 8.0 * kGoodEnough * tolerance_ / body_.pitch;
  return most > least * least;
}

std::vector<Spot> Sharpener::find_spots() const {
  constexpr std::size_t kAtATime = 1 << 14;
  const std::size_t count = mesh_.vertices(), pieces = (count + kAtATime - 1) / kAtATime;
  std::vector<std::vector<Spot>> found(pieces);
  const auto work = [&](std::size_t piece) {
    for (std::size_t v = piece * kAtATime; v < std::min(count, (piece + 1) * kAtATime); ++v) {
      const auto vertex = static_cast<std::uint32_t>(v);
      if (is_wanted(vertex)) found[piece].push_back(sweeps_.spot_at(mesh_.point(vertex), vertex));
    }
  };
  parallel_for(threads_, pieces, work, [] { return false; });
  std::vector<Spot> spots;
  for (const std::vector<Spot>& some : found) spots.insert(spots.end(), some.begin(), some.end());
  std::sort(spots.begin(), spots.end());
  return spots;
}

void Sharpener::place_vertices() {
  const std::vector<Spot> spots = find_spots();
  bends_.assign(mesh_.vertices(), false);
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
        places[n] = Placer(mesh_, body_, tolerance_).place(spots[n].number, around);
        ++done;
      },
      stop);
  if (!stopped()) move(spots, places);
}

void Sharpener::move(const std::vector<Spot>& spots, const std::vector<Point3>& places) {
  std::vector<Point3> before(mesh_.vertices());
  std::vector<std::uint32_t> changed;
  for (std::uint32_t v = 0; v < mesh_.vertices(); ++v) before[v] = mesh_.point(v);
  for (std::size_t n = 0; n < spots.size(); ++n) mesh_.move(spots[n].number, places[n]);
  for (std::uint32_t t = 0; t < mesh_.triangles(); ++t)
    if (bends_[mesh_.vertex(3 * t)] || bends_[mesh_.vertex(3 * t + 1)] || bends_[mesh_.vertex(3 * t + 2)])
      changed.push_back(t);
  mesh_.settle(changed, [&](std::uint32_t v) { return before[v]; });
}

void Sharpener::split_edges() {
  EdgeSplitter splitter(mesh_, body_, sweeps_, std::move(bends_), tolerance_, threads_);
  const auto stop = [&] { return stopped(); };
  for (int round = 0; round < kMaxRounds; ++round) {
    splitter.turn(stop);
    if (stopped() || !splitter.part(stop)) return;
    report(progress_, 0.6 + 0.3 * (round + 1) / kMaxRounds);
  }
  splitter.turn(stop);
}

bool Sharpener::run() {
  place_vertices();
  if (!stopped() && !body_.start) relabel_triangles(mesh_.mesh(), body_.bounds);
  if (!stopped()) split_edges();
  return !stopped();
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
  if (progress != nullptr) progress->phase("sharpening");
  Mesh rough;
  if (progress != nullptr) rough = mesh;
  const Workpiece::Body& body = workpiece.body();
  if (!sim::Sharpener(mesh, body, path, std::move(setup->survey), tools, options, progress).run()) {
    mesh = std::move(rough);
    return false;
  }
  meshing::mend_flat_triangles(mesh, thread_count(options.threads));
  relabel_mesh(mesh, workpiece);
  report(progress, 1.0);
  return true;
}

std::optional<Mesh> extract_exact_mesh(const MeshColumns& columns, const MeshOptions& options,
                                       const Workpiece& workpiece, const Toolpath& path,
                                       const ToolTable& tools, const Stock& stock, Diagnostics& diagnostics,
                                       Progress* progress) {
  const SharpenOptions sharp;
  Mesh mesh = extract_mesh(columns, options, progress);
  if (stop_requested(progress) || !sharpen_mesh(mesh, workpiece, path, tools, stock, sharp, progress))
    return std::nullopt;
  Diagnostics fault;
  MeshOptions allowed = options;
  allowed.tolerance = options.tolerance + sharp.tolerance;
  if (verify_mesh(mesh, mesh_volume(columns, allowed), fault)) return mesh;
  diagnostics
      .warning(Code::mesh_unsound, {},
               "edges and walls are only as exact as the columns: with exact ones the mesh is not sound")
      .hint = "a finer --resolution may help";
  mesh = extract_mesh(columns, options, progress);
  relabel_mesh(mesh, workpiece);
  if (stop_requested(progress)) return std::nullopt;
  return mesh;
}

void relabel_mesh(Mesh& mesh, const Workpiece& workpiece) {
  const Workpiece::Body& body = workpiece.body();
  if (!body.start) sim::relabel_triangles(mesh, body.bounds);  // else its surface may lie anywhere
}

}  // namespace kerf
