// Matching the words of a comment with a form, element by element.
#include "front/gcode/comments/comment_forms.h"

#include <algorithm>

namespace kerf::gcode {
namespace {

constexpr double kMaxToolNumber = 1e8;

struct KindName {
  std::initializer_list<std::string_view> words;
  ToolKind kind;
};

/// Longer names before those that they start with.
const KindName kKinds[] = {{{"BOWL", "BIT"}, ToolKind::bull_nose},
                           {{"BULL", "NOSE", "END", "MILL"}, ToolKind::bull_nose},
                           {{"BULL", "NOSE", "ENDMILL"}, ToolKind::bull_nose},
                           {{"BULL", "NOSE"}, ToolKind::bull_nose},
                           {{"BULLNOSE"}, ToolKind::bull_nose},
                           {{"TOROIDAL", "CUTTER"}, ToolKind::bull_nose},
                           {{"BALL", "END", "MILL"}, ToolKind::ball},
                           {{"BALL", "ENDMILL"}, ToolKind::ball},
                           {{"BALL", "NOSE"}, ToolKind::ball},
                           {{"BALL", "MILL"}, ToolKind::ball},
                           {{"BALL", "END"}, ToolKind::ball},
                           {{"BALLNOSE"}, ToolKind::ball},
                           {{"BALLEND"}, ToolKind::ball},
                           {{"SPHERICAL", "CUTTER"}, ToolKind::ball},
                           {{"ROUND", "NOSE"}, ToolKind::ball},
                           {{"END", "MILL", "SPHER"}, ToolKind::ball},
                           {{"V", "BIT"}, ToolKind::vee},
                           {{"VBIT"}, ToolKind::vee},
                           {{"V", "GROOVE", "BIT"}, ToolKind::vee},
                           {{"V", "CARVE", "BIT"}, ToolKind::vee},
                           {{"ENGRAVING", "BIT"}, ToolKind::vee},
                           {{"CONICAL", "CUTTER"}, ToolKind::vee},
                           {{"CONICAL"}, ToolKind::vee},
                           {{"CHAMFER", "MILL"}, ToolKind::vee},
                           {{"FLAT", "END", "MILL"}, ToolKind::square},
                           {{"FLAT", "ENDMILL"}, ToolKind::square},
                           {{"SQUARE", "END", "MILL"}, ToolKind::square},
                           {{"SQUARE", "ENDMILL"}, ToolKind::square},
                           {{"END", "MILL"}, ToolKind::square},
                           {{"ENDMILLM"}, ToolKind::square},
                           {{"ENDMILL"}, ToolKind::square},
                           {{"CYLINDRICAL", "CUTTER"}, ToolKind::square},
                           {{"FACE", "MILL"}, ToolKind::square},
                           {{"CORN"}, ToolKind::square},
                           {{"ROUTER", "BIT"}, ToolKind::square},
                           {{"SPOILBOARD", "BIT"}, ToolKind::square},
                           {{"DRILL", "BIT"}, ToolKind::drill},
                           {{"TWIST", "DRILL"}, ToolKind::drill},
                           {{"DRILL"}, ToolKind::drill}};

/// Words about a tool that do not change its profile.
constexpr std::string_view kAdjectives[] = {"CARBIDE", "SOLID",  "HSS",    "VHM",         "HM",     "UPCUT",
                                            "DOWNCUT", "SPIRAL", "COATED", "COMPRESSION", "SINGLE", "DOUBLE"};

bool is_whole(const CommentToken& t) {
  return t.is_number() && t.whole && t.unit == CommentUnit::none && t.value < kMaxToolNumber;
}
bool is_length(const CommentToken& t) {
  return t.is_number() && (t.unit == CommentUnit::mm || t.unit == CommentUnit::inch);
}
bool is_angle(const CommentToken& t) {
  return t.is_number() && t.unit == CommentUnit::degrees && t.value > 0.0 && t.value < 180.0;
}

class Matcher {
 public:
  explicit Matcher(const std::vector<CommentToken>& tokens) : tokens_(tokens) {}

  bool run(std::string_view form) {
    while (!form.empty()) {
      const std::size_t end = std::min(form.find(' '), form.size());
      std::string_view element = form.substr(0, end);
      form.remove_prefix(std::min(end + 1, form.size()));
      const bool optional = element.size() > 1 && element.front() == '?';
      if (optional) element.remove_prefix(1);
      if (!take(element) && !optional) return false;
    }
    return at_ == tokens_.size();
  }
  FormMatch found;

 private:
  bool take(std::string_view element) {
    if (element == "@rest") return at_ = tokens_.size(), true;
    if (element == "@adjectives") return adjectives();
    if (at_ == tokens_.size()) return false;
    const CommentToken& token = tokens_[at_];
    if (element == "@kind") return kind();
    if (element == "@quoted") return quoted();
    if (element == "@number") {
      if (is_whole(token)) found.number = static_cast<int>(token.value);
      return next_if(is_whole(token));
    }
    if (element == "@length" || element == "@size") {
      const bool fits = is_length(token) || (element == "@size" && token.is_number() && !is_angle(token));
      if (fits) found.lengths.push_back(token);
      return next_if(fits);
    }
    if (element == "@nominal") return next_if(token.is_number() && !is_angle(token));
    if (element == "@angle") {
      if (is_angle(token)) found.angle = token.value;
      return next_if(is_angle(token));
    }
    if (element == "@tip") {
      if (is_length(token)) found.tip = token;
      return next_if(is_length(token));
    }
    if (element == "@count") return next_if(token.is_number() && token.unit == CommentUnit::none);
    return next_if(token.is(element));
  }

  bool next_if(bool fits) {
    if (fits) ++at_;
    return fits;
  }

  bool adjectives() {
    while (at_ < tokens_.size() && std::any_of(std::begin(kAdjectives), std::end(kAdjectives),
                                               [&](std::string_view word) { return tokens_[at_].is(word); }))
      ++at_;
    return true;
  }

  /// The words of a kind, with hyphens between them.
  bool kind() {
    for (const KindName& k : kKinds) {
      std::size_t at = at_;
      bool fits = true;
      for (const std::string_view word : k.words) {
        if (at > at_ && at < tokens_.size() && tokens_[at].is("-")) ++at;
        fits = fits && at < tokens_.size() && tokens_[at].is(word);
        ++at;
      }
      if (!fits) continue;
      found.kind = k.kind;
      at_ = at;
      return true;
    }
    return false;
  }

  /// A name in quotes, such as 0.8mm corn or 0.3mm30degree.
  bool quoted() {
    if (!tokens_[at_].is("\"")) return false;
    for (++at_; at_ < tokens_.size() && !tokens_[at_].is("\"");) {
      if (is_angle(tokens_[at_])) found.angle = tokens_[at_].value;
      if (is_length(tokens_[at_])) found.tip = tokens_[at_];
      if (!kind()) ++at_;
    }
    return next_if(at_ < tokens_.size());
  }

  const std::vector<CommentToken>& tokens_;
  std::size_t at_ = 0;
};

}  // namespace

std::optional<FormMatch> match_form(const std::vector<CommentToken>& tokens, std::string_view form) {
  Matcher matcher(tokens);
  return matcher.run(form) ? std::optional(std::move(matcher.found)) : std::nullopt;
}

}  // namespace kerf::gcode
