// The stock in the comments of CAM programs.
#include "front/gcode/comments/cam_stock_comments.h"

#include <algorithm>

#include "front/gcode/comments/comment_words.h"

namespace kerf::gcode {
namespace {

constexpr std::size_t kMaxCommentBytes = 200;  // bytes
constexpr std::string_view kAxes[] = {"X", "Y", "Z"};
constexpr std::string_view kLow[] = {"MINX", "MINY", "MINZ"}, kHigh[] = {"MAXX", "MAXY", "MAXZ"};

double mm_of(const CommentToken& t, double scale) {
  return t.unit == CommentUnit::none ? t.value * scale : t.value;
}

/// The number after two words, as in "X MIN: -150".
const CommentToken* number_after(const std::vector<CommentToken>& tokens, std::string_view first,
                                 std::string_view second) {
  for (std::size_t i = 0; i + 2 < tokens.size(); ++i) {
    if (!tokens[i].is(first) || !tokens[i + 1].is(second)) continue;
    std::size_t at = i + 2;
    while (at + 1 < tokens.size() && (tokens[at].is(":") || tokens[at].is("="))) ++at;
    if (tokens[at].is_number()) return &tokens[at];
  }
  return nullptr;
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
  for (unsigned axis = 0; axis < 3; ++axis) {
    const CommentToken* low = number_after(tokens, kAxes[axis], "MIN");
    const CommentToken* high = number_after(tokens, kAxes[axis], "MAX");
    if (tokens.size() == 3 && tokens[1].is("=") && tokens[2].is_number()) {  // PyCAM
      if (tokens[0].is(kLow[axis])) low = &tokens[2];
      if (tokens[0].is(kHigh[axis])) high = &tokens[2];
    }
    if (low != nullptr) box_.low[static_cast<int>(axis)] = mm_of(*low, scale);
    if (high != nullptr) box_.high[static_cast<int>(axis)] = mm_of(*high, scale);
    given_ |= (low != nullptr ? 1u << axis : 0u) | (high != nullptr ? 8u << axis : 0u);
  }
}

void CamStockComments::read_sizes(std::string_view text, double scale) {
  const auto tokens = comment_tokens(text);
  if (contains_words(tokens, {"WORKPIECE", "DIMENSIONS"})) {  // CopperCAM
    std::vector<CommentToken> numbers;
    for (const CommentToken& t : tokens)
      if (t.is_number()) numbers.push_back(t);
    if (numbers.size() != 3) return;
    const double unit = numbers[2].unit == CommentUnit::mm     ? 1.0
                        : numbers[2].unit == CommentUnit::inch ? 25.4
                                                               : scale;
    size_ = Point3{mm_of(numbers[0], unit), mm_of(numbers[1], unit), mm_of(numbers[2], unit)};
  }
  if (contains_words(tokens, {"STOCK", "IS"})) {  // "Stock is 3"x3"x1""
    std::vector<double> lengths;
    for (const CommentToken& t : tokens)
      if (t.is_number()) lengths.push_back(mm_of(t, scale));
    if (lengths.size() == 3) size_ = Point3{lengths[0], lengths[1], lengths[2]};
  }
  const auto value = [&](const CommentToken* t) {
    return t != nullptr ? std::optional(mm_of(*t, scale)) : std::nullopt;
  };
  if (contains_words(tokens, {"MATERIAL", "THICKNESS"}))
    thickness_ = value(number_after(tokens, "THICKNESS"));
  if (contains_words(tokens, {"MATERIAL", "LENGTH"})) {  // SketchUcam
    length_ = value(number_after(tokens, "LENGTH"));
    width_ = value(number_after(tokens, "WIDTH"));
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
