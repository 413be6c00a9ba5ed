// Origins: the tables of their names, and rows for the origins themselves.
#include <algorithm>
#include <utility>
#include <vector>

#include "job/stored/access.h"
#include "job/stored/parts.h"

#include "kerf/base/limits.h"

namespace kerf::stored {

template <class A>
void fields(A& a, Like<A, DrawingLocation>& v) {
  auto& [file, layer, handle, x, y, entity] = v;
  values(a, file, layer, handle, x, y, entity);
}
void value(Sink& a, const DrawingLocation& v) { fields(a, v); }
void value(Source& a, DrawingLocation& v) { fields(a, v); }

namespace {

using Record = Access::Record;
using Kind = Access::Kind;

/// The number of each name; a name must not be there twice.
void number_names(Source& a, const std::vector<std::string>& names,
                  std::unordered_map<std::string, std::uint32_t>& index) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!index.try_emplace(names[i], static_cast<std::uint32_t>(i)).second) a.refuse("a name is there twice");
}

/// An origin as the difference from the one before. One byte: the kind, bits for another file, a line that is
/// not the next one, and another column.
void write_origin(Sink& a, const Record& record, Record& last) {
  const auto& [file, line, column, kind] = record;
  const unsigned bits = static_cast<unsigned>(kind) | (file != last.file ? 4u : 0u) |
                        (line != last.line + 1 ? 8u : 0u) | (column != last.column ? 16u : 0u);
  a.byte(static_cast<std::uint8_t>(bits));
  if ((bits & 4u) != 0) a.whole(file);
  if ((bits & 8u) != 0) a.signed_whole(std::int64_t{line} - last.line);
  if ((bits & 16u) != 0) a.whole(column);
  last = record;
}

std::uint32_t moved(Source& a, std::uint32_t from) {
  return from + static_cast<std::uint32_t>(static_cast<std::uint64_t>(a.signed_whole()));
}

Record read_origin(Source& a, const Record& last) {
  const unsigned bits = a.byte();
  if (bits > 31) a.refuse("an origin is unknown");
  Record r = last;
  r.kind = static_cast<Kind>(bits & 3u);
  if ((bits & 4u) != 0) r.file = static_cast<std::uint32_t>(a.whole());
  r.line = (bits & 8u) != 0 ? moved(a, last.line) : last.line + 1;
  if ((bits & 16u) != 0) r.column = static_cast<std::uint32_t>(a.whole());
  return r;
}

}  // namespace

void write_origin_tables(Sink& a, const OriginTable& table) {
  const auto& [records, files, file_index, drawings, calls, call_index, callers] =
      Access::origin_members(table);
  values(a, files, drawings, calls);
  a.whole(records.size());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sorted;
  for (const auto& [inner, outer] : callers) sorted.emplace_back(inner, static_cast<std::uint32_t>(outer));
  std::sort(sorted.begin(), sorted.end());
  a.whole(sorted.size());
  std::uint32_t last = 0;
  for (const auto& [inner, outer] : sorted) {
    a.whole(inner - std::exchange(last, inner));
    a.signed_whole(std::int64_t{outer} - inner);
  }
}

std::size_t read_origin_tables(Source& a, OriginTable& table) {
  const auto& [records, files, file_index, drawings, calls, call_index, callers] =
      Access::origin_members(table);
  values(a, files, drawings, calls);
  number_names(a, files, file_index);
  number_names(a, calls, call_index);
  const std::uint64_t count = a.whole();
  if (count == 0 || count > 2 * limits::kMaxPathSteps) a.refuse("a table of origins has a wrong size");
  std::uint64_t inner = 0;
  for (std::size_t left = a.entries(2); left > 0 && !a.failed(); --left) {
    inner += a.whole();
    const std::uint64_t outer = inner + static_cast<std::uint64_t>(a.signed_whole());
    if (inner >= count || outer >= count) a.refuse("a caller is no origin");
    callers[static_cast<std::uint32_t>(inner)] = static_cast<OriginId>(outer);
  }
  records.clear();  // the rows follow, the first of them is that of no origin
  return static_cast<std::size_t>(count);
}

void write_origins(ChunkWriter& out, const OriginTable& table) {
  const auto& records = std::get<0>(Access::origin_members(table));
  Record last;
  for (std::size_t i = 0; i < records.size(); i += kRowsPerChunk) {
    Sink a;
    for (std::size_t k = i; k < std::min(i + kRowsPerChunk, records.size()); ++k)
      write_origin(a, records[k], last);
    out.add(kOrigins, a.take());
  }
}

void read_origins(Source& a, OriginTable& table, std::size_t expected) {
  const auto& [records, files, file_index, drawings, calls, call_index, callers] =
      Access::origin_members(table);
  Record last = records.empty() ? Record{} : records.back();
  while (!a.at_end() && !a.failed()) {
    if (records.size() == expected) return a.refuse("there are too many origins");
    last = read_origin(a, last);
    const bool is_known = (last.kind == Kind::none || last.file < files.size()) &&
                          (last.kind != Kind::dxf || last.line < drawings.size()) &&
                          (last.kind != Kind::call || last.column < calls.size());
    if (!is_known || (records.empty() && last.kind != Kind::none)) a.refuse("an origin is unknown");
    records.push_back(last);
  }
}

}  // namespace kerf::stored
