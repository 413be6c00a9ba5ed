// Regular expressions: a compiler to a small program, and its run for all alternatives at once (Thompson,
// Pike). No backtracking, so no expression takes exponential time.
#include "base/pattern.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace kerf {
namespace {

constexpr std::size_t kMaxInstructions = 20'000;
constexpr std::size_t kMaxRepeats = 1000;
constexpr int kMaxDepth = 100;                                  // of groups in groups
constexpr std::size_t kOpenEnd = static_cast<std::size_t>(-1);  // of {n,}
constexpr char32_t kLastCodePoint = 0x10FFFF;

/// The code point at `at` and its length in bytes; a byte that is no UTF-8 counts as a code point.
std::pair<char32_t, std::size_t> decode(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(at);
  const std::size_t length = first < 0xC0 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  if (length == 1 || at + length > text.size()) return {first, 1};
  char32_t c = first & (0xFFu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xC0u) != 0x80u) return {first, 1};
    c = c << 6 | (byte(at + i) & 0x3Fu);
  }
  return {c, length};
}

bool is_word(char32_t c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' || c >= 0xC0;
}

}  // namespace

bool Pattern::Set::contains(char32_t c) const {
  const bool found = std::any_of(ranges.begin(), ranges.end(),
                                 [c](const auto& range) { return c >= range.first && c <= range.second; });
  return found != negated;
}

/// Recursive descent over the expression; each function appends the code of what it reads.
class PatternCompiler {
 public:
  PatternCompiler(std::string_view text, LetterCase letters) : text_(text), letters_(letters) {}

  std::optional<Pattern> compile(std::string& problem) {
    alternatives(0);
    if (problem_.empty() && !at_end()) fail("unmatched )");
    add(Pattern::Op::accept);
    if (!problem_.empty()) {
      problem = problem_;
      return std::nullopt;
    }
    pattern_.groups_ = groups_;
    return std::move(pattern_);
  }

 private:
  using Op = Pattern::Op;

  bool at_end() const { return at_ >= text_.size(); }
  bool next_is(char c) const { return !at_end() && text_[at_] == c; }
  bool take(char c) {
    if (!next_is(c)) return false;
    ++at_;
    return true;
  }
  bool take(std::string_view word) {
    if (text_.substr(at_, word.size()) != word) return false;
    at_ += word.size();
    return true;
  }
  char32_t take_code_point() {
    const auto [c, length] = decode(text_, at_);
    at_ += length;
    return c;
  }
  void fail(std::string_view what) {
    if (problem_.empty()) problem_ = fmt::format("{} at character {} of {}", what, at_ + 1, text_);
    at_ = text_.size();
  }

  std::size_t size() const { return pattern_.program_.size(); }
  std::size_t add(Op op, std::size_t a = 0, std::size_t b = 0) {
    if (size() >= kMaxInstructions) {
      fail("expression too large");
      return size() - 1;
    }
    pattern_.program_.push_back({op, a, b});
    return size() - 1;
  }
  /// Makes room for a split before instruction `at`; its first target is what follows.
  void insert_split(std::size_t at) {
    add(Op::accept);
    auto& program = pattern_.program_;
    for (std::size_t i = size() - 1; i > at; --i) {
      program[i] = program[i - 1];
      if (program[i].op != Op::split && program[i].op != Op::jump) continue;
      if (program[i].a >= at) ++program[i].a;
      if (program[i].b >= at) ++program[i].b;
    }
    program[at] = {Op::split, at + 1, 0};
  }

  void alternatives(int depth) {
    if (depth > kMaxDepth) return fail("groups nested too deep");
    std::vector<std::size_t> leaves;
    std::size_t start = size();
    sequence(depth);
    while (take('|')) {
      insert_split(start);
      leaves.push_back(add(Op::jump));
      pattern_.program_[start].b = size();
      start = size();
      sequence(depth);
    }
    for (const std::size_t leave : leaves) pattern_.program_[leave].a = size();
  }

  void sequence(int depth) {
    while (problem_.empty() && !at_end() && !next_is('|') && !next_is(')')) {
      const std::size_t start = size();
      atom(depth);
      quantifier(start);
    }
  }

  void atom(int depth) {
    switch (text_[at_]) {
      case '(': return group(depth);
      case '[': return add_class();
      case '^':
        ++at_;
        add(Op::start);
        return;
      case '$':
        ++at_;
        add(Op::end);
        return;
      case '.': {
        ++at_;
        Pattern::Set set{true, {{'\n', '\n'}}};
        return add_set(std::move(set));
      }
      case '\\': return escape();
      case '*':
      case '+':
      case '?': return fail("nothing to repeat");
      default: {
        Pattern::Set set;
        const char32_t c = take_code_point();
        set.ranges.push_back({c, c});
        return add_set(std::move(set));
      }
    }
  }

  void group(int depth) {
    ++at_;
    const bool captures = !take("?:");
    if (captures && next_is('?')) {
      const std::string_view kind = text_.substr(at_, 3);
      if (kind.substr(0, 2) != "?<" || kind == "?<=" || kind == "?<!")
        return fail("unsupported kind of group");
      at_ = std::min(text_.find('>', at_), text_.size());
      if (!take('>')) return fail("unfinished name of a group");
    }
    const std::size_t number = captures ? ++groups_ : 0;
    if (captures) add(Op::save, 2 * number);
    alternatives(depth + 1);
    if (captures) add(Op::save, 2 * number + 1);
    if (problem_.empty() && !take(')')) fail("missing )");
  }

  void escape() {
    ++at_;
    if (at_end()) return fail("unfinished escape");
    const char c = text_[at_];
    if (c == 'b' || c == 'B' || c == 'A' || c == 'z' || c == 'Z') {
      ++at_;
      add(c == 'b' ? Op::word_edge : c == 'B' ? Op::no_word_edge : c == 'A' ? Op::start : Op::end);
      return;
    }
    Pattern::Set set;
    escaped(set);
    add_set(std::move(set));
  }

  /// The code points that the escape at `at_` (after the backslash) means.
  void escaped(Pattern::Set& set) {
    const char32_t c = take_code_point();
    static const std::vector<std::pair<char32_t, char32_t>> digits{{'0', '9'}},
        words{{'0', '9'}, {'A', 'Z'}, {'_', '_'}, {'a', 'z'}, {0xC0, kLastCodePoint}},
        spaces{{9, 13}, {' ', ' '}};
    const auto all = [&](const auto& ranges) {
      set.ranges.insert(set.ranges.end(), ranges.begin(), ranges.end());
    };
    const auto others = [&](const auto& ranges) {  // the gaps between sorted ranges
      char32_t next = 0;
      for (const auto& [first, last] : ranges) {
        if (first > next) set.ranges.push_back({next, first - 1});
        next = last + 1;
      }
      if (next <= kLastCodePoint) set.ranges.push_back({next, kLastCodePoint});
    };
    const auto one = [&](char32_t code) { set.ranges.push_back({code, code}); };
    switch (c) {
      case 'd': return all(digits);
      case 'D': return others(digits);
      case 'w': return all(words);
      case 'W': return others(words);
      case 's': return all(spaces);
      case 'S': return others(spaces);
      case 't': return one('\t');
      case 'n': return one('\n');
      case 'r': return one('\r');
      case 'f': return one('\f');
      case 'v': return one('\v');
      default: break;
    }
    if ((c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'))
      return fail("unsupported escape");
    one(c);
  }

  void add_class() {
    ++at_;
    Pattern::Set set;
    set.negated = take('^');
    bool first = true;
    while (problem_.empty() && (first || !next_is(']'))) {
      first = false;
      if (at_end()) return fail("missing ]");
      if (take('\\')) {
        if (at_end()) return fail("unfinished escape");
        escaped(set);
        if (set.ranges.empty() || set.ranges.back().first != set.ranges.back().second) continue;
      } else {
        const char32_t c = take_code_point();
        set.ranges.push_back({c, c});
      }
      if (!next_is('-') || text_.substr(at_, 2) == "-]" || at_ + 1 >= text_.size()) continue;
      ++at_;
      take('\\');
      if (at_end()) return fail("missing ]");
      set.ranges.back().second = take_code_point();
      if (set.ranges.back().second < set.ranges.back().first) return fail("reversed range");
    }
    if (problem_.empty()) ++at_;  // ]
    add_set(std::move(set));
  }

  void add_set(Pattern::Set set) {
    if (letters_ == LetterCase::ignored) {
      const auto ranges = set.ranges;
      for (const auto& [first, last] : ranges)
        for (const char32_t low : {U'A', U'a'}) {
          const char32_t from = std::max(first, low), to = std::min<char32_t>(last, low + 25);
          if (from > to) continue;
          const char32_t other = low == U'A' ? U'a' : U'A';
          set.ranges.push_back({from - low + other, to - low + other});
        }
    }
    pattern_.sets_.push_back(std::move(set));
    add(Op::set, pattern_.sets_.size() - 1);
  }

  std::optional<std::size_t> number() {
    std::size_t value = 0, digits = 0;
    for (; !at_end() && text_[at_] >= '0' && text_[at_] <= '9' && digits < 6; ++digits)
      value = value * 10 + static_cast<std::size_t>(text_[at_++] - '0');
    return digits > 0 ? std::optional(value) : std::nullopt;
  }

  /// {n}, {n,} or {n,m}; other braces are literals, as in max dialects.
  bool braces(std::size_t& min, std::size_t& max) {
    const std::size_t before = at_;
    if (!take('{')) return false;
    const auto low = number();
    bool good = low.has_value();
    if (good) min = max = *low;
    if (good && take(',')) max = next_is('}') ? kOpenEnd : number().value_or(0);
    if (good && take('}')) return true;
    at_ = before;
    return false;
  }

  void quantifier(std::size_t start) {
    std::size_t min = 1, max = 1;
    if (take('*'))
      min = 0, max = kOpenEnd;
    else if (take('+'))
      max = kOpenEnd;
    else if (take('?'))
      min = 0;
    else if (!braces(min, max))
      return;
    const bool lazy = take('?');
    if (next_is('*') || next_is('+') || next_is('?')) return fail("nested quantifier");
    if (min > kMaxRepeats || (max != kOpenEnd && (max > kMaxRepeats || max < min)))
      return fail("invalid number of repetitions");
    repeat(start, min, max, lazy);
  }

  /// The code [start, size) of one atom becomes that of its repetitions.
  void repeat(std::size_t start, std::size_t min, std::size_t max, bool lazy) {
    const std::vector<Pattern::Instruction> body(
        pattern_.program_.begin() + static_cast<std::ptrdiff_t>(start), pattern_.program_.end());
    pattern_.program_.resize(start);
    const auto emit_body = [&] {
      const std::size_t at = size();
      for (Pattern::Instruction c : body) {
        if (c.op == Op::split || c.op == Op::jump) {
          c.a = c.a - start + at;
          c.b = c.b - start + at;
        }
        add(c.op, c.a, c.b);
      }
    };
    const auto set_split = [&](std::size_t at, std::size_t into, std::size_t past) {
      pattern_.program_[at].a = lazy ? past : into;
      pattern_.program_[at].b = lazy ? into : past;
    };
    for (std::size_t i = 0; i < min && problem_.empty(); ++i) emit_body();
    if (max == kOpenEnd) {
      const std::size_t loop = add(Op::split);
      emit_body();
      add(Op::jump, loop);
      set_split(loop, loop + 1, size());
      return;
    }
    std::vector<std::size_t> splits;
    for (std::size_t i = min; i < max && problem_.empty(); ++i) {
      splits.push_back(add(Op::split));
      emit_body();
    }
    for (const std::size_t at : splits) set_split(at, at + 1, size());
  }

  std::string_view text_;
  LetterCase letters_;
  std::size_t at_ = 0;
  std::size_t groups_ = 0;
  std::string problem_;
  Pattern pattern_;
};

/// All threads of a run at one position of the text, those with precedence first.
class PatternRun {
 public:
  PatternRun(const Pattern& pattern, std::string_view text, bool whole)
      : pattern_(pattern), text_(text), whole_(whole), marks_(pattern.program_.size(), 0) {}

  std::optional<PatternMatch> run(std::size_t from) {
    for (std::size_t at = from;;) {
      if (found_.empty() && (!whole_ || at == from)) {
        std::vector<std::size_t> saved(2 * (pattern_.groups_ + 1), std::string_view::npos);
        saved[0] = at;
        follow(0, at, std::move(saved));
      }
      const bool at_end = at >= text_.size();
      const auto [c, length] = at_end ? std::pair<char32_t, std::size_t>{0, 1} : decode(text_, at);
      step(c, at, at + length, at_end);
      if (at_end || (threads_.empty() && (!found_.empty() || whole_))) break;
      at += length;
    }
    return result();
  }

 private:
  struct Thread {
    std::size_t at;
    std::vector<std::size_t> saved;
  };

  /// Adds the threads that instruction `first` leads to without a character, in order of precedence.
  void follow(std::size_t first, std::size_t position, std::vector<std::size_t> saved) {
    if (generation_ == 0) generation_ = 1;
    std::vector<Thread> open;
    open.push_back({first, std::move(saved)});
    while (!open.empty()) {
      Thread t = std::move(open.back());
      open.pop_back();
      if (marks_[t.at] == generation_) continue;
      marks_[t.at] = generation_;
      const Pattern::Instruction& c = pattern_.program_[t.at];
      switch (c.op) {
        case Pattern::Op::split:
          open.push_back({c.b, t.saved});
          open.push_back({c.a, std::move(t.saved)});
          break;
        case Pattern::Op::jump: open.push_back({c.a, std::move(t.saved)}); break;
        case Pattern::Op::save:
          t.saved[c.a] = position;
          open.push_back({t.at + 1, std::move(t.saved)});
          break;
        case Pattern::Op::start:
        case Pattern::Op::end:
        case Pattern::Op::word_edge:
        case Pattern::Op::no_word_edge:
          if (holds(c.op, position)) open.push_back({t.at + 1, std::move(t.saved)});
          break;
        case Pattern::Op::set:
        case Pattern::Op::accept: threads_.push_back(std::move(t)); break;
      }
    }
  }

  bool holds(Pattern::Op op, std::size_t position) const {
    if (op == Pattern::Op::start) return position == 0;
    if (op == Pattern::Op::end) return position >= text_.size();
    const bool before = position > 0 && is_word(static_cast<unsigned char>(text_[position - 1]));
    const bool after = position < text_.size() && is_word(static_cast<unsigned char>(text_[position]));
    return (before != after) == (op == Pattern::Op::word_edge);
  }

  void step(char32_t c, std::size_t position, std::size_t next, bool at_end) {
    std::vector<Thread> current;
    current.swap(threads_);
    ++generation_;
    for (Thread& t : current) {
      const Pattern::Instruction& i = pattern_.program_[t.at];
      if (i.op == Pattern::Op::accept) {
        if (whole_ && !at_end) continue;
        t.saved[1] = position;
        found_ = std::move(t.saved);
        break;  // threads of lower precedence end
      }
      if (!at_end && pattern_.sets_[i.a].contains(c)) follow(t.at + 1, next, std::move(t.saved));
    }
  }

  std::optional<PatternMatch> result() const {
    if (found_.empty()) return std::nullopt;
    PatternMatch match{found_[0], found_[1], {}};
    for (std::size_t g = 1; g <= pattern_.groups_; ++g) {
      const std::size_t from = found_[2 * g], to = found_[2 * g + 1];
      const bool took_part = from != std::string_view::npos && to != std::string_view::npos && to >= from;
      match.groups.emplace_back(took_part ? text_.substr(from, to - from) : std::string_view());
    }
    return match;
  }

  const Pattern& pattern_;
  std::string_view text_;
  bool whole_;
  std::vector<std::size_t> marks_;
  std::size_t generation_ = 0;
  std::vector<Thread> threads_;
  std::vector<std::size_t> found_;
};

std::optional<Pattern> Pattern::compile(std::string_view text, LetterCase letters, std::string& problem) {
  return PatternCompiler(text, letters).compile(problem);
}

std::optional<PatternMatch> Pattern::search(std::string_view text, std::size_t from) const {
  if (from > text.size()) return std::nullopt;
  return PatternRun(*this, text, false).run(from);
}

std::optional<PatternMatch> Pattern::match_whole(std::string_view text) const {
  return PatternRun(*this, text, true).run(0);
}

}  // namespace kerf
