// Occlusion, up to sixteen points at a time: for each processor level, chosen at run time. No operation is
// fused or approximate, so that all levels return the same bits.
#include "sim/render/occlusion.h"

// Excluded: levels that are hardly faster than those below them, as each costs a compilation, and SVE, whose
// vectors have no size at compile time.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/render/occlusion.cpp"
#include <hwy/foreach_target.h>  // NOLINT: this file again, once per level
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kerf::rendering::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void occlusion_of(const OcclusionRow& row) {
  const hn::CappedTag<float, kOcclusionLanes> tag;
  using Vector = hn::Vec<decltype(tag)>;
  constexpr float kSlant = 0.08f;  // sine; lower horizons are unevenness of the surface itself
  const float square_radius = row.radius * row.radius;
  const Vector limit = hn::Set(tag, square_radius), slant = hn::Set(tag, kSlant), one = hn::Set(tag, 1.0f);
  const Vector zero = hn::Zero(tag);
  const auto width = static_cast<int>(hn::Lanes(tag));
  const PixelPoints& points = *row.points;
  for (int k = 0; k < row.count; k += width) {
    const auto from = static_cast<std::size_t>(k);
    const Vector nx = hn::LoadU(tag, row.normal_right + from), ny = hn::LoadU(tag, row.normal_up + from);
    const Vector nz = hn::LoadU(tag, row.normal_into + from);
    const std::size_t at = points.index(row.x, row.y) + from;
    const Vector px = hn::LoadU(tag, points.right() + at), py = hn::LoadU(tag, points.up() + at);
    const Vector pz = hn::LoadU(tag, points.into() + at);
    Vector sum = zero;
    for (const Ray& ray : *row.rays) {
      Vector highest = zero;
      for (const RayOffset& offset : ray) {
        const int y = row.y + offset.y;
        if (y < 0 || y >= points.height()) break;
        const std::size_t of = points.index(row.x + offset.x, y) + from;
        const Vector dx = hn::Sub(hn::LoadU(tag, points.right() + of), px);
        const Vector dy = hn::Sub(hn::LoadU(tag, points.up() + of), py);
        const Vector dz = hn::Sub(hn::LoadU(tag, points.into() + of), pz);
        const Vector height = hn::Add(hn::Add(hn::Mul(nx, dx), hn::Mul(ny, dy)), hn::Mul(nz, dz));
        const Vector square = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
        const auto counts = hn::And(hn::Gt(height, zero), hn::Lt(square, limit));
        const Vector sine = hn::Sub(hn::Div(height, hn::Sqrt(square)), slant);
        const Vector fading = hn::Sub(one, hn::Div(square, limit));
        highest = hn::IfThenElse(counts, hn::Max(highest, hn::Mul(sine, fading)), highest);
      }
      sum = hn::Add(sum, highest);
    }
    sum = hn::Min(one, hn::Div(sum, hn::Set(tag, static_cast<float>(kDirections))));
    hn::StoreU(sum, tag, row.result + from);
  }
}

}  // namespace kerf::rendering::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "sim/render/render_raster.h"

namespace kerf::rendering {

HWY_EXPORT(occlusion_of);

PixelPoints::PixelPoints(int width, int height, int reach)
    : height_(height),
      margin_((reach + kStride - 1) / kStride),
      columns_((width + kStride - 1) / kStride + 2 * margin_ + kOcclusionLanes) {
  const std::size_t size = static_cast<std::size_t>(kStride * height) * static_cast<std::size_t>(columns_);
  fill(right_, size, 0.0f);
  fill(up_, size, 0.0f);
  fill(into_, size, kFarDepth);
}

void occlusion_of(const OcclusionRow& row) { HWY_DYNAMIC_DISPATCH(occlusion_of)(row); }

}  // namespace kerf::rendering
#endif
