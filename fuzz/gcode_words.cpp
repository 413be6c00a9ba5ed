// Any bytes as a G-code program: each byte selects a fragment, so that expressions and O-words occur in every
// order. No crash, no hang, every step finite.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "kerf/program/gcode.h"

namespace {

constexpr std::string_view kPieces[] = {"\n",
                                        "\n",
                                        "#1",
                                        "#<a>",
                                        "#<_x>",
                                        "=",
                                        "[",
                                        "]",
                                        "+",
                                        "-",
                                        "*",
                                        "/",
                                        "**",
                                        " MOD ",
                                        " EQ ",
                                        " LT ",
                                        " AND ",
                                        "SIN[",
                                        "ATAN[",
                                        "SQRT[",
                                        "EXISTS[#<",
                                        ">]",
                                        "1",
                                        "2.5",
                                        "0",
                                        "#",
                                        "G1 X",
                                        "G2 I1 Y",
                                        "F100",
                                        "O1 sub\n",
                                        "O1 call ",
                                        "O1 endsub",
                                        "O1 return",
                                        "O1 while [",
                                        "O1 endwhile\n",
                                        "O1 do\n",
                                        "O1 if [",
                                        "O1 elseif [",
                                        "O1 else\n",
                                        "O1 endif\n",
                                        "O1 repeat [",
                                        "O1 endrepeat\n",
                                        "O1 break\n",
                                        "O1 continue\n",
                                        "O2",
                                        "O<a>",
                                        " call",
                                        "M98 P1",
                                        "M99\n",
                                        "O1\n",
                                        "G10 L2 P1 R30 X",
                                        "G92 X",
                                        "@",
                                        "^",
                                        "M70",
                                        "M72\n",
                                        "M73\n",
                                        "G5 P1 Q1 I1 J1 X",
                                        "G5.2 P1 L3 X",
                                        "G5.3\n",
                                        "G51 X2",
                                        "G68 R45\n",
                                        "G54",
                                        "G55",
                                        "G41.1 D2 ",
                                        "G42.1 D.5 ",
                                        "G40\n",
                                        "G3 I1 J2 X",
                                        "G83 R1 Z0 Q.1 X",
                                        "G28\n",
                                        "M30\n"};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text;
  for (std::size_t i = 0; i < size && text.size() < 4000; ++i) text += kPieces[data[i] % std::size(kPieces)];
  kerf::GcodeReadOptions options;
  options.max_steps = 5000;
  options.max_rerun_bytes = 100'000;
  options.read_file = [&](const std::string&) { return std::optional<std::string>("o<a> sub\nG1 X#1\n"); };
  kerf::Diagnostics diagnostics(5);
  const kerf::GcodeProgram program = kerf::read_gcode(text, options, diagnostics);
  if (program.path.size() > options.max_steps) std::abort();
  for (const kerf::Step& s : program.path.steps())
    if (s.is_motion() && !(finite(s.to()) && std::isfinite(s.feed().mm_per_min()))) std::abort();
  for (const kerf::Diagnostic& diagnostic : diagnostics.list())
    if (to_string(diagnostic).empty()) std::abort();
  return 0;
}
