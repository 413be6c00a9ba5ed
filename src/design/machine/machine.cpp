// The motions, the tool and the files of a program's commands.
#include "design/machine/machine.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "kerf/base/limits.h"
#include "kerf/op/printer.h"
#include "kerf/path/passes.h"

namespace kerf::design {
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

/// Whether a path changes the tool from a step on before it cuts.
bool changes_tool_first(const Toolpath& path, std::size_t from) {
  for (std::size_t i = from; i < path.size(); ++i) {
    const StepKind kind = path[i].kind();
    if (kind == StepKind::tool_change) return true;
    if (kind == StepKind::cut || kind == StepKind::arc || kind == StepKind::extrude) return false;
  }
  return false;
}

/// Names that a DXF layer cannot have.
constexpr std::string_view kNotInLayers = "<>/\\\":;?*|=,`\r\n";

}  // namespace

Machine::Machine(const MachineOptions& options)
    : options_(options), numbers_(options.tools == nullptr ? ToolTable() : *options.tools) {
  settings.post = "carbide";
  settings.ending = ".nc";
}

// ---- the call that runs

Machine::Running::Running(Machine& state, Call& call)
    : state_(state), before_(state.call_), origin_before_(state.origin_) {
  state_.call_ = &call;
  state_.origin_ = OriginId::none;
}
Machine::Running::~Running() {
  state_.call_ = before_;
  state_.origin_ = origin_before_;
}

Call& Machine::call() {
  assert(call_ != nullptr);
  return *call_;
}

OriginId Machine::here() {
  if (origin_ == OriginId::none) origin_ = call().site().origin(path_->origins());
  return origin_;
}

void Machine::warn(std::string message) { call().site().warning(std::move(message)); }

void Machine::expect_tool(std::string_view shape, std::string_view command) {
  if (tool_.shape() != shape)
    warn(fmt::format("{}: a {} should be in use, not a {}", command, shape, tool_.shape()));
}
void Machine::expect_number(int number) {
  if (numbers_.maker_number(number) != tool_.number)
    warn(fmt::format("{}: tool {} is in use, not {}; toolchange({}) changes to it", call().command().name,
                     tool_.given, number, number));
}
Diagnostics& Machine::diagnostics() { return call().site().diagnostics(); }
Origin Machine::where() { return call().site().where(); }
void Machine::stop_after_errors(std::size_t errors) {
  if (diagnostics().errors() > errors) throw Reported{};
}
RegionOptions Machine::region_options() {
  RegionOptions region;
  region.name = call().command().name;
  region.where = where();
  region.progress = options_.progress;
  return region;
}

// ---- the object

void Machine::start(Mode mode, bool gcode, bool dxf, double pitch) {
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
  tool_ = {kDefaultTool, kDefaultTool, numbers_.tool(kDefaultTool), false};
  if (const auto height = call().site().variable("retractheight")) retract_height = *height;
  if (mode == Mode::cut) announce_tool(here());
}

// ---- position

void Machine::set_axis(int axis, double value) { at_[axis] = coordinate(value, "the position"); }

void Machine::catch_up() {
  if (!commanded_) return;
  const Point3 last = *commanded_;
  const bool away = distance(at_, last) > kFar;
  if (!only_z_ && !away) return;
  switch_beam(false);
  if (away)
    warn(
        fmt::format("the position was set to X{:g} Y{:g} Z{:g} without a motion from X{:g} Y{:g} Z{:g}: a "
                    "rapid to it is added",
                    at_.x, at_.y, at_.z, last.x, last.y, last.z));
  if (at_.z > last.z + kFar && !only_z_)
    path_->add(step::Rapid{{last.x, last.y, at_.z}}, here());
  else if (at_.z < last.z - kFar)
    path_->add(step::Rapid{{at_.x, at_.y, last.z}}, here());
  path_->add(step::Rapid{at_}, here());
  commanded_ = at_;
  only_z_ = false;
}

void Machine::arrive(Point3 to) {
  at_ = to;
  commanded_ = to;
  only_z_ = false;
}

void Machine::turn_with(std::size_t step) {
  if (!rotary) return;
  MotionExtra extra;
  extra.abc = {*rotary, 0.0, 0.0};
  path_->set_extra(step, std::move(extra));
}

double Machine::feed_to(Point3 to, std::optional<double> given) const {
  if (given) return positive(*given, "feed");
  const bool down = to.z < at_.z && std::hypot(to.x - at_.x, to.y - at_.y) <= kFar;
  const auto ratio = ratios.find(tool_.feed_class());
  return (down ? plunge : feed) * (ratio == ratios.end() ? 1.0 : ratio->second);
}

// ---- motions

void Machine::rapid(Point3 to) {
  check_position(to);
  switch_beam(false);
  const bool only_z = !commanded_ && std::abs(to.x - at_.x) <= kFar && std::abs(to.y - at_.y) <= kFar;
  if (!only_z) {
    catch_up();
    turn_with(path_->add(step::Rapid{to}, here()));
    arrive(to);
    return;
  }
  // X and Y have no commanded position yet: they must not move.
  path_->set_unknown_axes(path_->add(step::Rapid{{0.0, 0.0, to.z}}, here()), kXY);
  arrive(to);
  only_z_ = true;
}

void Machine::reposition(Point3 to) {
  check_position(to);
  const double height = std::max({retract_height, at_.z, to.z});
  const bool across = distance(at_.xy(), to.xy()) > kFar;
  const bool turns = spindle_ && spindle_->turn != SpindleTurn::off;
  if (turns && !beam_ && commanded_ && across) {
    if (height > at_.z + kFar) rapid_z(height);
    rapid({to.x, to.y, height});
    if (height <= to.z + kFar) return;
  }
  rapid(to);
}

void Machine::move_to_safe_z() {
  note("Move to safe Z to avoid workholding");
  const Point3 to{at_.x, at_.y, retract_height};
  if (commanded_ && !only_z_) return rapid(to);
  path_->set_unknown_axes(path_->add(step::Rapid{{0.0, 0.0, to.z}}, here()), kXY);
  arrive(to);
  only_z_ = true;
}

void Machine::cut(Point3 to, std::optional<double> feed_given) {
  check_position(to);
  const double speed = feed_to(to, feed_given);
  catch_up();
  mark_tool();
  switch_beam(true);
  turn_with(path_->add(step::Cut{to, mm_per_min(speed)}, here()));
  arrive(to);
}

void Machine::arc_to(Point3 to, Point2 centre, Turn turn, int extra_turns) {
  check_position(to);
  const double speed = feed_to({to.x, to.y, limits::kMaxCoordinate}, {});
  const double first = distance(at_.xy(), centre), last = distance(to.xy(), centre);
  if (!ArcMismatch{.limit = mm(kLargestArcError)}.permits(first, last))
    refuse(fmt::format("the arc starts {:.4f} mm from its centre and ends {:.4f} mm from it", first, last));
  catch_up();
  if (!commanded_) path_->add(step::Rapid{at_}, here());  // an arc needs a commanded start
  mark_tool();
  switch_beam(true);
  step::Arc arc;
  arc.to = to;
  arc.centre = centre;
  arc.turn = turn;
  arc.extra_turns = extra_turns;
  arc.feed = mm_per_min(speed);
  path_->add(arc, here());
  arrive(to);
}

void Machine::arc(const ArcBetween& arc) {
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

void Machine::extrude(Point3 to, double volume, double width, double height, double feed_given) {
  check_position(to);
  catch_up();
  step::Extrude bead;
  bead.to = to;
  bead.feed = mm_per_min(positive(feed_given, "feedrate"));
  bead.volume = mm3(volume);
  bead.width = mm(width);
  bead.height = mm(height);
  path_->add(bead, here());
  arrive(to);
}

void Machine::draw_back(double volume, double feed_given) {
  if (!commanded_) refuse_now("the position of the nozzle is unknown; move it first");
  catch_up();
  step::Extrude bead;
  bead.to = at_;
  bead.feed = mm_per_min(positive(feed_given, "extrusionfeed"));
  bead.volume = mm3(-volume);
  path_->add(bead, here());
  if (volume < 0.0) prime.volume = std::max(0.0, prime.volume + volume);
}

void Machine::follow(const Outline& outline, double z) {
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

void Machine::cut_outlines(const std::vector<Outline>& outlines, double z) {
  for (const Outline& outline : outlines) {
    lift();
    rapid_xy(outline.start);
    cut_at(outline.start, z);
    follow(outline, z);
  }
  lift();
}

// ---- tools

void Machine::change_tool(int number, double speed) {
  const int maker = numbers_.maker_number(number);
  catch_up();
  tool_ = {maker, number, numbers_.tool(maker), false};
  spindle_ = step::Spindle{rpm(speed), speed > 0.0 ? SpindleTurn::cw : SpindleTurn::off};
  note("Toolpath");
  announce_tool(here());
  write_further_lines(Moment::tool_changed);
}

/// The tool in use and its spindle as steps.
void Machine::announce_tool(OriginId where) {
  path_->add(step::ToolChange{tool_.number}, where);
  if (spindle_) path_->add(*spindle_, where);
  tool_stated_ = true;
}

void Machine::keep_tool() {
  if (tool_stated_) announce_tool(here());
}

/// The tool in use cuts: its number keeps its meaning from now on.
void Machine::mark_tool() {
  if (last_used_ == tool_.number) return;
  used_.insert(tool_.number);
  last_used_ = tool_.number;
}

void Machine::add_tool(int number, Tool tool) {
  if (used_.count(number) != 0)
    refuse_now(fmt::format("tool {} has cut already; another tool needs another number", number));
  numbers_.add(number, std::move(tool));
  if (tool_.number == number) tool_.tool = numbers_.tool(number);
}

void Machine::describe_tool(Tool tool) {
  const bool has_cut = used_.count(tool_.number) != 0;
  const int number = has_cut ? numbers_.free_number(tool_.number) : tool_.number;
  numbers_.add(number, std::move(tool));
  tool_ = {number, has_cut ? number : tool_.given, numbers_.tool(number), true};
  if (has_cut) announce_tool(here());
}

// ---- lasers

void Machine::set_beam(const step::LaserPower& beam) {
  switch_beam(false);
  beam_.reset();
  if (beam.power > 0.0) beam_ = beam;
}

/// The beam is on during cuts alone.
void Machine::switch_beam(bool on) {
  if (!beam_ || on == beam_is_on_) return;
  path_->add(on ? *beam_ : step::LaserPower{LaserMode::off, 0.0}, here());
  beam_is_on_ = on;
}

// ---- drawing

std::string Machine::layer_for(int tool_number) const {
  if (layer) return *layer;
  if (settings.layers == FileSettings::Layers::by_tool) return fmt::format("Tool {}", tool_number);
  if (settings.layers != FileSettings::Layers::by_depth) return colour.layer();
  std::string name = fmt::format("Tool {} to {:.3f}", tool_number, at_.z);
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

void Machine::draw(int tool_number, Sketch::Entity entity) {
  if (!settings.dxf) return;
  const std::string name = layer_for(tool_number);
  if (name.find_first_of(kNotInLayers) != std::string::npos)
    refuse("layer: a name without <>/\\\":;?*|=,` is required");
  const auto own = tool_sketches_.find(tool_number);
  if (own != tool_sketches_.end()) own->second.add(name, colour.index, entity);
  sketch_.add(name, colour.index, std::move(entity));
}

std::string Machine::dxf_of(const Sketch& sketch, Point2 stagger) const {
  return write_dxf(sketch.drawing(settings.chains, stagger), settings.version);
}

/// The offset of the colours of a drawing.
Point2 Machine::stagger() const {
  if (!settings.stagger) return {};
  if (!stock) refuse_now("drawings offset by colour: setupstock must be called first");
  return stock->block.high.xy() - stock->block.low.xy();
}

std::string Machine::dxf() const { return dxf_of(sketch_, stagger()); }
std::string Machine::svg() const { return write_svg(sketch_.drawing(settings.chains, stagger())); }

void Machine::sketch_tools(const std::vector<int>& tools) {
  tool_sketches_.clear();
  if (settings.dxf)
    for (const int number : tools)
      if (number != 0) tool_sketches_[number];
}

// ---- texts and files

void Machine::note(std::string_view text) { path_->add(step::Note{std::string(text)}, here()); }

void Machine::write_line(const std::string& line) {
  if (line.size() > 1 && line.front() == '(' && line.back() == ')')
    note(std::string_view(line).substr(1, line.size() - 2));
  else
    add_verbatim(line);
}

/// Refused now, not when the file is closed and all of it would be lost.
void Machine::add_verbatim(const std::string& line) {
  if (options_.check_line && settings.gcode)
    if (auto reason = options_.check_line(line, settings.post)) refuse(std::move(*reason));
  path_->add(step::Verbatim{line}, here());
}

void Machine::write_further_lines(Moment moment) {
  if (!options_.further_lines) return;
  for (const std::string& line : options_.further_lines(moment, tool_.number)) write_line(line);
}

void Machine::add_file(std::string name, std::string bytes) {
  std::erase_if(files_, [&](const DesignFile& file) { return file.name == name; });
  files_.push_back({std::move(name), std::move(bytes)});
}

void Machine::note_stock(std::vector<std::string> lines) {
  if (stock_note_steps_.empty()) {
    for (const std::string& line : lines) {
      stock_note_steps_.push_back(path_->size());
      note(line);
    }
  } else {
    replace_stock_notes(lines);
  }
  stock_notes_ = std::move(lines);
}

/// A path states one stock: readers take the first, or refuse two.
void Machine::replace_stock_notes(const std::vector<std::string>& lines) {
  Toolpath changed;
  changed.origins() = path_->origins();
  for (std::size_t i = 0; i < path_->size(); ++i) {
    const auto found = std::find(stock_note_steps_.begin(), stock_note_steps_.end(), i);
    if (found == stock_note_steps_.end())
      changed.add_copy(*path_, i);
    else
      changed.add(step::Note{lines[static_cast<std::size_t>(found - stock_note_steps_.begin())]},
                  (*path_)[i].origin());
  }
  *path_ = std::move(changed);
}

void Machine::open_program(std::string name) {
  gcode_name = std::move(name);
  file_ = next_file_;
}

Toolpath Machine::program() const {
  if (file_.step == 0) return without_unused_first_tool(*path_);
  Toolpath program;
  const OriginId where = program.copy_origin(*path_, file_.step - 1);
  if (file_.tool && !changes_tool_first(*path_, file_.step)) {
    program.add(step::ToolChange{*file_.tool}, where);
    if (file_.spindle) program.add(*file_.spindle, where);
  }
  if (stock_note_steps_.empty() || stock_note_steps_.front() < file_.step)
    for (const std::string& line : stock_notes_) program.add(step::Note{line}, where);
  if (file_.at) {  // where the file before has left the tool: in Z first
    program.set_unknown_axes(program.add(step::Rapid{{0.0, 0.0, file_.at->z}}, where), kXY);
    program.add(step::Rapid{*file_.at}, where);
  }
  for (std::size_t i = file_.step; i < path_->size(); ++i) program.add_copy(*path_, i);
  return program;
}

void Machine::close_program() {
  std::erase_if(programs_, [&](const DesignProgram& made) { return made.name == *gcode_name; });
  programs_.push_back({*gcode_name, settings.post, program(), mm_per_min(feed)});
  gcode_name.reset();
  next_file_ = {path_->size(), {}, spindle_, {}};
  if (tool_stated_) next_file_.tool = tool_.number;
  if (!only_z_) next_file_.at = commanded_;
}

void Machine::home(unsigned axes) {
  add_home(*path_, axes, here());
  commanded_.reset();
}

void Machine::end_program() {
  if (mode_ == Mode::print) {
    switch_off(*path_, here());
    home(1);
  }
  switch_beam(false);
  if (mode_ == Mode::cut && commanded_ && at_.z < retract_height) lift();
}

void Machine::restart_path() {
  auto path = std::make_shared<Toolpath>();
  path->origins() = path_->origins();  // callers keep the ids of locations
  path_ = std::move(path);
  origin_ = OriginId::none;
  commanded_.reset();
  only_z_ = false;
  beam_is_on_ = false;
  stock_note_steps_.clear();
  used_.clear();
  last_used_ = -1;
  file_ = next_file_ = {};
}

void Machine::continue_path(const Toolpath& program) {
  restart_path();
  for (std::size_t i = 0; i < program.size(); ++i) path_->add_copy(program, i);
  PathPosition position;
  for (const Step& step : path_->steps()) position.pass(step);
  at_ = position.at;
  if (position.is_known()) commanded_ = at_;
}

Results Machine::take() {
  Results result;
  result.path = std::move(*path_);
  result.tools = numbers_.own();
  result.stock = std::move(stock);
  result.resolution = mm(resolution);
  result.shown = shown;
  result.files = std::move(files_);
  result.programs = std::move(programs_);
  return result;
}

}  // namespace kerf::design
