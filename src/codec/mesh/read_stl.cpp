// Reads STL, binary and text. A binary file may start with "solid" too, so its length is checked first.
#include <fmt/format.h>

#include "base/number.h"
#include "codec/mesh/read_text.h"
#include "codec/mesh/readers.h"

namespace kerf::mesh_format {
namespace {

constexpr std::size_t kHeader = 84, kRecord = 50;  // bytes: header with the count, a triangle
constexpr std::size_t kNormal = 12;                // bytes of a record before its corners

bool read_binary(std::string_view bytes, std::size_t count, MeshMaker& out) {
  if (count > out.limits().triangles)
    return out.too_large(
        fmt::format("the file has {} triangles; the maximum is {}", count, out.limits().triangles));
  for (std::size_t t = 0; t < count; ++t) {
    if (!out.goes_on(t, count)) return false;
    const std::size_t at = kHeader + t * kRecord + kNormal;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const auto coordinate = [&](std::size_t axis) {
        return static_cast<double>(little_at<float>(bytes, at + 12 * corner + 4 * axis));
      };
      if (!out.add_vertex(coordinate(0), coordinate(1), coordinate(2))) return false;
    }
    if (!out.add_triangle(3 * t, 3 * t + 1, 3 * t + 2)) return false;
  }
  return true;
}

bool read_vertex(Words& words, MeshMaker& out) {
  double p[3] = {};
  for (double& coordinate : p) {
    const auto number = parse_number(words.next());
    if (!number) return out.fail("expected three numbers after \"vertex\"", words.line());
    coordinate = *number;
  }
  return out.add_vertex(p[0], p[1], p[2], words.line());
}

bool read_text(std::string_view bytes, MeshMaker& out) {
  Words words(bytes);
  std::size_t first = 0;  // vertex of the open loop
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (!out.goes_on(words.position(), bytes.size())) return false;
    if (word == "solid" || word == "endsolid") {
      words.skip_line();  // a name, which may contain any words
    } else if (word == "loop") {
      first = out.vertices();
    } else if (word == "vertex") {
      if (!read_vertex(words, out)) return false;
    } else if (word == "endloop") {
      if (out.vertices() != first + 3) return out.fail("a facet does not have three vertices", words.line());
      if (!out.add_triangle(first, first + 1, first + 2, words.line())) return false;
    }
  }
  if (out.vertices() % 3 != 0) return out.fail("the file ends within a facet", words.line());
  return true;
}

}  // namespace

bool read_stl(std::string_view bytes, MeshMaker& out) {
  const bool has_count = bytes.size() >= kHeader;
  const std::size_t count = has_count ? little_at<std::uint32_t>(bytes, kHeader - 4) : 0;
  const bool starts_as_text = bytes.substr(0, 5) == "solid";
  const std::size_t needed = kHeader + count * kRecord;
  if (has_count && (bytes.size() == needed || (!starts_as_text && bytes.size() > needed)))
    return read_binary(bytes, count, out);
  if (starts_as_text) return read_text(bytes, out);
  if (!has_count) return out.fail("the file is too short for an STL, and does not start with \"solid\"");
  return out.fail(fmt::format("the header gives {} triangles, which take {} bytes, but the file has {}",
                              count, needed, bytes.size()));
}

}  // namespace kerf::mesh_format
