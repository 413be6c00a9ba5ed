// Posts: a toolpath as G-code for one kind of controller.
//
// The differences of controllers are data: a PostProfile lists words, decimals, arcs, maximum line lengths
// and tool changes. The built-in profiles are posts/*.toml; a new machine is one more such file
// (docs/manual/posts.md), not code.
//
//   Diagnostics diagnostics;
//   const PostProfile* grbl = find_post("grbl");
//   std::vector<PostedFile> files = post(path, *grbl, {.program_name = "part"}, diagnostics);
//   lint_gcode(files[0].text, *grbl, "part.nc", diagnostics);
//
// Sources: the manuals of LinuxCNC, GRBL, grblHAL, Marlin, Klipper, RepRapFirmware and Mach3.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/base/tolerance.h"
#include "kerf/base/units.h"
#include "kerf/path/toolpath.h"

namespace kerf {

enum class LengthUnit : std::uint8_t { mm, inch };
/// Arcs as G2 and G3 with both plane axes and both centre words, or as straight chords if the controller
/// has no arcs.
enum class ArcPolicy : std::uint8_t { centre, chords };
enum class CommentStyle : std::uint8_t { none, brackets, semicolon };
/// `command`: the controller changes tools (T M6). `pause`: the program stops for a manual change; not
/// before the first tool, which is in the spindle already. `files`: one file per tool. `ignore`: nothing.
enum class ToolChangePolicy : std::uint8_t { command, pause, files, ignore };
enum class DwellUnit : std::uint8_t { seconds, milliseconds };
/// Whether an unchanged modal word is written again.
enum class Repeat : std::uint8_t { when_changed, always };
/// "X10", "X10.000", or "X10." for controllers where a number without a point counts thousandths.
enum class Zeros : std::uint8_t { dropped, kept, point };
enum class WordSpacing : std::uint8_t { blank, none };
enum class LineEnd : std::uint8_t { lf, crlf };
/// The form of a line. `words`: any number of codes and words with a modal motion (RS274, all mills).
/// `commands`: one command, named on every line (printers); G28 and G53 have other meanings there, so motions
/// to machine positions are left out.
enum class LineSyntax : std::uint8_t { words, commands };
/// What counts towards the maximum line length: every byte, or (GRBL) neither blanks nor comments.
enum class LineMeasure : std::uint8_t { bytes, significant };
enum class ExtruderMode : std::uint8_t { relative, absolute };
/// Comments on beads. `slicer`: layers, kinds, widths and heights as PrusaSlicer writes them
/// (";LAYER_CHANGE",
/// ";TYPE:External perimeter", ";WIDTH:0.45"), which the viewers of slicers and printers read.
enum class BeadComments : std::uint8_t { none, slicer };
/// How the limits of motions (step::MotionLimits) are written: not at all; M201, M203, M204, M205 with mm/s;
/// the same with mm/min and M566; SET_VELOCITY_LIMIT.
enum class LimitCommands : std::uint8_t { none, marlin, reprap, klipper };
/// Retraction by the firmware (G10, G11): as such a line, or by E words.
enum class RetractionPolicy : std::uint8_t { firmware, extruder };
/// What M3 and M4 switch, and S sets: a spindle and its speed, or a laser's beam and its power.
enum class Drive : std::uint8_t { spindle, beam };
/// The feed of a straight cut that moves along and turns an axis. `per_minute`: of X, Y and Z, as LinuxCNC
/// has it. `inverse_time`: in G93, where each controller takes F per minute as something else.
enum class TurningFeed : std::uint8_t { per_minute, inverse_time };
/// E words: mm of filament, or mm3.
enum class ExtruderUnit : std::uint8_t { length, volume };

/// What a program may have.
struct ProgramForm {
  bool percent_lines = false;    // it may be enclosed in lines of %
  bool program_numbers = false;  // a line O1234 names it; O-words do not exist
  bool parameters = false;       // #1, [1 + 2] and O-words
  bool blend_tolerance = false;  // G64 takes P, the greatest distance from the path
  bool capitals = false;         // no small letters, in comments either
  TurningFeed turning_feed = TurningFeed::per_minute;
};
struct DriveWords {
  Drive kind = Drive::spindle;
  bool surface_limit = false;  // G96 takes D, the highest rpm
  SpindleSpeed full_speed{};   // M3 takes P, the percentage of this; 0: S in rpm
};
/// How a printer's filament is written.
struct ExtruderWords {
  ExtruderMode mode = ExtruderMode::relative;
  ExtruderUnit unit = ExtruderUnit::length;
  RetractionPolicy retraction = RetractionPolicy::firmware;
  Length retract = mm(0.8);  // by E words, where the program does not set it
  Feed retract_speed = mm_per_min(2100);
};

/// Digits after the decimal point, of lengths by unit, of rotary axes, feeds and spindle speeds.
struct Decimals {
  int mm = 3, inch = 4, degrees = 3, feed = 3, speed = 2;
};

/// One controller's dialect. Lines of templates may hold {name}, {units}, {tool}, {tool_name},
/// {tool_comment}, {tools}, {bounds}, {time}, {version}, {profile}, of a print {extruder} (M82 or M83),
/// {filament_diameter}, {filament_mm}, {filament_cm3}, {layers}, {layer_height} (of the first layer),
/// {nozzle}, {bed}, {chamber} (the temperature of each at the first bead, C), and the names of
/// `variables`; a comment that ends up empty is left out.
struct PostProfile {
  std::string name;     // "grbl"
  std::string title;    // "GRBL 1.1"
  std::string dialect;  // how Kerf reads what the post writes (gcode_options.h); empty: by the name
  std::string file_ending = ".nc";

  // What the controller supports.
  std::string letters;       // all letters of a line, "FGIJKMNPSTXYZ"
  std::vector<int> g_codes;  // in tenths: G38.2 is 382
  std::vector<int> m_codes;  // in tenths
  int homing = 0;            // in tenths: the code that runs axes to their switches; 0: none
  DriveWords drive;
  int highest_tool = 99'999'999;
  int highest_line_number = 99'999;
  std::size_t longest_line = 250;
  LineMeasure line_measure = LineMeasure::bytes;
  std::vector<std::string> commands{};  // words that start a line: PAUSE, echo; "*": any
  LineSyntax syntax = LineSyntax::words;
  CommentStyle comments = CommentStyle::brackets;
  ProgramForm form;
  std::string comment_forbidden;  // characters that act even inside a comment (GRBL's ! ? ~)

  // How they are written.
  LengthUnit unit = LengthUnit::mm;
  Decimals decimals;
  Zeros zeros = Zeros::dropped;
  WordSpacing spacing = WordSpacing::blank;
  LineEnd line_end = LineEnd::lf;
  Repeat motion = Repeat::when_changed, axes = Repeat::when_changed, feed = Repeat::when_changed;
  int line_number_step = 0;  // 0: no N words

  ArcPolicy arcs = ArcPolicy::centre;
  std::vector<Plane> arc_planes{Plane::xy, Plane::xz, Plane::yz};
  Length largest_radius = mm(10'000);            // above it, chords
  Length shortest_arc = mm(0.002);               // below it, a straight cut
  Length chord = default_tolerance::kPostChord;  // of chords from their arc

  ToolChangePolicy tool_change = ToolChangePolicy::command;
  DwellUnit dwell_unit = DwellUnit::seconds;
  Duration spindle_dwell;  // after a spindle start, unless the program has a dwell
  Length filament;         // diameter, for E words; 0: that of the program, else 1.75 mm
  ExtruderWords extruder;
  double fan_full = 255.0;  // S of a fan at full speed
  BeadComments bead_comments = BeadComments::none;
  LimitCommands limits = LimitCommands::none;
  std::map<std::string, std::string> variables;  // for templates; PostOptions::variables come first

  std::vector<std::string> header, section, footer;
  std::vector<std::string> change_lines{"T{tool} M6"};  // for ToolChangePolicy::command
  std::vector<std::string> length_lines;                // after them, with ToolLengths::by_post
  std::vector<std::string> pause_lines{"(change to tool {tool})", "(tool {tool}: {tool_name})", "M0"};
  std::vector<std::string> extruder_lines;  // select an extruder of a printer; {extruder_number}

  bool has_letter(char letter) const { return letters.find(letter) != std::string::npos; }
  bool has_g(int tenths) const;
  bool has_m(int tenths) const;
};

/// The built-in profiles, ordered by name.
const std::vector<PostProfile>& built_in_posts();
/// One of them by its name ("grbl", "LinuxCNC"); null if there is none.
const PostProfile* find_post(std::string_view name);
/// Reads a profile file. A key `base = "grbl"` inherits from that profile. Errors are reported with
/// their location; nothing is returned after one.
std::optional<PostProfile> read_post_profile(std::string_view text, std::string_view file_name,
                                             Diagnostics& diagnostics);

/// Who states that the length of a new tool takes effect (G43): the post, for toolpaths that do not, or the
/// toolpath's own steps.
enum class ToolLengths : std::uint8_t { by_post, by_path };

/// Codes of the source that are unknown and may have moved the tool (UnresolvedKind::code): an error, or
/// written without them.
enum class LeftOutCodes : std::uint8_t { refused, skipped };

/// A picture in the comments at the start of a printer's program, as slicers write them.
struct Thumbnail {
  int width = 0, height = 0;  // pixels
  std::string png;            // bytes of the file
};

struct PostOptions {
  std::string program_name;        // for the header's comment
  std::optional<LengthUnit> unit;  // instead of the profile's
  std::optional<ToolChangePolicy> tool_change;
  ToolLengths tool_lengths = ToolLengths::by_post;
  LeftOutCodes left_out = LeftOutCodes::refused;
  Feed missing_feed;                         // for cuts without a feed; 0: an error
  Length filament;                           // diameter of the program's; 0: unknown
  std::vector<std::string> stock_comments;   // after the first comments of the header
  std::string start_tool;                    // after them: "tool 1 at the start: square ...", not a change
  std::map<int, std::string> tool_names;     // for comments
  std::map<int, std::string> tool_comments;  // "TOOL/MILL, 6, 0, 20, 0"
  std::map<std::string, std::string> variables;  // for templates
  std::vector<Thumbnail> thumbnails;             // not written for mills
};

struct PostedFile {
  std::optional<int> tool;  // set if each tool has its own file
  std::string text;
  std::size_t lines = 0;
};

/// Writes a toolpath as G-code. A missing feature of the controller is an error if it changes the part,
/// otherwise a warning; after an error the files must not be used. A stopped run returns no file.
std::vector<PostedFile> post(const Toolpath& path, const PostProfile& profile, const PostOptions& options,
                             Diagnostics& diagnostics, Progress* progress = nullptr);

/// Reads G-code like the profile's controller and reports what that would refuse, one error each: letters,
/// codes, conflicts, unused words, arcs that do not close, long lines. True without errors.
bool lint_gcode(std::string_view text, const PostProfile& profile, const std::string& file_name,
                Diagnostics& diagnostics);

}  // namespace kerf
