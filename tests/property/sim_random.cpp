// Random jobs through the simulator: tools, blocks and motions are drawn at random.
//   property_sim [COUNT] [SEED]
// Every job has to give the same bits on 1, 2, 3 and 7 threads and on every vector instruction set of this
// processor, lose no volume, and leave a closed mesh. Prints the seed of each job that fails. Exit status 1
// if any does.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <hwy/highway.h>
#include <numbers>
#include <random>

#include "../unit/sim_cut/cut_jobs.h"
#include "mesh_crossings.h"

#include "kerf/sim/exact_mesh.h"

namespace {

using namespace kerf;

struct Job {
  Toolpath path;
  ToolTable tools;
  Stock stock;
  double pitch = 0.0;
};

class Drawer {
 public:
  explicit Drawer(std::uint64_t seed) : random_(seed) {}
  Job job();

 private:
  double in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  bool chance(double probability) { return in(0.0, 1.0) < probability; }
  int below(int count) { return static_cast<int>(in(0.0, count)); }
  Tool tool(int number);
  Point3 point() { return {in(-4, size_.x + 4), in(-4, size_.y + 4), in(-1.1, 0.2) * size_.z}; }
  void move(test::Path& path);
  void arc(test::Path& path);

  std::mt19937_64 random_;
  Point3 size_, at_;
};

Tool Drawer::tool(int number) {
  const auto profiles = test::all_profiles();
  Tool made = test::make_drawn(
      number, profiles[static_cast<std::size_t>(below(static_cast<int>(profiles.size())))].profile);
  const double top = made.silhouette.cutting.top();
  if (chance(0.5)) made.silhouette.shank = test::profile({{in(1, 5), top, 0}, {in(5, 6), top + 20, 0}});
  return made;
}

void Drawer::arc(test::Path& path) {
  step::Arc arc;
  arc.turn = chance(0.5) ? Turn::cw : Turn::ccw;
  arc.feed = mm_per_min(100);
  arc.plane = chance(0.6) ? Plane::xy : chance(0.5) ? Plane::xz : Plane::yz;
  const PlaneAxes axes = axes_of(arc.plane);
  const double radius = in(0.2, 6), angle = in(0, 2 * std::numbers::pi), turned = angle + in(0, 6);
  arc.centre = {at_[axes.u] + radius * std::cos(angle), at_[axes.v] + radius * std::sin(angle)};
  arc.to = at_;
  arc.to[axes.u] = arc.centre.x + radius * std::cos(turned);
  arc.to[axes.v] = arc.centre.y + radius * std::sin(turned);
  if (chance(0.4)) arc.to[axes.w] += in(-2, 2);
  path.arc(arc);
  at_ = arc.to;
}

void Drawer::move(test::Path& path) {
  if (chance(0.2)) return arc(path);
  Point3 to = point();
  if (chance(0.3)) to.z = at_.z;                  // level
  if (chance(0.15)) to = {at_.x, at_.y, to.z};    // straight up or down
  if (chance(0.3)) to = at_ + 0.02 * (to - at_);  // a small step
  chance(0.1) ? path.rapid(to) : path.cut(to);
  at_ = to;
}

Job Drawer::job() {
  size_ = {in(3, 40), in(3, 30), in(2, 12)};
  Job made;
  made.pitch = in(0.08, 0.5);
  made.stock = test::block({0, 0, -size_.z}, {size_.x, size_.y, 0});
  const int tools = 1 + below(3);
  for (int k = 1; k <= tools; ++k) made.tools.set(k, tool(k));
  test::Path path;
  at_ = {0, 0, 5};
  path.tool(1).rapid(at_);
  const int moves = 1 + below(chance(0.2) ? 300 : 40);
  for (int k = 0; k < moves; ++k) {
    if (chance(0.03)) path.tool(1 + below(tools));
    move(path);
  }
  made.path = path.path();
  return made;
}

// ---- properties

std::optional<Simulation> simulated(const Job& job, unsigned threads) {
  Diagnostics diagnostics;
  return test::run(job.path, job.tools, job.stock, job.pitch, diagnostics, threads);
}

template <class Value>
bool same_bits(const std::vector<Value>& a, const std::vector<Value>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Value)) == 0);
}

bool same_hazards(const std::vector<Hazard>& a, const std::vector<Hazard>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (a[k].kind != b[k].kind || a[k].step != b[k].step || a[k].at != b[k].at || a[k].depth != b[k].depth ||
        a[k].removed != b[k].removed)
      return false;
  return true;
}

const char* difference(const Simulation& a, const Simulation& b) {
  const ColumnGrid one = a.workpiece.grid(), other = b.workpiece.grid();
  if (!same_bits(one.first, other.first) || !same_bits(one.intervals, other.intervals)) return "columns";
  if (!same_bits(one.cut_through, other.cut_through)) return "steps of columns cut through";
  if (!same_bits(a.removed_by_step, b.removed_by_step)) return "volumes of steps";
  if (a.removed != b.removed) return "removed volume";
  return same_hazards(a.hazards, b.hazards) ? nullptr : "hazards";
}

/// Runs the job with each vector instruction set; the widest is the reference.
std::string differs_by_level(const Job& job, const Simulation& reference) {
  hwy::SetSupportedTargetsForTest(0);
  const std::int64_t all = hwy::SupportedTargets();
  std::string problem;
  for (std::int64_t rest = all; rest != 0; rest &= rest - 1) {
    const std::int64_t target = rest & -rest;
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    const auto result = simulated(job, 1);
    const char* what = result ? difference(reference, *result) : "no result";
    if (what != nullptr)
      problem = fmt::format("{} differ on {}", what, hwy::TargetName(static_cast<std::uint32_t>(target)));
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return problem;
}

std::string lost_volume(const Simulation& result) {
  const double stock = result.stock.mm3(), left = result.workpiece.volume().mm3();
  if (std::abs(stock - result.removed.mm3() - left) > 2e-6 * stock)
    return fmt::format("{} mm3 of {} are neither removed nor left", stock - result.removed.mm3() - left,
                       stock);
  return {};
}

/// Edges that pierce a triangle less deeply do not count, mm.
constexpr double kPierced = 1e-3;

/// Deviations of the meshes' volumes: the sums of all jobs from the volume with refined walls, mm3, and the
/// maximum from the volume of the columns as a fraction of the tolerance of verify_mesh.
struct MeshErrors {
  double rough = 0.0, sharp = 0.0, max_fraction = 0.0;
  std::size_t pierced = 0;  // edges of the sharpened meshes
  double deepest = 0.0;     // mm, of them
};

std::string fault_of(const Mesh& mesh, const Simulation& result, const VolumeRange& range, double& error,
                     double& max_fraction) {
  const MeshCheck check = check_mesh(mesh);
  if (check.bad_edges != 0)
    return fmt::format("{} edges of the mesh are not shared by two triangles", check.bad_edges);
  error += std::abs((check.volume - result.workpiece.volume()).mm3());
  const double off = std::abs((check.volume - range.expected).mm3());
  max_fraction = std::max(max_fraction, off > 0.0 ? off / range.tolerance.mm3() : 0.0);
  if (off > range.tolerance.mm3())
    return fmt::format("the mesh holds {} mm3, the columns {}", check.volume.mm3(), range.expected.mm3());
  return {};
}

std::string mesh_problem(const Simulation& result, MeshErrors& errors) {
  const ColumnGrid columns = result.workpiece.grid();
  const Mesh rough = extract_mesh(columns);
  if (std::string problem = fault_of(rough, result, mesh_volume(columns), errors.rough, errors.max_fraction);
      !problem.empty())
    return problem;
  std::array<Mesh, 2> sharp{rough, rough};
  for (const unsigned n : {0u, 1u}) {
    ExactMeshOptions options;
    options.threads = n == 0 ? 1 : 3;
    if (!make_mesh_exact(sharp[n], result, options)) return "not sharpened";
  }
  if (!same_bits(sharp[0].positions, sharp[1].positions) ||
      !same_bits(sharp[0].triangles, sharp[1].triangles))
    return "the sharp mesh depends on the number of threads";
  const VolumeRange range = mesh_volume(columns, {.tolerance = ExactMeshOptions().tolerance});
  const std::string problem = fault_of(sharp[0], result, range, errors.sharp, errors.max_fraction);
  if (!problem.empty()) return "sharpened: " + problem;
  const test::Crossings crossings = test::find_crossings(sharp[0], kPierced);
  errors.pierced += crossings.edges;
  errors.deepest = std::max(errors.deepest, crossings.deepest);
  return {};
}

std::string problem_of(const Job& job, MeshErrors& errors) {
  const auto reference = simulated(job, 1);
  if (!reference) return "not simulated";
  for (const unsigned threads : {2u, 3u, 7u}) {
    const auto result = simulated(job, threads);
    const char* what = result ? difference(*reference, *result) : "no result";
    if (what != nullptr) return fmt::format("{} differ on {} threads", what, threads);
  }
  if (std::string problem = differs_by_level(job, *reference); !problem.empty()) return problem;
  if (std::string problem = lost_volume(*reference); !problem.empty()) return problem;
  return mesh_problem(*reference, errors);
}

}  // namespace

int main(int argc, char** argv) {
  const long count = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 1000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  long failed = 0;
  MeshErrors errors;
  for (long k = 0; k < count; ++k) {
    const std::string problem = problem_of(Drawer(seed + static_cast<std::uint64_t>(k)).job(), errors);
    if (problem.empty()) continue;
    ++failed;
    std::fputs(fmt::format("seed {}: {}\n", seed + static_cast<std::uint64_t>(k), problem).c_str(), stdout);
  }
  std::fputs(fmt::format("{} jobs from seed {}, {} failed\n", count, seed, failed).c_str(), stdout);
  std::fputs(
      fmt::format(
          "volumes of the meshes differ by {:.4g} mm3 in total, of the sharpened ones by {:.4g}; maximum "
          "fraction of the tolerance {:.2g}\n",
          errors.rough, errors.sharp, errors.max_fraction)
          .c_str(),
      stdout);
  std::fputs(fmt::format("{} edges of the sharpened meshes pierce a triangle by more than {} mm, the deepest "
                         "by {:.3g} mm\n",
                         errors.pierced, kPierced, errors.deepest)
                 .c_str(),
             stdout);
  return failed == 0 ? 0 : 1;
}
