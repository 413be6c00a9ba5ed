// How rows of operations and of shapes get their keys: each sets a member of an options struct, whose type
// gives the unit and the check, and whose initializer is the default.
#pragma once

#include <cmath>
#include <type_traits>
#include <utility>

#include "base/names.h"
#include "base/number.h"
#include "base/quantity.h"

#include "kerf/op/operation.h"
#include "kerf/op/rows.h"

namespace kerf::op_detail {

template <class Value>
using Names = std::vector<std::pair<std::string_view, Value>>;

/// Shapes of examples.
constexpr std::string_view kFrameShape =
    "[[shape]]                 # shapes of the job itself, besides those of art\n"
    "name = \"frame\"\n"
    "rectangle = [0, 0, 60, 40]\n\n";
constexpr std::string_view kPlateShapes =
    "[[shape]]                 # shapes of the job itself, besides those of art\n"
    "name = \"frame\"\n"
    "rectangle = [0, 0, 60, 40]\n"
    "corner = 8                # radius\n\n"
    "[[shape]]\n"
    "name = \"hole\"\n"
    "circle = [30, 20, 16]     # x, y, diameter; polygon, line = [[x, y], ...]; point = [x, y]\n\n";
constexpr std::string_view kStarShape =
    "[[shape]]                 # shapes of the job itself, besides those of art\n"
    "name = \"star\"\n"
    "polygon = [[0, 14], [18, 14], [24, 0], [30, 14], [48, 14], [34, 24], [39, 40], [24, 30], [9, 40], "
    "[14, 24]]\n\n";
constexpr std::string_view kLineAndText =
    "[[shape]]                 # shapes of the job itself, besides those of art\n"
    "name = \"arrow\"\n"
    "line = [[0, 0], [40, 0], [30, 8]]\n\n"
    "[[shape]]\n"
    "text = \"KERF\"            # font, text-angle, align, letter-spacing\n"
    "height = 8                # of capital letters\n"
    "at = [0, 12]              # start of the baseline\n\n";

constexpr CutRange above(double low) { return {.low = low, .above = true}; }
constexpr CutRange at_least(double low) { return {.low = low}; }
constexpr CutRange within(double low, double high) { return {low, high, false}; }

/// Numbers of keys as values of options and back.
template <class Value>
struct InUnit {
  static constexpr std::string_view kUnit{};
  static Value made(double v) { return static_cast<Value>(v); }
  static double number(Value v) { return static_cast<double>(v); }
};
template <>
struct InUnit<Length> {
  static constexpr std::string_view kUnit = "mm";
  static Length made(double v) { return mm(v); }
  static double number(Length v) { return v.mm(); }
};
template <>
struct InUnit<Feed> {
  static constexpr std::string_view kUnit = "mm/min";
  static Feed made(double v) { return mm_per_min(v); }
  static double number(Feed v) { return v.mm_per_min(); }
};
template <>
struct InUnit<Angle> {
  static constexpr std::string_view kUnit = "degrees";
  static Angle made(double v) { return degrees(v); }
  static double number(Angle v) { return v.deg(); }
};
template <>
struct InUnit<Duration> {
  static constexpr std::string_view kUnit = "s";
  static Duration made(double v) { return seconds(v); }
  static double number(Duration v) { return v.seconds(); }
};
template <>
struct InUnit<SpindleSpeed> {
  static constexpr std::string_view kUnit = "rpm";
  static SpindleSpeed made(double v) { return rpm(v); }
  static double number(SpindleSpeed v) { return v.rpm(); }
};

template <class Value>
struct Bare {
  using type = Value;
  static constexpr bool kOptional = false;
};
template <class Value>
struct Bare<std::optional<Value>> {
  using type = Value;
  static constexpr bool kOptional = true;
};

/// "10, 1/4in" as a point.
inline std::optional<Point2> point_of(const CutValue& value) {
  if (const auto* list = std::get_if<std::vector<double>>(&value))
    return list->size() == 2 ? std::optional(Point2{(*list)[0], (*list)[1]}) : std::nullopt;
  std::vector<std::string> parts;
  if (const auto* list = std::get_if<std::vector<std::string>>(&value)) parts = *list;
  if (const auto* text = std::get_if<std::string>(&value))
    if (const std::size_t comma = text->find(','); comma != std::string::npos)
      parts = {text->substr(0, comma), text->substr(comma + 1)};
  if (parts.size() != 2) return std::nullopt;
  std::string fault;
  const auto x = read_quantity(parts[0], "mm", {}, fault), y = read_quantity(parts[1], "mm", {}, fault);
  return x && y ? std::optional(Point2{*x, *y}) : std::nullopt;
}

/// The number of a value, if it is one that the key may have.
inline std::optional<double> number_within(const CutKeyText& key, const CutValue& value) {
  std::string fault;
  std::optional<double> given;
  if (const double* number = std::get_if<double>(&value)) given = *number;
  if (const auto* text = std::get_if<std::string>(&value)) given = read_quantity(*text, key.unit, {}, fault);
  if (!given || !std::isfinite(*given)) return std::nullopt;
  const bool whole = key.type != CutKeyText::Type::number;
  const bool low = key.range.above ? *given > key.range.low : *given >= key.range.low;
  if (!low || *given > key.range.high || (whole && *given != std::floor(*given))) return std::nullopt;
  return given;
}

inline bool set_text(std::string& target, const CutValue& value) {
  const auto* given = std::get_if<std::string>(&value);
  if (given != nullptr) target = *given;
  return given != nullptr && !given->empty();
}
inline bool set_list(std::vector<std::string>& target, const CutValue& value) {
  if (const auto* one = std::get_if<std::string>(&value)) target = {*one};
  const auto* many = std::get_if<std::vector<std::string>>(&value);
  if (many != nullptr) target = *many;
  return (std::holds_alternative<std::string>(value) || many != nullptr) && !target.empty();
}
inline bool set_point(Point2& target, const CutValue& value) {
  const auto given = point_of(value);
  if (!given ||
      !(std::abs(given->x) <= limits::kMaxCoordinate && std::abs(given->y) <= limits::kMaxCoordinate))
    return false;
  target = *given;
  return true;
}

/// How a key finds the value that it sets. A pointer, so that keys of one type of value share their code.
template <class Target, class Held>
using Access = Held& (*)(Target&);

template <class Target, class Held>
const Held& seen(Access<Target, Held> access, const Target& target) {
  return access(const_cast<Target&>(target));
}

/// The key of a number with a unit, or of none.
template <class Target, class Held>
void make_number_key(CutKeyOf<Target>& key, Access<Target, Held> access) {
  using Value = typename Bare<Held>::type;
  using Type = CutKeyText::Type;
  if (key.unit.empty()) key.unit = InUnit<Value>::kUnit;
  if (std::is_integral_v<Value> && key.type == Type::number) key.type = Type::whole;
  const double factor = key.unit == "%" ? 100.0 : 1.0;
  const CutKeyText rule = key;
  key.set = [access, rule, factor](Target& t, const CutValue& v) {
    const auto given = number_within(rule, v);
    if (given) access(t) = InUnit<Value>::made(*given / factor);
    return given.has_value();
  };
  key.get = [access, factor](const Target& t) -> std::optional<CutValue> {
    const Held& held = seen(access, t);
    if constexpr (Bare<Held>::kOptional)
      return held ? std::optional<CutValue>(factor * InUnit<Value>::number(*held)) : std::nullopt;
    else
      return factor * InUnit<Value>::number(held);
  };
}

template <class Target, class Held>
void make_point_key(CutKeyOf<Target>& key, Access<Target, Held> access) {
  key.type = CutKeyText::Type::point;
  key.set = [access](Target& t, const CutValue& v) {
    Point2 given;
    const bool good = set_point(given, v);
    if (good) access(t) = given;
    return good;
  };
  key.get = [access](const Target& t) -> std::optional<CutValue> {
    if constexpr (Bare<Held>::kOptional)
      if (!seen(access, t)) return std::nullopt;
    const Point2 held = *std::optional<Point2>(seen(access, t));
    return CutValue(std::vector<double>{held.x, held.y});
  };
}

/// The key that sets what `access` returns.
template <class Target, class Held>
CutKeyOf<Target> key_of(const CutKeyText& text, Access<Target, Held> access) {
  using Type = CutKeyText::Type;
  using Value = typename Bare<Held>::type;
  CutKeyOf<Target> key{text, {}, {}};
  if constexpr (std::is_same_v<Value, std::string>) {
    key.type = Type::text;
    key.set = [access](Target& t, const CutValue& v) { return set_text(access(t), v); };
    key.get = [access](const Target& t) { return std::optional<CutValue>(seen(access, t)); };
  } else if constexpr (std::is_same_v<Value, std::vector<std::string>>) {
    key.type = Type::list;
    key.set = [access](Target& t, const CutValue& v) { return set_list(access(t), v); };
    key.get = [access](const Target& t) { return std::optional<CutValue>(seen(access, t)); };
  } else if constexpr (std::is_same_v<Value, Point2>) {
    make_point_key(key, access);
  } else {
    make_number_key(key, access);
  }
  return key;
}

/// The key that chooses one of the named values for what `access` returns.
template <class Target, class Held>
CutKeyOf<Target> key_of(const CutKeyText& text, Access<Target, Held> access, const Names<Held>& names) {
  CutKeyOf<Target> key{text, {}, {}};
  key.type = CutKeyText::Type::choice;
  for (const auto& row : names) key.choices.push_back(row.first);
  key.set = [access, names](Target& t, const CutValue& v) {
    const auto* given = std::get_if<std::string>(&v);
    for (const auto& [name, value] : names)
      if (given != nullptr && fold_name(name) == fold_name(*given)) {
        access(t) = value;
        return true;
      }
    return false;
  };
  key.get = [access, names](const Target& t) -> std::optional<CutValue> {
    for (const auto& [name, value] : names)
      if (value == seen(access, t)) return CutValue(std::string(name));
    return std::nullopt;
  };
  return key;
}

/// The key that sets `member(target)`, where `member` is a lambda without captures.
template <class Target, class Member, class... More>
CutKeyOf<Target> key_at(const CutKeyText& text, Member member, const More&... more) {
  using Held = std::remove_reference_t<decltype(member(std::declval<Target&>()))>;
  return key_of(text, Access<Target, Held>(member), more...);
}

/// Keys of an operation with options of type `Options`, which has a member `cut` for those of mills.
template <class Options>
class Keys {
 public:
  template <class Member, class... More>
  Keys& add(const CutKeyText& text, Member, const More&... more) {
    const auto inside = [](CutOperation & o) -> auto& {
      return Member{}(*std::any_cast<Options>(&o.options));
    };
    keys_.push_back(key_at<CutOperation>(text, inside, more...));
    return *this;
  }
  /// The name, and which shapes.
  Keys& selection(const CutKeyText& outlines = {}) {
    const CutKeyText usual{.name = "outlines",
                           .meaning = "names of the outlines that are used, as kerf outline reports them",
                           .example = "[\"CUT.1\"]",
                           .as_comment = true};
    return name()
        .common(
            {.name = "layers",
             .meaning = "layers of the drawing whose shapes are used; none: all",
             .example = "[\"CUT\"]",
             .as_comment = true},
            [](CutOperation & o) -> auto& { return o.layers; })
        .common(
            outlines.name.empty() ? usual : outlines, [](CutOperation & o) -> auto& { return o.outlines; });
  }
  Keys& name() {
    return common(
        {.name = "name",
         .meaning = "name of the operation, in messages and in the program",
         .example = "\"left pocket\"",
         .as_comment = true},
        [](CutOperation & o) -> auto& { return o.name; });
  }
  Keys& tool() {
    return common(
               {.name = "tool",
                .meaning = "number of the tool",
                .example = "1",
                .range = within(0, limits::kMaxToolNumber),
                .required = true,
                .type = CutKeyText::Type::tool},
               [](CutOperation & o) -> auto& { return o.tool; })
        .common(
            {.name = "rpm",
             .meaning = "spindle speed, clockwise; 0: none",
             .example = "16000",
             .range = within(0, limits::kMaxSpeed)},
            [](CutOperation & o) -> auto& { return o.speed; })
        .common(
            {.name = "coolant", .meaning = "coolant while the operation cuts"},
            [](CutOperation & o) -> auto& { return o.coolant; },
            Names<CutCoolant>{
                {"none", CutCoolant::none}, {"mist", CutCoolant::mist}, {"flood", CutCoolant::flood}});
  }
  /// The surface, and the depth below it.
  Keys& levels(std::string_view depth = "6") {
    return top()
        .add(
            {.name = "depth",
             .meaning = "below the surface",
             .example = depth,
             .range = above(0),
             .required = true},
            [](Options & o) -> auto& { return frame(o).depth; })
        .common(
            {.name = "through",
             .meaning = "instead of depth: through the stock, and this far into what is below",
             .example = "0.2",
             .range = at_least(0),
             .as_comment = true},
            [](CutOperation & o) -> auto& { return o.through; });
  }
  /// Where the operation itself finds the depth.
  Keys& own_depth(std::string_view example, std::string_view otherwise) {
    return add(
        {.name = "depth",
         .meaning = "below the surface",
         .example = example,
         .range = at_least(0),
         .otherwise = otherwise},
        [](Options & o) -> auto& { return frame(o).depth; });
  }
  Keys& top() {
    return add(
        {.name = "top", .meaning = "Z of the surface of the material", .example = "0", .unit = "mm"},
        [](Options & o) -> auto& { return frame(o).top; });
  }
  Keys& stepdown(std::string_view example = "2") {
    return add(
        {.name = "stepdown",
         .meaning = "maximum depth of a pass; 0: one pass",
         .example = example,
         .range = at_least(0)},
        [](Options & o) -> auto& { return o.cut.stepdown; });
  }
  Keys& stepover(std::string_view example = "0.4") {
    return add(
        {.name = "stepover",
         .meaning = "distance of paths as a fraction of the diameter of the tool",
         .example = example,
         .range = {0, 1, true}},
        [](Options & o) -> auto& { return o.stepover; });
  }
  /// Feeds, and the levels of rapids.
  Keys& rates() {
    return feed()
        .add(
            {.name = "plunge",
             .meaning = "maximum feed downwards; 0: half of feed",
             .example = "300",
             .range = at_least(0)},
            [](Options & o) -> auto& { return o.cut.plunge; })
        .retract()
        .clearance();
  }
  Keys& feed() {
    return add(
               {.name = "feed",
                .meaning = "feed of cuts",
                .example = "900",
                .range = above(0),
                .otherwise = "by the chip load in material"},
               [](Options & o) -> auto& { return frame(o).feed; })
        .chip_load();
  }
  Keys& clearance() {
    return add(
        {.name = "clearance",
         .meaning = "above material, where rapids downwards end",
         .example = "0.5",
         .range = at_least(0)},
        [](Options & o) -> auto& { return frame(o).clearance; });
  }
  Keys& chip_load() {
    return common(
               {.name = "material",
                .meaning = "for a feed that is not given: MDF, plywood, softwood, aluminium ...",
                .example = "\"MDF\"",
                .as_comment = true},
               [](CutOperation & o) -> auto& { return o.material; })
        .common(
            {.name = "machine",
             .meaning = "file of the machine whose limits a chosen feed keeps",
             .example = "\"router.toml\"",
             .as_comment = true},
            [](CutOperation & o) -> auto& { return o.machine; });
  }
  Keys& retract() {
    return common(
        {.name = "retract",
         .meaning = "Z of rapids between cuts",
         .example = "5",
         .otherwise = "5 mm above the highest surface",
         .unit = "mm"},
        [](CutOperation & o) -> auto& { return o.retract; });
  }
  Keys& allowance() {
    return add(
        {.name = "allowance",
         .meaning = "left on walls for a finishing pass",
         .example = "0",
         .range = at_least(0)},
        [](Options & o) -> auto& { return o.cut.allowance; });
  }
  Keys& direction() {
    return add(
        {.name = "direction", .meaning = "direction along walls, of a clockwise spindle"},
        [](Options & o) -> auto& { return o.cut.direction; },
        Names<CutDirection>{{"climb", CutDirection::climb}, {"conventional", CutDirection::conventional}});
  }
  Keys& entry_angle() {
    return add(
        {.name = "entry-angle",
         .meaning = "maximum descent of a ramp or helix",
         .example = "3",
         .range = within(0.5, 89)},
        [](Options & o) -> auto& { return o.cut.entry.angle; });
  }
  Keys& entry() {
    return add(
               {.name = "entry", .meaning = "how the tool enters the material"},
               [](Options & o) -> auto& { return o.cut.entry.kind; },
               Names<EntryKind>{
                   {"helix", EntryKind::helix}, {"ramp", EntryKind::ramp}, {"plunge", EntryKind::plunge}})
        .entry_angle()
        .add(
            {.name = "helix-radius",
             .meaning = "radius of a helix, of the tool's axis; 0: 0.45 times the diameter",
             .example = "0",
             .range = at_least(0)},
            [](Options & o) -> auto& { return o.cut.entry.radius; });
  }
  Keys& side(std::string_view meaning) {
    return add(
        {.name = "side", .meaning = meaning}, [](Options & o) -> auto& { return o.side; },
        Names<ContourSide>{{"outside", ContourSide::outside}, {"inside", ContourSide::inside}});
  }
  /// Leads of a closed path: members lead, lead_out and lead_kind.
  Keys& leads(std::string_view example) {
    return add(
               {.name = "lead",
                .meaning = "radius or length of the lead-in and lead-out; 0: none",
                .example = example,
                .range = at_least(0)},
               [](Options & o) -> auto& { return o.lead; })
        .add(
            {.name = "lead-out",
             .meaning = "size of the lead-out, where it differs",
             .example = "0",
             .range = at_least(0),
             .otherwise = "as lead"},
            [](Options & o) -> auto& { return o.lead_size_out; })
        .add(
            {.name = "lead-kind", .meaning = "arcs tangent to the wall, or lines square to it"},
            [](Options & o) -> auto& { return o.lead_kind; },
            Names<LeadKind>{{"arc", LeadKind::arc}, {"line", LeadKind::line}})
        .add(
            {.name = "overlap",
             .meaning = "how far the path continues beyond its start",
             .example = "0",
             .range = at_least(0)},
            [](Options & o) -> auto& { return o.overlap; });
  }
  Keys& finish() {
    return add(
        {.name = "finish",
         .meaning = "left on walls, and removed by a last pass at the full depth",
         .example = "0",
         .range = at_least(0)},
        [](Options & o) -> auto& { return o.finish; });
  }
  Keys& tabs() {
    return add(
               {.name = "tab-height",
                .meaning = "height of tabs above the bottom; 0: no tabs",
                .example = "0",
                .range = at_least(0)},
               [](Options & o) -> auto& { return o.tabs.height; })
        .add(
            {.name = "tab-length",
             .meaning = "length of tabs; 0: the diameter of the tool",
             .example = "6",
             .range = at_least(0),
             .needs = "tab-height"},
            [](Options & o) -> auto& { return o.tabs.length; })
        .add(
            {.name = "tabs",
             .meaning = "number of tabs on each contour",
             .example = "4",
             .range = within(1, 1000),
             .needs = "tab-height"},
            [](Options & o) -> auto& { return o.tabs.count; })
        .add(
            {.name = "tab-spacing",
             .meaning = "distance of tabs; 0: by their number",
             .example = "0",
             .range = at_least(0),
             .needs = "tab-height"},
            [](Options & o) -> auto& { return o.tabs.spacing; })
        .add(
            {.name = "tab-shape", .meaning = "shape of tabs", .needs = "tab-height"},
            [](Options & o) -> auto& { return o.tabs.shape; },
            Names<TabShape>{{"rectangular", TabShape::rectangular}, {"triangular", TabShape::triangular}});
  }
  Keys& combine() {
    keys_.push_back(key_at<CutOperation>(
        {.name = "combine",
         .meaning =
             "overlapping shapes: as the drawing fills them, those inside others as holes, or all united"},
        [](CutOperation & o) -> auto& { return o.combining; },
        Names<Combining>{
            {"drawn", Combining::drawn}, {"nested", Combining::nested}, {"united", Combining::united}}));
    return *this;
  }
  Keys& rest_tool() {
    return add(
        {.name = "rest-tool",
         .meaning = "the tool of the same operation before: only what it left is cut",
         .example = "2",
         .range = within(0, limits::kMaxToolNumber),
         .as_comment = true,
         .type = CutKeyText::Type::tool},
        [](Options & o) -> auto& { return o.rest_tool; });
  }
  std::vector<CutKey> list() const { return keys_; }

 private:
  template <class Member, class... More>
  Keys& common(const CutKeyText& text, Member member, const More&... more) {
    keys_.push_back(key_at<CutOperation>(text, member, more...));
    return *this;
  }
  /// What all operations of mills have in common: `cut`, but for drilling.
  static auto& frame(Options& o) {
    if constexpr (requires { o.cut; })
      return o.cut;
    else
      return o;
  }
  std::vector<CutKey> keys_;
};

/// Of closed paths: how leads are given by keys.
struct LeadKeys {
  Length lead{};
  std::optional<Length> lead_size_out{};  ///< nothing: as `lead`
  LeadKind lead_kind = LeadKind::arc;

  Lead in() const { return {lead_kind, lead}; }
  Lead out() const { return {lead_kind, lead_size_out.value_or(lead)}; }
};

/// Completes the options by what holds for the whole program.
template <class Options>
void complete(Options& options, const CutWork& work) {
  if constexpr (requires { options.cut; }) {
    complete(options.cut, work);
  } else if constexpr (requires { options.laser; }) {
    complete(options.laser, work);
  } else {
    options.name = work.operation.name, options.where = work.operation.where;
    if constexpr (requires { options.max_steps; }) options.max_steps = work.operation.max_steps;
    if constexpr (requires { options.progress; }) options.progress = work.progress;
    if constexpr (requires { options.retract_plane; }) options.retract_plane = work.retract_plane;
  }
}

/// The row of an operation that `run(options, work, diagnostics)` makes.
template <class Options, class Run>
CutRow row_of(CutRow row, const Keys<Options>& keys, Run run) {
  row.keys = keys.list();
  row.options = [] { return std::any(Options{}); };
  row.run = [run](const CutWork& work, Diagnostics& diagnostics) -> std::optional<Operation> {
    Options options = std::any_cast<const Options&>(work.operation.options);
    complete(options, work);
    return run(options, work, diagnostics);
  };
  return row;
}

}  // namespace kerf::op_detail
