// Contacts of convex pieces with a box. While a piece moves along a line, its distance in plan from the box
// and its clearance in height are convex functions of the path parameter: ternary search finds their minimum,
// bisection the start of a contact.
#include "sim/cut/block_contact.h"

#include <algorithm>
#include <cmath>

#include "kerf/path/toolpath.h"

namespace kerf::sim {
namespace {

constexpr int kThirds = 80;    // iterations of a search for a minimum, to full precision
constexpr int kHalvings = 55;  // iterations of a search for a zero, to full precision

/// A straight section of a sweep.
struct Line {
  Point3 from, to;
  double start_fraction = 0.0, end_fraction = 1.0;  // fractions of the step's path

  Point3 at(double t) const { return from + t * (to - from); }
  double fraction(double t) const { return start_fraction + t * (end_fraction - start_fraction); }
};

/// The position of the minimum of a convex function.
template <class Function>
double lowest(const Function& f, double low, double high) {
  for (int n = 0; n < kThirds; ++n) {
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    (f(a) < f(b) ? high : low) = f(a) < f(b) ? b : a;
  }
  return 0.5 * (low + high);
}

/// The end of the interval in which a function is negative, from `inside` towards `outside`.
template <class Function>
double last_negative(const Function& f, double inside, double outside) {
  if (f(outside) < 0.0) return outside;
  for (int n = 0; n < kHalvings; ++n) {
    const double midpoint = 0.5 * (inside + outside);
    (f(midpoint) < 0.0 ? inside : outside) = midpoint;
  }
  return inside;
}

double outside_of(double v, double size) { return std::max({-v, v - size, 0.0}); }

/// One piece of a solid that moves past the block.
class Passing {
 public:
  Passing(const Line& line, const Solid& solid, const ConvexPiece& piece, Point3 size, double ignore)
      : line_(line), solid_(solid), piece_(piece), size_(size), ignore_(ignore) {}

  void note(Contact& contact) const;

 private:
  bool is_far() const;
  /// Distance of the axis from the block in plan.
  double distance(Point3 tip) const {
    return std::hypot(outside_of(tip.x, size_.x), outside_of(tip.y, size_.y));
  }
  double beyond_rim(double t) const { return distance(line_.at(t)) - piece_.rim; }
  /// The lowest point of the piece over the block.
  double low(double t) const {
    const Point3 tip = line_.at(t);
    return tip.z + piece_.lower.at(distance(tip));
  }
  /// Clearance to a contact in height; convex while the block is within the rim.
  double clearance(double t) const {
    const Point3 tip = line_.at(t);
    const double high = solid_.one_envelope ? solid_.top : -piece_.upper.at(distance(tip));
    return ignore_ + std::max(low(t), 0.0) - std::min(tip.z + high, size_.z);
  }

  const Line& line_;
  const Solid& solid_;
  const ConvexPiece& piece_;
  Point3 size_;
  double ignore_;
};

bool Passing::is_far() const {
  const Point3 &a = line_.from, &b = line_.to;
  const double rim = piece_.rim;
  return std::max(a.x, b.x) + rim <= 0.0 || std::min(a.x, b.x) - rim >= size_.x ||
         std::max(a.y, b.y) + rim <= 0.0 || std::min(a.y, b.y) - rim >= size_.y ||
         std::min(a.z, b.z) + piece_.lower.height >= size_.z || std::max(a.z, b.z) + solid_.top <= 0.0;
}

void Passing::note(Contact& contact) const {
  if (is_far()) return;
  const auto beyond = [&](double t) { return beyond_rim(t); };
  const auto clearance = [&](double t) { return this->clearance(t); };
  const double nearest = lowest(beyond, 0.0, 1.0);
  if (beyond(nearest) >= 0.0) return;
  const double start = last_negative(beyond, nearest, 0.0), end = last_negative(beyond, nearest, 1.0);
  const double innermost = lowest(clearance, start, end);
  if (clearance(innermost) >= 0.0) return;
  const double first = last_negative(clearance, innermost, start),
               last = last_negative(clearance, innermost, end);
  const double deepest = low(lowest([&](double t) { return low(t); }, first, last));
  contact.depth = std::max(contact.depth, size_.z - std::max(deepest, 0.0));
  if (line_.fraction(first) >= contact.fraction) return;
  contact.fraction = line_.fraction(first);
  const Point3 tip = line_.at(first);
  contact.at = {std::clamp(tip.x, 0.0, size_.x), std::clamp(tip.y, 0.0, size_.y),
                std::clamp(low(first), 0.0, size_.z)};
}

std::vector<Line> lines_of(const Sweep& s) {
  const auto start = static_cast<double>(s.start_fraction), end = static_cast<double>(s.end_fraction);
  const Point3 from{s.x, s.y, s.z};
  if (!s.is_arc) return {{from, {s.x + s.length * s.ux, s.y + s.length * s.uy, s.z_end}, start, end}};
  ArcWalk walk;
  walk.u = s.x;
  walk.v = s.y;
  walk.start_w = walk.end_w = s.z;
  walk.start_radius = walk.end_radius = s.radius;
  walk.start_angle = std::atan2(s.uy, s.ux);
  walk.sweep = s.turn;
  const int count = walk.chords(mm(kPathChord));
  std::vector<Line> lines;
  for (int k = 0; k < count; ++k) {
    const double a = static_cast<double>(k) / count, b = (k + 1.0) / count;
    lines.push_back({walk.at(a), walk.at(b), start + a * (end - start), start + b * (end - start)});
  }
  return lines;
}

}  // namespace

void note_block_contacts(const Sweep& sweep, const ToolSolids& tool, Point3 size, double hazard_depth,
                         std::vector<Contact>& contacts) {
  const bool rapid = (sweep.passes & kPassRapid) != 0;
  constexpr HazardKind kKinds[] = {HazardKind::spindle_off, HazardKind::neck_contact,
                                   HazardKind::shank_contact, HazardKind::holder_contact};
  const std::vector<Line> lines = lines_of(sweep);
  for (int part = 0; part < 4; ++part) {
    Contact contact;
    contact.step = sweep.step;
    contact.kind = rapid ? HazardKind::rapid_in_stock : kKinds[part];
    const Solid& solid = tool.touching[part];
    for (const Line& line : lines)
      for (const ConvexPiece& piece : solid.pieces)
        Passing(line, solid, piece, size, hazard_depth).note(contact);
    if (contact.fraction <= 1.0) contacts.push_back(contact);
  }
}

}  // namespace kerf::sim
