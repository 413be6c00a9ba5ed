// Printers of sliced programs: the settings that slicers write as comments, the program's own steps, and the
// lines before the first and after the last layer.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "base/names.h"
#include "base/number.h"
#include "path/printer_firmware.h"

#include "kerf/base/limits.h"
#include "kerf/formats/printer_files.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxSettings = 5000;
constexpr double kSameTemperature = 0.5;  // C
constexpr double kSecondsPerMinute = 60.0;
constexpr double kMaxBed = 1e5;  // mm

/// Calls visit(line, next) for every line, next the start of the one after it; stops where it returns false.
template <class Visit>
void for_each_line(std::string_view text, Visit&& visit) {
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", start), text.size());
    const std::size_t next = std::min(end + (text.substr(end, 2) == "\r\n" ? 2 : 1), text.size());
    if (!visit(trim(text.substr(start, end - start)), next)) return;
    start = next;
  }
}

/// "; key = value" of PrusaSlicer and its relatives.
std::map<std::string, std::string, std::less<>> settings_in(std::string_view text) {
  std::map<std::string, std::string, std::less<>> found;
  for_each_line(text, [&](std::string_view line, std::size_t) {
    const std::size_t sign = line.find('=');
    if (!line.starts_with(';') || sign == std::string_view::npos) return true;
    const std::string_view key = trim(line.substr(1, sign - 1));
    const bool plain = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
    });
    if (plain) found.emplace(key, trim(line.substr(sign + 1)));
    return found.size() < kMaxSettings;
  });
  return found;
}

class Importer {
 public:
  Importer(std::string_view text, const Toolpath& path)
      : text_(text), path_(path), settings_(settings_in(text)) {}

  PrinterChoice run() {
    names();
    sizes();
    speeds();
    temperatures();
    planner();
    lines();
    return std::move(made_);
  }

 private:
  /// The value of the first of the keys that there is.
  std::string_view value(std::initializer_list<std::string_view> keys) const {
    for (const std::string_view key : keys)
      if (const auto it = settings_.find(key); it != settings_.end() && !it->second.empty())
        return it->second;
    return {};
  }
  /// Its first number, of the first extruder. Percentages are none.
  double number(std::initializer_list<std::string_view> keys, double low, double high) const {
    const std::string_view all = value(keys);
    const std::string_view first = trim(all.substr(0, all.find_first_of(",;")));
    const auto v = parse_number(first);
    return v && *v >= low && *v <= high ? *v : 0.0;
  }

  void names() {
    PrinterProfile& printer = made_.printer;
    const auto plain = [](std::string_view text) {
      std::string name;
      for (const char c : text.substr(0, limits::kMaxNameBytes))
        if (static_cast<unsigned char>(c) >= 0x20 && c != '"' && c != ':') name += c;
      return std::string(trim(name));
    };
    printer.name = plain(value({"printer_settings_id", "printer_model"}));
    if (printer.name.empty()) printer.name = "imported printer";
    made_.filament.name = plain(value({"filament_settings_id", "filament_type"}));
    if (made_.filament.name.empty()) made_.filament.name = "imported filament";
    const std::string_view setting = value({"gcode_flavor"});
    const PrinterFirmware* firmware = firmware_of_gcode_flavor(setting);
    if (const std::size_t at = text_.find("FLAVOR:"); setting.empty() && at != std::string_view::npos) {
      const std::string_view rest = text_.substr(at + std::string_view("FLAVOR:").size());
      firmware = firmware_of_flavor(trim(rest.substr(0, rest.find_first_of("\r\n"))));
    } else if (setting.empty() && path_.has(StepKind::motion_limits)) {
      firmware = firmware_of_gcode_flavor("marlin");
    }
    printer.firmware = firmware != nullptr ? firmware->name : "plain";
  }

  /// "0x0,250x0,250x210,0x210"
  std::optional<Box3> bed() const {
    Box2 box;
    std::string_view shape = value({"bed_shape", "printable_area"});
    while (!shape.empty()) {
      const std::string_view corner = shape.substr(0, shape.find(','));
      const std::size_t cross = corner.find('x');
      const auto x = parse_number(trim(corner.substr(0, cross)));
      const auto y =
          cross == std::string_view::npos ? std::nullopt : parse_number(trim(corner.substr(cross + 1)));
      if (!x || !y || std::abs(*x) > kMaxBed || std::abs(*y) > kMaxBed) return std::nullopt;
      box.add(Point2{*x, *y});
      shape.remove_prefix(std::min(corner.size() + 1, shape.size()));
    }
    if (box.empty() || !(box.high.x > box.low.x) || !(box.high.y > box.low.y)) return std::nullopt;
    const double height = number({"max_print_height", "printable_height"}, 0.1, kMaxBed);
    return Box3{{box.low.x, box.low.y, -INFINITY},
                {box.high.x, box.high.y, height > 0.0 ? height : INFINITY}};
  }

  void sizes() {
    PrinterProfile& p = made_.printer;
    p.bed = bed();
    p.nozzle = mm(number({"nozzle_diameter"}, 0.01, 1000));
    p.filament = made_.filament.diameter = mm(number({"filament_diameter"}, 0.1, 10));
    p.layer = mm(number({"layer_height"}, 0.001, limits::kMaxBeadWidth));
    p.first_layer =
        mm(number({"first_layer_height", "initial_layer_print_height"}, 0.001, limits::kMaxBeadWidth));
    p.width = mm(number({"extrusion_width", "line_width"}, 0.01, limits::kMaxBeadWidth));
    p.retract = mm(number({"retract_length", "retraction_length"}, 0.0, 1000));
    p.hop = mm(number({"retract_lift", "z_hop"}, 0.0, 1000));
    made_.filament.density = number({"filament_density"}, 0.01, 100);
    made_.filament.max_flow = mm3_per_s(number({"filament_max_volumetric_speed"}, 0.0, 1e4));
    // What settings do not say is that of most of the length of the beads.
    std::map<std::pair<double, double>, double> lengths;
    for_each_motion(path_, [&](const Step& s, const MotionContext& context) {
      if (s.kind() != StepKind::extrude || (context.unknown_from | s.unknown_axes()) != 0) return;
      const step::Extrude bead = path_.extrude(context.index);
      const auto usual = [](Length l) { return l.mm() >= 0.01 && l.mm() <= limits::kMaxBeadWidth; };
      if (bead.volume > Volume() && usual(bead.width) && usual(bead.height))
        lengths[{bead.width.mm(), bead.height.mm()}] += distance(context.from, s.to());
    });
    const auto longest = std::max_element(lengths.begin(), lengths.end(),
                                          [](const auto& a, const auto& b) { return a.second < b.second; });
    if (longest == lengths.end()) return;
    if (!(p.width > Length{})) p.width = mm(longest->first.first);
    if (!(p.layer > Length{})) p.layer = mm(longest->first.second);
  }

  Feed per_minute(double mm_per_s) const { return mm_per_min(kSecondsPerMinute * mm_per_s); }
  void speeds() {
    PrinterProfile& p = made_.printer;
    const double highest = limits::kMaxSpeed / kSecondsPerMinute;
    p.speed = per_minute(number({"perimeter_speed", "outer_wall_speed"}, 0.0, highest));
    p.first_layer_speed = per_minute(number({"first_layer_speed", "initial_layer_speed"}, 0.0, highest));
    p.travel_speed = per_minute(number({"travel_speed"}, 0.0, highest));
    p.retract_speed = per_minute(number({"retract_speed", "retraction_speed"}, 0.0, highest));
  }

  void temperatures() {
    FilamentProfile& f = made_.filament;
    f.nozzle = number({"temperature", "nozzle_temperature"}, 0.0, 2000);
    f.first_nozzle = number({"first_layer_temperature", "nozzle_temperature_initial_layer"}, 0.0, 2000);
    f.bed = number({"bed_temperature", "hot_plate_temp"}, 0.0, 2000);
    f.first_bed = number({"first_layer_bed_temperature", "hot_plate_temp_initial_layer"}, 0.0, 2000);
    // Else the highest that the program sets.
    double nozzle = 0.0, plate = 0.0;
    for (const Step& s : path_.steps()) {
      if (s.kind() != StepKind::temperature) continue;
      const step::Temperature t = s.temperature();
      if (t.heater == Heater::nozzle) nozzle = std::max(nozzle, t.celsius);
      if (t.heater == Heater::bed) plate = std::max(plate, t.celsius);
    }
    if (!(f.nozzle > 0.0)) f.nozzle = std::min(nozzle, 2000.0);
    if (!(f.bed > 0.0)) f.bed = std::min(plate, 2000.0);
  }

  /// The limits of motions that the program sets first.
  void planner() {
    PrinterProfile& p = made_.printer;
    p.planner = default_planner(path_);
    unsigned seen = 0;
    for (const Step& s : path_.steps()) {
      if (s.kind() != StepKind::motion_limits) continue;
      const step::MotionLimits found = s.motion_limits();
      const unsigned bit = 1u << static_cast<unsigned>(found.kind);
      if ((seen & bit) != 0) continue;
      seen |= bit;
      take(found);
    }
    p.has_planner = seen != 0;
  }
  /// Whether a file may have the limit.
  static bool is_usual(double v) { return v >= 1e-3 && v <= 1e5; }
  void take(const step::MotionLimits& limits) {
    PrintPlanner& planner = made_.printer.planner;
    const auto copy = [&](auto& target) {
      for (std::size_t i = 0; i < target.size(); ++i)
        if ((limits.given >> i & 1u) != 0 && is_usual(limits.values[i])) target[i] = limits.values[i];
    };
    switch (limits.kind) {
      case LimitKind::axis_speed: return copy(planner.axis_speed);
      case LimitKind::axis_acceleration: return copy(planner.axis_acceleration);
      case LimitKind::acceleration: return copy(planner.acceleration);
      case LimitKind::jerk: return copy(planner.jerk);
      case LimitKind::junction_deviation:
        if (is_usual(limits.values[0])) planner.junction_deviation = std::min(limits.values[0], 1000.0);
        return;
      case LimitKind::corner_speed:
        if (is_usual(limits.values[0])) planner.corner_speed = limits.values[0];
        return;
    }
  }

  /// The line of the last motion that lays filament, or that wipes the nozzle behind it, by the program's
  /// steps: arcs and lines without G1 are beads too. 0 without one.
  std::uint32_t last_line() const {
    std::uint32_t line = 0;
    bool wipes = false;
    PathPosition position;
    for (std::size_t i = 0; i < path_.size(); ++i) {
      const Step& s = path_[i];
      const Point3 from = position.at;
      position.pass(s);
      if (s.is_motion() && s.to() == from) continue;  // a retraction, or a feed
      if (s.kind() == StepKind::extrude) {
        const bool is_wipe = wipes && s.to().z == from.z && path_.extrude(i).volume < Volume();
        wipes = is_wipe || path_.extrude(i).volume > Volume();
        if (wipes) line = path_.origins().line(s.origin());
      } else if (s.kind() != StepKind::motion_limits && s.kind() != StepKind::note) {
        wipes = false;
      }
    }
    return line;
  }

  /// Where the first layer starts and the last one ends.
  struct Body {
    std::size_t start = std::string_view::npos, end = 0;
  };
  Body body() const {
    Body found;
    const std::uint32_t last = last_line();
    std::uint32_t number = 0;
    for_each_line(text_, [&](std::string_view line, std::size_t next) {
      ++number;
      const bool layer = line.starts_with(";LAYER_CHANGE") || line.starts_with(";LAYER:") ||
                         line.starts_with("; CHANGE_LAYER");
      if (layer && found.start == std::string_view::npos) found.start = next;
      if (number == last && found.start != std::string_view::npos) found.end = next;
      return number != last;
    });
    return found;
  }

  /// A line with the temperatures of the filament as variables.
  std::string with_variables(std::string_view line) const {
    const FilamentProfile& f = made_.filament;
    const bool nozzle = line.starts_with("M104") || line.starts_with("M109");
    if (!nozzle && !line.starts_with("M140") && !line.starts_with("M190")) return std::string(line);
    const std::size_t at = line.find(" S");
    if (at == std::string_view::npos) return std::string(line);
    const std::size_t end = std::min(line.find_first_of(" ;", at + 2), line.size());
    const auto value = parse_number(line.substr(at + 2, end - at - 2));
    const double first = nozzle ? f.first_nozzle : f.first_bed, usual = nozzle ? f.nozzle : f.bed;
    const double wanted = first > 0.0 ? first : usual;
    if (!value || !(*value > 0.0) || std::abs(*value - wanted) > kSameTemperature) return std::string(line);
    return fmt::format("{} S{{{}}}{}", line.substr(0, at), nozzle ? "nozzle" : "bed", line.substr(end));
  }

  /// Whether E is relative at the end of a part of the program.
  static bool is_relative(std::string_view part) {
    bool relative = false;
    for_each_line(part, [&](std::string_view line, std::size_t) {
      if (line.starts_with("M83")) relative = true;
      if (line.starts_with("M82")) relative = false;
      return true;
    });
    return relative;
  }
  /// At the end of another program a relative E means the same; an absolute one would draw all filament back.
  static void keep_extrusion(std::vector<std::string>& lines, bool relative) {
    const auto extrudes = [](const std::string& line) {
      return (line.starts_with("G0") || line.starts_with("G1")) && line.find('E') != std::string::npos;
    };
    if (!relative) return void(std::erase_if(lines, extrudes));
    const auto first = std::find_if(lines.begin(), lines.end(), extrudes);
    if (first != lines.end()) lines.insert(first, "M83");
  }

  void lines() {
    const Body found = body();
    if (found.start == std::string_view::npos) return;
    const auto copy = [&](std::string_view text, std::vector<std::string>& target) {
      for_each_line(text, [&](std::string_view line, std::size_t) {
        const bool comment = line.empty() || line.front() == ';';
        // Braces would be names of variables.
        if (!comment && line.find_first_of("{}") == std::string_view::npos) {
          const std::string_view code = trim(line.substr(0, line.find(';')));
          target.push_back(with_variables(code));
        }
        return target.size() < limits::kMaxTemplateLines;
      });
    };
    copy(text_.substr(0, found.start), made_.printer.start);
    if (found.end == 0 || found.end >= text_.size()) return;
    copy(text_.substr(found.end), made_.printer.end);
    keep_extrusion(made_.printer.end, is_relative(text_.substr(0, found.end)));
  }

  std::string_view text_;
  const Toolpath& path_;
  std::map<std::string, std::string, std::less<>> settings_;
  PrinterChoice made_;
};

}  // namespace

PrinterChoice import_printer(std::string_view text, const Toolpath& path) {
  return Importer(text, path).run();
}

}  // namespace kerf
