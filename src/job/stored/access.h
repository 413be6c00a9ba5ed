// The members of toolpaths, steps and origin tables, which are private elsewhere.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "kerf/base/origin.h"
#include "kerf/path/toolpath.h"

namespace kerf::stored {

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

/// The sizes of the tables that steps refer to.
struct Tables {
  std::size_t texts = 0, beads = 0, extras = 0, origins = 0;
};
/// What is wrong with a row; empty: nothing.
std::string_view fault_of(const Row& row, const Tables& tables);

/// The structured bindings name all members: a new one does not compile before it is stored, too.
struct Access {
  using Bead = Toolpath::Bead;
  using Record = OriginTable::Record;
  using Kind = OriginTable::Kind;

  /// Steps, changes, kinds, origins, texts, the index of the texts, beads, extras, rotary axes of the extras.
  template <class Path>
  static auto members(Path& path) {
    auto& [steps, changes, kinds, origins, texts, text_index, beads, extras, rotary] = path;
    return std::tie(steps, changes, kinds, origins, texts, text_index, beads, extras, rotary);
  }
  /// Records, files, the index of the files, drawing locations, calls, the index of the calls, callers.
  template <class Table>
  static auto origin_members(Table& table) {
    auto& [records, files, file_index, drawings, calls, call_index, callers] = table;
    return std::tie(records, files, file_index, drawings, calls, call_index, callers);
  }

  static_assert(sizeof(Step) == 64);
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
  /// Appends a step with what the toolpath derives from it.
  static void append(Toolpath& path, const Row& row) {
    path.steps_.push_back(step_of(row));
    path.note_kind(row.kind);
  }
};

}  // namespace kerf::stored
