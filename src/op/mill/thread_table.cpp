// The table of threads: majors and pitches of ISO 261 and ASME B1.1; tap drills of ISO 2306 for metric
// threads, and the usual number, letter and fraction drills, of about 75% of the depth, for unified ones.
#include "op/mill/thread_table.h"

#include <fmt/format.h>
#include <string>

#include "base/codes/op.h"

namespace kerf::op_detail {
namespace {

constexpr double kInch = 25.4;

constexpr ThreadSize metric(std::string_view name, double major, double pitch, double drill) {
  return {name, mm(major), mm(pitch), mm(drill)};
}
/// Of inches, with the number of threads per inch.
constexpr ThreadSize unified(std::string_view name, double major, double per_inch, double drill) {
  return {name, mm(kInch * major), mm(kInch / per_inch), mm(kInch * drill)};
}

constexpr ThreadSize kThreads[] = {
    metric("m1.6", 1.6, 0.35, 1.25),
    metric("m2", 2, 0.4, 1.6),
    metric("m2.5", 2.5, 0.45, 2.05),
    metric("m3", 3, 0.5, 2.5),
    metric("m3.5", 3.5, 0.6, 2.9),
    metric("m4", 4, 0.7, 3.3),
    metric("m5", 5, 0.8, 4.2),
    metric("m6", 6, 1, 5),
    metric("m7", 7, 1, 6),
    metric("m8", 8, 1.25, 6.8),
    metric("m10", 10, 1.5, 8.5),
    metric("m12", 12, 1.75, 10.2),
    metric("m14", 14, 2, 12),
    metric("m16", 16, 2, 14),
    metric("m18", 18, 2.5, 15.5),
    metric("m20", 20, 2.5, 17.5),
    metric("m22", 22, 2.5, 19.5),
    metric("m24", 24, 3, 21),
    metric("m27", 27, 3, 24),
    metric("m30", 30, 3.5, 26.5),
    metric("m33", 33, 3.5, 29.5),
    metric("m36", 36, 4, 32),
    metric("m6x0.75", 6, 0.75, 5.2),
    metric("m8x1", 8, 1, 7),
    metric("m10x1", 10, 1, 9),
    metric("m10x1.25", 10, 1.25, 8.8),
    metric("m12x1.25", 12, 1.25, 10.8),
    metric("m12x1.5", 12, 1.5, 10.5),
    metric("m14x1.5", 14, 1.5, 12.5),
    metric("m16x1.5", 16, 1.5, 14.5),
    metric("m18x1.5", 18, 1.5, 16.5),
    metric("m20x1.5", 20, 1.5, 18.5),
    metric("m22x1.5", 22, 1.5, 20.5),
    metric("m24x2", 24, 2, 22),
    unified("2-56", 0.086, 56, 0.0700),
    unified("4-40", 0.112, 40, 0.0890),
    unified("6-32", 0.138, 32, 0.1065),
    unified("8-32", 0.164, 32, 0.1360),
    unified("10-24", 0.19, 24, 0.1495),
    unified("1/4-20", 0.25, 20, 0.2010),
    unified("5/16-18", 0.3125, 18, 0.2570),
    unified("3/8-16", 0.375, 16, 0.3125),
    unified("7/16-14", 0.4375, 14, 0.3680),
    unified("1/2-13", 0.5, 13, 0.4219),
    unified("9/16-12", 0.5625, 12, 0.4844),
    unified("5/8-11", 0.625, 11, 0.5313),
    unified("3/4-10", 0.75, 10, 0.6563),
    unified("7/8-9", 0.875, 9, 0.7656),
    unified("1-8", 1, 8, 0.8750),
    unified("4-48", 0.112, 48, 0.0935),
    unified("6-40", 0.138, 40, 0.1130),
    unified("8-36", 0.164, 36, 0.1360),
    unified("10-32", 0.19, 32, 0.1590),
    unified("1/4-28", 0.25, 28, 0.2130),
    unified("5/16-24", 0.3125, 24, 0.2720),
    unified("3/8-24", 0.375, 24, 0.3320),
    unified("7/16-20", 0.4375, 20, 0.3906),
    unified("1/2-20", 0.5, 20, 0.4531),
    unified("9/16-18", 0.5625, 18, 0.5156),
    unified("5/8-18", 0.625, 18, 0.5781),
    unified("3/4-16", 0.75, 16, 0.6875),
    unified("7/8-14", 0.875, 14, 0.8125),
    unified("1-12", 1, 12, 0.9219),
};

/// In lower case, without blanks, signs of numbers and inches, and the series of unified threads.
std::string folded(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (c == ' ' || c == '#' || c == '"') continue;
    text += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c == '*' ? 'x' : c;
  }
  for (const std::string_view series : {"unc", "unf"})
    if (const std::size_t at = text.find(series); at != std::string::npos) text.erase(at, series.size());
  return text;
}

}  // namespace

std::optional<ThreadSize> thread_size(std::string_view name) {
  const std::string wanted = folded(name);
  for (const ThreadSize& thread : kThreads)
    if (wanted == thread.name || wanted == fmt::format("{}x{:g}", thread.name, thread.pitch.mm()))
      return thread;
  return std::nullopt;
}

std::optional<ThreadSize> thread_size(std::string_view name, const CutOptions& cut,
                                      Diagnostics& diagnostics) {
  auto found = thread_size(name);
  if (!found)
    diagnostics
        .error(codes::op_option, cut.where,
               fmt::format("{}no thread \"{}\" in the table", prefix(cut), name.substr(0, 40)))
        .hint = "M1.6 to M36, M6x0.75 to M24x2, 2-56 to 1-8, 4-48 to 1-12: \"M6\", \"M10x1.25\", \"1/4-20\"";
  return found;
}

}  // namespace kerf::op_detail
