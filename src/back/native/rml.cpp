// RML-1, the language of Roland's mills (.rml): commands that end with a semicolon, positions in whole steps,
// speeds in mm per second. Every motion is Z x,y,z at the speed of V, for which all models have one meaning;
// a rapid is one at the highest speed.
//
// Sources: RML-1 in the manuals of MDX-15/20, MDX-40 and SRM-20, Roland DG; the output of the fab modules.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>

#include "back/native/walk.h"
#include "base/codes/gcode.h"
#include "base/number.h"

namespace kerf {
namespace {

constexpr unsigned kZ = 4;
constexpr double kMarginOfFeeds = 0.1;  // mm/s: below the highest speed, so that a cut is not read as a rapid
constexpr double kSlowest = 0.1;        // mm/s: speeds have one decimal
constexpr double kCoarseStep = 0.025;   // mm, of the models that start with ^IN

using Position = std::array<std::optional<long>, 3>;  // steps; nothing: unknown

class RmlWriter : public native::Writer {
 public:
  RmlWriter(const Toolpath& path, const RmlMachine& machine, const NativeOptions& options,
            Diagnostics& diagnostics)
      : Writer(path, options, NativeToolChange::command, diagnostics), machine_(machine) {}

 private:
  void open_file() override;
  void close_file() override;
  void straight(std::size_t i, Speed speed, Point3 to, unsigned axes, Feed feed) override;
  bool arc(std::size_t, const ArcWalk&, Point3, Feed) override { return false; }
  void spindle(std::size_t i, const step::Spindle& wanted) override;
  void dwell(std::size_t i, Duration) override { left_out(i, "a dwell"); }
  void pause(std::size_t i) override { left_out(i, "a pause"); }
  void change_tool(std::size_t i, int tool, bool in_use) override;
  void comment(std::string_view) override {}  // the language has none

  void set_speed(double mm_per_second);
  double cutting_speed(std::size_t i, Feed feed);

  RmlMachine machine_;
  double speed_ = 0.0;  // mm/s, of the last V
  bool turns_ = false;
  Position at_;
};

void RmlWriter::open_file() {
  speed_ = 0.0;
  turns_ = false;
  at_ = {};
  text_ += machine_.step == kCoarseStep ? ";;^IN;\n" : ";;^DF;\n";
  text_ += "^PA;\n";
}

void RmlWriter::close_file() {
  if (turns_) text_ += "!MC0;\n";
  text_ += "H;\n";
}

void RmlWriter::set_speed(double mm_per_second) {
  if (mm_per_second == speed_) return;
  speed_ = mm_per_second;
  text_ += fmt::format("V{};\n", number_text(mm_per_second, 1));
}

/// In tenths of a mm per second.
double RmlWriter::cutting_speed(std::size_t i, Feed feed) {
  const double wanted = feed.mm_per_min() / 60.0, highest = machine_.fastest - kMarginOfFeeds;
  if (wanted > highest)
    left_out(i, fmt::format("feeds above {} mm/min, the machine's highest speed: what is more",
                            number_text(60.0 * machine_.fastest, 0)));
  constexpr double kRounding = 1e-9;
  const std::string slow = fmt::format("feeds below {} mm/min, the language's lowest speed, are raised to it",
                                       number_text(60.0 * kSlowest, 0));
  if (wanted < kSlowest - kRounding && once(slow))
    diagnostics_.warning(codes::post_left_out, path_.origin_of(i), slow);
  return std::clamp(std::round(10.0 * wanted) / 10.0, kSlowest, highest);
}

/// A position of which only Z is known goes by !ZM; across at an unknown height, the tool goes up first (PU),
/// to the highest Z of the program.
void RmlWriter::straight(std::size_t i, Speed speed, Point3 to, unsigned axes, Feed feed) {
  const auto count = [&](double value) { return std::lround(value / machine_.step); };
  Position next{count(to.x), count(to.y), count(to.z)};
  for (std::size_t axis = 0; axis < next.size(); ++axis)
    if ((axes >> axis & 1u) == 0) next[axis] = at_[axis];
  if (at_ == next) return;
  const bool rapid = speed == Speed::rapid;
  set_speed(rapid ? machine_.fastest : cutting_speed(i, feed));
  const bool in_plane = next[0] && next[1];
  if (in_plane && next[2]) {
    text_ += fmt::format("Z{},{},{};\n", *next[0], *next[1], *next[2]);
  } else if (axes == kZ) {
    text_ += fmt::format("!ZM{};\n", *next[2]);
  } else if (in_plane && rapid && top().value_or(-1.0) >= 0.0) {
    next[2] = count(*top());
    text_ += fmt::format("!PZ0,{};\nPU{},{};\n", *next[2], *next[0], *next[1]);
  } else {
    diagnostics_.error(codes::post_place_unknown, path_.origin_of(i),
                       "a motion while the positions of other axes are unknown");
  }
  at_ = next;
}

void RmlWriter::spindle(std::size_t i, const step::Spindle& wanted) {
  const bool turns = wanted.turn != SpindleTurn::off;
  if (wanted.turn == SpindleTurn::ccw) return cannot(i, "the spindle cannot turn counter-clockwise (M4)");
  if (turns && wanted.speed.rpm() > 0.0) left_out(i, "the spindle's speed, which is set at the machine,");
  if (turns != turns_) text_ += turns ? "!MC1;\n" : "!MC0;\n";
  turns_ = turns;
}

void RmlWriter::change_tool(std::size_t i, int, bool in_use) {
  if (!in_use || tool_change_ == NativeToolChange::ignore) return;
  cannot(i, "the machine's language has no tool change; write one file per tool with --tool-change files");
}

}  // namespace

std::vector<NativeFile> write_rml(const Toolpath& path, const RmlMachine& machine,
                                  const NativeOptions& options, Diagnostics& diagnostics,
                                  Progress* progress) {
  return RmlWriter(path, machine, options, diagnostics).run(progress);
}

}  // namespace kerf
