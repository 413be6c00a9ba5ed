// The paths of all drawings that a run reads: found by name, built with the values of their variables.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "front/pathdxf/model/drawing.h"
#include "front/pathdxf/model/path.h"

namespace kerf::pathdxf {

/// Whether a path is the one that becomes a program, or is embedded in one.
enum class PathRole : std::uint8_t { main, checked, embedded };

class Library {
 public:
  Library(const PathdxfOptions& options, Report& report) : options_(options), report_(report) {}

  /// Reads a drawing, unless it is known already. The result stays valid.
  const DrawingPaths& load(const std::string& file, const PathNames& names);

  struct Found {
    const DrawingPaths* drawing = nullptr;
    const PathDrawing* path = nullptr;
  };
  /// The path of a name: of a drawing read already, else of the files whose names match, in `folder` and in
  /// those of the options. All of these are read.
  Found find(const std::string& name, const std::string& folder, const PathNames& names);

  /// The names of all files read, in their order.
  std::vector<std::string> files() const;

  struct BuiltPath {
    std::shared_ptr<const Path> path;  // null: errors were reported
    bool in_progress = false;
  };
  /// What was built before, by name, role and values of variables.
  std::map<std::string, BuiltPath>& built() { return built_; }

 private:
  void search(const std::string& folder, const std::string& name, const PathNames& names);

  const PathdxfOptions& options_;
  Report& report_;
  std::vector<std::unique_ptr<DrawingPaths>> drawings_;
  std::map<std::string, std::size_t> by_file_;  // canonical names
  std::map<std::string, Found> by_name_;
  std::map<std::string, std::vector<std::string>> folders_;  // with their DXF files
  std::map<std::string, BuiltPath> built_;
};

/// Builds a path: orders its elements, gives them their parameters, and builds the paths embedded in it.
/// Null, with errors reported, where that is impossible.
std::shared_ptr<const Path> build_path(Library& library, const PathNames& names, const Library::Found& found,
                                       PathRole role, const Variables& variables,
                                       const PathdxfOptions& options, Report& report);

/// Example values for the variables of a path (/c). Empty where it has none, or its definitions are invalid.
Variables example_values(const Library::Found& found);

}  // namespace kerf::pathdxf
