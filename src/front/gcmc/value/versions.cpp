// The published versions of the language that a program can name.
#include "front/gcmc/value/gcmc_options.h"

namespace kerf {

std::optional<GcmcVersion> gcmc_version_named(std::string_view text) {
  const auto is_of = [&](std::string_view line) {
    return text.substr(0, line.size()) == line && (text.size() == line.size() || text[line.size()] == '.');
  };
  if (is_of("1.8")) return GcmcVersion::v1_8;
  if (is_of("1.9")) return GcmcVersion::v1_9;
  return std::nullopt;
}

std::string_view gcmc_version_text(GcmcVersion version) {
  if (version == GcmcVersion::v1_8) return "1.8.0";
  return version == GcmcVersion::v1_9 ? "1.9.0" : "1.0.0-oracle";
}

}  // namespace kerf
