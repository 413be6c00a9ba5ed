// Finds steps between neighbouring columns that are too high for a smooth surface, see walls.cpp.
#if defined(KERF_SIM_STEPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef KERF_SIM_STEPS_INL_H
#undef KERF_SIM_STEPS_INL_H
#else
#define KERF_SIM_STEPS_INL_H
#endif

#include "sim/kernel/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace kerf::sim::HWY_NAMESPACE {

/// For 16 rows of four columns: the excess of the inner step over what its neighbours explain, in units of
/// the minimum step.
HWY_INLINE Vector excess_of(const StepRules& rules, Vector before, Vector a, Vector b, Vector after) {
  const Vector inner = b - a, left = a - before, right = after - b;
  const Vector step = absolute(inner), l = absolute(left), r = absolute(right);
  const Vector lower = lower_of(l, r), higher = higher_of(l, r);
  const Mask same_sign = (left * inner > 0) & (right * inner > 0);
  const Vector by_lower = only(same_sign, rules.explained_by_lower * lower);
  const Vector by_higher = lower_of(rules.explained_by_higher * higher, rules.max_explained);
  const Vector rest = (step - higher_of(by_lower, by_higher)) * rules.per_min;
  return higher_of(rest, only(higher <= rules.same_height, step * rules.per_min_level));
}

HWY_INLINE void add_steps(Vector excess, int x, int y, StepAxis axis, std::vector<ColumnStep>& out) {
  unsigned found = bits_of(excess >= 1);
  if (found == 0) return;
  Lanes all;
  store(excess, all);
  for (; found != 0; found &= found - 1) {
    const int lane = __builtin_ctz(found);
    out.push_back({x + lane, y, axis, all[lane]});
  }
}

}  // namespace kerf::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
