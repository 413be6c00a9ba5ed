// The clips of SVG: edges of viewports, and clipPath elements.
#if KERF_WITH_SVG
#include <algorithm>
#include <fmt/format.h>

#include "base/codes/outline.h"
#include "base/names.h"
#include "codec/drawing/svg_reader.h"

namespace kerf::svg {

/// Clips to the rectangle of a viewport in the coordinates of `frame`.
std::uint32_t SvgReader::clip_to_viewport(const Context& frame, double width, double height) {
  dxf::Clip clip;
  clip.outer = frame.clip;
  dxf::Polyline edge;
  edge.closed = true;
  for (const Vec p : {Vec{0.0, 0.0}, Vec{width, 0.0}, Vec{width, height}, Vec{0.0, height}}) {
    const Vec at = frame.matrix * p;
    edge.vertices.push_back({{at.x, at.y, 0.0}, 0.0});
  }
  clip.entities.emplace_back().shape = dxf::Boxed<dxf::Polyline>(std::move(edge));
  drawing_.clips.push_back(std::move(clip));
  return static_cast<std::uint32_t>(drawing_.clips.size() - 1);
}

/// The clip of a clipPath for an element with this context; nothing, with a warning, if it is not understood.
std::optional<std::uint32_t> SvgReader::clip_to_path(const Element& path, const Drawn& drawn) {
  const Context& context = drawn.context;
  const Properties properties = sheet_.properties(path, context.variables);
  const auto is_text = [](const Element& e) { return e.name == "text"; };
  if (properties.find("display") == "none" ||
      std::find(open_clips_.begin(), open_clips_.end(), &path) != open_clips_.end() ||
      std::any_of(path.children.begin(), path.children.end(), is_text))
    return std::nullopt;
  Affine units;
  if (path.attribute("clipPathUnits") == "objectBoundingBox") {
    const Box box = box_of(drawn);
    units = {box.width, 0, 0, box.height, box.x, box.y};
  }
  const Affine m = context.matrix * units;
  const std::string key = fmt::format("{} {} {} {} {} {} {} {}", static_cast<const void*>(&path),
                                      context.clip, m.a, m.b, m.c, m.d, m.e, m.f);
  if (const auto known = clips_.find(key); known != clips_.end()) return known->second;
  Context inside;
  inside.base = context.base;
  inside.matrix = context.matrix;
  inside.clip = context.clip;
  inside.variables = context.variables;
  inside.is_in_clip = true;
  open_clips_.push_back(&path);
  const auto entered_path = entered(path, properties, inside);
  dxf::Clip clip;
  if (entered_path) {
    clip.outer = entered_path->clip;
    Context content = *entered_path;
    content.matrix = content.matrix * units;
    content.clip = 0;  // the clips of its shapes hold for them alone
    std::vector<dxf::Entity> shown = std::exchange(drawing_.entities, {});
    const std::size_t depth = depth_;
    children(path, content, depth + 1);
    depth_ = depth;
    clip.entities = std::exchange(drawing_.entities, std::move(shown));
  }
  open_clips_.pop_back();
  drawing_.clips.push_back(std::move(clip));
  const auto made = static_cast<std::uint32_t>(drawing_.clips.size() - 1);
  clips_.emplace(key, made);
  return made;
}

/// The box of what an element draws, in its own coordinates, without strokes and clips. Texts have no box
/// here: their fonts are not known.
Box SvgReader::box_of(const Drawn& drawn) {
  const LengthBase& base = drawn.context.base;
  const std::string key = fmt::format("{} {} {} {} {} {}", static_cast<const void*>(&drawn.element),
                                      base.width, base.height, base.page_width, base.page_height, base.em);
  if (const auto known = boxes_.find(key); known != boxes_.end()) return known->second;
  const std::size_t depth = depth_;
  boxes_[key] = {};  // of one that contains itself
  Context inside = drawn.context;
  inside.matrix = {};
  inside.clip = 0;
  dxf::Drawing shown = std::exchange(drawing_, {});
  Diagnostics reported = std::exchange(diagnostics_, Diagnostics());
  auto ignored = std::exchange(ignored_, {});
  drawing_.file = shown.file;
  drawing_.clips.resize(1);
  drawing_.paints.resize(1);
  auto clips = std::exchange(clips_, {});
  draw_content({drawn.element, drawn.properties, inside}, depth + 1);
  depth_ = depth;
  const std::vector<dxf::Entity> found = std::exchange(drawing_, std::move(shown)).entities;
  reported = std::exchange(diagnostics_, std::move(reported));
  for (const Diagnostic& d : reported.list())
    if (d.severity == Severity::error) diagnostics_.add(d);  // a limit
  ignored_ = std::move(ignored);
  clips_ = std::move(clips);
  bool has_text = false;
  const Box box = bounding_box(found, has_text);
  if (has_text)
    diagnostics_.warning(codes::svg_value, location(drawn.element),
                         drawn.element.name +
                             ": its box, which a clip or transform refers to, is that without "
                             "its texts");
  return boxes_[key] = box;
}

/// The clip-path of an element.
void SvgReader::apply_clip(const Drawn& drawn, Context& context) {
  const std::string_view value = drawn.properties.find("clip-path");
  if (value.empty() || value == "none" || value == "inherit") return;
  std::string_view link = value;
  if (link.substr(0, 4) == "url(" && link.find(')') != std::string_view::npos) {
    link = trim(link.substr(4, link.find(')') - 4));
    if (link.size() > 1 && (link.front() == '"' || link.front() == '\''))
      link = link.substr(1, link.size() - 2);
  }
  const auto target = link.substr(0, 1) == "#" ? by_id_.find(link.substr(1)) : by_id_.end();
  const bool is_known = target != by_id_.end() && target->second->name == "clipPath";
  const auto clip =
      is_known ? clip_to_path(*target->second, {drawn.element, drawn.properties, context}) : std::nullopt;
  const std::string name = fmt::format("clip-path {}", clipped(value, 40));
  note_ignored(drawn.element, name);
  if (!clip) return;
  context.clip = *clip;
  ignored_[name].is_applied = true;
}

}  // namespace kerf::svg
#endif
