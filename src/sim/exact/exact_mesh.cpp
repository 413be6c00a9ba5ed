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
#include "sim/exact/vertex_fitter.h"
#include "sim/mesh/mesh_build.h"

#include "kerf/exact_mesh.h"

namespace kerf {
namespace sim {
namespace {

/// Vertices that are nearer than this share of the tolerance to their surfaces are left alone.
constexpr double kGoodEnough = 0.5;
/// How far from a vertex surfaces are looked for, in pitches.
constexpr double kReach = 0.5 * kKeptMargin;

/// Each round turns edges and then halves those that still stray.
constexpr int kMaxRounds = 5;

class Sharpener {
 public:
  Sharpener(Mesh& mesh, const Simulation& simulation, const SharpenOptions& options, Progress* progress);
  bool run();

 private:
  bool is_wanted(std::uint32_t vertex) const;
  std::vector<QueryPoint> find_queries() const;
  void place_vertices();
  void split_edges();
  void move(const std::vector<QueryPoint>& queries, const std::vector<Point3>& places);
  bool stopped() { return stopped_ = stopped_ || stop_requested(progress_); }

  LinkedMesh mesh_;
  const Simulation& simulation_;
  const Workpiece::Body& body_;
  double tolerance_;
  unsigned threads_;
  Progress* progress_;
  bool stopped_ = false;
  std::vector<ToolDistance> tools_;
  SweepsByTile sweeps_;
  std::vector<bool> bends_;  // vertices that were looked at
};

Sharpener::Sharpener(Mesh& mesh, const Simulation& simulation, const SharpenOptions& options,
                     Progress* progress)
    : mesh_(mesh, simulation.workpiece.bounds().low, thread_count(options.threads)),
      simulation_(simulation),
      body_(simulation.workpiece.body()),
      tolerance_(options.tolerance.mm()),
      threads_(thread_count(options.threads)),
      progress_(progress),
      sweeps_(body_, tools_, kReach * body_.pitch) {
  const Survey& survey = simulation.plan->survey;
  std::vector<const Silhouette*> silhouettes(survey.solids.size());
  for (const auto& [number, index] : survey.index)
    silhouettes[index] = &simulation.job.tools.find(number)->silhouette;
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

std::vector<QueryPoint> Sharpener::find_queries() const {
  constexpr std::size_t kAtATime = 1 << 14;
  const std::size_t count = mesh_.vertices(), pieces = (count + kAtATime - 1) / kAtATime;
  std::vector<std::vector<QueryPoint>> found(pieces);
  const auto work = [&](std::size_t piece) {
    for (std::size_t v = piece * kAtATime; v < std::min(count, (piece + 1) * kAtATime); ++v) {
      const auto vertex = static_cast<std::uint32_t>(v);
      if (is_wanted(vertex)) found[piece].push_back(sweeps_.query_at(mesh_.point(vertex), vertex));
    }
  };
  parallel_for(threads_, pieces, work, [] { return false; });
  std::vector<QueryPoint> queries;
  for (const std::vector<QueryPoint>& some : found) queries.insert(queries.end(), some.begin(), some.end());
  std::sort(queries.begin(), queries.end());
  return queries;
}

void Sharpener::place_vertices() {
  const std::vector<QueryPoint> queries = find_queries();
  bends_.assign(mesh_.vertices(), false);
  for (const QueryPoint& query : queries) bends_[query.number] = true;
  sweeps_.gather(simulation_, queries, [&] { return stopped(); });
  std::vector<Point3> places(queries.size());
  std::atomic<std::size_t> done{0};
  const auto stop = [&] {
    report(progress_, 0.6 * static_cast<double>(done) / static_cast<double>(queries.size()));
    return stopped();
  };
  sweeps_.visit(
      queries, threads_,
      [&](std::size_t n, Around& around) {
        places[n] = Placer(mesh_, body_, tolerance_).place(queries[n].number, around);
        ++done;
      },
      stop);
  if (!stopped()) move(queries, places);
}

void Sharpener::move(const std::vector<QueryPoint>& queries, const std::vector<Point3>& places) {
  std::vector<Point3> before(mesh_.vertices());
  std::vector<std::uint32_t> changed;
  for (std::uint32_t v = 0; v < mesh_.vertices(); ++v) before[v] = mesh_.point(v);
  for (std::size_t n = 0; n < queries.size(); ++n) mesh_.move(queries[n].number, places[n]);
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

bool sharpen_mesh(Mesh& mesh, const Simulation& simulation, const SharpenOptions& options,
                  Progress* progress) {
  if (mesh.triangles.empty()) return true;
  if (progress != nullptr) progress->phase("sharpening");
  Mesh rough;
  if (progress != nullptr) rough = mesh;
  if (!sim::Sharpener(mesh, simulation, options, progress).run()) {
    mesh = std::move(rough);
    return false;
  }
  meshing::mend_flat_triangles(mesh, thread_count(options.threads));
  relabel_mesh(mesh, simulation.workpiece);
  report(progress, 1.0);
  return true;
}

std::optional<CheckedMesh> extract_exact_mesh(const Simulation& simulation, const MeshOptions& options,
                                              Diagnostics& diagnostics, Progress* progress) {
  const SharpenOptions sharp;
  const MeshColumns columns(simulation.workpiece, options.threads);
  CheckedMesh result{extract_mesh(columns, options, progress), {}};
  if (stop_requested(progress) || !sharpen_mesh(result.mesh, simulation, sharp, progress))
    return std::nullopt;
  Diagnostics fault;
  MeshOptions allowed = options;
  allowed.tolerance = options.tolerance + sharp.tolerance;
  result.volume = mesh_volume(columns, allowed);
  result.is_verified = verify_mesh(result.mesh, result.volume, fault);
  if (result.is_verified) return result;
  diagnostics
      .warning(Code::mesh_unsound, {},
               "edges and walls are only as exact as the columns: with exact ones the mesh is not sound")
      .hint = "a finer --resolution may help";
  result.mesh = extract_mesh(columns, options, progress);
  relabel_mesh(result.mesh, simulation.workpiece);
  if (stop_requested(progress)) return std::nullopt;
  return result;
}

void relabel_mesh(Mesh& mesh, const Workpiece& workpiece) {
  const Workpiece::Body& body = workpiece.body();
  if (!body.start) sim::relabel_triangles(mesh, body.bounds);  // else its surface may lie anywhere
}

}  // namespace kerf
