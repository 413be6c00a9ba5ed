// The words of programs for lathes.
#include "front/gcode/run/lathe_words.h"

#include <iterator>

#include "base/codes/gcode.h"

namespace kerf::gcode {

/// Words that programs for lathes have: diameters (G7, G8), the plane of X and Z (G18), feeds per turn (G95),
/// cutting speeds (G96, G97), threads (G76).
void LatheWords::note() {
  const bool signs[] = {line_.has(Group::lathe), line_.has(Group::plane) && line_.code(Group::plane) == 180,
                        line_.has(Group::feed_mode) && line_.code(Group::feed_mode) == 950,
                        line_.has(Group::spindle_mode),
                        line_.has(Group::motion) && line_.code(Group::motion) == 760};
  for (std::size_t i = 0; i < std::size(signs); ++i) {
    if (!signs[i]) continue;
    if (kinds_ == 0) where_ = reporter_.location(line_.column());
    kinds_ |= 1u << i;
  }
}

/// A program with words of two kinds that moves in X and Z only is one for a lathe.
void LatheWords::report() {
  if ((kinds_ & (kinds_ - 1)) == 0) return;
  constexpr unsigned kY = 2;
  bool cuts = false;
  for (const Step& s : path_.steps()) {
    if (s.is_motion() && (s.named_axes() & kY) != 0) return;
    cuts = cuts || s.is_cutting();
  }
  if (cuts)
    reporter_.unusual_at(
        where_, codes::turning_program,
        "the program seems to be for a lathe; turning is not supported, it is read as milling", "");
}

}  // namespace kerf::gcode
