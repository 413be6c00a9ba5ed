// Damaged files of measured heights: an error, or the right points but for those that the damage explains.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <random>
#include <string>
#include <vector>

#include "kerf/formats/measured.h"

namespace kerf {
namespace {

constexpr int kColumns = 4, kRows = 3, kTrials = 200;

struct Point {
  double x = 0.0, y = 0.0, z = 0.0;
};

/// X 0 to 30, Y 0 to 20; each height is another one, of four decimals.
std::vector<Point> right_points() {
  std::vector<Point> out;
  for (int j = 0; j < kRows; ++j)
    for (int i = 0; i < kColumns; ++i)
      out.push_back({10.0 * i, 10.0 * j, 0.1234 + 0.0101 * i - 0.0703 * j + 0.0007 * i * j});
  return out;
}

/// What a file states of its own size.
enum class Size : std::uint8_t {
  stated,    // a missing point is an error
  open,      // a missing line is a missing point
  only_area  // --map-area has the positions: a missing row cannot be known
};

struct Format {
  std::string name, file, text;
  Size size = Size::stated;
};

std::string lines(const std::string& pattern) {
  std::string out;
  for (const Point& p : right_points())
    out += fmt::format(fmt::runtime(pattern), fmt::arg("x", p.x), fmt::arg("y", p.y),
                       fmt::arg("z", fmt::format("{:.4f}", p.z)), fmt::arg("mx", p.x + 100.0),
                       fmt::arg("my", p.y + 50.0), fmt::arg("mz", fmt::format("{:.4f}", p.z - 30.0)));
  return out;
}

/// The heights row by row.
std::string rows(const std::string& start, const std::string& separator, const std::string& end = "\n") {
  const auto points = right_points();
  std::string out;
  for (int j = 0; j < kRows; ++j) {
    out += fmt::format(fmt::runtime(start), fmt::arg("row", j));
    for (int i = 0; i < kColumns; ++i)
      out += fmt::format("{}{:.4f}", i == 0 ? "" : separator,
                         points[static_cast<std::size_t>(j * kColumns + i)].z);
    out += j + 1 == kRows ? "\n" : end;
  }
  return out;
}

std::string xml() {
  std::string out =
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
      "<heightmap MinX=\"0\" MinY=\"0\" MaxX=\"30\" MaxY=\"20\" SizeX=\"4\" SizeY=\"3\">\n";
  const auto points = right_points();
  for (std::size_t k = 0; k < points.size(); ++k)
    out +=
        fmt::format("  <point X=\"{}\" Y=\"{}\">{:.4f}</point>\n", k % kColumns, k / kColumns, points[k].z);
  return out + "</heightmap>\n";
}

std::string json_points() {
  std::string points = lines("    {{\"x\": {x}, \"y\": {y}, \"z\": {z}}},\n");
  points.erase(points.rfind(','), 1);
  return "{\n  \"bounds\": {\"minX\": 0, \"maxX\": 30, \"minY\": 0, \"maxY\": 20},\n"
         "  \"resolution\": {\"x\": 10, \"y\": 10},\n  \"units\": \"mm\",\n  \"points\": [\n" +
         points + "  ]\n}\n";
}

std::string json_mesh() {
  return "{\"bed_mesh\": {\n\"profile_name\": \"default\",\n\"mesh_min\": [0, 0],\n\"mesh_max\": [30, 20],\n"
         "\"profiles\": {\"default\": {\"mesh_params\": {\"x_count\": 4, \"y_count\": 3}}},\n"
         "\"probed_matrix\": [\n" +
         rows("[", ", ", "],\n") + "]]}}\n";
}

std::vector<Format> formats() {
  const std::string duet =
      "RepRapFirmware height map file v2 generated at 2024-05-01 10:00\n"
      "axis0,axis1,min0,max0,min1,max1,radius,spacing0,spacing1,num0,num1\n"
      "X,Y,0.00,30.00,0.00,20.00,-1.00,10.00,10.00,4,3\n";
  const std::string klipper =
      "[printer]\nkinematics: cartesian\n#*# [bed_mesh default]\n#*# version = 1\n#*# points =\n" +
      rows("#*# \t  ", ", ") +
      "#*# x_count = 4\n#*# y_count = 3\n#*# min_x = 0.0\n#*# min_y = 0.0\n#*# max_x = 30.0\n"
      "#*# max_y = 20.0\n";
  return {
      {"bCNC", "map.probe", "0 30 4\n0 20 3\n-5 3 50\n\n\n" + lines("{x} {y} {z}\n")},
      {"bCNC, another ending", "map.txt", "0 30 4\n0 20 3\n-5 3 50\n\n\n" + lines("{x} {y} {z}\n")},
      {"Candle", "map", "0;0;30;20\n4;3;-1;1\n0;1;1\n" + rows("", ";")},
      {"OpenCNCPilot", "map", xml()},
      {"gSender", "map", json_points()},
      {"Klipper's state", "map", json_mesh()},
      {"Duet", "heightmap.csv", duet + rows("  ", ",  ")},
      {"Klipper", "printer.cfg", klipper},
      {"Marlin's grid", "log",
       "Bilinear Leveling Grid:\n      0      1      2      3\n" + rows(" {row} ", " "), Size::only_area},
      {"Klipper's grid", "log", "// Mesh Leveling Probed Z positions:\n" + rows("  ", " "), Size::only_area},
      {"GRBL's log", "log",
       "<Idle|MPos:0,0,0|WCO:100.000,50.000,-30.000>\n" + lines("[PRB:{mx},{my},{mz}:1]\n"), Size::open},
      {"Marlin's log", "log", lines("Bed X: {x} Y: {y} Z: {z}\n"), Size::open},
      {"Klipper's log", "log", lines("// probe at {x},{y} is z={z}\n"), Size::open},
      {"lines", "map.xyz", lines("{x} {y} {z}\n"), Size::open},
      {"LinuxCNC", "probe.txt", lines("{x} {y} {z} 0 0 0 0 0 0\n"), Size::open},
      {"named columns", "map.csv", "N;Y;X;Z;comment\n" + lines("1;{y};{x};{z};ok\n"), Size::open},
      {"a list of probes", "a_Z.txt", lines("([{x} {y}]/T=0.100) #51={z}\n"), Size::open},
  };
}

MeasuredFile read(const Format& format, const std::string& text, Diagnostics& diagnostics) {
  MeasuredOptions options;
  if (format.size == Size::only_area) options.area = std::array<double, 4>{0, 0, 30, 20};
  return read_measured(text, format.file, options, diagnostics);
}

std::vector<Point> points_of(const MeasuredFile& file) {
  const auto all = right_points();
  std::vector<Point> out;
  for (const MeasuredHeight& h : file.heights) {
    if (!h.height) continue;
    // A height of a list belongs to its variable; the position beside it is for the reader.
    const auto same = std::find_if(all.begin(), all.end(),
                                   [&](const Point& p) { return std::abs(p.z - *h.height) < 1e-6; });
    if (h.variable && same != all.end())
      out.push_back(*same);
    else if (h.at)
      out.push_back({(*h.at)[0], (*h.at)[1], *h.height});
  }
  return out;
}

bool is_right(const Point& p) {
  const auto all = right_points();
  return std::any_of(all.begin(), all.end(), [&](const Point& r) {
    return std::abs(p.x - r.x) < 1e-6 && std::abs(p.y - r.y) < 1e-6 && std::abs(p.z - r.z) < 1e-6;
  });
}

bool has_right_height(const Point& p) {
  const auto all = right_points();
  return std::any_of(all.begin(), all.end(), [&](const Point& r) { return std::abs(p.z - r.z) < 1e-6; });
}

struct Span {
  std::size_t start = 0, end = 0;
};

std::vector<Span> spans_of_lines(const std::string& text) {
  std::vector<Span> out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = text.find('\n', i) + 1;
    out.push_back({i, end});
    i = end;
  }
  return out;
}

/// Numbers, but for digits of words such as "num0" and "G54".
std::vector<Span> spans_of_numbers(const std::string& text) {
  const auto is_of_number = [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-'; };
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  std::vector<Span> out;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i;
    while (end < text.size() && is_of_number(text[end])) ++end;
    if (end > i && (i == 0 || !is_letter(text[i - 1]))) out.push_back({i, end});
    i = std::max(end, i + 1);
  }
  return out;
}

/// A line of the text without heights: one of the map's head, or with the offset of a log.
bool is_of_head(const std::string& text, std::size_t at) {
  const std::size_t start = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;
  const std::string line = text.substr(start, text.find('\n', start) - start);
  for (const Point& p : right_points())
    for (const double z : {p.z, p.z - 30.0})
      if (line.find(fmt::format("{:.4f}", z)) != std::string::npos) return false;
  return true;
}

class Damage : public testing::TestWithParam<std::size_t> {
 protected:
  const Format format_ = formats()[GetParam()];
  std::mt19937 random_{static_cast<std::mt19937::result_type>(GetParam() + 1)};

  std::size_t below(std::size_t count) { return random_() % count; }

  /// Either an error, or points of which at most `changed` are not right ones and `lost` are missing.
  void check(const std::string& text, std::size_t changed, std::size_t lost, const std::string& what) {
    Diagnostics diagnostics;
    const MeasuredFile file = read(format_, text, diagnostics);
    if (diagnostics.has_errors()) {
      EXPECT_FALSE(diagnostics.list().front().message.empty());
      ++refused_;
      return;
    }
    const auto points = points_of(file);
    const auto wrong = static_cast<std::size_t>(
        std::count_if(points.begin(), points.end(), [](const Point& p) { return !is_right(p); }));
    EXPECT_LE(wrong, changed) << format_.name << ": " << what << "\n" << text;
    EXPECT_LE(points.size(), right_points().size()) << format_.name << ": " << what << "\n" << text;
    EXPECT_GE(points.size() + lost, right_points().size()) << format_.name << ": " << what << "\n" << text;
  }
  int refused_ = 0;
};

TEST_P(Damage, TheRightFileIsRead) {
  Diagnostics diagnostics;
  const auto points = points_of(read(format_, format_.text, diagnostics));
  for (const Diagnostic& d : diagnostics.list()) ADD_FAILURE() << format_.name << ": " << to_string(d);
  EXPECT_EQ(points.size(), right_points().size()) << format_.name;
  for (const Point& p : points) EXPECT_TRUE(is_right(p)) << format_.name;
}

TEST_P(Damage, ALineIsMissing) {
  const auto all = spans_of_lines(format_.text);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (format_.size == Size::only_area && !is_of_head(format_.text, all[k].start)) continue;
    std::string text = format_.text;
    text.erase(all[k].start, all[k].end - all[k].start);
    check(text, 0, format_.size == Size::open ? 1 : 0, fmt::format("without line {}", k + 1));
  }
}

TEST_P(Damage, ALineIsThereTwice) {
  const auto all = spans_of_lines(format_.text);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (format_.size == Size::only_area && !is_of_head(format_.text, all[k].start)) continue;
    std::string text = format_.text;
    text.insert(all[k].start, text.substr(all[k].start, all[k].end - all[k].start));
    Diagnostics diagnostics;
    const auto points = points_of(read(format_, text, diagnostics));
    if (diagnostics.has_errors()) continue;
    EXPECT_LE(points.size(), right_points().size() + (format_.size == Size::open ? 1 : 0)) << text;
    for (const Point& p : points) EXPECT_TRUE(is_right(p)) << format_.name << "\n" << text;
  }
}

TEST_P(Damage, TheFileIsCutOff) {
  if (format_.size == Size::only_area) return;
  // A first line alone may be anything, also a list of one point.
  const std::size_t first = format_.text.find('\n') + 2;
  for (int trial = 0; trial < kTrials; ++trial) {
    const std::size_t at = first + below(format_.text.size() - 1 - first);
    // Of the last number some digits may be missing (of Duet's it may be a 0: not measured); lists without
    // size end anywhere.
    check(format_.text.substr(0, at), 1, format_.size == Size::open ? right_points().size() : 1,
          fmt::format("of {} bytes", at));
  }
}

TEST_P(Damage, ANumberIsNone) {
  const auto all = spans_of_numbers(format_.text);
  constexpr std::array<const char*, 8> kWords{"nan", "inf", "-inf", "", "1x", "--1", "1.2.3", "?"};
  for (int trial = 0; trial < kTrials; ++trial) {
    const Span number = all[below(all.size())];
    const char* word = kWords[below(kWords.size())];
    std::string text = format_.text;
    text.replace(number.start, number.end - number.start, word);
    // The numbers of a comment and of columns beside X, Y and Z have no effect. A height without a value may
    // follow in another file, where a list of probes has none.
    check(text, 0, format_.size == Size::open && word[0] == '\0' ? 1 : 0,
          fmt::format("\"{}\" at byte {}", word, number.start));
  }
  EXPECT_GT(refused_, kTrials / 3) << format_.name;
}

TEST_P(Damage, ANumberIsAnother) {
  const auto all = spans_of_numbers(format_.text);
  constexpr std::array<double, 6> kChanges{1.0, -1.0, 0.5, -2.0, 10.0, 1000.0};
  for (int trial = 0; trial < kTrials; ++trial) {
    const Span number = all[below(all.size())];
    std::string text = format_.text;
    const std::string was = text.substr(number.start, number.end - number.start);
    const double value = std::strtod(was.c_str(), nullptr) + kChanges[below(kChanges.size())];
    const bool in_head = is_of_head(text, number.start);
    text.replace(number.start, number.end - number.start, fmt::format("{:.4f}", value));
    const std::string what = fmt::format("{:.4f} for {} at byte {}", value, was, number.start);
    if (!in_head) {
      // In a line of heights: one point is another one, or was without contact.
      check(text, 1, 1, what);
      continue;
    }
    // The area of a map or the offset of a log: other positions, or heights that are all other ones.
    Diagnostics diagnostics;
    const auto points = points_of(read(format_, text, diagnostics));
    if (diagnostics.has_errors()) continue;
    EXPECT_EQ(points.size(), right_points().size()) << format_.name << ": " << what;
    const bool is_offset = text.find("WCO:") != std::string::npos;
    for (const Point& p : points)
      EXPECT_TRUE(is_offset || has_right_height(p)) << format_.name << ": " << what;
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, Damage, testing::Range(std::size_t{0}, formats().size()));

}  // namespace
}  // namespace kerf
