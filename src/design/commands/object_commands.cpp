// gcodepreview(...) itself, the position, choices for files, and messages of a program.
#include <fmt/format.h>

#include "base/names.h"
#include "design/commands/rows.h"

namespace kerf::design {
namespace {

constexpr double kVersion = 0.93;  // of the library whose commands these are

Mode mode_of(const Value& value) {
  if (!value.is(Type::text)) return Mode::no_preview;
  const std::string name = fold_name(value.text());
  return name == "cut" ? Mode::cut : name == "print" ? Mode::print : Mode::no_preview;
}

void gcodepreview(Machine& machine, Call& call) {
  const bool gcode = call.truth(1), dxf = call.truth(2);
  positive(call.number(3), "gcpfa");
  const double resolution = positive(call.number(4), "gcpfs");
  positive(call.number(5), "steps");
  machine.start(mode_of(call[0]), gcode, dxf, resolution);
}

Value version(Machine&, Call&) { return kVersion; }
void echo_version(Machine&, Call& call) { call.site().print("ECHO: " + text_of(kVersion)); }

Value xpos(Machine& machine, Call&) { return machine.position().x; }
Value ypos(Machine& machine, Call&) { return machine.position().y; }
Value zpos(Machine& machine, Call&) { return machine.position().z; }
void setxpos(Machine& machine, Call& call) { machine.set_axis(0, call.number(0)); }
void setypos(Machine& machine, Call& call) { machine.set_axis(1, call.number(0)); }
void setzpos(Machine& machine, Call& call) { machine.set_axis(2, call.number(0)); }

void setcolor(Machine&, Call& call) {
  for (std::size_t i = 0; i < 3; ++i) css_colour(call.text(i), call.name(i));
}

void setfeeds(Machine& machine, Call& call) {
  if (const auto plunge = call.optional_number(0)) machine.plunge = positive(*plunge, "plunge");
  if (const auto feed = call.optional_number(1)) machine.feed = positive(*feed, "feed");
  for (std::size_t i = 2; i < call.size(); ++i)
    if (const auto ratio = call.optional_number(i)) {
      const std::string& name = feed_classes()[i - 2];
      machine.ratios[name] = positive(*ratio, name);
    }
}

void setpost(Machine& machine, Call& call) { machine.settings.post = call.text(0); }

void setdxfoptions(Machine& machine, Call& call) {
  FileSettings& settings = machine.settings;
  settings.version =
      choice(call.text(0), {"r2000", "r12"}, "version") == 0 ? DxfVersion::r2000 : DxfVersion::r12;
  settings.layers =
      static_cast<FileSettings::Layers>(choice(call.text(1), {"colour", "tool", "depth"}, "layers"));
  settings.chains = call.truth(2) ? Sketch::Chains::joined : Sketch::Chains::loose;
  settings.stagger = call.truth(3);
}

void writecomment(Machine& machine, Call& call) { machine.note(call.site().as_text(call[0])); }

/// A line of G-code: a comment, or a line that neither moves the machine nor changes modes.
void writegc(Machine& machine, Call& call) {
  std::string line;
  for (std::size_t i = 0; i < call.size(); ++i) line += call.site().as_text(call[i]);
  machine.write_line(line);
}

void debug(Machine& machine, Call& call) {
  if (!machine.debug) return;
  std::string line = "DEBUG:";
  for (std::size_t i = 0; i < call.size(); ++i) line += " " + call.site().as_text(call[i]);
  call.site().print(line);
}
void setdebug(Machine& machine, Call& call) { machine.debug = call.truth(0); }

}  // namespace

void add_object_commands(Rows& rows) {
  rows.push_back(without_start(row<gcodepreview>(
      "gcodepreview",
      "cutorprint=\"cut\", generategcode=false, generatedxf=false, gcpfa=2, gcpfs=0.125, steps=10",
      "The machine, its stock and its files.")));
  rows.push_back(making<version>("pygcpversion", "", "The version of the library whose commands these are."));
  rows.push_back(
      row<echo_version>("gcpversion", "", "Print the version of the library whose commands these are."));
  rows.push_back(asking<xpos>("xpos", "", "The current position in X, mm."));
  rows.push_back(asking<ypos>("ypos", "", "The current position in Y, mm."));
  rows.push_back(asking<zpos>("zpos", "", "The current position in Z, mm."));
  rows.push_back(
      row<setxpos>("setxpos", "newxpos",
                   "Set the position in X without a motion; the next motion is preceded by a rapid to it, "
                   "with a\n"
                   "warning."));
  rows.push_back(row<setypos>("setypos", "newypos", "Set the position in Y without a motion, as setxpos."));
  rows.push_back(row<setzpos>("setzpos", "newzpos", "Set the position in Z without a motion, as setxpos."));
  rows.push_back(row<setcolor>("setcolor", "cutcolor=\"green\", rapidcolor=\"orange\", shaftcolor=\"red\"",
                               "Colours of the preview by web names."));
  rows.push_back(row<setfeeds>(
      "setfeeds",
      "plunge=undef, feed=undef, large_square=undef, small_square=undef, large_ball=undef, small_ball=undef, "
      "large_V=undef, small_V=undef, DT=undef, KH=undef, RO=undef, MISC=undef",
      "Set the base feeds in mm/min, and ratios by class of tool.\n"
      "\n"
      "Classes: large_square, small_square, large_ball, small_ball, large_V, small_V, DT, KH, "
      "RO, MISC. A\n"
      "ratio multiplies both feeds while a tool of that class is in use."));
  rows.push_back(row<setpost>("setpost", "name", "Choose the controller for which G-code is written."));
  rows.push_back(row<setdxfoptions>(
      "setdxfoptions", "version=\"r2000\", layers=\"colour\", joined=true, stagger=false",
      "Choose the version of drawings ('r2000', 'r12'), their layers ('colour', 'tool', "
      "'depth'), whether lines and arcs that meet become polylines, and whether colours are "
      "drawn beside each other."));
  rows.push_back(row<writecomment>("writecomment", "text", "Write a comment."));
  rows.push_back(with_further(
      row<writegc>("writegc", "",
                   "Write a line of G-code: a comment, or a line that neither moves the machine nor changes "
                   "modes.")));
  rows.push_back(
      with_further(row<debug>("debug", "", "Print, with the prefix \"DEBUG: \", if `debugenable` is set.")));
  rows.push_back(row<setdebug>("setdebug", "enable=true", "Whether debug() prints."));
}

}  // namespace kerf::design
