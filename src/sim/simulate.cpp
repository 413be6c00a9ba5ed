// The driver: checks what it is given, sends the planner's batches through the kernels, gathers what they
// found.
#include "kerf/simulate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <map>
#include <utility>

#include "sim/kernels.h"
#include "sim/parallel.h"
#include "sim/plan.h"
#include "sim/start.h"
#include "sim/walls.h"

#include "kerf/names.h"
#include "kerf/number.h"

namespace kerf {

std::string_view to_string(HazardKind kind) {
  switch (kind) {
    case HazardKind::rapid_in_stock: return "rapid_in_stock";
    case HazardKind::neck_contact: return "neck_contact";
    case HazardKind::shank_contact: return "shank_contact";
    case HazardKind::holder_contact: return "holder_contact";
    case HazardKind::over_flute: return "over_flute";
    case HazardKind::below_floor: return "below_floor";
    case HazardKind::spindle_off: break;
  }
  return "spindle_off";
}

namespace sim {
namespace {

// What is accepted. Beyond it single precision or patience ends, and the input is a slip in any case.
constexpr double kLargestStock = 1e5;                            // mm
constexpr double kFarthestMotion = 1e7;                          // mm from the stock
constexpr double kFinestPitch = 1e-4;                            // mm
constexpr double kDefaultColumns = 4e6;                          // of the automatic resolution
constexpr double kDefaultFinest = 0.02, kDefaultCoarsest = 1.0;  // mm
constexpr double kMostDefaultColumns = 5e7;                      // a coarser one rather than more
/// Sideways contacts below this are rounding, even where no depth at all is to be ignored, mm.
constexpr double kLeastClearance = 1e-4;

// ---- what is asked for

bool stock_is_sound(const Stock& stock, Diagnostics& diagnostics) {
  const Box3& block = stock.block;
  const Point3 size = block.size();
  if (!finite(block.low) || !finite(block.high) || !(size.x > 0.0) || !(size.y > 0.0) || !(size.z > 0.0)) {
    diagnostics.error(Code::stock_empty, {},
                      "the stock is empty: its length, width and height must be above 0");
    return false;
  }
  const double largest = std::max({size.x, size.y, size.z});
  const double reach =
      std::max(std::max(length(block.low), length(block.high)) / kFarthestMotion, largest / kLargestStock);
  if (reach <= 1.0) return true;
  diagnostics.error(Code::stock_empty, {},
                    fmt::format("the stock measures {} x {} x {} mm; at most {} mm can be simulated",
                                number_text(size.x, 3), number_text(size.y, 3), number_text(size.z, 3),
                                number_text(kLargestStock, 0)));
  return false;
}

/// The column pitch to use, or nothing with an error.
std::optional<double> choose_pitch(const SimulationOptions& options, const Stock& stock,
                                   Diagnostics& diagnostics) {
  const Point3 size = stock.block.size();
  double pitch = options.resolution.mm();
  if (pitch == 0.0 && stock.body) pitch = stock.body->pitch().value_or(Length()).mm();
  if (pitch == 0.0) {
    const double area = size.x * size.y;
    pitch = std::clamp(std::sqrt(area / kDefaultColumns), kDefaultFinest, kDefaultCoarsest);
    pitch = std::max(pitch, std::sqrt(area / kMostDefaultColumns));
  }
  if (!std::isfinite(pitch) || pitch < kFinestPitch) {
    diagnostics.error(
        Code::bad_resolution, {},
        fmt::format("the resolution is {} mm; expected a length of at least {} mm, or 0 to have one chosen",
                    number_text(pitch, 9), number_text(kFinestPitch, 4)));
    return std::nullopt;
  }
  pitch = std::min(pitch, std::max(size.x, size.y));  // never less than one column
  const double columns = std::ceil(size.x / pitch) * std::ceil(size.y / pitch);
  const auto most = static_cast<double>(std::min(options.max_columns, std::size_t{0xfffffff0}));
  if (columns <= most) return pitch;
  // The finest that does for certain: (x / p + 1) (y / p + 1) = most, for the last column may be a part of
  // one.
  const double area = size.x * size.y, edges = size.x + size.y, longest = std::max(size.x, size.y);
  const double root = std::sqrt(edges * edges + 4.0 * area * std::max(most - 1.0, 0.0));
  const double would_do = root > edges ? std::min(2.0 * area / (root - edges), longest) : longest;
  Diagnostic& error =
      diagnostics.error(Code::too_many_columns, {},
                        fmt::format("a resolution of {} mm needs {:.0f} columns; at most {:.0f} are allowed",
                                    number_text(pitch, 6), columns, most));
  error.hint = fmt::format("a resolution of {} mm would do", number_text(std::ceil(would_do * 1e4) / 1e4, 4));
  return std::nullopt;
}

/// Which tool cuts where, found before anything is cut so that a missing tool costs no time.
struct Survey {
  std::map<int, std::uint32_t> index;  // tool number to place in `solids`
  std::vector<ToolSolids> solids;
  std::optional<int> only_tool;  // of a table with one tool: used until the program chooses
  bool judges_spindle = false;   // the program says something of the spindle and is not for a laser
};

class Surveyor {
 public:
  Surveyor(const Toolpath& path, const ToolTable& tools, const Stock& stock, double clearance,
           Diagnostics& diagnostics)
      : path_(path),
        tools_(tools),
        centre_(0.5 * (stock.block.low + stock.block.high)),
        clearance_(clearance),
        diagnostics_(diagnostics) {}

  Survey run() {
    if (tools_.tools().size() == 1) survey_.only_tool = tools_.tools().begin()->first;
    bool has_spindle = false, has_laser = false;
    for (const Step& step : path_.steps()) {
      has_spindle = has_spindle || step.kind() == StepKind::spindle;
      has_laser = has_laser || step.kind() == StepKind::laser_power;
    }
    survey_.judges_spindle = has_spindle && !has_laser;
    for_each_motion(path_, [&](const Step& step, const MotionContext& context) { look_at(step, context); });
    return std::move(survey_);
  }

 private:
  void look_at(const Step& step, const MotionContext& context) {
    check_place(step, context);
    check_extras(step, context);
    const std::optional<int> number = context.tool ? context.tool : survey_.only_tool;
    if (number && survey_.index.count(*number) == 0) add_tool(*number);
    if (!step.is_cutting()) return;
    if (!number) return no_tool(context);
    if (survey_.index.count(*number) == 0) no_such_tool(*number, context);
    if (step.kind() == StepKind::arc && context.unknown_from == 0 &&
        chord_count(walk_of(step, context.from)).too_coarse)
      diagnostics_.warning(Code::coarse_arc, path_.origin_of(context.index),
                           "the arc is so long that it is simulated with chords coarser than usual");
    if (step.unknown_axes() != 0) warn_unknown_place(step.unknown_axes(), context);
  }

  void add_tool(int number) {
    const Tool* tool = tools_.find(number);
    if (tool == nullptr) return;
    survey_.index[number] = static_cast<std::uint32_t>(survey_.solids.size());
    survey_.solids.push_back(make_tool_solids(tool->silhouette, mm(clearance_)));
  }

  void check_place(const Step& step, const MotionContext& context) {
    Point3 arc_centre = centre_;
    if (step.kind() == StepKind::arc) {
      const Point2 c = step.arc().centre;
      arc_centre = centre_ + Point3{c.x, c.y, 0.0};
    }
    if (distance(step.to(), centre_) < kFarthestMotion && distance(arc_centre, centre_) < kFarthestMotion)
      return;
    diagnostics_.error(Code::motion_out_of_range, path_.origin_of(context.index),
                       fmt::format("the motion goes further than {} km from the stock",
                                   number_text(kFarthestMotion * 1e-6, 0)));
  }

  void check_extras(const Step& step, const MotionContext& context) {
    if (step.kind() == StepKind::extrude)
      once(Code::extrusion_not_simulated, context,
           "printing is not simulated; extruding moves are passed over");
    const MotionExtra* extra = path_.extra(context.index);
    if (extra == nullptr) return;
    if (extra->abc)
      once(Code::rotary_not_simulated, context,
           "rotary axes are not simulated here; the tool is taken as upright throughout, see --rotary");
    if (!extra->z_correction.empty())
      once(Code::z_correction_not_simulated, context,
           "corrections of Z by measured points are not simulated");
  }

  void no_such_tool(int number, const MotionContext& context) {
    if (std::find(missing_.begin(), missing_.end(), number) != missing_.end()) return;
    missing_.push_back(number);
    Diagnostic& error =
        diagnostics_.error(Code::no_such_tool, path_.origin_of(context.index),
                           fmt::format("tool {} cuts here, but its shape is not known", number));
    error.hint = fmt::format("give a tool {}, for example \"square d=3.175 flute=12.7\"", number);
  }

  void no_tool(const MotionContext& context) {
    if (std::exchange(said_no_tool_, true)) return;
    Diagnostic& error = diagnostics_.error(Code::no_tool_chosen, path_.origin_of(context.index),
                                           "the program cuts here before it has chosen a tool");
    error.hint = "give exactly one tool, which is then used until the program chooses another";
  }

  void warn_unknown_place(unsigned axes, const MotionContext& context) {
    constexpr unsigned kAxisZ = 4;
    std::vector<std::string> unknown, taken;
    for (unsigned axis = 0; axis < 3; ++axis) {
      if ((axes >> axis & 1u) == 0) continue;
      unknown.emplace_back(1, "XYZ"[axis]);
      if (axis < 2) taken.push_back(fmt::format("{}0", "XYZ"[axis]));
    }
    std::string message = fmt::format("the program cuts here before it has said where {} {}; ",
                                      list_text(unknown, "and"), unknown.size() == 1 ? "is" : "are");
    if (!taken.empty())
      message += fmt::format("{} {} taken", list_text(taken, "and"), taken.size() == 1 ? "is" : "are");
    if ((axes & kAxisZ) != 0)
      message += taken.empty() ? "without it nothing is cut" : ", and without a Z nothing is cut";
    once(Code::cut_at_unknown_place, context, std::move(message));
  }

  void once(Code code, const MotionContext& context, std::string message) {
    if (std::find(said_.begin(), said_.end(), code) != said_.end()) return;
    said_.push_back(code);
    diagnostics_.warning(code, path_.origin_of(context.index), std::move(message));
  }

  const Toolpath& path_;
  const ToolTable& tools_;
  Point3 centre_;
  double clearance_;
  Diagnostics& diagnostics_;
  Survey survey_;
  std::vector<int> missing_;
  std::vector<Code> said_;
  bool said_no_tool_ = false;
};

// ---- the run

/// Along one axis: each column's share in the block, and its place from the first column of its tile.
struct ColumnPlaces {
  std::vector<Real> share, place;
  void add(double column_share, double column_place, int number, double pitch) {
    const int first = number / kTileColumns * kTileColumns;
    share.push_back(static_cast<Real>(column_share));
    place.push_back(static_cast<Real>(column_place - (first + 0.5) * pitch));
  }
};

class Run {
 public:
  Run(Workpiece& workpiece, const Toolpath& path, Survey survey, const SimulationOptions& options,
      Progress* progress)
      : body_(workpiece.body()),
        path_(path),
        survey_(std::move(survey)),
        hazard_depth_(options.hazard_depth),
        is_no_go_(options.role == SolidRole::no_go),
        threads_(thread_count(options.threads)),
        progress_(progress),
        removed_(path.size(), 0.0) {
    for (const ToolSolids& solids : survey_.solids) tools_.emplace_back(solids);
    field_.pitch = body_.pitch;
    field_.height = body_.height;
    field_.same_height = body_.same_height;
    field_.hazard_depth = static_cast<Real>(options.hazard_depth.mm());
    for (int i = 0; i < kTileColumns; ++i) field_.step[i] = static_cast<Real>(i * body_.pitch);
    for (int i = 0; i < body_.tiles_x * kTileColumns; ++i)
      along_x_.add(body_.share_x(i), body_.place_x(std::min(i, body_.nx - 1)), i, body_.pitch);
    for (int j = 0; j < body_.tiles_y * kTileColumns; ++j)
      along_y_.add(body_.share_y(j), body_.place_y(std::min(j, body_.ny - 1)), j, body_.pitch);
  }

  void cut_all() {
    if (progress_ != nullptr) progress_->phase("cutting");
    in_tile_.assign(body_.tiles.size(), {});
    send_all(nullptr);
    report(progress_, 1.0);
  }

  /// Counts the columns at walls anew, see walls.h. Stopped meanwhile, all is as it was before.
  void refine_walls();

  bool stopped() const { return stopped_; }
  double removed_length(std::size_t step) const { return removed_[step]; }
  std::vector<Hazard> hazards() const;

 private:
  /// From a first step to a last one; none while the first is after the last.
  struct Steps {
    std::size_t first = SIZE_MAX, last = 0;
    void add(const Steps& more) {
      first = std::min(first, more.first);
      last = std::max(last, more.last);
    }
  };
  std::vector<Steps> steps_in(const std::vector<bool>& tiles) const;

  bool is_wanted(std::size_t step) {
    while (next_wanted_ < wanted_.size() && wanted_[next_wanted_].last < step) ++next_wanted_;
    return next_wanted_ < wanted_.size() && wanted_[next_wanted_].first <= step;
  }

  void add(const Step& step, const MotionContext& context) {
    if (!is_wanted(context.index)) return planner_->interrupt();
    if (step.kind() == StepKind::probe || step.kind() == StepKind::extrude) return planner_->interrupt();
    const std::optional<int> number = context.tool ? context.tool : survey_.only_tool;
    const auto tool = number ? survey_.index.find(*number) : survey_.index.end();
    if (tool == survey_.index.end()) return planner_->interrupt();  // a rapid before the first tool
    const bool spindle_off =
        is_no_go_ ||
        (survey_.judges_spindle && (!context.spindle_stated || context.spindle.turn == SpindleTurn::off));
    planner_->add(step, context, tool->second, spindle_off, batch_, [&] { return flush(context.index); });
    if (batch_.full()) flush(context.index);
  }

  /// Plans all motions and cuts them, in batches; given tiles, only what goes there.
  void send_all(const std::vector<bool>* tiles) {
    planner_.emplace(body_, survey_.solids, hazard_depth_, PlanScope{.margin = body_.pitch, .tiles = tiles});
    wanted_ = tiles == nullptr ? std::vector{Steps{0, path_.size()}} : steps_in(*tiles);
    next_wanted_ = 0;
    for_each_motion(path_, [&](const Step& step, const MotionContext& context) {
      if (!stopped_) add(step, context);
    });
    if (!stopped_) flush(path_.size());
  }

  bool flush(std::size_t steps_done);
  void sort_by_tile();
  void cut_tile_number(std::size_t k);
  void merge_contacts();
  void merge(const Contact& contact);

  Workpiece::Body& body_;
  const Toolpath& path_;
  Survey survey_;
  Length hazard_depth_;
  bool is_no_go_;
  std::optional<Planner> planner_;
  unsigned threads_;
  Progress* progress_;
  std::vector<LaneTool> tools_;
  Field field_{};
  ColumnPlaces along_x_, along_y_;
  std::vector<double> removed_;  // length of column, one a step
  WallGroup* walls_ = nullptr;   // what is cut instead of the workpiece, if any
  std::vector<Steps> wanted_;    // to be planned, in order and apart
  std::size_t next_wanted_ = 0;
  std::vector<Steps> in_tile_;  // which steps each tile has seen
  bool stopped_ = false;

  Batch batch_;
  // The batch's pairs in order of tiles: tile busy_[k] has the sweeps list_[start_[k]] to list_[start_[k + 1]
  // - 1].
  std::vector<std::uint32_t> busy_, list_;
  std::vector<std::size_t> start_, order_;
  std::vector<std::uint32_t> count_;
  std::vector<double> pair_removed_;
  std::vector<std::vector<Contact>> contacts_;
  std::map<std::pair<std::uint32_t, HazardKind>, Contact> merged_;
};

void Run::sort_by_tile() {
  count_.resize(body_.tiles.size(), 0);
  busy_.clear();
  for (const Batch::Pair& pair : batch_.pairs)
    if (count_[pair.tile]++ == 0) busy_.push_back(pair.tile);
  std::sort(busy_.begin(), busy_.end());
  start_.assign(1, 0);
  for (const std::uint32_t tile : busy_) {
    start_.push_back(start_.back() + count_[tile]);
    count_[tile] =
        static_cast<std::uint32_t>(start_[start_.size() - 2]);  // from here on where the next one goes
  }
  list_.resize(batch_.pairs.size());
  for (const Batch::Pair& pair : batch_.pairs) list_[count_[pair.tile]++] = pair.sweep;
  for (std::size_t k = 0; k < busy_.size(); ++k) {
    count_[busy_[k]] = 0;
    in_tile_[busy_[k]].add(
        {batch_.sweeps[list_[start_[k]]].step, batch_.sweeps[list_[start_[k + 1] - 1]].step});
  }
  order_.resize(busy_.size());
  for (std::size_t k = 0; k < order_.size(); ++k) order_[k] = k;
  // The largest first, so that the threads end together.
  std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    const std::size_t na = start_[a + 1] - start_[a], nb = start_[b + 1] - start_[b];
    return na != nb ? na > nb : a < b;
  });
}

void Run::cut_tile_number(std::size_t k) {
  const std::size_t tile = busy_[k];
  const auto tiles_x = static_cast<std::size_t>(body_.tiles_x);
  const auto column = static_cast<int>(tile % tiles_x) * kTileColumns;
  const auto row = static_cast<int>(tile / tiles_x) * kTileColumns;
  TileJob job;
  job.field = &field_;
  job.x = (column + 0.5) * body_.pitch;
  job.y = (row + 0.5) * body_.pitch;
  const bool at_border = column + kTileColumns >= body_.nx || row + kTileColumns >= body_.ny;
  if (at_border) {
    job.place_x = along_x_.place.data() + column;
    job.place_y = along_y_.place.data() + row;
    job.share_x = along_x_.share.data() + column;
    job.share_y = along_y_.share.data() + row;
  }
  job.tools = &tools_;
  job.sweeps = batch_.sweeps.data();
  job.list = list_.data() + start_[k];
  job.count = start_[k + 1] - start_[k];
  job.removed = pair_removed_.data() + start_[k];
  job.contacts = &contacts_[k];
  if (walls_ != nullptr) return walls_->cut(tile, job);
  job.tile = &body_.touch(tile);
  cut_tile(job);
}

std::vector<Run::Steps> Run::steps_in(const std::vector<bool>& tiles) const {
  std::vector<Steps> all;
  for (std::size_t tile = 0; tile < tiles.size(); ++tile)
    if (tiles[tile] && in_tile_[tile].first <= in_tile_[tile].last) all.push_back(in_tile_[tile]);
  std::sort(all.begin(), all.end(), [](const Steps& a, const Steps& b) { return a.first < b.first; });
  std::vector<Steps> apart;
  for (const Steps& next : all) {
    if (apart.empty() || apart.back().last < next.first) {
      apart.push_back(next);
    } else {
      apart.back().add(next);
    }
  }
  return apart;
}

void Run::refine_walls() {
  if (stopped_) return;
  const std::vector<WallColumns> found = find_walls(body_, threads_);
  if (found.empty()) return;
  if (progress_ != nullptr) progress_->phase("measuring walls");
  std::vector<double> counted = removed_;
  double excess = 0.0;
  for (std::size_t next = 0; next < found.size() && !stopped_;) {
    WallGroup group(body_, found, next);
    walls_ = &group;
    send_all(&group.tiles());
    excess += group.excess();
    walls_ = nullptr;
  }
  if (stopped_) {
    removed_ = std::move(counted);
  } else {
    body_.wall_volume = excess * body_.pitch * body_.pitch;
  }
  report(progress_, 1.0);
}

bool Run::flush(std::size_t steps_done) {
  sort_by_tile();
  pair_removed_.assign(list_.size(), 0.0);
  contacts_.assign(busy_.size(), {});
  parallel_for(
      threads_, busy_.size(), [&](std::size_t n) { cut_tile_number(order_[n]); },
      [&] { return stopped_ = stopped_ || stop_requested(progress_); });
  // In order of tiles, whichever thread was first: sums of floating numbers depend on the order.
  for (std::size_t k = 0; k < list_.size(); ++k) removed_[batch_.sweeps[list_[k]].step] += pair_removed_[k];
  if (walls_ == nullptr) merge_contacts();
  batch_.clear();
  report(progress_,
         path_.size() == 0 ? 1.0 : static_cast<double>(steps_done) / static_cast<double>(path_.size()));
  stopped_ = stopped_ || stop_requested(progress_);
  return !stopped_;
}

void Run::merge_contacts() {
  for (const Contact& contact : batch_.contacts) merge(contact);
  for (const std::vector<Contact>& of_tile : contacts_)
    for (const Contact& contact : of_tile) merge(contact);
}

void Run::merge(const Contact& contact) {
  const auto [it, is_new] = merged_.try_emplace({contact.step, contact.kind}, contact);
  if (is_new) return;
  Contact& all = it->second;
  if (contact.share < all.share) {
    all.share = contact.share;
    all.at = contact.at;
  }
  all.depth = std::max(all.depth, contact.depth);
  all.removed += contact.removed;
}

std::vector<Hazard> Run::hazards() const {
  std::vector<Hazard> list;
  for (const auto& [key, contact] : merged_)
    list.push_back(
        {key.second, key.first, contact.at + body_.bounds.low, mm(contact.depth), mm3(contact.removed)});
  return list;
}

}  // namespace
}  // namespace sim

std::optional<Simulation> simulate(const Toolpath& path, const ToolTable& tools, const Stock& stock,
                                   const SimulationOptions& options, Diagnostics& diagnostics,
                                   Progress* progress) {
  const auto begin = std::chrono::steady_clock::now();
  if (!sim::stock_is_sound(stock, diagnostics)) return std::nullopt;
  const std::optional<double> pitch = sim::choose_pitch(options, stock, diagnostics);
  if (!pitch) return std::nullopt;
  const std::size_t errors_before = diagnostics.errors();
  const double clearance = std::max(options.hazard_depth.mm(), sim::kLeastClearance);
  sim::Survey survey = sim::Surveyor(path, tools, stock, clearance, diagnostics).run();
  if (diagnostics.errors() != errors_before) return std::nullopt;

  Simulation result{.workpiece = Workpiece(stock, mm(*pitch)),
                    .stock = {},
                    .removed = {},
                    .hazards = {},
                    .removed_by_step = {}};
  const Point3 size = stock.block.size();
  result.stock = mm3(size.x * size.y * size.z);
  if (stock.body) {
    if (!sim::fill_from_body(result.workpiece.body(), *stock.body, diagnostics, progress))
      return std::nullopt;
    result.stock = result.workpiece.volume();
  }
  sim::Run run(result.workpiece, path, std::move(survey), options, progress);
  run.cut_all();
  if (options.role == SolidRole::stock) run.refine_walls();
  const double area = *pitch * *pitch;
  double removed = 0.0;
  result.removed_by_step.reserve(path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double volume = run.removed_length(i) * area;
    removed += volume;
    result.removed_by_step.push_back(static_cast<float>(volume));
  }
  result.removed = mm3(removed);
  result.hazards = run.hazards();
  result.stopped = run.stopped();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace kerf
