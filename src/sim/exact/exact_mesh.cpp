// Exact meshes: moves the vertices of a mesh of columns to the surfaces that the sweeps left and splits its
// edges.
//
//   1. Select the vertices around which the mesh is not flat, and gather the sweeps near them.
//   2. Move each to its surface, edge or corner (VertexFitter), one tile per thread, and repair folds.
//   3. In rounds, flip edges and then split those that are still off the surface (EdgeSplitter).
//   4. Remove degenerate triangles and assign triangles along edges to steps again.
#include "kerf/sim/exact_mesh.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "base/codes/sim.h"
#include "base/parallel.h"
#include "sim/exact/edge_splitter.h"
#include "sim/exact/relabel.h"
#include "sim/exact/vertex_fitter.h"
#include "sim/mesh/mesh_build.h"

namespace kerf {
namespace sim {
namespace {

/// Vertices are not moved if they are closer to their surface than this fraction of the tolerance, or of that
/// of an exact mesh: with a coarser one, triangles are larger than the columns, and so are their errors.
constexpr double kGoodEnough = 0.5;
/// Maximum distance of a sweep from a vertex, in pitches.
constexpr double kReach = 0.5 * kKeptMargin;

/// Rounds of flipping and splitting edges.
constexpr int kMaxRounds = 5;

class ExactMesher {
 public:
  ExactMesher(Mesh& mesh, const Simulation& simulation, const ExactMeshOptions& options, Progress* progress);
  bool run();

 private:
  bool is_curved_at(std::uint32_t vertex) const;
  std::vector<QueryPoint> find_queries() const;
  bool is_cut(std::uint32_t vertex) const;
  void raise_to_cuts(const std::vector<QueryPoint>& queries);
  void fit_vertices();
  void split_edges();
  void move(const std::vector<QueryPoint>& queries, const std::vector<Point3>& positions);
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
  std::vector<bool> is_curved_;  // vertices that were fitted
};

ExactMesher::ExactMesher(Mesh& mesh, const Simulation& simulation, const ExactMeshOptions& options,
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

/// Whether the normals of the triangles around a vertex differ. Flat surfaces are exact already.
bool ExactMesher::is_curved_at(std::uint32_t vertex) const {
  std::optional<Point3> first;
  double largest = 0.0;
  mesh_.around(vertex, [&](std::uint32_t triangle) {
    const Point3 normal = mesh_.normal(triangle);
    if (dot(normal, normal) == 0.0) return;
    if (!first) first = normal;
    const Point3 change = normal - *first;
    largest = std::max(largest, dot(change, change));
  });
  // If the normal changes by an angle within about a pitch, the sagitta is pitch * angle / 8.
  const double exact = std::min(tolerance_, default_tolerance::kExactMesh.mm());
  const double threshold = 8.0 * kGoodEnough * exact / body_.pitch;
  return largest > threshold * threshold;
}

std::vector<QueryPoint> ExactMesher::find_queries() const {
  constexpr std::size_t kAtATime = 1 << 14;
  const std::size_t count = mesh_.vertices(), pieces = (count + kAtATime - 1) / kAtATime;
  std::vector<std::vector<QueryPoint>> found(pieces);
  const auto work = [&](std::size_t piece) {
    for (std::size_t v = piece * kAtATime; v < std::min(count, (piece + 1) * kAtATime); ++v) {
      const auto vertex = static_cast<std::uint32_t>(v);
      if (is_curved_at(vertex)) found[piece].push_back(sweeps_.query_at(mesh_.point(vertex), vertex));
    }
  };
  parallel_for(threads_, pieces, work, [] { return false; });
  std::vector<QueryPoint> queries;
  for (const std::vector<QueryPoint>& some : found) queries.insert(queries.end(), some.begin(), some.end());
  std::sort(queries.begin(), queries.end());
  return queries;
}

/// Whether a vertex is on a surface that was cut. In a block the edge of that surface is included; other
/// stock may continue below it.
bool ExactMesher::is_cut(std::uint32_t vertex) const {
  bool all = true, any = false;
  mesh_.around(vertex, [&](std::uint32_t triangle) {
    const bool cut = mesh_.step(triangle) != kStockSurface;
    all &= cut;
    any |= cut;
  });
  return body_.start ? all && any : any;
}

/// In corners the mesh of the columns continues slopes to below all cuts, where no sweep is near.
void ExactMesher::raise_to_cuts(const std::vector<QueryPoint>& queries) {
  for (const QueryPoint& query : queries) {
    Point3 at = mesh_.point(query.number);
    if (at.z <= kOnBlock || at.z >= sweeps_.lowest() || !is_cut(query.number)) continue;
    at.z = sweeps_.lowest();
    mesh_.move(query.number, at);
  }
}

void ExactMesher::fit_vertices() {
  const std::vector<QueryPoint> queries = find_queries();
  is_curved_.assign(mesh_.vertices(), false);
  for (const QueryPoint& query : queries) is_curved_[query.number] = true;
  sweeps_.gather(simulation_, queries, [&] { return stopped(); });
  if (stopped()) return;
  raise_to_cuts(queries);
  std::vector<Point3> positions(queries.size());
  std::atomic<std::size_t> done{0};
  const auto stop = [&] {
    report(progress_, 0.6 * static_cast<double>(done) / static_cast<double>(queries.size()));
    return stopped();
  };
  sweeps_.visit(
      queries, threads_,
      [&](std::size_t n, SweepFinder& finder) {
        positions[n] =
            VertexFitter(mesh_, body_, sweeps_.lowest(), tolerance_).fit(queries[n].number, finder);
        ++done;
      },
      stop);
  if (!stopped()) move(queries, positions);
}

void ExactMesher::move(const std::vector<QueryPoint>& queries, const std::vector<Point3>& positions) {
  std::vector<Point3> before(mesh_.vertices());
  std::vector<std::uint32_t> changed;
  for (std::uint32_t v = 0; v < mesh_.vertices(); ++v) before[v] = mesh_.point(v);
  for (std::size_t n = 0; n < queries.size(); ++n) mesh_.move(queries[n].number, positions[n]);
  for (std::uint32_t t = 0; t < mesh_.triangles(); ++t)
    if (is_curved_[mesh_.vertex(3 * t)] || is_curved_[mesh_.vertex(3 * t + 1)] ||
        is_curved_[mesh_.vertex(3 * t + 2)])
      changed.push_back(t);
  mesh_.repair_folds(changed, [&](std::uint32_t v) { return before[v]; });
}

void ExactMesher::split_edges() {
  EdgeSplitter splitter(mesh_, body_, sweeps_, std::move(is_curved_), tolerance_, threads_);
  const auto stop = [&] { return stopped(); };
  for (int round = 0; round < kMaxRounds; ++round) {
    splitter.flip_edges(stop);
    if (stopped() || !splitter.split_edges(stop)) return;
    report(progress_, 0.6 + 0.3 * (round + 1) / kMaxRounds);
  }
  splitter.flip_edges(stop);
}

bool ExactMesher::run() {
  fit_vertices();
  if (!stopped() && !body_.start) relabel_triangles(mesh_.mesh(), body_.bounds);
  if (!stopped()) split_edges();
  return !stopped();
}

}  // namespace
}  // namespace sim

bool make_mesh_exact(Mesh& mesh, const Simulation& simulation, const ExactMeshOptions& options,
                     Progress* progress) {
  if (mesh.triangles.empty()) return true;
  if (progress != nullptr) progress->phase("exact mesh");
  Mesh original;
  if (progress != nullptr) original = mesh;
  if (!sim::ExactMesher(mesh, simulation, options, progress).run()) {
    mesh = std::move(original);
    return false;
  }
  meshing::remove_degenerate_triangles(mesh, thread_count(options.threads));
  relabel_mesh(mesh, simulation.workpiece);
  report(progress, 1.0);
  return true;
}

std::optional<CheckedMesh> extract_exact_mesh(const Simulation& simulation, const MeshOptions& options,
                                              Diagnostics& diagnostics, Progress* progress,
                                              const ExactMeshOptions& exact) {
  const MeshColumns columns(simulation.workpiece, options.threads);
  CheckedMesh result{extract_mesh(columns, options, progress), {}};
  if (stop_requested(progress) || !make_mesh_exact(result.mesh, simulation, exact, progress))
    return std::nullopt;
  Diagnostics fault;
  MeshOptions allowed = options;
  allowed.tolerance = options.tolerance + exact.tolerance;
  result.volume = mesh_volume(columns, allowed);
  result.is_verified = verify_mesh(result.mesh, result.volume, fault);
  if (result.is_verified) return result;
  diagnostics
      .warning(codes::mesh_unsound, {},
               "edges and walls are only as exact as the columns, since the exact mesh is not valid")
      .hint = "a finer --resolution may help";
  result.mesh = extract_mesh(columns, options, progress);
  relabel_mesh(result.mesh, simulation.workpiece);
  if (stop_requested(progress)) return std::nullopt;
  return result;
}

void relabel_mesh(Mesh& mesh, const Workpiece& workpiece) {
  const Workpiece::Body& body = workpiece.body();
  if (!body.start) sim::relabel_triangles(mesh, body.bounds);  // other stock may have its surface anywhere
}

}  // namespace kerf
