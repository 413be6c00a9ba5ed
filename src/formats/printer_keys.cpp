// The table of keys of printers and filaments.
#include "formats/printer_keys.h"

#include <algorithm>

#include "kerf/base/limits.h"

namespace kerf::detail {
namespace {

using Numbers = std::vector<double>;
using P = PrinterProfile;
using F = FilamentProfile;

constexpr double kMaxCelsius = 2000.0, kMaxFlow = 1e4, kMaxLength = 1000.0, kMaxBed = 1e5;
constexpr double kMaxAxisSpeed = 1e5, kMaxAcceleration = 1e7;  // mm/s, mm/s2

/// One number, which is not stated where it is 0.
Numbers one(double v) { return v != 0.0 ? Numbers{v} : Numbers{}; }

template <std::size_t N>
Numbers planned(const P& p, const std::array<double, N>& values) {
  return p.has_planner ? Numbers(values.begin(), values.end()) : Numbers{};
}
template <std::size_t N>
void plan(P& p, std::array<double, N>& target, const double* v) {
  std::copy(v, v + N, target.begin());
  p.has_planner = true;
}

#define KERF_LENGTH(Profile, field) \
  [](Profile& p, const double* v) { p.field = mm(*v); }, [](const Profile& p) { return one(p.field.mm()); }
#define KERF_SPEED(Profile, field)                               \
  [](Profile& p, const double* v) { p.field = mm_per_min(*v); }, \
      [](const Profile& p) { return one(p.field.mm_per_min()); }
#define KERF_FLOW(Profile, field)                               \
  [](Profile& p, const double* v) { p.field = mm3_per_s(*v); }, \
      [](const Profile& p) { return one(in_mm3_per_s(p.field)); }
#define KERF_PLAIN(Profile, field) \
  [](Profile& p, const double* v) { p.field = *v; }, [](const Profile& p) { return one(p.field); }
#define KERF_PLAN(field)                                      \
  [](P& p, const double* v) { plan(p, p.planner.field, v); }, \
      [](const P& p) { return planned(p, p.planner.field); }

void set_bed(P& p, const double* v) {
  const Box3 old = p.bed.value_or(Box3{{0, 0, -INFINITY}, {0, 0, INFINITY}});
  p.bed = Box3{{std::min(v[0], v[2]), std::min(v[1], v[3]), old.low.z},
               {std::max(v[0], v[2]), std::max(v[1], v[3]), old.high.z}};
}
Numbers bed_of(const P& p) {
  if (!p.bed || !std::isfinite(p.bed->low.x)) return {};
  return {p.bed->low.x, p.bed->low.y, p.bed->high.x, p.bed->high.y};
}
void set_height(P& p, const double* v) {
  if (!p.bed) p.bed = Box3{{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};
  p.bed->high.z = *v;
}

}  // namespace

const std::vector<NumberKey<PrinterProfile>>& printer_numbers() {
  static const std::vector<NumberKey<P>> keys{
      {"height", "mm", 1, 0.1, kMaxBed, set_height,
       [](const P& p) { return p.bed && std::isfinite(p.bed->high.z) ? Numbers{p.bed->high.z} : Numbers{}; }},
      {"bed", "mm: low X, low Y, high X, high Y", 4, -kMaxBed, kMaxBed, set_bed, bed_of},
      {"nozzle", "mm", 1, 0.01, kMaxLength, KERF_LENGTH(P, nozzle)},
      {"filament", "mm", 1, 0.1, 10.0, KERF_LENGTH(P, filament)},
      {"max_flow", "mm3/s", 1, 0.0, kMaxFlow, KERF_FLOW(P, max_flow)},
      {"max_nozzle", "C", 1, 0.0, kMaxCelsius, KERF_PLAIN(P, max_nozzle)},
      {"max_bed", "C", 1, 0.0, kMaxCelsius, KERF_PLAIN(P, max_bed)},
      {"axis_speed", "mm/s: X, Y, Z, E", 4, 1e-3, kMaxAxisSpeed, KERF_PLAN(axis_speed)},
      {"axis_acceleration", "mm/s2: X, Y, Z, E", 4, 1e-3, kMaxAcceleration, KERF_PLAN(axis_acceleration)},
      {"acceleration", "mm/s2 of beads, retractions, travel", 3, 1e-3, kMaxAcceleration,
       KERF_PLAN(acceleration)},
      {"jerk", "mm/s: X, Y, Z, E", 4, 0.0, kMaxAxisSpeed,
       [](P& p, const double* v) { plan(p, p.planner.jerk, v), p.planner.corners = CornerRule::jerk; },
       [](const P& p) {
         return p.planner.corners == CornerRule::jerk ? planned(p, p.planner.jerk) : Numbers{};
       }},
      {"junction_deviation", "mm", 1, 1e-6, kMaxLength,
       [](P& p, const double* v) {
         p.planner.junction_deviation = *v, p.planner.corners = CornerRule::junction_deviation;
         p.has_planner = true;
       },
       [](const P& p) {
         return p.planner.corners == CornerRule::junction_deviation ? one(p.planner.junction_deviation)
                                                                    : Numbers{};
       }},
      {"corner_speed", "mm/s at 90 degrees", 1, 1e-3, kMaxAxisSpeed,
       [](P& p, const double* v) {
         p.planner.corner_speed = *v, p.planner.corners = CornerRule::square_corner;
         p.has_planner = true;
       },
       [](const P& p) {
         return p.planner.corners == CornerRule::square_corner ? one(p.planner.corner_speed) : Numbers{};
       }},
      {"width", "mm", 1, 0.01, limits::kMaxBeadWidth, KERF_LENGTH(P, width)},
      {"layer", "mm", 1, 0.001, limits::kMaxBeadWidth, KERF_LENGTH(P, layer)},
      {"first_layer", "mm", 1, 0.001, limits::kMaxBeadWidth, KERF_LENGTH(P, first_layer)},
      {"speed", "mm/min", 1, 0.0, limits::kMaxSpeed, KERF_SPEED(P, speed)},
      {"first_layer_speed", "mm/min", 1, 0.0, limits::kMaxSpeed, KERF_SPEED(P, first_layer_speed)},
      {"travel_speed", "mm/min", 1, 0.0, limits::kMaxSpeed, KERF_SPEED(P, travel_speed)},
      {"retract", "mm", 1, 0.0, kMaxLength, KERF_LENGTH(P, retract)},
      {"retract_speed", "mm/min", 1, 0.0, limits::kMaxSpeed, KERF_SPEED(P, retract_speed)},
      {"hop", "mm", 1, 0.0, kMaxLength, KERF_LENGTH(P, hop)},
  };
  return keys;
}

const std::vector<NumberKey<FilamentProfile>>& filament_numbers() {
  static const std::vector<NumberKey<F>> keys{
      {"nozzle", "C", 1, 0.0, kMaxCelsius, KERF_PLAIN(F, nozzle)},
      {"bed", "C", 1, 0.0, kMaxCelsius, KERF_PLAIN(F, bed)},
      {"first_nozzle", "C", 1, 0.0, kMaxCelsius, KERF_PLAIN(F, first_nozzle)},
      {"first_bed", "C", 1, 0.0, kMaxCelsius, KERF_PLAIN(F, first_bed)},
      {"min_nozzle", "C", 1, 0.0, kMaxCelsius, KERF_PLAIN(F, min_nozzle)},
      {"diameter", "mm", 1, 0.1, 10.0, KERF_LENGTH(F, diameter)},
      {"density", "g/cm3", 1, 0.01, 100.0, KERF_PLAIN(F, density)},
      {"max_flow", "mm3/s", 1, 0.0, kMaxFlow, KERF_FLOW(F, max_flow)},
  };
  return keys;
}

}  // namespace kerf::detail
