// The page: embedded in the command, served with a nonce for its scripts, or exported with its model inside.
#pragma once

#include <string>
#include <string_view>

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
/// The page as served; it fetches its data.
Page served_page();
/// One file that needs no server: the page with model, mesh and path inside, a number of instants of a milled
/// part, and its G-code.
std::string exported_page(Session& session);

/// zlib data as base64.
std::string packed(std::string_view bytes);

}  // namespace kerf::app::view
