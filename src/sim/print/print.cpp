// simulate_print: surveys the beads, chooses the columns, lays the beads tile by tile, adds up.
//
// Three passes over the beads: the survey; beads and the wedges of corners in time order; the free ends last,
// so that they get only space that no bead fills. Within a tile, pieces are laid in time order; sums are
// added in the order of tiles, so that the result does not depend on threads. Each piece is laid twice: in
// the columns of the material, and in columns spread evenly about, whose sums are the volumes: those of a
// regular grid depend on how a bead along X or Y lies in it.
#include "kerf/sim/print.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <utility>

#include "base/codes/sim.h"
#include "base/number.h"
#include "base/parallel.h"
#include "sim/print/print_hollow.h"
#include "sim/print/print_support.h"
#include "sim/print/print_survey.h"
#include "sim/print/print_tile.h"
#include "sim/print/tile_set.h"

#include "kerf/base/limits.h"

namespace kerf {
namespace printing {
namespace {

constexpr std::size_t kBatchPairs = 1'000'000;  // of piece and tile, per batch
constexpr std::size_t kBatchColumns =
    30'000'000;                // columns of all pieces of a batch: bounds the memory that a batch can add
constexpr double kWide = 3.0;  // usual widths
constexpr std::size_t kPurgeBeads = 3;  // usual beads before the first wide one that is no purge line
constexpr double kStraight = 1e-6;      // sine of the angle below which a corner has no wedge

// ---- laying

/// The sums of a layer; heights of columns in mm, to be multiplied by the area of a column.
struct LayerSums {
  double volume = 0.0, length = 0.0, bare = 0.0;  // of beads: mm3, mm
  double height = 0.0;                            // of the highest bead, mm
  std::size_t beads = 0;
  double full = 0.0, covered = 0.0;  // of beads
  double filled_corners = 0.0, filled_ends = 0.0;
};

struct PieceBatch {
  std::vector<BeadPiece> pieces;
  std::vector<Bead> beads;

  void clear() {
    pieces.clear();
    beads.clear();
  }
};

class Printer final : public BeadSink {
 public:
  Printer(const Toolpath& path, const PrintOptions& options, const Frame& frame, const PrintSurvey& survey,
          Diagnostics& diagnostics, Progress* progress)
      : path_(path),
        options_(options),
        frame_(frame),
        survey_(survey),
        diagnostics_(diagnostics),
        progress_(progress),
        threads_(thread_count(options.threads)),
        columns_(frame),
        samples_(make_sample_frame(frame, survey)),
        layers_(survey.levels.size()),
        unsupported_(hazards_) {}

  /// False if stopped, or with an error if the print is too large.
  bool print() {
    if (progress_ != nullptr) progress_->phase("printing");
    for_each_bead(path_, options_, *this, nullptr);
    flush();
    unsupported_.close();
    laying_ends_ = true;
    for_each_bead(path_, options_, *this, nullptr);
    flush();
    report(progress_, 1.0);
    return !ended_;
  }
  bool stopped() const { return stopped_; }
  PrintSimulation result();

  void bead(const Bead& r) override;
  void corner(const Bead& before, const Bead& next) override;
  void free_start(const Bead& r) override {
    if (laying_ends_) add_wedge(r, r.from, {}, r.along, r.section);
  }
  void free_end(const Bead& r) override {
    if (laying_ends_) add_wedge(r, r.to, r.along, {}, r.section);
  }
  void travel(std::uint32_t step, Point3 from, Point3 to) override;
  void blob(std::uint32_t step, Point3 at, double volume) override;
  bool wants_more() override { return !ended_; }

 private:
  Point2 in_frame(Point3 p) const { return {p.x - frame_.x, p.y - frame_.y}; }
  void add_wedge(const Bead& bead, Point3 at, Point2 after, Point2 before, const Section& section);
  void add(const BeadPiece& piece);
  void meet_width(const Bead& bead);
  void meet_bed(const BeadPiece& piece);
  void meet(const NozzleContact& contact);
  void flush();
  void lay_batch();
  void merge();
  void add_to_layers();
  void check_size();

  const Toolpath& path_;
  const PrintOptions& options_;
  Frame frame_;
  const PrintSurvey& survey_;
  Diagnostics& diagnostics_;
  Progress* progress_;
  unsigned threads_;
  TileSet columns_;  // the material
  TileSet samples_;  // for the volumes
  PieceBatch batch_;
  std::vector<LayerSums> layers_;
  std::vector<PrintHazard> hazards_;
  std::map<std::uint32_t, NozzleContact> contacts_;  // by step
  UnsupportedBeads unsupported_;
  double blobs_ = 0.0;
  std::size_t usual_beads_ = 0;
  std::uint32_t chain_start_ = 0;
  std::uint32_t travel_step_ = std::numeric_limits<std::uint32_t>::max();
  double travelled_ = 0.0;  // of this step
  bool laying_ends_ = false, stopped_ = false, ended_ = false;
};

BeadPiece piece_of(const Section& section) {
  BeadPiece piece;
  piece.round = 0.5 * section.height;
  piece.flat = std::max(0.0, 0.5 * section.width - piece.round);
  return piece;
}

void Printer::bead(const Bead& r) {
  if (laying_ends_) return;
  if (!r.continues) chain_start_ = r.step;
  BeadPiece piece = piece_of(r.section);
  piece.step = r.step;
  piece.layer = survey_.layer_of(r.level);
  piece.bead = static_cast<std::uint32_t>(batch_.beads.size());
  piece.chain_start = chain_start_;
  piece.from = in_frame(r.from);
  piece.along = r.along;
  piece.length = r.length;
  piece.z = r.from.z - frame_.bed;
  piece.slope = r.slope();
  batch_.beads.push_back(r);
  meet_width(r);
  LayerSums& layer = layers_[piece.layer];
  layer.volume += r.volume;
  layer.length += r.length;
  layer.height = std::max(layer.height, r.section.height);
  ++layer.beads;
  add(piece);
}

void Printer::corner(const Bead& before, const Bead& next) {
  if (laying_ends_) return;
  if (std::abs(cross(before.along, next.along)) < kStraight && dot(before.along, next.along) > 0.0) return;
  const Section section{std::min(before.section.width, next.section.width),
                        std::min(before.section.height, next.section.height)};
  add_wedge(next, next.from, before.along, next.along, section);
}

void Printer::add_wedge(const Bead& bead, Point3 at, Point2 after, Point2 before, const Section& section) {
  BeadPiece piece = piece_of(section);
  piece.kind = PieceKind::wedge;
  piece.step = bead.step;
  piece.layer = survey_.layer_of(bead.level);
  piece.from = in_frame(at);
  piece.z = at.z - frame_.bed;
  piece.after = after;
  piece.before = before;
  add(piece);
}

void Printer::travel(std::uint32_t step, Point3 from, Point3 to) {
  if (laying_ends_) return;
  const Point2 offset = to.xy() - from.xy();
  BeadPiece piece;
  piece.length = length(offset);
  if (!(piece.length > 0.0)) return;
  if (travel_step_ != step) travelled_ = 0.0;
  travel_step_ = step;
  piece.kind = PieceKind::travel;
  piece.step = step;
  piece.from = in_frame(from);
  piece.along = 1.0 / piece.length * offset;
  piece.travelled = travelled_;
  piece.z = from.z - frame_.bed;
  piece.slope = (to.z - from.z) / piece.length;
  travelled_ += piece.length;
  add(piece);
}

void Printer::blob(std::uint32_t step, Point3 at, double volume) {
  if (laying_ends_) return;
  blobs_ += volume;
  if (volume < options_.min_blob.mm3()) return;
  hazards_.push_back({PrintHazardKind::blob, step, 1, at, {}, {}, mm3(volume), {}});
}

void Printer::meet_width(const Bead& r) {
  const double width = r.section.width, usual = survey_.usual_width();
  if (width <= kWide * usual) ++usual_beads_;
  if (width <= kWide * usual || usual_beads_ < kPurgeBeads) return;
  hazards_.push_back({PrintHazardKind::wide_bead,
                      r.step,
                      1,
                      r.from,
                      {},
                      mm(r.length),
                      mm3(r.volume * (1.0 - usual / width)),
                      mm(width)});
}

/// Contacts with the bed, which extends beyond the columns.
void Printer::meet_bed(const BeadPiece& p) {
  const double deepest = -std::min(p.z, p.z + p.length * p.slope), min_depth = options_.contact_depth.mm();
  if (deepest <= min_depth) return;
  const double u = p.z < -min_depth ? 0.0 : (-min_depth - p.z) / p.slope;
  meet({p.step,
        p.travelled + u,
        {p.from.x + u * p.along.x, p.from.y + u * p.along.y, p.z + u * p.slope},
        deepest});
}

void Printer::add(const BeadPiece& piece) {
  if (ended_) return;
  if (piece.kind != PieceKind::wedge) meet_bed(piece);
  const auto number = static_cast<std::uint32_t>(batch_.pieces.size());
  batch_.pieces.push_back(piece);
  columns_.add(piece, number);
  if (piece.kind != PieceKind::travel) samples_.add(piece, number);
  const bool full = columns_.pairs() >= kBatchPairs || samples_.pairs() >= kBatchPairs ||
                    columns_.columns() + samples_.columns() >= kBatchColumns;
  if (full || batch_.pieces.size() >= kBatchPairs) flush();
}

void Printer::flush() {
  if (ended_) return;
  lay_batch();
  ended_ = stopped_;
  if (!ended_) merge();
  if (!ended_) check_size();
  if (!batch_.pieces.empty() && path_.size() > 0)
    report(progress_, static_cast<double>(batch_.pieces.back().step) / static_cast<double>(path_.size()));
  batch_.clear();
  columns_.clear_batch();
  samples_.clear_batch();
}

void Printer::lay_batch() {
  const auto stop = [&] { return stopped_ = stopped_ || stop_requested(progress_); };
  columns_.lay(batch_.pieces, options_.contact_depth.mm(), threads_, stop);
  if (!stop()) samples_.lay(batch_.pieces, std::numeric_limits<double>::infinity(), threads_, stop);
  if (!stop()) columns_.for_each_contact([&](const NozzleContact& contact) { meet(contact); });
}

void Printer::meet(const NozzleContact& contact) {
  const auto [it, is_new] = contacts_.try_emplace(contact.step, contact);
  if (is_new) return;
  NozzleContact& all = it->second;
  all.depth = std::max(all.depth, contact.depth);
  if (contact.distance >= all.distance) return;
  all.distance = contact.distance;
  all.at = contact.at;
}

/// Adds the volumes of the batch to the layers.
void Printer::add_to_layers() {
  samples_.for_each_sum([&](std::uint32_t number, const PieceSums& sums) {
    const BeadPiece& piece = batch_.pieces[number];
    LayerSums& layer = layers_[piece.layer];
    if (piece.kind == PieceKind::wedge) {
      (laying_ends_ ? layer.filled_ends : layer.filled_corners) += sums.full - sums.covered;
      return;
    }
    layer.full += sums.full;
    layer.covered += sums.covered;
  });
}

/// Adds up the batch, and finds unsupported beads, in time order.
void Printer::merge() {
  add_to_layers();
  std::vector<PieceSums> of_bead(batch_.beads.size());
  columns_.for_each_sum([&](std::uint32_t number, const PieceSums& sums) {
    const BeadPiece& piece = batch_.pieces[number];
    if (piece.kind != PieceKind::bead) return;
    PieceSums& bead = of_bead[piece.bead];
    bead.full += sums.full;
    bead.centre += sums.centre;
    bead.bare += sums.bare;
    bead.supported = bead.supported || sums.supported;
  });
  for (std::size_t r = 0; r < batch_.beads.size(); ++r)
    layers_[survey_.layer_of(batch_.beads[r].level)].bare += unsupported_.add(batch_.beads[r], of_bead[r]);
}

void Printer::check_size() {
  const bool too_deep = columns_.too_deep();
  if (!too_deep && columns_.runs() <= options_.max_intervals) return;
  ended_ = true;
  if (too_deep) {
    diagnostics_.error(codes::print_too_large, {},
                       fmt::format("more than {} beads lie above each other without touching",
                                   limits::kMaxIntervalsPerColumn));
    return;
  }
  diagnostics_
      .error(codes::print_too_large, {},
             fmt::format("the columns of the print have more than {} intervals of material",
                         options_.max_intervals))
      .hint = fmt::format("use a resolution coarser than {} mm", number_text(frame_.pitch, 4));
}

/// The figures of a layer from the sums of its columns; see print.h.
PrintVolumes volumes_of(const LayerSums& sums, double column_area) {
  PrintVolumes volumes;
  volumes.extruded = mm3(sums.volume);
  const double fraction = sums.full > 0.0 ? (sums.covered - sums.filled_corners) / sums.full : 0.0;
  volumes.overlap = std::clamp(fraction, 0.0, 1.0) * volumes.extruded;
  volumes.ends = mm3(sums.filled_ends * column_area);
  volumes.laid = volumes.extruded - volumes.overlap + volumes.ends;
  volumes.bead_length = mm(sums.length);
  volumes.unsupported = mm(sums.bare);
  return volumes;
}

void add_up(PrintVolumes& all, const PrintVolumes& more) {
  all.extruded = all.extruded + more.extruded;
  all.laid = all.laid + more.laid;
  all.overlap = all.overlap + more.overlap;
  all.ends = all.ends + more.ends;
  all.bead_length = all.bead_length + more.bead_length;
  all.unsupported = all.unsupported + more.unsupported;
}

PrintSimulation Printer::result() {
  PrintSimulation out;
  out.beads = survey_.beads;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const PrintVolumes volumes = volumes_of(layers_[i], samples_.frame().pitch * samples_.frame().pitch);
    out.layers.push_back({mm(survey_.levels[i]), mm(layers_[i].height), layers_[i].beads, volumes});
    add_up(out.total, volumes);
  }
  out.total.blobs = mm3(blobs_);
  out.total.extruded = out.total.extruded + out.total.blobs;
  for (const auto& [step, contact] : contacts_) {
    const Point3 at = contact.at + Point3{frame_.x, frame_.y, frame_.bed};
    hazards_.push_back({PrintHazardKind::nozzle_contact, step, 1, at, mm(contact.depth), {}, {}, {}});
  }
  out.hazards = std::move(hazards_);
  std::stable_sort(out.hazards.begin(), out.hazards.end(), [](const PrintHazard& a, const PrintHazard& b) {
    return std::pair(a.step, a.kind) < std::pair(b.step, b.kind);
  });
  out.columns = columns_.grid(std::max(survey_.box.high.z - frame_.bed, frame_.pitch));
  const double pitch = samples_.frame().pitch;
  const HollowSamples samples{pitch * pitch,
                              [this](const HollowSamples::Visit& visit) { samples_.for_each_column(visit); }};
  out.stopped = stopped_ || !measure_hollow(out.columns, static_cast<double>(frame_.touch), samples,
                                            out.layers, out.total, progress_);
  return out;
}

}  // namespace
}  // namespace printing

std::string_view to_string(PrintHazardKind kind) {
  switch (kind) {
    case PrintHazardKind::nozzle_contact: return "nozzle_contact";
    case PrintHazardKind::in_air: return "in_air";
    case PrintHazardKind::unsupported: return "unsupported";
    case PrintHazardKind::wide_bead: return "wide_bead";
    case PrintHazardKind::blob: break;
  }
  return "blob";
}

bool is_print(const Toolpath& path) {
  bool lays = false;
  Point3 at;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Step& step = path[i];
    if (step.kind() == StepKind::spindle && step.spindle().turn != SpindleTurn::off) return false;
    if (!step.is_motion()) continue;
    if (step.kind() == StepKind::extrude && !(step.to() == at))
      lays = lays || path.extrude(i).volume.mm3() > 0.0;
    at = step.to();
  }
  return lays;
}

std::optional<PrintSimulation> simulate_print(const Toolpath& path, const PrintOptions& options,
                                              Diagnostics& diagnostics, Progress* progress) {
  const auto start = std::chrono::steady_clock::now();
  printing::PrintSurvey survey(progress);
  printing::for_each_bead(path, options, survey, &diagnostics);
  if (survey.stopped) {
    PrintSimulation nothing;
    nothing.stopped = true;
    return nothing;
  }
  if (survey.beads == 0) {
    diagnostics.error(codes::nothing_printed, {}, "no motion of the program lays a bead").hint =
        "a printing program extrudes while it moves (E words)";
    return std::nullopt;
  }
  survey.sort_levels();
  const auto frame = printing::make_frame(survey, options, diagnostics);
  if (!frame) return std::nullopt;
  printing::Printer printer(path, options, *frame, survey, diagnostics, progress);
  if (!printer.print() && !printer.stopped()) return std::nullopt;
  PrintSimulation result = printer.result();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace kerf
