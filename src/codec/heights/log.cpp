// Console logs of controllers: what their probes measured, in the work coordinates in force at each probe.
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <fmt/format.h>

#include "base/codes/pathdxf.h"
#include "base/names.h"
#include "base/number.h"
#include "codec/heights/sink.h"

#include "kerf/base/units.h"

namespace kerf::heights_detail {
namespace {

constexpr double kSameOffset = 0.0005;  // mm
constexpr double kSamePosition = 0.1;   // mm, of the probes of one touch-off
constexpr std::size_t kMaxTouches = 5;  // fast, then slow, perhaps repeated
constexpr std::string_view kBed = "Bed X:", kKlipper = "probe at ", kKlipperNew = "Result: at ";

using Offset = std::array<double, 3>;

bool differs(const Offset& a, const Offset& b) {
  return std::abs(a[0] - b[0]) > kSameOffset || std::abs(a[1] - b[1]) > kSameOffset ||
         std::abs(a[2] - b[2]) > kSameOffset;
}

/// A result in machine coordinates.
struct Touch {
  std::size_t line = 0;
  Offset at{};
  bool has_contact = true;
  std::optional<Offset> offset;  // the one known before it
};

class LogReader {
 public:
  explicit LogReader(const HeightsSink& sink) : sink_(sink) {}

  void read(std::string_view bytes) {
    for_each_line(bytes, [&](std::size_t line, std::string_view text) { return take(line, text); });
    if (!touches_.empty()) finish();
  }

 private:
  bool take(std::size_t line, std::string_view text);
  bool take_printer(std::size_t line, std::string_view text, bool& good);
  void take_offset(std::size_t line, std::string_view text);
  std::optional<std::vector<double>> values_of(std::size_t line, std::string_view text, std::string_view key,
                                               std::size_t count);
  void take_command(std::string_view text);
  void take_result(std::size_t line, std::string_view text);
  void leave_out(std::size_t line, const char* reason);
  void finish();
  std::size_t touch_off_from(std::size_t i) const;
  double unit() const { return sink_.options.mm_per_unit.value_or(unit_); }

  const HeightsSink& sink_;
  double unit_ = 1.0;  // mm, of the controller's reports
  std::string system_ = "G54";
  std::map<std::string, Offset> systems_;
  Offset shift_{};
  double tool_length_ = 0.0;
  bool in_parameters_ = false;  // of the answer to $#
  bool is_reported_ = false;    // by status reports, which have the whole offset
  bool failed_ = false;
  std::optional<Offset> offset_;
  std::deque<bool> commands_;  // of the probes that were sent: whether each probes along Z
  std::vector<Touch> touches_;
};

/// The numbers after `key`; an error where the key is there without them: another offset would be used.
std::optional<std::vector<double>> LogReader::values_of(std::size_t line, std::string_view text,
                                                        std::string_view key, std::size_t count) {
  auto values = values_after(text, key, count);
  if (!values && text.find(key) != std::string_view::npos) {
    failed_ = true;
    sink_.error(codes::heights_format, line,
                fmt::format("expected {} {} after {}", count, count == 1 ? "number" : "numbers", key));
  }
  return values;
}

/// "WCO:1,2,3" of a status report, or the lines of the answer to $#.
void LogReader::take_offset(std::size_t line, std::string_view text) {
  if (text.substr(0, 4) == "$13=") unit_ = text.substr(4, 1) == "1" ? kMmPerInch : 1.0;
  if (const std::size_t modes = text.find("[GC:"); modes != std::string_view::npos)
    for (int g = 54; g <= 59; ++g)
      if (text.find(fmt::format(" G{} ", g), modes) != std::string_view::npos)
        system_ = fmt::format("G{}", g);
  if (const auto wco = values_of(line, text, "WCO:", 3)) {
    offset_ = Offset{(*wco)[0], (*wco)[1], (*wco)[2]};
    is_reported_ = true;
  }
  bool is_parameter = text.substr(0, 4) == "[G28" || text.substr(0, 4) == "[G30";
  for (int g = 54; g <= 59; ++g)
    if (const auto v = values_of(line, text, fmt::format("[G{}:", g), 3)) {
      systems_[fmt::format("G{}", g)] = {(*v)[0], (*v)[1], (*v)[2]};
      is_parameter = true;
    }
  if (const auto v = values_of(line, text, "[G92:", 3))
    shift_ = {(*v)[0], (*v)[1], (*v)[2]}, is_parameter = true;
  const auto length = values_of(line, text, "[TLO:", 1);
  if (length) tool_length_ = length->back(), is_parameter = true;
  const auto system = systems_.find(system_);
  // G92 and TLO follow the coordinate systems in one answer: the offset is whole at its last line.
  if (is_parameter && !is_reported_ && system != systems_.end())
    offset_ = Offset{system->second[0] + shift_[0], system->second[1] + shift_[1],
                     system->second[2] + shift_[2] + tool_length_};
  const bool is_table = text.substr(0, 3) == "[T:" || text.substr(0, 6) == "[HOME:";
  in_parameters_ = is_parameter || (in_parameters_ && is_table);
}

/// A line that was sent, as senders show it: "> G38.2 Z-5 F50".
void LogReader::take_command(std::string_view text) {
  const std::size_t at = text.find("G38.");
  if (at == std::string_view::npos || text.find('[') != std::string_view::npos) return;
  const std::string_view words = text.substr(at + 4);
  const bool has_z = words.find('Z') != std::string_view::npos;
  commands_.push_back(has_z || words.find_first_of("XY") == std::string_view::npos);
}

void LogReader::leave_out(std::size_t line, const char* reason) {
  sink_.diagnostics.note(codes::heights_left_out,
                         TextLocation{sink_.out.file, static_cast<std::uint32_t>(line), 0}, reason);
}

/// "[PRB:1.000,2.000,-3.100:1]"
void LogReader::take_result(std::size_t line, std::string_view text) {
  const auto position = values_after(text, "[PRB:", 3);
  const std::string_view rest = text.substr(text.find("[PRB:") + 5);
  const std::size_t colon = rest.find(':');
  const std::string_view flag = colon == std::string_view::npos ? "" : rest.substr(colon + 1, 1);
  if (!position || (flag != "0" && flag != "1")) {
    sink_.error(codes::heights_format, line, "expected [PRB:x,y,z:1], or :0 without contact");
    failed_ = true;
    return;
  }
  Touch t{line, {(*position)[0], (*position)[1], (*position)[2]}, flag == "1", offset_};
  if (in_parameters_) {
    in_parameters_ = false;  // its last line
    if (touches_.empty() || differs(touches_.back().at, t.at))
      leave_out(line,
                "a probe in the answer to $# is left out: it is the last one before, perhaps a touch-off");
    return;
  }
  const bool is_upright = commands_.empty() || commands_.front();
  if (!commands_.empty()) commands_.pop_front();
  if (!is_upright) return leave_out(line, "a probe along X or Y is left out");
  if (!touches_.empty() && !differs(touches_.back().at, t.at) && touches_.back().has_contact == t.has_contact)
    return;  // shown twice
  touches_.push_back(t);
}

/// "Bed X: 1.00 Y: 2.00 Z: 0.10" of Marlin's G30 and G29, "probe at 1.000,2.000 is z=0.1" of Klipper's PROBE.
bool LogReader::take_printer(std::size_t line, std::string_view text, bool& good) {
  std::optional<double> x, y, z;
  const auto word = [](std::string_view at) {
    const std::size_t start = at.find_first_not_of(' ');
    if (start == std::string_view::npos) return std::optional<double>();
    return parse_number(at.substr(start, at.find_first_of(" ,\t", start) - start));
  };
  const auto after = [&](std::string_view key, std::size_t from) {
    const std::size_t at = text.find(key, from);
    return at == std::string_view::npos ? std::optional<double>() : word(text.substr(at + key.size()));
  };
  if (const std::size_t at = text.find(kBed); at != std::string_view::npos) {
    x = after("X:", at), y = after("Y:", at), z = after("Z:", at);
  } else if (text.find(kKlipper) != std::string_view::npos ||
             text.find(kKlipperNew) != std::string_view::npos) {
    const std::string_view key = text.find(kKlipperNew) != std::string_view::npos ? kKlipperNew : kKlipper;
    const std::size_t start = text.find(key) + key.size();
    x = after("", start), z = after("z=", start);
    x = word(text.substr(start));
    y = after(",", start);
  } else {
    return false;
  }
  good = x && y && z && sink_.add(line, *x, *y, z, unit());
  if (!x || !y || !z)
    sink_.error(codes::heights_format, line, "expected the position and height of a probe: X, Y and Z");
  return true;
}

bool LogReader::take(std::size_t line, std::string_view text) {
  bool good = true;
  if (take_printer(line, text, good)) return good;
  if (text.find("[PRB:") != std::string_view::npos) {
    take_result(line, text);
    if (touches_.size() <= sink_.options.max_heights) return true;
    sink_.error(codes::level_map, line, fmt::format("more than {} heights", sink_.options.max_heights));
    failed_ = true;
    return false;
  }
  take_command(text);
  take_offset(line, text);
  return true;
}

/// The end of the touch-off that starts at probe `i`: a few probes at one position, the only ones with their
/// Z zero, and more probes with another one after them. `i` itself if none starts there.
std::size_t LogReader::touch_off_from(std::size_t i) const {
  if (i > 0 && touches_[i - 1].offset == touches_[i].offset) return i;
  std::size_t end = i + 1;
  const auto is_same = [&](const Touch& t) {
    return t.offset == touches_[i].offset && std::abs(t.at[0] - touches_[i].at[0]) * unit() < kSamePosition &&
           std::abs(t.at[1] - touches_[i].at[1]) * unit() < kSamePosition;
  };
  while (end < touches_.size() && is_same(touches_[end])) ++end;
  if (end == touches_.size() || end - i > kMaxTouches) return i;
  if (!touches_[end].offset) return i;
  const std::optional<Offset>& before = touches_[i].offset;
  return before && std::abs((*before)[2] - (*touches_[end].offset)[2]) > kSameOffset ? end : i;
}

void LogReader::finish() {
  if (failed_) return;
  const std::optional<std::array<double, 3>> given = sink_.options.work_offset;
  if (!given && !offset_) {
    sink_
        .error(codes::heights_missing, 0,
               "the positions of [PRB:...] are machine coordinates, and the log has no work offset")
        .hint = "add the controller's answer to $# or ? to the log, or specify --work-offset X,Y,Z";
    return;
  }
  std::vector<Touch> kept;
  for (std::size_t i = 0; i < touches_.size();) {
    const std::size_t end = given ? i : touch_off_from(i);
    for (std::size_t k = i; k < end; ++k)
      leave_out(touches_[k].line, "a probe is left out: the Z zero is set after it, as at a touch-off");
    if (end == i) kept.push_back(touches_[i++]);
    i = std::max(i, end);
  }
  // The first offset of the log counts for the probes before it.
  std::optional<Offset> first = offset_;
  for (auto t = kept.rbegin(); t != kept.rend(); ++t)
    if (t->offset) first = t->offset;
  std::optional<Offset> last;
  bool is_warned = given.has_value();
  const auto compare = [&](const Offset& now, std::size_t line, const char* what) {
    if (last && differs(*last, now) && !is_warned) {
      is_warned = true;
      sink_.warning(codes::heights_offset, line, what).hint =
          "each height is above the work zero that was in force when it was measured; measure again, or "
          "specify "
          "--work-offset";
    }
    last = now;
  };
  for (const Touch& t : kept) {
    const Offset own = t.offset ? *t.offset : *first;
    compare(own, t.line, "the work offset differs from that of the probes before");
    const double u = unit();
    const Offset o = given ? *given : Offset{own[0] * u, own[1] * u, own[2] * u};
    const std::optional<double> z = t.has_contact ? std::optional(t.at[2] * u - o[2]) : std::nullopt;
    if (!sink_.add(t.line, t.at[0] * u - o[0], t.at[1] * u - o[1], z, 1.0)) return;
  }
  if (offset_) compare(*offset_, 0, "the work offset is changed after the last probe");
}

}  // namespace

bool is_log(std::string_view bytes) {
  for (const std::string_view key : {std::string_view("[PRB:"), kBed, kKlipper, kKlipperNew})
    if (bytes.find(key) != std::string_view::npos) return true;
  return false;
}

void read_log(std::string_view bytes, const HeightsSink& sink) { LogReader(sink).read(bytes); }

}  // namespace kerf::heights_detail
