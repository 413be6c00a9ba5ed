// The end of a program's output.
#include "app/shown/printed.h"

#include <algorithm>

namespace kerf::app::view {
namespace {

/// Bytes that are kept until the first ones are dropped; doing that for each line would take time in
/// proportion to what is kept.
constexpr std::size_t kKept = 4 * kShownOutput;

}  // namespace

std::string shown_end(std::string_view text) {
  return std::string(text.substr(text.size() - std::min(text.size(), kShownOutput)));
}

void Printed::add(std::string_view line) {
  text_ += line.substr(0, kShownOutput);
  text_ += '\n';
  if (text_.size() > kKept) text_ = shown_end(text_);
}

}  // namespace kerf::app::view
