// Whole programs and single values as files.
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "job/stored/parts.h"

#include "kerf/base/limits.h"
#include "kerf/job/program_file.h"

namespace kerf {
namespace stored {

template <>
inline constexpr ProgramUnits kLast<ProgramUnits> = ProgramUnits::inch;
template <>
inline constexpr ToolsOfProgram kLast<ToolsOfProgram> = ToolsOfProgram::whole;
template <>
inline constexpr ProgramEnd kLast<ProgramEnd> = ProgramEnd::missing;

void value(Sink& a, const HeightTarget& v) {
  const auto& [variable, at, expected] = v;
  values(a, variable, at, expected);
}
void value(Source& a, HeightTarget& v) {
  auto& [variable, at, expected] = v;
  values(a, variable, at, expected);
}

void value(Sink& a, const RoundBar& v) {
  const auto& [diameter, x_low, x_high, axis_y, axis_z] = v;
  values(a, diameter, x_low, x_high, axis_y, axis_z);
}
void value(Source& a, RoundBar& v) {
  auto& [diameter, x_low, x_high, axis_y, axis_z] = v;
  values(a, diameter, x_low, x_high, axis_y, axis_z);
  const bool is_bar = diameter > 0.0 && diameter <= limits::kMaxBarSize && x_low < x_high &&
                      x_high - x_low <= limits::kMaxBarSize;
  for (const double at : {x_low, x_high, axis_y, axis_z})
    if (!is_bar || std::abs(at) > limits::kMaxCoordinate) a.refuse("a bar has no size");
}

namespace {

/// Stock needs the diagnostics of its reader.
template <class A>
void stock_field(A& a, Like<A, Stock>& stock, [[maybe_unused]] Diagnostics* diagnostics) {
  if constexpr (A::kReads)
    read_stock(a, stock, *diagnostics);
  else
    value(a, stock);
}

template <class A>
void stock_field(A& a, Like<A, std::optional<Stock>>& stock, Diagnostics* diagnostics) {
  bool has = stock.has_value();
  if constexpr (A::kReads) {
    value(a, has);
    if (has) stock_field(a, stock.emplace(), diagnostics);
  } else {
    value(a, has);
    if (has) stock_field(a, *stock, diagnostics);
  }
}

template <class A>
void fixtures_field(A& a, Like<A, std::vector<Fixture>>& fixtures, Diagnostics* diagnostics) {
  if constexpr (A::kReads)
    fixtures.resize(a.entries(sizeof(Box3)));
  else
    a.whole(fixtures.size());
  for (auto& fixture : fixtures) {
    auto& [name, solid] = fixture;
    value(a, name);
    stock_field(a, solid, diagnostics);
  }
}

/// All members but the toolpath, which has chunks of its own.
template <class A>
void fields(A& a, Like<A, Program>& v, Diagnostics* diagnostics) {
  auto& [source, front_end, path, units, tools, tools_are, tools_beside, stock, bar, fixtures, spoilboard,
         filament_diameter, filament_density, units_given, end, manual_spindle, probes, assumed_diameter,
         states_tool_lengths, files] = v;
  values(a, source, front_end, units, tools, tools_are, tools_beside);
  stock_field(a, stock, diagnostics);
  value(a, bar);
  fixtures_field(a, fixtures, diagnostics);
  values(a, spoilboard, filament_diameter, filament_density, units_given, end, manual_spindle, probes,
         assumed_diameter, states_tool_lengths, files);
}

/// Values that a program cannot have.
void check(Source& a, const Program& v) {
  const auto is_size = [](const std::optional<double>& size) {
    return !size || (*size > 0.0 && *size <= limits::kMaxToolSize);
  };
  if (!is_size(v.filament_diameter) || !is_size(v.filament_density) || !is_size(v.assumed_diameter))
    a.refuse("a diameter or density is out of range");
  if (v.spoilboard < Length() || v.spoilboard.mm() > limits::kMaxStockSize)
    a.refuse("a spoilboard has a wrong thickness");
  for (const Fixture& fixture : v.fixtures)
    if (!is_solid(fixture.solid)) a.refuse("a fixture has no volume");
}

std::string written(Content content, Sink& fields) {
  ChunkWriter out(content);
  out.add(kFields, fields.take());
  return out.finish();
}

/// The fields of a file with a single value; false, with an error, if it is damaged.
template <class Read>
bool read_fields(std::string_view bytes, Content content, const std::string& name, Diagnostics& diagnostics,
                 Read read) {
  ChunkReader in(bytes, name, diagnostics);
  if (!in.open(content)) return false;
  const auto chunk = in.next();
  if (!chunk) return false;
  if (chunk->tag != kFields) return in.damaged("its fields are missing");
  Source a(chunk->bytes, in.version());
  read(a);
  if (a.failed()) return in.damaged(a.fault());
  if (!a.at_end()) return in.damaged("bytes follow its fields");
  const auto end = in.next();
  return end && (end->tag == kEnd || in.damaged("a chunk is unknown"));
}

}  // namespace
}  // namespace stored

bool is_program_file(std::string_view bytes) { return stored::has_head(bytes); }

std::string write_program(const Program& program) {
  stored::Sink a;
  stored::fields(a, program, nullptr);
  stored::ChunkWriter out(stored::Content::program);
  out.add(stored::kFields, a.take());
  stored::write_path(out, program.path);
  return out.finish();
}

std::optional<Program> read_program(std::string_view bytes, const std::string& name,
                                    Diagnostics& diagnostics) {
  stored::ChunkReader in(bytes, name, diagnostics);
  if (!in.open(stored::Content::program)) return std::nullopt;
  auto chunk = in.next();
  if (!chunk) return std::nullopt;
  Program program;
  stored::Source a(chunk->bytes, in.version());
  if (chunk->tag != stored::kFields) a.refuse("its fields are missing");
  stored::fields(a, program, &diagnostics);
  stored::check(a, program);
  if (!a.at_end()) a.refuse("bytes follow its fields");
  if (a.failed()) {
    in.damaged(a.fault());
    return std::nullopt;
  }
  chunk = in.next();
  if (!chunk || !stored::read_path(in, *chunk, program.path)) return std::nullopt;
  return program;
}

std::string write_toolpath(const Toolpath& path) {
  stored::ChunkWriter out(stored::Content::toolpath);
  stored::write_path(out, path);
  return out.finish();
}

std::optional<Toolpath> read_toolpath(std::string_view bytes, const std::string& name,
                                      Diagnostics& diagnostics) {
  stored::ChunkReader in(bytes, name, diagnostics);
  if (!in.open(stored::Content::toolpath)) return std::nullopt;
  const auto chunk = in.next();
  Toolpath path;
  if (!chunk || !stored::read_path(in, *chunk, path)) return std::nullopt;
  return path;
}

std::string write_tool(const Tool& tool) {
  stored::Sink a;
  value(a, tool);
  return stored::written(stored::Content::tool, a);
}

std::optional<Tool> read_tool(std::string_view bytes, const std::string& name, Diagnostics& diagnostics) {
  Tool tool;
  const bool good = stored::read_fields(bytes, stored::Content::tool, name, diagnostics,
                                        [&tool](stored::Source& a) { value(a, tool); });
  return good ? std::optional(std::move(tool)) : std::nullopt;
}

std::string write_stock(const Stock& stock) {
  stored::Sink a;
  value(a, stock);
  return stored::written(stored::Content::stock, a);
}

std::optional<Stock> read_stock(std::string_view bytes, const std::string& name, Diagnostics& diagnostics) {
  Stock stock;
  const bool good =
      stored::read_fields(bytes, stored::Content::stock, name, diagnostics,
                          [&](stored::Source& a) { stored::read_stock(a, stock, diagnostics); });
  return good ? std::optional(std::move(stock)) : std::nullopt;
}

}  // namespace kerf
