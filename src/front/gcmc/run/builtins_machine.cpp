// Built-in functions that move the machine or set its state.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/codes/gcmc.h"
#include "front/gcmc/code/operators.h"
#include "front/gcmc/run/builtins.h"
#include "geom/base/line_arc.h"

namespace kerf::gcmc {
namespace {

constexpr std::size_t kAxes = 9;
constexpr bool is_rotary(std::size_t axis) { return axis >= 3 && axis <= 5; }
constexpr std::string_view kPlaneNames[] = {"PLANE_XY", "PLANE_XZ", "PLANE_YZ"};

void finite_or_fail(const Call& call, double v, std::size_t axis) {
  if (std::isfinite(v)) return;
  call.fail(codes::gcmc_geometry,
            fmt::format("{}() coordinate {} is not a finite number", call.name, "XYZABCUVW"[axis]));
}

/// A coordinate of A, B or C without unit, in degrees. The versions of the language disagree about its unit.
double bare_angle(const Call& call, double value) {
  const GcmcOptions& options = call.vm.options();
  if (options.degrees || value == 0.0) return value;
  if (options.version == GcmcVersion::v1_9) return convert(value, Unit::rad, Unit::deg);
  if (options.version == GcmcVersion::unstated && options.own_warnings &&
      !std::exchange(call.vm.machine().has_warned_of_angles, true)) {
    call.warn(
        codes::gcmc_bare_angle,
        fmt::format("{}() argument 1 has an angle without unit: taken as degrees, as gcmc 1.8 does; gcmc "
                    "1.9 takes radians",
                    call.name),
        "write the unit (deg), or state the version of gcmc: --compat 1.8 or --compat 1.9");
  }
  return value;
}

/// A coordinate in the units of the machine: native length or degrees.
double machine_number(const Call& call, Scalar s, std::size_t axis) {
  if (s.kind() == Kind::real && s.unit() == call.vm.native && axis < 3 && std::isfinite(s.p.d)) return s.p.d;
  if (is_rotary(axis)) {
    if (is_distance(s.unit()))
      call.warn(codes::gcmc_unit,
                fmt::format("{}() argument 1 has incompatible distance units attached", call.name));
    else if (s.unit() == Unit::rad)
      s = convert(s, Unit::deg);
    finite_or_fail(call, s.number(), axis);
    return s.unit() == Unit::none ? bare_angle(call, s.number()) : s.number();
  }
  if (is_angle(s.unit())) {
    call.warn(codes::gcmc_unit,
              fmt::format("{}() argument 1 has incompatible angular units attached", call.name));
    finite_or_fail(call, s.number(), axis);
    return s.number();
  }
  const double v = native_number(call.vm, s);
  finite_or_fail(call, v, axis);
  return v;
}

Value position_value(const Call& call, std::size_t axes) {
  const Machine& m = call.vm.machine();
  std::array<Scalar, kAxes> all;
  for (std::size_t i = 0; i < axes; ++i)
    all[i] = Scalar::real(m.position[i], is_rotary(i) ? Unit::deg : call.vm.native);
  return Value::vector(all.data(), axes, call.vm.meter);
}

// ---- straight moves

enum class From : std::uint8_t { zero, here };

/// The target position of a vector, and the axes that it names.
Axes target_of(const Call& call, const Value& v, From from, unsigned& named) {
  const Machine& m = call.vm.machine();
  Axes to = m.position;
  named = 0;
  const std::size_t count = std::min(v.vector_size(), kAxes);
  for (std::size_t i = 0; i < count; ++i) {
    const Scalar s = v.coordinate(i);
    if (!s.defined()) continue;
    const double value = machine_number(call, s, i);
    to[i] = from == From::here ? m.position[i] + value : value;
    named |= 1u << i;
  }
  return to;
}

void move_one(const Call& call, const Value& v, bool rapid, From from, double feed) {
  Machine& m = call.vm.machine();
  const Point2 start{m.position[0], m.position[1]};
  unsigned named = 0, moving = 0;
  const std::size_t count = std::min(v.vector_size(), kAxes);
  for (std::size_t i = 0; i < count; ++i) {
    const Scalar s = v.coordinate(i);
    if (!s.defined()) continue;
    const double value = machine_number(call, s, i);
    m.set_axis(i, from == From::here ? m.position[i] + value : value);
    named |= 1u << i;
    if (std::fabs(value) >= kEpsilon) moving |= 1u << i;
  }
  if (named == 0) {
    m.for_each_sink([&](Sink& sink) { sink.broken_move(rapid); });
    call.fail(codes::gcmc_geometry, fmt::format("All coordinates in {}() undefined", call.name));
  }
  if (m.trace && !rapid) m.trace->motions.push_back(line_between(start, {m.position[0], m.position[1]}));
  // Relative moves in relative text omit axes that do not move, unless none is left.
  if (from == From::here && call.vm.options().relative && moving != 0) named = moving;
  call.vm.reset_quiet_steps();
  const Move out{rapid, m.sent, named, feed};
  m.for_each_sink([&](Sink& sink) { sink.move(out); });
}

Value moves(const Call& call, bool rapid, From from) {
  const Value before = call.value_used ? position_value(call, 3) : Value::undef();
  const double feed = call.count > 1 ? call.length(1) : 0.0;
  const Value& v = call[0];
  if (v.is_vector()) {
    move_one(call, v, rapid, from, feed);
  } else if (v.is_list()) {
    if (v.vectors().empty())
      call.warn(codes::gcmc_geometry, fmt::format("{}(): Vectorlist contains no vectors", call.name));
    for (const Value& item : v.vectors()) move_one(call, item, rapid, from, feed);
  } else {
    call.fail(codes::gcmc_type, fmt::format("{}(): Argument must be a vector or a vectorlist", call.name));
  }
  return before;
}

Value go_to(const Call& call) { return moves(call, true, From::zero); }
Value move(const Call& call) { return moves(call, false, From::zero); }
Value go_to_relative(const Call& call) { return moves(call, true, From::here); }
Value move_relative(const Call& call) { return moves(call, false, From::here); }

Value position(const Call& call) {
  const std::int32_t axes = call.count > 0 ? call.integer(0) : 3;
  if (axes < 1 || axes > static_cast<std::int32_t>(kAxes))
    call.fail(codes::gcmc_range, fmt::format("position() argument 1 must be 1 to {}", kAxes));
  return position_value(call, static_cast<std::size_t>(axes));
}

Value relocate(const Call& call) {
  Machine& m = call.vm.machine();
  m.relocation = {};
  if (call.count > 0 && !call[0].is_vector())
    call.fail(codes::gcmc_type, "relocate() argument 1 must be vector");
  for (std::size_t i = 0; call.count > 0 && i < std::min(call[0].vector_size(), kAxes); ++i) {
    const Scalar s = call[0].coordinate(i);
    if (s.defined()) m.relocation[i] = machine_number(call, s, i);
  }
  m.set_position(m.position);
  return Value::undef();
}

/// The internal variables with the position and the offset of six axes.
template <bool offset>
Value internal_axes(const Call& call) {
  const Machine& m = call.vm.machine();
  std::array<Scalar, 6> all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double v = offset ? m.fixed_offset[i] + m.relocation[i] : m.position[i];
    all[i] = is_rotary(i) ? Scalar::real(convert(v, Unit::deg, Unit::rad), Unit::rad)
                          : Scalar::real(v, call.vm.native);
  }
  return Value::vector(all.data(), all.size(), call.vm.meter);
}

// ---- arcs and circles

int turns_of(const Call& call, int i) {
  if (call.count <= i) return 0;
  const std::int32_t turns = call.integer(i);
  if (turns < 1) call.fail(codes::gcmc_range, fmt::format("{}() Number of turns must be >= 1", call.name));
  return turns;
}

/// An error if a radius is too small for an arc over a chord.
void check_radius(const Call& call, Point2 chord, double radius) {
  const double square = dot(chord, chord), length = std::sqrt(square);
  if (length < kEpsilon) {
    call.fail(codes::gcmc_geometry,
              fmt::format("{}() distance between start and endpoint zero ({:e})", call.name, length));
  }
  const double rise = radius * radius - square / 4.0;
  if (rise < -kEpsilon) {
    call.fail(codes::gcmc_geometry,
              fmt::format("{}() radius ({:e}) is less than two times distance from start to end (D={:e})",
                          call.name, radius, rise));
  }
}

/// In XZ the direction is seen from +Y, where X and Z form a left-handed system: the sides are exchanged.
/// Version 1.8 did not exchange them.
bool has_exchanged_sides(const Call& call, Point2 chord, double radius) {
  Machine& m = call.vm.machine();
  const GcmcVersion version = call.vm.options().version;
  if (m.plane != Plane::xz || version == GcmcVersion::v1_8) return false;
  const bool differs = radius * radius - dot(chord, chord) / 4.0 > kEpsilon;  // a half circle has one centre
  if (version == GcmcVersion::unstated && differs && !std::exchange(m.has_warned_of_arcs, true)) {
    call.warn(
        codes::gcmc_xz_arc,
        fmt::format("{}() in the XZ plane: its centre is where G-code requires it, as in gcmc 1.9; gcmc "
                    "1.8 puts it on the other side",
                    call.name),
        "state the version of gcmc for which the program was written: --compat 1.8 or --compat 1.9");
  }
  return true;
}

/// Version 1.8 adds the position for a coordinate that is written as `-` in a relative arc.
void double_omitted(const Call& call, PlaneAxes axes, Axes& to) {
  for (const int axis : {axes.u, axes.v}) {
    const auto i = static_cast<std::size_t>(axis);
    if (i < call[0].vector_size() && !call[0].coordinate(i).defined()) to[i] *= 2.0;
  }
}

Value arc(const Call& call, Turn turn, From from) {
  if (!call[0].is_vector())
    call.fail(codes::gcmc_type, fmt::format("{}(): First argument must be a vector", call.name));
  Machine& m = call.vm.machine();
  const PlaneAxes axes = named_axes_of(m.plane);
  ArcMove out;
  out.turn = turn;
  out.plane = m.plane;
  Axes to = target_of(call, call[0], from, out.named);
  if (from == From::here && call.vm.options().version == GcmcVersion::v1_8) double_omitted(call, axes, to);
  const double radius = call.length(1);
  finite_or_fail(call, radius, static_cast<std::size_t>(axes.u));
  out.turns = turns_of(call, 2);
  if ((out.named & (1u << axes.u | 1u << axes.v)) == 0) {
    call.fail(codes::gcmc_geometry, fmt::format("{}() in plane {} is missing both plane coordinates",
                                                call.name, kPlaneNames[static_cast<std::size_t>(m.plane)]));
  }
  const Point2 chord{along(to, axes.u) - along(m.position, axes.u),
                     along(to, axes.v) - along(m.position, axes.v)};
  check_radius(call, chord, radius);
  const bool left = ((turn == Turn::ccw) == (radius > 0.0)) != has_exchanged_sides(call, chord, radius);
  out.offset = centre_over_chord(chord, radius, left ? 1.0 : -1.0);
  if (m.trace && m.plane == Plane::xy) {
    const Point2 start{m.position[0], m.position[1]};
    m.trace->motions.push_back(arc_about(start + out.offset, start, {to[0], to[1]}, turn));
  }
  m.set_position(to);
  out.to = m.sent;
  call.vm.reset_quiet_steps();
  m.for_each_sink([&](Sink& sink) { sink.arc(out); });
  return std::move(call[0]);
}

Value arc_cw(const Call& call) { return arc(call, Turn::cw, From::zero); }
Value arc_ccw(const Call& call) { return arc(call, Turn::ccw, From::zero); }
Value arc_cw_relative(const Call& call) { return arc(call, Turn::cw, From::here); }
Value arc_ccw_relative(const Call& call) { return arc(call, Turn::ccw, From::here); }

/// A full circle given by its centre; a third coordinate makes it a helix.
void circle_by_centre(const Call& call, From from, ArcMove& out, Axes& to) {
  const Machine& m = call.vm.machine();
  const PlaneAxes axes = named_axes_of(m.plane);
  unsigned named = 0;
  const Axes centre = target_of(call, call[0], from, named);
  const unsigned both = 1u << axes.u | 1u << axes.v;
  if ((named & both) != both) {
    call.fail(codes::gcmc_geometry, fmt::format("{}() in plane {} is missing plane coordinates", call.name,
                                                kPlaneNames[static_cast<std::size_t>(m.plane)]));
  }
  out.offset = {along(centre, axes.u) - along(m.position, axes.u),
                along(centre, axes.v) - along(m.position, axes.v)};
  out.named = both;
  if (named & 1u << axes.w) {
    along(to, axes.w) = along(centre, axes.w);
    out.named |= 1u << axes.w;
  }
  out.turns = turns_of(call, 1);
}

void circle_by_radius(const Call& call, ArcMove& out) {
  const PlaneAxes axes = named_axes_of(call.vm.machine().plane);
  if (call.count < 2) call.fail(codes::gcmc_arguments, fmt::format("{}() requires two arguments", call.name));
  const double radius = call.length(0), angle = call.angle(1);
  out.offset = {radius * std::cos(angle), radius * std::sin(angle)};
  finite_or_fail(call, out.offset.x, static_cast<std::size_t>(axes.u));
  finite_or_fail(call, out.offset.y, static_cast<std::size_t>(axes.v));
  out.named = 1u << axes.u | 1u << axes.v;
  out.turns = turns_of(call, 2);
}

Value circle(const Call& call, Turn turn, From from) {
  Machine& m = call.vm.machine();
  ArcMove out;
  out.turn = turn;
  out.plane = m.plane;
  Axes to = m.position;
  if (call[0].is_vector())
    circle_by_centre(call, from, out, to);
  else if (call[0].is_scalar())
    circle_by_radius(call, out);
  else
    call.fail(codes::gcmc_type, fmt::format("{}(): First argument neither vector nor scalar", call.name));
  if (std::hypot(out.offset.x, out.offset.y) < kEpsilon)
    call.fail(codes::gcmc_geometry, fmt::format("{}() radius is zero", call.name));
  if (call.vm.options().version == GcmcVersion::v1_8) {
    // It does not follow a helix, and subtracts the offset from its end.
    const int w = named_axes_of(m.plane).w;
    out.to = m.sent;
    along(out.to, w) = 2.0 * along(to, w) - m.with_offset(static_cast<std::size_t>(w), along(to, w));
  } else {
    m.set_position(to);
    out.to = m.sent;
  }
  call.vm.reset_quiet_steps();
  m.for_each_sink([&](Sink& sink) { sink.arc(out); });
  return std::move(call[0]);
}

Value circle_cw(const Call& call) { return circle(call, Turn::cw, From::zero); }
Value circle_ccw(const Call& call) { return circle(call, Turn::ccw, From::zero); }
Value circle_cw_relative(const Call& call) { return circle(call, Turn::cw, From::here); }
Value circle_ccw_relative(const Call& call) { return circle(call, Turn::ccw, From::here); }

/// A canned cycle of the controller: depth, retract level, and depth of each peck.
Value drill(const Call& call) {
  if (!call[0].is_vector() || !call[0].coordinate_or_undef(2).defined())
    call.fail(codes::gcmc_geometry, "Drill-cycle must have a scalar Z-coordinate in first argument");
  Machine& m = call.vm.machine();
  DrillMove out;
  const Axes to = target_of(call, call[0], From::zero, out.named);
  const double retract = call.length(1);
  out.delta = call.length(2);
  finite_or_fail(call, retract, 2);
  finite_or_fail(call, out.delta, 2);
  if (out.delta <= 0.0) call.fail(codes::gcmc_range, "drill() argument 3 must be > 0");
  if (call.count > 3) {
    out.repeat = call.integer(3);
    if (out.repeat < 1) call.fail(codes::gcmc_range, "drill() argument 4 must be > 0");
  }
  m.set_position(to);
  out.to = m.sent;
  m.set_axis(2, retract);
  out.retract = m.sent[2];
  m.for_each_sink([&](Sink& sink) { sink.drill(out); });
  return Value::undef();
}

// ---- state

double finite_argument(const Call& call, double v, int i) {
  if (!std::isfinite(v))
    call.fail(codes::gcmc_range, fmt::format("{}() argument {} is not finite", call.name, i + 1));
  return v;
}

Value feed_rate(const Call& call) {
  const double feed = finite_argument(call, call.length(0), 0);
  call.vm.machine().for_each_sink([&](Sink& sink) { sink.feed_rate(feed); });
  return Value::undef();
}

std::string lower_text(const Value& v) {
  std::string text = to_utf8(v.text());
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  return text;
}

/// An argument that is an index into `words` or one of `words`, as the index; -1 for anything else.
int choice_of(const Call& call, std::initializer_list<std::string_view> words) {
  int i = -1;
  if (call[0].is_string()) {
    const std::string text = lower_text(call[0]);
    const auto* found = std::find(words.begin(), words.end(), text);
    if (found != words.end()) i = static_cast<int>(found - words.begin());
  } else if (call[0].is_scalar() && !call[0].is_undef()) {
    i = call.integer(0);
  }
  return i >= 0 && i < static_cast<int>(words.size()) ? i : -1;
}

Value feed_mode(const Call& call) {
  const int mode = choice_of(call, {"inverse", "upm", "upr"});
  if (mode < 0)
    call.fail(codes::gcmc_range, "Feed mode must be one of 0 (\"inverse\"), 1 (\"upm\") or 2 (\"upr\")");
  call.vm.machine().for_each_sink([&](Sink& sink) { sink.feed_mode(mode); });
  return Value::undef();
}

Value coolant(const Call& call) {
  const int bits = choice_of(call, {"off", "mist", "flood", "mist+flood"});
  if (bits < 0) {
    call.fail(codes::gcmc_range,
              "Coolant must be on of: 0 (\"off\"), 1 (\"mist\"), 2 (\"flood\") or 3 (\"mist+flood\")");
  }
  call.vm.machine().for_each_sink([&](Sink& sink) { sink.coolant(bits); });
  return Value::undef();
}

Value spindle(const Call& call) {
  const double speed = finite_argument(call, call.number(0), 0);
  call.vm.machine().for_each_sink([&](Sink& sink) { sink.spindle(speed); });
  return Value::undef();
}

Value spindle_speed(const Call& call) {
  const double speed = finite_argument(call, call.number(0), 0);
  if (speed < 0.0)
    call.fail(codes::gcmc_range, fmt::format("Spindle speed cannot be negative ({:f})", speed));
  call.vm.machine().for_each_sink([&](Sink& sink) { sink.spindle_speed(speed); });
  return Value::undef();
}

Value tool_change(const Call& call) {
  const std::int32_t tool = call.integer(0);
  if (tool < 0) call.fail(codes::gcmc_range, "Tool index must be >= 0");
  const bool length = call.count > 1 && call.truth(1);
  call.vm.machine().for_each_sink([&](Sink& sink) { sink.tool_change(tool, length); });
  return Value::undef();
}

Value dwell(const Call& call) {
  const double seconds = finite_argument(call, call.number(0), 0);
  if (seconds < 0.0)
    call.fail(codes::gcmc_range, fmt::format("Dwell cannot have negative seconds ({:f})", seconds));
  call.vm.machine().for_each_sink([&](Sink& sink) { sink.dwell(seconds); });
  return Value::undef();
}

Value path_mode(const Call& call) {
  if (call.count < 1 || call.count > 2)
    call.fail(codes::gcmc_arguments, "pathmode(): expects one or two arguments");
  if (call.count == 1) {
    const bool exact = call.truth(0);
    call.vm.machine().for_each_sink([&](Sink& sink) { sink.path_mode(exact, {}, {}); });
    return Value::undef();
  }
  const std::optional<double> p = finite_argument(call, call.length(0), 0);
  std::optional<double> q;
  if (!call[1].is_undef()) q = finite_argument(call, call.length(1), 1);
  call.vm.machine().for_each_sink([&](Sink& sink) { sink.path_mode(false, p, q); });
  return Value::undef();
}

Value pause(const Call& call) {
  const bool optional = call.count > 0 && call.truth(0);
  call.vm.machine().for_each_sink([&](Sink& sink) { sink.pause(optional); });
  return Value::undef();
}

Value plane(const Call& call) {
  Machine& m = call.vm.machine();
  const auto before = Value::integer(static_cast<std::int32_t>(m.plane));
  if (call[0].is_undef()) return before;
  const int plane = choice_of(call, {"xy", "xz", "yz"});
  if (plane < 0) {
    call.fail(
        codes::gcmc_range,
        "plane() only accepts PLANE_XY (0), PLANE_XZ (1), PLANE_YZ (2) or strings \"XY\"|\"XZ\"|\"YZ\"");
  }
  if (plane != 0 && call.vm.options().target != GcmcTarget::gcode)
    call.warn(codes::gcmc_suspicious, "plane() other than PLANE_XY has no meaning in a drawing");
  m.plane = static_cast<Plane>(plane);
  m.for_each_sink([&](Sink& sink) { sink.plane(m.plane); });
  return before;
}

// ---- stored positions

Value store_position(const Call& call) {
  Machine& m = call.vm.machine();
  const bool second = call.truth(0);
  m.stored[second ? 1 : 0] = {true, m.position};
  m.for_each_sink([&](Sink& sink) { sink.store_position(second); });
  return Value::undef();
}

Value set_position(const Call& call) {
  const bool second = call.truth(0);
  if (!call[1].is_vector()) call.fail(codes::gcmc_type, "fixpos_set() argument 2 must be vector");
  Axes where{};
  for (std::size_t i = 0; i < std::min(call[1].vector_size(), kAxes); ++i) {
    const Scalar s = call[1].coordinate(i);
    if (s.defined()) where[i] = machine_number(call, s, i);
  }
  call.vm.machine().stored[second ? 1 : 0] = {true, where};
  return Value::undef();
}

Value restore_position(const Call& call) {
  Machine& m = call.vm.machine();
  const bool second = call.truth(0);
  unsigned named = 0;
  Axes via = m.position;
  if (call.count > 1) {
    if (!call[1].is_vector()) call.fail(codes::gcmc_type, "fixpos_restore() argument 2 must be vector");
    via = target_of(call, call[1], From::zero, named);
  }
  const Machine::Stored& stored = m.stored[second ? 1 : 0];
  if (!stored.known) {
    call.warn(codes::gcmc_suspicious,
              fmt::format("Position for {} not previously set, tracking may be off", second ? "G30" : "G28"));
  }
  m.set_position(stored.position);
  call.vm.reset_quiet_steps();
  m.for_each_sink([&](Sink& sink) { sink.restore_position(second, via, named, m.sent); });
  return Value::undef();
}

// ---- layers and drawings

bool is_layer_name(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

std::string layer_name(const Call& call, int i) {
  if (!call[i].is_string())
    call.fail(codes::gcmc_type, fmt::format("{}() argument {} must be string", call.name, i + 1));
  std::string name = to_utf8(call[i].text());
  if (!is_layer_name(name)) {
    call.fail(codes::gcmc_arguments,
              fmt::format("{}() invalid characters in layer name {}", call.name, i + 1));
  }
  return name;
}

Value layer_stack(const Call& call) {
  Machine& m = call.vm.machine();
  for (int i = 0; i < call.count; ++i) {
    std::string name = layer_name(call, i);
    if (std::find(m.layers.begin(), m.layers.end(), name) != m.layers.end())
      call.fail(codes::gcmc_arguments, fmt::format("{}() layer '{}' already exists", call.name, name));
    m.layers.push_back(std::move(name));
  }
  return Value::undef();
}

Value layer(const Call& call) {
  Machine& m = call.vm.machine();
  if (call[0].is_string()) {
    const std::string name = layer_name(call, 0);
    auto found = std::find(m.layers.begin(), m.layers.end(), name);
    if (found == m.layers.end()) {
      call.warn(codes::gcmc_suspicious,
                fmt::format("layer() layer '{}' not found, added to the stack", name));
      found = m.layers.insert(m.layers.end(), name);
    }
    m.layer = static_cast<int>(found - m.layers.begin());
  } else {
    const std::int32_t i = call.integer(0);
    if (i < 1 || i > static_cast<std::int32_t>(m.layers.size()))
      call.fail(codes::gcmc_range, fmt::format("layer() index {} out of range [1..{}]", i, m.layers.size()));
    m.layer = i - 1;
  }
  const std::string& name = m.layers[static_cast<std::size_t>(m.layer)];
  m.for_each_sink([&](Sink& sink) { sink.layer(name); });
  return Value::undef();
}

Value close_path(const Call& call) {
  call.vm.machine().for_each_sink([](Sink& sink) { sink.close_path(); });
  return Value::undef();
}

}  // namespace

const std::vector<Builtin>& machine_builtins() {
  static const std::vector<Builtin> table = {
      {"goto", go_to, 1, 1},
      {"move", move, 1, 2},
      {"goto_r", go_to_relative, 1, 1},
      {"move_r", move_relative, 1, 2},
      {"position", position, 0, 1},
      {"relocate", relocate, 0, 1},
      {"__global_position", internal_axes<false>, 0, 0},
      {"__global_offset", internal_axes<true>, 0, 0},
      {"arc_cw", arc_cw, 2, 3},
      {"arc_ccw", arc_ccw, 2, 3},
      {"arc_cw_r", arc_cw_relative, 2, 3},
      {"arc_ccw_r", arc_ccw_relative, 2, 3},
      {"circle_cw", circle_cw, 1, 3},
      {"circle_ccw", circle_ccw, 1, 3},
      {"circle_cw_r", circle_cw_relative, 1, 3},
      {"circle_ccw_r", circle_ccw_relative, 1, 3},
      {"drill", drill, 3, 4},
      {"feedrate", feed_rate, 1, 1},
      {"feedmode", feed_mode, 1, 1},
      {"coolant", coolant, 1, 1},
      {"spindle", spindle, 1, 1},
      {"spindlespeed", spindle_speed, 1, 1},
      {"toolchange", tool_change, 1, 2},
      {"dwell", dwell, 1, 1},
      {"pathmode", path_mode, 0, kAnyCount},
      {"pause", pause, 0, 1},
      {"plane", plane, 1, 1},
      {"fixpos_store", store_position, 1, 1},
      {"fixpos_set", set_position, 2, 2},
      {"fixpos_restore", restore_position, 1, 2},
      {"layer", layer, 1, 1},
      {"layerstack", layer_stack, 0, kAnyCount},
      {"svg_closepath", close_path, 0, 0},
  };
  return table;
}

}  // namespace kerf::gcmc
