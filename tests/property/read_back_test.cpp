// What a post writes of a random program, read back, is the same program: motions with what is known of them
// and with the state in force, the events between, tools with their shapes, stock, filament. A post that
// cannot write a program has an error, or a warning of what it leaves out. KERF_RUNS is the number of
// programs, each for every post; 20,000 is the long run. KERF_SEED repeats one.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <string>
#include <unistd.h>
#include <vector>

#include "base/ending.h"
#include "base/number.h"
#include "path/firmware_retraction.h"
#include "path/state.h"
#include "random_program.h"

#include "kerf/job/job.h"
#include "kerf/job/posting.h"
#include "kerf/job/program.h"

namespace kerf {
namespace {

struct Motion {
  std::size_t step = 0;
  PathPosition from, to;
  double length = 0.0;
  double laid = 0.0;  // mm3 of filament until its end
  PathState state;
};

/// A rapid to where the tool is: cycles and homes add such ones.
bool stays(const Toolpath& path, std::size_t i, const PathState& state) {
  const Step& s = path[i];
  const MotionExtra* extra = path.extra(i);
  const bool turns = extra != nullptr && extra->abc && *extra->abc != state.abc;
  return s.kind() == StepKind::rapid && s.to() == state.position.at && s.reference_axes() == 0 && !turns &&
         s.unknown_axes() == state.position.unknown;
}

std::vector<Motion> motions_of(const Toolpath& path) {
  std::vector<Motion> made;
  StateReader reader(path);
  double laid = 0.0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!path[i].is_motion()) continue;
    reader.to(i);
    if (stays(path, i, reader.state())) continue;
    Motion m{i, reader.state().position, reader.state().position, 0.0, 0.0, reader.state()};
    m.to.pass(path[i]);
    if (path[i].kind() == StepKind::extrude) laid += path.extrude(i).volume.mm3();
    m.laid = laid;
    m.length = path[i].kind() == StepKind::arc ? walk_of(path[i], m.from.at).length()
                                               : distance(m.from.at, path[i].to());
    made.push_back(m);
  }
  return made;
}

/// A line for the firmware; empty for M400, with which posts for printers end.
std::string text_of_line(std::string_view line) {
  const FirmwareRetraction read = read_firmware_retraction(line);
  if (read.line != RetractionLine::lengths) return line == "M400" ? "" : std::string(line);
  std::string text = "retraction";  // each firmware has its own words
  for (const auto& value :
       {read.lengths.length, read.lengths.speed, read.lengths.extra, read.lengths.return_speed})
    text += value ? " " + number_text(*value, 2) : " -";
  return text;
}

/// What happens between motions, in its order.
std::string in_capitals(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), capital_letter);
  return text;
}

std::vector<std::string> events_of(const Toolpath& path, bool with_messages) {
  std::vector<std::string> list;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Step& s = path[i];
    switch (s.kind()) {
      case StepKind::dwell: list.push_back("dwell " + number_text(s.dwell().time.seconds(), 3)); break;
      case StepKind::pause: list.push_back(fmt::format("pause {}", static_cast<int>(s.pause().kind))); break;
      case StepKind::tool_change: list.push_back(fmt::format("tool {}", s.tool_change().tool)); break;
      case StepKind::extruder: list.push_back(fmt::format("extruder {}", s.extruder().number)); break;
      case StepKind::fan:
        list.push_back(fmt::format("fan {} {:.0f}", s.fan().fan, 255 * s.fan().fraction));
        break;
      case StepKind::verbatim:
        if (const std::string text = text_of_line(path.text(i)); !text.empty()) list.push_back(text);
        break;
      case StepKind::temperature: {
        const step::Temperature t = s.temperature();
        list.push_back(fmt::format("heater {} {} {} {}", static_cast<int>(t.heater),
                                   number_text(t.celsius, 1), t.wait, t.extruder));
        break;
      }
      case StepKind::note:
        if (with_messages && s.note_kind() == NoteKind::message) list.emplace_back(path.text(i));
        break;
      default: break;
    }
  }
  return list;
}

/// How far a written value may be from its source, and whether the controller shows messages.
struct Slack {
  double unit;  // mm of the last decimal
  double position;
  double chord;    // mm, of chords from their arc
  double feed;     // mm/min
  double inverse;  // 1/min, of the feed of a cut that turns
  bool messages;
};

bool near(const PathPosition& a, const PathPosition& b, const Slack& slack) {
  for (int axis = 0; axis < 3; ++axis)
    if ((a.unknown >> axis & 1u) == 0 && std::abs(a.at[axis] - b.at[axis]) > slack.position) return false;
  return a.unknown == b.unknown;
}

std::string text_of(const PathPosition& p) {
  return fmt::format("{},{},{} without {}", exact_text(p.at.x), exact_text(p.at.y), exact_text(p.at.z),
                     p.unknown);
}

/// Of the end of `m` from the curve of the written motion.
double off_curve(const Toolpath& path, const Motion& written, Point3 at) {
  const Step& s = path[written.step];
  if (s.kind() == StepKind::arc) {
    const ArcWalk walk = walk_of(s, written.from.at);
    const PlaneAxes axes = axes_of(walk.plane);
    return std::abs(std::hypot(at[axes.u] - walk.u, at[axes.v] - walk.v) - walk.start_radius);
  }
  if (written.from.unknown != 0 || written.to.unknown != 0) return 0.0;
  const Point3 way = s.to() - written.from.at;
  const double t = dot(way, way) > 0.0 ? dot(at - written.from.at, way) / dot(way, way) : 0.0;
  return distance(at, written.from.at + std::clamp(t, 0.0, 1.0) * way);
}

constexpr StateParts kCompared = bit_of(StatePart::tool) | bit_of(StatePart::tool_length) |
                                 bit_of(StatePart::path_mode) | bit_of(StatePart::coolant) |
                                 bit_of(StatePart::laser) | bit_of(StatePart::rotary) |
                                 bit_of(StatePart::extruder);

/// Without what the controller does without a word for it.
PathState rounded(PathState state, const PostProfile& profile) {
  const bool exact = state.path_mode && state.path_mode->kind == PathModeKind::exact_path;
  if (exact && !profile.has_g(610)) state.path_mode.reset();
  if (state.path_mode)
    state.path_mode->tolerance = mm(std::round(1e3 * state.path_mode->tolerance.mm()) / 1e3);
  if (state.length && state.length->kind == ToolLengthKind::none && !profile.has_g(490)) state.length.reset();
  if (state.length) state.length->offset.z = std::round(1e2 * state.length->offset.z) / 1e2;
  if (state.laser && state.laser->power == 0.0) state.laser->mode = LaserMode::off;
  for (std::size_t k = 0; k < 3; ++k) {
    state.abc[k] = std::round(1e3 * state.abc[k]) / 1e3;
    const bool lacks = !profile.has_letter(static_cast<char>('A' + k));
    if (lacks && state.abc[k] == 0.0) state.unknown_abc |= 1u << k;
  }
  return state;
}

/// Speeds are rounded to hundredths, or to percents of `full` and at most that; surface speeds to thousandths
/// of a metre or foot per minute.
bool same_spindle(const PathState& a, const PathState& b, double full) {
  const step::Spindle x = a.spindle.value_or(step::Spindle{}), y = b.spindle.value_or(step::Spindle{});
  const auto surface = [](const step::Spindle& s) { return s.surface_speed.mm_per_min(); };
  const double wanted = full > 0.0 ? std::min(x.speed.rpm(), full) : x.speed.rpm();
  const double slack = full > 0.0 ? full / 100.0 : 0.01;  // a percentage is at least 1
  return x.turn == y.turn && std::abs(wanted - y.speed.rpm()) < slack &&
         std::abs(surface(x) - surface(y)) < 0.5;
}

class Comparison {
 public:
  Comparison(const Program& written, const Program& read, const PostProfile& profile, const Slack& slack)
      : a_(written), b_(read), profile_(profile), slack_(slack) {}

  /// Empty, or what differs first.
  std::string run() {
    const std::vector<Motion> want = motions_of(a_.path), got = motions_of(b_.path);
    std::size_t next = 0;
    for (const Motion& m : want) {
      if (const std::string text = motion(m, got, next); !text.empty())
        return fmt::format("{}: {} of line {}, read at line {}", name_of(a_.path[m.step].kind()), text,
                           a_.path.origins().line(a_.path[m.step].origin()),
                           next == 0 ? 0 : b_.path.origins().line(b_.path[got[next - 1].step].origin()));
    }
    if (next != got.size()) return "more motions are read than were written";
    if (const std::string text = events(); !text.empty()) return text;
    return rest();
  }

 private:
  std::string motion(const Motion& m, const std::vector<Motion>& got, std::size_t& next) {
    const bool divided = a_.path[m.step].kind() == StepKind::arc;
    double length = 0.0;
    for (bool first = true; next < got.size(); first = false) {
      const Motion& one = got[next++];
      if (const std::string text = state(m, one, divided); !text.empty()) return text;
      if (first && !near(m.from, one.from, slack_)) return "the start";
      length += one.length;
      const double allowed = 0.01 * m.length + 4 * slack_.unit;
      const bool long_enough = length > m.length - allowed || m.from.unknown != 0;
      if (!divided || (near(m.to, one.to, slack_) && long_enough)) {
        if (!near(m.to, one.to, slack_))
          return fmt::format("the end {} for {}", text_of(one.to), text_of(m.to));
        if (m.from.unknown == 0 && m.to.unknown == 0 && std::abs(length - m.length) > allowed)
          return "the length";
        return {};
      }
      if (off_curve(a_.path, m, one.to.at) > 2 * slack_.unit + slack_.chord) return "the curve";
    }
    return "the motion, which is missing,";
  }

  std::string state(const Motion& m, const Motion& one, bool divided) const {
    const Step &a = a_.path[m.step], &b = b_.path[one.step];
    if (divided ? !b.is_cutting() : a.kind() != b.kind()) return "the kind";
    if (a.kind() == StepKind::probe && a.probe().kind != b.probe().kind) return "the kind of probe";
    if (a.reference() != b.reference() || a.reference_axes() != b.reference_axes()) return "the reference";
    const double from = a.feed().mm_per_min(), to = b.feed().mm_per_min();
    const bool locked = lock_of(a_, m) != SpindleLock::none;
    if (a.kind() != StepKind::rapid && !locked && std::abs(from - to) > feed_slack(m, one))
      return fmt::format("the feed {} for {}", to, from);
    if (lock_of(a_, m) != lock_of(b_, one)) return "the lock to the spindle";
    if (locked && std::abs(per_turn(a_, m) - per_turn(b_, one)) > slack_.unit) return "the pitch";
    const StateParts parts =
        difference(rounded(m.state, profile_), rounded(one.state, profile_)) & compared(a);
    if (parts != 0) return to_text(parts);
    if (!same_spindle(m.state, one.state, profile_.drive.full_speed.rpm())) return "the spindle";
    if (system_of(m.state) != system_of(one.state)) return "the work offset";
    if (std::abs(m.laid - one.laid) > 2e-3 + 1e-5 * std::abs(m.laid)) return "the filament";
    return a.kind() == StepKind::extrude ? bead(m, one) : std::string();
  }
  /// A feed in inverse time is the written length by the written time: both are rounded.
  double feed_slack(const Motion& m, const Motion& one) const {
    const double from = a_.path[m.step].feed().mm_per_min(), usual = slack_.feed + 1e-6 * from;
    const MotionExtra* extra = b_.path.extra(one.step);
    const bool turns = extra != nullptr && extra->abc && *extra->abc != one.state.abc;
    if (!turns || profile_.form.turning_feed != TurningFeed::inverse_time || m.length == 0.0) return usual;
    const double ends = 2.0 * std::sqrt(3.0) * slack_.position;  // mm, that the length may be off by them
    return usual + from * ends / m.length + slack_.inverse * m.length;
  }
  /// The power of a beam does not matter to a rapid.
  static StateParts compared(const Step& s) {
    return s.kind() == StepKind::rapid ? kCompared & ~bit_of(StatePart::laser) : kCompared;
  }
  static int system_of(const PathState& state) { return state.selected ? state.selected->system : 1; }
  static SpindleLock lock_of(const Program& program, const Motion& m) {
    const MotionExtra* extra = program.path.extra(m.step);
    return extra != nullptr ? extra->lock : SpindleLock::none;
  }
  static double per_turn(const Program& program, const Motion& m) {
    return program.path.extra(m.step)->per_turn;
  }
  std::string bead(const Motion& m, const Motion& one) const {
    const step::Extrude a = a_.path.extrude(m.step), b = b_.path.extrude(one.step);
    if (!(a.volume > Volume()) || m.length == 0.0) return {};
    if (std::abs(a.width.mm() - b.width.mm()) > 1e-5 || std::abs(a.height.mm() - b.height.mm()) > 1e-5)
      return "the size of the bead";
    return a.kind != b.kind && a.kind != BeadKind::none ? "the kind of the bead" : "";
  }

  std::string events() const {
    std::vector<std::string> a = events_of(a_.path, slack_.messages), b = events_of(b_.path, slack_.messages);
    if (profile_.form.capitals)
      for (std::string& text : a) text = in_capitals(text);
    if (profile_.form.capitals)
      for (std::string& text : b) text = in_capitals(text);
    const auto [x, y] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
    if (x == a.end() && y == b.end()) return {};
    return fmt::format("the event \"{}\" is read as \"{}\"", x == a.end() ? "" : *x, y == b.end() ? "" : *y);
  }

  std::string rest() const {
    if (a_.stock.has_value() != b_.stock.has_value()) return "the stock";
    if (a_.stock && (distance(a_.stock->block.low, b_.stock->block.low) > 1e-6 ||
                     distance(a_.stock->block.high, b_.stock->block.high) > 1e-6))
      return "the stock";
    if (a_.path.has(StepKind::extrude) &&
        std::abs(*a_.filament_diameter - b_.filament_diameter.value_or(0.0)) > 1e-9)
      return "the filament diameter";
    for (const auto& [number, tool] : used_tools(a_, {})) {
      const auto tools = used_tools(b_, {});
      const auto found = tools.find(number);
      if (found == tools.end() || !same_profile(tool.silhouette.cutting, found->second.silhouette.cutting))
        return fmt::format("the shape of tool {}", number);
    }
    return {};
  }
  static bool same_profile(const Profile& a, const Profile& b) {
    return std::equal(a.knots.begin(), a.knots.end(), b.knots.begin(), b.knots.end(),
                      [](const Knot& p, const Knot& q) {
                        return std::abs(p.r - q.r) < 1e-5 && std::abs(p.z - q.z) < 1e-5 &&
                               std::abs(p.bulge - q.bulge) < 1e-5;
                      });
  }

  const Program &a_, &b_;
  const PostProfile& profile_;
  Slack slack_;
};

/// Whether the firmware draws filament back.
bool draws_back(const Toolpath& path) {
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path[i].kind() == StepKind::verbatim &&
        read_firmware_retraction(path.text(i)).line == RetractionLine::back)
      return true;
  return false;
}

class ReadBack : public testing::Test {
 protected:
  void SetUp() override {
    file_ =
        (std::filesystem::path(testing::TempDir()) / fmt::format("kerf-read-back-{}.nc", getpid())).string();
  }
  void TearDown() override { std::filesystem::remove(file_); }

  Program loaded(const std::string& text, std::optional<GcodeDialect> dialect) {
    std::ofstream(file_, std::ios::binary) << text;
    ProgramOptions options;
    options.dialect = dialect;
    Diagnostics diagnostics;
    auto program = load_program(file_, options, diagnostics);
    for (const Diagnostic& d : diagnostics.list())
      if (d.severity == Severity::error) ADD_FAILURE() << to_string(d) << "\n" << text;
    return program ? std::move(*program) : Program{};
  }

  /// Whether the post has written the program without a warning; else the first one is `refusal_`.
  bool is_written_and_read(const Program& program, const std::string& text, const PostProfile& profile,
                           LengthUnit unit) {
    PostTarget target;
    target.profile = profile;
    target.profile->spindle_dwell = Duration{};
    PostingOptions options;
    options.unit = unit;
    Diagnostics diagnostics;
    const std::vector<PostedFile> files = post_program(program, target, options, diagnostics);
    const auto& list = diagnostics.list();
    const auto refusal =
        std::find_if(list.begin(), list.end(), [](const auto& d) { return d.severity != Severity::note; });
    refusal_ = refusal == list.end() ? "several files" : to_string(*refusal);
    if (refusal != list.end() || files.size() != 1) return false;
    if (draws_back(program.path) && !profile.has_g(100)) return true;  // as motions of E alone
    const Program read = loaded(files[0].text, {});
    const double mm = unit == LengthUnit::mm ? 1.0 : 25.4;
    const Decimals& digits = profile.decimals;
    const double rounding = program.path.has(StepKind::work_zero) ? 1.02 : 0.51;  // also of the zero
    const double last = mm * std::pow(10.0, -(unit == LengthUnit::mm ? digits.mm : digits.inch));
    const Slack slack{last,
                      rounding * last + 1e-9,
                      1.1 * profile.chord.mm(),
                      0.51 * mm * std::pow(10.0, -digits.feed),
                      0.51e-6,
                      profile.comments == CommentStyle::brackets};
    const std::string different = Comparison(program, read, profile, slack).run();
    EXPECT_EQ(different, "") << profile.name << "\n" << text << "\n---\n" << files[0].text;
    return true;
  }

  /// By every post; false after a failure.
  bool check(unsigned seed);

  std::string refusal_;
  std::map<std::string, int> written_;  // programs, by post

 private:
  std::string file_;
};

/// The controllers that have all of what the random programs of a kind use.
bool is_home(const RandomProgram& made, const PostProfile& profile) {
  if (made.kind == ProgramKind::mill) return profile.name == "linuxcnc";
  if (made.kind == ProgramKind::laser) return profile.name == "laser";
  return false;
}

bool ReadBack::check(unsigned seed) {
  const RandomProgram made = random_program(seed);
  const Program program = loaded(made.text, made.dialect);
  for (const PostProfile& profile : built_in_posts()) {
    const LengthUnit unit = seed % 2 == 0 && profile.has_g(200) ? LengthUnit::inch : LengthUnit::mm;
    SCOPED_TRACE(fmt::format("seed {} to {}", seed, profile.name));
    const bool written = is_written_and_read(program, made.text, profile, unit);
    written_[profile.name] += written ? 1 : 0;
    EXPECT_TRUE(written || !is_home(made, profile)) << refusal_ << "\n" << made.text;
    if (HasFailure()) return false;
  }
  return true;
}

TEST_F(ReadBack, what_a_post_writes_is_the_same_program) {
  const auto number = [](const char* name, unsigned usual) {
    const char* given = std::getenv(name);
    return given == nullptr ? usual : static_cast<unsigned>(std::atoi(given));
  };
  const unsigned first = number("KERF_SEED", 1), runs = number("KERF_RUNS", 300);
  for (unsigned seed = first; seed < first + runs; ++seed)
    if (!check(seed)) return;
  for (const auto& [name, count] : written_) {
    RecordProperty(name, count);
    EXPECT_TRUE(count > 0 || runs < 300) << name << " refuses all of them";
  }
}

}  // namespace
}  // namespace kerf
