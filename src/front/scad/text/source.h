// The source texts of an OpenSCAD program: its file, the files that it includes or uses, and definitions of
// the command line. They are read by a function that is passed in.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"

namespace kerf::scad {

/// A location in one of the sources.
struct Position {
  std::uint32_t source = 0, line = 0, column = 0;
};

struct Source {
  std::string name;
  std::string text;
  std::string identity;  // of the file: the same for all spellings of its name
};

/// Reads the file that `include <name>` or `use <name>` in file `from` refers to; nothing if there is none.
/// The result's name is its path.
using ReadSource = std::function<std::optional<Source>(const std::string& name, const std::string& from)>;

/// All sources of a program; positions refer to them by index.
class Sources {
 public:
  std::uint32_t add(Source source) {
    list_.push_back(std::make_unique<Source>(std::move(source)));
    return static_cast<std::uint32_t>(list_.size() - 1);
  }
  const Source& operator[](std::uint32_t i) const { return *list_[i]; }
  std::size_t size() const { return list_.size(); }
  TextLocation locate(Position at) const { return {list_[at.source]->name, at.line, at.column}; }

 private:
  std::vector<std::unique_ptr<Source>> list_;
};

}  // namespace kerf::scad
