// The shapes that a job file contains itself: [[shape]] with numbers in mm.
#include "front/cut/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "base/quantity.h"

#include "kerf/base/limits.h"

namespace kerf::cut_detail {
namespace {

constexpr std::array<std::string_view, 5> kForms{"rectangle", "circle", "polygon", "line", "point"};
constexpr const char* kFormsHint =
    "rectangle = [x, y, x, y] of two corners, circle = [x, y, diameter], polygon or line = [[x, y], ...], "
    "point = [x, y]";

/// A polyline through the points.
Outline through(const std::vector<Point2>& points, bool closed) {
  Outline outline{points.front()};
  for (std::size_t i = 1; i < points.size(); ++i) outline.segments.push_back({points[i]});
  if (closed) outline.segments.push_back({points.front(), {}});
  return outline;
}

class ShapeReader {
 public:
  ShapeReader(const std::string& file, Diagnostics& diagnostics) : file_(file), diagnostics_(diagnostics) {}

  std::optional<ArtShape> read(const toml::table& table) {
    std::size_t forms = 0;
    for (const auto& [key, node] : table) {
      const std::string_view name = key.str();
      if (std::find(kForms.begin(), kForms.end(), name) != kForms.end())
        ++forms, form(name, node);
      else if (name == "name")
        text(name, node, shape_.name);
      else if (name == "layer")
        text(name, node, shape_.layer);
      else if (name == "corner")
        corner(node);
      else
        fail(key.source(), fmt::format("unknown key \"{}\" of a shape", name.substr(0, 60)));
    }
    if (!failed_ && forms != 1)
      fail(table.source(), "a shape has one of rectangle, circle, polygon, line, point");
    if (!failed_) build(table);
    if (failed_) return std::nullopt;
    return std::move(shape_);
  }

 private:
  Origin location(const toml::source_region& at) const {
    return TextLocation{file_, at.begin.line, at.begin.column};
  }
  void fail(const toml::source_region& at, std::string message) {
    failed_ = true;
    diagnostics_.error(codes::cut_job_key, location(at), std::move(message)).hint = kFormsHint;
  }

  void text(std::string_view name, const toml::node& node, std::string& target) {
    if (const auto given = node.value_exact<std::string>())
      target = *given;
    else
      fail(node.source(), fmt::format("{} must be a text", name));
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

  void corner(const toml::node& node) {
    const auto value = length_of(node);
    if (value && *value >= 0.0)
      corner_ = mm(*value);
    else
      fail(node.source(), "corner must be a radius in mm");
  }
  void form(std::string_view name, const toml::node& node) {
    form_ = name;
    if (name == "polygon" || name == "line") {
      const toml::array* list = node.as_array();
      for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
        const auto pair = numbers((*list)[i]);
        if (!pair || pair->size() != 2) return fail((*list)[i].source(), "a point is [x, y] in mm");
        points_.push_back({(*pair)[0], (*pair)[1]});
      }
      const std::size_t least = name == "polygon" ? 3 : 2;
      if (points_.size() < least)
        fail(node.source(), fmt::format("a {} has at least {} points", name, least));
      return;
    }
    const auto given = numbers(node);
    const std::size_t count = name == "rectangle" ? 4 : name == "circle" ? 3 : 2;
    if (!given || given->size() != count)
      return fail(node.source(), fmt::format("{} has {} numbers", name, count));
    numbers_ = *given;
    if (name == "circle" && !(numbers_[2] > 0.0)) fail(node.source(), "a circle has a diameter above 0 mm");
    if (name == "rectangle" && (numbers_[0] == numbers_[2] || numbers_[1] == numbers_[3]))
      fail(node.source(), "a rectangle has two different corners");
  }

  void build(const toml::table& table) {
    if (form_ == "point") {
      shape_.point = Point2{numbers_[0], numbers_[1]};
      return;
    }
    if (form_ == "circle") {
      shape_.circle = Circle{{numbers_[0], numbers_[1]}, mm(0.5 * numbers_[2])};
      shape_.outline = as_outline(*shape_.circle);
      return;
    }
    if (form_ == "rectangle") {
      const double x0 = std::min(numbers_[0], numbers_[2]), x1 = std::max(numbers_[0], numbers_[2]);
      const double y0 = std::min(numbers_[1], numbers_[3]), y1 = std::max(numbers_[1], numbers_[3]);
      points_ = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    }
    const bool closed = form_ != "line";
    const Outline outline = through(points_, closed);
    CornerRequests corners(points_.size(), corner_);  // where both neighbours exist
    if (!closed) corners.front() = corners.back() = Length();
    CornerOptions options;
    options.name = shape_.name.empty() ? std::string(form_) : shape_.name;
    options.where = location(table.source());
    auto cut = cut_corners(outline, corners, options, diagnostics_);
    if (cut)
      shape_.outline = std::move(cut->outline);
    else
      failed_ = true;
  }

  const std::string& file_;
  Diagnostics& diagnostics_;
  ArtShape shape_;
  std::string_view form_;
  std::vector<double> numbers_;
  std::vector<Point2> points_;
  Length corner_{};
  bool failed_ = false;
};

}  // namespace

std::optional<ArtShape> read_shape(const toml::node& node, const std::string& file,
                                   Diagnostics& diagnostics) {
  if (const toml::table* table = node.as_table()) return ShapeReader(file, diagnostics).read(*table);
  diagnostics
      .error(codes::cut_job_key, TextLocation{file, node.source().begin.line, node.source().begin.column},
             "[[shape]] has the wrong form")
      .hint = kFormsHint;
  return std::nullopt;
}

namespace {

bool has_key(const toml::node& node, std::string_view key) {
  const toml::table* table = node.as_table();
  return table != nullptr && table->contains(key);
}

/// Reads the keys of a shape that has a table of them, besides name and layer.
template <class Shape>
class KeyedShapeReader {
 public:
  KeyedShapeReader(const std::string& file, const char* what, const char* hint, Diagnostics& diagnostics)
      : file_(file), what_(what), hint_(hint), diagnostics_(diagnostics) {}

  Origin location(const toml::source_region& at) const {
    return TextLocation{file_, at.begin.line, at.begin.column};
  }
  void fail(const toml::source_region& at, std::string message) {
    good_ = false;
    diagnostics_.error(codes::cut_job_key, location(at), std::move(message)).hint = hint_;
  }
  bool read(const toml::table& table, const std::vector<CutKeyOf<Shape>>& keys, Shape& shape) {
    for (const auto& [key, value] : table) {
      const std::string_view name = key.str();
      if (name == "name" || name == "layer") {
        const auto text = value.template value_exact<std::string>();
        if (!text) fail(value.source(), fmt::format("{} must be a text", name));
        if (text) (name == "name" ? shape.name : shape.layer) = *text;
        continue;
      }
      const auto known =
          std::find_if(keys.begin(), keys.end(), [&](const auto& k) { return k.name == name; });
      if (known == keys.end()) {
        fail(key.source(), fmt::format("unknown key \"{}\" of a {}", name.substr(0, 60), what_));
        continue;
      }
      const auto given = value_of(value);
      if (!given || !known->set(shape, *given))
        fail(value.source(), fmt::format("{} must be as in {} = {}", name, name, known->example));
    }
    return good_;
  }
  bool good() const { return good_; }

 private:
  const std::string& file_;
  const char *what_, *hint_;
  Diagnostics& diagnostics_;
  bool good_ = true;
};

}  // namespace

std::optional<CutValue> value_of(const toml::node& value) {
  if (const auto text = value.value_exact<std::string>()) return CutValue(*text);
  if (value.is_number()) return CutValue(*value.value<double>());
  const toml::array* list = value.as_array();
  if (list == nullptr) return std::nullopt;
  if (list->size() == 2 && (*list)[0].is_number() && (*list)[1].is_number())
    return CutValue(std::vector<double>{*(*list)[0].value<double>(), *(*list)[1].value<double>()});
  // A number beside a text with a unit: [-5, "90mm"].
  if (list->size() == 2 && ((*list)[0].is_number() || (*list)[1].is_number()))
    if (const auto x = length_of((*list)[0]), y = length_of((*list)[1]); x && y)
      return CutValue(std::vector<double>{*x, *y});
  std::vector<std::string> texts;
  for (const toml::node& entry : *list) {
    const auto text = entry.value_exact<std::string>();
    if (!text) return std::nullopt;
    texts.push_back(*text);
  }
  return CutValue(std::move(texts));
}

std::optional<double> length_of(const toml::node& node) {
  std::string fault;
  auto value = node.is_number() ? node.value<double>() : std::nullopt;
  if (const auto text = node.value_exact<std::string>()) value = read_quantity(*text, "mm", {}, fault);
  return value && std::abs(*value) <= limits::kMaxCoordinate ? value : std::nullopt;
}

bool is_text_shape(const toml::node& node) { return has_key(node, "text"); }
bool is_picture_shape(const toml::node& node) { return has_key(node, "picture") || has_key(node, "pixels"); }

std::optional<TextShape> read_text_shape(const toml::node& node, const std::string& file,
                                         Diagnostics& diagnostics) {
  KeyedShapeReader<TextShape> reader(
      file, "text",
      "text = \"KERF\", height = 10, at = [x, y], font, text-angle, align, letter-spacing, name, layer",
      diagnostics);
  TextShape shape;
  shape.options.where = reader.location(node.source());
  if (reader.read(*node.as_table(), cut_text_keys(), shape) && !(shape.options.height > Length{}))
    reader.fail(node.source(), "the height of the text is missing");
  return reader.good() ? std::optional(std::move(shape)) : std::nullopt;
}

std::optional<PictureShape> read_picture_shape(const toml::node& node, const std::string& file,
                                               Diagnostics& diagnostics) {
  KeyedShapeReader<PictureShape> reader(
      file, "picture", "picture = \"photo.png\", picture-width = 80, at = [x, y], name, layer", diagnostics);
  PictureShape shape;
  shape.where = reader.location(node.source());
  if (reader.read(*node.as_table(), cut_picture_keys(), shape) && !shape.file.empty() &&
      !shape.pixels.empty())
    reader.fail(node.source(), "a picture has either a file or pixels");
  return reader.good() ? std::optional(std::move(shape)) : std::nullopt;
}

}  // namespace kerf::cut_detail
