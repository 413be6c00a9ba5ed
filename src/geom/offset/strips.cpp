// Bands around paths. All parts of a strip run counter-clockwise, so that winding numbers add up: common
// borders cancel, also where the path intersects itself. Where a path comes back to itself so often that its
// strips intersect in too many points, it is divided, and the bands of its pieces are united two by two.
#include "strips.h"

namespace kerf::region_detail {
namespace {

constexpr std::size_t kLeaf = 16;  // runs of an undivided piece

bool covered(const Winding& w) { return w.of[0] > 0; }

/// Adds strips, corners and ends to a set of edges.
class Strips {
 public:
  Strips(EdgeSet& set, const Chain& chain, double width) : set_(set), chain_(chain), width_(width) {}
  /// The strips of some runs, each with the corner after it.
  void add(std::size_t first, std::size_t last);
  void add_ends();

 private:
  void run(const Run& run);
  void ring(const Run& run, double outer, double inner);
  void corner(const Run& run, const Run& next);
  void sector(const Run& run, Point2 from, Point2 to, const Corner& corner, const CornerSources& sources);

  EdgeSet& set_;
  const Chain& chain_;
  double width_;
};

/// The strip of an arc, between two circles; where its radius is below the width, also the sector beyond the
/// centre.
void Strips::ring(const Run& run, double outer, double inner) {
  const bool ccw = run.turn > 0.0;
  // Outwards, at both ends of the arc run counter-clockwise.
  const Point2 a = ccw ? run.right_of_start() : -run.right_of_end();
  const Point2 b = ccw ? run.right_of_end() : -run.right_of_start();
  const Point2 c = run.circle_centre();
  const std::uint32_t seam = source_of(run, Beside::none);
  set_.start_chain(c + outer * a);
  set_.belongs_to(source_of(run, ccw ? Beside::right : Beside::left));
  set_.arc_to(c + outer * a, c + outer * b, c, outer, 1.0);
  set_.belongs_to(seam);
  if (inner > set_.weld()) {
    set_.line_to(c + inner * b);
    set_.belongs_to(source_of(run, ccw ? Beside::left : Beside::right));
    set_.arc_to(c + inner * b, c + inner * a, c, inner, -1.0);
    set_.belongs_to(seam);
  } else {
    set_.line_to(c);
    set_.belongs_to(source_of(run, Beside::second_seam));
  }
  set_.close();
  if (inner >= -set_.weld()) return;
  set_.belongs_to(seam);
  set_.start_chain(c);
  set_.line_to(c + inner * a);
  set_.belongs_to(source_of(run, Beside::second_seam));
  set_.arc_to(c + inner * a, c + inner * b, c, -inner, 1.0);
  set_.close();
}

void Strips::run(const Run& run) {
  if (run.is_arc()) return ring(run, run.radius + width_, run.radius - width_);
  const Point2 aside = width_ * run.right_of_start();
  set_.start_chain(run.from + aside);
  set_.belongs_to(source_of(run, Beside::right));
  set_.line_to(run.to + aside);
  set_.belongs_to(source_of(run, Beside::none));
  set_.line_to(run.to - aside);
  set_.belongs_to(source_of(run, Beside::left));
  set_.line_to(run.from - aside);
  set_.belongs_to(source_of(run, Beside::none));
  set_.close();
}

/// Counter-clockwise about the end of a run, between two unit directions.
void Strips::sector(const Run& run, Point2 from, Point2 to, const Corner& corner,
                    const CornerSources& sources) {
  set_.belongs_to(source_of(run, Beside::none));
  set_.start_chain(run.to);
  set_.line_to(run.to + width_ * from);
  add_corner(set_, run.to, width_, from, to, 1.0, corner, sources);
  set_.belongs_to(source_of(run, Beside::none));
  set_.close();
}

void Strips::corner(const Run& run, const Run& next) {
  const Point2 before = run.right_of_end(), after = next.right_of_start();
  if (width_ * norm(after - before) <= set_.weld()) return;
  if (turn_between(run, next) > 0.0)
    return sector(run, before, after, chain_.right,
                  corner_sources(run, next, Beside::right, Beside::right_corner));
  // Counter-clockwise from the next run to this one.
  CornerSources sources = corner_sources(run, next, Beside::left, Beside::left_corner);
  std::swap(sources.before, sources.after);
  sector(run, -after, -before, chain_.left, sources);
}

void Strips::add(std::size_t first, std::size_t last) {
  const std::vector<Run>& runs = chain_.runs;
  for (std::size_t i = first; i < last; ++i) {
    run(runs[i]);
    if (i + 1 < runs.size())
      corner(runs[i], runs[i + 1]);
    else if (chain_.closed)
      corner(runs[i], runs.front());
  }
}

void Strips::add_ends() {
  if (chain_.closed || !chain_.round_ends || chain_.runs.empty()) return;
  const Run &start = chain_.runs.front(), &end = chain_.runs.back();
  const auto seam = [](const Run& run) { return CornerSources{source_of(run, Beside::none), 0, 0}; };
  sector(end, end.right_of_end(), -end.right_of_end(), {}, seam(end));
  Run back = start;  // whose end is the path's start
  back.to = start.from;
  sector(back, -start.right_of_start(), start.right_of_start(), {}, seam(back));
}

/// The bands of pieces of a chain.
class Pieces {
 public:
  Pieces(const Chain& chain, double width, const RegionOptions& options, double weld,
         Diagnostics& diagnostics)
      : chain_(chain), width_(width), options_(options), weld_(weld), diagnostics_(diagnostics) {}
  std::optional<Traced> of(std::size_t first, std::size_t last) {
    if (last - first > kLeaf) {
      const std::size_t between = first + (last - first) / 2;
      const auto one = of(first, between);
      if (!one) return std::nullopt;
      const auto other = of(between, last);
      if (!other) return std::nullopt;
      return unite(*one, *other, options_, weld_, diagnostics_);
    }
    EdgeSet set(weld_);
    Strips strips(set, chain_, width_);
    strips.add(first, last);
    if (first == 0) strips.add_ends();
    const auto outlined = arrange(set, options_, diagnostics_, covered);
    if (!outlined) return std::nullopt;
    report(options_.progress, static_cast<double>(last) / static_cast<double>(chain_.runs.size()));
    return traced(*outlined, weld_);
  }

 private:
  const Chain& chain_;
  double width_;
  const RegionOptions& options_;
  double weld_;
  Diagnostics& diagnostics_;
};

}  // namespace

std::optional<Traced> band_of(const Chain& chain, double width, const RegionOptions& options, double weld,
                              Diagnostics& diagnostics) {
  EdgeSet set(weld);
  Strips strips(set, chain, width);
  strips.add(0, chain.runs.size());
  strips.add_ends();
  Attempts attempts(set, options, kModerate);
  if (const auto outlined = attempt(attempts, covered)) return traced(*outlined, weld);
  if (attempts.exceeded()) return Pieces(chain, width, options, weld, diagnostics).of(0, chain.runs.size());
  attempts.fail(diagnostics);
  return std::nullopt;
}

std::optional<Traced> unite(const Traced& first, const Traced& second, const RegionOptions& options,
                            double weld, Diagnostics& diagnostics) {
  EdgeSet set(weld);
  add_traced(set, first, 0);
  add_traced(set, second, 0);
  const auto outlined = arrange(set, options, diagnostics, covered);
  if (!outlined) return std::nullopt;
  return traced(*outlined, weld);
}

}  // namespace kerf::region_detail
