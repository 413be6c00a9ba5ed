// The page: embedded in the command, served with a nonce for its scripts, or exported with its model inside.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/view/session.h"

namespace kerf::app::view {

/// Whether this build has the page that the folder web makes; else pages show the part without controls.
bool has_full_page();
/// The text of the page, as built.
std::string_view page_text();

struct Page {
  std::string html;
  std::string policy;  // of the header Content-Security-Policy
};
/// The page as served; it fetches its data. Pages of these origins, and no others, may have it in a frame.
Page served_page(const std::vector<std::string>& frame_origins = {});
/// One file that needs no server: the page with model, mesh and path inside, a number of instants of a milled
/// part, and its G-code.
std::string exported_page(Session& session);

/// zlib data as base64.
std::string packed(std::string_view bytes);

}  // namespace kerf::app::view
