// The paths of all drawings that a run reads: found by name, built with the values of their variables.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "front/pathdxf/model/drawing.h"
#include "front/pathdxf/model/path.h"
#include "front/pathdxf/text/restriction.h"

namespace kerf::pathdxf {

/// Whether a path is the one that becomes a program, or is embedded in one.
enum class PathRole : std::uint8_t { main, checked, embedded };

class Library {
 public:
  Library(PathNames names, std::vector<Restriction> restrictions, const PathdxfOptions& options,
          Report& report)
      : names_(std::move(names)),
        restrictions_(std::move(restrictions)),
        options_(options),
        report_(report) {}

  const PathNames& names() const { return names_; }
  const std::vector<Restriction>& restrictions() const { return restrictions_; }
  const PathdxfOptions& options() const { return options_; }
  Report& report() { return report_; }

  /// Reads a drawing, unless it is known already. The result stays valid.
  const DrawingPaths& load(const std::string& file);

  struct Found {
    const DrawingPaths* drawing = nullptr;
    const PathDrawing* path = nullptr;
  };
  /// The path of a name: of a drawing read already, else of the files whose names match, in `folder` and in
  /// those of the options. All of these are read.
  Found find(const std::string& name, const std::string& folder);

  /// The names of all files read, in their order.
  std::vector<std::string> files() const;

 private:
  std::vector<std::string> drawings_in(const std::string& folder);
  void search(const std::string& folder, const std::string& name);

  PathNames names_;
  std::vector<Restriction> restrictions_;  // of the options
  const PathdxfOptions& options_;
  Report& report_;
  std::vector<std::unique_ptr<DrawingPaths>> drawings_;
  std::map<std::string, std::size_t> by_file_;  // canonical names
  std::map<std::string, Found> by_name_;
  std::map<std::string, std::vector<std::string>> folders_;  // with their DXF files
};

/// Builds paths: orders their elements, gives them their parameters, and builds the paths embedded in them.
/// Each is built once per set of values of its variables.
class PathBuilder {
 public:
  explicit PathBuilder(Library& library) : library_(library) {}
  /// Null, with errors reported, where that is impossible.
  std::shared_ptr<const Path> build(const Library::Found& found, PathRole role, const Variables& variables);

 private:
  friend class PathAssembly;
  struct Built {
    std::shared_ptr<const Path> path;  // null: errors were reported
    bool in_progress = true;
  };

  Library& library_;
  std::map<std::string, Built> built_;  // by name, role and values of variables
  int depth_ = 0;                       // of the path in progress
};

/// Reports values that are missing, not defined or not permitted. `where` is what gives them.
void check_values(const Variables& values, const Library::Found& found, const Origin& where, Report& report);
/// Example values for the variables of a path (/c); those with an invalid definition are left out.
Variables example_values(const Library::Found& found);
/// Those of a path that is not embedded, by the options.
Variables main_values(const Library::Found& found, const PathdxfOptions& options, Report& report);

}  // namespace kerf::pathdxf
