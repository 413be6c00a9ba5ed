// Taking swept intervals away from the columns of a micro.
#if defined(KERF_SIM_TAKE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef KERF_SIM_TAKE_INL_H
#undef KERF_SIM_TAKE_INL_H
#else
#define KERF_SIM_TAKE_INL_H
#endif

#include "sim/kernel/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace kerf::sim::HWY_NAMESPACE {

/// Takes all above `low` from columns that stand on the floor. Returns the length taken of each.
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

/// One interval of 16 columns less [low, high]; returned are the columns where that leaves two intervals, and
/// the caller stores what is above the gap.
HWY_INLINE Mask take_from_slot(Slot& slot, Vector low, Vector high, Ids step, Real same, Vector& taken) {
  const Vector l = load(slot.low), h = load(slot.high);
  const Vector a = higher_of(low, l), b = lower_of(high, h);
  const Mask bottom = a <= l + same, top = b + same >= h;
  const Mask meets = (b > a) & ((b - a > same) | (bottom & top));
  const Mask all_of_it = meets & bottom & top;
  const Mask from_below = meets & bottom & ~top, with_new_top = meets & ~bottom;
  store(select(all_of_it, kFar, select(from_below, b, l)), slot.low);
  store(select(all_of_it, -kFar, select(with_new_top, a, h)), slot.high);
  store_ids(select(from_below, step, load_ids(slot.low_step)), slot.low_step);
  // Of an interval that ends here too: Tile::cut_through reads it.
  store_ids(select(with_new_top | all_of_it, step, load_ids(slot.high_step)), slot.high_step);
  taken = taken + select(all_of_it, h - l, only(meets, b - a));
  return meets & ~bottom & ~top;
}

/// Finds the highest and lowest material of a micro with a chain again, and whether anything floats in it
/// still: most undercut columns lose soon what is above the gap.
HWY_INLINE void update_bounds(Tile& tile, int micro) {
  Vector high = load(tile.top[micro]), low = select(high > 0, 0, kFar);
  Mask floats = no_lane();
  for (std::int32_t k = tile.chain[micro]; k >= 0; k = tile.slots.next(k)) {
    const Vector slot_high = load(tile.slots[k].high);
    const Vector slot_low = load(tile.slots[k].low);
    high = higher_of(high, slot_high);
    low = lower_of(low, slot_low);
    floats = floats | (slot_low < slot_high);
  }
  tile.micro_top[micro] = highest_of(high);
  tile.micro_bottom[micro] = lowest_of(low);
  if (!any(floats)) tile.drop_chain(micro);
}

/// What is left above the gaps in intervals that a sweep has split, one a column.
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

/// Puts remnants into a slot that is free in all their columns, into a new one if some column has none that
/// is free, else column by column wherever there is room.
HWY_INLINE void store_remnants(Tile& tile, int micro, const Remnants& rest) {
  Slot* room = nullptr;
  Mask full = rest.split;
  for (std::int32_t k = tile.chain[micro]; k >= 0 && room == nullptr; k = tile.slots.next(k)) {
    Slot& slot = tile.slots[k];
    const Mask taken = rest.split & (load(slot.low) <= load(slot.high));
    if (!any(taken)) room = &slot;
    full = full & taken;
  }
  if (room == nullptr && any(full)) room = &tile.add_slot(micro);
  if (room != nullptr) {
    store_where(rest.split, rest.low, room->low);
    store_where(rest.split, rest.high, room->high);
    store_where(rest.split, rest.low_step, room->low_step);
    return store_where(rest.split, rest.high_step, room->high_step);
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

/// Takes [low, high] from what stands on the floor; what it leaves above the gap goes to `rest`.
HWY_INLINE Vector take_from_standing(Tile& tile, int micro, Vector low, Vector high, Ids step, Real same,
                                     Remnants& rest) {
  const Vector h = load(tile.top[micro]);
  const Ids old_step = load_ids(tile.top_step[micro]);
  const Vector a = higher_of(low, 0), b = lower_of(high, h);
  const Mask bottom = a <= same, top = b + same >= h;
  const Mask meets = (b > a) & ((b - a > same) | (bottom & top));
  store(select(meets, only(~bottom, a), h), tile.top[micro]);
  store_ids(select(meets, step, old_step), tile.top_step[micro]);
  rest.split = meets & ~top;
  rest.high = h;
  rest.high_step = old_step;
  return select(meets & bottom & top, h, only(meets, b - a));
}

/// Takes [low, high] from what stands and what floats.
HWY_INLINE Vector take_from_all(Tile& tile, int micro, Vector low, Vector high, Ids step, Real same) {
  Remnants rest{no_lane(), high, 0, step, step};
  Vector taken = take_from_standing(tile, micro, low, high, step, same, rest);
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

/// Takes [low, high]; returns the length taken of each column.
HWY_NOINLINE Vector take(Tile& tile, int micro, Vector low, Vector high, Ids step, Real same) {
  const Mask meets = (low < high) & (low < tile.micro_top[micro]) & (high > tile.micro_bottom[micro]);
  if (!any(meets)) return 0;
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
