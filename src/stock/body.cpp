// Bodies: made from triangles or columns, checked, moved.
#include "stock/body.h"

#include <algorithm>
#include <cassert>
#include <fmt/format.h>
#include <unordered_map>

#include "base/codes/stock.h"
#include "base/pace.h"

namespace kerf {
namespace solid {
namespace {

/// Smaller volumes count as none, mm3; far below a chip, far above rounding.
constexpr double kNoVolume = 1e-6;

struct LatticeHash {
  std::size_t operator()(const Lattice& p) const {
    std::uint64_t h = 0;
    for (const std::int64_t v : {p.x, p.y, p.z}) {
      h = (h ^ static_cast<std::uint64_t>(v)) * 0x9e3779b97f4a7c15u;
      h ^= h >> 29;
    }
    return static_cast<std::size_t>(h);
  }
};

/// One point per position, and no triangle with equal vertices.
MeshSolid weld(std::span<const double> positions, std::span<const std::uint32_t> triangles, Pace& pace) {
  MeshSolid mesh;
  std::unordered_map<Lattice, std::uint32_t, LatticeHash> known;
  std::vector<std::uint32_t> number(positions.size() / 3);
  known.reserve(number.size() / 2);
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (pace.stops(v, number.size())) return mesh;
    const double* p = positions.data() + 3 * v;
    const Lattice at{to_lattice(p[0]), to_lattice(p[1]), to_lattice(p[2])};
    const auto [it, is_new] = known.try_emplace(at, static_cast<std::uint32_t>(mesh.points.size()));
    if (is_new) mesh.points.push_back(at);
    number[v] = it->second;
  }
  mesh.triangles.reserve(triangles.size() / 3);
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    if (pace.stops(number.size(), number.size())) return mesh;
    const std::array<std::uint32_t, 3> v{number[triangles[t]], number[triangles[t + 1]],
                                         number[triangles[t + 2]]};
    if (v[0] != v[1] && v[1] != v[2] && v[2] != v[0]) mesh.triangles.push_back(v);
  }
  return mesh;
}

double signed_volume(const MeshSolid& mesh) {
  if (mesh.points.empty()) return 0.0;
  const Point3 origin = mesh.at(0);
  double six = 0.0;
  for (const auto& t : mesh.triangles)
    six += dot(mesh.at(t[0]) - origin, cross(mesh.at(t[1]) - origin, mesh.at(t[2]) - origin));
  return six / 6.0;
}

/// Faults of the edges: those with a missing triangle, and those with inconsistently oriented triangles.
struct EdgeFaults {
  std::size_t open = 0, turned = 0;
  Point3 first_open;  // midpoint of one
};

/// An edge of a triangle, stored at its vertex with the lower number.
struct Edge {
  std::uint32_t high;
  bool upwards;
};

/// The edges of all triangles, by their lower vertex: those of vertex v are first[v] to first[v + 1] - 1.
struct Edges {
  std::vector<std::size_t> first;
  std::vector<Edge> edges;
};

/// Sorted by counting, as that can be stopped and takes less time than a sort of all.
Edges edges_of(const MeshSolid& mesh, Pace& pace) {
  Edges out;
  out.first.assign(mesh.points.size() + 1, 0);
  const auto each = [&](const auto& visit) {
    for (std::size_t n = 0; n < mesh.triangles.size() && !pace.stops(n, mesh.triangles.size()); ++n)
      for (std::size_t k = 0; k < 3; ++k) visit(mesh.triangles[n][k], mesh.triangles[n][(k + 1) % 3]);
  };
  pace.part(0.4, 0.5);
  each([&](std::uint32_t a, std::uint32_t b) { ++out.first[std::min(a, b) + 1]; });
  for (std::size_t v = 1; v < out.first.size(); ++v) out.first[v] += out.first[v - 1];
  out.edges.resize(out.first.back());
  std::vector<std::size_t> next(out.first.begin(), out.first.end() - 1);
  pace.part(0.5, 0.7);
  each([&](std::uint32_t a, std::uint32_t b) {
    out.edges[next[std::min(a, b)]++] = {std::max(a, b), a < b};
  });
  return out;
}

EdgeFaults find_edge_faults(const MeshSolid& mesh, Pace& pace) {
  EdgeFaults faults;
  Edges all = edges_of(mesh, pace);
  pace.part(0.7, 1.0);
  for (std::uint32_t v = 0; v < mesh.points.size() && !pace.stops(v, mesh.points.size()); ++v) {
    const auto first = all.edges.begin() + static_cast<std::ptrdiff_t>(all.first[v]),
               last = all.edges.begin() + static_cast<std::ptrdiff_t>(all.first[v + 1]);
    std::sort(first, last, [](const Edge& a, const Edge& b) { return a.high < b.high; });
    for (auto at = first; at != last;) {
      const std::uint32_t high = at->high;
      std::size_t uses = 0;
      std::ptrdiff_t balance = 0;
      for (; at != last && at->high == high; ++at, ++uses) balance += at->upwards ? 1 : -1;
      if (uses % 2 != 0) {
        if (faults.open++ == 0) faults.first_open = 0.5 * (mesh.at(v) + mesh.at(high));
      } else if (balance != 0) {
        ++faults.turned;
      }
    }
  }
  return faults;
}

void turn_round(MeshSolid& mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

/// Reports faults and corrects orientation. False if the mesh is unusable, or the work stopped.
bool check_mesh(MeshSolid& mesh, double& volume, Pace& pace, Diagnostics& diagnostics) {
  const TextLocation file{mesh.name, 0, 0};
  const EdgeFaults faults = find_edge_faults(mesh, pace);
  if (pace.stopped()) return false;
  if (faults.open > 0) {
    const Point3& at = faults.first_open;
    diagnostics
        .warning(
            codes::mesh_open, file,
            fmt::format("the mesh is not closed: {} edges have a triangle on one side only, one of them at "
                        "X{:.3f} Y{:.3f} Z{:.3f}",
                        faults.open, at.x, at.y, at.z))
        .hint = "it is used as long as no vertical line passes through a hole";
  }
  mesh.is_oriented = faults.turned == 0;
  if (!mesh.is_oriented) {
    diagnostics.warning(
        codes::mesh_turned, file,
        fmt::format("the triangles at {} edges are inconsistently oriented; the inside is determined "
                    "by counting surfaces",
                    faults.turned));
    volume = std::abs(volume);
  } else if (volume < 0.0) {
    diagnostics.note(codes::mesh_turned, file, "the triangles face inwards; they were inverted");
    turn_round(mesh);
    volume = -volume;
  }
  if (volume > kNoVolume || !mesh.is_oriented) return true;
  diagnostics.error(codes::mesh_no_volume, file, "the mesh encloses no volume");
  return false;
}

Box3 bounds_of(const MeshSolid& mesh) {
  Box3 box;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) box.add(mesh.at(v));
  return box;
}

double volume_of(const LeftColumns& left) {
  const Point3 size = left.bounds.size();
  const ColumnPositions& p = left.positions;
  const auto fraction_inside = [&p](double low, double size_in_axis, double first, int k) {
    const double start = std::max(first + (k - 0.5) * p.pitch, low);
    return std::max(std::min(first + (k + 0.5) * p.pitch, low + size_in_axis) - start, 0.0);
  };
  double sum = 0.0;
  for (int j = 0; j < p.ny; ++j) {
    double row = 0.0;
    for (int i = 0; i < p.nx; ++i) {
      double length = 0.0;
      for (const Run& run : left.columns.column(i, j)) length += static_cast<double>(run.high - run.low);
      row += length * fraction_inside(left.bounds.low.x, size.x, p.x, i);
    }
    sum += row * fraction_inside(left.bounds.low.y, size.y, p.y, j);
  }
  return sum;
}

// ---- moves

/// A move of one axis: v to sign * v + shift.
struct AxisMove {
  double sign = 1.0, shift = 0.0;
  double operator()(double v) const { return sign * v + shift; }
};
struct Moves {
  AxisMove axis[3];
  Point3 operator()(Point3 p) const { return {axis[0](p.x), axis[1](p.y), axis[2](p.z)}; }
  Box3 operator()(const Box3& box) const {
    Box3 out;
    out.add((*this)(box.low));
    out.add((*this)(box.high));
    return out;
  }
};

Moves moves_of(const StockMove& move) {
  Moves out;
  if (move.flip != StockMove::Flip::none) {
    const int across = move.flip == StockMove::Flip::about_x ? 1 : 0;
    out.axis[across] = {-1.0, 2.0 * move.across.value_or(0.0)};
    out.axis[2] = {-1.0, 2.0 * move.z.value_or(0.0)};
  }
  for (int k = 0; k < 3; ++k) out.axis[k].shift += move.shift[k];
  return out;
}

MeshSolid moved_mesh(MeshSolid mesh, const Moves& moves) {
  for (Lattice& p : mesh.points) {
    std::int64_t* const v[3] = {&p.x, &p.y, &p.z};
    for (int k = 0; k < 3; ++k)
      *v[k] = (moves.axis[k].sign < 0.0 ? -*v[k] : *v[k]) + to_lattice(moves.axis[k].shift);
  }
  return mesh;  // half a turn changes two signs, so the orientation is unchanged
}

LeftColumns moved_columns(const LeftColumns& left, const Moves& moves) {
  LeftColumns out;
  out.bounds = moves(left.bounds);
  ColumnPositions& p = out.positions = left.positions;
  const bool turn_x = moves.axis[0].sign < 0.0, turn_y = moves.axis[1].sign < 0.0,
             turn_z = moves.axis[2].sign < 0.0;
  p.x = moves.axis[0](left.positions.x + (turn_x ? (p.nx - 1) * p.pitch : 0.0));
  p.y = moves.axis[1](left.positions.y + (turn_y ? (p.ny - 1) * p.pitch : 0.0));
  p.z = out.bounds.low.z;
  const auto height = static_cast<float>(left.bounds.size().z);
  out.columns.nx = p.nx;
  out.columns.ny = p.ny;
  out.columns.first.reserve(left.columns.first.size());
  RunSink sink(out.columns);
  for (int j = 0; j < p.ny; ++j) {
    for (int i = 0; i < p.nx; ++i) {
      sink.start_column();
      const auto runs = left.columns.column(turn_x ? p.nx - 1 - i : i, turn_y ? p.ny - 1 - j : j);
      for (std::size_t k = 0; k < runs.size(); ++k) {
        const Run& run = runs[turn_z ? runs.size() - 1 - k : k];
        turn_z ? sink.add(height - run.high, height - run.low) : sink.add(run.low, run.high);
      }
    }
  }
  sink.end_columns();
  return out;
}

}  // namespace

ColumnRuns resampled(const LeftColumns& left, const ColumnPositions& positions) {
  ColumnRuns out{.nx = positions.nx, .ny = positions.ny, .first = {}, .runs = {}};
  const ColumnPositions& from = left.positions;
  const auto lift = static_cast<float>(from.z - positions.z);
  /// The column whose square contains a position; -1 outside.
  const auto nearest = [&from](double v, double first, int count) {
    const double k = std::floor((v - first) / from.pitch + 0.5);
    return k >= 0.0 && k < count ? static_cast<int>(k) : -1;
  };
  RunSink sink(out);
  for (int j = 0; j < positions.ny; ++j) {
    const int from_j = nearest(positions.y_of(j), from.y, from.ny);
    for (int i = 0; i < positions.nx; ++i) {
      sink.start_column();
      const int from_i = nearest(positions.x_of(i), from.x, from.nx);
      if (from_i < 0 || from_j < 0) continue;
      for (const Run& run : left.columns.column(from_i, from_j)) sink.add(run.low + lift, run.high + lift);
    }
  }
  sink.end_columns();
  return out;
}

}  // namespace solid

StockBody::StockBody(std::unique_ptr<Inside> inside) : inside_(std::move(inside)) {}
StockBody::~StockBody() = default;

const Box3& StockBody::bounds() const { return inside_->bounds; }
Volume StockBody::volume() const { return mm3(inside_->volume); }

std::optional<Length> StockBody::pitch() const {
  const auto* left = std::get_if<LeftColumns>(&inside_->what);
  return left == nullptr ? std::nullopt : std::optional(mm(left->positions.pitch));
}

std::optional<ColumnRuns> StockBody::columns(const ColumnPositions& positions, Diagnostics& diagnostics,
                                             Progress* progress) const {
  if (const auto* mesh = std::get_if<solid::MeshSolid>(&inside_->what))
    return solid::mesh_columns(*mesh, positions, diagnostics, progress);
  return solid::resampled(std::get<LeftColumns>(inside_->what), positions);
}

std::shared_ptr<const StockBody> StockBody::moved(const StockMove& move) const {
  const solid::Moves moves = solid::moves_of(move);
  const auto* mesh = std::get_if<solid::MeshSolid>(&inside_->what);
  if (mesh == nullptr)
    return make_columns_body(solid::moved_columns(std::get<LeftColumns>(inside_->what), moves));
  solid::MeshSolid moved = solid::moved_mesh(*mesh, moves);
  auto inside = std::make_unique<Inside>();
  inside->bounds = solid::bounds_of(moved);
  inside->volume = std::abs(solid::signed_volume(moved));
  inside->what = std::move(moved);
  return std::make_shared<StockBody>(std::move(inside));
}

std::shared_ptr<const StockBody> make_mesh_body(std::span<const double> positions,
                                                std::span<const std::uint32_t> triangles,
                                                const std::string& name, Diagnostics& diagnostics,
                                                Progress* progress) {
  Pace pace(progress, "checking the mesh");
  pace.part(0.0, 0.4);
  solid::MeshSolid mesh = solid::weld(positions, triangles, pace);
  if (pace.asks()) return nullptr;
  mesh.name = name;
  double volume = solid::signed_volume(mesh);
  if (!solid::check_mesh(mesh, volume, pace, diagnostics)) return nullptr;
  auto inside = std::make_unique<StockBody::Inside>();
  inside->bounds = solid::bounds_of(mesh);
  inside->volume = volume;
  inside->what = std::move(mesh);
  return std::make_shared<StockBody>(std::move(inside));
}

std::shared_ptr<const StockBody> make_columns_body(LeftColumns columns) {
  auto inside = std::make_unique<StockBody::Inside>();
  inside->bounds = columns.bounds;
  inside->volume = solid::volume_of(columns);
  inside->what = std::move(columns);
  return std::make_shared<StockBody>(std::move(inside));
}

std::optional<BodyMesh> mesh_of(const StockBody& body) {
  const auto* mesh = std::get_if<solid::MeshSolid>(&body.inside().what);
  if (mesh == nullptr) return std::nullopt;
  BodyMesh out{.name = mesh->name, .positions = {}, .triangles = {}};
  out.positions.reserve(3 * mesh->points.size());
  for (std::uint32_t v = 0; v < mesh->points.size(); ++v) {
    const Point3 p = mesh->at(v);
    out.positions.insert(out.positions.end(), {p.x, p.y, p.z});
  }
  out.triangles.reserve(3 * mesh->triangles.size());
  for (const auto& t : mesh->triangles) out.triangles.insert(out.triangles.end(), t.begin(), t.end());
  return out;
}

const LeftColumns* columns_of(const StockBody& body) { return std::get_if<LeftColumns>(&body.inside().what); }

Stock stock_of(std::shared_ptr<const StockBody> body) {
  Stock stock{body->bounds()};
  stock.body = std::move(body);
  return stock;
}

Stock moved(const Stock& stock, StockMove move) {
  const Point3 centre = 0.5 * (stock.block.low + stock.block.high);
  if (!move.across) move.across = move.flip == StockMove::Flip::about_x ? centre.y : centre.x;
  if (!move.z) move.z = centre.z;
  Stock out{solid::moves_of(move)(stock.block)};
  if (stock.body) out.body = stock.body->moved(move);
  return out;
}

}  // namespace kerf
