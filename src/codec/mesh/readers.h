// The readers of read_mesh, one per format, and their common mesh builder with limits.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "base/pace.h"

#include "kerf/formats/mesh_files.h"

namespace kerf::mesh_format {

/// A mesh under construction. The first error is reported; after it nothing is added.
class MeshMaker {
 public:
  MeshMaker(const std::string& name, const MeshLimits& limits, Diagnostics& diagnostics,
            Progress* progress = nullptr)
      : name_(name), limits_(limits), diagnostics_(diagnostics), pace_(progress, "reading the mesh") {}

  const MeshLimits& limits() const { return limits_; }
  bool failed() const { return failed_; }
  /// False once the work is to stop: nothing more is added then, as after an error. `done` of `all`, in
  /// bytes.
  bool goes_on(std::size_t done, std::size_t all) {
    if (pace_.stops(done, all)) failed_ = true;
    return !failed_;
  }
  /// What follows is this part of the work.
  void part(double from, double to) { pace_.part(from, to); }
  /// As goes_on, for large steps.
  bool goes_on_at(std::size_t done, std::size_t all) {
    if (pace_.stops_at(done, all)) failed_ = true;
    return !failed_;
  }
  /// Reports an error at a line of the file, or (0) of the whole file. Returns false.
  bool fail(const std::string& message, std::uint32_t line = 0);
  bool too_large(const std::string& what);
  /// Adds a vertex; false if it is not finite or exceeds the limit.
  bool add_vertex(double x, double y, double z, std::uint32_t line = 0);
  /// Adds a triangle; false if an index is invalid or the limit is exceeded.
  bool add_triangle(std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint32_t line = 0);
  std::size_t vertices() const { return mesh_.positions.size() / 3; }
  std::optional<MeshData> finish();

 private:
  std::string name_;
  MeshLimits limits_;
  Diagnostics& diagnostics_;
  MeshData mesh_;
  Pace pace_;
  bool failed_ = false;
};

bool read_stl(std::string_view bytes, MeshMaker& out);
bool read_obj(std::string_view bytes, MeshMaker& out);
bool read_glb(std::string_view bytes, MeshMaker& out);
bool read_three_mf(std::string_view bytes, MeshMaker& out);

/// The number of 1 to 4 bytes at `at`, lowest byte first; `at` must leave room for it.
template <class T>
T little_at(std::string_view bytes, std::size_t at) {
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < sizeof(T); ++k)
    bits |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + k])) << (8 * k);
  T value{};
  if constexpr (sizeof(T) == 4) {
    std::memcpy(&value, &bits, 4);
  } else {
    value = static_cast<T>(bits);
  }
  return value;
}

/// An affine map: p -> M p + t, rows of M with t at their end.
struct Affine {
  double m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

  /// `inner` first, then this one.
  Affine after(const Affine& inner) const;
  void apply(double& x, double& y, double& z) const;
  /// Whether it mirrors, which inverts triangles.
  bool mirrors() const;
};

}  // namespace kerf::mesh_format
