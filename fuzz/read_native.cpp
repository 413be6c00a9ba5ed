// Fuzz target: programs in the languages of machines, OpenSBP and RML-1. What was read is written and read
// again: it has the same ends of its motions. The first byte selects the language.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "back/native/native.h"
#include "front/native/native_program.h"

namespace {

constexpr double kSame = 0.02;  // mm: half a step of RML-1, and rounding

std::vector<kerf::Point3> ends_of(const kerf::Toolpath& path) {
  std::vector<kerf::Point3> ends;
  for (const kerf::Step& s : path.steps())
    if (s.is_motion() && s.reference() == kerf::Reference::work && s.unknown_axes() == 0)
      ends.push_back(s.to());
  return ends;
}

bool same(const kerf::Point3& a, const kerf::Point3& b) {
  const double far = 1e-9 * std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
  return std::abs(a.x - b.x) < kSame + far && std::abs(a.y - b.y) < kSame + far &&
         std::abs(a.z - b.z) < kSame + far;
}

/// Whether positions are known from the first motion that has all axes on: what is unknown is written as a
/// motion to the highest Z.
bool stays_known(const kerf::Toolpath& path) {
  bool known = false;
  for (const kerf::Step& s : path.steps()) {
    if (!s.is_motion()) continue;
    if (s.reference() != kerf::Reference::work || (known && s.unknown_axes() != 0)) return false;
    known = known || s.unknown_axes() == 0;
  }
  return true;
}

/// The last position is that of the source: in between there may be fewer motions, those of no length.
void compare(const kerf::Toolpath& before, const kerf::Toolpath& after) {
  const auto a = ends_of(before), b = ends_of(after);
  if (!a.empty() && !b.empty() && !same(a.back(), b.back())) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const bool sbp = data[0] == 's';
  (void)kerf::looks_like_opensbp(text);
  (void)kerf::looks_like_rml(text);
  kerf::Diagnostics diagnostics, writing, again;
  const kerf::NativeProgram read =
      sbp ? kerf::read_opensbp(text, "a", diagnostics) : kerf::read_rml(text, "a", diagnostics);
  if (diagnostics.has_errors()) return 0;
  kerf::NativeOptions options;
  options.missing_feed = kerf::mm_per_min(100);
  options.tool_change = kerf::NativeToolChange::ignore;
  const auto files = sbp ? kerf::write_opensbp(read.path, options, writing)
                         : kerf::write_rml(read.path, {}, options, writing);
  if (writing.has_errors()) return 0;
  const kerf::NativeProgram written =
      sbp ? kerf::read_opensbp(files.at(0).text, "b", again) : kerf::read_rml(files.at(0).text, "b", again);
  if (again.has_errors()) std::abort();
  if (stays_known(read.path)) compare(read.path, written.path);
  return 0;
}
