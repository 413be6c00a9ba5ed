// Fuzz target: programs, toolpaths, tools and stock as files. The first byte selects what is read. From 'A'
// on the bytes are the fields, or the tables of a toolpath and its rows, in a file with a right checksum.
#include "kerf/job/program_file.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "job/stored/container.h"

namespace {

using kerf::Diagnostics;

/// What is read writes bytes that are read as the same.
template <class T>
void check(std::string_view bytes,
           std::optional<T> (*read)(std::string_view, const std::string&, Diagnostics&),
           std::string (*write)(const T&)) {
  Diagnostics diagnostics;
  const auto value = read(bytes, "fuzz", diagnostics);
  if (value.has_value() == diagnostics.has_errors() || diagnostics.errors() > 1) std::abort();
  if (!value) return;
  const std::string written = write(*value);
  const auto again = read(written, "fuzz", diagnostics);
  if (!again || write(*again) != written) std::abort();
}

void check_path(std::string_view bytes) {
  check<kerf::Toolpath>(bytes, kerf::read_toolpath, kerf::write_toolpath);
  Diagnostics ignored;
  const auto path = kerf::read_toolpath(bytes, "fuzz", ignored);
  if (!path) return;
  for (std::size_t i = 0; i < path->size(); ++i)
    if (kerf::to_string(path->origin_of(i)).size() > bytes.size() + 200) std::abort();
  for_each_motion(*path, [](const kerf::Step&, const kerf::MotionContext&) {});
}

/// The tables up to the first byte 0xff, 0xff; then the origins, then the rows of steps.
std::string toolpath_of(std::string_view bytes) {
  kerf::stored::ChunkWriter out(kerf::stored::Content::toolpath);
  for (const kerf::stored::Tag tag : {kerf::stored::kTables, kerf::stored::kOrigins, kerf::stored::kSteps}) {
    const std::size_t end = std::min(bytes.find("\xff\xff"), bytes.size());
    out.add(tag, bytes.substr(0, end));
    bytes.remove_prefix(std::min(bytes.size(), end + 2));
  }
  return out.finish();
}

std::string value_of(kerf::stored::Content content, std::string_view fields) {
  kerf::stored::ChunkWriter out(content);
  out.add(kerf::stored::kFields, fields);
  return out.finish();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  using kerf::stored::Content;
  switch (data[0]) {
    case 'p': check<kerf::Program>(bytes, kerf::read_program, kerf::write_program); break;
    case 't': check_path(bytes); break;
    case 'A': check_path(toolpath_of(bytes)); break;
    case 'B': check<kerf::Tool>(value_of(Content::tool, bytes), kerf::read_tool, kerf::write_tool); break;
    case 'C': check<kerf::Stock>(value_of(Content::stock, bytes), kerf::read_stock, kerf::write_stock); break;
    default: break;
  }
  return 0;
}
