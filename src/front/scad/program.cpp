// A whole OpenSCAD program: its files, its parse, its run, and what its shapes are.
#include <algorithm>
#include <fmt/format.h>

#include "base/file_names.h"
#include "front/scad/run/solids.h"
#include "front/scad/scad.h"
#include "front/scad/text/parser.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"
#include "kerf/stock/stock.h"

namespace kerf {
namespace {

using namespace scad;

/// Finds files of include and use: beside the file that names them, then in the folders of the options.
class Files {
 public:
  explicit Files(const ScadOptions& options) : options_(options) {}

  std::optional<Source> operator()(const std::string& name, const std::string& from) const {
    if (name.empty() || name.find('\0') != std::string::npos) return std::nullopt;
    if (auto source = open(path_beside(from, name))) return source;
    if (is_absolute(name)) return std::nullopt;
    for (const std::string& folder : options_.include_paths)
      if (auto source = open(path_in(folder, name))) return source;
    return std::nullopt;
  }

 private:
  static std::optional<Source> open(const std::string& path) {
    Diagnostics ignored;
    const auto file = InputFile::open(path, ignored, limits::kMaxGcmcSourceBytes);
    if (!file) return std::nullopt;
    return Source{normal_path(path), std::string(file->bytes()), resolved_path(path)};
  }
  const ScadOptions& options_;
};

KnownModule known_module(const BuiltinModule& m) {
  KnownModule known{static_cast<int>(&m - builtin_modules().data()), m.positional, m.positional.size(),
                    m.evaluated == ModuleArguments::first};
  known.parameters.insert(known.parameters.end(), m.named.begin(), m.named.end());
  return known;
}

KnownNames known_names(const CommandSet& commands) {
  KnownNames known;
  for (const BuiltinFunction& f : builtin_functions()) {
    known.functions.emplace(f.name, static_cast<int>(&f - builtin_functions().data()));
    if (f.of_number != nullptr) known.of_number.emplace(f.name, f.of_number);
  }
  for (const BuiltinModule& m : builtin_modules()) known.modules.emplace(m.name, known_module(m));
  if (commands.commands != nullptr)
    for (const Command& c : *commands.commands)
      known.commands.emplace(c.name, static_cast<int>(&c - commands.commands->data()));
  return known;
}

bool is_block(const Shape& s) {
  if (s.slabs.size() != 1 || !s.bodies.empty()) return false;
  const Box2 box = bounds(s.slabs[0].region);
  return area(s.slabs[0].region) >= (1.0 - 1e-12) * (box.high.x - box.low.x) * (box.high.y - box.low.y);
}

/// A solid as material: a block where it is one, else a mesh.
std::optional<Stock> material_of(Interpreter& run, Shape s, const std::string& name,
                                 Diagnostics& diagnostics) {
  if (s.is_empty()) return std::nullopt;
  if (is_block(s)) return Stock{bounds_of(s)};
  append_bodies(run, s, {0, 1, 1});
  if (s.bodies.empty()) return std::nullopt;
  SolidBody all = std::move(s.bodies[0]);
  for (std::size_t i = 1; i < s.bodies.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(all.positions.size() / 3);
    all.positions.insert(all.positions.end(), s.bodies[i].positions.begin(), s.bodies[i].positions.end());
    for (const std::uint32_t t : s.bodies[i].triangles) all.triangles.push_back(first + t);
  }
  const auto body = make_mesh_body(all.positions, all.triangles, name, diagnostics);
  if (!body) return std::nullopt;
  return stock_of(body);
}

void keep_shapes(Interpreter& interpreter, Shapes shapes, const ScadOptions& options, ScadRun& run,
                 Diagnostics& diagnostics) {
  Shapes areas, solids;
  for (Shape& s : shapes) (s.kind == Shape::Kind::area ? areas : solids).push_back(std::move(s));
  try {
    if (!areas.empty()) run.area = united(interpreter, std::move(areas), {0, 1, 1}).region;
    if (!solids.empty())
      run.material = material_of(interpreter, united(interpreter, std::move(solids), {0, 1, 1}),
                                 options.file_name, diagnostics);
  } catch (const Stop&) {  // reported
  }
}

}  // namespace

ScadRun run_scad(std::string_view text, const ScadOptions& options, Diagnostics& diagnostics,
                 Progress* progress) {
  const CommandSet none;
  const CommandSet& commands = options.commands == nullptr ? none : *options.commands;
  Diagnostics own;  // errors of other inputs do not keep the program from running
  const Files files(options);
  const auto program = parse({options.file_name, std::string(text), {}}, options.defines, files, {},
                             known_names(commands), own);
  ScadRun run;
  run.files.assign(program->files.begin() + 1, program->files.end());
  for (const CustomParameter& p : program->parameters)
    run.parameters.push_back({p.name, p.value, p.group, p.description, p.choices, p.at.line});
  const bool is_valid = !own.has_errors();
  for (const Diagnostic& d : own.list()) diagnostics.add(d);
  if (!is_valid) return run;
  RunLimits limits;
  limits.max_memory = options.max_memory;
  limits.max_steps = options.max_steps;
  limits.max_stack = options.max_stack;
  limits.max_range = options.max_range;
  limits.max_output = options.max_output;
  Interpreter interpreter(*program, limits, commands, {run.output, options.printed}, diagnostics, progress);
  keep_shapes(interpreter, interpreter.run(), options, run, diagnostics);
  run.stopped = interpreter.stopped();
  run.files.insert(run.files.end(), interpreter.files().paths.begin(), interpreter.files().paths.end());
  return run;
}

std::vector<std::string> scad_names() {
  std::vector<std::string> names;
  for (const scad::BuiltinFunction& function : scad::builtin_functions()) names.emplace_back(function.name);
  for (const scad::BuiltinModule& module : scad::builtin_modules()) names.emplace_back(module.name);
  return names;
}

}  // namespace kerf
