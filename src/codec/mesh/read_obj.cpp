// Reads Wavefront OBJ: vertices and faces; faces with more than three vertices become fans. Everything else
// is ignored.
#include "base/number.h"
#include "codec/mesh/read_text.h"
#include "codec/mesh/readers.h"

namespace kerf::mesh_format {
namespace {

/// The vertex of "7", "7/1", "7//3" or "-1" (the last one); nothing if it does not exist.
std::optional<std::uint64_t> vertex_of(std::string_view word, std::size_t count) {
  const auto number = parse_number(word.substr(0, word.find('/')));
  if (!number) return std::nullopt;
  const double index = *number > 0.0 ? *number - 1.0 : *number + static_cast<double>(count);
  if (!(index >= 0.0) || !(index < static_cast<double>(count))) return std::nullopt;
  return static_cast<std::uint64_t>(index);
}

bool read_face(Words& words, MeshMaker& out) {
  std::uint64_t first = 0, last = 0;
  int corners = 0;
  for (std::string_view word = words.next_in_line(); !word.empty(); word = words.next_in_line()) {
    const auto vertex = vertex_of(word, out.vertices());
    if (!vertex) return out.fail("a face uses a vertex that does not exist", words.line());
    if (corners == 0) first = *vertex;
    if (corners >= 2 && !out.add_triangle(first, last, *vertex, words.line())) return false;
    last = *vertex;
    ++corners;
  }
  if (corners < 3) return out.fail("a face has fewer than three corners", words.line());
  return true;
}

}  // namespace

bool read_obj(std::string_view bytes, MeshMaker& out) {
  Words words(bytes);
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (!out.goes_on(words.position(), bytes.size())) return false;
    if (word == "v") {
      double p[3] = {};
      for (double& coordinate : p) {
        const auto number = parse_number(words.next_in_line());
        if (!number) return out.fail("expected three numbers after \"v\"", words.line());
        coordinate = *number;
      }
      if (!out.add_vertex(p[0], p[1], p[2], words.line())) return false;
    } else if (word == "f") {
      if (!read_face(words, out)) return false;
    }
    words.skip_line();
  }
  return true;
}

}  // namespace kerf::mesh_format
