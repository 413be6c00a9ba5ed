// Threads by a thread mill, and countersinks by a ball mill.
//
//   const auto made = thread({{{10, 20}, mm(4)}}, mill, {.cut = {.depth = mm(10), .feed = mm_per_min(200)},
//       .pitch = mm(1.25)}, diagnostics);
//
// The hole or rod of a thread must be there: the tool goes down in the hole, or one pitch beside the rod, by
// a rapid where it cannot plunge. Frame and errors as in operation.h.
#pragma once

#include <optional>
#include <vector>

#include "kerf/op/operation.h"

namespace kerf {

enum class ThreadHand : std::uint8_t { right, left };
enum class ThreadSide : std::uint8_t {
  inside,  ///< of a hole: the circle is the major diameter, which the tips of the tool reach
  outside  ///< of a rod: the circle is the major diameter, the tips reach 0.6134 pitches below it (ISO 68-1)
};
struct ThreadOptions {
  CutOptions cut{};  ///< depth: of the thread. direction: climb or conventional; stepdown has no effect
  Length pitch{};    ///< > 0
  ThreadHand hand = ThreadHand::right;
  ThreadSide side = ThreadSide::inside;
  int passes = 1;  ///< of equal depth, at increasing depth of the thread
  int teeth = 1;   ///< of the tool, one pitch apart: it turns once for as many pitches
};
std::optional<Operation> thread(const std::vector<Circle>& circles, const Tool& tool,
                                const ThreadOptions& options, Diagnostics& diagnostics);

struct CountersinkOptions {
  CutOptions cut{};           ///< depth: of the cone, from its wide end at `top`. stepdown has no effect
  Angle angle = degrees(90);  ///< of the cone, between its sides
  Length scallop = mm(0.02);  ///< maximum height of material left between two circles
};
/// Cones with the given circles at the top, by circles of a ball mill from the inside out.
std::optional<Operation> countersink(const std::vector<Circle>& circles, const Tool& tool,
                                     const CountersinkOptions& options, Diagnostics& diagnostics);

}  // namespace kerf
