// Steps between neighbouring columns that are too high for a surface, see walls.cpp.
#if defined(KERF_SIM_STEPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef KERF_SIM_STEPS_INL_H
#undef KERF_SIM_STEPS_INL_H
#else
#define KERF_SIM_STEPS_INL_H
#endif

#include "sim/kernel/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace kerf::sim::HWY_NAMESPACE {

/// Of four columns in a row, for 16 such rows: by how much the step in the middle exceeds what is explained,
/// in least steps that count.
HWY_INLINE Vector excess_of(const StepRules& rules, Vector before, Vector a, Vector b, Vector after) {
  const Vector middle = b - a, left = a - before, right = after - b;
  const Vector step = absolute(middle), l = absolute(left), r = absolute(right);
  const Vector lower = lower_of(l, r), higher = higher_of(l, r);
  const Mask same_way = (left * middle > 0) & (right * middle > 0);
  const Vector by_lower = only(same_way, rules.explained_by_lower * lower);
  const Vector by_higher = lower_of(rules.explained_by_higher * higher, rules.most_explained);
  const Vector rest = (step - higher_of(by_lower, by_higher)) * rules.per_least;
  return higher_of(rest, only(higher <= rules.same_height, step * rules.per_least_level));
}

HWY_INLINE void add_steps(Vector excess, int x, int y, StepWay way, std::vector<ColumnStep>& out) {
  unsigned found = bits_of(excess >= 1);
  if (found == 0) return;
  Lanes all;
  store(excess, all);
  for (; found != 0; found &= found - 1) {
    const int lane = __builtin_ctz(found);
    out.push_back({x + lane, y, way, all[lane]});
  }
}

}  // namespace kerf::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
