// Steps as the lines of PathDxf2GCode.
#include "base/codes/gcode.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

#include "back/pathdxf/pathdxf_gcode.h"
#include "base/number.h"

namespace kerf {
namespace {

constexpr unsigned kX = 1, kY = 2, kZ = 4;  // bits of axes
constexpr double kHeaderFeed = 150.0;       // mm/min, in force until the first F word
constexpr double kSameFeed = 1e-9;          // mm/min

class Writer {
 public:
  Writer(const Toolpath& path, Diagnostics& diagnostics) : path_(path), diagnostics_(diagnostics) {}

  std::string write(const PathdxfGcodeOptions& options) {
    out_ = fmt::format("%\n({})\n({})\nF{:.0f}\nG17 G21 G40 G49 G54 G80 G90 G94\n", options.program_line,
                       options.file_name, kHeaderFeed);
    for (std::size_t i = 0; i < path_.size(); ++i) add(i);
    return out_ + "%\n";
  }

 private:
  void add(std::size_t i) {
    const Step& s = path_[i];
    switch (s.kind()) {
      case StepKind::tool_change: return line(fmt::format("T{}", s.tool_change().tool));
      case StepKind::note: return note(path_.text(i));
      case StepKind::rapid: return rapid(i);
      case StepKind::cut: return cut(i);
      case StepKind::arc: return arc(i);
      case StepKind::probe: return probe(s);
      case StepKind::dwell: return line(fmt::format("G04 P{}", number_text(s.dwell().time.seconds(), 3)));
      case StepKind::end: return line("M30");
      case StepKind::spindle:
      case StepKind::coolant:
      case StepKind::path_mode:
      case StepKind::extrude:
      case StepKind::temperature:
      case StepKind::fan:
      case StepKind::laser_power:
      case StepKind::layer:
      case StepKind::verbatim:
      case StepKind::pause:
      case StepKind::close_path:
      case StepKind::store_home:
      case StepKind::work_zero:
      case StepKind::tool_length:
      case StepKind::unresolved:
      case StepKind::motion_limits:
      case StepKind::extruder: break;
    }
    diagnostics_.error(codes::post_cannot, path_.origin_of(i),
                       fmt::format("a {} step cannot be written in this form", name_of(s.kind())));
  }

  void line(std::string_view text) {
    out_ += text;
    out_ += '\n';
  }
  void word(char letter, double value) {
    out_ += ' ';
    out_ += letter;
    append_fixed(out_, value, 3, MinusZero::keep);
  }
  void note(std::string_view text) {
    if (text.substr(0, 1) == ";") return line(text);
    const std::size_t indent = std::min(text.find_first_not_of(' '), text.size());
    out_.append(indent, ' ');
    out_ += fmt::format("({})\n", text.substr(indent));
  }
  void feed_word(const Step& s) {
    feed_ = s.feed().mm_per_min();
    word('F', feed_);
  }
  /// X, Y and Z as named by the step, then the correction of Z.
  void axes(std::size_t i) {
    const Step& s = path_[i];
    const unsigned named = s.named_axes() == 0 ? (kX | kY | kZ) : s.named_axes();
    if ((named & kX) != 0) word('X', s.to().x);
    if ((named & kY) != 0) word('Y', s.to().y);
    if ((named & kZ) != 0) word('Z', s.to().z);
    const MotionExtra* extra = path_.extra(i);
    if ((named & kZ) != 0 && extra != nullptr && !extra->z_correction.empty())
      out_ += fmt::format("(={})", extra->z_correction);
    out_ += '\n';
    position_ = s.to();
  }
  void rapid(std::size_t i) {
    out_ += "G00";
    axes(i);
  }
  /// Plunges keep the feed rate in force.
  void cut(std::size_t i) {
    const Step& s = path_[i];
    out_ += "G01";
    if (s.named_axes() != kZ || std::abs(s.feed().mm_per_min() - feed_) > kSameFeed) feed_word(s);
    axes(i);
  }
  void arc(std::size_t i) {
    const Step& s = path_[i];
    const step::Arc a = s.arc();
    out_ += a.turn == Turn::cw ? "G02" : "G03";
    feed_word(s);
    const Point2 centre = a.centre - position_.xy();
    // The half circles of helices lie exactly above and below their centre.
    if (centre.x == 0.0 && s.to().x == position_.x)
      out_ += " I0";
    else
      word('I', centre.x);
    word('J', centre.y);
    axes(i);
  }
  void probe(const Step& s) {
    const step::Probe p = s.probe();
    const int kind = 2 + static_cast<int>(p.kind);
    out_ += fmt::format("G38.{} Z{}", kind, number_text(p.to.z, 3));
    feed_word(s);
    out_ += '\n';
    position_ = p.to;
  }

  const Toolpath& path_;
  Diagnostics& diagnostics_;
  std::string out_;
  Point3 position_;
  double feed_ = kHeaderFeed;
};

}  // namespace

std::string pathdxf_gcode(const Toolpath& path, const PathdxfGcodeOptions& options,
                          Diagnostics& diagnostics) {
  return Writer(path, diagnostics).write(options);
}

}  // namespace kerf
