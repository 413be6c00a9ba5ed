// Texts of users inside XML and HTML.
#pragma once

#include <string>
#include <string_view>

namespace kerf {

/// The text with &, <, > and both quotes as entities, for content and attributes. Bytes that are not UTF-8
/// become the characters of their values, and characters that XML does not permit are left out.
std::string markup_text(std::string_view text);

}  // namespace kerf
