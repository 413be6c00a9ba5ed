// Files made from the shown part: exact meshes, a picture, G-code.
#pragma once

#include <string>

#include "app/shown/shown.h"

namespace kerf::app::view {

struct Download {
  std::string bytes, type, name;  // type: of the header Content-Type
  std::string problem;            // why there is none; empty: there is one
};
struct DownloadRequest {
  std::string format;  // "stl", "3mf", "glb", "obj", "png", "gcode" or "burn"
  std::string post;    // of G-code: a target of kerf post; empty: grbl
  std::string view;    // of a picture; empty: that of kerf simulate
};
/// Runs the job again at the usual resolution of files.
Download make_download(const Shown& shown, const DownloadRequest& request, unsigned threads);

}  // namespace kerf::app::view
