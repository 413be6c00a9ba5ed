// Units, names and styles of a drawing, and the placement of the entities of blocks.
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/outline.h"
#include "base/pace.h"
#include "codec/drawing/dxf_reader.h"

namespace kerf::dxf {
namespace {

Point cross(Point a, Point b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Point unit(Point a) {
  // By the largest coordinate first, so that no square overflows.
  const double largest = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
  if (!(largest > 0.0)) return {};
  const Point s{a.x / largest, a.y / largest, a.z / largest};
  const double size = std::sqrt(s.x * s.x + s.y * s.y + s.z * s.z);
  return {s.x / size, s.y / size, s.z / size};
}

struct Unit {
  int number;
  const char* name;
  double mm;
};
constexpr Unit kUnits[] = {
    {1, "inch", 25.4},
    {2, "foot", 304.8},
    {3, "mile", 1609344.0},
    {4, "mm", 1.0},
    {5, "cm", 10.0},
    {6, "m", 1e3},
    {7, "km", 1e6},
    {8, "microinch", 25.4e-6},
    {9, "mil", 0.0254},
    {10, "yard", 914.4},
    {11, "angstrom", 1e-7},
    {12, "nm", 1e-6},
    {13, "micrometre", 1e-3},
    {14, "dm", 100.0},
    {15, "decametre", 1e4},
    {16, "hectometre", 1e5},
    {21, "US survey foot", 1200e3 / 3937.0},
};

std::optional<std::uint32_t> find_name(const auto& table, std::string_view name) {
  const std::string key = folded(name);
  for (std::size_t i = 0; i < table.size(); ++i)
    if (folded(table[i].name) == key) return static_cast<std::uint32_t>(i);
  return std::nullopt;
}

}  // namespace

std::optional<std::uint32_t> find_layer(const Drawing& drawing, std::string_view name) {
  return find_name(drawing.layers, name);
}
std::optional<std::uint32_t> find_block(const Drawing& drawing, std::string_view name) {
  return find_name(drawing.blocks, name);
}

std::optional<double> mm_per_unit(int insunits) {
  for (const Unit& known : kUnits)
    if (known.number == insunits) return known.mm;
  return std::nullopt;
}

std::string unit_name(int insunits) {
  for (const Unit& known : kUnits)
    if (known.number == insunits) return known.name;
  return insunits == 0 ? "none" : fmt::format("unit {}", insunits);
}

std::string handle_text(std::uint64_t handle) { return handle == 0 ? "" : fmt::format("{:X}", handle); }

std::string_view type_name(const Drawing& drawing, const Entity& entity) {
  struct Names {
    const Drawing& drawing;
    std::string_view operator()(const Line&) const { return "LINE"; }
    std::string_view operator()(const Circle&) const { return "CIRCLE"; }
    std::string_view operator()(const Arc&) const { return "ARC"; }
    std::string_view operator()(const Dot&) const { return "POINT"; }
    std::string_view operator()(const Boxed<Polyline>& p) const {
      return p->lightweight ? "LWPOLYLINE" : "POLYLINE";
    }
    std::string_view operator()(const Boxed<Text>& text) const {
      constexpr std::string_view kNames[] = {"TEXT", "MTEXT", "ATTRIB", "ATTDEF"};
      return kNames[static_cast<std::size_t>(text->kind)];
    }
    std::string_view operator()(const Boxed<Insert>&) const { return "INSERT"; }
    std::string_view operator()(const Boxed<Ellipse>&) const { return "ELLIPSE"; }
    std::string_view operator()(const Boxed<Spline>&) const { return "SPLINE"; }
    std::string_view operator()(const Boxed<Hatch>& hatch) const { return hatch->name; }
    std::string_view operator()(const TextPart&) const { return "text"; }
    std::string_view operator()(const Other& other) const { return drawing.others[other.type].name; }
  };
  return std::visit(Names{drawing}, entity.shape);
}

namespace {

Origin at_line(const Drawing& drawing, std::size_t line) {
  return TextLocation{drawing.file, drawing.binary ? 0 : static_cast<std::uint32_t>(line), 0};
}

}  // namespace

Origin origin_of(const Drawing& drawing) { return at_line(drawing, 0); }
Origin origin_of(const Drawing& drawing, const Entity& entity) { return at_line(drawing, entity.position); }

Origin origin_at(const Drawing& drawing, std::uint32_t layer, std::uint64_t handle, double x_mm,
                 double y_mm) {
  return DrawingLocation{drawing.file, drawing.layers[layer].name, handle_text(handle), x_mm, y_mm};
}

// ------------------------------------------------------------------------------------------------- matrices

Point Matrix::direction(Point d) const {
  return {m[0][0] * d.x + m[0][1] * d.y + m[0][2] * d.z, m[1][0] * d.x + m[1][1] * d.y + m[1][2] * d.z,
          m[2][0] * d.x + m[2][1] * d.y + m[2][2] * d.z};
}

Point Matrix::operator*(Point p) const {
  const Point d = direction(p);
  return {d.x + m[0][3], d.y + m[1][3], d.z + m[2][3]};
}

Matrix Matrix::operator*(const Matrix& first) const {
  Matrix made;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) {
      double sum = column == 3 ? m[row][3] : 0.0;
      for (int k = 0; k < 3; ++k) sum += m[row][k] * first.m[k][column];
      made.m[row][column] = sum;
    }
  return made;
}

Matrix object_axes(Point extrusion) {
  if (extrusion.x == 0.0 && extrusion.y == 0.0 && extrusion.z > 0.0) return {};
  constexpr double kNearZ = 1.0 / 64.0;
  const Point z = unit(extrusion);
  if (z == Point{}) return {};
  const bool near_z = std::abs(z.x) < kNearZ && std::abs(z.y) < kNearZ;
  const Point x = unit(cross(near_z ? Point{0.0, 1.0, 0.0} : Point{0.0, 0.0, 1.0}, z));
  const Point y = unit(cross(z, x));
  Matrix made;
  const Point axes[] = {x, y, z};
  for (int i = 0; i < 3; ++i) {
    made.m[0][i] = axes[i].x;
    made.m[1][i] = axes[i].y;
    made.m[2][i] = axes[i].z;
  }
  return made;
}

// --------------------------------------------------------------------------------------------------- inserts

namespace {

/// Sine and cosine that are exact for multiples of 90 degrees.
std::pair<double, double> turn_of(double degrees) {
  const double quarter = std::remainder(degrees, 360.0) / 90.0;
  if (quarter == std::floor(quarter)) {
    constexpr double kCosines[] = {1.0, 0.0, -1.0, 0.0};
    const auto index = static_cast<std::size_t>((static_cast<int>(quarter) + 4) % 4);
    return {kCosines[index], kCosines[(index + 3) % 4]};
  }
  const double angle = std::remainder(degrees, 360.0) * std::numbers::pi / 180.0;
  return {std::cos(angle), std::sin(angle)};
}

Matrix shift(Point by) {
  Matrix made;
  made.m[0][3] = by.x;
  made.m[1][3] = by.y;
  made.m[2][3] = by.z;
  return made;
}

/// The insertion at a column and row of its array, in the object coordinates of the insert.
Matrix placement(const Insert& insert, Point base, int column, int row) {
  const auto [cosine, sine] = turn_of(insert.rotation);
  const double dx = column * insert.column_spacing, dy = row * insert.row_spacing;
  Matrix made;
  made.m[0][0] = cosine * insert.scale.x;
  made.m[1][0] = sine * insert.scale.x;
  made.m[0][1] = -sine * insert.scale.y;
  made.m[1][1] = cosine * insert.scale.y;
  made.m[2][2] = insert.scale.z;
  made.m[0][3] = insert.at.x + cosine * dx - sine * dy;
  made.m[1][3] = insert.at.y + sine * dx + cosine * dy;
  made.m[2][3] = insert.at.z;
  return made * shift({-base.x, -base.y, -base.z});
}

class Placer {
 public:
  Placer(const Drawing& drawing, const VisitOptions& options, Diagnostics& diagnostics,
         const std::function<void(const Placed&)>& visit)
      : drawing_(drawing),
        options_(options),
        diagnostics_(diagnostics),
        visit_(visit),
        pace_(options.progress, {}, kBetween) {
    open_.resize(drawing.blocks.size());
    reported_.resize(drawing.blocks.size());
  }
  bool run();

 private:
  /// Properties that an entity inherits from the insert that it belongs to.
  struct Context {
    Style style;  // of the insert; its colour and line type are those of BYBLOCK
    bool in_block = false;
    bool frozen = false;  // the insert's layer, or that of one around it, is frozen, or one of them is hidden
  };
  bool entity(const Entity& entity, const Matrix& matrix, const Context& context);
  bool insert(const Entity& entity, const Insert& insert, const Matrix& matrix, const Context& context,
              const Style& style);
  bool usable(const Entity& entity, const Insert& insert);
  Style style_of(const Entity& entity, const Context& context) const;
  bool limit(const Entity& entity, const std::string& what);

  const Drawing& drawing_;
  const VisitOptions& options_;
  Diagnostics& diagnostics_;
  static constexpr std::size_t kBetween = 16;  // a hatch or a text takes up to some ms
  const std::function<void(const Placed&)>& visit_;
  Pace pace_;
  std::size_t done_ = 0;  // of the drawing's own entities
  std::vector<const Entity*> inserts_;
  std::vector<bool> open_, reported_;  // by block
  std::size_t visited_ = 0;
};

bool Placer::run() {
  for (const Entity& e : drawing_.entities) {
    if (e.paper == options_.paper && !entity(e, {}, {})) return false;
    ++done_;
  }
  return true;
}

bool Placer::limit(const Entity& entity, const std::string& what) {
  const Entity& outermost = inserts_.empty() ? entity : *inserts_.front();
  diagnostics_.error(codes::dxf_limit, origin_of(drawing_, outermost), what).hint =
      "explode the blocks that are needed and remove the others";
  return false;
}

Style Placer::style_of(const Entity& entity, const Context& context) const {
  Style style;
  style.layer = context.in_block && entity.layer == kLayerZero ? context.style.layer : entity.layer;
  const Layer& layer = drawing_.layers[style.layer];
  if (entity.linetype == kByBlock)
    style.linetype = context.style.linetype;
  else
    style.linetype = entity.linetype == kByLayer ? layer.linetype : entity.linetype;
  if (style.linetype == kByLayer || style.linetype == kByBlock) style.linetype = kContinuous;
  style.colour = entity.colour;
  style.true_colour = entity.true_colour;
  if (entity.true_colour == kNoTrueColour && entity.colour == kColourByBlock) {
    style.colour = context.style.colour;
    style.true_colour = context.style.true_colour;
  } else if (entity.true_colour == kNoTrueColour && entity.colour >= kColourByLayer) {
    style.colour = layer.colour;
    style.true_colour = layer.true_colour;
  }
  style.linetype_scale = entity.linetype_scale * context.style.linetype_scale;
  style.visible = !context.frozen && !entity.hidden && !layer.frozen && !layer.off;
  return style;
}

bool Placer::entity(const Entity& entity, const Matrix& matrix, const Context& context) {
  if (pace_.stops(done_, drawing_.entities.size())) return false;
  if (++visited_ > options_.max_entities)
    return limit(entity,
                 fmt::format("the inserted blocks have more than {} entities", options_.max_entities));
  const Style style = style_of(entity, context);
  if (const auto* block = std::get_if<Boxed<Insert>>(&entity.shape))
    return insert(entity, **block, matrix, context, style);
  visit_({entity, matrix, style, inserts_});
  return true;
}

/// Whether a block can be placed; one diagnostic for each that cannot.
bool Placer::usable(const Entity& entity, const Insert& insert) {
  const Block& block = drawing_.blocks[insert.block];
  std::string problem;
  if (open_[insert.block]) problem = "contains itself; the inner insertion is skipped";
  if (block.external)
    problem = fmt::format("is in another file{}; its insertions are skipped",
                          block.file.empty() ? "" : fmt::format(", {}", block.file));
  if (!block.declared) problem = "is not in the file; its insertions are skipped";
  if (problem.empty()) return true;
  if (!reported_[insert.block])
    diagnostics_.warning(
        codes::dxf_block, origin_of(drawing_, entity),
        fmt::format("block \"{}\" {}; the first is INSERT {} on layer {}", block.name, problem,
                    handle_text(entity.handle), drawing_.layers[entity.layer].name));
  reported_[insert.block] = true;
  return false;
}

bool Placer::insert(const Entity& entity, const Insert& insert, const Matrix& matrix, const Context& context,
                    const Style& style) {
  if (!usable(entity, insert)) return true;
  if (inserts_.size() >= options_.max_depth)
    return limit(entity, fmt::format("blocks are nested more than {} deep", options_.max_depth));
  const Block& block = drawing_.blocks[insert.block];
  const Matrix object = matrix * object_axes(drawing_.extrusions[entity.extrusion]);
  Context inner;
  inner.style = style;
  inner.in_block = true;
  inner.frozen = context.frozen || entity.hidden || drawing_.layers[style.layer].frozen;
  inserts_.push_back(&entity);
  open_[insert.block] = true;
  bool go_on = true;
  for (int row = 0; row < insert.rows && go_on; ++row)
    for (int column = 0; column < insert.columns && go_on; ++column) {
      if (++visited_ > options_.max_entities)
        go_on = limit(entity,
                      fmt::format("the inserted blocks have more than {} entities", options_.max_entities));
      const Matrix placed = object * placement(insert, block.base, column, row);
      for (std::size_t i = 0; i < block.entities.size() && go_on; ++i)
        go_on = this->entity(block.entities[i], placed, inner);
    }
  open_[insert.block] = false;
  inserts_.pop_back();
  return go_on;
}

}  // namespace

bool for_each_placed(const Drawing& drawing, const VisitOptions& options, Diagnostics& diagnostics,
                     const std::function<void(const Placed&)>& visit) {
  return Placer(drawing, options, diagnostics, visit).run();
}

}  // namespace kerf::dxf
