// Parses an OpenSCAD program with all files that it includes and uses.
#pragma once

#include <string>
#include <vector>

#include "front/scad/text/syntax.h"

#include "kerf/base/limits.h"

namespace kerf::scad {

struct ParseLimits {
  std::size_t max_nodes = limits::kMaxSyntaxNodes;
  int max_nesting = limits::kMaxStatementDepth;
  std::size_t max_includes = limits::kMaxIncludeDepth;
  std::size_t max_files = limits::kMaxSourceFiles;
};

/// Numbers of what is built in, by name.
/// A module of the interpreter: arguments without a name are those of the first `positional` parameters.
struct KnownModule {
  int number = 0;
  std::vector<std::string_view> parameters;
  std::size_t positional = 0;
  bool one_argument = false;  // evaluates the first one only, whatever its name
};

struct KnownNames {
  std::unordered_map<std::string, int> functions, commands;
  std::unordered_map<std::string, KnownModule> modules;
  std::unordered_map<std::string, double (*)(double)> of_number;  // functions of one number
};

/// The text of `main`, then the assignments of `defines` ("depth=5"), which replace those of the text. Errors
/// are reported, all of the text; a program with errors must not be run.
std::unique_ptr<Program> parse(Source main, const std::vector<std::string>& defines, const ReadSource& read,
                               const ParseLimits& limits, const KnownNames& known, Diagnostics& diagnostics);

}  // namespace kerf::scad
