// The volume of a bead.
#include "path/bead.h"

#include <numbers>

namespace kerf {

Volume bead_volume(Length length, Length width, Length height) {
  const double w = width.mm(), h = height.mm();
  return mm3(length.mm() * ((w - h) * h + std::numbers::pi / 4.0 * h * h));
}

}  // namespace kerf
