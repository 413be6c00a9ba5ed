// The options of a run of a gcmc program, and the receiver of its text and messages (GcmcOutput).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/origin.h"
#include "kerf/geom/geometry.h"

namespace kerf {

/// The target of the compilation, queried by isgcode(), issvg() and isdxf().
enum class GcmcTarget : std::uint8_t { gcode, svg, dxf };
/// Prologue and epilogue of the text: the usual ones, none, or those of an O-word subroutine.
enum class GcmcFrame : std::uint8_t { usual, bare, subroutine };

/// Names of sources that are not files: the defines, and the files of the built-in library ("<kerf>/NAME").
inline constexpr std::string_view kGcmcDefinesName = "<cmd-line defines>";
inline constexpr std::string_view kGcmcLibraryPrefix = "<kerf>/";

/// The published version whose arcs, angles and version constants a program expects.
enum class GcmcVersion : std::uint8_t {
  unstated,  // arcs as G-code requires, angles without unit in degrees; a warning where versions differ
  v1_8,      // arcs in XZ as seen from -Y, helices leave the tracked position, angles in degrees
  v1_9       // arcs as G-code requires, angles without unit in radians
};
/// The version of a text such as "1.8" or "1.9.2"; nothing if there is no such version.
std::optional<GcmcVersion> gcmc_version_named(std::string_view text);
/// "1.9.0", as GCMC_VERSION_STR; without a stated version that of the recorded output.
std::string_view gcmc_version_text(GcmcVersion version);

struct GcmcOptions {
  std::string file_name = "--stdin--";     // for messages and origins
  std::vector<std::string> include_paths;  // searched after the current folder, before the built-in library
  std::vector<std::string> defines;        // statements that run first, "depth=5mm"
  bool imperial = false;                   // inch is native
  bool relative = false;                   // text in G91
  int precision = 8;                       // decimals, 1 to 15
  Plane plane = Plane::xy;
  std::array<double, 9> offsets{};  // X Y Z A B C U V W, native units and degrees, added to all output
  GcmcTarget target = GcmcTarget::gcode;
  GcmcVersion version = GcmcVersion::unstated;
  bool degrees = false;      // A B C without unit are degrees, in any version
  bool own_warnings = true;  // those of Kerf about angles and corners, which the real program does not give

  bool want_path = true;   // GcmcRun::path
  bool want_text = false;  // GcmcOutput::text
  bool uvw = false;        // U V W words in the text
  bool brief = false;      // omit words that repeat a modal value
  GcmcFrame frame = GcmcFrame::usual;
  std::string subroutine;               // name, for GcmcFrame::subroutine
  bool subroutine_ends_program = true;  // M2 after the subroutine
  std::string date;                     // in the prologue, "2026-01-31 12:00:00"
  std::string prologue, epilogue;       // replace the usual ones if not empty

  std::size_t max_memory = std::size_t{2} << 30;      // bytes of vectors, lists and strings
  std::size_t max_calls = 20'000;                     // nesting of calls
  std::uint64_t max_quiet_steps = 500'000'000;        // loop steps and calls without output or message
  std::uint64_t max_steps = 1'000'000'000'000;        // loop steps and calls in all
  std::uint64_t max_output = std::uint64_t{2} << 30;  // bytes of text and messages, plus 1 for each call
  std::size_t max_path_steps = 50'000'000;            // steps of the toolpath
};

/// "part.gcmc:3:10: Runtime message(): text": the message in the form of the real program, which other
/// programs parse, without notes and hint. message(), warning() and error() of the program have the code
/// gcmc_script and the severity note, warning and error.
std::string gcmc_line(const Diagnostic& diagnostic);

/// Receives the messages and the text of a program.
class GcmcOutput {
 public:
  virtual ~GcmcOutput() = default;
  /// A message, warning or error, at once; `where` is a TextLocation, the notes are the calls that led to it,
  /// innermost first.
  virtual void message(const Diagnostic& message) = 0;
  /// A chunk of the text.
  virtual void text(std::string_view piece) = 0;
  /// True if no more text can be received, as on a full disk: the program then ends without a message.
  virtual bool is_broken() const { return false; }
};

}  // namespace kerf
