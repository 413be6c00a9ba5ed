// What the commands of an OpenSCAD program write.
#pragma once

#include <string>

#include "kerf/base/units.h"
#include "kerf/path/toolpath.h"

namespace kerf {

/// A drawing or another text of a program.
struct ScadFile {
  std::string name, bytes;
};
/// A G-code file of a program.
struct ScadProgram {
  std::string name;
  std::string post;  // the name of a built-in post, or a post file
  Toolpath path;
  Feed missing_feed;  // of cuts without one
};

}  // namespace kerf
