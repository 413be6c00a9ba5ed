// The stock in the comments of CAM programs.
#include "front/gcode/comments/cam_stock_comments.h"

#include <algorithm>
#include <array>

#include "front/gcode/comments/comment_forms.h"

#include "kerf/base/units.h"

namespace kerf::gcode {
namespace {

constexpr std::size_t kMaxCommentBytes = 200;  // bytes
constexpr std::string_view kAxes[] = {"X", "Y", "Z"};
constexpr std::string_view kLow[] = {"MINX", "MINY", "MINZ"}, kHigh[] = {"MAXX", "MAXY", "MAXZ"};

double mm_of(const CommentToken& t, double scale) {
  return t.unit == CommentUnit::none ? t.value * scale : t.value;
}

/// "X MIN:-150.000  Y MIN:-115.000  Z MIN:-20.000": the numbers after the names of the axes, in any number of
/// them; nothing else is in the comment.
bool read_bounds(const std::vector<CommentToken>& tokens, std::string_view which,
                 std::array<const CommentToken*, 3>& out) {
  for (std::size_t at = 0; at < tokens.size();) {
    const auto axis = std::find_if(std::begin(kAxes), std::end(kAxes),
                                   [&](std::string_view name) { return tokens[at].is(name); });
    if (axis == std::end(kAxes) || at + 1 >= tokens.size() || !tokens[at + 1].is(which)) return false;
    for (at += 2; at < tokens.size() && (tokens[at].is(":") || tokens[at].is("="));) ++at;
    if (at == tokens.size() || !tokens[at].is_number()) return false;
    out[static_cast<std::size_t>(axis - std::begin(kAxes))] = &tokens[at++];
  }
  return true;
}

}  // namespace

void CamStockComments::read(std::string_view text, double scale) {
  if (text.size() > kMaxCommentBytes || comments_left_ == 0) return;
  --comments_left_;
  if (text.find_first_of("0123456789") == std::string_view::npos) return;
  read_corners(text, scale);
  read_sizes(text, scale);
}

void CamStockComments::read_corners(std::string_view text, double scale) {
  const auto tokens = comment_tokens(text);
  std::array<const CommentToken*, 3> low{}, high{};
  if (!read_bounds(tokens, "MIN", low)) low = {};
  if (!read_bounds(tokens, "MAX", high)) high = {};
  for (unsigned axis = 0; axis < 3; ++axis) {
    if (tokens.size() == 3 && tokens[1].is("=") && tokens[2].is_number()) {  // PyCAM
      if (tokens[0].is(kLow[axis])) low[axis] = &tokens[2];
      if (tokens[0].is(kHigh[axis])) high[axis] = &tokens[2];
    }
    if (low[axis] != nullptr) box_.low[static_cast<int>(axis)] = mm_of(*low[axis], scale);
    if (high[axis] != nullptr) box_.high[static_cast<int>(axis)] = mm_of(*high[axis], scale);
    given_ |= (low[axis] != nullptr ? 1u << axis : 0u) | (high[axis] != nullptr ? 8u << axis : 0u);
  }
}

void CamStockComments::read_sizes(std::string_view text, double scale) {
  const auto tokens = comment_tokens(text);
  const auto size_in = [&](std::string_view form) -> std::optional<Point3> {
    const auto m = match_form(tokens, form);
    if (!m) return std::nullopt;
    const CommentUnit last = m->lengths[2].unit;  // counts for all
    const double unit = last == CommentUnit::mm ? 1.0 : last == CommentUnit::inch ? kMmPerInch : scale;
    return Point3{mm_of(m->lengths[0], unit), mm_of(m->lengths[1], unit), mm_of(m->lengths[2], unit)};
  };
  if (const auto size = size_in("WORKPIECE DIMENSIONS : @size X @size X @size")) size_ = size;  // CopperCAM
  if (const auto size = size_in("STOCK IS @size X @size X @size")) size_ = size;
  if (const auto m = match_form(tokens, "MATERIAL THICKNESS : @size"))  // SketchUcam
    thickness_ = mm_of(m->lengths[0], scale);
  if (const auto m = match_form(tokens, "MATERIAL LENGTH : @size X WIDTH : @size")) {
    length_ = mm_of(m->lengths[0], scale);
    width_ = mm_of(m->lengths[1], scale);
  }
}

std::optional<Stock> CamStockComments::stock() const {
  Stock stock;
  if (given_ == 63)
    stock.block = box_;
  else if (size_)
    stock = make_block(*size_, ZeroCorner::lower_left, ZeroHeight::top);
  else if (length_ && width_ && thickness_)
    stock = make_block({*length_, *width_, *thickness_}, ZeroCorner::lower_left, ZeroHeight::top);
  else
    return std::nullopt;
  return is_solid(stock) ? std::optional(stock) : std::nullopt;
}

}  // namespace kerf::gcode
