// Setup sheets as files: a page of HTML, or one drawing.
#include <algorithm>
#include <fmt/format.h>

#include "back/drawing/sheet_marks.h"
#include "base/markup.h"
#include "base/number.h"
#include "base/utf8.h"
#include "job/setup_sheet.h"

namespace kerf {
namespace {

// Black on white: the page is for printing.
const char* const kStyle = R"(@page{size:A4;margin:12mm}
body{font:10pt/1.35 sans-serif;color:#000;background:#fff;max-width:190mm;margin:6mm auto;padding:0 4mm}
h1{font-size:16pt;margin:0 0 3mm;overflow-wrap:anywhere}
h2{font-size:11pt;margin:5mm 0 1mm}
table{border-collapse:collapse;width:100%}
th,td{text-align:left;vertical-align:top;padding:.6mm 1.5mm;border:.2mm solid #888}
#facts td,#operations td,#fixtures td,#findings td+td+td{overflow-wrap:anywhere}
thead th{background:#e8e8e8;print-color-adjust:exact;-webkit-print-color-adjust:exact}
tr{break-inside:avoid}
td[colspan]{font-weight:bold;border-top:.5mm solid #000}
#facts th{width:28mm;border:0}
#facts td{border:0}
figure{margin:3mm 0;text-align:center;break-inside:avoid}
figure svg{max-width:100%;height:auto;max-height:150mm}
.line{display:block;width:12mm;height:2mm}
)";

std::string line_of(const DrawingLayer& layer) {
  const std::string dashes =
      layer.line == LineKind::dashed
          ? fmt::format(" stroke-dasharray=\"{}\"", number_text(8.0 * layer.line_width, 3))
          : "";
  return fmt::format(
      "<svg class=\"line\" viewBox=\"0 0 12 2\" aria-hidden=\"true\"><path d=\"M0 1H12\" "
      "stroke=\"#{:02x}{:02x}{:02x}\" stroke-width=\"{}\"{}/></svg>",
      layer.rgb[0], layer.rgb[1], layer.rgb[2], number_text(2.0 * layer.line_width, 3), dashes);
}

void add_table(std::string& out, const SetupSheet::Table& table, const Drawing& plan) {
  out += fmt::format("<h2>{}</h2>\n<table id=\"{}\">\n<thead><tr>", markup_text(table.title), table.id);
  for (const SetupSheet::Column& column : table.columns)
    out += fmt::format("<th>{}</th>", markup_text(column.head));
  out += "</tr></thead>\n<tbody>\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& row = table.rows[i];
    out += "<tr>";
    if (row.size() == 1)
      out += fmt::format("<td colspan=\"{}\">{}</td>", table.columns.size(), markup_text(row.front()));
    for (std::size_t k = 0; k < row.size() && row.size() > 1; ++k) {
      const bool has_line = k == 0 && i < table.layers.size() && table.layers[i] < plan.layers.size();
      out += fmt::format("<td>{}{}</td>", markup_text(row[k]),
                         has_line ? line_of(plan.layers[table.layers[i]]) : "");
    }
    out += "</tr>\n";
  }
  out += "</tbody>\n</table>\n";
}

// ---- the drawing

constexpr double kPageWidth = 180.0, kRow = 4.2, kCell = 2.2;  // mm: page, rows, height of texts
constexpr double kCharacter = 0.56;                            // average width of a character in heights

/// The text in lines of at most `max` characters, broken at blanks where there are some.
std::vector<std::string> wrapped(const std::string& text, std::size_t max) {
  std::vector<std::string> lines;
  std::u32string rest = from_utf8(text);
  do {
    std::size_t end = std::min(max, rest.size()), next = end;
    if (end < rest.size()) {
      const std::size_t blank = rest.rfind(U' ', end);
      if (blank != std::u32string::npos && blank > 0) end = blank, next = blank + 1;
    }
    std::string line;
    for (const char32_t c : rest.substr(0, end)) append_utf8(line, c);
    lines.push_back(std::move(line));
    rest.erase(0, next);
  } while (!rest.empty());
  return lines;
}

/// Writes rows of texts below a drawing.
class PageWriter {
 public:
  PageWriter(Drawing& page, std::size_t layer, double top) : page_(page), layer_(layer), y_(top) {}

  void title(const std::string& text, double height) {
    y_ -= 1.6 * height;
    drawings::add_text(page_, layer_, {0.0, y_}, height, text);
    y_ -= 0.4 * height;
  }
  void row(const std::vector<std::string>& cells, const std::vector<double>& widths) {
    std::size_t deepest = 1;
    double x = 0.0;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const double room = cells.size() == 1 ? kPageWidth : widths[k];
      const auto max = static_cast<std::size_t>(std::max((room - 1.0) / (kCharacter * kCell), 1.0));
      const std::vector<std::string> lines = wrapped(cells[k], max);
      for (std::size_t i = 0; i < lines.size(); ++i)
        drawings::add_text(page_, layer_, {x, y_ - kRow * static_cast<double>(i + 1) + 1.2}, kCell, lines[i]);
      deepest = std::max(deepest, lines.size());
      x += room;
    }
    y_ -= kRow * static_cast<double>(deepest);
    drawings::add_line(page_, layer_, {0.0, y_}, {kPageWidth, y_});
  }
  double y() const { return y_; }

 private:
  Drawing& page_;
  std::size_t layer_;
  double y_;
};

std::vector<double> widths_of(const SetupSheet::Table& table) {
  double all = 0.0;
  for (const SetupSheet::Column& column : table.columns) all += column.width;
  std::vector<double> widths;
  for (const SetupSheet::Column& column : table.columns) widths.push_back(kPageWidth * column.width / all);
  return widths;
}

}  // namespace

std::string setup_sheet_html(const SetupSheet& sheet) {
  const std::string title = markup_text(sheet.title);
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta "
      "charset=\"utf-8\">\n<title>{0}</title>\n<style>\n{1}"
      "</style>\n</head>\n<body>\n<h1>{0}</h1>\n<table id=\"facts\">\n<tbody>\n",
      title, kStyle);
  for (const auto& [name, text] : sheet.facts)
    out += fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", markup_text(name), markup_text(text));
  out += "</tbody>\n</table>\n<figure>\n";
  const std::string svg = write_svg(sheet.plan);
  out += svg.substr(std::min(svg.find("<svg"), svg.size()));  // without the XML declaration
  out += "</figure>\n";
  for (const SetupSheet::Table& table : sheet.tables) add_table(out, table, sheet.plan);
  return out + "</body>\n</html>\n";
}

std::string setup_sheet_svg(const SetupSheet& sheet) {
  Drawing page = sheet.plan;
  page.title = sheet.title;
  DrawingLayer text;
  text.name = "text", text.line_width = 0.1;
  const std::size_t layer = page.layers.size();
  page.layers.push_back(text);
  const std::array<double, 4> bounds = drawing_bounds(sheet.plan);
  PageWriter rows(page, layer, bounds[1] - 4.0);
  rows.title(sheet.title, 5.0);
  for (const auto& [name, value] : sheet.facts) rows.row({name, value}, {28.0, kPageWidth - 28.0});
  for (const SetupSheet::Table& table : sheet.tables) {
    rows.title(table.title, 3.2);
    const std::vector<double> widths = widths_of(table);
    std::vector<std::string> heads;
    for (const SetupSheet::Column& column : table.columns) heads.push_back(column.head);
    rows.row(heads, widths);
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      const double top = rows.y();
      rows.row(table.rows[i], widths);
      if (i < table.layers.size() && table.layers[i] < sheet.plan.layers.size())
        drawings::add_line(page, table.layers[i], {7.0, top - 2.2}, {14.0, top - 2.2});
    }
  }
  return write_svg(page);
}

}  // namespace kerf
