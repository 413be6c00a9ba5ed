// Stock: a block, a mesh, left-over columns.
#include "kerf/stock/stock.h"

#include <algorithm>
#include <cmath>

#include "job/stored/parts.h"

#include "kerf/base/limits.h"
#include "kerf/formats/workshop_files.h"

namespace kerf::stored {
namespace {

enum class Body : std::uint8_t { none, mesh, columns };

bool is_position(double v) { return std::abs(v) <= limits::kMaxCoordinate; }

/// Whether each triangle has three points of the mesh.
bool is_complete(const BodyMesh& mesh) {
  const std::size_t points = mesh.positions.size() / 3;
  return mesh.positions.size() % 3 == 0 && mesh.triangles.size() % 3 == 0 &&
         mesh.triangles.size() / 3 <= limits::kMaxTriangles &&
         std::all_of(mesh.positions.begin(), mesh.positions.end(), is_position) &&
         std::all_of(mesh.triangles.begin(), mesh.triangles.end(),
                     [points](std::uint32_t v) { return v < points; });
}

std::shared_ptr<const StockBody> read_mesh_body(Source& a, Diagnostics& diagnostics) {
  BodyMesh mesh;
  values(a, mesh.name, mesh.positions, mesh.triangles);
  if (!a.failed() && !is_complete(mesh)) a.refuse("a mesh is incomplete");
  if (a.failed()) return nullptr;
  Diagnostics found;
  auto body = make_mesh_body(mesh.positions, mesh.triangles, mesh.name, found);
  if (!body) {
    a.refuse("a mesh has no volume");
    return nullptr;
  }
  for (const Diagnostic& d : found.list()) diagnostics.add(d);
  return body;
}

/// By the form of .kstock files, which is compact.
std::shared_ptr<const StockBody> read_columns_body(Source& a) {
  Diagnostics ignored;
  const auto stock = read_stock_file(a.text(), "stock.kstock", ignored);
  if (!stock) a.refuse("left-over stock is damaged");
  return stock ? stock->body : nullptr;
}

}  // namespace

template <>
inline constexpr Body kLast<Body> = Body::columns;

void value(Sink& a, const Stock& stock) {
  const auto& [block, body] = stock;
  value(a, block);
  if (!body) return value(a, Body::none);
  if (const auto mesh = mesh_of(*body)) {
    values(a, Body::mesh, mesh->name, mesh->positions, mesh->triangles);
  } else {
    value(a, Body::columns);
    a.text(write_left_file(*columns_of(*body)));
  }
}

void read_stock(Source& a, Stock& stock, Diagnostics& diagnostics) {
  Body body = Body::none;
  values(a, stock.block, body);
  for (const Point3& corner : {stock.block.low, stock.block.high})
    if (!stock.block.empty() && !(is_position(corner.x) && is_position(corner.y) && is_position(corner.z)))
      a.refuse("a stock is too large");
  if (a.failed()) return;
  if (body == Body::mesh) stock.body = read_mesh_body(a, diagnostics);
  if (body == Body::columns) stock.body = read_columns_body(a);
}

}  // namespace kerf::stored
