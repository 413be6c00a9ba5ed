// OpenSBP, the language of ShopBot's machines (.sbp): one command of two letters per line, its parameters
// after commas, positions in the unit that the machine is set to, speeds in that unit per second.
//
// Source: Command Reference for the ShopBot Control Software and OpenSBP Language, ShopBot Tools, 2015.
#include <cmath>
#include <fmt/format.h>

#include "back/native/walk.h"
#include "base/number.h"

namespace kerf {
namespace {

constexpr int kDecimals = 6;
constexpr unsigned kAllAxes = 7, kPlaneXy = 3;

class OpenSbpWriter : public native::Writer {
 public:
  OpenSbpWriter(const Toolpath& path, const NativeOptions& options, Diagnostics& diagnostics)
      : Writer(path, options, NativeToolChange::pause, diagnostics),
        unit_mm_(options.inch ? kMmPerInch : 1.0) {}

 private:
  void open_file() override;
  void close_file() override;
  void straight(std::size_t i, Speed speed, Point3 to, unsigned axes, Feed feed) override;
  bool arc(std::size_t i, const ArcWalk& walk, Point3 to, Feed feed) override;
  void spindle(std::size_t i, const step::Spindle& wanted) override;
  void dwell(std::size_t i, Duration time) override;
  void pause(std::size_t i) override;
  void change_tool(std::size_t i, int tool, bool in_use) override;
  void comment(std::string_view text) override;

  std::string length(double mm_value) const { return number_text(mm_value / unit_mm_, kDecimals); }
  void line(std::string_view text) { text_.append(text).append("\n"); }
  void set_feed(Feed feed);
  void stop();

  double unit_mm_;
  double feed_ = 0.0;   // mm/min, of the last MS
  double speed_ = 0.0;  // rpm, of the last TR
  bool turns_ = false;
};

/// The machine is set to inches or to mm by its own setting, %(25); a file of the other unit must not run.
void OpenSbpWriter::open_file() {
  feed_ = speed_ = 0.0;
  turns_ = false;
  if (!options_.title.empty()) comment(options_.title);
  comment(fmt::format("{}, OpenSBP in {}", options_.writer, options_.inch ? "inches" : "mm"));
  for (const std::string& text : options_.comments) comment(text);
  line(fmt::format("IF %(25)={} THEN GOTO UNIT_ERROR", options_.inch ? 1 : 0));
  line("SA");
}

void OpenSbpWriter::close_file() {
  stop();
  line("END");
  line("UNIT_ERROR:");
  line("CN,91");
  line("END");
}

void OpenSbpWriter::set_feed(Feed feed) {
  if (feed.mm_per_min() == feed_) return;
  feed_ = feed.mm_per_min();
  const std::string speed = length(feed_ / 60.0);  // for X and Y, and for Z
  line(fmt::format("MS,{},{}", speed, speed));
}

void OpenSbpWriter::straight(std::size_t, Speed speed, Point3 to, unsigned axes, Feed feed) {
  if (speed == Speed::feed) set_feed(feed);
  const char letter = speed == Speed::rapid ? 'J' : 'M';
  const std::string x = length(to.x), y = length(to.y), z = length(to.z);
  switch (axes) {
    case 1: return line(fmt::format("{}X,{}", letter, x));
    case 2: return line(fmt::format("{}Y,{}", letter, y));
    case 4: return line(fmt::format("{}Z,{}", letter, z));
    case kPlaneXy: return line(fmt::format("{}2,{},{}", letter, x, y));
    case kAllAxes: return line(fmt::format("{}3,{},{},{}", letter, x, y, z));
    default:  // an empty parameter: the axis stays
      return line(
          fmt::format("{}3,{},{},{}", letter, (axes & 1u) != 0 ? x : "", (axes & 2u) != 0 ? y : "", z));
  }
}

/// CG with the centre from the start, no compensation (T), 1 clockwise.
bool OpenSbpWriter::arc(std::size_t, const ArcWalk& walk, Point3 to, Feed feed) {
  set_feed(feed);
  const Point3 from = position().at;
  line(fmt::format("CG,,{},{},{},{},T,{}", length(to.x), length(to.y), length(walk.u - from.x),
                   length(walk.v - from.y), walk.sweep < 0.0 ? 1 : -1));
  return true;
}

void OpenSbpWriter::stop() {
  if (turns_) line("C7");
  turns_ = false;
}

void OpenSbpWriter::spindle(std::size_t i, const step::Spindle& wanted) {
  if (wanted.turn == SpindleTurn::off) return stop();
  if (wanted.turn == SpindleTurn::ccw) return cannot(i, "the spindle cannot turn counter-clockwise (M4)");
  const double rpm = wanted.speed.rpm();
  if (rpm > 0.0 && rpm != speed_) {
    speed_ = rpm;
    line(fmt::format("TR,{}", number_text(rpm, 0)));
  }
  if (!turns_) line("C6");
  turns_ = true;
}

void OpenSbpWriter::dwell(std::size_t, Duration time) {
  line(fmt::format("PAUSE {}", number_text(time.seconds(), 3)));
}

void OpenSbpWriter::pause(std::size_t) { line("PAUSE"); }

/// The tool of the first change is in the spindle already, unless the machine changes tools itself.
void OpenSbpWriter::change_tool(std::size_t, int tool, bool in_use) {
  if (tool_change_ == NativeToolChange::ignore) return;
  const bool by_hand = tool_change_ == NativeToolChange::pause && in_use;
  if (by_hand) stop();
  const auto name = options_.tool_names.find(tool);
  if (name != options_.tool_names.end()) comment(fmt::format("tool {}: {}", tool, name->second));
  line(fmt::format("&Tool = {}", tool));
  if (tool_change_ == NativeToolChange::command) {
    stop();
    line("C9");
  }
  if (!by_hand) return;
  comment(fmt::format("change to tool {}", tool));
  line("PAUSE");
}

void OpenSbpWriter::comment(std::string_view text) {
  std::string out = "'";
  for (const char c : text) out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  line(out);
}

}  // namespace

std::vector<NativeFile> write_opensbp(const Toolpath& path, const NativeOptions& options,
                                      Diagnostics& diagnostics, Progress* progress) {
  return OpenSbpWriter(path, options, diagnostics).run(progress);
}

}  // namespace kerf
