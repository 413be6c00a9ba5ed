// Subtracts swept intervals from the columns of a micro.
#if defined(KERF_SIM_TAKE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef KERF_SIM_TAKE_INL_H
#undef KERF_SIM_TAKE_INL_H
#else
#define KERF_SIM_TAKE_INL_H
#endif

#include "sim/kernel/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace kerf::sim::HWY_NAMESPACE {

/// Removes everything above `low` from columns that start at the floor. Returns the length removed of each.
HWY_INLINE Vector take_open(Tile& tile, int micro, Vector low, Ids step, Real same) {
  const Vector old = load(tile.top[micro]);
  const Vector left = only(low >= same, low);
  const Mask cut = left + same < old;
  const Vector now = select(cut, left, old);
  store(now, tile.top[micro]);
  store_ids(select(cut, step, load_ids(tile.top_step[micro])), tile.top_step[micro]);
  tile.micro_top[micro] = highest_of(now);
  return old - now;
}

/// Subtracts [low, high] from one interval in each of 16 columns. Returns the columns in which two intervals
/// remain; the caller stores the upper one.
HWY_INLINE Mask take_from_slot(Slot& slot, Vector low, Vector high, Ids step, Real same, Vector& taken) {
  const Vector l = load(slot.low), h = load(slot.high);
  const Vector a = higher_of(low, l), b = lower_of(high, h);
  const Mask bottom = a <= l + same, top = b + same >= h;
  const Mask touches = (b > a) & ((b - a > same) | (bottom & top));
  const Mask all_of_it = touches & bottom & top;
  const Mask from_below = touches & bottom & ~top, with_new_top = touches & ~bottom;
  store(select(all_of_it, kFar, select(from_below, b, l)), slot.low);
  store(select(all_of_it, -kFar, select(with_new_top, a, h)), slot.high);
  store_ids(select(from_below, step, load_ids(slot.low_step)), slot.low_step);
  // Also for an interval that ends here: Tile::cut_through reads it.
  store_ids(select(with_new_top | all_of_it, step, load_ids(slot.high_step)), slot.high_step);
  taken = taken + select(all_of_it, h - l, only(touches, b - a));
  return touches & ~bottom & ~top;
}

/// Recomputes the highest and lowest material of a micro with a chain, and frees the chain if it is empty:
/// most undercut columns soon lose what is above the gap.
HWY_INLINE void update_bounds(Tile& tile, int micro) {
  Vector high = load(tile.top[micro]), low = select(high > 0, 0, kFar);
  Mask above_gap = no_lane();
  for (std::int32_t k = tile.chain[micro]; k >= 0; k = tile.slots.next(k)) {
    const Vector slot_high = load(tile.slots[k].high);
    const Vector slot_low = load(tile.slots[k].low);
    high = higher_of(high, slot_high);
    low = lower_of(low, slot_low);
    above_gap = above_gap | (slot_low < slot_high);
  }
  tile.micro_top[micro] = highest_of(high);
  tile.micro_bottom[micro] = lowest_of(low);
  if (!any(above_gap)) tile.drop_chain(micro);
}

/// The parts of intervals above the gaps where a sweep has split them, one per column.
struct Remnants {
  Mask split;
  Vector low, high;
  Ids low_step, high_step;
};

HWY_INLINE void store_where(Mask where, Vector v, Lanes& lanes) {
  store(select(where, v, load(lanes)), lanes);
}
HWY_INLINE void store_where(Mask where, Ids v, std::uint32_t* ids) {
  store_ids(select(where, v, load_ids(ids)), ids);
}

/// Stores remnants in a slot that is empty in all their columns, in a new one if a column has no empty slot,
/// else column by column.
HWY_INLINE void store_remnants(Tile& tile, int micro, const Remnants& rest) {
  Slot* slot_for_all = nullptr;
  Mask full = rest.split;
  for (std::int32_t k = tile.chain[micro]; k >= 0 && slot_for_all == nullptr; k = tile.slots.next(k)) {
    Slot& slot = tile.slots[k];
    const Mask taken = rest.split & (load(slot.low) <= load(slot.high));
    if (!any(taken)) slot_for_all = &slot;
    full = full & taken;
  }
  if (slot_for_all == nullptr && any(full)) slot_for_all = &tile.add_slot(micro);
  if (slot_for_all != nullptr) {
    store_where(rest.split, rest.low, slot_for_all->low);
    store_where(rest.split, rest.high, slot_for_all->high);
    store_where(rest.split, rest.low_step, slot_for_all->low_step);
    return store_where(rest.split, rest.high_step, slot_for_all->high_step);
  }
  Lanes low, high;
  alignas(64) std::uint32_t low_step[kLanes], high_step[kLanes];
  store(rest.low, low);
  store(rest.high, high);
  store_ids(rest.low_step, low_step);
  store_ids(rest.high_step, high_step);
  for (unsigned split = bits_of(rest.split); split != 0; split &= split - 1) {
    const int i = __builtin_ctz(split);
    tile.store_remnant(micro, {i, low[i], high[i], low_step[i], high_step[i]});
  }
}

/// Subtracts [low, high] from the intervals at the floor; upper parts that remain are stored in `rest`.
HWY_INLINE Vector take_from_floor(Tile& tile, int micro, Vector low, Vector high, Ids step, Real same,
                                  Remnants& rest) {
  const Vector h = load(tile.top[micro]);
  const Ids old_step = load_ids(tile.top_step[micro]);
  const Vector a = higher_of(low, 0), b = lower_of(high, h);
  const Mask bottom = a <= same, top = b + same >= h;
  const Mask touches = (b > a) & ((b - a > same) | (bottom & top));
  store(select(touches, only(~bottom, a), h), tile.top[micro]);
  store_ids(select(touches, step, old_step), tile.top_step[micro]);
  rest.split = touches & ~top;
  rest.high = h;
  rest.high_step = old_step;
  return select(touches & bottom & top, h, only(touches, b - a));
}

/// Subtracts [low, high] from all intervals.
HWY_INLINE Vector take_from_all(Tile& tile, int micro, Vector low, Vector high, Ids step, Real same) {
  Remnants rest{no_lane(), high, 0, step, step};
  Vector taken = take_from_floor(tile, micro, low, high, step, same, rest);
  for (std::int32_t k = tile.chain[micro]; k >= 0;) {
    Slot& slot = tile.slots[k];
    const Vector old_high = load(slot.high);
    const Ids old_step = load_ids(slot.high_step);
    // The intervals of a column do not overlap, so at most one of them is split.
    const Mask split = take_from_slot(slot, low, high, step, same, taken);
    rest.split = rest.split | split;
    rest.high = select(split, old_high, rest.high);
    rest.high_step = select(split, old_step, rest.high_step);
    k = tile.slots.next(k);
  }
  if (!any(taken > 0)) return taken;
  if (any(rest.split)) store_remnants(tile, micro, rest);
  update_bounds(tile, micro);
  return taken;
}

/// Subtracts [low, high]; returns the length removed of each column.
HWY_NOINLINE Vector take(Tile& tile, int micro, Vector low, Vector high, Ids step, Real same) {
  const Mask touches = (low < high) & (low < tile.micro_top[micro]) & (high > tile.micro_bottom[micro]);
  if (!any(touches)) return 0;
  if (tile.chain[micro] < 0) {
    const Vector top = load(tile.top[micro]);
    const Mask cuts = (low < top) & (high > same);
    if (!any(cuts)) return 0;
    if (!any(cuts & (high + same < top)))
      return take_open(tile, micro, select(high > same, low, kFar), step, same);
  }
  return take_from_all(tile, micro, low, high, step, same);
}

}  // namespace kerf::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
