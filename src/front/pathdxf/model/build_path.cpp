// From the elements of a drawn path to its operations in the order of travel.
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "base/codes/pathdxf.h"
#include "base/number.h"
#include "front/pathdxf/model/library.h"
#include "front/pathdxf/model/values.h"
#include "front/pathdxf/model/walk.h"
#include "front/pathdxf/text/nearly.h"

namespace kerf::pathdxf {
namespace {

constexpr int kMaxNesting = 10;                  // levels of sub-paths below the main path
constexpr std::size_t kMaxBuiltPaths = 100'000;  // with different values of variables
constexpr double kEmbeddingLength = 1e-3;        // mm, by which an embedding may differ from its sub-path
constexpr double kSameCentre = 1e-3;             // mm, of circles around one centre
constexpr double kUnnumbered = 9998.0;           // order of elements without N
constexpr double kDrillOrder = -1e6;             // drilled holes first, then helices by radius
constexpr double kDefaultHelix = 4.0;            // largest diameter of a helix in tool diameters

// Ranks of elements that continue a path at the same point.
constexpr int kDrillRank = 1, kHelixRank = 2, kEmbeddingRank = 3, kMillRank = 4, kSweepRank = 5;

constexpr Bilingual kSweepHeight{"S must be above T", "S muss über T liegen"};
constexpr Bilingual kBelowRaised{
    "S={} is below T+H={} of sub-path {}: rapids would go through its material",
    "S={} liegt unter T+H={} von Unterpfad {}: Leerfahrten gingen durch sein Material"};
constexpr Bilingual kAtRaised{
    "S={} is the height of the top of sub-path {} (T+H): rapids touch its material",
    "S={} ist die Höhe der Oberseite von Unterpfad {} (T+H): Leerfahrten berühren sein Material"};
constexpr Bilingual kBelowTop{"{}={} must not be larger than T={}", "{}={} darf nicht größer als T={} sein"};
constexpr Bilingual kMarkAboveBottom{"D={} must be larger than B={}", "D={} muss größer als B={} sein"};
constexpr Bilingual kNoMaterial{"M value missing at the start of path {}",
                                "M-Wert fehlt am Start von Pfad {}"};
constexpr Bilingual kSuffix{"R={} must not contain / or \\", "R={} darf / und \\ nicht enthalten"};
constexpr Bilingual kFeedAssumed{"no feed rate given; assuming {} mm/min",
                                 "kein Vorschub angegeben; {} mm/min angenommen"};
constexpr Bilingual kFeedHint{"specify it as F at the start of the path, or with /f",
                              "Angabe als F am Start des Pfades oder mit /f"};
constexpr Bilingual kSweepAssumed{"no sweep height given; assuming T+O = {} mm",
                                  "keine Sweephöhe angegeben; T+O = {} mm angenommen"};
constexpr Bilingual kSweepHint{"specify it as S at the start of the path, or with /s",
                               "Angabe als S am Start des Pfades oder mit /s"};
constexpr Bilingual kLineType{"Line type {} not supported", "Linientyp {} nicht unterstützt"};
constexpr Bilingual kTooSmall{"Diameter {} is smaller than O={}", "Durchmesser {} ist kleiner als O={}"};
constexpr Bilingual kTooLarge{"Diameter {} of helix circle is larger than A={}",
                              "Durchmesser {} des Helixkreises ist größer als A={}"};
constexpr Bilingual kTooLargeHint{"mill it as arcs, or specify a larger A at the start of the path",
                                  "aus Bögen zusammensetzen oder größeres A am Start des Pfades angeben"};
constexpr Bilingual kCore{
    "the helical circle of diameter {} leaves a loose core of diameter {}",
    "Der Helixkreis mit Durchmesser {} lässt einen losen Kern mit Durchmesser {} stehen"};
constexpr Bilingual kCoreHint{"draw smaller circles around the same centre, which are milled first",
                              "Kleinere Kreise um denselben Mittelpunkt zeichnen; sie werden zuerst gefräst"};
constexpr Bilingual kNoInteger{"N value '{}' is not an integer and is ignored",
                               "N-Wert '{}' ist keine ganze Zahl und wird ignoriert"};
constexpr Bilingual kNoMore{"No more segments found after location {}",
                            "Keine weiteren Segmente nach Punkt {} gefunden"};
constexpr Bilingual kNearestEnd{"the nearest open end is at {}, {} mm away",
                                "Das nächste offene Ende liegt bei {}, {} mm entfernt"};
constexpr Bilingual kNothingLeft{
    "all elements of the path layer are used already; the end marker is at {}",
    "Alle Elemente des Pfad-Layers sind bereits verwendet; die Endmarkierung liegt bei {}"};
constexpr Bilingual kUnreached{"{} segments (e.g. this one here) not reached - maybe N value is missing",
                               "{} Segmente (z.B. dieses) nicht erreicht - vielleicht fehlt ein N-Wert"};
constexpr Bilingual kNotAtEnd{
    "End marker not near end of last traversed segment, but at {} - add sweep",
    "Endmarkierung liegt nicht am Ende des letzten Segments, sondern bei {} - Sweep ergänzen"};
constexpr Bilingual kOverlap{"this {} lies on another one of path {}",
                             "{} liegt auf einem anderen Element von Pfad {}"};
constexpr Bilingual kNoSubpath{">... missing", ">... fehlt"};
constexpr Bilingual kNoPathName{"'>{}' is not a valid path name", "'>{}' ist kein gültiger Pfadname"};
constexpr Bilingual kForbidden{"Sub-path {} is forbidden in path {} by the restriction {}",
                               "Unterpfad {} ist in Pfad {} durch die Einschränkung {} verboten"};
constexpr Bilingual kNoEffect{"E={} has no effect: '{}' does not match path {}",
                              "E={} hat keine Wirkung: '{}' passt nicht zu Pfad {}"};
constexpr Bilingual kNotFound{"Could not find path {} in file(s) {}",
                              "Pfad {} nicht gefunden in Datei(en) {}"};
constexpr Bilingual kNotFoundHint{
    "searched: the folder of {} and the folders of /d, in files whose name contains a pattern for the path",
    "Durchsucht: das Verzeichnis von {} und die von /d, Dateien mit passendem Muster im Namen"};
constexpr Bilingual kUnusable{"Path {} has errors and cannot be embedded",
                              "Pfad {} ist fehlerhaft und kann nicht eingebettet werden"};
constexpr Bilingual kTooDeep{"Nesting depth deeper than 9 levels at path {}",
                             "Schachtelung tiefer als 9 Ebenen bei Pfad {}"};
constexpr Bilingual kItself{"Path {} contains itself", "Pfad {} enthält sich selbst"};
constexpr Bilingual kTooMany{"more than {} sub-paths with different values of variables",
                             "mehr als {} Unterpfade mit verschiedenen Variablenwerten"};
constexpr Bilingual kSize{"Subpath size {} is not equal to size {} in referenced path {}",
                          "Unterpfadgröße {} ungleich Größe {} im referenzierten Pfad {}"};
constexpr Bilingual kDifferent{"{}={} at subpath {} is different from {}={} in referenced path",
                               "{}={} bei Unterpfad {} weicht ab von {}={} im referenzierten Pfad"};
constexpr Bilingual kMissingHere{"{} value missing at the embedding of {} or in its path",
                                 "{}-Wert fehlt bei der Einbettung von {} oder in deren Pfad"};
constexpr Bilingual kInherited{"{} not specified at the embedding of {}; the values of path {} are used",
                               "{} fehlt bei der Einbettung von {}; es gelten die Werte von Pfad {}"};
constexpr Bilingual kAboveTop{"T={} at path is less than T={} at subpath {}",
                              "T={} am Pfad ist kleiner als T={} bei Unterpfad {}"};
std::string number(double value) { return number_text(value, 6); }

/// Depth and comment of an element, its values before those of its path.
struct EmbeddingDraft {
  std::string path;
  std::optional<double> tool, top;
  std::optional<std::string> material;
  double raise = 0.0;
  std::vector<Parameter> variables;
};
struct MillDraft {
  MillSegment segment;
  std::optional<double> infeed, first_depth;  // used where the segment is the first of its chain
};
struct Draft {
  const Element* element = nullptr;
  Origin where;
  std::variant<MillDraft, Drill, Helix, Sweep, EmbeddingDraft> what;
};

std::optional<double> either(const std::optional<double>& own, const std::optional<double>& inherited) {
  return own ? own : inherited;
}

}  // namespace

/// Builds one path.
class PathAssembly {
 public:
  PathAssembly(PathBuilder& builder, const Library::Found& found, PathRole role, const Variables& variables)
      : builder_(builder),
        report_(builder.library_.report()),
        options_(builder.library_.options()),
        drawing_(*found.drawing),
        source_(*found.path),
        role_(role),
        variables_(variables) {}

  /// Null where anything is wrong.
  std::shared_ptr<const Path> assemble();

 private:
  void read_start();
  void check_heights(const Values& values, std::initializer_list<char> depths);
  void read_restriction(const Values& values);
  const Restriction* restriction() const;
  void read_probes();
  void draft(const Element& element);
  void draft_circle(const Element& element, const Origin& where);
  void add(const Element& element, Draft draft, double order, int rank);
  double order_of(const Values& values);
  MillingValues milling_values(const Values& values, Depth depth);
  MillDraft mill_draft(const Element& element, const Values& values);
  EmbeddingDraft embedding_draft(const Values& values);
  void order_drafts();
  void report_gap(const Walk& walk, const Origin& last, bool at_end);
  void report_overlaps();
  void warn_of_cores();
  void append(const Draft& draft, bool reversed);
  void append_mill(const MillDraft& mill, bool reversed);
  void embed(const Draft& draft, bool reversed);
  std::shared_ptr<const Path> find_subpath(const EmbeddingDraft& embedding, const Origin& where);
  void check_embedding(const EmbeddingDraft& embedding, const Path& sub, double size, const Origin& where);
  void check_rapids(const Path& sub, double raise, const Origin& where);
  void check_number(char key, const std::optional<double>& here, double there, const Path& sub,
                    const Origin& where);

  PathBuilder& builder_;
  Report& report_;
  const PathdxfOptions& options_;
  const DrawingPaths& drawing_;
  const PathDrawing& source_;
  PathRole role_;
  const Variables& variables_;

  std::shared_ptr<Path> path_ = std::make_shared<Path>();
  // Values at the start marker that elements inherit.
  std::optional<double> b_, d_, infeed_, bar_length_, bar_distance_, first_depth_, cycle_from_;
  std::optional<Restriction> restriction_;  // E
  double largest_helix_ = 0.0, probe_feed_ = 0.0;
  bool in_chain_ = false;  // the last operation is a chain that the next cut continues
  std::vector<Link> links_;
  std::vector<Draft> drafts_;
};

std::shared_ptr<const Path> PathAssembly::assemble() {
  const std::size_t attempts = report_.attempts();
  path_->name = source_.name;
  path_->name_in_file = name_in_file(source_, drawing_);
  path_->where = drawing_.origin(*source_.start);
  path_->start = source_.start->centre;
  path_->end = source_.end->centre;
  read_start();
  if (path_->tool > 0.0 && path_->top > 0.0) {
    read_probes();
    for (const Element& element : source_.elements) draft(element);
    order_drafts();
    warn_of_cores();
  }
  return report_.attempts() == attempts ? path_ : nullptr;
}

void PathAssembly::check_heights(const Values& values, std::initializer_list<char> depths) {
  if (path_->top <= 0.0) return;
  if (const auto s = values.number('S'); s && !above(*s, path_->top))
    report_.error(codes::pathdxf_value_range, values.where(), kSweepHeight);
  for (const char key : depths)
    if (const auto depth = values.number(key); depth && !at_least(path_->top, *depth))
      report_.error(codes::pathdxf_value_range, values.where(), kBelowTop, std::string(1, key),
                    number(*depth), number(path_->top));
}

void PathAssembly::read_start() {
  const Values v(drawing_.text_of(*source_.start), "FBDCISTOMPUZAWRE:", variables_, path_->where, report_);
  const auto tool = v.positive('O'), top = v.positive('T');
  require(tool, 'O', path_->where, report_);
  require(top, 'T', path_->where, report_);
  path_->tool = tool.value_or(0.0);
  path_->top = path_->highest = top.value_or(0.0);
  path_->material = v.text('M').value_or("");
  if (path_->material.empty())
    report_.warning(codes::pathdxf_material, path_->where, kNoMaterial, path_->name);
  path_->suffix = v.text('R').value_or("");
  if (path_->suffix.find_first_of("/\\") != std::string::npos)
    report_.error(codes::pathdxf_value_range, path_->where, kSuffix, path_->suffix);
  read_restriction(v);
  const auto feed = v.positive('F');
  path_->feed = feed ? *feed : options_.feed.value_or(kDefaultPathdxfFeed).mm_per_min();
  if (!feed && !options_.feed && role_ == PathRole::main) {
    report_.note(codes::pathdxf_assumed, path_->where, kFeedAssumed, number(path_->feed));
    report_.hint(kFeedHint);
  }
  const auto given_sweep = role_ == PathRole::main && options_.rapid_height
                               ? std::optional(options_.rapid_height->mm())
                               : std::nullopt;
  const auto sweep = either(v.number('S'), given_sweep);
  path_->sweep = sweep.value_or(path_->top + path_->tool);
  if (!sweep && role_ == PathRole::main) {
    report_.note(codes::pathdxf_assumed, path_->where, kSweepAssumed, number(path_->sweep));
    report_.hint(kSweepHint);
  }
  b_ = v.number('B');
  d_ = v.number('D');
  infeed_ = v.positive('I');
  bar_length_ = v.positive('P');
  bar_distance_ = v.positive('U');
  first_depth_ = v.positive('W');
  cycle_from_ = v.positive('C');
  largest_helix_ = v.positive('A').value_or(kDefaultHelix * path_->tool);
  const Feed probing = options_.probe_feed.value_or(options_.feed.value_or(mm_per_min(path_->feed)));
  probe_feed_ = v.positive('Z').value_or(probing.mm_per_min());
  check_heights(v, {'B', 'D'});
  const bool is_given = given_sweep && !v.number('S');
  if (is_given && path_->top > 0.0 && !above(path_->sweep, path_->top))
    report_.error(codes::pathdxf_value_range, v.where(), kSweepHeight);
  if (b_ && d_ && !above(*d_, *b_))
    report_.error(codes::pathdxf_value_range, path_->where, kMarkAboveBottom, number(*d_), number(*b_));
}

void PathAssembly::read_restriction(const Values& values) {
  const auto text = values.text('E');
  if (!text || text->empty()) return;
  restriction_ = Restriction::parse(*text, "E", path_->where, report_);
  if (!restriction_ || restriction_->applies_to(path_->name)) return;
  report_.warning(codes::pathdxf_restriction, path_->where, kNoEffect, *text,
                  text->substr(0, text->find(':')), path_->name);
  restriction_.reset();
}

/// The restriction that decides what this path may embed; null: none.
const Restriction* PathAssembly::restriction() const {
  if (restriction_) return &*restriction_;
  for (const Restriction& r : builder_.library_.restrictions())
    if (r.applies_to(path_->name)) return &r;
  return nullptr;
}

void PathAssembly::read_probes() {
  path_->has_probes = !source_.probes.empty();
  for (const Element& element : source_.probes) {
    const Origin where = drawing_.origin(element);
    const Values v(drawing_.text_of(element), "TLZH", variables_, where, report_);
    path_->probes.push_back({element.centre, v.positive('T').value_or(path_->top),
                             v.number('H').value_or(0.0), v.positive('Z').value_or(probe_feed_),
                             v.text('L').value_or(""), where});
  }
}

double PathAssembly::order_of(const Values& values) {
  const auto text = values.text('N');
  if (!text || text->empty()) return kUnnumbered;
  const auto n = parse_value(*text);
  if (n && *n == std::floor(*n)) return *n;
  report_.warning(codes::pathdxf_value_range, values.where(), kNoInteger, *text);
  return kUnnumbered;
}

MillingValues PathAssembly::milling_values(const Values& values, Depth depth) {
  MillingValues m;
  m.depth = depth;
  m.feed = values.positive('F').value_or(path_->feed);
  m.b = either(values.number('B'), b_);
  m.d = either(values.number('D'), d_);
  m.infeed = either(values.positive('I'), infeed_);
  m.comment = values.text('Q').value_or("");
  check_heights(values, {'B', 'D'});
  if (depth != Depth::bars) return m;
  const auto length = either(values.positive('P'), bar_length_);
  const auto distance = either(values.positive('U'), bar_distance_);
  require(length, 'P', values.where(), report_);
  require(distance, 'U', values.where(), report_);
  m.bar_length = length.value_or(0.0);
  m.bar_distance = distance.value_or(0.0);
  return m;
}

MillDraft PathAssembly::mill_draft(const Element& element, const Values& values) {
  MillDraft out;
  MillSegment& s = out.segment;
  s.is_arc = element.shape == Shape::arc;
  s.start = element.start;
  s.end = element.end;
  s.centre = element.centre;
  s.radius = element.radius;
  s.start_angle = element.start_angle;
  s.turn = element.turn;
  s.values = milling_values(values, element.kind == LineKind::mill   ? Depth::full
                                    : element.kind == LineKind::mark ? Depth::mark
                                                                     : Depth::bars);
  s.sweep_height = values.number('S');
  s.where = values.where();
  out.infeed = either(values.positive('I'), infeed_);
  out.first_depth = either(values.positive('W'), first_depth_);
  values.positive('C');
  return out;
}

EmbeddingDraft PathAssembly::embedding_draft(const Values& values) {
  EmbeddingDraft e;
  e.path = values.text('>').value_or("");
  if (e.path.empty()) {
    report_.error(codes::pathdxf_embedding, values.where(), kNoSubpath);
  } else if (!builder_.library_.names().in_value(e.path)) {
    report_.error(codes::pathdxf_embedding, values.where(), kNoPathName, e.path);
    e.path.clear();
  }
  e.tool = values.positive('O');
  e.top = values.positive('T');
  e.material = values.text('M');
  e.raise = values.number('H').value_or(0.0);
  e.variables = values.variables();
  return e;
}

void PathAssembly::add(const Element& element, Draft draft, double order, int rank) {
  draft.element = &element;
  const bool is_point = element.shape == Shape::circle;
  links_.push_back(
      {is_point ? element.centre : element.start, is_point ? element.centre : element.end, order, rank});
  drafts_.push_back(std::move(draft));
}

void PathAssembly::draft(const Element& element) {
  const Origin where = drawing_.origin(element);
  if (element.shape == Shape::circle) return draft_circle(element, where);
  const ParameterText* text = drawing_.text_of(element);
  switch (element.kind) {
    case LineKind::mill:
    case LineKind::mark:
    case LineKind::bars: {
      const Values v(text, "FBDSNQICWPU", variables_, where, report_);
      return add(element, {nullptr, where, mill_draft(element, v)}, order_of(v), kMillRank);
    }
    case LineKind::embedding: {
      const Values v(text, ">TOMNH:", variables_, where, report_);
      return add(element, {nullptr, where, embedding_draft(v)}, order_of(v), kEmbeddingRank);
    }
    case LineKind::sweep: {
      const Values v(text, "SN", variables_, where, report_);
      check_heights(v, {});
      return add(element, {nullptr, where, Sweep{element.end, v.number('S')}}, order_of(v), kSweepRank);
    }
    case LineKind::skipped:
      return add(element, {nullptr, where, Sweep{element.end, std::nullopt}}, kUnnumbered, kSweepRank);
    case LineKind::marker:
    case LineKind::unknown: break;
  }
  report_.error(codes::pathdxf_line_type, where, kLineType, drawing_.linetypes[element.linetype]);
}

/// Drilled holes and helices.
void PathAssembly::draft_circle(const Element& element, const Origin& where) {
  const bool is_drill = near(element.radius, path_->tool / 2.0);
  const bool is_mark = element.kind == LineKind::mark, has_bars = element.kind == LineKind::bars;
  if (!is_mark && element.kind != LineKind::mill && (!has_bars || is_drill)) {
    report_.error(codes::pathdxf_line_type, where, kLineType, drawing_.linetypes[element.linetype]);
    return;
  }
  const Depth depth = is_mark ? Depth::mark : has_bars ? Depth::bars : Depth::full;
  const ParameterText* text = drawing_.text_of(element);
  const std::string diameter = number(2.0 * element.radius);
  if (is_drill) {
    const Values v(text, is_mark ? "FDQC" : "FBQC", variables_, where, report_);
    Drill drill{element.centre, milling_values(v, depth), either(v.positive('C'), cycle_from_)};
    return add(element, {nullptr, where, std::move(drill)}, kDrillOrder, kDrillRank);
  }
  if (element.radius < path_->tool / 2.0) {
    report_.error(codes::pathdxf_circle, where, kTooSmall, diameter, number(path_->tool));
    return;
  }
  if (!at_least(largest_helix_, 2.0 * element.radius)) {
    report_.error(codes::pathdxf_circle, where, kTooLarge, diameter, number(largest_helix_));
    report_.hint(kTooLargeHint);
  }
  const Values v(text, is_mark ? "FDIQ" : has_bars ? "FDBIPUQ" : "FBIQ", variables_, where, report_);
  Helix helix{element.centre, element.radius, milling_values(v, depth)};
  add(element, {nullptr, where, std::move(helix)}, kDrillOrder + element.radius, kHelixRank);
}

void PathAssembly::order_drafts() {
  if (drafts_.empty()) return;
  const Walk w = walk(links_, path_->start);
  for (const WalkStep& step : w.steps) append(drafts_[step.link], step.reversed);
  const Origin last = w.steps.empty() ? drawing_.origin(source_) : drafts_[w.steps.back().link].where;
  const bool at_end = near(w.end, path_->end);
  if (!at_end || !w.unreached.empty()) report_gap(w, last, at_end);
}

void PathAssembly::report_gap(const Walk& w, const Origin& last, bool at_end) {
  if (!at_end && !w.unreached.empty()) {
    report_.error(codes::pathdxf_open_end, last, kNoMore, point_text(w.end));
    const auto open = nearest_end(links_, w.unreached, w.end);
    report_.hint(kNearestEnd, point_text(open->at), fixed_text(open->distance, 3));
  }
  if (at_end)
    report_.error(codes::pathdxf_unreached, drafts_[w.unreached.front()].where, kUnreached,
                  w.unreached.size());
  else
    report_.error(codes::pathdxf_end, last, kNotAtEnd, point_text(path_->end));
  if (!at_end && w.unreached.empty()) report_.hint(kNothingLeft, point_text(path_->end));
  report_overlaps();
}

/// Elements of the same shape and ends, which lead back instead of on.
void PathAssembly::report_overlaps() {
  std::vector<const Draft*> sorted;
  for (const Draft& d : drafts_) sorted.push_back(&d);
  const auto key = [](const Draft* d) {
    const Element& e = *d->element;
    const bool swapped = e.end.x < e.start.x || (e.end.x == e.start.x && e.end.y < e.start.y);
    const Point2 a = swapped ? e.end : e.start, b = swapped ? e.start : e.end;
    return std::tuple(static_cast<int>(e.shape), a.x, a.y, b.x, b.y, e.centre.x, e.centre.y, e.radius);
  };
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const Draft* a, const Draft* b) { return key(a) < key(b); });
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (key(sorted[i - 1]) == key(sorted[i])) {
      const auto* at = std::get_if<DrawingLocation>(&sorted[i]->where);
      report_.warning(codes::pathdxf_overlap, sorted[i]->where, kOverlap, at->entity, path_->name);
    }
}

/// Helices through the material that leave a core which no smaller circle around the same centre removes.
void PathAssembly::warn_of_cores() {
  const auto key = [](Point2 p) {
    return std::pair(std::llround(p.x / kSameCentre), std::llround(p.y / kSameCentre));
  };
  std::map<std::pair<long long, long long>, std::vector<double>> radii;
  for (const Operation& operation : path_->operations) {
    if (const auto* drill = std::get_if<Drill>(&operation.what))
      radii[key(drill->at)].push_back(path_->tool / 2.0);
    if (const auto* helix = std::get_if<Helix>(&operation.what))
      radii[key(helix->centre)].push_back(helix->radius);
  }
  for (auto& [centre, list] : radii) std::sort(list.begin(), list.end());
  for (const Operation& operation : path_->operations) {
    const auto* helix = std::get_if<Helix>(&operation.what);
    if (helix == nullptr || helix->values.depth != Depth::full || !helix->values.b || *helix->values.b > 0.0)
      continue;
    const double core = helix->radius - path_->tool;
    const std::vector<double>& list = radii[key(helix->centre)];
    const auto next = std::lower_bound(list.begin(), list.end(), core - kSameCentre);
    if (!above(core, 0.0) || *next < helix->radius - kSameCentre) continue;
    report_.warning(codes::pathdxf_core, operation.where, kCore, number(2.0 * helix->radius),
                    number(2.0 * core));
    report_.hint(kCoreHint);
  }
}

void PathAssembly::append(const Draft& draft, bool reversed) {
  if (const auto* mill = std::get_if<MillDraft>(&draft.what)) return append_mill(*mill, reversed);
  in_chain_ = false;
  if (std::holds_alternative<EmbeddingDraft>(draft.what)) return embed(draft, reversed);
  if (const auto* sweep = std::get_if<Sweep>(&draft.what))
    path_->operations.push_back(
        {Sweep{reversed ? draft.element->start : draft.element->end, sweep->height}, draft.where});
  if (const auto* drill = std::get_if<Drill>(&draft.what)) path_->operations.push_back({*drill, draft.where});
  if (const auto* helix = std::get_if<Helix>(&draft.what)) path_->operations.push_back({*helix, draft.where});
}

void PathAssembly::append_mill(const MillDraft& mill, bool reversed) {
  if (!in_chain_) path_->operations.push_back({Chain{{}, mill.infeed, mill.first_depth}, mill.segment.where});
  in_chain_ = true;
  MillSegment s = mill.segment;
  if (reversed) {
    std::swap(s.start, s.end);
    s.start_angle += s.turn;
    s.turn = -s.turn;
  }
  std::get<Chain>(path_->operations.back().what).segments.push_back(std::move(s));
}

void PathAssembly::embed(const Draft& draft, bool reversed) {
  const auto& embedding = std::get<EmbeddingDraft>(draft.what);
  const Point2 start = reversed ? draft.element->end : draft.element->start;
  const Point2 end = reversed ? draft.element->start : draft.element->end;
  if (embedding.path.empty()) return;
  const auto sub = find_subpath(embedding, draft.where);
  if (!sub) return;
  check_embedding(embedding, *sub, distance(start, end), draft.where);
  check_rapids(*sub, embedding.raise, draft.where);
  path_->nesting = std::max(path_->nesting, sub->nesting + 1);
  path_->has_probes = path_->has_probes || sub->has_probes;
  if (builder_.depth_ - 1 + path_->nesting > kMaxNesting)
    report_.error(codes::pathdxf_nesting, draft.where, kTooDeep, sub->name_in_file);
  path_->operations.push_back({Embedding{sub, start, end, embedding.raise}, draft.where});
}

std::shared_ptr<const Path> PathAssembly::find_subpath(const EmbeddingDraft& embedding, const Origin& where) {
  if (const Restriction* r = restriction(); r != nullptr && !r->permits(embedding.path)) {
    report_.error(codes::pathdxf_restriction, where, kForbidden, embedding.path, path_->name, r->text());
    return nullptr;
  }
  const auto found = builder_.library_.find(embedding.path, drawing_.folder);
  if (found.path == nullptr) {
    report_.error(codes::pathdxf_not_found, where, kNotFound, embedding.path, "");
    report_.hint(kNotFoundHint, drawing_.file_name);
    return nullptr;
  }
  if (!found.path->usable || !found.drawing->usable) {
    report_.error(codes::pathdxf_not_found, where, kUnusable, name_in_file(*found.path, *found.drawing));
    return nullptr;
  }
  const std::size_t attempts = report_.attempts();
  Variables values;
  for (const Parameter& p : embedding.variables) values[p.key] = p.value;
  check_values(values, found, where, report_);
  if (report_.attempts() != attempts) return nullptr;
  if (builder_.depth_ > kMaxNesting) {
    report_.error(codes::pathdxf_nesting, where, kTooDeep, name_in_file(*found.path, *found.drawing));
    return nullptr;
  }
  const auto sub = builder_.build(found, PathRole::embedded, values);
  if (!sub && report_.attempts() ==
                  attempts)  // its errors were reported at its first embedding, or it is in progress
    report_.error(codes::pathdxf_nesting, where, kUnusable, name_in_file(*found.path, *found.drawing));
  return sub;
}

void PathAssembly::check_number(char key, const std::optional<double>& here, double there, const Path& sub,
                                const Origin& where) {
  if (!here || near(*here, there)) return;
  const std::string letter(1, key);
  report_.error(codes::pathdxf_embedding, where, kDifferent, letter, number(*here), sub.name_in_file, letter,
                number(there));
}

void PathAssembly::check_embedding(const EmbeddingDraft& embedding, const Path& sub, double size,
                                   const Origin& where) {
  const double own_size = distance(sub.start, sub.end);
  if (std::abs(size - own_size) > kEmbeddingLength)
    report_.error(codes::pathdxf_embedding, where, kSize, fixed_text(size, 3), fixed_text(own_size, 3),
                  sub.name_in_file);
  std::string inherited;
  if (!embedding.tool) inherited += 'O';
  if (!embedding.top) inherited += 'T';
  if (!embedding.material) inherited += 'M';
  if (!inherited.empty())
    report_.note(codes::pathdxf_assumed, where, kInherited, inherited, sub.name_in_file, path_->name);
  const double tool = embedding.tool.value_or(path_->tool), top = embedding.top.value_or(path_->top);
  check_number('O', tool, sub.tool, sub, where);
  check_number('T', top, sub.top, sub, where);
  if (!at_least(path_->top, top))
    report_.error(codes::pathdxf_embedding, where, kAboveTop, number(path_->top), number(top), sub.name);
  const std::string material = embedding.material.value_or(path_->material);
  if (material.empty() || sub.material.empty())
    report_.error(codes::pathdxf_embedding, where, kMissingHere, "M", sub.name_in_file);
  else if (material != sub.material)
    report_.error(codes::pathdxf_embedding, where, kDifferent, "M", material, sub.name_in_file, "M",
                  sub.material);
}

/// Rapids of this path pass over what is embedded in it, which H raises.
void PathAssembly::check_rapids(const Path& sub, double raise, const Origin& where) {
  const double highest = sub.highest + raise;
  path_->highest = std::max(path_->highest, highest);
  if (above(path_->sweep, highest)) return;
  if (near(path_->sweep, highest))
    report_.warning(codes::pathdxf_rapid_height, where, kAtRaised, number(path_->sweep), sub.name_in_file);
  else
    report_.error(codes::pathdxf_rapid_height, where, kBelowRaised, number(path_->sweep), number(highest),
                  sub.name_in_file);
}

std::shared_ptr<const Path> PathBuilder::build(const Library::Found& found, PathRole role,
                                               const Variables& variables) {
  std::string key = found.path->name + (role == PathRole::main ? "\nmain" : "\n");
  for (const auto& [name, value] : variables) key += "\n" + name + value;
  Report& report = library_.report();
  const auto [known, is_new] = built_.try_emplace(key);
  if (!is_new && known->second.in_progress)
    report.error(codes::pathdxf_nesting, found.drawing->origin(*found.path), kItself, found.path->name);
  if (!is_new) return known->second.path;
  if (built_.size() > kMaxBuiltPaths) {
    report.error(codes::pathdxf_limit, found.drawing->origin(*found.path), kTooMany, kMaxBuiltPaths);
    return nullptr;
  }
  ++depth_;
  auto path = PathAssembly(*this, found, role, variables).assemble();
  --depth_;
  known->second = {path, false};
  return path;
}

}  // namespace kerf::pathdxf
