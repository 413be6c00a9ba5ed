// Any bytes as a post file: no crash, and a valid profile can write a small toolpath.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "kerf/program/post.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  kerf::Diagnostics diagnostics(5);
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto profile = kerf::read_post_profile(text, "post.toml", diagnostics);
  if (!profile) return 0;
  kerf::Toolpath path;
  path.add(kerf::step::ToolChange{1}, kerf::OriginId::none);
  path.add(kerf::step::Spindle{kerf::rpm(1000), kerf::SpindleTurn::cw}, kerf::OriginId::none);
  path.add(kerf::step::Rapid{{0, 0, 1}}, kerf::OriginId::none);
  path.add(kerf::step::Arc{.to = {2, 0, 0}, .centre = {1, 0}, .feed = kerf::mm_per_min(100)},
           kerf::OriginId::none);
  for (const kerf::PostedFile& file : kerf::post(path, *profile, {}, diagnostics))
    kerf::lint_gcode(file.text, *profile, "written", diagnostics);
  return 0;
}
