// The order of the operations of a job.
//
// Two rules hold for pairs. What is cut out comes after the work inside of it. Work in the same area, by the
// boxes of the shapes, keeps the order in which it is written; this rule gives way to the first one.
#include "front/cut/order.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "base/names.h"

namespace kerf::cut_detail {
namespace {

constexpr std::size_t kMaxUnits = 10'000;     // of an order by parts; others stay whole
constexpr std::size_t kMaxPairs = 1'000'000;  // of shapes that are compared
constexpr double kBottom = 1e-3;              // mm above the bottom of the stock, where a part is loose

Box2 box_of(const ArtShape& shape) {
  Box2 box;
  if (shape.outline) box.add(bounds(*shape.outline));
  if (shape.point) box.add(*shape.point);
  if (shape.picture) {
    const GreyPicture& pixels = shape.picture->picture;
    const double width = shape.picture->width.mm();
    const double height =
        width * static_cast<double>(pixels.height) / std::max(1.0, static_cast<double>(pixels.width));
    box.add(shape.picture->at);
    box.add(shape.picture->at + Point2{width, height});
  }
  return box;
}

Point2 point_of(const ArtShape& shape) {
  if (shape.point) return *shape.point;
  return shape.outline ? shape.outline->start : box_of(shape).low;
}

bool is_closed(const ArtShape& shape) { return shape.outline && shape.outline->closed(); }

/// Whether an operation makes parts loose: it goes through the stock, or the stock is unknown.
bool cuts_out(const CutOperation& operation, const CutJob& job) {
  if (!operation.row->cuts_out) return false;
  const auto depth = number_of(operation, "depth");
  if (!job.stock_box || !depth || operation.row->laser) return true;
  return number_of(operation, "top").value_or(0.0) - *depth <= job.stock_box->low.z + kBottom;
}

/// The area inside of closed outlines, holes included.
class Inside {
 public:
  explicit Inside(const std::vector<const ArtShape*>& shapes) {
    std::vector<Outline> closed;
    for (const ArtShape* shape : shapes)
      if (is_closed(*shape)) closed.push_back(*shape->outline);
    Diagnostics none;  // what is no region has no inside; the operation reports it
    if (const auto region = closed.empty() ? std::nullopt : make_region(closed, FillRule::nonzero, {}, none))
      box_ = bounds(*region), search_.emplace(*region);
  }
  bool holds(const ArtShape& shape) const {
    const Point2 p = point_of(shape);
    return search_ && box_.contains(Box2{p, p}) && search_->locate(p, Tolerance{}.weld) == Location::inside;
  }

 private:
  Box2 box_;
  std::optional<RegionSearch> search_;
};

/// Whether a shape is something that an operation cuts.
bool is_usable(const CutOperation& operation, const ArtShape& shape) {
  const auto circle = circle_of(shape);
  if (circle) {
    const double diameter = 2.0 * circle->radius.mm();
    if (diameter < number_of(operation, "min-diameter").value_or(0.0)) return false;
    if (diameter > number_of(operation, "max-diameter").value_or(INFINITY)) return false;
  }
  switch (operation.row->input) {
    case CutInput::circles: return circle.has_value() || (shape.point && operation.row->name == "bore");
    case CutInput::points: return circle || shape.point;
    case CutInput::outlines: return shape.outline.has_value();
    case CutInput::region:
    case CutInput::region_or_stock: return is_closed(shape) || (shape.outline && shape.fill.figure != 0);
    default: return true;
  }
}

/// Units with what their order depends on.
class Scheduler {
 public:
  Scheduler(std::vector<CutUnit> units, const CutJob& job, const std::map<int, Tool>& tools)
      : units_(std::move(units)) {
    for (const CutUnit& unit : units_) {
      Work work;
      const auto tool = tools.find(unit.operation->tool);
      const double radius = tool == tools.end() ? 0.0 : 0.5 * tool->second.diameter.mm();
      for (const ArtShape* shape : unit.shapes) {
        const Box2 box = box_of(*shape);
        if (box.empty()) continue;
        work.boxes.push_back(box.grown(radius)), work.box.add(work.boxes.back());
      }
      if (cuts_out(*unit.operation, job)) work.inside.emplace(unit.shapes);
      work_.push_back(std::move(work));
    }
  }

  /// The order; `parts` are those of the units.
  std::vector<std::size_t> run(CutOrder order, const std::vector<std::size_t>& parts) {
    std::vector<std::size_t> made, open(units_.size());
    std::vector<std::size_t> waits(units_.size()), hard(units_.size());
    for (std::size_t i = 0; i < units_.size(); ++i) open[i] = i;
    for (std::size_t a = 0; a < units_.size(); ++a)
      for (std::size_t b = 0; b < units_.size(); ++b) {
        const Rule rule = rule_of(a, b);
        waits[b] += rule != Rule::none, hard[b] += rule == Rule::inside;
      }
    while (!open.empty()) {
      // Of those that wait for nothing, else for no work inside of them, else the first one.
      const auto score = [&](std::size_t i) {
        if (waits[i] != 0) return hard[i] == 0 ? 1 : 0;
        const bool same = !made.empty() && ((order == CutOrder::by_part && parts[i] == parts[made.back()]) ||
                                            (order == CutOrder::by_tool && tool(i) == tool(made.back())));
        return same ? 3 : 2;
      };
      const auto next = std::max_element(open.begin(), open.end(),
                                         [&](std::size_t a, std::size_t b) { return score(a) < score(b); });
      const std::size_t unit = *next;
      open.erase(next);
      made.push_back(unit);
      for (const std::size_t b : open) {
        const Rule rule = rule_of(unit, b);
        waits[b] -= rule != Rule::none, hard[b] -= rule == Rule::inside;
      }
    }
    return made;
  }

  /// Whether unit `a` is work inside of what unit `b` cuts out.
  bool is_inside(std::size_t a, std::size_t b) const {
    if (a == b || units_[a].whole || !work_[b].inside) return false;
    const auto& shapes = units_[a].shapes;
    return std::any_of(shapes.begin(), shapes.end(),
                       [&](const ArtShape* shape) { return work_[b].inside->holds(*shape); });
  }

 private:
  enum class Rule : std::uint8_t { none, written, inside };
  struct Work {
    Box2 box;
    std::vector<Box2> boxes;
    std::optional<Inside> inside;
  };

  int tool(std::size_t i) const { return units_[i].operation->tool; }
  bool meet(std::size_t a, std::size_t b) const {
    if (units_[a].whole || units_[b].whole) return true;
    const Work &first = work_[a], &second = work_[b];
    if (first.boxes.empty() || second.boxes.empty() || !first.box.overlaps(second.box)) return false;
    if (first.boxes.size() * second.boxes.size() > kMaxPairs) return true;
    for (const Box2& one : first.boxes)
      for (const Box2& other : second.boxes)
        if (one.overlaps(other)) return true;
    return false;
  }
  /// Why unit `a` comes before unit `b`.
  Rule rule_of(std::size_t a, std::size_t b) const {
    if (a == b) return Rule::none;
    if (is_inside(a, b) && !is_inside(b, a)) return Rule::inside;
    return a < b && !is_inside(b, a) && meet(a, b) ? Rule::written : Rule::none;
  }

  std::vector<CutUnit> units_;
  std::vector<Work> work_;
};

/// Those of lasers that follow each other by their rows: what is cut out moves.
std::vector<CutUnit> by_rows(std::vector<CutUnit> units) {
  for (auto first = units.begin(); first != units.end();) {
    const bool laser = first->operation->row->laser;
    const auto last =
        std::find_if(first, units.end(), [&](const CutUnit& u) { return u.operation->row->laser != laser; });
    if (laser)
      std::stable_sort(first, last, [](const CutUnit& a, const CutUnit& b) {
        return a.operation->row->order < b.operation->row->order;
      });
    first = last;
  }
  return units;
}

/// The outermost outlines of what is cut out, or without such of all: each is a part with what is inside.
std::vector<const ArtShape*> parts_of(const std::vector<CutUnit>& units, const CutJob& job) {
  std::vector<const ArtShape*> closed;
  for (const bool only_cut_out : {true, false})
    for (const CutUnit& unit : units)
      if (!unit.whole && (only_cut_out ? cuts_out(*unit.operation, job) : closed.empty()))
        for (const ArtShape* shape : unit.shapes)
          if (is_closed(*shape) && std::find(closed.begin(), closed.end(), shape) == closed.end())
            closed.push_back(shape);
  std::vector<const ArtShape*> parts;
  for (const ArtShape* shape : closed) {
    const Box2 box = box_of(*shape);
    const bool is_inner = std::any_of(closed.begin(), closed.end(), [&](const ArtShape* other) {
      return other != shape && box_of(*other).contains(box) && Inside({other}).holds(*shape);
    });
    if (!is_inner) parts.push_back(shape);
  }
  return parts;
}

/// Each operation as one unit for each part, and the number of the part; 0: outside of all.
std::vector<CutUnit> divided(const std::vector<CutUnit>& units, const CutJob& job,
                             std::vector<std::size_t>& part_numbers) {
  const std::vector<const ArtShape*> parts = parts_of(units, job);
  std::vector<Inside> areas;
  for (const ArtShape* part : parts) areas.emplace_back(std::vector{part});
  std::vector<CutUnit> made;
  for (const CutUnit& unit : units) {
    std::map<std::size_t, CutUnit> pieces;
    for (const ArtShape* shape : unit.shapes) {
      std::size_t part = 0;
      for (std::size_t i = 0; i < parts.size() && part == 0; ++i)
        if (parts[i] == shape || areas[i].holds(*shape)) part = i + 1;
      if (is_usable(*unit.operation, *shape))
        pieces.try_emplace(part, CutUnit{unit.operation, {}, false}).first->second.shapes.push_back(shape);
    }
    if (unit.whole || pieces.empty() || made.size() + pieces.size() > kMaxUnits) {
      made.push_back(unit), part_numbers.push_back(0);
      continue;
    }
    for (auto& [part, piece] : pieces) made.push_back(std::move(piece)), part_numbers.push_back(part);
  }
  return made;
}

/// Of the order as written: work inside of what is loose by then. One warning for each operation.
void warn_of_loose(const Scheduler& scheduler, const std::vector<CutUnit>& units, Diagnostics& diagnostics) {
  std::vector<std::pair<const CutOperation*, std::vector<std::string>>> found;
  for (std::size_t b = 1; b < units.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      if (!scheduler.is_inside(b, a) || scheduler.is_inside(a, b)) continue;
      if (found.empty() || found.back().first != units[b].operation)
        found.emplace_back(units[b].operation, std::vector<std::string>{});
      std::vector<std::string>& names = found.back().second;
      const std::string& name = units[a].operation->name;
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  for (const auto& [operation, names] : found)
    diagnostics
        .warning(codes::cut_job_order, operation->where,
                 fmt::format("{} works inside of what {} cut out before", operation->name,
                             joined(names, ", ") + (names.size() == 1 ? " has" : " have")))
        .hint = "order = \"inner-first\"";
}

}  // namespace

std::vector<CutUnit> in_order(const std::vector<CutUnit>& written, const CutJob& job,
                              const std::map<int, Tool>& tools, Diagnostics& diagnostics) {
  const bool has_cut_out = std::any_of(written.begin(), written.end(),
                                       [&](const CutUnit& unit) { return cuts_out(*unit.operation, job); });
  std::vector<std::size_t> parts(written.size());
  std::vector<CutUnit> units;
  if (job.layout.order == CutOrder::by_part)
    parts.clear(), units = divided(by_rows(written), job, parts);
  else
    units = by_rows(written);
  if (!has_cut_out && job.layout.order != CutOrder::by_tool && job.layout.order != CutOrder::by_part)
    return units;
  Scheduler scheduler(units, job, tools);
  if (job.layout.order == CutOrder::as_written) {
    warn_of_loose(scheduler, units, diagnostics);
    return units;
  }
  std::vector<CutUnit> made;
  for (const std::size_t i : scheduler.run(job.layout.order, parts)) made.push_back(std::move(units[i]));
  return made;
}

}  // namespace kerf::cut_detail
