// The writer of the gcmc text form.
#include "front/gcmc/out/text_sink.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>

#include "base/number.h"

namespace kerf::gcmc {
namespace {

constexpr std::size_t kChunkBytes = 1 << 16;    // bytes passed on at once
constexpr std::size_t kMaxLineBytes = 1 << 13;  // nine axes, offsets, feed: numbers of 330 digits at most
constexpr char kLetters[] = "XYZABCUVW";
constexpr char kOffsets[] = "IJK";

}  // namespace

TextSink::TextSink(Vm& vm, GcmcOutput& output)
    : vm_(vm),
      options_(vm.options()),
      output_(output),
      buffer_(new char[kChunkBytes + kMaxLineBytes]),
      at_(buffer_.get()) {}

/// The buffered text; empties the buffer, whose bytes stay valid until the next write.
std::string_view TextSink::take_buffer() {
  const std::string_view piece(buffer_.get(), static_cast<std::size_t>(at_ - buffer_.get()));
  at_ = buffer_.get();
  return piece;
}

/// Passes on text. Ends the program if the output is broken or exceeds the limit.
void TextSink::pass_on(std::string_view piece) {
  if (piece.empty()) return;
  output_.text(piece);
  if (output_.is_broken()) throw Stop{};
  vm_.count_output(piece.size());
}

void TextSink::flush() { pass_on(take_buffer()); }

void TextSink::flush_after_error() {
  const std::string_view piece = take_buffer();
  if (!piece.empty() && !output_.is_broken()) output_.text(piece);
}

/// Makes room for one line of any length up to kMaxLineBytes.
void TextSink::make_room() {
  if (at_ >= buffer_.get() + kChunkBytes) flush();
}

/// Text of any length.
void TextSink::put(std::string_view text) {
  make_room();
  if (text.size() > kMaxLineBytes) {
    flush();
    pass_on(text);
    return;
  }
  at_ = std::copy(text.begin(), text.end(), at_);
}

void TextSink::line(std::string_view text) {
  put(text);
  end_line();
}

/// A letter with its number, after a blank unless it starts the line.
void TextSink::word(char letter, double value, LineStart start) {
  if (start == LineStart::no) *at_++ = ' ';
  *at_++ = letter;
  if (char* end = write_fixed(at_, value, options_.precision)) {
    at_ = end;
    return;
  }
  std::string slow;
  append_fixed(slow, value, options_.precision, MinusZero::keep);
  at_ = std::copy(slow.begin(), slow.end(), at_);
}

// ---- prologue and epilogue

void TextSink::start() {
  if (!options_.prologue.empty()) {
    put(options_.prologue);
    return;
  }
  if (options_.frame == GcmcFrame::bare) return;
  if (options_.frame == GcmcFrame::subroutine) {
    if (!options_.subroutine_ends_program) line("%");
    line(fmt::format("(gcmc compiled function: {}, do not change)", options_.subroutine));
    line(fmt::format("o<{}> sub", options_.subroutine));
    return;
  }
  static constexpr std::string_view kPlanes[] = {"G17 ( Use XY plane )", "G18 ( Use XZ plane )",
                                                 "G19 ( Use YZ plane )"};
  line("(gcmc compiled code, do not change)");
  line(fmt::format("({})", options_.date));
  line("(-- prologue begin --)");
  line(kPlanes[static_cast<std::size_t>(options_.plane)]);
  line(options_.imperial ? "G20 ( Use inch )" : "G21 ( Use mm )");
  line("G40 ( Cancel cutter radius compensation )");
  line("G49 ( Cancel tool length compensation )");
  line("G54 ( Default coordinate system )");
  line("G80 ( Cancel canned cycle )");
  line(options_.relative ? "G91 ( Use relative distance mode )" : "G90 ( Use absolute distance mode )");
  line("G94 ( Units Per Minute feed rate mode )");
  line("G64 ( Enable path blending for best speed )");
  line("(-- prologue end --)");
}

void TextSink::end() {
  if (!options_.epilogue.empty()) {
    put(options_.epilogue);
  } else if (options_.frame == GcmcFrame::subroutine) {
    line(fmt::format("o<{}> endsub", options_.subroutine));
    line(options_.subroutine_ends_program ? "M2" : "%");
  } else if (options_.frame == GcmcFrame::usual) {
    line("(-- epilogue begin --)");
    line("M30 (-- epilogue end --)");
  }
  flush();
}

// ---- motions

/// The word of a motion; brief text omits a word that is in force.
void TextSink::start_motion(std::string_view motion, bool modal) {
  make_room();
  if (!options_.brief || mode_ != motion) {
    *at_++ = motion[0];
    *at_++ = motion[1];
    if (motion.size() > 2) *at_++ = motion[2];  // G73
  }
  mode_ = modal ? motion : std::string_view();
}

void TextSink::axes(const Axes& to, unsigned named, Words words) {
  const unsigned written = named & ((1u << (options_.uvw ? 9 : 6)) - 1u);
  for (unsigned left = written; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(left));
    const bool stays =
        options_.relative ? to[i] == last_[i] : (known_ & 1u << i) != 0 && to[i] == written_[i];
    if (words == Words::unless_repeated && options_.brief && stays) continue;
    written_[i] = to[i];
    word(kLetters[i], options_.relative ? to[i] - last_[i] : to[i]);
  }
  known_ |= written;
}

void TextSink::move(const Move& m) {
  make_room();
  char* const start = at_;
  start_motion(m.rapid ? "G0" : "G1", true);
  axes(m.to, m.named);
  if (m.feed > 0.0 && !(options_.brief && m.feed == feed_)) word('F', m.feed);
  if (m.feed > 0.0) feed_ = m.feed;
  last_ = m.to;
  if (at_ == start) return;  // brief, and nothing changes: no line
  if (*start == ' ') at_ = std::copy(start + 1, at_, start);
  end_line();
}

void TextSink::arc(const ArcMove& m) {
  start_motion(m.turn == Turn::cw ? "G2" : "G3", false);
  axes(m.to, m.named, Words::all);
  const PlaneAxes plane = named_axes_of(m.plane);
  word(kOffsets[plane.u], m.offset.x);
  word(kOffsets[plane.v], m.offset.y);
  if (m.turns > 0) at_ = fmt::format_to(at_, " P{}", m.turns);
  last_ = m.to;
  end_line();
}

void TextSink::drill(const DrillMove& m) {
  start_motion("G73", false);
  const Axes before = last_;
  axes(m.to, m.named & 7u, Words::all);
  word('R', options_.relative ? m.retract - before[2] : m.retract);
  word('Q', m.delta);
  if (m.repeat > 0) at_ = fmt::format_to(at_, " L{}", m.repeat);
  last_ = m.to;
  last_[2] = m.retract;
  forget();
  end_line();
}

void TextSink::broken_move(bool rapid) { line(rapid ? "G0" : "G1"); }

void TextSink::forget() {
  known_ = 0;
  mode_ = {};
}

// ---- state

void TextSink::feed_rate(double feed) {
  if (options_.brief && feed == feed_) return;
  feed_ = feed;
  make_room();
  word('F', feed, LineStart::yes);
  end_line();
}

void TextSink::feed_mode(int mode) {
  static constexpr std::string_view kModes[] = {"G93", "G94", "G95"};
  feed_ = -1.0;
  line(kModes[mode]);
}

void TextSink::spindle(double speed) {
  if (speed == 0.0) return line("M5");
  make_room();
  word('S', speed < 0.0 ? -speed : speed, LineStart::yes);
  end_line();
  line(speed > 0.0 ? "M3" : "M4");
}

void TextSink::spindle_speed(double speed) {
  make_room();
  word('S', speed, LineStart::yes);
  end_line();
}

void TextSink::coolant(int bits) {
  if (bits == 0) line("M9");
  if (bits & 1) line("M7");
  if (bits & 2) line("M8");
}

void TextSink::tool_change(int tool, bool length_offset) {
  line(fmt::format("T{}", tool));
  line("M6");
  if (length_offset) line(fmt::format("G43 H{}", tool));
  forget();
}

void TextSink::dwell(double seconds) {
  make_room();
  put("G4");
  word('P', seconds);
  end_line();
}

void TextSink::path_mode(bool exact, std::optional<double> p, std::optional<double> q) {
  put(exact ? "G61" : "G64");
  if (p) word('P', *p);
  if (q) word('Q', *q);
  end_line();
}

void TextSink::pause(bool optional) { line(optional ? "M1" : "M0"); }

void TextSink::plane(Plane plane) {
  static constexpr std::string_view kPlanes[] = {"G17", "G18", "G19"};
  line(kPlanes[static_cast<std::size_t>(plane)]);
}

void TextSink::comment(std::string_view text) {
  put("(");
  put(text);
  put(")\n");
}

void TextSink::literal(std::string_view text) {
  put(text);
  forget();  // it may have set anything
  feed_ = -1.0;
}

void TextSink::store_position(bool second) { line(second ? "G30.1" : "G28.1"); }

void TextSink::restore_position(bool second, const Axes& via, unsigned named, const Axes& end) {
  put(second ? "G30" : "G28");
  axes(via, named, Words::all);
  last_ = end;
  forget();
  end_line();
}

}  // namespace kerf::gcmc
