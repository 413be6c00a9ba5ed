// gcodepreview(...) itself, the position, choices for files, and messages of a program.
#include <fmt/format.h>

#include "front/scad/commands/bindings.h"

namespace kerf::scad {
namespace {

constexpr double kVersion = 0.93;  // of the library whose commands these are

class MachineObject final : public Object {
 public:
  std::string text() const override { return "gcodepreview()"; }
};

Mode mode_of(const Value& value) {
  if (value.is(Type::string) && value.text() == "cut") return Mode::cut;
  if (value.is(Type::string) && value.text() == "print") return Mode::print;
  return Mode::no_preview;
}

Value gcodepreview(MachineState& machine, Call& call) {
  const bool gcode = truth(call, 1), dxf = truth(call, 2);
  positive(number(call, 3), "gcpfa");
  const double resolution = positive(number(call, 4), "gcpfs");
  positive(number(call, 5), "steps");
  machine.start(mode_of(call[0]), gcode, dxf, resolution);
  return Value::of(Type::object, new MachineObject);
}

Value version(MachineState&, Call&) { return kVersion; }
void echo_version(MachineState&, Call& call) { call.site().print("ECHO: " + to_string(kVersion)); }

Value xpos(MachineState& machine, Call&) { return machine.position().x; }
Value ypos(MachineState& machine, Call&) { return machine.position().y; }
Value zpos(MachineState& machine, Call&) { return machine.position().z; }
void setxpos(MachineState& machine, Call& call) { machine.set_axis(0, number(call, 0)); }
void setypos(MachineState& machine, Call& call) { machine.set_axis(1, number(call, 0)); }
void setzpos(MachineState& machine, Call& call) { machine.set_axis(2, number(call, 0)); }

void setcolor(MachineState&, Call& call) {
  for (std::size_t i = 0; i < 3; ++i) drawing_colour(text(call, i));
}

void setfeeds(MachineState& machine, Call& call) {
  if (const auto plunge = optional_number(call, 0)) machine.plunge = positive(*plunge, "plunge");
  if (const auto feed = optional_number(call, 1)) machine.feed = positive(*feed, "feed");
  for (std::size_t i = 2; i < call.size(); ++i)
    if (const auto ratio = optional_number(call, i)) {
      const std::string& name = feed_classes()[i - 2];
      machine.ratios[name] = positive(*ratio, name);
    }
}

void setpost(MachineState& machine, Call& call) { machine.settings.post = text(call, 0); }

void setdxfoptions(MachineState& machine, Call& call) {
  FileSettings& settings = machine.settings;
  settings.version =
      choice(text(call, 0), {"r2000", "r12"}, "version") == 0 ? DxfVersion::r2000 : DxfVersion::r12;
  settings.layers =
      static_cast<FileSettings::Layers>(choice(text(call, 1), {"colour", "tool", "depth"}, "layers"));
  settings.chains = truth(call, 2) ? Sketch::Chains::joined : Sketch::Chains::loose;
  settings.stagger = truth(call, 3);
}

void writecomment(MachineState& machine, Call& call) { machine.note(as_text(call[0])); }

/// A line of G-code: a comment, or a line that neither moves the machine nor changes modes.
void writegc(MachineState& machine, Call& call) {
  std::string line;
  for (std::size_t i = 0; i < call.size(); ++i) line += as_text(call[i]);
  machine.write_line(line);
}

void debug(MachineState& machine, Call& call) {
  if (!machine.debug) return;
  std::string line = "DEBUG:";
  for (std::size_t i = 0; i < call.size(); ++i) line += " " + as_text(call[i]);
  call.site().print(line);
}
void setdebug(MachineState& machine, Call& call) { machine.debug = truth(call, 0); }

}  // namespace

void add_object_commands(Rows& rows) {
  rows.push_back(asking<gcodepreview, Needs::nothing>(
      "gcodepreview",
      "cutorprint=\"cut\", generategcode=false, generatedxf=false, gcpfa=2, gcpfs=0.125, steps=10"));
  rows.push_back(asking<version, Needs::nothing>("pygcpversion", ""));
  rows.push_back(row<echo_version>("gcpversion", ""));
  rows.push_back(asking<xpos>("xpos", ""));
  rows.push_back(asking<ypos>("ypos", ""));
  rows.push_back(asking<zpos>("zpos", ""));
  rows.push_back(row<setxpos>("setxpos", "newxpos"));
  rows.push_back(row<setypos>("setypos", "newypos"));
  rows.push_back(row<setzpos>("setzpos", "newzpos"));
  rows.push_back(row<setcolor>("setcolor", "cutcolor=\"green\", rapidcolor=\"orange\", shaftcolor=\"red\""));
  rows.push_back(row<setfeeds>(
      "setfeeds",
      "plunge=undef, feed=undef, large_square=undef, small_square=undef, large_ball=undef, small_ball=undef, "
      "large_V=undef, small_V=undef, DT=undef, KH=undef, RO=undef, MISC=undef"));
  rows.push_back(row<setpost>("setpost", "name"));
  rows.push_back(row<setdxfoptions>("setdxfoptions",
                                    "version=\"r2000\", layers=\"colour\", joined=true, stagger=false"));
  rows.push_back(row<writecomment>("writecomment", "text"));
  Command line = row<writegc>("writegc", "");
  line.further = FurtherArguments::taken;
  rows.push_back(std::move(line));
  Command message = row<debug>("debug", "");
  message.further = FurtherArguments::taken;
  rows.push_back(std::move(message));
  rows.push_back(row<setdebug>("setdebug", "enable=true"));
}

}  // namespace kerf::scad
