// Cylinders that move at one height: keyhole and T-slot cutters, flat mills in pockets. The first sweep over
// a column removes all that any of them removes, so many successive sweeps are processed together: find the
// first sweep over each column, then subtract once.
//
// Sweeps that follow each other are bundled into chords of about half a micro; one comparison tests sixteen
// bundles against a block of columns. A block that is covered by the disc at the start of a bundle, or lies
// behind it, is already cut. All positions are relative to the tile's first column, so that the disc at the
// end of a sweep and that at the start of the next are the same to the bit: the latter removes nothing and is
// skipped, whatever else is bundled.
#if defined(KERF_SIM_CYLINDERS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef KERF_SIM_CYLINDERS_INL_H
#undef KERF_SIM_CYLINDERS_INL_H
#else
#define KERF_SIM_CYLINDERS_INL_H
#endif

#include <algorithm>
#include <cmath>

#include "sim/kernel/passes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace kerf::sim::HWY_NAMESPACE {

inline constexpr int kBundles = kLanes;  // per group, one bit of a mask each
inline constexpr int kMaxBundled = 8;    // sweeps per bundle
inline constexpr int kMaxSweeps = kBundles * kMaxBundled;
inline constexpr Real kBundleLength = 3;  // pitches, if sweeps are that short
/// Margin for rounding in comparisons with blocks, pitches.
inline constexpr Real kBlockMargin = 0.01f;
/// Minimum cosine of the angle between the sweeps of a bundle and its chord; below it no block counts as
/// entirely before or behind the bundle.
inline constexpr Real kMinCosine = 0.5f;

/// A level sweep, relative to the tile's first column.
struct DiscSweep {
  Real start_x, start_y, end_x, end_y;
  Real along_x, along_y, length;
  bool follows;
};

/// Sweeps that are tested together, as a straight line.
struct Bundle {
  Real start_x, start_y, along_x, along_y, length;
  Real slack;               // margin for a block to count as behind or ahead
  Real outer2[kFewPieces];  // squared distances: reach of a cylinder from the line,
  Real inner2[kFewPieces];  // and its disc at the start, where the previous sweep ended
};
/// For each cylinder and bundle the blocks (one bit each) that it can cut, and those so far ahead that only
/// the discs at the ends of its sweeps count.
struct BundleBits {
  alignas(64) std::uint32_t touched[kFewPieces][kBundles];
  alignas(64) std::uint32_t passed[kBundles];
};

struct CylinderGroup {
  const LaneSolid* solid = nullptr;
  int count = 0, each = 1;                 // sweeps, and sweeps per bundle
  Real low[kFewPieces], high[kFewPieces];  // interval removed by each cylinder
  DiscSweep sweep[kMaxSweeps];
  // The last one is for columns that no sweep touches.
  std::uint32_t step[kMaxSweeps + 1];
  Lanes taken[kMaxSweeps + 1];  // length of column, weighted
  int bundles = 0;
  Bundle bundle[kBundles];
  BundleBits supers, micros;
};

/// Whether this code can cut level sweeps of a tool.
HWY_INLINE bool may_be_level_cylinders(const LaneSolid& solid) {
  return solid.is_cylinders && !solid.pieces.empty() && solid.pieces.size() <= kFewPieces;
}

/// Whether this code can cut a sweep.
HWY_INLINE bool is_level_cylinders(const TileJob& job, const Sweep& sweep) {
  return sweep.z == sweep.z_end && may_be_level_cylinders((*job.tools)[sweep.tool].cutting);
}

/// Ends that reach no column of the tile are moved nearer, to keep numbers small.
HWY_INLINE DiscSweep disc_sweep(const TileJob& job, const Sweep& s, Real rim) {
  const double range = 2.0 * (kTileColumns * job.field->pitch + static_cast<double>(rim));
  double from = 0.0, to = s.length;
  if (s.length > range) {
    const double near = (job.x - s.x) * s.ux + (job.y - s.y) * s.uy;
    from = std::clamp(near - range, 0.0, s.length);
    to = std::clamp(near + range, 0.0, s.length);
  }
  const auto real = [](double v) { return static_cast<Real>(v); };
  return {real(s.x + from * s.ux - job.x),
          real(s.y + from * s.uy - job.y),
          real(s.x + to * s.ux - job.x),
          real(s.y + to * s.uy - job.y),
          real(s.ux),
          real(s.uy),
          real(to - from),
          s.follows};
}

/// The chord of a bundle, the maximum distance of its sweeps from it, and the slack for their change of
/// direction.
struct BundleChord {
  Real along_x, along_y, length, bulge, slack;
};
HWY_INLINE BundleChord chord_of(const DiscSweep* sweeps, int count, Real rim) {
  const DiscSweep& first = sweeps[0];
  if (count == 1) return {first.along_x, first.along_y, first.length, 0, first.follows ? Real{0} : kFar};
  const DiscSweep& last = sweeps[count - 1];
  const Real x = last.end_x - first.start_x, y = last.end_y - first.start_y;
  const Real length = std::sqrt(x * x + y * y), per_length = length > 0 ? 1 / length : 0;
  const Real along_x = x * per_length, along_y = y * per_length;
  Real cosine = 1, sine = 0, total = 0;
  bool all_follow = true;
  for (int k = 0; k < count; ++k) {
    const DiscSweep& s = sweeps[k];
    cosine = std::min(cosine, s.along_x * along_x + s.along_y * along_y);
    sine = std::max(sine, std::abs(s.along_y * along_x - s.along_x * along_y));
    total += s.length;
    all_follow = all_follow && s.follows;
  }
  if (cosine < kMinCosine) return {along_x, along_y, length, total, kFar};
  const Real bulge = sine * total;
  return {along_x, along_y, length, bulge, all_follow ? bulge + sine / cosine * (rim + total) : kFar};
}

HWY_INLINE void prepare_bundles(CylinderGroup& group, Real pitch) {
  const LaneSolid& solid = *group.solid;
  const Real margin = kBlockMargin * pitch;
  group.bundles = 0;
  for (int first = 0; first < group.count; first += group.each) {
    const DiscSweep& start = group.sweep[first];
    const BundleChord chord = chord_of(&start, std::min(group.each, group.count - first), solid.rim);
    Bundle& bundle = group.bundle[group.bundles++];
    bundle = {start.start_x,
              start.start_y,
              chord.along_x,
              chord.along_y,
              chord.length,
              chord.slack + margin,
              {},
              {}};
    for (std::size_t p = 0; p < solid.pieces.size(); ++p) {
      const Real rim = solid.pieces[p].rim, outer = rim + chord.bulge + margin;
      const Real inner = start.follows ? std::max(rim - margin, Real{0}) : 0;
      bundle.outer2[p] = outer * outer;
      bundle.inner2[p] = inner * inner;
    }
  }
}

/// Compares bundles (one bit each) with blocks, given their highest and lowest material. Returns the bits of
/// blocks that any of them touches.
HWY_INLINE unsigned bundles_over(const CylinderGroup& group, unsigned bundles, const Blocks& blocks,
                                 const Real* top, const Real* bottom, BundleBits& bits) {
  const std::size_t pieces = group.solid->pieces.size();
  Mask material[kFewPieces];
  for (std::size_t p = 0; p < pieces; ++p) {
    material[p] = (load(top) > group.low[p]) & (load(bottom) < group.high[p]);
    store_ids(all_ids(0), bits.touched[p]);
  }
  store_ids(all_ids(0), bits.passed);
  unsigned all_touched = 0;
  for (; bundles != 0; bundles &= bundles - 1) {
    const int b = __builtin_ctz(bundles);
    const Bundle& bundle = group.bundle[b];
    const Real along = std::abs(bundle.along_x), across = std::abs(bundle.along_y);
    const Vector x = blocks.x - bundle.start_x, y = blocks.y - bundle.start_y;
    const Vector u = x * bundle.along_x + y * bundle.along_y, v = y * bundle.along_x - x * bundle.along_y;
    const Vector reach = blocks.half_x * along + blocks.half_y * across;
    const Vector du = higher_of(outside(u, 0, bundle.length) - reach, 0);
    const Vector dv = higher_of(absolute(v) - (blocks.half_x * across + blocks.half_y * along), 0);
    const Vector near2 = du * du + dv * dv;
    const Vector far2 = square(absolute(x) + blocks.half_x) + square(absolute(y) + blocks.half_y);
    const Mask ahead = u + reach + bundle.slack > 0;
    unsigned touched = 0;
    for (std::size_t p = 0; p < pieces; ++p) {
      bits.touched[p][b] =
          bits_of(material[p] & ahead & (near2 < bundle.outer2[p]) & (far2 >= bundle.inner2[p]));
      touched |= bits.touched[p][b];
    }
    if (touched == 0) continue;
    bits.passed[b] = bits_of(u - bundle.length - reach > bundle.slack);
    all_touched |= touched;
  }
  return all_touched;
}

/// Squared distance of columns from the path of a sweep between its ends, and from its start point unless it
/// follows another sweep; `distance2` elsewhere. Positions are relative to the end point.
HWY_INLINE Vector nearest_on_path(const DiscSweep& s, Vector x, Vector y, Vector distance2) {
  const Vector u = x * s.along_x + y * s.along_y, v = y * s.along_x - x * s.along_y;
  distance2 = select((u < 0) & (u > -s.length), lower_of(distance2, v * v), distance2);
  if (s.follows) return distance2;
  return lower_of(distance2, square(x + (s.end_x - s.start_x)) + square(y + (s.end_y - s.start_y)));
}

/// The number of the first sweep over each column; kMaxSweeps if there is none.
HWY_INLINE Ids first_over(const CylinderGroup& group, const MicroPositions& positions, unsigned bundles,
                          unsigned passed, Real rim2) {
  Ids first = all_ids(kMaxSweeps);
  while (bundles != 0) {  // the latest first; earlier ones overwrite
    const int b = 31 - __builtin_clz(bundles);
    bundles ^= 1u << b;
    const DiscSweep* const begin = group.sweep + b * group.each;
    const DiscSweep* s = std::min(begin + group.each, group.sweep + group.count);
    Ids number = all_ids(static_cast<std::uint32_t>(s - group.sweep));
    const bool is_passed = (passed >> b & 1u) != 0;
    while (s-- != begin) {
      number = one_less(number);
      const Vector x = positions.x - s->end_x, y = positions.y - s->end_y;
      Vector distance2 = x * x + y * y;
      if (!is_passed) distance2 = nearest_on_path(*s, x, y, distance2);
      first = select(distance2 < rim2, number, first);
    }
  }
  return first;
}

/// Subtracts a cylinder from the columns of a micro, each by the sweep with its number.
HWY_INLINE void take_by_numbers(CylinderGroup& group, const TileJob& job, int micro, std::size_t piece,
                                Ids numbers) {
  const Mask none = numbers == all_ids(kMaxSweeps);
  const unsigned touched = bits_of(~none);
  if (touched == 0) return;
  alignas(64) std::uint32_t number[kLanes];
  store_ids(numbers, number);
  alignas(64) std::uint32_t step[kLanes];
  for (int i = 0; i < kLanes; ++i) step[i] = group.step[number[i]];
  Lanes taken;
  store(take(*job.tile, micro, select(none, kFar, group.low[piece]), group.high[piece], load_ids(step),
             job.field->same_height) *
            weights_of(job, micro),
        taken);
  for (int i = 0; i < kLanes; ++i) group.taken[number[i]][i] += taken[i];
}

/// The same for few sweeps: a loop over sweeps instead of columns.
HWY_INLINE void take_by_few(CylinderGroup& group, const TileJob& job, int micro, std::size_t piece,
                            Ids numbers) {
  const Mask none = numbers == all_ids(kMaxSweeps);
  alignas(64) std::uint32_t number[kLanes];
  store_ids(numbers, number);
  const unsigned touched = bits_of(~none);
  if (touched == 0) return;
  std::uint32_t by[kLanes];
  int count = 0;
  Ids step = all_ids(0);
  for (unsigned rest = touched; rest != 0; ++count) {
    by[count] = number[__builtin_ctz(rest)];
    const Mask mine = numbers == all_ids(by[count]);
    step = select(mine, all_ids(group.step[by[count]]), step);
    rest &= ~bits_of(mine);
  }
  const Vector taken = take(*job.tile, micro, select(none, kFar, group.low[piece]), group.high[piece], step,
                            job.field->same_height) *
                       weights_of(job, micro);
  for (int n = 0; n < count; ++n) {
    Lanes& sum = group.taken[by[n]];
    store(load(sum) + only(numbers == all_ids(by[n]), taken), sum);
  }
}

/// Subtracts all cylinders from a micro.
HWY_NOINLINE void cylinders_over_micro(CylinderGroup& group, const TileJob& job, int micro) {
  const unsigned lane = 1u << (micro % kSupers);
  const MicroPositions positions = positions_of(job, micro);
  const unsigned passed = lanes_with(group.micros.passed, lane);
  for (std::size_t p = 0; p < group.solid->pieces.size(); ++p) {
    const unsigned touched = lanes_with(group.micros.touched[p], lane);
    if (touched == 0) continue;
    const Ids first = first_over(group, positions, touched, passed, group.solid->pieces[p].rim2);
    group.each > 1 ? take_by_numbers(group, job, micro, p, first) : take_by_few(group, job, micro, p, first);
  }
}

HWY_NOINLINE void cylinders_over_super(CylinderGroup& group, const TileJob& job, int super) {
  Tile& tile = *job.tile;
  const int first = super * kSupers;
  unsigned bundles = 0;
  for (std::size_t p = 0; p < group.solid->pieces.size(); ++p)
    bundles |= lanes_with(group.supers.touched[p], 1u << super);
  unsigned micros = bundles_over(group, bundles, micros_of(job, super), tile.micro_top + first,
                                 tile.micro_bottom + first, group.micros);
  if (micros == 0) return;
  for (; micros != 0; micros &= micros - 1) cylinders_over_micro(group, job, first + __builtin_ctz(micros));
  update_super(tile, super);
}

/// Prefetch distance: the sweeps of one tile are scattered in memory.
inline constexpr std::size_t kFetchedAhead = 16;
HWY_INLINE void fetch(const Sweep& sweep) {
  const auto* bytes = reinterpret_cast<const char*>(&sweep);
  __builtin_prefetch(bytes);
  __builtin_prefetch(bytes + sizeof(Sweep) - 1);
}

/// Adds sweeps to a group as long as they can be bundled like the first of them; if they cannot, one per
/// bundle. Returns the number of sweeps added.
HWY_INLINE int gather_cylinders(CylinderGroup& group, const TileJob& job, std::size_t first,
                                std::size_t limit) {
  const Sweep& like = job.sweeps[job.list[first]];
  const double pitch = job.field->pitch, bundle = static_cast<double>(kBundleLength) * pitch;
  group.solid = &(*job.tools)[like.tool].cutting;
  group.each =
      like.length * kMaxBundled > bundle ? std::max(1, static_cast<int>(bundle / like.length)) : kMaxBundled;
  limit = std::min(limit, static_cast<std::size_t>(kBundles * group.each));
  int count = 0;
  for (; static_cast<std::size_t>(count) < limit; ++count) {
    const std::size_t q = first + static_cast<std::size_t>(count);
    if (q + kFetchedAhead < job.count) fetch(job.sweeps[job.list[q + kFetchedAhead]]);
    const Sweep& sweep = job.sweeps[job.list[q]];
    if (sweep.passes != kPassCut || sweep.is_arc || sweep.tool != like.tool || sweep.z != like.z ||
        sweep.z_end != like.z)
      break;
    if (group.each > 1 && count > 0 &&
        (!sweep.follows || job.list[q] != job.list[q - 1] + 1 || sweep.length * group.each > 2 * bundle))
      break;
    group.sweep[count] = disc_sweep(job, sweep, group.solid->rim);
    group.step[count] = sweep.step;
    store(0, group.taken[count]);
  }
  group.step[kMaxSweeps] = 0;
  store(0, group.taken[kMaxSweeps]);
  return group.count = count;
}

/// Cuts with at limit `limit` level sweeps of cylinders from number `first` of the job's list on. Returns
/// their number.
HWY_NOINLINE std::size_t cut_cylinders(CylinderGroup& group, const TileJob& job, std::size_t first,
                                       std::size_t limit) {
  const int count = gather_cylinders(group, job, first, limit);
  const LaneSolid& solid = *group.solid;
  const auto z = static_cast<Real>(job.sweeps[job.list[first]].z);
  const bool open = z + solid.top >= job.field->height;
  for (std::size_t p = 0; p < solid.pieces.size(); ++p) {
    group.low[p] = z + solid.pieces[p].lower.height;
    group.high[p] = !solid.one_envelope ? z - solid.pieces[p].upper.height
                    : open              ? job.field->height + 1
                                        : z + solid.top;
  }
  prepare_bundles(group, job.field->step[1]);
  Tile& tile = *job.tile;
  unsigned supers = bundles_over(group, (1u << group.bundles) - 1u, supers_of(job), tile.super_top,
                                 tile.super_bottom, group.supers);
  for (; supers != 0; supers &= supers - 1) cylinders_over_super(group, job, __builtin_ctz(supers));
  for (int k = 0; k < count; ++k)
    job.removed[first + static_cast<std::size_t>(k)] = static_cast<double>(sum_of(load(group.taken[k])));
  return static_cast<std::size_t>(count);
}

}  // namespace kerf::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
