// Random outlines, cut and checked: corner count, kinds of neighbours, radii and sizes are drawn at random.
//   property_outline [COUNT] [SEED]
// Prints the seed, and each outline that fails as an outline file that `kerf outline` reads. Exit status 1 if
// any does.
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <random>

#include "outline_checks.h"

#include "kerf/drawing/outline_files.h"

namespace {

using namespace kerf;

class Drawer {
 public:
  explicit Drawer(std::uint64_t seed) : random_(seed) {}
  NamedOutline outline();
  double in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  bool chance(double probability) { return in(0.0, 1.0) < probability; }

 private:
  std::mt19937_64 random_;
};

NamedOutline Drawer::outline() {
  const double sizes[] = {5.0, 30.0, 100.0, 1000.0}, radii[] = {0.5, 2.0, 16.0};
  const double size = sizes[static_cast<int>(in(0.0, 4.0))], largest = radii[static_cast<int>(in(0.0, 3.0))];
  const int corners = 2 + static_cast<int>(in(0.0, 10.0));
  const bool closed = corners > 2 && chance(0.5);
  const auto request = [&] {
    return mm(chance(0.15) ? 0.0 : (chance(0.5) ? 1.0 : -1.0) * in(0.02, largest));
  };
  const auto random_point = [&] { return Point2{in(-size, size), in(-size, size)}; };
  Outline made;
  made.start = random_point();
  CornerRequests requests{closed ? request() : Length()};
  for (int i = 1; i < corners + (closed ? 1 : 0); ++i) {
    Segment segment;
    const Point2 from = made.point(made.segments.size());
    segment.to = i == corners ? made.start : random_point();
    requests.push_back(i < corners - (closed ? 0 : 1) ? request() : Length());
    if (chance(0.5)) {  // from nearly flat arcs to nearly whole circles
      const double bulge = (chance(0.5) ? 1.0 : -1.0) * std::exp(in(-5.0, 2.0));
      const Point2 half = 0.5 * (segment.to - from);
      segment.via = from + half + bulge * Point2{half.y, -half.x};
    }
    made.segments.push_back(segment);
  }
  return {"", made, requests};
}

std::string file_text(const NamedOutline& drawn) {
  const Outline& outline = drawn.outline;
  std::size_t i = 0;
  std::string text =
      fmt::format("{{\"outlines\": [{{\"first\": {{\"at\": [{}, {}], \"corner\": {}}}, \"segments\": [",
                  outline.start.x, outline.start.y, drawn.corners[i++].mm());
  const char* comma = "";
  for (const Segment& s : outline.segments) {
    text +=
        fmt::format("{}{{\"to\": [{}, {}], \"corner\": {}", comma, s.to.x, s.to.y, drawn.corners[i++].mm());
    if (s.via) text += fmt::format(", \"via\": [{}, {}]", s.via->x, s.via->y);
    text += "}";
    comma = ", ";
  }
  return text + "]}]}";
}

}  // namespace

int main(int argc, char** argv) {
  const long count = argc > 1 ? std::atol(argv[1]) : 100000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : std::random_device()();
  fmt::print("{} random outlines, seed {}\n", count, seed);
  Drawer drawer(seed);
  long failed = 0, corners[3] = {};
  for (long i = 0; i < count && failed < 20; ++i) {
    const NamedOutline drawn = drawer.outline();
    const Outline& outline = drawn.outline;
    const bool even = drawer.chance(0.25);
    CornerOptions options;
    options.tolerance.weld = mm(1e-8);
    options.sharing = even ? EdgeSharing::even : EdgeSharing::in_order;
    Diagnostics diagnostics;
    const auto cut = cut_corners(outline, drawn.corners, options, diagnostics);
    const std::string wrong = cut ? outline_checks::wrong_with_cut(outline, drawn.corners, *cut, even)
                                  : "refused: " + to_string(diagnostics.list()[0]);
    if (cut)
      for (const CornerReport& report : cut->corners) ++corners[static_cast<int>(report.outcome)];
    if (wrong.empty()) continue;
    ++failed;
    fmt::print("outline {}{}: {}\n  {}\n", i, even ? " (even)" : "", wrong, file_text(drawn));
  }
  fmt::print("corners: {} smoothed, {} enlarged, {} left sharp; {} outlines failed\n", corners[0], corners[1],
             corners[2], failed);
  return failed == 0 ? 0 : 1;
}
