// Hazards as text.
#include "app/report/findings.h"

#include <algorithm>
#include <fmt/format.h>

namespace kerf::app {
namespace {

constexpr std::size_t kMaxLines = 30;  // of hazards as text; JSON has them all

std::string line_of(const Finding& f, const LengthText& lengths) {
  std::string line = to_string(f.origin);
  if (!line.empty()) line += ": ";
  line += "hazard: " + lengths.message(f.message);
  if (f.steps > 1) line += fmt::format(", in {} motions from here", f.steps);
  line +=
      fmt::format(" (at X{} Y{} Z{}", lengths.of(f.at.x, 3), lengths.of(f.at.y, 3), lengths.of(f.at.z, 3));
  if (lengths.unit() != "mm") line += fmt::format(" {}", lengths.unit());
  if (f.removed_mm3 > 0.0) line += fmt::format(", {} removed", lengths.volume(f.removed_mm3, 3));
  line += fmt::format(") [{}]\n", f.kind);
  if (!f.hint.empty()) line += "    hint: " + f.hint + "\n";
  for (const Origin& caller : f.callers) line += fmt::format("  called from {}\n", to_string(caller));
  return line;
}

}  // namespace

std::string count_text(const std::vector<Finding>& findings) {
  const std::vector<Finding> lines = grouped(findings);
  if (lines.empty()) return "none";
  std::size_t motions = 0;
  for (const Finding& line : lines) motions += line.steps;
  if (motions == lines.size()) return std::to_string(motions);
  return fmt::format("{} in {} motions", lines.size(), motions);
}

void show(Console& console, const std::vector<Finding>& findings) {
  const std::vector<Finding> lines = grouped(findings);
  for (std::size_t i = 0; i < std::min(lines.size(), kMaxLines); ++i)
    console.print(line_of(lines[i], console.lengths()));
  if (lines.size() > kMaxLines)
    console.print(fmt::format("... and {} more hazards (--json lists them all)\n", lines.size() - kMaxLines));
}

}  // namespace kerf::app
