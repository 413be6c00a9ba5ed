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

#include "sim/feed.h"
#include "sim/kernels.h"
#include "sim/parallel.h"
#include "sim/start.h"
#include "sim/walls.h"

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
    for_each_motion(path_, [&](const Step& step, const MotionContext& context) { look_at(step, context); });
    survey_.judges_spindle = has_step(StepKind::spindle) && !has_step(StepKind::laser_power);
    return std::move(survey_);
  }

 private:
  void look_at(const Step& step, const MotionContext& context) {
    check_place(step, context);
    check_extras(step, context);
    const std::optional<int> number = context.tool ? context.tool : survey_.only_tool;
    const bool is_known = number && (number == known_tool_ || find_tool(*number));
    if (!step.is_cutting()) return;
    if (!number) return no_tool(context);
    if (!is_known) no_such_tool(*number, context);
    if (step.kind() == StepKind::arc && context.unknown_from == 0 &&
        chord_count(walk_of(step, context.from)).too_coarse)
      diagnostics_.warning(Code::coarse_arc, path_.origin_of(context.index),
                           "the arc is so long that it is simulated with chords coarser than usual");
    if (step.unknown_axes() != 0) warn_unknown_place(context);
  }

  bool has_step(StepKind kind) const {
    const std::vector<Step>& steps = path_.steps();
    return std::any_of(steps.begin(), steps.end(), [kind](const Step& step) { return step.kind() == kind; });
  }

  /// Makes the solids of a tool that is met for the first time. False if its shape is not known.
  bool find_tool(int number) {
    if (survey_.index.count(number) == 0) {
      const Tool* tool = tools_.find(number);
      if (tool == nullptr) return false;
      survey_.index[number] = static_cast<std::uint32_t>(survey_.solids.size());
      survey_.solids.push_back(make_tool_solids(tool->silhouette, mm(clearance_)));
    }
    known_tool_ = number;
    return true;
  }

  void check_place(const Step& step, const MotionContext& context) {
    Point3 arc_centre = centre_;
    if (step.kind() == StepKind::arc) {
      const Point2 c = step.arc().centre;
      arc_centre = centre_ + Point3{c.x, c.y, 0.0};
    }
    if (is_near(step.to()) && is_near(arc_centre)) return;
    diagnostics_.error(Code::motion_out_of_range, path_.origin_of(context.index),
                       fmt::format("the motion goes further than {} km from the stock",
                                   number_text(kFarthestMotion * 1e-6, 0)));
  }

  bool is_near(Point3 place) const {
    const Point3 way = place - centre_;
    return dot(way, way) < kFarthestMotion * kFarthestMotion;
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

  void warn_unknown_place(const MotionContext& context) {
    once(Code::cut_at_unknown_place, context,
         "the program cuts here before it has said where X, Y and Z are; X0 Y0 are taken, and without a Z "
         "nothing is cut");
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
  std::optional<int> known_tool_;  // of the motion before
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

/// A batch and what cutting it has found.
struct CutBatch : Batch {
  std::vector<double> removed;                    // length of column, one a pair in order of tiles
  std::vector<std::vector<Contact>> contacts_of;  // one a tile
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
    constexpr double kNarrower = 1e-6;  // less is rounding
    narrow_x_ = body_.share_x(body_.nx - 1) < 1.0 - kNarrower;
    narrow_y_ = body_.share_y(body_.ny - 1) < 1.0 - kNarrower;
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

  /// Counts the columns at walls anew, see walls.h. False if there are none, or if stopped: then what was
  /// told of volumes before stands.
  bool refine_walls();

  bool stopped() const { return stopped_; }
  void tell_removed(Simulation& result) const;
  std::vector<Hazard> hazards() const;

 private:
  std::vector<StepRange> steps_in(const std::vector<bool>& tiles) const;
  void send_all(const std::vector<bool>* tiles);
  void cut_tile_number(CutBatch& batch, std::size_t k);
  void take_over(const CutBatch& batch);
  void merge(const Contact& contact);

  Workpiece::Body& body_;
  const Toolpath& path_;
  Survey survey_;
  Length hazard_depth_;
  bool is_no_go_;
  unsigned threads_;
  Progress* progress_;
  std::vector<LaneTool> tools_;
  Field field_{};
  ColumnPlaces along_x_, along_y_;
  bool narrow_x_ = false, narrow_y_ = false;  // the last column of a row, the last row
  std::vector<double> removed_;               // length of column, one a step
  WallGroup* walls_ = nullptr;                // what is cut instead of the workpiece, if any
  std::vector<StepRange> in_tile_;            // which steps each tile has seen
  bool stopped_ = false;
  std::map<std::pair<std::uint32_t, HazardKind>, Contact> merged_;
};

/// Plans all motions and cuts them, in batches; given tiles, only what goes there. While a batch is cut, what
/// the one before has cut is added up, and then the next one is planned in its place.
void Run::send_all(const std::vector<bool>* tiles) {
  const PlanScope scope{.margin = body_.pitch, .tiles = tiles};
  Feeder feeder(body_, path_, survey_,
                {.plan = scope,
                 .steps = tiles == nullptr ? std::vector{StepRange{0, path_.size()}} : steps_in(*tiles),
                 .hazard_depth = hazard_depth_,
                 .is_no_go = is_no_go_});
  const auto stop = [&] { return stopped_ = stopped_ || stop_requested(progress_); };
  CutBatch now, other;
  for (feeder.fill(now); !now.empty() && !stop(); std::swap(now, other)) {
    now.removed.assign(now.list.size(), 0.0);
    now.contacts_of.assign(now.busy.size(), {});
    const auto work = [&](std::size_t n) {
      if (n > 0) return cut_tile_number(now, now.order[n - 1]);
      take_over(other);
      feeder.fill(other);
    };
    parallel_for(threads_, now.busy.size() + 1, work, stop);
    report(progress_, static_cast<double>(now.steps_done) / static_cast<double>(path_.size()));
  }
  take_over(other);
}

void Run::cut_tile_number(CutBatch& batch, std::size_t k) {
  const std::size_t tile = batch.busy[k];
  const auto tiles_x = static_cast<std::size_t>(body_.tiles_x);
  const auto column = static_cast<int>(tile % tiles_x) * kTileColumns;
  const auto row = static_cast<int>(tile / tiles_x) * kTileColumns;
  TileJob job;
  job.field = &field_;
  job.x = (column + 0.5) * body_.pitch;
  job.y = (row + 0.5) * body_.pitch;
  if ((narrow_x_ && column + kTileColumns >= body_.nx) || (narrow_y_ && row + kTileColumns >= body_.ny)) {
    job.place_x = along_x_.place.data() + column;
    job.place_y = along_y_.place.data() + row;
    job.share_x = along_x_.share.data() + column;
    job.share_y = along_y_.share.data() + row;
  }
  job.tools = &tools_;
  job.sweeps = batch.sweeps.data();
  job.list = batch.list.data() + batch.start[k];
  job.count = batch.start[k + 1] - batch.start[k];
  job.removed = batch.removed.data() + batch.start[k];
  job.contacts = &batch.contacts_of[k];
  if (walls_ != nullptr) return walls_->cut(tile, job);
  job.tile = &body_.touch(tile);
  cut_tile(job);
}

std::vector<StepRange> Run::steps_in(const std::vector<bool>& tiles) const {
  std::vector<StepRange> all;
  for (std::size_t tile = 0; tile < tiles.size(); ++tile)
    if (tiles[tile] && in_tile_[tile].first <= in_tile_[tile].last) all.push_back(in_tile_[tile]);
  std::sort(all.begin(), all.end(), [](const StepRange& a, const StepRange& b) { return a.first < b.first; });
  std::vector<StepRange> apart;
  for (const StepRange& next : all) {
    if (apart.empty() || apart.back().last < next.first) {
      apart.push_back(next);
    } else {
      apart.back().add(next);
    }
  }
  return apart;
}

bool Run::refine_walls() {
  if (stopped_) return false;
  const std::vector<WallColumns> found = find_walls(body_, threads_);
  if (found.empty()) return false;
  if (progress_ != nullptr) progress_->phase("measuring walls");
  double excess = 0.0;
  for (std::size_t next = 0; next < found.size() && !stopped_;) {
    WallGroup group(body_, found, next, threads_);
    walls_ = &group;
    send_all(&group.tiles());
    excess += group.excess();
    walls_ = nullptr;
  }
  if (!stopped_) body_.wall_volume = excess * body_.pitch * body_.pitch;
  report(progress_, 1.0);
  return !stopped_;
}

void Run::tell_removed(Simulation& result) const {
  const double area = body_.pitch * body_.pitch;
  double all = 0.0;
  result.removed_by_step.resize(removed_.size());
  for (std::size_t step = 0; step < removed_.size(); ++step) {
    const double volume = removed_[step] * area;
    all += volume;
    result.removed_by_step[step] = static_cast<float>(volume);
  }
  result.removed = mm3(all);
}

/// Adds what a batch has cut to the steps, in order of sweeps and tiles, whichever thread was first: sums of
/// floating numbers depend on the order.
void Run::take_over(const CutBatch& batch) {
  for (std::size_t p = 0; p < batch.pairs.size(); ++p)
    removed_[batch.sweeps[batch.pairs[p].sweep].step] += batch.removed[batch.place[p]];
  if (walls_ == nullptr) {
    for (const Contact& contact : batch.contacts) merge(contact);
    for (const std::vector<Contact>& of_tile : batch.contacts_of)
      for (const Contact& contact : of_tile) merge(contact);
    for (std::size_t k = 0; k < batch.busy.size(); ++k)
      in_tile_[batch.busy[k]].add({batch.sweeps[batch.list[batch.start[k]]].step,
                                   batch.sweeps[batch.list[batch.start[k + 1] - 1]].step});
  }
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
  run.tell_removed(result);
  if (options.role == SolidRole::stock && run.refine_walls()) run.tell_removed(result);
  result.hazards = run.hazards();
  result.stopped = run.stopped();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace kerf
