// The mesh of a job: the name of a file, or a grid of heights.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "front/cut/shapes.h"

#include "kerf/base/limits.h"

namespace kerf::cut_detail {
namespace {

constexpr std::size_t kMaxHeights = 100'000;
constexpr const char* kHint =
    "file = \"part.stl\", or heights = [[z, ...], ...] of rows from low to high Y with rectangle = "
    "[x, y, x, y]; move = [x, y, z], scale";

class SurfaceReader {
 public:
  SurfaceReader(const std::string& file, Diagnostics& diagnostics) : file_(file), diagnostics_(diagnostics) {}

  std::optional<CutSurface> read(const toml::table& table) {
    for (const auto& [key, node] : table) key_of(key, node);
    const bool heights = !rows_.empty();
    if (good_ && heights == !surface_.file.empty())
      fail(table.source(), "a surface has either file, or heights and rectangle");
    if (good_ && heights && rectangle_.empty())
      fail(table.source(), "the rectangle of the heights is missing");
    if (good_ && heights) build();
    return good_ ? std::optional(std::move(surface_)) : std::nullopt;
  }

 private:
  void fail(const toml::source_region& at, std::string message) {
    good_ = false;
    diagnostics_
        .error(codes::cut_job_key, TextLocation{file_, at.begin.line, at.begin.column}, std::move(message))
        .hint = kHint;
  }
  static std::optional<std::vector<double>> numbers(const toml::node& node) {
    const toml::array* list = node.as_array();
    if (list == nullptr) return std::nullopt;
    std::vector<double> made;
    for (const toml::node& entry : *list) {
      const auto value = length_of(entry);
      if (!value) return std::nullopt;
      made.push_back(*value);
    }
    return made;
  }

  void key_of(const toml::key& key, const toml::node& node) {
    const std::string_view name = key.str();
    const auto list = numbers(node);
    if (name == "file") {
      surface_.file = node.value_exact<std::string>().value_or("");
      if (surface_.file.empty()) fail(node.source(), "file must be the name of a mesh");
    } else if (name == "scale") {
      surface_.scale = node.is_number() ? node.value<double>().value_or(0.0) : 0.0;
      if (!(surface_.scale > 0.0 && surface_.scale <= limits::kMaxCoordinate))
        fail(node.source(), "scale must be a number above 0");
    } else if (name == "move") {
      if (!list || list->size() != 3) return fail(node.source(), "move must be [x, y, z] in mm");
      surface_.move = {(*list)[0], (*list)[1], (*list)[2]};
    } else if (name == "rectangle") {
      if (!list || list->size() != 4 || !((*list)[0] < (*list)[2]) || !((*list)[1] < (*list)[3]))
        return fail(node.source(), "rectangle must be [x, y, x, y] of the low and the high corner");
      rectangle_ = *list;
    } else if (name == "heights") {
      heights(node);
    } else {
      fail(key.source(), fmt::format("unknown key \"{}\" of a surface", name.substr(0, 60)));
    }
  }
  void heights(const toml::node& node) {
    const toml::array* list = node.as_array();
    std::size_t count = 0;
    for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
      auto row = numbers((*list)[i]);
      if (!row || row->size() < 2 || (!rows_.empty() && row->size() != rows_.front().size()))
        return fail((*list)[i].source(), "a row of heights has at least two numbers, as many as all others");
      count += row->size();
      rows_.push_back(std::move(*row));
    }
    if (rows_.size() < 2 || count > kMaxHeights)
      fail(node.source(), fmt::format("heights are at least two rows, and at most {} numbers", kMaxHeights));
  }

  void build() {
    const auto nx = static_cast<std::uint32_t>(rows_.front().size()),
               ny = static_cast<std::uint32_t>(rows_.size());
    for (std::uint32_t j = 0; j < ny; ++j)
      for (std::uint32_t i = 0; i < nx; ++i)
        surface_.mesh.points.push_back({rectangle_[0] + (rectangle_[2] - rectangle_[0]) * i / (nx - 1.0),
                                        rectangle_[1] + (rectangle_[3] - rectangle_[1]) * j / (ny - 1.0),
                                        rows_[j][i]});
    for (std::uint32_t j = 0; j + 1 < ny; ++j)
      for (std::uint32_t i = 0; i + 1 < nx; ++i) {
        const std::uint32_t a = j * nx + i, b = a + nx;
        surface_.mesh.triangles.push_back({a, a + 1, b + 1});
        surface_.mesh.triangles.push_back({a, b + 1, b});
      }
  }

  const std::string& file_;
  Diagnostics& diagnostics_;
  CutSurface surface_;
  std::vector<std::vector<double>> rows_;
  std::vector<double> rectangle_;
  bool good_ = true;
};

}  // namespace

std::optional<CutSurface> read_surface(const toml::table& table, const std::string& file,
                                       Diagnostics& diagnostics) {
  return SurfaceReader(file, diagnostics).read(table);
}

}  // namespace kerf::cut_detail
