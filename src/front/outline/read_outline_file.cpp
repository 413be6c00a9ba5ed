// Outline files: JSON to outlines, with a check of the type of every value.
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/codes/outline.h"
#include "base/names.h"
#include "base/number.h"

#include "kerf/drawing/outline_files.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

class OutlineFileReader {
 public:
  OutlineFileReader(const std::string& file, Diagnostics& diagnostics)
      : file_(file), diagnostics_(diagnostics) {}
  std::vector<NamedOutline> read(const Json& root);

 private:
  bool error(const std::string& message) {
    diagnostics_.error(codes::outline_file_content, TextLocation{file_, 0, 0}, context_ + message);
    return false;
  }
  /// Every key of an object must be one of `known`.
  bool keys(const Json& object, const std::vector<std::string>& known);
  bool point(const Json& object, const char* key, Point2& out);
  bool corner(const Json& object, Length& out);
  bool outline(const Json& object, Outline& out, CornerRequests& corners);

  const std::string& file_;
  Diagnostics& diagnostics_;
  std::string context_;  // "outline 2, segment 5: "
  double scale_ = 1.0;
};

bool OutlineFileReader::keys(const Json& object, const std::vector<std::string>& known) {
  if (!object.is_object()) return error("an object { } is expected");
  for (const auto& item : object.items()) {
    bool found = false;
    for (const std::string& key : known) found = found || item.key() == key;
    if (!found)
      return error(
          fmt::format("unknown key \"{}\"; expected: {}", item.key().substr(0, 40), list_text(known)));
  }
  return true;
}

bool OutlineFileReader::point(const Json& object, const char* key, Point2& out) {
  const auto found = object.find(key);
  const bool valid = found != object.end() && found->is_array() && found->size() == 2 &&
                     (*found)[0].is_number() && (*found)[1].is_number();
  if (!valid) return error(fmt::format("\"{}\" must be two numbers, [x, y]", key));
  out = scale_ * Point2{(*found)[0].get<double>(), (*found)[1].get<double>()};
  return true;
}

bool OutlineFileReader::corner(const Json& object, Length& out) {
  const auto found = object.find("corner");
  if (found == object.end()) return true;
  if (!found->is_number()) return error("\"corner\" must be a number");
  out = mm(scale_ * found->get<double>());
  return true;
}

bool OutlineFileReader::outline(const Json& object, Outline& out, CornerRequests& corners) {
  const std::string whole = context_;
  if (!keys(object, {"name", "closed", "first", "segments"})) return false;
  const auto first = object.find("first");
  if (first == object.end()) return error("\"first\" is missing");
  context_ = whole + "first: ";
  if (!keys(*first, {"at", "corner"}) || !point(*first, "at", out.start) ||
      !corner(*first, corners.emplace_back()))
    return false;
  context_ = whole;
  const auto segments = object.find("segments");
  if (segments == object.end() || !segments->is_array()) return error("\"segments\" must be a list");
  for (const Json& item : *segments) {
    Segment segment;
    context_ = fmt::format("{}segment {}: ", whole, out.segments.size() + 1);
    if (!keys(item, {"to", "via", "corner"}) || !point(item, "to", segment.to) ||
        !corner(item, corners.emplace_back()))
      return false;
    Point2 via;
    if (item.contains("via")) {
      if (!point(item, "via", via)) return false;
      segment.via = via;
    }
    out.segments.push_back(segment);
  }
  context_ = whole;
  const auto closed_key = object.find("closed");
  if (closed_key == object.end()) return true;
  if (!closed_key->is_boolean()) return error("\"closed\" must be true or false");
  if (closed_key->get<bool>())
    out = closed(out), corners.resize(out.elements());
  else if (out.closed())
    return error("\"closed\" is false, but the last point is the first");
  return true;
}

std::vector<NamedOutline> OutlineFileReader::read(const Json& root) {
  if (!keys(root, {"unit", "outlines"})) return {};
  const Json unit = root.value("unit", Json("mm"));
  if (unit == "inch")
    scale_ = kMmPerInch;
  else if (unit != "mm")
    return error("\"unit\" must be \"mm\" or \"inch\""), std::vector<NamedOutline>();
  const auto outlines = root.find("outlines");
  if (outlines == root.end() || !outlines->is_array() || outlines->empty())
    return error("\"outlines\" must be a list of at least one outline"), std::vector<NamedOutline>();
  std::vector<NamedOutline> made;
  for (const Json& item : *outlines) {
    NamedOutline named;
    named.name = fmt::format("outline{}", made.size());
    if (item.is_object() && item.contains("name") && item["name"].is_string())
      named.name = item["name"].get<std::string>();
    context_ = fmt::format("outline \"{}\": ", named.name.substr(0, 80));
    if (!outline(item, named.outline, named.corners)) return {};
    made.push_back(std::move(named));
  }
  return made;
}

}  // namespace

std::vector<NamedOutline> read_outline_file(std::string_view text, const std::string& file_name,
                                            Diagnostics& diagnostics) {
  try {
    return OutlineFileReader(file_name, diagnostics).read(Json::parse(text));
  } catch (const Json::parse_error& problem) {
    // The text before the offending byte, for line and column.
    const std::size_t byte = std::min<std::size_t>(problem.byte == 0 ? 0 : problem.byte - 1, text.size());
    std::uint32_t line = 1, column = 1;
    for (const char c : text.substr(0, byte)) {
      ++column;
      if (c == '\n') ++line, column = 1;
    }
    diagnostics.error(codes::outline_file_syntax, TextLocation{file_name, line, column},
                      "this is not valid JSON");
  } catch (const Json::exception& problem) {  // a number beyond double
    diagnostics.error(codes::outline_file_content, TextLocation{file_name, 0, 0}, problem.what());
  }
  return {};
}

}  // namespace kerf
