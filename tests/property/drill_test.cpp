// Random canned cycles of G-code become the moves that LinuxCNC documents, which this test writes out
// independently; random gcmc programs with drill() have the same toolpath as the G-code that is written for
// them. The seed of a failure is in its message; KERF_SEED repeats it.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <random>
#include <string>
#include <vector>

#include "front/gcmc/gcmc.h"

#include "kerf/program/gcode.h"

namespace kerf {
namespace {

constexpr unsigned kRuns = 400;

unsigned first_seed() {
  const char* seed = std::getenv("KERF_SEED");
  return seed != nullptr ? static_cast<unsigned>(std::strtoul(seed, nullptr, 10)) : 0;
}
unsigned runs() { return std::getenv("KERF_SEED") != nullptr ? 1 : kRuns; }

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  int whole(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }
  bool often(double chance) { return std::uniform_real_distribution(0.0, 1.0)(random_) < chance; }
  /// With three decimals; sometimes a whole number.
  double number(double low, double high) {
    if (often(0.2)) return std::round(low + (high - low) * 0.5);
    return std::round(std::uniform_real_distribution(low, high)(random_) * 1000) / 1000;
  }
  template <class T>
  T one_of(std::initializer_list<T> list) {
    return list.begin()[whole(0, static_cast<int>(list.size()) - 1)];
  }

 private:
  std::mt19937 random_;
};

enum class Resting : bool { keep, skip };  // straight motions of length 0; brief text omits them
/// The motions of a toolpath as text, each with feed, spindle, tool and unknown axes; dwells and pauses.
std::vector<std::string> essence_of(const Toolpath& path, Resting resting) {
  std::vector<std::string> all;
  const auto number = [](double v) { return std::round(v * 1e5) / 1e5 + 0.0; };
  MotionReader motions(path);
  bool more = motions.next();
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Step& s = path[i];
    if (s.kind() == StepKind::dwell) all.push_back(fmt::format("dwell {:g}", s.dwell().time.seconds()));
    if (s.kind() == StepKind::pause) all.push_back("pause");
    if (!s.is_motion()) continue;
    const MotionContext& c = motions.context();
    const bool turns = more && c.spindle.turn != SpindleTurn::off;
    std::string text =
        fmt::format("{} {} {} {} F{} S{} T{} ?{}", name_of(s.kind()), number(s.to().x), number(s.to().y),
                    number(s.to().z), number(s.kind() == StepKind::rapid ? 0 : s.feed().mm_per_min()),
                    turns ? number(c.spindle.speed.rpm()) * (c.spindle.turn == SpindleTurn::cw ? 1 : -1) : 0,
                    c.tool.value_or(-1), s.unknown_axes());
    if (s.kind() == StepKind::arc) {
      const step::Arc arc = s.arc();
      text += fmt::format(" c {} {} {} {} {}", number(arc.centre.x), number(arc.centre.y),
                          static_cast<int>(arc.plane), static_cast<int>(arc.turn), arc.extra_turns);
    }
    if (const MotionExtra* extra = path.extra(i); extra != nullptr && extra->abc)
      text += fmt::format(" ABC {} {} {}", number((*extra->abc)[0]), number((*extra->abc)[1]),
                          number((*extra->abc)[2]));
    const bool is_resting = s.kind() != StepKind::arc && distance(s.to(), motions.context().from) < 1e-9 &&
                            s.unknown_axes() == motions.context().unknown_from;
    if (!is_resting || resting == Resting::keep) all.push_back(text);
    more = motions.next();
  }
  return all;
}

std::string all_of(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& d : diagnostics.list()) text += to_string(d) + "\n";
  return text;
}

GcodeProgram read(const std::string& text, Diagnostics& diagnostics) {
  GcodeReadOptions options;
  options.dialect = GcodeDialect::rs274;
  return read_gcode(text, options, diagnostics);
}

void expect_same(const Toolpath& found, const Toolpath& wanted, const std::string& about,
                 Resting resting = Resting::keep) {
  const auto one = essence_of(found, resting), other = essence_of(wanted, resting);
  for (std::size_t i = 0; i < std::max(one.size(), other.size()); ++i) {
    const std::string left = i < one.size() ? one[i] : "nothing",
                      right = i < other.size() ? other[i] : "nothing";
    ASSERT_EQ(left, right) << "step " << i << " of\n" << about;
  }
}

// ---- canned cycles of G-code, and the same moves written out

/// Writes random cycles twice: as cycles, and as the moves that LinuxCNC documents for them.
class CycleProgram {
 public:
  explicit CycleProgram(unsigned seed) : dice_(seed) {
    both("G21 G90 G94 G17 F120 S1000 M3");
    level_ = dice_.number(-2, 8);
    both(fmt::format("G0 X0 Y0 Z{}", level_));
    if (dice_.often(0.15)) {
      cycles_ += "G95\n";  // 0.1 mm per turn at 1000 rpm
      cycles_ += "F0.1\n", moves_ += "F100\n";
    }
    for (int i = dice_.whole(1, 4); i > 0; --i) series();
    both("M2");
  }
  const std::string& cycles() const { return cycles_; }
  const std::string& moves() const { return moves_; }

 private:
  void both(const std::string& line) {
    cycles_ += line + "\n";
    moves_ += line + "\n";
  }
  void add_move(const std::string& line) { moves_ += line + "\n"; }
  void rapid(double z) { add_move(fmt::format("G0 X{} Y{} Z{:.6f}", x_, y_, level_ = z)); }
  void feed(double z) { add_move(fmt::format("G1 X{} Y{} Z{:.6f}", x_, y_, level_ = z)); }

  /// Consecutive cycles without another motion; the start level of all is that before the first.
  void series() {
    start_ = level_;
    for (int i = dice_.whole(1, 4); i > 0; --i) one();
    if (dice_.often(0.5)) return cycles_ += "G80\n", void();
    cycles_ += fmt::format("G0 Z{}\n", level_ = dice_.number(-2, 8));
    add_move(fmt::format("G0 Z{}", level_));
  }

  void one() {
    static constexpr int kCycles[] = {73, 74, 81, 82, 83, 84, 85, 86, 87, 88, 89};
    const int code = kCycles[dice_.whole(0, 10)];
    const bool to_start = dice_.often(0.5), incremental = dice_.often(0.3);
    const int holes = dice_.often(0.3) ? dice_.whole(2, 4) : 1;
    const double r = dice_.often(0.1) && !incremental ? level_ : dice_.number(-2, 4);
    const double depth = dice_.often(0.1) ? 0 : dice_.number(0, 6);
    peck_ = dice_.often(0.15) ? 50 : dice_.number(0.3, 3), dwell_ = dice_.one_of({0.0, 0.5, 2.0});
    const double x = dice_.number(-9, 9), y = dice_.number(-9, 9);
    aside_x_ = dice_.number(-1, 1), aside_y_ = dice_.number(-1, 1);
    plane_ = incremental ? start_ + r : r;
    bottom_ = plane_ - depth;
    const double back = dice_.number(0, 2);
    back_ = bottom_ + back;
    cycles_ += fmt::format("G{} G{} G{} X{} Y{} Z{:.6f} R{}", to_start ? 98 : 99, incremental ? 91 : 90, code,
                           x, y, incremental ? -depth : bottom_, r);
    if (code == 73 || code == 83) cycles_ += fmt::format(" Q{}", peck_);
    if (code == 87)
      cycles_ += fmt::format(" I{} J{} K{:.6f}", aside_x_, aside_y_, incremental ? back : back_);
    cycles_ += fmt::format(" P{}", dwell_);
    if (holes > 1) cycles_ += fmt::format(" L{}", holes);
    cycles_ += "\nG90\n";
    clear_ = to_start ? std::max(start_, plane_) : plane_;
    if (start_ < plane_) rapid(plane_);
    for (int i = 0; i < holes; ++i) {
      x_ = incremental ? x_ + x : x, y_ = incremental ? y_ + y : y;
      const double travel = std::max(level_, clear_);
      rapid(i == 0 ? travel : clear_);
      if (level_ != plane_) rapid(plane_);
      hole(code);
    }
  }

  void hole(int code) {
    if (code == 87) return back_bore();
    if (code == 73 || code == 83)
      for (double z = plane_ - peck_; z > bottom_ + 1e-9; z -= peck_) {
        feed(z);
        if (code == 83) rapid(plane_);
        rapid(z + 0.254);
      }
    feed(bottom_);
    const bool taps = code == 74 || code == 84;
    if (taps) add_move(code == 74 ? "M3" : "M4");
    if ((taps || code == 82 || code == 86 || code == 88 || code == 89) && dwell_ > 0)
      add_move(fmt::format("G4 P{}", dwell_));
    if (code == 86 || code == 88) add_move("M5");
    if (code == 88) add_move("M0");
    if (code == 85) feed(plane_);
    taps || code == 89 ? feed(clear_) : rapid(clear_);
    if (taps) turn_ = code == 74 ? "M4" : "M3";
    if (taps || code == 86 || code == 88) add_move(turn_);
  }

  void back_bore() {
    const double x = x_, y = y_;
    const auto aside = [&] { x_ = x + aside_x_, y_ = y + aside_y_; };
    aside(), rapid(plane_), add_move("M5"), rapid(bottom_);
    x_ = x, y_ = y, rapid(bottom_), add_move(turn_), feed(back_), feed(bottom_), add_move("M5");
    aside(), rapid(bottom_), rapid(clear_);
    x_ = x, y_ = y, rapid(clear_), add_move(turn_);
  }

  Dice dice_;
  std::string cycles_, moves_, turn_ = "M3";
  double x_ = 0, y_ = 0, level_ = 0, start_ = 0, plane_ = 0, bottom_ = 0, clear_ = 0, back_ = 0;
  double peck_ = 0, dwell_ = 0, aside_x_ = 0, aside_y_ = 0;
};

TEST(Cycles, AreTheMovesThatLinuxCncDocuments) {
  for (unsigned seed = first_seed(), end = seed + runs(); seed < end; ++seed) {
    const CycleProgram program(seed);
    Diagnostics cycle_errors, move_errors;
    const GcodeProgram cycles = read(program.cycles(), cycle_errors);
    const GcodeProgram moves = read(program.moves(), move_errors);
    ASSERT_FALSE(cycle_errors.has_errors()) << seed << "\n" << program.cycles() << all_of(cycle_errors);
    expect_same(cycles.path, moves.path, fmt::format("seed {}\n{}", seed, program.cycles()));
    if (HasFatalFailure()) return;
  }
}

// ---- drill() of gcmc, and the G-code that is written for it

class DrillProgram {
 public:
  explicit DrillProgram(unsigned seed) : dice_(seed) {
    options_.want_text = true;
    options_.imperial = dice_.often(0.2);
    options_.relative = dice_.often(0.2);
    options_.brief = dice_.often(0.2);
    options_.precision = 9;
    options_.plane = dice_.often(0.85) ? Plane::xy : dice_.one_of({Plane::xz, Plane::yz});
    if (dice_.often(0.2) && !options_.relative) options_.offsets[0] = 3, options_.offsets[2] = 1;
    text_ = "feedrate(120mm);\nspindle(1000);\n";
    for (int i = dice_.whole(2, 12); i > 0; --i) statement();
  }
  const std::string& text() const { return text_; }
  const GcmcOptions& options() const { return options_; }

 private:
  std::string coordinate(double chance, double low, double high) {
    return dice_.often(chance) ? fmt::format("{}mm", dice_.number(low, high)) : "-";
  }
  std::string point() {
    const double z = dice_.number(-3, 8);
    return fmt::format("[{},{},{}]", coordinate(0.8, -9, 9), coordinate(0.8, -9, 9),
                       dice_.often(0.5) ? fmt::format("{}mm", z) : "1mm");
  }
  void drill() {
    const double r = dice_.number(-1, 4), depth = dice_.often(0.1) ? 0 : dice_.number(0, 6);
    const double peck = dice_.often(0.15) ? 50 : dice_.number(0.3, 3);
    const double bottom = options_.plane == Plane::xy ? r - depth : r;
    std::string x = coordinate(0.85, -9, 9), y = coordinate(0.85, -9, 9);
    if (options_.plane == Plane::xz) y = fmt::format("{}mm", r - depth);
    if (options_.plane == Plane::yz) x = fmt::format("{}mm", r - depth);
    text_ += fmt::format("drill([{},{},{:.6f}mm], {}mm, {}mm", x, y, bottom, r, peck);
    if (dice_.often(0.2)) text_ += fmt::format(", {}", dice_.whole(1, 4));
    text_ += ");\n";
  }
  void statement() {
    switch (dice_.whole(0, 9)) {
      case 0: text_ += fmt::format("goto({});\n", point()); return;
      case 1: text_ += fmt::format("move({}, {}mm);\n", point(), dice_.number(50, 300)); return;
      case 2: text_ += fmt::format("move_r([{},1mm]);\n", coordinate(0.7, -3, 3)); return;
      case 3:
        if (!options_.relative)
          text_ += fmt::format("relocate([{},{}mm,{}mm]);\n", coordinate(0.5, -3, 3), dice_.number(-3, 3),
                               dice_.number(-1, 1));
        return;
      case 4: text_ += fmt::format("feedrate({}mm);\n", dice_.number(50, 300)); return;
      case 5:
        text_ += dice_.one_of({"toolchange(2);\n", "dwell(1);\n", "comment(\"x\");\n", "spindle(-500);\n"});
        return;
      case 6: text_ += fmt::format("goto([-,-,-,{}deg]);\n", dice_.number(0, 90)); return;
      default: return drill();
    }
  }
  Dice dice_;
  std::string text_;
  GcmcOptions options_;
};

class Writing final : public GcmcOutput {
 public:
  void message(const Diagnostic& m) override { messages += gcmc_line(m) + "\n"; }
  void text(std::string_view piece) override { gcode += piece; }
  std::string messages, gcode;
};

TEST(Drill, IsTheCycleOfTheGcodeThatIsWritten) {
  int drilled = 0, refused = 0;
  for (unsigned seed = first_seed(), end = seed + runs(); seed < end; ++seed) {
    const DrillProgram program(seed);
    Writing output;
    Diagnostics gcmc_errors, gcode_errors;
    const GcmcRun ran = run_gcmc(program.text(), program.options(), output, gcmc_errors);
    const std::string about = fmt::format("seed {}\n{}\n{}", seed, program.text(), output.gcode);
    const GcodeProgram gcode = read(output.gcode, gcode_errors);
    if (!ran.completed) {
      EXPECT_NE(output.messages.find("error"), std::string::npos) << about << output.messages;
      EXPECT_TRUE(gcmc_errors.has_errors()) << about;
      ++refused;
      continue;
    }
    ++drilled;
    ASSERT_FALSE(gcode_errors.has_errors()) << about << all_of(gcode_errors);
    expect_same(ran.path, gcode.path, about, program.options().brief ? Resting::skip : Resting::keep);
    if (HasFatalFailure()) return;
  }
  if (std::getenv("KERF_SEED") == nullptr) {
    EXPECT_GT(drilled, 200);
    EXPECT_GT(refused, 0);
  }
}

}  // namespace
}  // namespace kerf
