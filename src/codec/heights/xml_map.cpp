// Height maps of OpenCNCPilot and its kin, in XML. The form is a flat list; it is read without an XML
// library, which the library in WebAssembly lacks, and anything else in it is an error.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/pathdxf.h"
#include "base/names.h"
#include "base/number.h"
#include "codec/heights/grid.h"

namespace kerf::heights_detail {
namespace {

constexpr std::string_view kHeadExpected =
    "expected MinX, MinY, MaxX, MaxY, SizeX and SizeY of the height map, the maxima above the minima";

std::optional<double> attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    const std::size_t equals = at + name.size();
    if (at == 0 || std::string_view(" \t\r\n").find(tag[at - 1]) == std::string_view::npos) continue;
    if (tag.substr(equals, 1) != "=" || equals + 2 >= tag.size()) continue;
    const char quote = tag[equals + 1];
    if (quote != '"' && quote != '\'') continue;
    const std::size_t end = tag.find(quote, equals + 2);
    if (end != std::string_view::npos) return parse_number(trim(tag.substr(equals + 2, end - equals - 2)));
  }
  return std::nullopt;
}

/// An index below `count`.
std::optional<std::size_t> index_below(std::size_t count, std::optional<double> value) {
  if (!value || !(*value >= 0.0 && *value < double(count)) || *value != std::floor(*value))
    return std::nullopt;
  return static_cast<std::size_t>(*value);
}

/// <heightmap MinX= ... SizeX= ...>, <point X="column" Y="row">height</point> ..., </heightmap>
class XmlMapReader {
 public:
  XmlMapReader(std::string_view bytes, const HeightsSink& sink) : bytes_(bytes), sink_(sink) {}

  void read() {
    const std::size_t start = bytes_.find("<heightmap");
    if (start == std::string_view::npos) {
      sink_.error(codes::heights_format, 1, "expected <heightmap ...>: this XML is no height map");
      return;
    }
    skip_to(start);
    const auto head = take_tag("<heightmap");
    const auto number = [&](std::string_view name) { return attribute(head.value_or(""), name); };
    const auto x0 = number("MinX"), y0 = number("MinY"), x1 = number("MaxX"), y1 = number("MaxY");
    const std::size_t columns = count_of(number("SizeX")), rows = count_of(number("SizeY"));
    if (!x0 || !y0 || !x1 || !y1 || columns == 0 || rows == 0 || *x0 > *x1 || *y0 > *y1 ||
        (columns > 1 && *x0 == *x1) || (rows > 1 && *y0 == *y1)) {
      sink_.error(codes::heights_format, line_, std::string(kHeadExpected));
      return;
    }
    at_ = {*x0, *y0, *x1, *y1, columns, rows};
    GridPoints points(at_, sink_, sink_.unit(), line_);
    skip_blanks_and_comments();
    bool good = points.is_good();
    while (good && !starts_with("</heightmap>")) good = take_point(points);
    if (good) points.finish(line_);
  }

 private:
  bool starts_with(std::string_view text) const { return bytes_.substr(at_byte_, text.size()) == text; }
  void skip_to(std::size_t to) {
    to = std::min(to, bytes_.size());
    const auto begin = bytes_.begin();
    line_ += static_cast<std::size_t>(
        std::count(begin + std::ptrdiff_t(at_byte_), begin + std::ptrdiff_t(to), '\n'));
    at_byte_ = to;
  }
  void skip_blanks_and_comments() {
    while (true) {
      skip_to(bytes_.find_first_not_of(" \t\r\n", at_byte_));
      if (!starts_with("<!--")) return;
      const std::size_t end = bytes_.find("-->", at_byte_);
      skip_to(end == std::string_view::npos ? end : end + 3);
    }
  }
  /// The text of a tag that starts here, up to its '>', which is passed. Nothing if there is none.
  std::optional<std::string_view> take_tag(std::string_view name) {
    const std::size_t end = starts_with(name) ? bytes_.find('>', at_byte_) : std::string_view::npos;
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view tag = bytes_.substr(at_byte_, end - at_byte_);
    skip_to(end + 1);
    return tag;
  }
  bool take_point(GridPoints& points);

  std::string_view bytes_;
  const HeightsSink& sink_;
  Rows at_;
  std::size_t at_byte_ = 0, line_ = 1;
};

bool XmlMapReader::take_point(GridPoints& points) {
  const std::size_t line = line_;
  const auto tag = take_tag("<point");
  if (!tag) {
    const bool is_end = at_byte_ >= bytes_.size();
    sink_.error(codes::heights_format, line,
                is_end ? "the file ends before </heightmap>: it is cut off"
                       : "expected <point X=\"column\" Y=\"row\">height</point> or </heightmap>");
    return false;
  }
  const auto column = index_below(at_.columns, attribute(*tag, "X")),
             row = index_below(at_.rows, attribute(*tag, "Y"));
  const std::size_t end = std::min(bytes_.find('<', at_byte_), bytes_.size());
  const auto height = parse_number(trim(bytes_.substr(at_byte_, end - at_byte_)));
  skip_to(end);
  constexpr std::string_view kClose = "</point>";
  if (!column || !row || !height || !starts_with(kClose)) {
    sink_.error(codes::heights_format, line,
                fmt::format("expected <point X=\"0 to {}\" Y=\"0 to {}\">height</point>", at_.columns - 1,
                            at_.rows - 1));
    return false;
  }
  skip_to(at_byte_ + kClose.size());
  skip_blanks_and_comments();
  return points.put(line, *column, *row, at_.x(*column), at_.y(*row), *height);
}

}  // namespace

void read_xml(std::string_view bytes, const HeightsSink& sink) { XmlMapReader(bytes, sink).read(); }

}  // namespace kerf::heights_detail
