// Fast path for lines of G0 or G1, axis words and F. The result must be that of run(); a test compares them.
#include "front/gcode/run/simple_lines.h"

#include "codec/gcode/decimal.h"

namespace kerf::gcode {
namespace {

/// The words of such a line. Bits of `axes`: 1, 2, 4 for X, Y, Z.
struct SimpleWords {
  double axis[3] = {};
  double feed = 0.0;
  unsigned axes = 0;
  Tenths motion = kMotionNotGiven;
  std::uint32_t column = 0;  // of the first word
  bool has_feed = false;
};

/// False for anything but at most one each of N (first), G0 or G1, X, Y, Z and F, with an axis word.
bool read_simple(std::string_view text, SimpleWords& words) {
  const char* p = text.data();
  const char* const end = p + text.size();
  bool numbered = false;
  while (p != end) {
    if (*p == ' ') {
      ++p;
      continue;
    }
    const char letter = *p;
    if (letter < 'F' || letter > 'Z') return false;
    const Decimal number = read_decimal(p + 1, end);
    if (number.fault != DecimalFault::none) return false;
    const auto column = static_cast<std::uint32_t>(p - text.data()) + 1;
    p = number.end;
    if (letter == 'N' && !numbered && words.column == 0) {
      numbered = true;
      continue;
    }
    if (words.column == 0) words.column = column;
    if (letter >= 'X') {
      const auto i = static_cast<unsigned>(letter - 'X');
      if ((words.axes >> i & 1u) != 0) return false;
      words.axes |= 1u << i;
      words.axis[i] = number.value;
    } else if (letter == 'G' && words.motion == kMotionNotGiven &&
               (number.value == 0.0 || number.value == 1.0)) {
      words.motion = number.value == 0.0 ? 0 : 10;
    } else if (letter == 'F' && !words.has_feed) {
      words.has_feed = true;
      words.feed = number.value;
    } else {
      return false;
    }
  }
  return words.axes != 0;
}

}  // namespace

/// Whether the modal state lets a line have only its plain meaning: absolute, per minute, unscaled, no
/// compensation.
bool SimpleLines::accepts() const {
  const bool printer = is_printer();
  const bool modes = modes_.absolute && modes_.feed_mode == FeedMode::per_minute && !modes_.diameters &&
                     !modes_.polar_centre && (modes_.motion == 0 || modes_.motion == 10);
  const bool path = coordinates_.frame().only_shifted && !compensation_.is_on() &&
                    !compensation_.is_leaving() && !corners_.is_holding() && !rotary_.used() &&
                    !mover_.starts_at_rest() && !feeds_.mode_repeated() && position_.reference_axes == 0;
  return modes && path && moved_ && !printer && !program_.ended && calls_.depth() == 0 &&
         !calls_.has_modal_macro();
}

std::size_t SimpleLines::run(BlockReader& reader, std::size_t limit) {
  std::size_t lines = 0;
  if (!accepts()) return lines;
  while (lines < limit && run_line(reader.peek(), reader.lines() + 1)) {
    reader.skip();
    ++lines;
  }
  return lines;
}

bool SimpleLines::run_line(std::string_view text, std::uint32_t number) {
  SimpleWords words;
  if (!read_simple(text, words) || !steps_.has_room()) return false;
  const Tenths motion = words.motion == kMotionNotGiven ? modes_.motion : words.motion;
  const double feed = words.has_feed ? words.feed * modes_.scale : modes_.feed;
  if (feed < 0.0 || (motion == 10 && !(feed > 0.0))) return false;
  ToolPosition to = position_;
  for (int axis = 0; axis < 3; ++axis)
    if ((words.axes >> axis & 1u) != 0)
      to.at[axis] = words.axis[axis] * modes_.scale + coordinates_.frame().shift[axis];
  to.unknown &= ~words.axes;
  if (!within_limit(to.at)) return false;
  modes_.motion = motion;
  modes_.feed = feed;
  if (words.has_feed) modes_.feed_scale = modes_.scale;
  if (motion == 10) feeds_.note_feed();
  end_.note_words();
  reporter_.at_line(number);
  const OriginId origin = steps_.start_line(number, words.column);
  if (motion == 0)
    path_.add(step::Rapid{to.at}, origin);
  else
    path_.add(step::Cut{to.at, mm_per_min(feed)}, origin);
  mover_.set_named(words.axes);
  mover_.arrive(to);
  return true;
}

}  // namespace kerf::gcode
