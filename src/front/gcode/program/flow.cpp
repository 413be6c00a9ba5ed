// Execution of O-words: loops, conditions, calls.
#include "front/gcode/program/flow.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/gcode.h"
#include "front/gcode/program/line_words.h"
#include "front/gcode/program/o_word.h"

namespace kerf::gcode {
namespace {

constexpr std::size_t kMaxCallDepth = 100;
constexpr std::size_t kLineCost = 16;  // bytes added for each line, so that empty ones count too
constexpr double kMaxRepeats = 1e9;

/// Whether a line of a Fanuc program returns from a subprogram or ends the program.
enum class FlowWord : std::uint8_t { none, returns, ends };

FlowWord flow_word_of(std::string_view line) {
  int depth = 0;
  for (std::size_t i = 0; i < line.size() && line[i] != ';'; ++i) {
    if (line[i] == '(') ++depth;
    if (line[i] == ')') --depth;
    const char c = static_cast<char>(line[i] & ~0x20);  // in capitals
    if (depth > 0 || (c != 'M' && c != 'O')) continue;
    const bool in_word = i > 0 && static_cast<char>(line[i - 1] & ~0x20) >= 'A';  // GOTO, DO
    if (in_word) continue;
    if (c == 'O') return FlowWord::ends;  // start of another program
    std::size_t end = i + 1;
    while (end < line.size() && line[end] >= '0' && line[end] <= '9') ++end;
    const std::string_view number = line.substr(i + 1, end - i - 1);
    if (number == "99") return FlowWord::returns;
    if (number == "2" || number == "02" || number == "30") return FlowWord::ends;
  }
  return FlowWord::none;
}

}  // namespace

Flow::Flow(std::string_view text, const GcodeReadOptions& options, LineReporter& reporter,
           Parameters& parameters, GcodeDialect dialect, Diagnostics& diagnostics)
    : options_(options),
      dialect_(dialect),
      reporter_(reporter),
      parameters_(parameters),
      diagnostics_(diagnostics) {
  auto source = std::make_unique<Source>();
  source->name = options.file_name;
  source->reader = std::make_unique<BlockReader>(text, reader_options(options.file_name), diagnostics);
  frames_.emplace_back().source = source.get();
  sources_.push_back(std::move(source));
}

Flow::~Flow() = default;

BlockReaderOptions Flow::reader_options(const std::string& name) const {
  const bool printer = is_printer(dialect_);
  const auto commands = printer ? BlockReaderOptions::Commands::words : BlockReaderOptions::Commands::letters;
  return {name, options_.max_line_bytes, options_.strict, commands, is_fanuc(dialect_)};
}

bool Flow::next(Block& block) {
  while (!stopped_) {
    if (frames_.back().source->reader->next(block)) return !jumped_ || may_run(block);
    if (frames_.size() == 1) return false;
    return_from_call();  // a subroutine's file may end without endsub
  }
  return false;
}

bool Flow::may_run(const Block& block) {
  work_ += block.text.size() + kLineCost;
  if (work_ <= options_.max_rerun_bytes) return true;
  reporter_.at_line(block.line);
  reporter_.error(codes::runs_too_long, 1,
                  "loops and calls repeat too many lines; the rest of the program is not read",
                  "does every loop end?");
  stopped_ = true;
  return false;
}

void Flow::jump(std::size_t position, std::uint32_t lines) {
  jumped_ = true;
  frames_.back().source->reader->seek(position, lines);
}

void Flow::jump_to(std::size_t o_line_index) {
  const OLine& line = o_line(o_line_index);
  jump(line.start, line.lines_before);
}

void Flow::jump_after(std::size_t o_line_index) {
  const OLine& line = o_line(o_line_index);
  jump(line.next, line.lines_before + 1);
}

/// Index of the last line in the list of O-words.
std::optional<std::size_t> Flow::find_o_line(const Block& block) {
  Source& source = *frames_.back().source;
  list_o_words(source);
  const auto found = std::lower_bound(
      source.o_lines.begin(), source.o_lines.end(), block.line,
      [](const OLine& line, std::uint32_t number) { return line.lines_before + 1 < number; });
  if (found == source.o_lines.end() || found->lines_before + 1 != block.line) return std::nullopt;
  return static_cast<std::size_t>(found - source.o_lines.begin());
}

std::optional<double> Flow::value_of(ExpressionReader& reader, std::uint32_t column) {
  const std::optional<double> value = reader.value();
  if (!value)
    reporter_.error(reader.fault().code, column + static_cast<std::uint32_t>(reader.fault().offset),
                    reader.fault().message);
  return value;
}

/// The value of if, while and repeat.
std::optional<double> Flow::condition_value(const Block& block) {
  const OWord word = read_o_word(block.o_word->text);
  const auto offset = static_cast<std::uint32_t>(word.values.data() - block.o_word->text.data());
  ExpressionReader reader(word.values, parameters_);
  if (reader.at_end() || word.values[reader.position()] != '[') {
    reporter_.error(codes::o_word_malformed, block.o_word->column,
                    "expected an expression in square brackets after this word");
    return std::nullopt;
  }
  const std::optional<double> value = value_of(reader, block.o_word->column + offset);
  unknown_value_ = unknown_value_ || reader.is_unknown();
  return value;
}

void Flow::control(const Block& block) {
  reporter_.at_line(block.line);
  const std::optional<std::size_t> at = find_o_line(block);
  if (!at || o_line(*at).kind == OKind::invalid) {
    reporter_.error(codes::o_word_malformed, block.o_word->column,
                    starts_macro_statement(block.o_word->text)
                        ? "expected WHILE [..] DOn, ENDn, GOTO n, IF [..] GOTO n or IF [..] THEN #n = .."
                        : "expected a label and a keyword after O: sub, call, if, while ...");
    return;
  }
  execute(*at, block);
}

void Flow::execute(std::size_t at, const Block& block) {
  const OLine& line = o_line(at);
  const bool paired = line.partner != at;
  const std::uint32_t column = block.o_word->column;
  switch (line.kind) {
    case OKind::sub:
      if (first_subroutine_.empty()) first_subroutine_ = read_o_word(block.o_word->text).label;
      if (!paired) return void(unmatched(line, column));
      if (depth() == 0 && called_.count(line.label) != 0)
        reporter_.unusual(
            codes::o_word_unmatched, column,
            fmt::format("subroutine {} is defined after its call; LinuxCNC refuses that", line.label));
      return jump_after(line.partner);
    case OKind::end_sub:
    case OKind::return_sub: return return_with_value(block);
    case OKind::call: return call(block);
    case OKind::if_branch: return paired ? branch(at, block) : void(unmatched(line, column));
    case OKind::else_if:
    case OKind::else_branch: return paired ? jump_after(line.partner) : void(unmatched(line, column));
    case OKind::loop_while:
      if (!paired) return void(unmatched(line, column));
      if (condition_value(block).value_or(0.0) == 0.0) jump_after(line.partner);
      return;
    case OKind::end_while: return paired ? jump_to(line.partner) : void(unmatched(line, column));
    case OKind::while_of_do:
      if (condition_value(block).value_or(0.0) != 0.0) jump_after(line.partner);
      return;
    case OKind::repeat: return paired ? start_repeat(at, block) : void(unmatched(line, column));
    case OKind::end_repeat: return paired ? end_repeat(at) : void(unmatched(line, column));
    case OKind::break_loop:
    case OKind::continue_loop: return leave_loop(at, column);
    case OKind::go_to:
    case OKind::go_to_if:
    case OKind::assign_if: return run_macro_statement(line, block);
    case OKind::end_if:
    case OKind::endless_loop:
    case OKind::loop_do:
      if (!paired) unmatched(line, column);
      return;
    case OKind::number:
    case OKind::invalid: return;
  }
}

void Flow::run_macro_statement(const OLine& line, const Block& block) {
  const OWord word = read_o_word(block.o_word->text);
  const std::uint32_t column = block.o_word->column;
  if (line.kind != OKind::go_to && condition_value(block).value_or(0.0) == 0.0) return;
  const std::string_view action = line.kind == OKind::go_to ? word.values : word.action;
  const auto at = column + static_cast<std::uint32_t>(action.data() - block.o_word->text.data());
  if (line.kind == OKind::assign_if) return void(assign({action, at}, parameters_, reporter_));
  ExpressionReader reader(action, parameters_);
  const std::optional<double> target = value_of(reader, at);
  unknown_value_ = unknown_value_ || reader.is_unknown();
  if (target) go_to_line(*target, at);
}

/// The program around a position: from its O number to the next one.
std::pair<std::size_t, std::size_t> Flow::program_around(std::size_t position) {
  const Source& source = *frames_.back().source;
  std::size_t start = 0, end = source.reader->text().size();
  for (const OLine& line : source.o_lines) {
    if (line.kind != OKind::number) continue;
    if (line.start >= position) {
      end = line.start;
      break;
    }
    start = line.start;
  }
  return {start, end};
}

void Flow::go_to_line(double number, std::uint32_t column) {
  Source& source = *frames_.back().source;
  list_o_words(source);
  const std::size_t here = source.reader->position();
  const auto [start, end] = program_around(here);
  const Source::Line* before = nullptr;
  const auto found = source.line_numbers.find(fmt::format("{:.0f}", number));
  if (found != source.line_numbers.end())
    for (const Source::Line& line : found->second) {
      if (line.start < start || line.start >= end) continue;
      if (line.start >= here) return jump(line.start, line.lines_before);
      if (before == nullptr) before = &line;
    }
  if (before != nullptr) return jump(before->start, before->lines_before);
  reporter_.error(codes::o_word_unmatched, column, fmt::format("this program has no line N{:g}", number));
}

bool Flow::unmatched(const OLine& line, std::uint32_t column) {
  reporter_.error(codes::o_word_unmatched, column,
                  fmt::format("{}{} has no matching start or end; skipped",
                              line.label.starts_with("do") ? "" : "O", line.label));
  return false;
}

/// Jumps to the first branch whose condition is true, otherwise after the end of the if.
void Flow::branch(std::size_t at, const Block& block) {
  Block next_branch;
  const Block* tested = &block;
  while (condition_value(*tested).value_or(0.0) == 0.0) {
    const std::size_t next = o_line(at).branch;
    if (next == at || o_line(next).kind != OKind::else_if) return jump_after(next);
    jump_to(next);
    if (!this->next(next_branch) || !next_branch.o_word) return;
    reporter_.at_line(next_branch.line);
    tested = &next_branch;
    at = next;
  }
}

void Flow::start_repeat(std::size_t at, const Block& block) {
  const double count = std::round(condition_value(block).value_or(0.0));
  if (!(count >= 1.0)) return jump_after(o_line(at).partner);
  std::vector<Repeat>& repeats = frames_.back().repeats;
  std::erase_if(repeats, [&](const Repeat& r) { return r.o_line >= at; });  // of loops left by a jump
  repeats.push_back({at, std::min(count, kMaxRepeats)});
}

void Flow::end_repeat(std::size_t at) {
  const std::size_t start = o_line(at).partner;
  std::vector<Repeat>& repeats = frames_.back().repeats;
  std::erase_if(repeats, [&](const Repeat& r) { return r.o_line > start; });
  if (repeats.empty() || repeats.back().o_line != start) return;
  if (--repeats.back().left >= 1.0) return jump_after(start);
  repeats.pop_back();
}

/// The innermost loop around a line with the label of its O-word.
std::optional<std::size_t> Flow::loop_around(std::size_t at) const {
  for (std::size_t i = at; i-- > 0;) {
    const OLine& line = o_line(i);
    const bool loop =
        line.kind == OKind::loop_while || line.kind == OKind::loop_do || line.kind == OKind::repeat;
    if (loop && line.partner > at && line.label == o_line(at).label) return i;
  }
  return std::nullopt;
}

void Flow::leave_loop(std::size_t at, std::uint32_t column) {
  const std::optional<std::size_t> loop = loop_around(at);
  if (!loop) return void(unmatched(o_line(at), column));
  const std::size_t end = o_line(*loop).partner;
  if (o_line(at).kind == OKind::continue_loop) return jump_to(end);
  std::erase_if(frames_.back().repeats, [&](const Repeat& r) { return r.o_line >= *loop; });
  jump_after(end);
}

// ---- subroutines

/// The label of a call; a computed one is evaluated.
std::optional<std::string> Flow::label_of(const OWord& word, std::uint32_t column) {
  if (word.label.front() != '[' && word.label.front() != '#') return word.label;
  ExpressionReader reader(word.label, parameters_);
  const std::optional<double> value = value_of(reader, column);
  if (!value) return std::nullopt;
  unknown_value_ = unknown_value_ || reader.is_unknown();
  return fmt::format("{:.0f}", *value);
}

void Flow::call(const Block& block) {
  const OWord word = read_o_word(block.o_word->text);
  const std::uint32_t column = block.o_word->column;
  const std::optional<std::string> label = label_of(word, column);
  if (!label) return;
  std::vector<ParameterValue> arguments;
  ExpressionReader reader(word.values, parameters_);
  for (reader.skip_comments(); !reader.at_end(); reader.skip_comments()) {
    const auto offset = static_cast<std::uint32_t>(word.values.data() - block.o_word->text.data());
    const std::optional<double> value = value_of(reader, column + offset);
    if (!value) return;
    arguments.push_back({*value, reader.is_unknown()});
  }
  if (arguments.size() > Parameters::kArguments) {
    reporter_.error(codes::o_word_malformed, column,
                    fmt::format("a call has at most {} arguments; skipped", Parameters::kArguments));
    return;
  }
  if (!enter(*label, 1, column)) return;
  called_.insert(*label);
  parameters_.enter(arguments);
  frames_.back().own_parameters = true;
}

bool Flow::has_sub(int number) {
  std::size_t entry = 0;
  return source_of(std::to_string(number), entry) != nullptr;
}

void Flow::call_macro(int number, std::span<const ParameterValue> arguments, int repeats,
                      std::uint32_t column) {
  if (!enter(std::to_string(number), repeats, column)) return;
  frames_.back().arguments.assign(arguments.begin(), arguments.end());
  parameters_.enter(arguments);
  frames_.back().own_parameters = true;
}

void Flow::call_number(int number, int repeats, std::uint32_t column) {
  enter(std::to_string(number), repeats, column);
}

/// Jumps to the start of a subroutine; the caller passes the arguments.
bool Flow::enter(const std::string& label, int repeats, std::uint32_t column) {
  std::size_t entry = 0;
  Source* source = source_of(label, entry);
  if (source == nullptr) {
    reporter_.error(codes::sub_missing, column,
                    fmt::format("subroutine {} is neither in this program nor in a file next to it", label));
    return false;
  }
  if (frames_.size() > kMaxCallDepth) {
    reporter_.error(codes::calls_too_deep, column,
                    fmt::format("calls are nested deeper than {}; this one is skipped", kMaxCallDepth));
    return false;
  }
  const BlockReader& caller = *frames_.back().source->reader;
  Frame frame;
  frame.source = source;
  frame.return_to = caller.position();
  frame.return_lines = caller.lines();
  frame.repeats_left = repeats - 1;
  frame.entry = entry;
  frames_.push_back(std::move(frame));
  jump_after(entry);
  return true;
}

Flow::Source* Flow::source_of(const std::string& label, std::size_t& entry) {
  for (Source* source : {frames_.back().source, sources_.front().get()}) {
    list_o_words(*source);
    const auto found = source->subs.find(label);
    if (found == source->subs.end()) continue;
    entry = found->second;
    return source;
  }
  Source* source = load(label);
  if (source == nullptr) return nullptr;
  const auto found = source->subs.find(label);
  if (found == source->subs.end()) return nullptr;
  entry = found->second;
  return source;
}

/// The file of a subroutine, loaded once. Names with characters of other folders' paths are refused.
Flow::Source* Flow::load(const std::string& label) {
  std::string name = label;
  if (name.size() > 2 && name.front() == '<') name = name.substr(1, name.size() - 2);
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (!options_.read_file || name.empty() || !std::all_of(name.begin(), name.end(), plain)) return nullptr;
  name += ".ngc";
  for (const auto& known : sources_)
    if (known->name == name) return known.get();
  std::optional<std::string> text = options_.read_file(name);
  if (!text) return nullptr;
  auto source = std::make_unique<Source>();
  source->name = name;
  source->owned = std::move(*text);
  source->reader = std::make_unique<BlockReader>(source->owned, reader_options(name), diagnostics_);
  list_o_words(*source);
  sources_.push_back(std::move(source));
  return sources_.back().get();
}

void Flow::return_with_value(const Block& block) {
  const OWord word = read_o_word(block.o_word->text);
  if (depth() == 0) {
    reporter_.error(codes::o_word_unmatched, block.o_word->column,
                    "return or endsub outside of a subroutine");
    return;
  }
  ExpressionReader reader(word.values, parameters_);
  std::optional<double> value;
  if (!reader.at_end()) value = value_of(reader, block.o_word->column);
  return_from_call();
  parameters_.set_name("_value", {value.value_or(0.0), reader.is_unknown()});
  parameters_.set_name("_value_returned", {value ? 1.0 : 0.0});
}

bool Flow::skip_subprogram() {
  BlockReader& reader = *frames_.back().source->reader;
  const std::string_view text = reader.text();
  std::size_t at = reader.position();
  std::pair<std::size_t, std::uint32_t> last_return{0, 0};
  for (std::uint32_t lines = reader.lines() + 1; at < text.size(); ++lines) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const FlowWord word = flow_word_of(text.substr(at, end - at));
    at = std::min(end + 1, text.size());
    if (word == FlowWord::ends) break;
    if (word == FlowWord::none) continue;
    last_return = {at, lines};  // of several the last one
  }
  if (last_return.first != 0) reader.seek(last_return.first, last_return.second);
  return last_return.first != 0;
}

bool Flow::return_from_call(bool leaves) {
  if (depth() == 0) return false;
  Frame& frame = frames_.back();
  if (!leaves && frame.repeats_left-- > 0) {
    frame.repeats.clear();
    if (frame.own_parameters) {
      parameters_.leave();
      parameters_.enter(frame.arguments);
    }
    jump_after(frame.entry);
    return true;
  }
  const Frame done = std::move(frame);
  if (done.own_parameters) parameters_.leave();
  frames_.pop_back();
  jump(done.return_to, done.return_lines);
  return true;
}

}  // namespace kerf::gcode
