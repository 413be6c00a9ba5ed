// SVG 1.1 of a drawing, at its true size.
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <string_view>
#include <vector>

#include "kerf/drawing_files.h"
#include "kerf/number.h"

namespace kerf {
namespace {

constexpr int kDecimals = 6;
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kMargin = 0.05;  // of the larger side, so that lines at the edge are seen whole

std::string escaped(std::string_view text) {
  std::string made;
  for (const char c : text) {
    if (c == '&')
      made += "&amp;";
    else if (c == '<')
      made += "&lt;";
    else if (c == '>')
      made += "&gt;";
    else if (c == '"')
      made += "&quot;";
    else if (static_cast<unsigned char>(c) >= ' ' || c == '\n' || c == '\t')
      made += c;
  }
  return made;
}

/// Numbers with y turned down.
class SvgWriter {
 public:
  explicit SvgWriter(const Drawing& drawing) : drawing_(drawing) {}
  std::string write();

 private:
  static std::string text(double value) { return number_text(value, kDecimals); }
  static std::string at(double x, double y) { return text(x) + "," + text(-y); }
  void path(const std::string& data) { fmt::format_to(std::back_inserter(out_), "<path d=\"{}\"/>\n", data); }
  static std::string arc_to(double radius, bool large, bool ccw, double x, double y) {
    return fmt::format(" A{0},{0} 0 {1} {2} {3}", text(radius), large ? 1 : 0, ccw ? 0 : 1, at(x, y));
  }
  void shape(const drawing::Line& line) { path("M" + at(line.x1, line.y1) + " L" + at(line.x2, line.y2)); }
  void shape(const drawing::Arc& arc);
  void shape(const drawing::Circle& circle) {
    fmt::format_to(std::back_inserter(out_), "<circle cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", text(circle.x),
                   text(-circle.y), text(circle.radius));
  }
  void shape(const drawing::Polyline& line);
  void shape(const drawing::Text& label) {
    fmt::format_to(
        std::back_inserter(out_),
        "<text x=\"{}\" y=\"{}\" font-size=\"{}\" font-family=\"sans-serif\" fill=\"currentColor\" "
        "stroke=\"none\">{}</text>\n",
        text(label.x), text(-label.y), text(label.height), escaped(label.text));
  }
  void open();
  void layer(std::size_t index, const std::vector<std::size_t>& entities);

  const Drawing& drawing_;
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
  path("M" + at(x1, y1) + arc_to(arc.radius, sweep > 180.0, true, x2, y2));
}

void SvgWriter::shape(const drawing::Polyline& line) {
  std::string data;
  const std::size_t n = line.vertices.size();
  for (std::size_t i = 0; i < n; ++i) {
    const drawing::Vertex& a = line.vertices[i];
    if (i == 0) data = "M" + at(a.x, a.y);
    if (i + 1 == n && !line.closed) break;
    const drawing::Vertex& b = line.vertices[(i + 1) % n];
    if (a.bulge == 0.0) {
      data += i + 1 == n ? "" : " L" + at(b.x, b.y);
    } else {
      const double chord = std::hypot(b.x - a.x, b.y - a.y);
      const double radius = 0.25 * chord * std::abs(1.0 / a.bulge + a.bulge);
      data += arc_to(radius, std::abs(a.bulge) > 1.0, a.bulge > 0.0, b.x, b.y);
    }
  }
  path(line.closed ? data + " Z" : data);
}

void SvgWriter::open() {
  const std::array<double, 4> bounds = drawing_bounds(drawing_);
  const double side = std::max(bounds[2] - bounds[0], bounds[3] - bounds[1]);
  const double margin = side > 0.0 ? kMargin * side : 1.0;
  const std::string width = text(bounds[2] - bounds[0] + 2.0 * margin);
  const std::string height = text(bounds[3] - bounds[1] + 2.0 * margin);
  const std::string_view unit = drawing_.unit == DrawingUnit::mm     ? "mm"
                                : drawing_.unit == DrawingUnit::inch ? "in"
                                                                     : "";
  out_ = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" version=\"1.1\" width=\"{0}{2}\" height=\"{1}{2}\" "
      "viewBox=\"{3} {4} {0} {1}\">\n",
      width, height, unit, text(bounds[0] - margin), text(-bounds[3] - margin));
  if (!drawing_.title.empty()) out_ += "<title>" + escaped(drawing_.title) + "</title>\n";
}

void SvgWriter::layer(std::size_t index, const std::vector<std::size_t>& entities) {
  const DrawingLayer& layer = drawing_.layers[index];
  const std::string colour = fmt::format("#{:02x}{:02x}{:02x}", layer.rgb[0], layer.rgb[1], layer.rgb[2]);
  const std::string dashes = layer.line == LineKind::dashed
                                 ? fmt::format(" stroke-dasharray=\"{}\"", text(8.0 * layer.line_width))
                                 : "";
  fmt::format_to(std::back_inserter(out_),
                 "<g id=\"layer-{}\" fill=\"none\" stroke=\"{}\" color=\"{}\" stroke-width=\"{}\"{}>\n",
                 index, colour, colour, text(layer.line_width), dashes);
  out_ += "<title>" + escaped(layer.name) + "</title>\n";
  for (const std::size_t i : entities)
    std::visit([&](const auto& s) { shape(s); }, drawing_.entities[i].shape);
  out_ += "</g>\n";
}

std::string SvgWriter::write() {
  open();
  std::vector<std::vector<std::size_t>> of_layer(drawing_.layers.size());
  for (std::size_t i = 0; i < drawing_.entities.size(); ++i)
    of_layer[drawing_.entities[i].layer].push_back(i);
  for (std::size_t i = 0; i < of_layer.size(); ++i) layer(i, of_layer[i]);
  out_ += "</svg>\n";
  return std::move(out_);
}

}  // namespace

std::string write_svg(const Drawing& drawing) { return SvgWriter(drawing).write(); }

}  // namespace kerf
