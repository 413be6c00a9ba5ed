// Waterlines: the boundaries of where the axis of a tool may be on a level. They are found on a grid of
// heights of the tool, and each of their points by halving the interval between a free and a blocked
// position.
#include <algorithm>
#include <cmath>
#include <map>

#include "base/codes/op.h"
#include "base/pace.h"
#include "base/parallel.h"
#include "op/base/cutter.h"
#include "op/base/trails.h"
#include "op/mesh/surface_job.h"
#include "op/mesh/surface_rest.h"

#include "kerf/op/surface.h"

namespace kerf {
namespace {

using namespace op_detail;
using Loop = std::vector<Point2>;  // closed where the last point is the first

constexpr double kGridPitch = 0.25;  // of the tool's radius
constexpr double kMaxGrid = 4e6;     // points; the pitch is larger where there would be more
constexpr double kExact = 0.1;       // of the tolerance, of a point of a waterline
constexpr double kThin = 0.05;       // of the tolerance, of points that are left out
constexpr double kBlocked = 1e-6;    // mm above the level
constexpr double kMaxAside = 4.0;    // of the length of a chord, where the waterline is searched beside it
constexpr double kMinChord = 0.2;    // of the tolerance
constexpr std::size_t kMaxNearest = 20'000;  // points of loops that are compared for the nearest start

/// The heights of a tool on a grid.
struct Field {
  Point2 corner;
  double pitch = 1.0;
  int nx = 0, ny = 0;
  std::vector<double> heights;

  Point2 at(int i, int j) const { return {corner.x + pitch * i, corner.y + pitch * j}; }
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i);
  }
};

/// The waterlines of one level.
class Level {
 public:
  Level(const SurfaceJob& job, const Field& field, double z, double tolerance, const LineStop& stop)
      : job_(job), field_(field), z_(z + kBlocked), tolerance_(tolerance), stop_(stop) {
    SurfaceTool cylinder = job.cutter.tool();
    pitch_ = sample_pitch(cylinder, tolerance);
    cylinder.flat = cylinder.radius;
    wide_pitch_ = std::max(sample_pitch(cylinder, tolerance), pitch_);
  }

  /// With the part on the right; closed, but for pieces between thin parts that the grid does not show. Those
  /// of a stopped run are not complete.
  std::vector<Loop> loops() {
    std::map<std::size_t, std::size_t> next;  // edges of the grid that a waterline leads from and to
    for (int j = 0; j + 1 < field_.ny && !stop_(); ++j)
      for (int i = 0; i + 1 < field_.nx; ++i) link(i, j, next);
    std::vector<Loop> made;
    while (!next.empty() && !stop_()) {
      const std::size_t first = next.begin()->first;
      Loop coarse;
      for (auto edge = next.begin(); edge != next.end();) {
        coarse.push_back(crossing(edge->first));
        const std::size_t to = edge->second;
        next.erase(edge);
        edge = to == first ? next.end() : next.find(to);
      }
      coarse.push_back(coarse.front());
      for (Loop& piece : refined(coarse)) made.push_back(std::move(piece));
    }
    return made;
  }

 private:
  bool blocked(Point2 p) { return job_.cutter.at(p, z_) > z_; }
  /// How far from a free point the next one may be.
  double room(Point2 p) {
    const double cone = job_.cutter.tool().cone;
    if (cone == 0.0) return pitch_;
    // The height on a cone changes by no more than its slope, but for the cylinder above it.
    const double below = z_ - job_.cutter.at(p, z_ - cone * wide_pitch_);
    return std::max(pitch_, below / cone);
  }
  bool solid(int i, int j) const { return field_.heights[field_.index(i, j)] > z_; }

  /// The waterlines through one cell: each enters over an edge where the part is ahead on the way around the
  /// cell, and leaves over one where it ends.
  void link(int i, int j, std::map<std::size_t, std::size_t>& next) {
    const bool corner[4] = {solid(i, j), solid(i + 1, j), solid(i + 1, j + 1), solid(i, j + 1)};
    const std::size_t edge[4] = {2 * field_.index(i, j), 2 * field_.index(i + 1, j) + 1,
                                 2 * field_.index(i, j + 1), 2 * field_.index(i, j) + 1};
    int starts[2] = {0, 0}, count = 0;
    for (int k = 0; k < 4; ++k)
      if (!corner[k] && corner[(k + 1) % 4]) starts[count++] = k;
    if (count == 0) return;
    const bool joined =
        count == 2 && blocked(field_.at(i, j) + Point2{0.5 * field_.pitch, 0.5 * field_.pitch});
    for (int n = 0; n < count; ++n) {
      // Where the centre connects two corners of the part, a waterline passes around the free one before it.
      int k = starts[n];
      do k = joined ? (k + 3) % 4 : (k + 1) % 4;
      while (!(corner[k] && !corner[(k + 1) % 4]));
      next[edge[starts[n]]] = edge[k];
    }
  }

  /// The free end of the interval on an edge of the grid where the waterline crosses it.
  Point2 crossing(std::size_t edge) {
    const auto nx = static_cast<std::size_t>(field_.nx);
    const int i = static_cast<int>(edge / 2 % nx), j = static_cast<int>(edge / 2 / nx);
    const bool vertical = edge % 2 == 1;
    Point2 a = field_.at(i, j), b = field_.at(vertical ? i : i + 1, vertical ? j + 1 : j);
    if (solid(i, j)) std::swap(a, b);
    return boundary(a, b);
  }
  /// Between a free and a blocked point; free.
  Point2 boundary(Point2 open, Point2 closed) {
    while (distance(open, closed) > kExact * tolerance_) {
      const Point2 midpoint = 0.5 * (open + closed);
      (blocked(midpoint) ? closed : open) = midpoint;
    }
    return open;
  }

  /// The point of the waterline beside a point of a chord; nothing where there is none near.
  std::optional<Point2> beside(Point2 p, Point2 to_part, double limit) {
    const bool inside = blocked(p);
    const Point2 way = inside ? -to_part : to_part;
    for (double step = 2.0 * tolerance_, from = 0.0; from < limit; step *= 2.0) {
      const double to = std::min(from + step, limit);
      const Point2 q = p + to * way;
      if (blocked(q) != inside) {
        const Point2 last = p + from * way;
        return inside ? boundary(q, last) : boundary(last, q);
      }
      from = to;
    }
    return std::nullopt;
  }

  enum class Verdict : std::uint8_t { near, divide, blocked };
  /// Whether a chord is free and near enough to the waterline; otherwise where to divide it, if there is a
  /// point of the waterline beside it.
  std::pair<Verdict, Point2> judge(Point2 a, Point2 b) {
    const double whole = distance(a, b);
    if (whole <= kMinChord * tolerance_) return {Verdict::near, {}};
    const Point2 to_part = (-1.0 / whole) * left_of(b - a);
    const double limit = kMaxAside * std::max(whole, tolerance_);
    for (double s = room(a); s < whole;) {
      const Point2 p = a + (s / whole) * (b - a);
      if (blocked(p)) {
        const auto at = beside(p, to_part, limit);
        return at && *at != a && *at != b ? std::pair(Verdict::divide, *at) : std::pair(Verdict::blocked, p);
      }
      s += room(p);
    }
    const Point2 midpoint = 0.5 * (a + b);
    if (blocked(midpoint + (0.5 * tolerance_) * to_part)) return {Verdict::near, {}};
    const auto at = beside(midpoint, to_part, limit);
    return at && *at != a && *at != b ? std::pair(Verdict::divide, *at) : std::pair(Verdict::near, Point2{});
  }

  /// Pieces without chords that are blocked by something thinner than the grid.
  std::vector<Loop> refined(const Loop& coarse) {
    std::vector<Loop> made(1, Loop{coarse.front()});
    std::vector<Point2> open;  // to be reached, the next one last
    for (std::size_t i = 1; i < coarse.size() && !stop_(); ++i) {
      open.assign(1, coarse[i]);
      for (int divisions = 0; !open.empty();) {
        auto [verdict, at] = judge(made.back().back(), open.back());
        if (verdict == Verdict::divide && ++divisions > kMaxDivisions) verdict = Verdict::blocked;
        if (verdict == Verdict::divide) {
          open.push_back(at);
          continue;
        }
        if (verdict == Verdict::blocked) made.emplace_back();
        made.back().push_back(open.back());
        open.pop_back();
      }
    }
    std::erase_if(made, [](const Loop& piece) { return piece.size() < 2; });
    return made;
  }

  static constexpr int kMaxDivisions = 2000;  // of one chord between edges of the grid
  const SurfaceJob& job_;
  const Field& field_;
  double z_, tolerance_;
  const LineStop& stop_;
  double pitch_,
      wide_pitch_;  // mm, between positions that are examined: for the end of the tool, and for its sides
};

Field empty_field(const Box2& mesh, double radius) {
  Field field;
  field.pitch = kGridPitch * radius;
  const Box2 box = mesh.grown(radius + 2.0 * field.pitch);
  const double wide = box.high.x - box.low.x, high = box.high.y - box.low.y;
  field.pitch = std::max(field.pitch, std::sqrt(wide * high / kMaxGrid));
  field.corner = box.low;
  field.nx = static_cast<int>(std::ceil(wide / field.pitch)) + 1;
  field.ny = static_cast<int>(std::ceil(high / field.pitch)) + 1;
  field.heights.resize(static_cast<std::size_t>(field.nx) * static_cast<std::size_t>(field.ny));
  return field;
}

/// A closed loop from its point nearest to `here`.
void start_near(Loop& loop, Point2 here) {
  if (loop.front() != loop.back()) return;
  loop.pop_back();
  const auto nearest = std::min_element(
      loop.begin(), loop.end(), [&](Point2 a, Point2 b) { return distance(a, here) < distance(b, here); });
  std::rotate(loop.begin(), nearest, loop.end());
  loop.push_back(loop.front());
}

/// Cuts the loops of a level, each next one near the last.
class LevelCutter {
 public:
  LevelCutter(const SurfaceJob& job, Cutter& cutter, double reach)
      : job_(job), cutter_(cutter), reach_(reach) {}

  void cut(std::vector<Loop> loops, double z) {
    while (!loops.empty() && !cutter_.full()) {
      const std::size_t next = nearest(loops);
      Loop loop = std::move(loops[next]);
      loops.erase(loops.begin() + static_cast<std::ptrdiff_t>(next));
      if (cutter_.position()) start_near(loop, cutter_.position()->xy());
      if (!slide(loop.front())) {
        cutter_.travel(loop.front(), job_.cut.top);
        cutter_.rapid_down(job_.cut.top + job_.cut.clearance.mm());
      }
      cutter_.plunge(z);
      for (const Point2 p : loop) cutter_.line(p);
    }
  }

 private:
  std::size_t nearest(const std::vector<Loop>& loops) const {
    if (!cutter_.position()) return 0;
    const Point2 here = cutter_.position()->xy();
    double best = INFINITY;
    std::size_t at = 0, compared = 0;
    for (std::size_t i = 0; i < loops.size() && compared < kMaxNearest; ++i)
      for (const Point2 p : loops[i]) {
        if (++compared; distance(p, here) < best) best = distance(p, here), at = i;
      }
    return at;
  }
  /// On the level to a near point, if nothing is in the way.
  bool slide(Point2 to) {
    const auto here = cutter_.position();
    if (!here || distance(here->xy(), to) > reach_ || here->z > job_.cut.top) return false;
    for (const Point3& p : job_.follow(here->xy(), to))
      if (p.z > here->z + kBlocked) return false;
    cutter_.line(to);
    return true;
  }

  const SurfaceJob& job_;
  Cutter& cutter_;
  double reach_;
};

/// Without points within a tenth of the tolerance of the chords that are left.
Loop thinned(const Loop& loop, double tolerance) {
  std::vector<Point3> points;
  for (const Point2 p : loop) points.push_back({p.x, p.y, 0.0});
  Loop made;
  // A closed path is divided where it is furthest from its start, as its chord has no length.
  const auto furthest = std::max_element(points.begin(), points.end(), [&](const Point3& a, const Point3& b) {
    return distance(a, points.front()) < distance(b, points.front());
  });
  const std::vector<Point3> there(points.begin(), furthest + 1), back(furthest, points.end());
  for (const auto* half : {&there, &back})
    for (const Point3& p : simplified(*half, kThin * tolerance))
      if (made.empty() || made.back() != p.xy()) made.push_back(p.xy());
  return made;
}

/// The parts of loops on a level that cut what an earlier tool has left.
std::vector<Loop> rest_of(const std::vector<Loop>& loops, double z, const SurfaceRest& rest, Pace& pace) {
  std::vector<Loop> made;
  for (const Loop& loop : loops) {
    if (pace.asks()) return made;
    std::vector<Point3> path;
    for (const Point2 p : loop) path.push_back({p.x, p.y, z});
    for (const std::vector<Point3>& part : rest.parts(path)) {
      made.emplace_back();
      for (const Point3& p : part) made.back().push_back(p.xy());
    }
  }
  return made;
}

}  // namespace

std::optional<Operation> waterline(const SurfaceMesh& mesh, const Tool& tool, const MeshCutOptions& options,
                                   Diagnostics& diagnostics) {
  const auto job = surface_job(mesh, tool, options, SurfaceFloor::limited, diagnostics);
  if (!job || stop_requested(options.cut.progress)) return std::nullopt;
  const Box3 box = bounds(mesh);
  const double allowance = job->cut.allowance.mm(), tolerance = options.tolerance.mm();
  Field field = empty_field({box.low.xy(), box.high.xy()}, job->cutter.tool().radius);
  bool all = for_each_line(options, "heights of the tool", static_cast<std::size_t>(field.ny),
                           [&](std::size_t row, const LineStop&) {
                             const int j = static_cast<int>(row);
                             for (int i = 0; i < field.nx; ++i)
                               field.heights[field.index(i, j)] =
                                   job->cutter.at(field.at(i, j), job->floor - allowance);
                           });
  if (!all) return std::nullopt;
  const std::vector<double> levels = pass_levels(job->cut.top, job->cut.depth, job->cut.stepdown);
  std::vector<std::vector<Loop>> loops(levels.size());
  all = for_each_line(options, "waterlines", levels.size(), [&](std::size_t k, const LineStop& stop) {
    for (Loop& loop : Level(*job, field, levels[k] - allowance, tolerance, stop).loops()) {
      if (job->cut.direction == CutDirection::conventional) std::reverse(loop.begin(), loop.end());
      loops[k].push_back(thinned(loop, tolerance));
    }
  });
  if (!all) return std::nullopt;
  if (options.earlier) {
    const auto rest = SurfaceRest::make(mesh, *job, tool, {}, options, diagnostics);
    if (!rest) return std::nullopt;
    bool any = false;
    Pace pace(options.cut.progress, "rest of the earlier tool", 1);
    for (std::size_t k = 0; k < levels.size(); ++k) {
      if (pace.stops(k, levels.size())) return std::nullopt;
      loops[k] = rest_of(loops[k], levels[k], *rest, pace), any = any || !loops[k].empty();
    }
    if (pace.asks()) return std::nullopt;
    if (!any) return SurfaceRest::nothing(options, tool, diagnostics), std::nullopt;
  }
  Cutter cutter(job->cut, tool, Walls(Walls::Kind::unknown));
  LevelCutter level_cutter(*job, cutter, tool.diameter.mm());
  Pace pace(options.cut.progress, "ordering the levels", 1);
  for (std::size_t k = 0; k < levels.size() && !pace.stops(k, levels.size()); ++k)
    level_cutter.cut(std::move(loops[k]), levels[k]);
  auto made = finished(cutter, job->cut, diagnostics);
  if (made && made->path.size() <= 1) {
    fail(job->cut, codes::op_empty, "no level of the operation meets the mesh", diagnostics);
    return std::nullopt;
  }
  return made;
}

}  // namespace kerf
