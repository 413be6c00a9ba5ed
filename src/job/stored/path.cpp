// Toolpaths: the tables of texts, beads and extras, and rows for the steps.
#include <algorithm>
#include <cstring>
#include <utility>

#include "job/stored/access.h"
#include "job/stored/parts.h"

#include "kerf/base/limits.h"

namespace kerf::stored {

template <>
inline constexpr BeadKind kLast<BeadKind> = BeadKind::custom;
template <>
inline constexpr SpindleLock kLast<SpindleLock> = SpindleLock::tap;

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

template <class A>
void fields(A& a, Like<A, Access::Bead>& v) {
  auto& [width, height, kind] = v;
  values(a, width, height, kind);
}

namespace {

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

std::string tables_of(const Toolpath& path) {
  const auto& [steps, changes, kinds, origins, texts, text_index, beads, extras, rotary] =
      Access::members(path);
  Sink a;
  value(a, texts);
  a.whole(beads.size());
  for (const Access::Bead& bead : beads) fields(a, bead);
  a.whole(extras.size() - 1);  // the first one means none
  for (std::size_t i = 1; i < extras.size(); ++i) value(a, extras[i]);
  write_origin_tables(a, origins);
  a.whole(steps.size());
  return a.take();
}

/// Returns the number of steps that follow.
std::size_t read_tables(Source& a, Toolpath& path, Tables& tables) {
  const auto& [steps, changes, kinds, origins, texts, text_index, beads, extras, rotary] =
      Access::members(path);
  value(a, texts);
  for (std::size_t i = 0; i < texts.size(); ++i)
    if (!text_index.try_emplace(texts[i], static_cast<std::int32_t>(i)).second)
      a.refuse("a text is there twice");
  constexpr std::size_t kBeadBytes = 17, kExtraBytes = 6;
  const auto is_size = [](Length v) { return v >= Length() && v.mm() <= limits::kMaxCoordinate; };
  for (std::size_t left = a.entries(kBeadBytes); left > 0 && !a.failed(); --left) {
    Access::Bead& bead = beads.emplace_back();
    fields(a, bead);
    if (!is_size(bead.width) || !is_size(bead.height)) a.refuse("a bead has no size");
  }
  for (std::size_t left = a.entries(kExtraBytes); left > 0 && !a.failed(); --left) {
    value(a, extras.emplace_back());
    rotary |= extras.back().stated_axes();
  }
  tables = {texts.size(), beads.size(), extras.size(), read_origin_tables(a, origins)};
  const std::uint64_t count = a.whole();
  if (count > limits::kMaxPathSteps) a.refuse("a toolpath has too many steps");
  return static_cast<std::size_t>(count);
}

void read_steps(Source& a, RowCodec<Source>& rows, Toolpath& path, const Tables& tables,
                std::size_t expected) {
  rows.continue_with(a);
  while (!a.at_end() && !a.failed()) {
    if (path.size() == expected) return a.refuse("there are too many steps");
    const Row& row = rows.read();
    if (a.failed()) return;
    if (const std::string_view fault = fault_of(row, tables); !fault.empty())
      return a.refuse("a step has a wrong value: " + std::string(fault));
    Access::append(path, row);
  }
}

}  // namespace

void write_path(ChunkWriter& out, const Toolpath& path) {
  out.add(kTables, tables_of(path));
  write_origins(out, path.origins());
  Sink none;
  RowCodec<Sink> rows(none);
  for (std::size_t i = 0; i < path.size(); i += kRowsPerChunk) {
    Sink a;
    rows.continue_with(a);
    for (std::size_t k = i; k < std::min(i + kRowsPerChunk, path.size()); ++k)
      rows.write(Access::row_of(path[k]));
    out.add(kSteps, a.take());
  }
}

bool read_path(ChunkReader& in, ChunkReader::Chunk first, Toolpath& path) {
  if (first.tag != kTables) return in.damaged("the tables of a toolpath are missing");
  Source head(first.bytes, in.version());
  Tables tables;
  const std::size_t steps = read_tables(head, path, tables);
  if (head.failed()) return in.damaged(head.fault());
  if (!head.at_end()) return in.damaged("bytes follow the tables of a toolpath");
  Source none({}, in.version());
  RowCodec<Source> rows(none);
  for (;;) {
    const auto next = in.next();
    if (!next) return false;
    if (next->tag == kEnd) break;
    Source a(next->bytes, in.version());
    if (next->tag == kOrigins)
      read_origins(a, path.origins(), tables.origins);
    else if (next->tag == kSteps)
      read_steps(a, rows, path, tables, steps);
    else
      return in.damaged("a chunk is unknown");
    if (a.failed()) return in.damaged(a.fault());
  }
  const bool is_whole = path.origins().size() == tables.origins && path.size() == steps;
  return is_whole || in.damaged("steps or origins are missing");
}

}  // namespace kerf::stored
