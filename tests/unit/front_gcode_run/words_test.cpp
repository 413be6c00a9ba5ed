// Every word of LinuxCNC's quick reference (tests/data/gcode/words.txt explains the notation): the events and
// diagnostics of a small program with it.
#include <algorithm>
#include <array>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <sstream>

#include "notation.h"
#include "test_paths.h"

#include "kerf/geom/geometry.h"
#include "kerf/program/gcode.h"

namespace kerf {
namespace {

struct Row {
  std::string word, program;
  std::vector<std::string> events, says;
};

struct Table {
  std::set<std::string> words;
  std::vector<Row> rows;
};

/// The part of a line after its keyword.
std::string rest_of(const std::string& line) {
  const std::size_t blank = line.find(' ');
  const std::size_t text = line.find_first_not_of(' ', blank);
  return text == std::string::npos ? std::string() : line.substr(text);
}

Table read_table() {
  Table table;
  std::ifstream file(KERF_TEST_DATA "/gcode/words.txt");
  EXPECT_TRUE(file);
  for (std::string line; std::getline(file, line);) {
    const std::string key = line.substr(0, line.find(' '));
    const std::string rest = rest_of(line);
    if (key == "word")
      for (const std::string& word : split(rest, " ")) table.words.insert(word);
    if (key == "show") table.rows.push_back({split(rest, " | ").front(), {}, {}, {}});
    if (key == "run") table.rows.back().program = rest;
    if (key == "=") table.rows.back().events = split(rest, "; ");
    if (key == "says") table.rows.back().says.push_back(rest);
  }
  return table;
}

std::string numbers(std::initializer_list<double> values) {
  std::ostringstream out;
  out.precision(9);
  for (const double v : values) out << ' ' << v;
  return out.str();
}

std::string text_of(const step::Spindle& s) {
  const char* const turn = s.turn == SpindleTurn::off ? "off" : s.turn == SpindleTurn::cw ? "cw" : "ccw";
  return "S" + numbers({s.speed.rpm()}) + " " + turn;
}

std::string text_of(const step::Coolant& c) {
  if (!c.mist && !c.flood) return "K off";
  return std::string("K") + (c.mist ? " mist" : "") + (c.flood ? " flood" : "");
}

std::string text_of(const step::PathMode& p) {
  if (p.kind == PathModeKind::exact_path) return "P exact path";
  if (p.kind == PathModeKind::exact_stop) return "P exact stop";
  return "P blend" + numbers({p.tolerance.mm()});
}

std::string text_of(const step::Pause& p) {
  return p.kind == PauseKind::always ? "M0" : p.kind == PauseKind::optional ? "M1" : "M60";
}

/// A move that is no chord of a curve; curves are N.
std::string move_text(const Toolpath& path, std::size_t i) {
  const Step& s = path[i];
  const Point3 to = s.to();
  const char letter = s.kind() == StepKind::rapid ? 'R' : s.kind() == StepKind::probe ? 'Q' : 'C';
  std::string text = letter + numbers({to.x, to.y, to.z});
  if (s.kind() == StepKind::arc) {
    const step::Arc arc = s.arc();
    const int turns = (arc.extra_turns + 1) * (arc.turn == Turn::cw ? -1 : 1);
    text = "A" + numbers({to.x, to.y, to.z}) + " c" + numbers({arc.centre.x, arc.centre.y}) + " t" +
           numbers({static_cast<double>(turns)});
  }
  if (s.kind() != StepKind::rapid) text += " f" + numbers({s.feed().mm_per_min()});
  const MotionExtra* extra = path.extra(i);
  if (extra != nullptr && extra->abc && *extra->abc != std::array<double, 3>{})
    text += " a" + numbers({(*extra->abc)[0], (*extra->abc)[1], (*extra->abc)[2]});
  return text;
}

std::string event_text(const Toolpath& path, std::size_t i) {
  const Step& s = path[i];
  switch (s.kind()) {
    case StepKind::dwell: return "D" + numbers({s.dwell().time.seconds()});
    case StepKind::tool_change: return "T " + std::to_string(s.tool_change().tool);
    case StepKind::spindle: return text_of(s.spindle());
    case StepKind::coolant: return text_of(s.coolant());
    case StepKind::path_mode: return text_of(s.path_mode());
    case StepKind::pause: return text_of(s.pause());
    case StepKind::end: return "end";
    case StepKind::store_home:
    case StepKind::work_zero:
    case StepKind::tool_length:
    case StepKind::unresolved:
    case StepKind::note: return {};
    default: return move_text(path, i);
  }
}

/// Adds an event; what an end switches off is omitted.
void add_event(std::vector<std::string>& events, const std::string& event) {
  if (event.empty()) return;
  if (event == "end")
    while (!events.empty() && (events.back() == "S 0 off" || events.back() == "K off")) events.pop_back();
  events.push_back(event);
}

double distance_to(Point2 p, Point2 a, Point2 b) {
  const Point2 way = b - a;
  const double size = dot(way, way);
  const double t = size > 0.0 ? std::clamp(dot(p - a, way) / size, 0.0, 1.0) : 0.0;
  return distance(p, a + t * way);
}

/// True if the chords of one line, from step `i` of a path, are the curve "N x y z via u v ...": they end at
/// x y z and pass its points. i becomes the last of them.
bool is_curve(const Toolpath& path, std::size_t& i, const std::string& wanted) {
  constexpr double kNear = 0.01;  // mm; the chords are nearer
  std::istringstream in(wanted.substr(1));
  Point3 end;
  std::string via;
  in >> end.x >> end.y >> end.z >> via;
  std::vector<Point2> chain{i > 0 && path[i - 1].is_motion() ? path[i - 1].to().xy() : Point2{}};
  const Origin origin = path.origin_of(i);
  for (chain.push_back(path[i].to().xy());
       i + 1 < path.size() && path[i + 1].is_cutting() && path.origin_of(i + 1) == origin;
       chain.push_back(path[i].to().xy()))
    ++i;
  bool passes = distance(path[i].to(), end) < 1e-9 && chain.size() > 8;
  for (Point2 p; in >> p.x >> p.y;) {
    double nearest = 1e9;
    for (std::size_t k = 1; k < chain.size(); ++k)
      nearest = std::min(nearest, distance_to(p, chain[k - 1], chain[k]));
    passes = passes && nearest < kNear;
  }
  return passes;
}

std::vector<std::string> events_of(const Toolpath& path, const std::vector<std::string>& wanted) {
  std::vector<std::string> events;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const std::string next = events.size() < wanted.size() ? wanted[events.size()] : "";
    if (next.rfind("N ", 0) == 0 && path[i].is_cutting()) {
      const bool passes = is_curve(path, i, next);
      events.push_back(passes ? next : "another curve");
      continue;
    }
    add_event(events, event_text(path, i));
  }
  return events;
}

/// "warning 2018 4:1"
std::string text_of(const Diagnostic& d) {
  std::string text = std::string(to_string(d.severity)) + " " + std::to_string(static_cast<int>(d.code));
  if (const auto* location = std::get_if<TextLocation>(&d.where))
    text += " " + std::to_string(location->line) + ":" + std::to_string(location->column);
  return text;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : "; ") + word;
  return text;
}

void check(const Row& row) {
  constexpr double kSlack = 1.01e-4;  // the table has four decimals
  Diagnostics diagnostics;
  GcodeReadOptions options;
  options.dialect = GcodeDialect::rs274;
  options.tool_diameter = [](int tool, const Tool*) -> std::optional<double> {
    return tool == 1 ? 6.0 : 10.0;
  };
  const GcodeProgram program = read_gcode(program_text(row.program), options, diagnostics);
  const std::vector<std::string> got = events_of(program.path, row.events);
  const std::string where = row.word + ": " + row.program;
  bool agree = got.size() == row.events.size();
  for (std::size_t i = 0; agree && i < got.size(); ++i) agree = same(got[i], row.events[i], kSlack);
  EXPECT_TRUE(agree) << where << "\ngot    " << joined(got) << "\nwanted " << joined(row.events);
  std::vector<std::string> messages;
  for (const Diagnostic& d : diagnostics.list()) messages.push_back(text_of(d));
  EXPECT_EQ(joined(messages), joined(row.says))
      << where << (diagnostics.list().empty() ? "" : "\n" + to_string(diagnostics.list().front()));
}

TEST(Words, DoWhatLinuxCncDocuments) {
  for (const Row& row : read_table().rows) check(row);
}

/// True if the program contains the word; G10L20 is two words.
bool contains(const std::string& program, const std::string& word) {
  std::string capitals = program;
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  if (word.rfind("G10L", 0) == 0) return capitals.find("G10 " + word.substr(3)) != std::string::npos;
  if (word == "comment") return capitals.find('(') != std::string::npos;
  if (word == "[]") return capitals.find('[') != std::string::npos;
  if (word.rfind("#<", 0) == 0)
    return capitals.find(word.substr(0, word[2] == '_' ? 3 : 2)) != std::string::npos;
  std::string wanted = word;
  for (char& c : wanted) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const std::size_t at = capitals.find(wanted);
  return at != std::string::npos;
}

TEST(Words, NoneIsWithoutAProgram) {
  const Table table = read_table();
  EXPECT_GE(table.words.size(), 180u);
  std::set<std::string> shown;
  for (const Row& row : table.rows) {
    shown.insert(row.word);
    EXPECT_TRUE(table.words.count(row.word) == 1) << row.word << " is no word of the list";
    EXPECT_TRUE(contains(row.program, row.word)) << row.word << " is not in " << row.program;
  }
  for (const std::string& word : table.words) EXPECT_EQ(shown.count(word), 1u) << word << " has no program";
}

}  // namespace
}  // namespace kerf
