// Names of files that a page saves or uploads.
#pragma once

#include <string>
#include <string_view>

namespace kerf::app::view {

/// A file name for a Content-Disposition header and for a folder of uploaded files: letters, digits, ".", "-"
/// and "_", at most 100.
std::string download_name(std::string_view name);

}  // namespace kerf::app::view
