// The internal functions of operations.inc.gcmc: operations of cutting jobs, as motions of the program.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/codes/gcmc.h"
#include "base/names.h"
#include "front/gcmc/run/builtins.h"
#include "front/gcmc/run/workshop.h"

namespace kerf::gcmc {
namespace {

/// An error at the call in the program, which it ends: a line of the library is of no help to its user.
[[noreturn]] void fail_in_program(const Call& call, Code code, std::string text, std::string hint = {}) {
  call.vm.program_message(Severity::error, code, std::move(text), std::move(hint), Vm::At::program);
  throw Stop{};
}

/// The function of the library that the program calls for an operation, as "cut_vcarve_floor".
std::string function_of(std::string_view operation) {
  std::string name = fmt::format("cut_{}", operation);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

/// Argument `i`, which is argument `number` of the function that the program calls.
std::string text_argument(const Call& call, int i, std::string_view function, int number) {
  if (!call[i].is_string())
    fail_in_program(call, codes::gcmc_type, fmt::format("{}() argument {} must be string", function, number));
  return to_utf8(call[i].text());
}

const GcmcWorkshop& workshop_of(const Call& call) {
  if (call.vm.options().workshop == nullptr)
    fail_in_program(call, codes::gcmc_unknown_name, "Operations are not available here");
  return *call.vm.options().workshop;
}

/// Passes messages on, with the line of the program; an error ends it.
void pass_on(const Call& call, const Diagnostics& found) {
  for (const Diagnostic& d : found.list())
    if (d.severity != Severity::note)
      call.vm.program_message(d.severity, d.code, d.message, d.hint, Vm::At::program);
  if (found.errors() > 0) throw Stop{};
}

/// "depth=6mm; feed=900" as names and values.
std::vector<std::pair<std::string, std::string>> keys_of(const Call& call, std::string_view text) {
  std::vector<std::pair<std::string, std::string>> keys;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(';'), text.size());
    const std::string_view key = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (trim(key).empty()) continue;
    const std::size_t equals = key.find('=');
    if (equals == std::string_view::npos)
      fail_in_program(call, codes::gcmc_arguments, fmt::format("'{}' is not a key with a value", trim(key)),
                      "write keys as \"depth=6mm; stepdown=2mm\"");
    keys.emplace_back(trim(key.substr(0, equals)), trim(key.substr(equals + 1)));
  }
  return keys;
}

/// The shapes of a vectorlist, mm; an empty vector separates one from the next.
std::vector<std::vector<std::array<double, 3>>> shapes_of(const Call& call, const Value& list,
                                                          std::string_view function) {
  if (!list.is_list())
    fail_in_program(call, codes::gcmc_type, fmt::format("{}() argument 1 must be a vectorlist", function));
  const double scale = call.vm.native == Unit::inch ? kMmPerInch : 1.0;
  std::vector<std::vector<std::array<double, 3>>> shapes(1);
  for (const Value& v : list.vectors()) {
    if (v.vector_size() == 0) {
      if (!shapes.back().empty()) shapes.emplace_back();
      continue;
    }
    std::array<double, 3> point{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Scalar s = v.coordinate_or_undef(i);
      if (!s.defined() && i < 2)
        fail_in_program(call, codes::gcmc_geometry, fmt::format("{}(): a point without X or Y", function));
      if (s.defined()) point[i] = native_number(call.vm, s) * scale;
      if (!std::isfinite(point[i]))
        fail_in_program(call, codes::gcmc_geometry,
                        fmt::format("{}(): a coordinate is not a finite number", function));
    }
    shapes.back().push_back(point);
  }
  if (shapes.back().empty()) shapes.pop_back();
  return shapes;
}

/// Writes the steps of a toolpath as calls of the program.
class Replay {
 public:
  explicit Replay(const Call& call)
      : vm_(call.vm), m_(call.vm.machine()), scale_(vm_.native == Unit::inch ? 1.0 / kMmPerInch : 1.0) {}

  void run(const Toolpath& path) {
    const Plane plane = m_.plane;
    for (std::size_t i = 0; i < path.size(); ++i) add(path, i);
    set_plane(plane);
  }

 private:
  void add(const Toolpath& path, std::size_t i) {
    const Step& step = path[i];
    vm_.reset_quiet_steps();
    switch (step.kind()) {
      case StepKind::rapid: straight(step, true); break;
      case StepKind::cut: straight(step, false); break;
      case StepKind::arc: arc(step.arc()); break;
      case StepKind::dwell:
        m_.for_each_sink([&](Sink& sink) { sink.dwell(step.dwell().time.seconds()); });
        break;
      case StepKind::spindle: spindle(step.spindle()); break;
      case StepKind::note: m_.for_each_sink([&](Sink& sink) { sink.comment(path.text(i)); }); break;
      default: break;  // the change of the tool was before, the end is the program's
    }
  }

  Axes target(Point3 to, unsigned& named) const {
    Axes out = m_.position;
    const double values[3] = {to.x * scale_, to.y * scale_, to.z * scale_};
    for (std::size_t i = 0; i < 3; ++i) {
      if (moved_ && std::fabs(values[i] - out[i]) < kEpsilon) continue;
      out[i] = values[i];
      named |= 1u << i;
    }
    return out;
  }

  void straight(const Step& step, bool rapid) {
    unsigned named = 0;
    Axes to = target(step.to(), named);
    if (step.unknown_axes() != 0) {
      // The first rise names Z only, and does not go down.
      named = m_.position[2] < to[2] ? 4u : 0u;
      to = m_.position;
      if (named != 0) to[2] = step.to().z * scale_;
    }
    if (named == 0) return;
    moved_ = moved_ || step.unknown_axes() == 0;
    if (!rapid) feed(step.feed());
    m_.set_position(to);
    const Move out{rapid, m_.sent, named, 0.0};
    m_.for_each_sink([&](Sink& sink) { sink.move(out); });
  }

  void arc(const step::Arc& a) {
    set_plane(a.plane);
    feed(a.feed);
    const PlaneAxes axes = named_axes_of(a.plane);
    ArcMove out;
    out.turn = a.turn;
    out.plane = a.plane;
    const Axes to = target(a.to, out.named);
    out.named |= 1u << axes.u | 1u << axes.v;
    out.offset = {a.centre.x * scale_ - along(m_.position, axes.u),
                  a.centre.y * scale_ - along(m_.position, axes.v)};
    out.turns = a.extra_turns > 0 ? a.extra_turns + 1 : 0;
    m_.set_position(to);
    out.to = m_.sent;
    m_.for_each_sink([&](Sink& sink) { sink.arc(out); });
  }

  void set_plane(Plane plane) {
    if (m_.plane == plane) return;
    m_.plane = plane;
    m_.for_each_sink([&](Sink& sink) { sink.plane(plane); });
  }

  void feed(Feed feed) {
    const double value = feed.mm_per_min() * scale_;
    if (value == feed_) return;
    feed_ = value;
    m_.for_each_sink([&](Sink& sink) { sink.feed_rate(value); });
  }

  void spindle(const step::Spindle& s) {
    if (s.turn == SpindleTurn::off) return;
    const double speed = s.turn == SpindleTurn::cw ? s.speed.rpm() : -s.speed.rpm();
    m_.for_each_sink([&](Sink& sink) { sink.spindle(speed); });
  }

  Vm& vm_;
  Machine& m_;
  double scale_;  // mm to native lengths
  double feed_ = 0.0;
  bool moved_ = false;  // to a position that the operation knows
};

/// Changes to a tool where it is not in the spindle or has another shape, with a comment of its shape.
void change_tool(const Call& call, int number, const std::string& text) {
  Machine& m = call.vm.machine();
  const auto known = m.tool_texts.find(number);
  const bool is_new = !text.empty() && (known == m.tool_texts.end() || known->second != text);
  std::optional<std::string> comment;
  if (is_new) {
    Diagnostics found;
    const double scale = call.vm.native == Unit::inch ? kMmPerInch : 1.0;
    comment = workshop_of(call).tool_comment(text, scale, location_in_program(call.vm), found);
    pass_on(call, found);
    m.tool_texts[number] = text;
  }
  if (m.tool == number && !is_new) return;
  m.tool = number;
  m.for_each_sink([&](Sink& sink) { sink.tool_change(number, false); });
  if (comment) m.for_each_sink([&](Sink& sink) { sink.comment(*comment); });
}

/// __kerf_tool(number, text)
Value declare_tool(const Call& call) {
  const std::int32_t number = call.integer(0);
  if (number < 0) fail_in_program(call, codes::gcmc_range, "Tool index must be >= 0");
  const std::string text = text_argument(call, 1, "cutter", 2);
  change_tool(call, number, std::string(trim(text)));
  return Value::undef();
}

/// __kerf_cut(name, shapes, keys)
Value cut(const Call& call) {
  Machine& m = call.vm.machine();
  GcmcOperation operation;
  operation.name = text_argument(call, 0, call.name, 1);
  const std::string function = function_of(operation.name);
  operation.shapes = shapes_of(call, call[1], function);
  operation.keys = keys_of(call, text_argument(call, 2, function, 2));
  operation.where = location_in_program(call.vm);
  if (m.feed_mode != 1)
    fail_in_program(call, codes::gcmc_arguments, fmt::format("{}() needs feedmode(\"upm\")", function));
  if (!m.tool || m.tool_texts.count(*m.tool) == 0)
    fail_in_program(call, codes::gcmc_arguments, "The shape of the tool in the spindle is not known",
                    "call cutter(1, \"square d=6\") before the operation");
  operation.tool = *m.tool;
  operation.tool_text = m.tool_texts[*m.tool];
  Diagnostics found;
  const auto path = workshop_of(call).cut(operation, found, call.vm.machine().progress);
  pass_on(call, found);
  if (!path) throw Stop{};
  Replay(call).run(*path);
  return Value::undef();
}

}  // namespace

const std::vector<Builtin>& cut_builtins() {
  static const std::vector<Builtin> table = {
      {"__kerf_tool", declare_tool, 2, 2},
      {"__kerf_cut", cut, 3, 3},
  };
  return table;
}

}  // namespace kerf::gcmc
