// Random programs. They are correct: what is referred to exists, and arcs close to the last decimal.
#include "random_program.h"

#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <random>
#include <set>
#include <vector>

#include "base/number.h"
#include "tool/tool_description.h"

#include "kerf/formats/workshop_files.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf {
namespace {

/// Lines with random values.
class Lines {
 public:
  explicit Lines(unsigned seed) : random_(seed) {}

 protected:
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  bool chance(int of) { return whole(1, of) == 1; }
  /// With two decimals, so that sums are exact in both units.
  double real(double low, double high) {
    return std::round(100.0 * std::uniform_real_distribution<double>(low, high)(random_)) / 100.0;
  }
  template <class... Values>
  void line(fmt::format_string<Values...> format, Values&&... values) {
    text_ += fmt::format(format, std::forward<Values>(values)...) + "\n";
  }
  /// "X12.5", in the unit of the program.
  std::string word(char letter, double mm) const { return letter + number_text(mm / unit_, 6); }
  std::string feed() { return word('F', 10.0 * whole(5, 90)); }
  std::string xy() { return word('X', real(-40, 40)) + " " + word('Y', real(-40, 40)); }

  std::mt19937 random_;
  std::string text_;
  double unit_ = 1.0;  // mm
};

class MillProgram : Lines {
 public:
  explicit MillProgram(unsigned seed) : Lines(seed) {}

  std::string make() {
    unit_ = chance(4) ? 25.4 : 1.0;
    rotary_ = chance(5);
    line("{} G17 G90 G94 G40", unit_ == 1.0 ? "G21" : "G20");
    if (unit_ == 1.0 && chance(2)) stock();
    for (int n = chance(3) ? whole(1, 3) : 0; n > 0; --n) subroutine();
    if (chance(3)) {
      line("G10 L2 P1 X0 Y0 Z0");
      line("G10 L2 P2 {} {}", xy(), word('Z', real(-3, 3)));
      related_ = true;
    }
    if (chance(5)) {  // one tool, without a change
      work();
    } else {
      const int first = whole(1, 60);
      for (int n = 0, count = whole(1, 3); n < count; ++n) section(first + n);
    }
    line("M5");
    line("M9");
    line("{}", chance(2) ? "M2" : "M30");
    return std::move(text_);
  }

 private:
  void stock() {
    const Point3 low{real(-60, -40), real(-60, -40), real(-12, -8)};
    for (const std::string& comment : write_stock_comments({{low, {real(40, 60), real(40, 60), 0}}}))
      line("({})", comment);
  }
  void subroutine() {
    const int number = 100 + 100 * static_cast<int>(subroutines_.size());
    subroutines_.push_back(number);
    line("o{} sub", number);
    line("G91 G1 {} {}", word('Z', -0.5), feed());
    line("{}", word('X', real(1, 5)));
    if (chance(2)) line("#1 = [#1 + 1]");
    line("G90 G0 {}", word('Z', 9));
    line("o{} endsub", number);
  }
  void section(int tool) {
    line("T{} M6", tool);
    const auto& tools = built_in_tools().tools();
    const auto described = std::next(tools.begin(), whole(0, static_cast<int>(tools.size()) - 1));
    line("(tool {}: {})", tool, write_tool_description(described->second));
    switch (whole(0, 3)) {
      case 0: line("G43.1 {}", word('Z', real(5, 30))); break;
      case 1: line("G49"); break;
      default: line("G43 H{}", tool);
    }
    work();
  }
  void work() {
    if (chance(3)) path_mode();
    spindle();
    line("G0 {}", word('Z', 9));
    if (!chance(9)) line("G0 {}", xy());
    if (rotary_) line("G0 A{}", whole(-8, 8) * 22.5);
    line("G1 {} {}", word('Z', real(-3, 0)), feed());
    for (int n = whole(2, 8); n > 0; --n) part();
    line("G0 {}", word('Z', 9));
    if (chance(2)) line("M5");
    if (chance(6)) line("{}", chance(2) ? "M0" : "M1");
  }
  void path_mode() {
    const int mode = whole(0, 2);
    if (mode == 2)
      line("G64 {}", word('P', 0.01 * whole(1, 9)));
    else
      line("{}", mode == 0 ? "G61" : "G61.1");
  }
  void spindle() {
    turn_ = chance(4) ? "M4" : "M3";
    if (chance(8)) {
      line("G96 D{} S{} {}", whole(1000, 4000), whole(20, 200), turn_);
      surface_ = speed_stated_ = true;
      if (chance(2)) change_speed();
    } else if (!speed_stated_ && chance(3)) {
      line("{}", turn_);
    } else {
      change_speed();
      line("{}", turn_);
    }
  }
  void change_speed() {
    line("{}S{}", surface_ ? "G97 " : "", whole(2, 20) * 500);
    surface_ = false, speed_stated_ = true;
  }
  void part() {
    switch (whole(0, 19)) {
      case 0: return line("M{}", whole(7, 9));
      case 1: return line("G4 P{}", 0.25 * whole(1, 8));
      case 2: return line("(MSG, turn {})", whole(1, 9));
      case 3: return change_speed();
      case 4: return inverse_time();
      case 5: return per_turn();
      case 6: return cycle();
      case 7: return thread();
      case 8: return call();
      case 9: return relative();
      case 10: return machine();
      case 11: return probe();
      case 12: return zero();
      case 13: return spindle();
      case 14: return rapid();
      case 15:
      case 16: return cut();
      default: return arc();
    }
  }
  std::string turn() { return rotary_ && chance(2) ? fmt::format(" A{}", whole(-8, 8) * 22.5) : ""; }
  void rapid() {
    line("G0 {}", word('Z', 9));
    line("G0 {}{}", xy(), turn());
  }
  void cut() {
    if (chance(6)) return line("G1 {}", chance(2) ? word('X', real(-40, 40)) : word('Z', real(-6, -1)));
    line("G1 {}{} {}", xy(), turn(), chance(2) ? feed() : word('Z', real(-6, -1)));
  }
  void inverse_time() {
    line("G93");
    for (int n = whole(1, 3); n > 0; --n) line("G1 {}{} F{}", xy(), turn(), whole(1, 30));
    line("G94 {}", feed());
  }
  void per_turn() {
    if (surface_ || !speed_stated_) change_speed();
    line("G95 {}", word('F', 0.01 * whole(2, 20)));
    line("G1 {}", xy());
    line("G94 {}", feed());
  }
  void cycle() {
    line("G0 {}", word('Z', 9));
    line("G0 {}", xy());
    const std::string words = fmt::format("{} {} {}", word('R', 2), word('Z', real(-6, -1)), feed());
    switch (whole(0, 4)) {
      case 0: line("{} G83 {} {}", chance(2) ? "G98" : "G99", words, word('Q', real(0.5, 2))); break;
      case 1: line("{} G82 {} P0.5", chance(2) ? "G98" : "G99", words); break;
      case 2: line("G98 {} {}", turn_ == "M3" ? "G84" : "G74", words); break;
      case 3: line("G98 G73 {} {}", words, word('Q', real(0.5, 2))); break;
      default: line("{} G81 {}", chance(2) ? "G98" : "G99", words);
    }
    for (int n = whole(0, 2); n > 0; --n) line("{}", xy());
    line("G80");
    line("G0 {}", word('Z', 9));
  }
  void thread() {
    line("G0 {}", word('Z', 9));
    line("{} {} {}", chance(2) ? "G33" : "G33.1", word('Z', real(-6, -1)), word('K', 0.25 * whole(2, 6)));
    line("G0 {}", word('Z', 9));
    line("G1 {}", feed());
  }
  void call() {
    if (subroutines_.empty()) return cut();
    const int number =
        subroutines_[static_cast<std::size_t>(whole(0, static_cast<int>(subroutines_.size()) - 1))];
    line("G0 {}", word('Z', 9));
    line("G0 {}", xy());
    line("G1 {} {}", word('Z', 0), feed());
    if (chance(2)) return line("o{} call [{}]", number, whole(1, 9));
    line("o{} repeat [{}]", number + 1, whole(1, 3));
    line("G1 {} {}", word('Z', 0), feed());
    line("o{} call [2]", number);
    line("o{} endrepeat", number + 1);
  }
  void relative() {
    line("G91");
    for (int n = whole(1, 3); n > 0; --n) line("G1 {} {}", word('X', real(-5, 5)), word('Y', real(-5, 5)));
    line("G90");
  }
  void machine() {
    if (chance(3))
      line("G91 G28 {}\nG90", word('Z', 0));
    else
      line("G53 G0 {}", word('Z', 0));
    line("G0 {}", xy());
    line("G0 {}", word('Z', 9));
  }
  void probe() {
    line("G0 {}", word('Z', 9));
    line("G38.{} {} {}", whole(2, 3), word('Z', -20), feed());
    if (chance(3)) line("G10 L20 P1 {}", word('Z', 0));
    line("G0 {}", word('Z', 9));
  }
  void zero() {
    line("G0 {}", word('Z', 9));
    if (chance(3))
      line("G92 {} {}", word('X', real(-5, 5)), word('Y', real(-5, 5)));
    else
      line("G{}", whole(54, 55));
    line("G0 {}", xy());
    line("G0 {}", word('Z', 9));
  }
  /// From a point of its own; half a circle, a quarter or a whole one, some of them as a helix.
  void arc() {
    const double x = real(-30, 30), y = real(-30, 30), r = real(1, 8), z = real(-6, -1);
    const std::string radius = word('R', r), g = chance(2) ? "G2" : "G3";
    line("G1 {} {} {}", word('X', x), word('Y', y), word('Z', z));
    const std::string w = chance(3) ? " " + word('Z', real(-6, -1)) : "";
    switch (whole(0, 5)) {
      case 0: return line("{} {} {}{}", g, word('I', r), word('J', 0), w);
      case 1: return line("{} {} {}{} P{}", g, word('I', r), word('J', 0), w, whole(2, 3));
      case 2:
        return line("{} {} {} {} {}{}", g, word('X', x + r), word('Y', y + r), word('I', r), word('J', 0), w);
      case 3: return line("G3 {} {} {}{}", word('X', x + r), word('Y', y + r), radius, w);
      case 4:
        return line("G18 {} {} {} {} {}\nG17", g, word('X', x + 2 * r), word('Z', z), word('I', r),
                    word('K', 0));
      default:
        line("G19 {} {} {} {} {}\nG17", g, word('Y', y + 2 * r), word('Z', z), word('J', r), word('K', 0));
    }
  }

  std::vector<int> subroutines_;
  std::string turn_ = "M3";
  bool rotary_ = false, related_ = false;
  bool surface_ = false, speed_stated_ = false;  // of the spindle
};

class LaserProgram : Lines {
 public:
  explicit LaserProgram(unsigned seed) : Lines(seed) {}

  std::string make() {
    unit_ = chance(4) ? 25.4 : 1.0;
    line("{} G17 G90 G94", unit_ == 1.0 ? "G21" : "G20");
    line("G0 {}", xy());
    line("G1 {}", feed());
    for (int n = whole(2, 10); n > 0; --n) part();
    line("M5");
    line("M{}", chance(2) ? 2 : 30);
    return std::move(text_);
  }

 private:
  void part() {
    switch (whole(0, 7)) {
      case 0: return line("M{} S{}", whole(3, 4), whole(0, 1000));
      case 1: return line("M5");
      case 2: return line("G0 {}", xy());
      case 3: return line("M{}", whole(8, 9));
      case 4: return line("G4 P{}", 0.25 * whole(1, 4));
      case 5: {
        const double r = real(1, 8);
        line("G1 {}", xy());
        return line("{} {} {}", chance(2) ? "G2" : "G3", word('I', r), word('J', 0));
      }
      default: return line("G1 {} S{}", xy(), whole(0, 1000));
    }
  }
};

class PrintProgram : Lines {
 public:
  PrintProgram(unsigned seed, GcodeDialect dialect) : Lines(seed), dialect_(dialect) {}

  std::string make() {
    if (chance(2)) line("; filament_diameter = {}", chance(2) ? 2.85 : 1.75);
    if (chance(5)) line("; use_volumetric_e = 1");
    absolute_ = chance(2);
    extruders_ = chance(3) ? whole(2, 3) : 1;
    line("G21\nG90\n{}", absolute_ ? "M82" : "M83");
    line("M104 S{}", whole(180, 240));
    if (chance(2)) line("M190 S{}", whole(50, 80));
    line("G28");
    line("M109 S{}", whole(180, 240));
    if (chance(3)) limits();
    line("G92 E0");
    for (int layer = 1, count = whole(1, 3); layer <= count; ++layer) {
      line(";LAYER_CHANGE\n;Z:{}\n;HEIGHT:0.2", number_text(0.2 * layer, 3));
      line("G1 Z{} F600", number_text(0.2 * layer, 3));
      line("G1 {} F6000", xy());
      line("G1 {} {} F1200", xy(), push(1.5));
      for (int n = whole(3, 10); n > 0; --n) part();
    }
    back(false);
    line("M104 S0");
    line("M107");
    line("{}", chance(2) ? "M84" : "M84 X Y E");
    return std::move(text_);
  }

 private:
  std::string push(double e) {
    e_ = absolute_ ? e_ + e : e;
    return "E" + number_text(e_, 5);
  }
  void limits() {
    if (dialect_ == GcodeDialect::klipper) return line("SET_VELOCITY_LIMIT ACCEL={}", whole(5, 50) * 100);
    line("M204 P{} T{}", whole(5, 20) * 100, whole(5, 20) * 100);
    if (chance(2)) line("M201 X{} E{}", whole(5, 20) * 100, whole(5, 20) * 100);
  }
  void part() {
    static const char* const kKinds[] = {"Perimeter", "External perimeter", "Solid infill",
                                         "Support material"};
    switch (whole(0, 15)) {
      case 0: return line(";TYPE:{}\n;WIDTH:{}", kKinds[whole(0, 3)], number_text(0.05 * whole(7, 14), 2));
      case 1: return retract();
      case 2: return by_firmware();
      case 3: return line("M106{} S{}", chance(3) ? " P1" : "", fan());
      case 4: return line("M104{} S{}", chance(2) && extruders_ > 1 ? " T1" : "", whole(180, 240));
      case 5: return select();
      case 6: return line("G92 E{}", set_zero());
      case 7: return line("{} S{}", chance(2) ? "M221" : "M220", whole(80, 120));
      case 8: return line("G4 P{}", whole(1, 8) * 250);
      case 9: return line("M117 part {}", whole(1, 9));
      case 10: return bead_arc();
      case 11: return volumetric();
      case 12: return line("G1 {} F{}", xy(), whole(60, 120) * 100);
      default: return line("G1 {} {} F{}", xy(), push(real(0.1, 4)), whole(10, 60) * 60);
    }
  }
  std::string fan() {
    return dialect_ == GcodeDialect::reprap ? number_text(0.125 * whole(0, 8), 3)
                                            : std::to_string(whole(0, 255));
  }
  double set_zero() { return e_ = absolute_ ? whole(0, 5) : e_; }
  void retract() {
    back(false);
    line("G1 {} F2400", push(-1.5));
    line("G1 {} F9000", xy());
    line("G1 {} F2400", push(1.5));
  }
  void back(bool now) {
    if (back_ != now) line("{}", now ? "G10" : "G11");
    back_ = now;
  }
  void by_firmware() {
    if (chance(3) && dialect_ == GcodeDialect::klipper)
      line("SET_RETRACTION RETRACT_LENGTH={} RETRACT_SPEED={}", 0.25 * whole(1, 8), whole(20, 50));
    else if (chance(3))
      line("M207 S{} F{}", 0.25 * whole(1, 8), whole(20, 50) * 60);
    back(true);
    line("G1 {} F9000", xy());
    back(false);
  }
  void select() {
    if (extruders_ == 1) return;
    const int number = whole(0, extruders_ - 1);
    line("T{}", number);
    if (dialect_ == GcodeDialect::klipper && number != extruder_) e_ = 0.0;
    extruder_ = number;
  }
  void bead_arc() {
    const double x = real(-30, 30), y = real(-30, 30), r = real(1, 8);
    line("G1 {} {} F6000", word('X', x), word('Y', y));
    line("G{} {} {} {} {} {} F1200", whole(2, 3), word('X', x + 2 * r), word('Y', y), word('I', r),
         word('J', 0), push(real(0.1, 2)));
  }
  /// M200: E is a volume from here on, or a length again.
  void volumetric() {
    if (dialect_ == GcodeDialect::klipper) return;
    line("M200 D{}", chance(2) ? 1.75 : 0.0);
  }

  GcodeDialect dialect_;
  bool absolute_ = false, back_ = false;
  int extruders_ = 1, extruder_ = 0;
  double e_ = 0.0;
};

}  // namespace

RandomProgram random_program(unsigned seed) {
  RandomProgram made;
  switch (seed % 6) {
    case 0: made = {ProgramKind::laser, GcodeDialect::laser, LaserProgram(seed).make()}; break;
    case 1: made = {ProgramKind::print, GcodeDialect::marlin, {}}; break;
    case 2:
      made = {ProgramKind::print, seed % 4 < 2 ? GcodeDialect::klipper : GcodeDialect::reprap, {}};
      break;
    default: made = {ProgramKind::mill, GcodeDialect::rs274, MillProgram(seed).make()};
  }
  if (made.kind == ProgramKind::print) made.text = PrintProgram(seed, made.dialect).make();
  return made;
}

}  // namespace kerf
