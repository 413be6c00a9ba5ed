// Tool comments in words. No grammar is common to the programs that write them, so a comment is searched
// for a kind of tool, a diameter, an angle and a tool number, and refused if it seems to name something else.
#include "front/gcode/comments/worded_tool_comment.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>

#include "front/gcode/comments/comment_words.h"

namespace kerf::gcode {
namespace {

using Tokens = std::vector<CommentToken>;

constexpr double kMaxDiameter = 500.0;  // mm
constexpr double kMaxToolNumber = 1e8;
constexpr double kPointAngle = 118.0;       // degrees, of a drill
constexpr double kCountersinkAngle = 90.0;  // degrees
constexpr double kVeeDiameter = 12.7;       // mm, if a comment has only the angle
constexpr double kEngraverShank = 3.175;    // mm, of a V with a tip but without a diameter
constexpr double kMaxTip = 1.0;  // mm: "30 degree 0.3 mm" is the tip, "60 degree 6 mm" the diameter

enum class Kind { square, ball, bull_nose, vee, drill, unusable };

struct KindName {
  std::initializer_list<std::string_view> words;
  Kind kind;
};

/// In the order in which they are searched: the first one that a comment contains is its kind.
const KindName kKinds[] = {{{"LOLLIPOP"}, Kind::unusable},
                           {{"THREAD"}, Kind::unusable},
                           {{"THREADMILL"}, Kind::unusable},
                           {{"SLOT", "MILL"}, Kind::unusable},
                           {{"T", "SLOT"}, Kind::unusable},
                           {{"PROBE"}, Kind::unusable},
                           {{"KEYHOLE"}, Kind::unusable},
                           {{"DOVETAIL"}, Kind::unusable},
                           {{"ROUNDOVER"}, Kind::unusable},
                           {{"ROUND", "OVER"}, Kind::unusable},
                           {{"RADIUS", "MILL"}, Kind::unusable},
                           {{"TAPERED"}, Kind::unusable},
                           {{"DRAG"}, Kind::unusable},
                           {{"TURNING"}, Kind::unusable},
                           {{"DRAWN"}, Kind::unusable},
                           {{"CORNER", "ROUNDING"}, Kind::unusable},
                           {{"FLAT", "GROOVE"}, Kind::unusable},
                           {{"BOWL"}, Kind::bull_nose},
                           {{"BULL"}, Kind::bull_nose},
                           {{"BULLNOSE"}, Kind::bull_nose},
                           {{"TOROIDAL"}, Kind::bull_nose},
                           {{"BALL"}, Kind::ball},
                           {{"BALLNOSE"}, Kind::ball},
                           {{"BALLEND"}, Kind::ball},
                           {{"SPHER"}, Kind::ball},
                           {{"SPHERICAL"}, Kind::ball},
                           {{"SPHERICALCUTTER"}, Kind::ball},
                           {{"ROUND", "NOSE"}, Kind::ball},
                           {{"V", "BIT"}, Kind::vee},
                           {{"VBIT"}, Kind::vee},
                           {{"V", "GROOVE"}, Kind::vee},
                           {{"VEE"}, Kind::vee},
                           {{"V", "CARVE"}, Kind::vee},
                           {{"CONICAL"}, Kind::vee},
                           {{"ENGRAVER"}, Kind::vee},
                           {{"ENGRAVING", "BIT"}, Kind::vee},
                           {{"ENGRAVE", "BIT"}, Kind::vee},
                           {{"CHAMFER", "MILL"}, Kind::vee},
                           {{"COUNTERSINK"}, Kind::vee},
                           {{"COUNTER", "SINK"}, Kind::vee},
                           {{"END", "MILL"}, Kind::square},
                           {{"ENDMILL"}, Kind::square},
                           {{"ENDMILLM"}, Kind::square},
                           {{"FLAT"}, Kind::square},
                           {{"CYLINDRICAL"}, Kind::square},
                           {{"CYLINDRICALCUTTER"}, Kind::square},
                           {{"FACE", "MILL"}, Kind::square},
                           {{"CORN"}, Kind::square},
                           {{"CORNCOB"}, Kind::square},
                           {{"UPCUT"}, Kind::square},
                           {{"DOWNCUT"}, Kind::square},
                           {{"COMPRESSION"}, Kind::square},
                           {{"FREZA"}, Kind::square},
                           {{"FREES"}, Kind::square},
                           {{"CRB"}, Kind::square},
                           {{"ROUTER", "BIT"}, Kind::square},
                           {{"REAMER"}, Kind::square},
                           {{"TAP"}, Kind::square},
                           {{"BORING", "BAR"}, Kind::square},
                           {{"DRILL"}, Kind::drill},
                           {{"DRILL", "BIT"}, Kind::drill},
                           {{"CARBIDE"}, Kind::square},
                           {{"CUTTER"}, Kind::square},
                           {{"MILL"}, Kind::square},
                           {{"BIT"}, Kind::square},
                           {{"CHAMFER"}, Kind::vee},
                           {{"V"}, Kind::vee}};

/// Words of comments about the part, an operation or the stock.
constexpr std::string_view kOther[] = {"HOLE",     "HOLES",   "POCKET",  "DEEP",      "DEPTH",    "WORKPIECE",
                                       "MATERIAL", "STOCK",   "PROFILE", "CONTOUR",   "THICK",    "TAB",
                                       "TABS",     "PLYWOOD", "STEP",    "STEPDOWN",  "OVERLAP",  "FEED",
                                       "FEEDRATE", "SPEED",   "RPM",     "CLEARANCE", "OFFSET",   "RETRACT",
                                       "SAFE",     "HEIGHT",  "TIME",    "TOOLPATHS", "THICKNESS"};

/// Words before which a number is another dimension of the tool.
constexpr std::string_view kNotDiameter[] = {"LOC", "LEN",   "LONG",  "LENGTH", "FLUTE", "FLUTES",
                                             "FL",  "SHANK", "SHAFT", "OAL",    "RAD",   "RADIUS"};
constexpr std::string_view kDiameterWords[] = {"DIAMETER", "DIAMETRE", "DIAM", "DIA", "DURCHMESSER"};
constexpr std::string_view kToolWords[] = {"TOOL", "TOOLS", "CUTTER", "BIT", "BITS", "MILL", "DRILL", "T"};

template <std::size_t N>
bool is_any(const CommentToken& token, const std::string_view (&words)[N]) {
  return std::any_of(std::begin(words), std::end(words),
                     [&](std::string_view word) { return token.is(word); });
}

template <std::size_t N>
bool has_any(const Tokens& tokens, const std::string_view (&words)[N]) {
  return std::any_of(tokens.begin(), tokens.end(), [&](const CommentToken& t) { return is_any(t, words); });
}

std::optional<Kind> kind_of(const Tokens& tokens) {
  for (const KindName& k : kKinds)
    if (contains_words(tokens, k.words)) return k.kind;
  return std::nullopt;
}

bool is_length(const CommentToken& t) {
  return t.is_number() && (t.unit == CommentUnit::mm || t.unit == CommentUnit::inch);
}

/// The number of the tool: "T04", "TOOL #5", "TOOL NUMBER: 1", "TOOL: T1", "1 = End Mill". A number with a
/// unit is a diameter.
std::optional<int> tool_number(const Tokens& tokens) {
  const auto whole = [](const CommentToken& t) {
    return t.is_number() && t.whole && t.unit == CommentUnit::none && t.value < kMaxToolNumber;
  };
  if (tokens.size() > 1 && whole(tokens[0]) && tokens[1].is("=")) return static_cast<int>(tokens[0].value);
  for (std::size_t i = 0; i + 1 < tokens.size(); ++i) {
    const bool tool = tokens[i].is("TOOL"), letter = tokens[i].is("T");
    if (!tool && !letter) continue;
    std::size_t at = i + 1;
    while (tool && at + 1 < tokens.size() &&
           (tokens[at].kind == CommentToken::Kind::sign || tokens[at].is("NUMBER") || tokens[at].is("NO") ||
            tokens[at].is("T")))
      ++at;
    if (whole(tokens[at])) return static_cast<int>(tokens[at].value);
  }
  return std::nullopt;
}

/// The number is another dimension: flutes, length of cut.
bool is_other_dimension(const Tokens& tokens, std::size_t i) {
  const bool before = i + 1 < tokens.size() && is_any(tokens[i + 1], kNotDiameter);
  std::size_t at = i;
  while (at > 0 && tokens[at - 1].kind == CommentToken::Kind::sign && !tokens[at - 1].is(",")) --at;
  return before || (at > 0 && is_any(tokens[at - 1], kNotDiameter));
}

/// The diameter in mm that a word names, as in "Diam = 3mm", "10.0 dia.", "D10" and "drill size 0.8mm".
std::optional<double> named_diameter(const Tokens& tokens, double scale) {
  const auto mm_of = [&](const CommentToken* t) -> std::optional<double> {
    if (t == nullptr || t->unit == CommentUnit::degrees) return std::nullopt;
    return t->unit == CommentUnit::none ? t->value * scale : t->value;
  };
  for (const std::string_view word : kDiameterWords) {
    if (const auto value = mm_of(number_after(tokens, word))) return value;
    if (const auto value = mm_of(number_before(tokens, word))) return value;
  }
  for (const std::string_view word : {"SIZE", "SIZES", "D", "\xc3\x98"})
    if (const auto value = mm_of(number_after(tokens, word))) return value;
  return std::nullopt;
}

/// The first length with a unit that is not another dimension.
std::optional<double> unnamed_diameter(const Tokens& tokens) {
  for (std::size_t i = 0; i < tokens.size(); ++i)
    if (is_length(tokens[i]) && !is_other_dimension(tokens, i)) return tokens[i].value;
  return std::nullopt;
}

std::optional<double> angle_in(const Tokens& tokens) {
  for (const CommentToken& t : tokens)
    if (t.is_number() && t.unit == CommentUnit::degrees && t.value > 0.0 && t.value < 180.0) return t.value;
  return std::nullopt;
}

/// `named`: the diameter is named as such; else a short length is the tip.
std::optional<ToolShape> vee(double angle, std::optional<double> named, std::optional<double> unnamed) {
  shape::Vee shape{{}, {}, degrees(angle), {}, {}};
  const bool has_tip = unnamed && *unnamed <= kMaxTip && (!named || *unnamed < *named);
  if (has_tip) shape.tip_diameter = mm(*unnamed);
  const double diameter = named ? *named : has_tip ? kEngraverShank : unnamed.value_or(kVeeDiameter);
  if (!(diameter > 0.0) || diameter > kMaxDiameter) return std::nullopt;
  shape.diameter = mm(diameter);
  return shape;
}

std::optional<ToolShape> shape_for(Kind kind, double diameter, const Tokens& tokens, double scale) {
  if (!(diameter > 0.0) || diameter > kMaxDiameter) return std::nullopt;
  switch (kind) {
    case Kind::ball: return shape::Ball{mm(diameter), {}};
    case Kind::drill: return shape::Drill{mm(diameter), {}, degrees(angle_in(tokens).value_or(kPointAngle))};
    case Kind::bull_nose: {
      for (const std::string_view word : {"CR", "R", "RADIUS"})
        if (const CommentToken* r = number_after(tokens, word); r != nullptr && r->value > 0.0) {
          const double radius = r->unit == CommentUnit::none ? r->value * scale : r->value;
          if (2.0 * radius <= diameter) return shape::BullNose{mm(diameter), {}, mm(radius)};
        }
      return std::nullopt;
    }
    default: return shape::Square{mm(diameter), {}};
  }
}

}  // namespace

std::optional<CamTool> read_worded_tool_comment(std::string_view text, double scale, bool at_tool_change) {
  const Tokens tokens = comment_tokens(text);
  const auto has_number = [](const CommentToken& t) { return t.is_number(); };
  if (std::none_of(tokens.begin(), tokens.end(), has_number) || has_any(tokens, kOther)) return std::nullopt;
  const std::optional<Kind> kind = kind_of(tokens);
  const std::optional<double> named = named_diameter(tokens, scale), unnamed = unnamed_diameter(tokens);
  const std::optional<double> angle = angle_in(tokens);
  const std::optional<int> number = tool_number(tokens);
  if (kind == Kind::unusable) return std::nullopt;
  const bool about_tool = kind || number || at_tool_change || has_any(tokens, kToolWords);
  if (!about_tool) return std::nullopt;
  if (kind == Kind::vee || (angle && kind != Kind::drill)) {
    const bool sinks = contains_words(tokens, {"COUNTERSINK"}) || contains_words(tokens, {"COUNTER", "SINK"});
    const std::optional<double> cone = angle   ? angle
                                       : sinks ? std::optional(kCountersinkAngle)
                                               : std::nullopt;
    const auto shape = cone ? vee(*cone, named, unnamed) : std::nullopt;
    if (!shape) return std::nullopt;
    return CamTool{number, *shape, angle ? std::string_view() : kAssumedCountersink};
  }
  const std::optional<double> diameter = named ? named : unnamed;
  if (!diameter || (!kind && !named && !at_tool_change && !contains_words(tokens, {"TOOL"})))
    return std::nullopt;
  const auto shape = shape_for(kind.value_or(Kind::square), *diameter, tokens, scale);
  if (!shape) return std::nullopt;
  std::string capitals(text);
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return CamTool{number, *shape, assumed_profile(capitals)};
}

}  // namespace kerf::gcode
