// SVG 1.1 of a drawing, at its true size.
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <string_view>
#include <vector>

#include "base/markup.h"
#include "base/number.h"
#include "codec/drawing/forms.h"

#include "kerf/drawing/drawing_files.h"

namespace kerf {
namespace {

using drawings::Decimals;
using drawings::SvgForm;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kMargin = 0.05;  // of the larger side, so that lines at the edge are not clipped

class SvgWriter {
 public:
  SvgWriter(const Drawing& drawing, const SvgForm& form)
      : drawing_(drawing), form_(form), turns_y_(form.y == drawings::SvgY::turned) {}
  std::string write();

 private:
  std::string text(double value) const {
    return form_.decimals == Decimals::fixed ? fmt::format("{:.{}f}", value, form_.digits)
                                             : number_text(value, form_.digits);
  }
  std::string at(double x, double y) const { return text(x) + "," + text(turns_y_ ? -y : y); }
  std::string command(const char* letter, double x, double y) const {
    return fmt::format("{}{}{}", letter, form_.command_gap, at(x, y));
  }
  void path(const std::string& data) {
    fmt::format_to(std::back_inserter(out_), "<path {}d=\"{}\"/>\n",
                   form_.attributes ? form_.attributes(entity_, ++count_) : "", data);
  }
  std::string arc_to(double radius, bool large, bool ccw, double x, double y) const {
    return fmt::format(" A{0}{1},{1} 0 {2}{3}{4} {5}", form_.command_gap, text(radius), large ? 1 : 0,
                       form_.flag_gap, ccw == turns_y_ ? 0 : 1, at(x, y));
  }
  void shape(const drawing::Line& line) {
    path(command("M", line.x1, line.y1) + command(" L", line.x2, line.y2));
  }
  void shape(const drawing::Arc& arc);
  void shape(const drawing::Circle& circle) {
    fmt::format_to(std::back_inserter(out_), "<circle cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", text(circle.x),
                   text(turns_y_ ? -circle.y : circle.y), text(circle.radius));
  }
  void shape(const drawing::Polyline& line);
  void shape(const drawing::Text& label) {
    fmt::format_to(
        std::back_inserter(out_),
        "<text x=\"{}\" y=\"{}\" font-size=\"{}\" font-family=\"sans-serif\" fill=\"currentColor\" "
        "stroke=\"none\">{}</text>\n",
        text(label.x), text(turns_y_ ? -label.y : label.y), text(label.height), markup_text(label.text));
  }

  const Drawing& drawing_;
  const SvgForm& form_;
  bool turns_y_;
  std::size_t entity_ = 0, count_ = 0;  // the entity being written; paths so far
  std::string out_;
};

void SvgWriter::shape(const drawing::Arc& arc) {
  double sweep = std::fmod(arc.end - arc.start, 360.0);
  if (sweep <= 0.0) sweep += 360.0;
  if (sweep == 360.0) return shape(drawing::Circle{arc.x, arc.y, arc.radius});
  const auto on = [&](double degrees) {
    return std::pair(arc.x + arc.radius * std::cos(degrees * kDegree),
                     arc.y + arc.radius * std::sin(degrees * kDegree));
  };
  const auto [x1, y1] = on(arc.start);
  const auto [x2, y2] = on(arc.end);
  path(command("M", x1, y1) + arc_to(arc.radius, sweep > 180.0, true, x2, y2));
}

void SvgWriter::shape(const drawing::Polyline& line) {
  std::string data;
  const std::size_t n = line.vertices.size();
  for (std::size_t i = 0; i < n; ++i) {
    const drawing::Vertex& a = line.vertices[i];
    if (i == 0) data = command("M", a.x, a.y);
    if (i + 1 == n && !line.closed) break;
    const drawing::Vertex& b = line.vertices[(i + 1) % n];
    if (a.bulge == 0.0) {
      data += i + 1 == n ? "" : command(" L", b.x, b.y);
    } else {
      const double chord = std::hypot(b.x - a.x, b.y - a.y);
      const double radius = 0.25 * chord * std::abs(1.0 / a.bulge + a.bulge);
      data += arc_to(a.radius > 0.0 ? a.radius : radius, std::abs(a.bulge) > 1.0, a.bulge > 0.0, b.x, b.y);
    }
  }
  path(line.closed ? data + " Z" : data);
}

std::string SvgWriter::write() {
  out_ = form_.head;
  std::vector<std::vector<std::size_t>> of_layer(drawing_.layers.size());
  for (std::size_t i = 0; i < drawing_.entities.size(); ++i)
    of_layer[drawing_.entities[i].layer].push_back(i);
  for (std::size_t i = 0; i < of_layer.size(); ++i) {
    const std::string group = form_.group(i);
    if (group.empty()) continue;
    out_ += group;
    for (const std::size_t k : of_layer[i]) {
      entity_ = k;
      std::visit([&](const auto& s) { shape(s); }, drawing_.entities[k].shape);
    }
    out_ += "</g>\n";
  }
  out_ += "</svg>\n";
  return std::move(out_);
}

// ---- the default form

std::string short_text(double value) { return number_text(value, SvgForm{}.digits); }

std::string head_of(const Drawing& drawing) {
  const std::array<double, 4> bounds = drawing_bounds(drawing);
  const double side = std::max(bounds[2] - bounds[0], bounds[3] - bounds[1]);
  const double margin = side > 0.0 ? kMargin * side : 1.0;
  const std::string width = short_text(bounds[2] - bounds[0] + 2.0 * margin);
  const std::string height = short_text(bounds[3] - bounds[1] + 2.0 * margin);
  const std::string_view unit = drawing.unit == DrawingUnit::mm     ? "mm"
                                : drawing.unit == DrawingUnit::inch ? "in"
                                                                    : "";
  std::string head = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" version=\"1.1\" width=\"{0}{2}\" height=\"{1}{2}\" "
      "viewBox=\"{3} {4} {0} {1}\">\n",
      width, height, unit, short_text(bounds[0] - margin), short_text(-bounds[3] - margin));
  if (!drawing.title.empty()) head += "<title>" + markup_text(drawing.title) + "</title>\n";
  return head;
}

std::string group_of(const DrawingLayer& layer, std::size_t index) {
  const std::string colour = fmt::format("#{:02x}{:02x}{:02x}", layer.rgb[0], layer.rgb[1], layer.rgb[2]);
  const std::string dashes = layer.line == LineKind::dashed
                                 ? fmt::format(" stroke-dasharray=\"{}\"", short_text(8.0 * layer.line_width))
                                 : "";
  return fmt::format(
      "<g id=\"layer-{}\" fill=\"none\" stroke=\"{}\" color=\"{}\" "
      "stroke-width=\"{}\"{}>\n<title>{}</title>\n",
      index, colour, colour, short_text(layer.line_width), dashes, markup_text(layer.name));
}

}  // namespace

std::string drawings::write_svg(const Drawing& drawing, const SvgForm& form) {
  return SvgWriter(drawing, form).write();
}

std::string write_svg(const Drawing& drawing) {
  SvgForm form;
  form.head = head_of(drawing);
  form.group = [&](std::size_t layer) { return group_of(drawing.layers[layer], layer); };
  return drawings::write_svg(drawing, form);
}

}  // namespace kerf
