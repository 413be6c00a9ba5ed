// The motions, the tool and the files of a program's commands.
#include "front/scad/commands/machine_state.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/scad.h"

#include "kerf/base/limits.h"
#include "kerf/op/printer.h"
#include "kerf/path/passes.h"

namespace kerf::scad {
namespace {

constexpr unsigned kXY = 3;               // bits of axes, see Step::unknown_axes
constexpr double kLargestArcError = 0.5;  // mm, between the radii at the ends of an arc
constexpr int kDefaultTool = 102;

/// A point of a circle; exact at multiples of a right angle.
Point2 on_circle(Point2 centre, double radius, double angle) {
  const double quarter = angle / 90;
  double c = std::cos(degrees(angle).rad()), s = std::sin(degrees(angle).rad());
  if (quarter == std::round(quarter)) {
    constexpr int kCosines[] = {1, 0, -1, 0}, kSines[] = {0, 1, 0, -1};
    const auto k = static_cast<std::size_t>(std::fmod(std::fmod(quarter, 4) + 4, 4));
    c = kCosines[k], s = kSines[k];
  }
  return {centre.x + radius * c, centre.y + radius * s};
}

void check_position(Point3 p) {
  coordinate(p.x, "X");
  coordinate(p.y, "Y");
  coordinate(p.z, "Z");
}

/// Names that a DXF layer cannot have.
constexpr std::string_view kNotInLayers = "<>/\\\":;?*|=,`\r\n";

}  // namespace

MachineState::MachineState(const CommandOptions& options)
    : options_(options), numbers_(options.tools == nullptr ? ToolTable() : *options.tools) {
  settings.post = "carbide";
  settings.ending = ".nc";
}

// ---- the call that runs

MachineState::Running::Running(MachineState& state, Call& call)
    : state_(state), before_(state.call_), origin_before_(state.origin_) {
  state_.call_ = &call;
  state_.origin_ = OriginId::none;
}
MachineState::Running::~Running() {
  state_.call_ = before_;
  state_.origin_ = origin_before_;
}

Call& MachineState::call() {
  assert(call_ != nullptr);
  return *call_;
}

OriginId MachineState::here() {
  if (origin_ == OriginId::none) origin_ = call().origin(path.origins());
  return origin_;
}

void MachineState::warn(std::string message) { call().warning(codes::scad_argument, std::move(message)); }

void MachineState::expect_tool(std::string_view shape, std::string_view command) {
  if (tool_.shape() != shape)
    warn(fmt::format("{}: a {} should be in use, not a {}", command, shape, tool_.shape()));
}
Diagnostics& MachineState::diagnostics() { return call().diagnostics(); }
Origin MachineState::where() { return call().where(); }
void MachineState::stop_after_errors(std::size_t errors) {
  if (diagnostics().errors() > errors) throw Reported{};
}
RegionOptions MachineState::region_options() {
  RegionOptions region;
  region.name = call().command().name;
  region.where = where();
  region.progress = options_.progress;
  return region;
}

// ---- the object

void MachineState::start(Mode mode, bool gcode, bool dxf, double pitch) {
  if (started_) refuse_now("gcodepreview() was called before: a program has one machine");
  started_ = true;
  mode_ = mode;
  settings.gcode = gcode;
  settings.dxf = dxf;
  resolution = pitch;
  if (mode == Mode::print) {
    settings.post = "marlin";
    settings.ending = ".gcode";
  }
  tool_ = {kDefaultTool, kDefaultTool, numbers_.tool(kDefaultTool)};
  if (mode == Mode::cut) path.add(step::ToolChange{kDefaultTool}, here());
}

// ---- position

void MachineState::set_axis(int axis, double value) { at_[axis] = coordinate(value, "the position"); }

void MachineState::catch_up() {
  if (!commanded_) return;
  const Point3 last = *commanded_;
  const bool away = distance(at_, last) > kFar;
  if (!only_z_ && !away) return;
  if (away)
    warn(
        fmt::format("the position was set to X{:g} Y{:g} Z{:g} without a motion from X{:g} Y{:g} Z{:g}: a "
                    "rapid to it is added",
                    at_.x, at_.y, at_.z, last.x, last.y, last.z));
  if (at_.z > last.z + kFar && !only_z_)
    path.add(step::Rapid{{last.x, last.y, at_.z}}, here());
  else if (at_.z < last.z - kFar)
    path.add(step::Rapid{{at_.x, at_.y, last.z}}, here());
  path.add(step::Rapid{at_}, here());
  commanded_ = at_;
  only_z_ = false;
}

void MachineState::arrive(Point3 to) {
  at_ = to;
  commanded_ = to;
  only_z_ = false;
}

void MachineState::turn_with(std::size_t step) {
  if (!rotary) return;
  MotionExtra extra;
  extra.abc = {*rotary, 0.0, 0.0};
  path.set_extra(step, std::move(extra));
}

double MachineState::feed_to(Point3 to, std::optional<double> given) const {
  if (given) return positive(*given, "feed");
  const bool down = to.z < at_.z && std::hypot(to.x - at_.x, to.y - at_.y) <= kFar;
  const auto ratio = ratios.find(tool_.feed_class());
  return (down ? plunge : feed) * (ratio == ratios.end() ? 1.0 : ratio->second);
}

// ---- motions

void MachineState::rapid(Point3 to, Beam beam) {
  check_position(to);
  const bool only_z = !commanded_ && std::abs(to.x - at_.x) <= kFar && std::abs(to.y - at_.y) <= kFar;
  if (beam == Beam::off && commanded_) path.add(step::LaserPower{LaserMode::off, 0.0}, here());
  if (!only_z) {
    catch_up();
    turn_with(path.add(step::Rapid{to}, here()));
    arrive(to);
    return;
  }
  // X and Y have no commanded position yet: they must not move.
  path.set_unknown_axes(path.add(step::Rapid{{0.0, 0.0, to.z}}, here()), kXY);
  arrive(to);
  only_z_ = true;
}

void MachineState::move_to_safe_z() {
  note("Move to safe Z to avoid workholding");
  const Point3 to{at_.x, at_.y, retract_height};
  if (commanded_ && !only_z_) return rapid(to);
  path.set_unknown_axes(path.add(step::Rapid{{0.0, 0.0, to.z}}, here()), kXY);
  arrive(to);
  only_z_ = true;
}

void MachineState::cut(Point3 to, std::optional<double> feed_given) {
  check_position(to);
  const double speed = feed_to(to, feed_given);
  catch_up();
  turn_with(path.add(step::Cut{to, mm_per_min(speed)}, here()));
  arrive(to);
}

void MachineState::arc_to(Point3 to, Point2 centre, Turn turn, int extra_turns) {
  check_position(to);
  const double speed = feed_to({to.x, to.y, limits::kMaxCoordinate}, {});
  const double first = distance(at_.xy(), centre), last = distance(to.xy(), centre);
  if (!ArcMismatch{.limit = mm(kLargestArcError)}.permits(first, last))
    refuse(fmt::format("the arc starts {:.4f} mm from its centre and ends {:.4f} mm from it", first, last));
  catch_up();
  if (!commanded_) path.add(step::Rapid{at_}, here());  // an arc needs a commanded start
  step::Arc arc;
  arc.to = to;
  arc.centre = centre;
  arc.turn = turn;
  arc.extra_turns = extra_turns;
  arc.feed = mm_per_min(speed);
  path.add(arc, here());
  arrive(to);
}

void MachineState::arc(const ArcBetween& arc) {
  const double sweep = arc.turn == Turn::ccw ? arc.end - arc.start : arc.start - arc.end;
  if (!(sweep > 0.0))
    refuse(fmt::format("earc must be {} barc, not {:g} with a barc of {:g}",
                       arc.turn == Turn::ccw ? "above" : "below", arc.end, arc.start));
  const int turns = whole(std::ceil(sweep / 360) - 1, "the number of turns", 0, limits::kMaxTurns);
  const Point2 start = on_circle(arc.centre, arc.radius, arc.start);
  if (distance(start, at_.xy()) > kFar) cut_at(start, at_.z);
  const bool whole_turns = std::fmod(sweep, 360) == 0.0;
  const Point2 end = whole_turns ? start : on_circle(arc.centre, arc.radius, arc.end);
  arc_to({end.x, end.y, at_.z + arc.rise}, arc.centre, arc.turn, turns);
}

void MachineState::extrude(Point3 to, double volume, double width, double height, double feed_given) {
  check_position(to);
  catch_up();
  step::Extrude bead;
  bead.to = to;
  bead.feed = mm_per_min(positive(feed_given, "feedrate"));
  bead.volume = mm3(volume);
  bead.width = mm(width);
  bead.height = mm(height);
  path.add(bead, here());
  arrive(to);
}

void MachineState::draw_back(double volume, double feed_given) {
  if (!commanded_) refuse_now("the position of the nozzle is unknown; move it first");
  catch_up();
  step::Extrude bead;
  bead.to = at_;
  bead.feed = mm_per_min(positive(feed_given, "extrusionfeed"));
  bead.volume = mm3(-volume);
  path.add(bead, here());
}

void MachineState::follow(const Outline& outline, double z) {
  Point2 from = outline.start;
  for (const Segment& segment : outline.segments) {
    if (distance(from, segment.to) <= kFar && !segment.via) continue;
    const auto circle = arc_circle(from, segment);
    if (circle)
      arc_to({segment.to.x, segment.to.y, z}, circle->centre, circle->turn);
    else
      cut_at(segment.to, z);
    from = segment.to;
  }
}

void MachineState::cut_outlines(const std::vector<Outline>& outlines, double z) {
  for (const Outline& outline : outlines) {
    lift();
    rapid_xy(outline.start);
    cut_at(outline.start, z);
    follow(outline, z);
  }
  lift();
}

// ---- tools

void MachineState::change_tool(int number, double speed) {
  const int maker = numbers_.maker_number(number);
  catch_up();
  tool_ = {maker, number, numbers_.tool(maker)};
  note("Toolpath");
  path.add(step::ToolChange{maker}, here());
  path.add(step::Spindle{rpm(speed), speed > 0.0 ? SpindleTurn::cw : SpindleTurn::off}, here());
}

void MachineState::add_tool(int number, Tool tool) {
  numbers_.add(number, std::move(tool));
  if (tool_.number == number) tool_.tool = numbers_.tool(number);
}

void MachineState::describe_tool(Tool tool) { tool_.tool = std::move(tool); }

// ---- drawing

std::string MachineState::layer_for(int tool_number) const {
  if (layer) return *layer;
  if (settings.layers == FileSettings::Layers::by_tool) return fmt::format("Tool {}", tool_number);
  if (settings.layers != FileSettings::Layers::by_depth) return colour.layer();
  std::string name = fmt::format("Tool {} to {:.3f}", tool_number, at_.z);
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

void MachineState::draw(int tool_number, Sketch::Entity entity) {
  if (!settings.dxf) return;
  const std::string name = layer_for(tool_number);
  if (name.find_first_of(kNotInLayers) != std::string::npos)
    refuse("layer: a name without <>/\\\":;?*|=,` is required");
  const auto own = tool_sketches_.find(tool_number);
  if (own != tool_sketches_.end()) own->second.add(name, colour.index, entity);
  sketch_.add(name, colour.index, std::move(entity));
}

std::string MachineState::dxf_of(const Sketch& sketch, Point2 stagger) const {
  return write_dxf(sketch.drawing(settings.chains, stagger), settings.version);
}

std::string MachineState::dxf() const {
  if (!settings.stagger) return dxf_of(sketch_);
  if (!stock) refuse_now("drawings offset by colour: setupstock must be called first");
  return dxf_of(sketch_, stock->block.high.xy() - stock->block.low.xy());
}

void MachineState::sketch_tools(const std::vector<int>& tools) {
  tool_sketches_.clear();
  if (settings.dxf)
    for (const int number : tools)
      if (number != 0) tool_sketches_[number];
}

// ---- texts and files

void MachineState::note(std::string_view text) { path.add(step::Note{std::string(text)}, here()); }

void MachineState::write_line(const std::string& line) {
  if (line.size() > 1 && line.front() == '(' && line.back() == ')')
    note(std::string_view(line).substr(1, line.size() - 2));
  else
    path.add(step::Verbatim{line}, here());
}

void MachineState::add_file(std::string name, std::string bytes) {
  files_.push_back({std::move(name), std::move(bytes)});
}

void MachineState::close_program(const std::string& name) {
  programs_.push_back({name, settings.post, without_unused_first_tool(path), mm_per_min(feed)});
}

void MachineState::home(unsigned axes) {
  add_home(path, axes, here());
  commanded_.reset();
}

void MachineState::end_program() {
  if (mode_ == Mode::print) {
    switch_off(path, here());
    home(1);
  }
  if (mode_ == Mode::cut && commanded_ && at_.z < retract_height) lift();
}

void MachineState::restart_path() {
  path = {};
  origin_ = OriginId::none;
  commanded_.reset();
  only_z_ = false;
}

void MachineState::continue_path(Toolpath program) {
  path = std::move(program);
  origin_ = OriginId::none;
  PathPosition position;
  for (const Step& step : path.steps()) position.pass(step);
  at_ = position.at;
  only_z_ = false;
  commanded_ = at_;
  if (!position.is_known()) commanded_.reset();
}

CommandResult MachineState::take() {
  CommandResult result;
  result.path = std::move(path);
  result.tools = numbers_.own();
  result.stock = std::move(stock);
  result.resolution = mm(resolution);
  result.shown = shown;
  result.files = std::move(files_);
  result.programs = std::move(programs_);
  return result;
}

}  // namespace kerf::scad
