// All changes that can be made to a finished program, and the table of their options.
#include "kerf/op/rework.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <type_traits>
#include <utility>

#include "base/codes/op.h"
#include "base/names.h"
#include "base/number.h"
#include "base/quantity.h"
#include "op/base/upwards.h"

namespace kerf {
namespace {

using Options = ReworkOptions;
constexpr std::size_t kShown = 60;  // characters of a value in messages

std::optional<double> number_in(std::string_view text, std::string_view unit) {
  std::string fault;
  return read_quantity(text, unit, {}, fault);
}

/// A number, or a text with one in this unit or in another one.
std::optional<double> number(const CutValue& value, std::string_view unit) {
  const auto* text = std::get_if<std::string>(&value);
  const double* given = std::get_if<double>(&value);
  const auto made = text != nullptr    ? number_in(*text, unit)
                    : given != nullptr ? std::optional(*given)
                                       : std::nullopt;
  return made && std::isfinite(*made) ? made : std::nullopt;
}

/// `least` to `max` lengths: a list of them, or a text.
std::optional<std::vector<double>> numbers(const CutValue& value, std::size_t least, std::size_t max) {
  std::vector<double> values;
  if (const auto* list = std::get_if<std::vector<double>>(&value)) values = *list;
  if (const auto* list = std::get_if<std::vector<std::string>>(&value))
    for (const std::string& text : *list) values.push_back(number_in(text, "mm").value_or(NAN));
  if (const auto* text = std::get_if<std::string>(&value))
    for (std::string_view rest = *text; values.size() <= max;) {
      const std::size_t comma = std::min(rest.find(','), rest.size());
      values.push_back(number_in(rest.substr(0, comma), "mm").value_or(NAN));
      if (comma == rest.size()) break;
      rest.remove_prefix(comma + 1);
    }
  const bool finite = std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  return finite && values.size() >= least && values.size() <= max ? std::optional(values) : std::nullopt;
}

double plain(double v) { return v; }
/// A Z, in mm.
struct Height {
  double z;
  operator double() const { return z; }
};
Height height(double z) { return {z}; }

/// Stores a number from `low` to `high`, made by `make`. As all setters: empty, or what the value can be.
template <class Target, class Make>
std::string store(Target& target, const CutValue& given, double low, double high, Make make) {
  using Made = std::invoke_result_t<Make, double>;
  constexpr bool kLength = std::is_same_v<Made, Length> || std::is_same_v<Made, Height>;
  constexpr std::string_view kUnit = kLength ? "mm" : std::is_same_v<Made, Angle> ? "degrees" : "";
  const auto value = number(given, kUnit);
  if (!value || !(*value >= low && *value <= high))
    return fmt::format("a number from {} to {}", number_text(low, 6), number_text(high, 6));
  target = make(*value);
  return {};
}

template <class Whole>
std::string store_whole(Whole& target, const CutValue& given, double high) {
  const auto value = number(given, "");
  if (!value || !(*value >= 1.0 && *value <= high) || *value != std::floor(*value))
    return fmt::format("a whole number from 1 to {}", number_text(high, 0));
  target = static_cast<Whole>(*value);
  return {};
}

template <class Value>
std::string choose(Value& target, const CutValue& given,
                   std::initializer_list<std::pair<std::string_view, Value>> rows) {
  std::vector<std::string> names;
  for (const auto& [name, value] : rows) {
    if (const auto* text = std::get_if<std::string>(&given);
        text != nullptr && fold_name(name) == fold_name(*text)) {
      target = value;
      return {};
    }
    names.emplace_back(name);
  }
  return list_text(names);
}

std::string set_move(Options& o, const CutValue& given) {
  const auto v = numbers(given, 2, 3);
  if (!v) return "two or three numbers";
  o.transform.move = {(*v)[0], (*v)[1], v->size() > 2 ? (*v)[2] : 0.0};
  return {};
}
std::string set_point(Point2& target, const CutValue& given) {
  const auto v = numbers(given, 2, 2);
  if (!v) return "two numbers";
  target = {(*v)[0], (*v)[1]};
  return {};
}
std::optional<Point2> point_of(std::string_view text) {
  const auto v = numbers(std::string(text), 2, 2);
  return v ? std::optional(Point2{(*v)[0], (*v)[1]}) : std::nullopt;
}

/// "X,Y=X,Y", "X,Y=X,Y/X,Y/X,Y" (a hole), "corner=..." or "corner X,Y=..." (a corner).
std::optional<AlignPoint> align_point_of(std::string_view text) {
  constexpr std::string_view kCorner = "corner";
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  std::string_view at = trim(text.substr(0, equals)), rest = text.substr(equals + 1);
  AlignPoint made;
  if (at.substr(0, kCorner.size()) == kCorner) made.is_corner = true, at = trim(at.substr(kCorner.size()));
  if (const auto point = point_of(made.is_corner && at.empty() ? "0,0" : at))
    made.at = *point;
  else
    return std::nullopt;
  for (std::size_t end = 0; end != std::string_view::npos; rest.remove_prefix(end + 1)) {
    end = rest.find('/');
    const auto measured = point_of(rest.substr(0, end));
    if (!measured || made.measured.size() == 3) return std::nullopt;
    made.measured.push_back(*measured);
    if (end == std::string_view::npos) break;
  }
  const std::size_t count = made.measured.size();
  return count == 3 || (count == 1 && !made.is_corner) ? std::optional(made) : std::nullopt;
}
std::string set_align(Options& o, const CutValue& given) {
  constexpr std::string_view kForms =
      "X,Y=X,Y for each point, separated by semicolons: its position in the program and as measured, or "
      "after "
      "the "
      "= three points around a hole as X,Y/X,Y/X,Y; or corner=X,Y/X,Y/X,Y";
  const auto* text = std::get_if<std::string>(&given);
  if (text == nullptr) return std::string(kForms);
  o.align.points.clear();
  for (std::string_view rest = *text;;) {
    const std::size_t end = std::min(rest.find(';'), rest.size());
    auto point = align_point_of(rest.substr(0, end));
    if (!point) return std::string(kForms);
    o.align.points.push_back(std::move(*point));
    if (end == rest.size()) return {};
    rest.remove_prefix(end + 1);
  }
}
/// A diameter, also as "d=40".
std::string set_wrap(Options& o, const CutValue& given) {
  const auto* text = std::get_if<std::string>(&given);
  const bool named = text != nullptr && trim(*text).substr(0, 2) == "d=";
  const CutValue value = named ? CutValue(std::string(trim(*text).substr(2))) : given;
  return store(o.wrap.diameter, value, 1e-3, 1e4, mm);
}
std::string set_flag(bool& target) {
  target = true;
  return {};
}

using Given = const CutValue&;

const std::vector<ReworkKey>& passes_of_cuts() {
  static const std::vector<ReworkKey> keys{
      {"step-down", "MM", "Cut in passes of at max MM depth",
       [](Options& o, Given t) { return store(o.passes.stepdown, t, 1e-3, 1e4, mm); }},
      {"top", "Z", "Surface of the material, for --step-down, --entry, --lead and --finish (default 0)",
       [](Options& o, Given t) { return store(o.passes.top, t, -1e4, 1e4, height); }},
      {"entry", "KIND", "Entry of cuts that start with a plunge: plunge, ramp or helix",
       [](Options& o, Given t) {
         return choose(
             o.passes.entry, t,
             {{"plunge", EntryKind::plunge}, {"ramp", EntryKind::ramp}, {"helix", EntryKind::helix}});
       }},
      {"entry-angle", "DEGREES", "Maximum descent of ramps and helices (default 3)",
       [](Options& o, Given t) { return store(o.passes.entry_angle, t, 0.1, 89, degrees); }, "entry"},
      {"from-line", "LINE", "Resume from a line: tool, spindle, a safe approach, and the rest",
       [](Options& o, Given t) { return store_whole(o.resume.line, t, 4e9); }, "safe-z"},
      {"safe-z", "Z", "Height of the approach for --from-line; required with it",
       [](Options& o, Given t) { return store(o.resume.safe_z, t, -1e4, 1e4, height); }, "from-line"},
      {"tab-height", "MM", "Leave tabs of this height on closed paths that are cut to the lowest level",
       [](Options& o, Given t) { return store(o.tabs.height, t, 1e-3, 1e4, mm); }},
      {"tab-length", "MM", "Length of tabs (default: the diameter of the tool)",
       [](Options& o, Given t) { return store(o.tabs.length, t, 1e-3, 1e4, mm); }, "tab-height"},
      {"tabs", "N", "Number of tabs on each path (default 4)",
       [](Options& o, Given t) { return store_whole(o.tabs.count, t, 1000); }, "tab-height"},
      {"tab-spacing", "MM", "Distance of tabs, instead of their number",
       [](Options& o, Given t) { return store(o.tabs.spacing, t, 1e-3, 1e4, mm); }, "tab-height"},
      {"tab-shape", "SHAPE", "rectangular or triangular",
       [](Options& o, Given t) {
         return choose(o.tabs.shape, t,
                       {{"rectangular", TabShape::rectangular}, {"triangular", TabShape::triangular}});
       },
       "tab-height"}};
  return keys;
}

const std::vector<ReworkKey>& passes_of_closed_paths() {
  static const std::vector<ReworkKey> keys{
      {"helix-radius", "MM",
       "Radius of the tool's axis in a helix (default: 0.45 times the diameter of the tool)",
       [](Options& o, Given t) { return store(o.passes.helix_radius, t, 1e-3, 1e3, mm); }, "entry"},
      {"part", "SIDE", "Side of the path on which the part is: right (default: climb) or left",
       [](Options& o, Given t) {
         return choose(o.passes.part, t, {{"right", PartSide::right}, {"left", PartSide::left}});
       }},
      {"lead", "MM", "Lead-in and lead-out of closed paths: the radius of arcs, the length of lines",
       [](Options& o, Given t) { return store(o.leads.lead_in.size, t, 1e-3, 1e3, mm); }},
      {"lead-out", "MM", "Another size of the lead-out; 0: none",
       [](Options& o, Given t) {
         o.leads.lead_out.kind = LeadKind::arc;
         return store(o.leads.lead_out.size, t, 0, 1e3, mm);
       }},
      {"lead-kind", "KIND", "arc (default) or line",
       [](Options& o, Given t) {
         return choose(o.leads.lead_in.kind, t, {{"arc", LeadKind::arc}, {"line", LeadKind::line}});
       }},
      {"overlap", "MM", "How far the tool continues along a closed path beyond its start",
       [](Options& o, Given t) { return store(o.leads.overlap, t, 1e-3, 1e3, mm); }},
      {"finish", "MM", "Left on the part by all passes of closed paths, removed by one at the full depth",
       [](Options& o, Given t) { return store(o.leads.finish, t, 1e-3, 1e3, mm); }}};
  return keys;
}

const std::vector<ReworkKey>& keys_of_placement() {
  static const std::vector<ReworkKey> keys{
      {"order", "", "Order cuts by short rapids, inner contours before those around them",
       [](Options& o, Given) { return set_flag(o.order); }},
      {"scale", "FACTOR", "Scale X and Y",
       [](Options& o, Given t) { return store(o.transform.scale, t, 1e-6, 1e6, plain); }},
      {"mirror", "AXIS", "x or y changes its sign; climb becomes conventional, unless loops are reversed",
       [](Options& o, Given t) {
         return choose(o.transform.mirror, t, {{"x", Mirror::x}, {"y", Mirror::y}});
       }},
      {"rotate", "DEGREES", "Rotate counter-clockwise",
       [](Options& o, Given t) { return store(o.transform.rotate, t, -1e6, 1e6, degrees); }},
      {"centre", "X,Y", "Of --scale, --mirror and --rotate (default 0,0)",
       [](Options& o, Given t) { return set_point(o.transform.centre, t); }},
      {"move", "X,Y[,Z]", "Move by these distances in mm", set_move},
      {"reverse-loops", "", "Cut closed paths in the opposite direction",
       [](Options& o, Given) { return set_flag(o.reverse_loops); }},
      {"columns", "N", "Repeat N times along X",
       [](Options& o, Given t) { return store_whole(o.copies.columns, t, 1e4); }},
      {"rows", "N", "Repeat N times along Y",
       [](Options& o, Given t) { return store_whole(o.copies.rows, t, 1e4); }},
      {"pitch", "X,Y", "Distances of columns and rows in mm",
       [](Options& o, Given t) { return set_point(o.copies.pitch, t); }},
      {"align", "POINTS", "Rotate and move to where probed points are: X,Y=X,Y of each, separated by ;",
       set_align},
      {"align-probe", "MM", "Diameter of the probe that touched the edges of a corner, for --align",
       [](Options& o, Given t) { return store(o.align.probe, t, 0, 100, mm); }, "align"},
      {"wrap", "DIAMETER", "Wrap around a bar of this diameter along X: Y becomes turns of A, Z0 its surface",
       set_wrap}};
  return keys;
}

/// The diameter of the tool that cuts deepest.
Length deepest_tool(const Toolpath& path, const std::map<int, Length>& diameters) {
  double low = INFINITY;
  int tool = -1;
  for_each_motion(path, [&](const Step& s, const MotionContext& context) {
    if (s.is_cutting() && s.to().z < low) low = s.to().z, tool = context.tool.value_or(-1);
  });
  const auto known = diameters.find(tool);
  if (known != diameters.end()) return known->second;
  return diameters.size() == 1 ? diameters.begin()->second : Length{};
}

constexpr double kHelixOfDiameter = 0.45;

void needs_diameter(std::string_view what, Diagnostics& diagnostics) {
  diagnostics.error(codes::pass_option, {}, std::string(what)).hint = "--tool 1=\"square d=6\"";
}

/// Where the lead-out is not given, it is as the lead-in.
LeadOptions leads_of(const Options& options) {
  LeadOptions leads = options.leads;
  if (leads.lead_in.kind == LeadKind::none) leads.lead_in.kind = LeadKind::arc;
  if (leads.lead_out.kind == LeadKind::none)
    leads.lead_out = leads.lead_in;
  else
    leads.lead_out.kind = leads.lead_in.kind;
  leads.top = options.passes.top, leads.part = options.passes.part;
  return leads;
}

/// Tools whose cutting part is wider below than at its top: a pass above would cut what they leave.
std::set<int> undercutting(const std::map<int, Tool>& tools) {
  constexpr double kWider = 1e-6;  // mm
  std::set<int> numbers;
  for (const auto& [number, tool] : tools)
    if (const Profile& cutting = tool.silhouette.cutting;
        !cutting.empty() && cutting.max_radius() > cutting.knots.back().r + kWider)
      numbers.insert(number);
  return numbers;
}

/// Leads, the finishing pass, and the depth per pass of both.
bool cut_again(Toolpath& path, const std::map<int, Length>& diameters, std::set<int> undercutting,
               const Options& options, Diagnostics& diagnostics) {
  StepDownOptions passes = options.passes;
  passes.undercutting = std::move(undercutting);
  const LeadOptions leads = leads_of(options);
  const bool leads_change = leads.lead_in.size > Length{} || leads.lead_out.size > Length{} ||
                            leads.overlap > Length{} || leads.finish > Length{};
  if (leads_change) {
    auto led = add_leads(path, leads, diagnostics);
    if (!led) return false;
    path = std::move(led->path), passes.whole = std::move(led->whole);
  }
  if (passes.stepdown == Length{} && passes.entry == EntryKind::plunge) return true;
  if (passes.entry == EntryKind::helix && passes.helix_radius == Length{})
    passes.helix_radius = kHelixOfDiameter * deepest_tool(path, diameters);
  if (passes.entry == EntryKind::helix && passes.helix_radius == Length{}) {
    needs_diameter("a helix requires its radius (--helix-radius), or the diameter of the tool", diagnostics);
    return false;
  }
  auto deeper = step_down(path, passes, diagnostics);
  if (deeper) path = std::move(*deeper);
  return deeper.has_value();
}

}  // namespace

const std::vector<ReworkKey>& rework_keys() {
  static const std::vector<ReworkKey> keys = [] {
    std::vector<ReworkKey> all = passes_of_cuts();
    all.insert(all.end(), passes_of_closed_paths().begin(), passes_of_closed_paths().end());
    all.insert(all.end(), keys_of_placement().begin(), keys_of_placement().end());
    return all;
  }();
  return keys;
}

std::string set_rework(ReworkOptions& options, std::string_view name, const CutValue& value) {
  for (const ReworkKey& key : rework_keys()) {
    if (key.name != name) continue;
    const std::string expected = key.set(options, value);
    return expected.empty() ? expected : fmt::format("expected {}, not {}", expected, text_of(value));
  }
  return fmt::format("there is no option \"{}\"", name.substr(0, kShown));
}

std::optional<Reworked> rework(Toolpath path, const std::map<int, Tool>& tools, const ReworkOptions& options,
                               Diagnostics& diagnostics) {
  Reworked made;
  made.path = std::move(path);
  std::map<int, Length> diameters;
  for (const auto& [number, tool] : tools) diameters[number] = tool.diameter;
  const auto take = [&](std::optional<Toolpath> changed) {
    if (changed) made.path = std::move(*changed);
    return changed.has_value();
  };
  if (options.resume.line > 0) {
    auto rest = resume_from(made.path, options.resume, diagnostics);
    if (!rest) return std::nullopt;
    made.path = std::move(rest->path);
  }
  if (!cut_again(made.path, diameters, undercutting(tools), options, diagnostics)) return std::nullopt;
  if (options.tabs.height > Length{}) {
    const Length diameter = deepest_tool(made.path, diameters);
    if (!(diameter > Length{})) {
      needs_diameter("tabs require the diameter of the tool", diagnostics);
      return std::nullopt;
    }
    if (!take(add_tabs(made.path, options.tabs, diameter, diagnostics))) return std::nullopt;
  }
  if (options.order && !op_detail::counts_upwards(made.path, "rapids between cuts", diagnostics))
    return std::nullopt;
  if (options.order) {
    made.ordered = order_cuts(made.path, diameters);
    made.path = std::move(made.ordered->path);
    made.ordered->path = Toolpath();
  }
  if (!take(transformed(made.path, options.transform, diagnostics))) return std::nullopt;
  if (options.reverse_loops) made.path = reversed_loops(made.path);
  if (!take(repeated(made.path, options.copies, diagnostics))) return std::nullopt;
  if (!options.align.points.empty()) {
    made.alignment = alignment_of(options.align, diagnostics);
    if (!made.alignment || !take(transformed(made.path, made.alignment->transform, diagnostics)))
      return std::nullopt;
  }
  const bool wraps = options.wrap.diameter > Length{};
  if (wraps && !take(wrapped(made.path, options.wrap, diagnostics))) return std::nullopt;
  return made;
}

bool moves_part(const ReworkOptions& options) {
  const PathTransform& t = options.transform;
  return t.scale != 1.0 || t.mirror != Mirror::none || t.rotate != Angle() || !(t.move == Point3{}) ||
         options.copies.columns > 1 || options.copies.rows > 1 || !options.align.points.empty() ||
         options.wrap.diameter > Length{};
}

}  // namespace kerf
