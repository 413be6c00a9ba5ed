// Printing: temperatures, fans, settings of the firmware, and extruding motions.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <numbers>

#include "base/number.h"
#include "design/commands/rows.h"
#include "path/bead.h"

#include "kerf/base/limits.h"

namespace kerf::design {
namespace {

constexpr double kMaxCelsius = 1000.0, kFullFan = 255.0;
constexpr double kMaxAcceleration = 1e9;      // mm/s2
constexpr double kPrimed = 2.0, kLift = 5.0;  // mm of filament drawn back, Z

double filament_area(const Machine& machine) {
  return std::numbers::pi * std::pow(machine.print.filament / 2, 2);
}

void add_heat(Machine& machine, Heater heater, double celsius, bool wait) {
  if (!(celsius >= 0.0 && celsius <= kMaxCelsius))
    refuse(fmt::format("temperature must be from 0 to {:g} degrees, not {:g}", kMaxCelsius, celsius));
  machine.add_step(step::Temperature{heater, celsius, wait});
}

// ---- the form of gcodepreview 0.9313: one call starts a print, another ends it

constexpr double kUsualPrintSpeed = 1000.0;               // mm/min, that of its beads
constexpr double kUsualNozzle = 260.0, kUsualBed = 60.0;  // degrees C

/// extrusiontype, extruder_temperature, bed_temperature, printer_name, Base_filename from index `first` on.
void start_print(Machine& machine, Call& call, std::size_t first) {
  if (const auto kind = call.optional_text(first)) choice(*kind, {"relative", "absolute"}, "extrusiontype");
  const double nozzle = call.optional_number(first + 1).value_or(kUsualNozzle);
  const double bed = call.optional_number(first + 2).value_or(kUsualBed);
  const std::string printer = call.optional_text(first + 3).value_or("generic");
  const std::string name = call.optional_text(first + 4).value_or("export");
  if (machine.settings.gcode && !machine.gcode_name) open_gcode_file(machine, name);
  machine.note("printer " + printer);
  machine.print.feed = kUsualPrintSpeed;
  add_heat(machine, Heater::bed, bed, false);
  add_heat(machine, Heater::nozzle, nozzle, false);
  add_heat(machine, Heater::bed, bed, true);
  add_heat(machine, Heater::nozzle, nozzle, true);
}

void lay(Machine& machine, Point3 to, double width, double height, double feed) {
  const double length = distance(machine.position(), to);
  machine.extrude(to, bead_volume(mm(length), mm(width), mm(height)).mm3(), width, height, feed);
}

/// Beads at the front of the bed, by which the nozzle fills.
void prime(Machine& machine) {
  const PrintSettings& print = machine.print;
  constexpr double kLeft = 10.0, kRight = 110.0, kFront = 12.0, kApart = 2.0;
  machine.rapid({kLeft, kLeft, print.height + 0.1});
  machine.rapid({kLeft, kFront, print.height});
  for (const Point2 p : {Point2{kRight, kFront}, Point2{kRight, kFront + kApart},
                         Point2{kLeft, kFront + kApart}, Point2{kLeft, kFront + 2 * kApart}})
    lay(machine, {p.x, p.y, print.height}, print.width, print.height, print.feed);
}

/// Gives the beads with one feed another one, mm/min.
void set_bead_feed(Machine& machine, double from, double to) {
  if (from == to) return;
  const Toolpath& path = machine.path();
  Toolpath changed;
  changed.origins() = path.origins();
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i].kind() != StepKind::extrude || path.extrude(i).feed.mm_per_min() != from) {
      changed.add_copy(path, i);
      continue;
    }
    step::Extrude bead = path.extrude(i);
    bead.feed = mm_per_min(to);
    changed.add(bead, path[i].origin());
  }
  *machine.shared_path() = std::move(changed);
}

void shutdownafterprinting(Machine& machine, Call& call) {
  set_bead_feed(machine, kUsualPrintSpeed, positive(call.number(0), "print_speed"));
  if (machine.gcode_name)
    close_gcode_file(machine);
  else
    machine.end_program();
}

void initializeforprinting(Machine& machine, Call& call) {
  PrintSettings& print = machine.print;
  constexpr std::size_t kFurther = 4;  // the first argument of the form of 0.9313
  bool starts = false;
  for (std::size_t i = kFurther; i < call.size(); ++i) starts = starts || !call[i].is(Type::undefined);
  print.nozzle = positive(call.number(0), "nozzlediameter");
  print.filament = positive(call.number(1), "filamentdiameter");
  print.width = positive(call.number(2), "extrusionwidth");
  print.height = positive(call.number(3), "layerheight");
  if (starts) start_print(machine, call, kFurther);
  if (mm(print.filament) != kUsualFilament) machine.note(filament_note(mm(print.filament)));
  constexpr unsigned kAllAxes = 7;
  machine.home(kAllAxes);
  if (starts) prime(machine);
}

enum class Wait : bool { no, yes };
template <Heater heater, Wait wait>
void heat(Machine& machine, Call& call) {
  add_heat(machine, heater, call.number(0), wait == Wait::yes);
}

void setfansoff(Machine& machine, Call&) { machine.add_step(step::Fan{0, 0.0}); }

/// A number, or a text of one, as the original required.
double value(Call& call, std::size_t i) {
  const std::string_view name = call.name(i);
  if (!call[i].is(Type::text)) return not_negative(call.number(i), name);
  const auto read = parse_number(call[i].text());
  if (!read) refuse(fmt::format("{} must be a number", name));
  return not_negative(*read, name);
}

void setfanspeed(Machine& machine, Call& call) {
  const double speed = value(call, 1);
  if (speed > kFullFan) refuse(fmt::format("speed is at most {:g}, not {:g}", kFullFan, speed));
  machine.add_step(step::Fan{whole(value(call, 0), "fan", 0, limits::kMaxFans - 1), speed / kFullFan});
}

/// A setting of the firmware in percent.
void add_percent(Machine& machine, Call& call, std::string_view code, double low, double high) {
  const double percent = value(call, 0);
  if (!(percent >= low && percent <= high))
    refuse(fmt::format("{} must be from {:g} to {:g} percent, not {:g}", call.name(0), low, high, percent));
  machine.add_step(step::Verbatim{fmt::format("{}{:g}", code, percent)});
}
constexpr double kLowRatio = 1.0, kHighRatio = 999.0;  // what Marlin takes
void setfeedratio(Machine& machine, Call& call) {
  add_percent(machine, call, "M220 S", kLowRatio, kHighRatio);
}
void setspeedratio(Machine& machine, Call& call) {
  add_percent(machine, call, "M221 S", kLowRatio, kHighRatio);
}
void setbuildpercentage(Machine& machine, Call& call) { add_percent(machine, call, "M73 P", 0.0, 100.0); }

// ---- devices that few printers have

enum class Device : std::uint8_t { nozzle_cleaner, filament_cutter, load_cell, accelerometer };
struct DeviceCommand {
  Device device;
  std::string_view post, line;
};
/// The firmwares' own commands; for the others a printer has a macro.
constexpr DeviceCommand kDeviceCommands[] = {
    {Device::load_cell, "klipper", "LOAD_CELL_TARE"},
    {Device::accelerometer, "klipper", "ACCELEROMETER_QUERY"},
    {Device::accelerometer, "reprapfirmware", "M956 P0 S1000 A0 D0"},
};

template <Device device>
void use_device(Machine& machine, Call& call) {
  std::string line = call.optional_text(0).value_or("");
  for (const DeviceCommand& known : kDeviceCommands)
    if (line.empty() && known.device == device && known.post == machine.settings.post) line = known.line;
  if (line.empty())
    refuse(
        fmt::format("{} has no command of its own for it; the printer's macro is required, such as "
                    "{}(\"NAME_OF_MACRO\")",
                    machine.settings.post, call.command().name));
  machine.add_verbatim(line);
}
/// Of beads and travel; each firmware has a command of its own for it.
void setacceleration(Machine& machine, Call& call) {
  const double acceleration = value(call, 0);
  if (!(acceleration > 0.0 && acceleration <= kMaxAcceleration))
    refuse(fmt::format("acceleration must be above 0 and at most {:g}, not {:g}", kMaxAcceleration,
                       acceleration));
  constexpr unsigned kBeadsAndTravel = 5;  // bits of the values
  machine.add_step(
      step::MotionLimits{LimitKind::acceleration, {acceleration, 0.0, acceleration, 0.0}, kBeadsAndTravel});
}

void pauseforclearbuffer(Machine& machine, Call&) { machine.add_step(step::Verbatim{"M400"}); }

void setfilamentsensor(Machine& machine, Call& call) {
  machine.add_step(step::Verbatim{call.truth(0) ? "M412 S1" : "M412 S0"});
}

void displaymessage(Machine& machine, Call& call) {
  const std::string message = call.site().as_text(call[0]);
  const auto is_wrong = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < ' ' || byte == 127 || c == ';' || c == '(' || c == ')';
  };
  if (std::any_of(message.begin(), message.end(), is_wrong))
    refuse("message must be one line without ; and parentheses");
  machine.add_step(step::Verbatim{"M117 " + message});
}
void clearmessage(Machine& machine, Call&) { machine.add_step(step::Verbatim{"M117"}); }

void retract(Machine& machine, Call& call) {
  machine.draw_back(positive(call.number(0), "length") * filament_area(machine),
                    positive(call.number(1), "feedrate"));
}
void unretract(Machine& machine, Call& call) {
  machine.draw_back(-positive(call.number(0), "length") * filament_area(machine),
                    positive(call.number(1), "feedrate"));
}

/// The post writes the extruder's mode.
void setextrusionabsolute(Machine&, Call&) {}

void liftandprimenozzle(Machine& machine, Call& call) {
  const Point3 at = machine.position();
  machine.print.feed = positive(call.number(0), "liftfeed");
  machine.cut({at.x, at.y, kLift}, machine.print.feed);
  const double volume = kPrimed * filament_area(machine), speed = positive(call.number(1), "extrusionfeed");
  machine.draw_back(volume, speed);
  machine.prime = {volume, speed};
}

/// 0: what was set before.
double or_else(double given, double before) { return given != 0.0 ? given : before; }

void extrude(Machine& machine, Call& call) {
  const Point3 end = call.point3(0);
  const PrintSettings& print = machine.print;
  // A truth value is the `extrudeonly` of gcodepreview 0.9313, which concerns its preview.
  const double given = call[3].is(Type::truth) ? 0.0 : call.number(3);
  const double width = positive(or_else(given, print.width), "extrusionwidth");
  const double height = positive(or_else(call.number(4), print.height), "layerheight");
  if (width < height)
    refuse(fmt::format("extrusionwidth must be at least the layer height {:g}, not {:g}", height, width));
  if (width > limits::kMaxBeadWidth)
    refuse(fmt::format("extrusionwidth is at most {:g} mm, not {:g}", limits::kMaxBeadWidth, width));
  const double feed = or_else(or_else(call.number(5), print.feed), machine.feed);
  if (machine.prime.volume > 0.0) machine.draw_back(-machine.prime.volume, machine.prime.feed);
  lay(machine, end, width, height, feed);
}

void add_device_commands(Rows& rows) {
  constexpr const char* kCommand = "command=undef";
  rows.push_back(row<use_device<Device::nozzle_cleaner>>(
      "cleannozzle", kCommand, "Clean the nozzle, by the macro `command` of the printer."));
  rows.push_back(row<use_device<Device::filament_cutter>>(
      "cutfilament", kCommand, "Cut the filament, by the macro `command` of the printer."));
  rows.push_back(row<use_device<Device::load_cell>>(
      "tareloadcell", kCommand, "Set the force that the load cell measures now as zero."));
  rows.push_back(
      row<use_device<Device::accelerometer>>("readaccelerometer", kCommand, "Read the accelerometer."));
}

}  // namespace

void add_printing_commands(Rows& rows) {
  add_device_commands(rows);
  rows.push_back(row<initializeforprinting>(
      "initializeforprinting",
      "nozzlediameter=0.4, filamentdiameter=1.75, extrusionwidth=0.6, layerheight=0.2, extrusiontype=undef, "
      "extruder_temperature=undef, bed_temperature=undef, printer_name=undef, Base_filename=undef",
      "Set nozzle, filament and the usual bead, mm, and run all axes to their end switches.\n"
      "\n"
      "With one of the further arguments, those of gcodepreview 0.9313, it also opens the G-code file, heats "
      "bed and\n"
      "nozzle, degrees C, waits for them, and lays beads at the front of the bed. `extrusiontype` is "
      "'relative' or\n"
      "'absolute'; the post writes the mode of the printer."));
  rows.push_back(row<shutdownafterprinting>(
      "shutdownafterprinting", "print_speed=1000",
      "End the print that initializeforprinting has started, and write its file; its beads have the feed\n"
      "`print_speed`, mm/min."));
  constexpr const char* kTemperature = "temperature";
  rows.push_back(row<heat<Heater::nozzle, Wait::no>>("setextrudertemperature", kTemperature,
                                                     "Heat the nozzle, degrees C."));
  rows.push_back(row<heat<Heater::nozzle, Wait::yes>>(
      "setandwaitforextrudertemperature", kTemperature,
      "Heat the nozzle and wait until it has its temperature, degrees C."));
  rows.push_back(
      row<heat<Heater::bed, Wait::no>>("setbedtemperature", kTemperature, "Heat the bed, degrees C."));
  rows.push_back(
      row<heat<Heater::bed, Wait::yes>>("setandwaitforbedtemperature", kTemperature,
                                        "Heat the bed and wait until it has its temperature, degrees C."));
  rows.push_back(row<heat<Heater::chamber, Wait::no>>("setchambertemperature", kTemperature,
                                                      "Heat the chamber, degrees C."));
  rows.push_back(row<heat<Heater::chamber, Wait::yes>>(
      "setandwaitforchambertemperature", kTemperature,
      "Heat the chamber and wait until it has its temperature, degrees C."));
  rows.push_back(row<setfilamentsensor>("setfilamentsensor", "enabled=true",
                                        "Whether the printer stops when the filament ends."));
  rows.push_back(
      row<displaymessage>("displaymessage", "message", "Show a line of text on the printer's display."));
  rows.push_back(row<clearmessage>("clearmessage", "", "Clear the printer's display."));
  constexpr const char* kFilament = "length=1, feedrate=2400";
  rows.push_back(row<retract>("retract", kFilament, "Draw back a length of filament, mm."));
  rows.push_back(row<unretract>("unretract", kFilament, "Push a length of filament forward again, mm."));
  rows.push_back(row<setfansoff>("setfansoff", "", "Switch the fan off."));
  rows.push_back(row<setfanspeed>("setfanspeed", "fan, speed", "Set the speed of a fan, 0 to 255."));
  rows.push_back(
      row<pauseforclearbuffer>("pauseforclearbuffer", "", "Wait until the printer has run all motions."));
  rows.push_back(row<setfeedratio>("setfeedratio", "feedratio", "Percent of the feeds."));
  rows.push_back(row<setspeedratio>("setspeedratio", "speedratio", "Percent of the extrusion."));
  rows.push_back(row<setacceleration>("setacceleration", "acceleration",
                                      "Set the acceleration of beads and travel, mm/s2."));
  rows.push_back(row<setbuildpercentage>("setbuildpercentage", "percent",
                                         "Show the progress on the printer's display, percent."));
  rows.push_back(row<setextrusionabsolute>("setextrusionabsolute", "acceleration=true",
                                           "Not needed: the post writes the extruder's mode."));
  rows.push_back(motion<liftandprimenozzle>("liftandprimenozzle", "liftfeed=5000, extrusionfeed=2400",
                                            "Lift the nozzle to Z5 and retract 2 mm of filament."));
  rows.push_back(motion<extrude>(
      "extrude", "ex, ey, ez, extrusionwidth=0, layerheight=0, feedrate=0",
      "Lay a bead to a point; its volume is that of a stadium of the given width and height."));
}

}  // namespace kerf::design
