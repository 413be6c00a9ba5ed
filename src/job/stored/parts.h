// The stored forms of tools, stock and toolpaths, used by those of single values and of whole programs.
#pragma once

#include <string>

#include "job/stored/container.h"
#include "job/stored/values.h"

#include "kerf/base/diagnostics.h"
#include "kerf/path/toolpath.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf::stored {

void value(Sink& a, const Tool& tool);
void value(Source& a, Tool& tool);
void value(Sink& a, const ToolTable& table);
void value(Source& a, ToolTable& table);

void value(Sink& a, const Stock& stock);
/// Warnings of its mesh, as when it was read first, go to `diagnostics`.
void read_stock(Source& a, Stock& stock, Diagnostics& diagnostics);

inline constexpr std::size_t kRowsPerChunk = 1 << 16;  // of steps, and of origins

void write_origin_tables(Sink& a, const OriginTable& table);
/// Returns the number of origins that follow as rows.
std::size_t read_origin_tables(Source& a, OriginTable& table);
void write_origins(ChunkWriter& out, const OriginTable& table);
void read_origins(Source& a, OriginTable& table, std::size_t expected);

/// Appends the chunks of a toolpath.
void write_path(ChunkWriter& out, const Toolpath& path);
/// Reads chunks up to the end of the file, `first` before them. False, with an error, if they are damaged.
bool read_path(ChunkReader& in, ChunkReader::Chunk first, Toolpath& path);

}  // namespace kerf::stored
