// Toolpaths: the tables of texts, beads, extras and origins, and rows for the steps.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "job/stored/parts.h"

#include "kerf/base/limits.h"

namespace kerf::stored {

template <>
inline constexpr StepKind kLast<StepKind> = StepKind::extruder;
template <>
inline constexpr BeadKind kLast<BeadKind> = BeadKind::custom;
template <>
inline constexpr SpindleLock kLast<SpindleLock> = SpindleLock::tap;

template <class A>
void fields(A& a, Like<A, DrawingLocation>& v) {
  auto& [file, layer, handle, x, y, entity] = v;
  values(a, file, layer, handle, x, y, entity);
}
void value(Sink& a, const DrawingLocation& v) { fields(a, v); }
void value(Source& a, DrawingLocation& v) { fields(a, v); }

template <class A>
void fields(A& a, Like<A, MotionExtra>& v) {
  auto& [abc, z_correction, unknown_abc, reference_abc, lock, per_turn] = v;
  values(a, abc, z_correction, unknown_abc, reference_abc, lock, per_turn);
}
void value(Sink& a, const MotionExtra& v) { fields(a, v); }
void value(Source& a, MotionExtra& v) {
  fields(a, v);
  if (v.unknown_abc > 7 || v.reference_abc > 7) a.refuse("a motion has an unknown axis");
}

namespace {

constexpr std::size_t kRowsPerChunk = 1 << 16;  // of steps, and of origins

/// All members of a step. What the values mean depends on its kind; see Step's getters.
struct Row {
  std::array<double, 6> values{};
  std::int32_t count = 0;
  std::uint32_t origin = 0, extra = 0;
  StepKind kind = StepKind::rapid;
  std::uint32_t plane = 0, reference = 0, rests_before = 0, turn = 0, named_axes = 0, frame = 0;

  /// 23 bits.
  std::uint32_t flags() const {
    return plane | reference << 3 | rests_before << 6 | turn << 7 | named_axes << 9 | frame << 15;
  }
  void set_flags(std::uint32_t bits) {
    plane = bits & 7;
    reference = bits >> 3 & 7;
    rests_before = bits >> 6 & 1;
    turn = bits >> 7 & 3;
    named_axes = bits >> 9 & 63;
    frame = bits >> 15 & 255;
  }
};

bool is_same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// Rows as differences from the row before. A row starts with its kind, and a bit for an origin that is not
/// the one after that of the row before, and a bit for other flags; then a bit for each value that is another
/// one, and two for the count and the extra.
template <class A>
class RowCodec {
 public:
  explicit RowCodec(A& a) : a_(&a) {}
  void continue_with(A& a) { a_ = &a; }

  void write(const Row& row) {
    const bool jumps = row.origin != last_.origin + 1, other = row.flags() != last_.flags();
    a_->byte(static_cast<std::uint8_t>(static_cast<unsigned>(row.kind) | (jumps ? kJumps : 0u) |
                                       (other ? kFlags : 0u)));
    unsigned changed = (row.count != last_.count ? kCount : 0u) | (row.extra != 0 ? kExtra : 0u);
    for (std::size_t k = 0; k < row.values.size(); ++k)
      if (!is_same(row.values[k], last_.values[k])) changed |= 1u << k;
    a_->byte(static_cast<std::uint8_t>(changed));
    if (jumps) a_->signed_whole(std::int64_t{row.origin} - last_.origin);
    if (other) a_->whole(row.flags());
    for (std::size_t k = 0; k < row.values.size(); ++k)
      if ((changed >> k & 1u) != 0) a_->number(row.values[k]);
    if ((changed & kCount) != 0) a_->signed_whole(std::int64_t{row.count} - last_.count);
    if (row.extra != 0) a_->signed_whole(std::int64_t{row.extra} - extra_);
    keep(row);
  }
  const Row& read() {
    Row row = last_;
    const unsigned start = a_->byte(), changed = a_->byte();
    row.kind = static_cast<StepKind>(start & (kFlags - 1));
    row.origin = (start & kJumps) != 0 ? moved(last_.origin) : last_.origin + 1;
    if ((start & kFlags) != 0) row.set_flags(static_cast<std::uint32_t>(a_->whole()));
    for (std::size_t k = 0; k < row.values.size(); ++k)
      if ((changed >> k & 1u) != 0) row.values[k] = a_->number();
    if ((changed & kCount) != 0)
      row.count = static_cast<std::int32_t>(moved(static_cast<std::uint32_t>(row.count)));
    row.extra = (changed & kExtra) != 0 ? moved(extra_) : 0;
    keep(row);
    return last_;
  }

 private:
  static constexpr unsigned kFlags = 64, kJumps = 128;  // beside the kind
  static constexpr unsigned kCount = 64, kExtra = 128;  // beside the values

  std::uint32_t moved(std::uint32_t from) {
    return from + static_cast<std::uint32_t>(static_cast<std::uint64_t>(a_->signed_whole()));
  }
  void keep(const Row& row) {
    last_ = row;
    if (row.extra != 0) extra_ = row.extra;
  }

  A* a_;
  Row last_;
  std::uint32_t extra_ = 0;  // of the last row that had one
};

/// The sizes of the tables that steps refer to.
struct Tables {
  std::size_t texts = 0, beads = 0, extras = 0, origins = 0;
};

bool is_number(double v) { return std::abs(v) <= limits::kMaxResult; }

/// The fault of what a row's kind makes of its members; empty: none. No default: a new kind is added here.
std::string_view fault_of_kind(const Row& row, const Tables& tables) {
  const std::uint32_t plane = row.plane, turn = row.turn;
  const auto unless = [](bool is_good, std::string_view fault) {
    return is_good ? std::string_view() : fault;
  };
  const bool has_text = row.count >= 0 && static_cast<std::size_t>(row.count) < tables.texts;
  const bool is_numbered = row.count >= -1 && row.count <= limits::kMaxToolNumber;
  switch (row.kind) {
    case StepKind::rapid:
    case StepKind::cut:
    case StepKind::dwell:
    case StepKind::close_path: return {};
    case StepKind::arc:
      return unless(plane < 3 && turn < 2 && row.count >= 0 && row.count <= limits::kMaxTurns, "an arc");
    case StepKind::tool_change: return unless(plane < 2 && is_numbered, "a tool change");
    case StepKind::spindle: return unless(turn < 3, "a spindle step");
    case StepKind::coolant: return {};
    case StepKind::path_mode: return unless(plane < 3, "a path mode");
    case StepKind::probe: return unless(plane < 4, "a probe");
    case StepKind::extrude:
      return unless(row.count >= 0 && static_cast<std::size_t>(row.count) < tables.beads, "a bead");
    case StepKind::temperature: return unless(plane < 3 && turn < 2 && is_numbered, "a temperature");
    case StepKind::fan:
    case StepKind::extruder: return unless(is_numbered, "a fan or extruder");
    case StepKind::laser_power: return unless(plane < 3, "a laser's power");
    case StepKind::layer: return unless(has_text && std::abs(row.values[0]) <= 1e9, "a layer");
    case StepKind::note:
    case StepKind::unresolved: return unless(plane < 2 && has_text, "a text");
    case StepKind::verbatim: return unless(has_text, "a text");
    case StepKind::pause: return unless(plane < 3, "a pause");
    case StepKind::end: return unless(turn < 2, "an end");
    case StepKind::store_home: return unless(plane == 2 || plane == 3, "a stored home");
    case StepKind::work_zero:
      return unless(plane < 7 && row.count >= 1 && row.count <= 9 && row.named_axes < 8 &&
                        (row.frame >> 6) == 0 && (row.frame >> 3 & ~row.named_axes) == 0,
                    "a work offset");
    case StepKind::tool_length:
      return unless(plane < 3 && is_numbered && row.named_axes < 8, "a tool length");
    case StepKind::motion_limits: {
      const auto is_limit = [](double v) { return v >= 0.0; };
      return unless(
          plane < 6 && row.frame < 16 && std::all_of(row.values.begin(), row.values.end(), is_limit),
          "limits of motions");
    }
  }
  return "a step of an unknown kind";
}

bool has_position(StepKind kind) {
  return kind <= StepKind::arc || kind == StepKind::probe || kind == StepKind::extrude;
}

std::string_view fault_of(const Row& row, const Tables& tables) {
  if (row.kind > kLast<StepKind>) return "a step of an unknown kind";
  if (!std::all_of(row.values.begin(), row.values.end(), is_number)) return "a number that is too large";
  if (row.origin >= tables.origins || row.extra >= tables.extras) return "a reference";
  const bool is_motion = has_position(row.kind);
  if (!is_motion && (row.extra != 0 || row.rests_before != 0)) return "an axis of no motion";
  if (is_motion && (row.reference > 5 || (row.frame >> 6) != 0 || (row.frame >> 3 & ~row.frame & 7u) != 0))
    return "the axes of a motion";
  return fault_of_kind(row, tables);
}

}  // namespace

/// Reads and writes the members of toolpaths, steps and origin tables, which are private elsewhere.
struct Access {
  static_assert(sizeof(Step) == 64, "a member that is new is stored, too");

  static Row row_of(const Step& step) {
    const auto& [values, count, origin, extra, kind, plane, reference, rests, turn, named, frame] = step;
    return {values, count, static_cast<std::uint32_t>(origin), extra, kind, plane, reference, rests, turn,
            named,  frame};
  }
  static Step step_of(const Row& row) {
    Step step;
    auto& [values, count, origin, extra, kind, plane, reference, rests, turn, named, frame] = step;
    values = row.values;
    count = row.count;
    origin = static_cast<OriginId>(row.origin);
    extra = row.extra;
    kind = row.kind;
    plane = static_cast<std::uint8_t>(row.plane) & 7;
    reference = static_cast<std::uint8_t>(row.reference) & 7;
    rests = row.rests_before != 0;
    turn = static_cast<std::uint8_t>(row.turn) & 3;
    named = static_cast<std::uint8_t>(row.named_axes) & 63;
    frame = static_cast<std::uint8_t>(row.frame);
    return step;
  }

  using Bead = Toolpath::Bead;
  template <class A>
  static void bead(A& a, Like<A, Bead>& v) {
    auto& [width, height, kind] = v;
    values(a, width, height, kind);
  }

  using Callers = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

  static std::string tables(const Toolpath& path) {
    const auto& [steps, changes, kinds, origins, texts, text_index, beads, extras] = path;
    Sink a;
    value(a, texts);
    a.whole(beads.size());
    for (const Bead& b : beads) bead(a, b);
    a.whole(extras.size() - 1);  // the first one means none
    for (std::size_t i = 1; i < extras.size(); ++i) value(a, extras[i]);
    const auto& [records, files, file_index, dxf, calls, call_index, callers] = origins;
    values(a, files, dxf, calls);
    a.whole(records.size());
    Callers sorted;
    for (const auto& [inner, outer] : callers) sorted.emplace_back(inner, static_cast<std::uint32_t>(outer));
    std::sort(sorted.begin(), sorted.end());
    a.whole(sorted.size());
    std::uint32_t last = 0;
    for (const auto& [inner, outer] : sorted) {
      a.whole(inner - std::exchange(last, inner));
      a.signed_whole(std::int64_t{outer} - inner);
    }
    a.whole(steps.size());
    return a.take();
  }

  /// Of how many rows what follows consists.
  struct Expected {
    std::size_t origins = 0, steps = 0;
  };

  static Expected read_tables(Source& a, Toolpath& path) {
    auto& [steps, changes, kinds, origins, texts, text_index, beads, extras] = path;
    value(a, texts);
    for (std::size_t i = 0; i < texts.size(); ++i)
      if (!text_index.try_emplace(texts[i], static_cast<std::int32_t>(i)).second)
        a.refuse("a text is there twice");
    constexpr std::size_t kBeadBytes = 17, kExtraBytes = 6;
    for (std::size_t left = a.entries(kBeadBytes); left > 0 && !a.failed(); --left) {
      bead(a, beads.emplace_back());
      const auto is_size = [](Length v) { return v >= Length() && v.mm() <= limits::kMaxCoordinate; };
      if (!is_size(beads.back().width) || !is_size(beads.back().height)) a.refuse("a bead has no size");
    }
    for (std::size_t left = a.entries(kExtraBytes); left > 0 && !a.failed(); --left)
      value(a, extras.emplace_back());
    Expected expected;
    expected.origins = read_origin_tables(a, origins);
    const std::uint64_t count = a.whole();
    if (count > limits::kMaxPathSteps) a.refuse("a toolpath has too many steps");
    expected.steps = static_cast<std::size_t>(count);
    return expected;
  }

  /// The number of origins.
  static std::size_t read_origin_tables(Source& a, OriginTable& origins) {
    auto& [records, files, file_index, dxf, calls, call_index, callers] = origins;
    values(a, files, dxf, calls);
    for (std::size_t i = 0; i < files.size(); ++i)
      if (!file_index.try_emplace(files[i], static_cast<std::uint32_t>(i)).second)
        a.refuse("a file is there twice");
    for (std::size_t i = 0; i < calls.size(); ++i)
      if (!call_index.try_emplace(calls[i], static_cast<std::uint32_t>(i)).second)
        a.refuse("a call is there twice");
    const std::uint64_t count = a.whole();
    if (count == 0 || count > 2 * limits::kMaxPathSteps) a.refuse("a table of origins has a wrong size");
    std::uint64_t inner = 0;
    for (std::size_t left = a.entries(2); left > 0 && !a.failed(); --left) {
      inner += a.whole();
      const std::uint64_t outer = inner + static_cast<std::uint64_t>(a.signed_whole());
      if (inner >= count || outer >= count) a.refuse("a caller is no origin");
      callers[static_cast<std::uint32_t>(inner)] = static_cast<OriginId>(outer);
    }
    return static_cast<std::size_t>(count);
  }

  using Kind = OriginTable::Kind;
  using Record = OriginTable::Record;

  /// An origin as the difference from the one before. One byte: the kind, bits for another file, a line that
  /// is not the next one, and another column.
  static void write_origin(Sink& a, const Record& record, Record& last) {
    const auto& [file, line, column, kind] = record;
    const unsigned bits = static_cast<unsigned>(kind) | (file != last.file ? 4u : 0u) |
                          (line != last.line + 1 ? 8u : 0u) | (column != last.column ? 16u : 0u);
    a.byte(static_cast<std::uint8_t>(bits));
    if ((bits & 4u) != 0) a.whole(file);
    if ((bits & 8u) != 0) a.signed_whole(std::int64_t{line} - last.line);
    if ((bits & 16u) != 0) a.whole(column);
    last = record;
  }
  static void read_origin(Source& a, OriginTable& origins, Record& last) {
    const unsigned bits = a.byte();
    Record r = last;
    r.kind = static_cast<Kind>(bits & 3u);
    if ((bits & 4u) != 0) r.file = static_cast<std::uint32_t>(a.whole());
    r.line +=
        (bits & 8u) != 0 ? static_cast<std::uint32_t>(static_cast<std::uint64_t>(a.signed_whole())) : 1u;
    if ((bits & 16u) != 0) r.column = static_cast<std::uint32_t>(a.whole());
    const bool has_file = r.kind == Kind::none || r.file < origins.files_.size();
    const bool is_known = (r.kind != Kind::dxf || r.line < origins.dxf_.size()) &&
                          (r.kind != Kind::call || r.column < origins.calls_.size());
    if (bits > 31 || !has_file || !is_known) a.refuse("an origin is unknown");
    last = r;
    origins.records_.push_back(r);
  }

  static void write(ChunkWriter& out, const Toolpath& path) {
    out.add(kTables, tables(path));
    const std::vector<Record>& records = path.origins_.records_;
    Record last;
    for (std::size_t i = 0; i < records.size(); i += kRowsPerChunk) {
      Sink a;
      for (std::size_t k = i; k < std::min(i + kRowsPerChunk, records.size()); ++k)
        write_origin(a, records[k], last);
      out.add(kOrigins, a.take());
    }
    Sink first;
    RowCodec<Sink> rows(first);
    for (std::size_t i = 0; i < path.size(); i += kRowsPerChunk) {
      Sink a;
      rows.continue_with(a);
      for (std::size_t k = i; k < std::min(i + kRowsPerChunk, path.size()); ++k) rows.write(row_of(path[k]));
      out.add(kSteps, a.take());
    }
  }

  static void read_origins(Source& a, OriginTable& origins, Record& last, std::size_t expected) {
    while (!a.at_end() && !a.failed()) {
      if (origins.records_.size() == expected) return a.refuse("there are too many origins");
      read_origin(a, origins, last);
    }
  }

  static void read_steps(Source& a, RowCodec<Source>& rows, Toolpath& path, const Tables& tables,
                         std::size_t expected) {
    rows.continue_with(a);
    while (!a.at_end() && !a.failed()) {
      if (path.size() == expected) return a.refuse("there are too many steps");
      const Row& row = rows.read();
      if (a.failed()) return;
      if (const std::string_view fault = fault_of(row, tables); !fault.empty())
        return a.refuse(std::string("a step has a wrong value: ") + std::string(fault));
      path.steps_.push_back(step_of(row));
      path.note_kind(row.kind);
    }
  }

  static bool read(ChunkReader& in, ChunkReader::Chunk chunk, Toolpath& path) {
    if (chunk.tag != kTables) return in.damaged("the tables of a toolpath are missing");
    Source head(chunk.bytes);
    const Expected expected = read_tables(head, path);
    if (head.failed() || !head.at_end())
      return in.damaged(head.failed() ? head.fault() : "bytes follow the tables of a toolpath");
    auto& records = path.origins_.records_;
    records.clear();
    Tables tables{path.texts_.size(), path.beads_.size(), path.extras_.size(), expected.origins};
    Record last;
    Source nothing({});
    RowCodec<Source> rows(nothing);
    for (;;) {
      const auto next = in.next();
      if (!next) return false;
      if (next->tag == kEnd) break;
      Source a(next->bytes);
      if (next->tag == kOrigins)
        read_origins(a, path.origins_, last, expected.origins);
      else if (next->tag == kSteps)
        read_steps(a, rows, path, tables, expected.steps);
      else
        return in.damaged("a chunk is unknown");
      if (a.failed()) return in.damaged(a.fault());
    }
    const bool is_whole = records.size() == expected.origins && path.size() == expected.steps;
    if (is_whole && records.front().kind == Kind::none) return true;
    return in.damaged("steps or origins are missing");
  }
};

void write_path(ChunkWriter& out, const Toolpath& path) { Access::write(out, path); }

bool read_path(ChunkReader& in, ChunkReader::Chunk first, Toolpath& path) {
  return Access::read(in, std::move(first), path);
}

}  // namespace kerf::stored
