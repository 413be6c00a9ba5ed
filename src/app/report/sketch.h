// A tool's silhouette drawn with characters, for a terminal.
#pragma once

#include <string>

#include "kerf/tool/tool.h"

namespace kerf::app {

/// About `rows` lines: '#' cuts, '=' neck, '|' shank, 'H' holder, with heights in mm at the left.
std::string sketch(const Silhouette& silhouette, int rows = 24);

}  // namespace kerf::app
