// What a run of a gcmc program is given (options) and where its text and messages go (GcmcOutput).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/geometry.h"
#include "kerf/origin.h"

namespace kerf {

/// What the program is compiled for: isgcode(), issvg() and isdxf() tell it.
enum class GcmcTarget : std::uint8_t { gcode, svg, dxf };
/// What stands before and behind the text: the usual words, nothing, or an O-word subroutine.
enum class GcmcFrame : std::uint8_t { usual, bare, subroutine };

struct GcmcOptions {
  std::string file_name = "--stdin--";  // for messages and origins
  std::vector<std::string>
      include_paths;                 // looked through after the current folder, before Kerf's own library
  std::vector<std::string> defines;  // statements that run first, "depth=5mm"
  bool imperial = false;             // inch is native
  bool relative = false;             // text in G91
  int precision = 8;                 // decimals, 1 to 15
  Plane plane = Plane::xy;
  std::array<double, 9> offsets{};  // X Y Z A B C U V W, native units and degrees, added to all output
  GcmcTarget target = GcmcTarget::gcode;

  bool want_path = true;   // GcmcRun::path
  bool want_text = false;  // GcmcOutput::text
  bool uvw = false;        // U V W words in the text
  bool brief = false;      // words that repeat what is in force are left out of the text
  GcmcFrame frame = GcmcFrame::usual;
  std::string subroutine;               // name, for GcmcFrame::subroutine
  bool subroutine_ends_program = true;  // M2 behind the subroutine
  std::string date;                     // for the head of the text, "2026-01-31 12:00:00"
  std::string prologue, epilogue;       // texts that replace the usual ones where not empty

  std::size_t max_memory = std::size_t{2} << 30;      // bytes of vectors, lists and strings
  std::size_t max_calls = 20'000;                     // calls inside of calls
  std::uint64_t max_quiet_steps = 2'000'000'000;      // loop steps and calls without any output or message
  std::uint64_t max_steps = 1'000'000'000'000;        // loop steps and calls in all
  std::uint64_t max_output = std::uint64_t{2} << 30;  // bytes of text and messages; a call counts as one more
  std::size_t max_path_steps = 50'000'000;            // steps of the toolpath
};

/// "part.gcmc:3:10: Runtime message(): text": the line of the real program, which other programs read,
/// without notes and hint. What a program itself says has the code gcmc_script: message() as a note,
/// warning() and error().
std::string gcmc_line(const Diagnostic& diagnostic);

/// Takes what a program says and writes.
class GcmcOutput {
 public:
  virtual ~GcmcOutput() = default;
  /// A message of the program, a warning or an error, as soon as there is one; `where` is a TextSpot, the
  /// notes are the calls that led there, innermost first.
  virtual void message(const Diagnostic& message) = 0;
  /// A piece of the text, as soon as there is enough of it.
  virtual void text(std::string_view piece) = 0;
  /// True where no more text can be taken, as on a full disk: the program ends with the piece that failed,
  /// without a message, since whoever takes the text knows why.
  virtual bool is_broken() const { return false; }
};

}  // namespace kerf
