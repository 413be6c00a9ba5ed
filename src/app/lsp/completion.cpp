// Words that may follow in a text: of G-code, gcmc, OpenSCAD and jobs.
#include "app/lsp/completion.h"

#include <algorithm>

#include "base/names.h"
#include "front/gcmc/run/builtins.h"
#include "front/scad/scad.h"

#include "kerf/program/cut_job.h"

namespace kerf::app::lsp {
namespace {

struct CodeMeaning {
  std::string_view word, meaning;
};
/// The codes of mills that most controllers have. Source: the G-code overview of LinuxCNC.
constexpr CodeMeaning kCodes[] = {{"G0", "rapid motion"},
                                  {"G1", "straight cut"},
                                  {"G2", "arc, clockwise"},
                                  {"G3", "arc, counter-clockwise"},
                                  {"G4", "dwell: P"},
                                  {"G10", "set offsets: L, P"},
                                  {"G17", "plane XY"},
                                  {"G18", "plane ZX"},
                                  {"G19", "plane YZ"},
                                  {"G20", "inches"},
                                  {"G21", "millimetres"},
                                  {"G28", "to the stored position, by way of a point"},
                                  {"G30", "to the second stored position"},
                                  {"G38.2", "probe towards the part, an error without contact"},
                                  {"G38.3", "probe towards the part"},
                                  {"G40", "cutter compensation off"},
                                  {"G41", "cutter compensation, left of the path"},
                                  {"G42", "cutter compensation, right of the path"},
                                  {"G43", "tool length offset: H"},
                                  {"G49", "tool length offset off"},
                                  {"G53", "in machine coordinates, this line only"},
                                  {"G54", "work offset 1"},
                                  {"G55", "work offset 2"},
                                  {"G56", "work offset 3"},
                                  {"G57", "work offset 4"},
                                  {"G58", "work offset 5"},
                                  {"G59", "work offset 6"},
                                  {"G61", "exact path"},
                                  {"G64", "blend corners: P, the tolerance"},
                                  {"G73", "drill, chip break: Q"},
                                  {"G80", "cycle off"},
                                  {"G81", "drill"},
                                  {"G82", "drill with dwell: P"},
                                  {"G83", "drill with pecks: Q"},
                                  {"G84", "tap"},
                                  {"G85", "bore, feed out"},
                                  {"G90", "absolute positions"},
                                  {"G90.1", "absolute arc centres"},
                                  {"G91", "relative positions"},
                                  {"G91.1", "relative arc centres"},
                                  {"G92", "shift the work zero"},
                                  {"G93", "feed as 1/minutes"},
                                  {"G94", "feed per minute"},
                                  {"G95", "feed per revolution"},
                                  {"G98", "cycles return to the initial height"},
                                  {"G99", "cycles return to R"},
                                  {"M0", "pause"},
                                  {"M1", "optional pause"},
                                  {"M2", "end"},
                                  {"M3", "spindle clockwise: S"},
                                  {"M4", "spindle counter-clockwise: S"},
                                  {"M5", "spindle off"},
                                  {"M6", "tool change: T"},
                                  {"M7", "mist on"},
                                  {"M8", "flood on"},
                                  {"M9", "coolant off"},
                                  {"M30", "end and rewind"}};

/// The operation of a job's [[operation]] at a line; null if there is none, or its `op` is not given yet.
const CutRow* operation_at(std::string_view text, std::size_t line) {
  const TextLines lines(text);
  std::size_t first = std::min(line, lines.count() - 1);
  while (first > 0 && lines.line(first).find('[') != 0) --first;
  if (lines.line(first).rfind("[[operation]]", 0) != 0) return nullptr;
  for (std::size_t n = first + 1; n < lines.count() && lines.line(n).find('[') != 0; ++n) {
    const std::string_view row = trim(lines.line(n));
    const std::size_t open = row.find('"'), close = row.find('"', open + 1);
    if (row.rfind("op", 0) != 0 || open == std::string_view::npos || close == std::string_view::npos)
      continue;
    for (const CutRow& operation : cut_rows())
      if (operation.name == row.substr(open + 1, close - open - 1)) return &operation;
  }
  return nullptr;
}

void add_job(std::string_view text, std::size_t line, std::vector<Proposal>& out) {
  if (const CutRow* const row = operation_at(text, line)) {
    for (const CutKey& key : row->keys) out.push_back({std::string(key.name), std::string(key.meaning)});
    return;
  }
  for (const CutRow& row : cut_rows()) out.push_back({std::string(row.name), std::string(row.sentence)});
}

void add_own(Script script, std::string_view text, std::vector<Proposal>& out) {
  for (const Symbol& symbol : outline_of(script, text))
    if (symbol.kind != SymbolKind::event)
      out.push_back({symbol.name, {}, symbol.kind != SymbolKind::variable});
}

}  // namespace

std::vector<Proposal> proposals(Script script, std::string_view text, std::size_t line) {
  std::vector<Proposal> out;
  switch (script) {
    case Script::gcode:
      for (const CodeMeaning& code : kCodes)
        out.push_back({std::string(code.word), std::string(code.meaning)});
      break;
    case Script::gcmc:
      for (const std::string& name : gcmc::builtin_names()) out.push_back({name, {}, true});
      break;
    case Script::scad:
      for (const std::string& name : scad_names()) out.push_back({name, {}, true});
      break;
    case Script::job: add_job(text, line, out); return out;
    case Script::other: return out;
  }
  add_own(script, text, out);
  return out;
}

std::string meaning_of(Script script, std::string_view text, std::size_t line, const std::string& word) {
  if (script == Script::job) {
    const CutRow* const row = operation_at(text, line);
    const CutKey* const key = row == nullptr ? nullptr : row->key(word);
    if (key != nullptr)
      return std::string(key->meaning) +
             (key->is_number() || !key->choices.empty() ? " (" + rule_of(*key) + ")" : "");
    for (const CutRow& operation : cut_rows())
      if (operation.name == word) return std::string(operation.sentence);
  }
  return {};
}

}  // namespace kerf::app::lsp
