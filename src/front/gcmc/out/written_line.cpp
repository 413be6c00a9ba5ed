// Assignment of the words of a line written by literal().
#include "front/gcmc/out/written_line.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "codec/gcode/block.h"
#include "codec/gcode/lasting_effect.h"

#include "kerf/base/diagnostics.h"

namespace kerf::gcmc {
namespace {

constexpr double kMaxSeconds = 1e9;  // of a dwell

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// The words of one line, each used once.
class Sorter {
 public:
  Sorter(const gcode::Block& block, std::string& problem) : block_(block), obstacle_(problem) {}

  std::optional<WrittenLine> sort() {
    for (const gcode::Word& word : block_.words)
      if (!take(word)) return std::nullopt;
    if (!finish()) return std::nullopt;
    return std::move(line_);
  }

 private:
  bool refuse(std::string why) {
    obstacle_ = std::move(why);
    return false;
  }
  std::string shown(const gcode::Word& word) const {
    return word.letter + std::string(block_.value_text(word));
  }

  template <class T>
  bool once(std::optional<T>& slot, T value, const gcode::Word& word) {
    if (slot) return refuse(fmt::format("{} conflicts with another word of the line", shown(word)));
    slot = std::move(value);
    return true;
  }

  bool take(const gcode::Word& word) {
    switch (word.letter) {
      case 'G': return take_g(word);
      case 'M': return take_m(word);
      case 'S':
        if (!(word.value >= 0.0)) return refuse("a spindle speed cannot be negative");
        return once(line_.speed, word.value, word);
      case 'T':
        if (!(word.value >= 0.0 && word.value <= std::numeric_limits<int>::max()) ||
            word.value != std::floor(word.value))
          return refuse("a tool number is an integer from 0");
        return once(line_.selected, static_cast<int>(word.value), word);
      case 'P': return once(p_, word.value, word);
      case 'Q': return once(q_, word.value, word);
      default: other_word_ = shown(word); return true;
    }
  }

  bool take_g(const gcode::Word& word) {
    switch (static_cast<int>(std::lround(word.value * 10.0))) {
      case 40: return once(line_.dwell, step::Dwell{}, word);
      case 610: return once(line_.path_mode, step::PathMode{PathModeKind::exact_path, {}}, word);
      case 611: return once(line_.path_mode, step::PathMode{PathModeKind::exact_stop, {}}, word);
      default: return once(line_.path_mode, step::PathMode{PathModeKind::blend, {}}, word);
    }
  }

  bool take_m(const gcode::Word& word) {
    switch (static_cast<int>(std::lround(std::min(word.value, 1e6) * 10.0))) {
      case 0: return once(line_.pause, step::Pause{PauseKind::always}, word);
      case 10: return once(line_.pause, step::Pause{PauseKind::optional}, word);
      case 600: return once(line_.pause, step::Pause{PauseKind::pallet_change}, word);
      case 20: return once(line_.end, step::End{false}, word);
      case 300: return once(line_.end, step::End{true}, word);
      case 30: return once(line_.turn, SpindleTurn::cw, word);
      case 40: return once(line_.turn, SpindleTurn::ccw, word);
      case 50: return once(line_.turn, SpindleTurn::off, word);
      case 60: line_.changes_tool = true; return true;
      case 70: line_.mist = true; return true;
      case 80: line_.flood = true; return true;
      case 90: line_.no_coolant = true; return true;
      default: unknown_code_text_ = shown(word); return true;
    }
  }

  bool has_steps() const {
    return line_.speed || line_.selected || line_.changes_tool || line_.turn || line_.mist || line_.flood ||
           line_.no_coolant || line_.dwell || line_.path_mode || line_.pause || line_.end;
  }

  /// Assigns the parameters to the codes that use them.
  bool finish() {
    if (line_.pause && line_.end) return refuse("a line both pauses and ends the program");
    if (!unknown_code_text_.empty()) {
      if (has_steps())
        return refuse(fmt::format("{} cannot be on one line with other codes", unknown_code_text_));
      line_.verbatim = trimmed(block_.text);
      line_.notes.clear();  // they are in the text
      return true;
    }
    if (line_.dwell) {
      if (!p_ || !(*p_ >= 0.0 && *p_ <= kMaxSeconds)) return refuse("G4 needs P, its time in seconds");
      line_.dwell->time = seconds(*p_);
      p_.reset();
    } else if (line_.path_mode && line_.path_mode->kind == PathModeKind::blend) {
      if (p_.value_or(0.0) < 0.0) return refuse("a tolerance cannot be negative");
      line_.path_mode->tolerance = mm(p_.value_or(0.0));
      p_.reset();
      q_.reset();
    }
    if (p_) other_word_ = "P";
    if (q_) other_word_ = "Q";
    if (!other_word_.empty())
      return refuse(fmt::format("{} is not used by any code of the line", other_word_));
    return true;
  }

  const gcode::Block& block_;
  std::string& obstacle_;
  WrittenLine line_;
  std::optional<double> p_, q_;
  std::string other_word_;         // a parameter without an effect of its own
  std::string unknown_code_text_;  // an unknown M code
};

/// Whether a word that acts beyond its line becomes a step.
bool becomes_step(char letter, double value) {
  if (letter == 'S' || letter == 'T') return true;
  if (letter != 'M') return false;
  const auto tenths = std::lround(std::min(value, 1e6) * 10.0);
  return tenths <= 90 || tenths == 300 || tenths == 600;
}

}  // namespace

std::optional<WrittenLine> read_written_line(std::string_view text, std::string& problem) {
  Diagnostics found;
  gcode::BlockReader reader(text, {}, found);
  gcode::Block block;
  if (!reader.next(block)) return WrittenLine{};
  if (block.faulty) {
    problem = found.list().empty() ? "it is not G-code" : found.list().front().message;
    return std::nullopt;
  }
  if (gcode::Block next; reader.next(next)) {
    problem = "a carriage return ends a line of G-code";
    return std::nullopt;
  }
  gcode::Block rest = block;  // the words that do not become steps
  std::erase_if(rest.words, [](const gcode::Word& word) {
    return word.kind == gcode::ValueKind::number && becomes_step(word.letter, word.value);
  });
  if (const gcode::LastingEffect lasting = lasting_effect(rest); !lasting.effect.empty()) {
    problem = fmt::format("{} changes {}", lasting.word, lasting.effect);
    return std::nullopt;
  }
  std::optional<WrittenLine> line = Sorter(block, problem).sort();
  if (line && line->verbatim.empty())
    for (const gcode::Comment& comment : block.comments)
      if (const auto note = trimmed(comment.text); !note.empty()) line->notes.emplace_back(note);
  return line;
}

}  // namespace kerf::gcmc
