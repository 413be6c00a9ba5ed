// G-code text as blocks of words with their locations, without any meaning.
//
// The reader fills one block per line in an object of the caller, so that a million lines allocate nothing.
// Numbers are read to the nearest double. Computed values (parameters `#1`, `#<name>`, expressions `[...]`,
// functions) and O-words are recognised and kept as text with their location, not evaluated. Texts are views
// into the program's text, which must outlive the block.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"

namespace kerf::gcode {

enum class ValueKind : std::uint8_t { number, expression };

/// A letter and its value. Letters are upper case; '@', '^' (polar words), '$' (a spindle's number; not first
/// on its line) and '*' (a checksum) count as letters. Lower case: a word after a comma, ",R5" (Fanuc, Haas).
struct Word {
  double value = 0.0;              // of a number; 0 for an expression
  std::uint32_t column = 0;        // of the letter, from 1
  std::uint32_t value_offset = 0;  // start of the value in the block's text
  std::uint32_t value_length = 0;
  char letter = 0;
  ValueKind kind = ValueKind::number;
};

/// A comment without its parentheses or semicolon.
struct Comment {
  std::string_view text;
  std::uint32_t column = 0;  // of the parenthesis or semicolon
};

/// Text that is to be computed: an assignment `#1 = [2 + 3]`, an O-word with all that follows it, or a
/// statement of Fanuc's macros such as `IF [#1 GT 3] GOTO 20`, which is kept as an O-word.
struct Computation {
  std::string_view text;
  std::uint32_t column = 0;
};

/// One line. A faulty one (an error was reported) has no words; its comments up to the fault are kept.
struct Block {
  std::uint32_t line = 0;  // from 1
  std::string_view text;   // the line without its end
  bool faulty = false;
  bool optional = false;          // starts with the block delete character '/'
  bool percent = false;           // a line that starts with '%'
  bool sender = false;            // a command of a sender: $H, $110=500, or one of ?, ! and ~
  bool computed = false;          // has words or assignments whose value is an expression
  std::string_view command;       // of BlockReaderOptions::Commands::words, or of a sender
  std::optional<double> number;   // N word
  std::vector<Word> words;        // in order, N left out
  std::vector<Comment> comments;  // in order
  std::vector<Computation> assignments;
  std::optional<Computation> o_word;

  std::string_view value_text(const Word& word) const {
    return text.substr(word.value_offset, word.value_length);
  }
};

struct BlockReaderOptions {
  std::string file_name = "<text>";
  std::size_t max_line_bytes = 1'000'000;
  bool strict = false;  // unusual comments are errors
  /// Printers have commands that are words ("EXCLUDE_OBJECT NAME=a", "M117 ready"); they are kept as text.
  enum class Commands : std::uint8_t { letters, words } commands = Commands::letters;
  bool macros = false;  // WHILE, DO, END, IF and GOTO at the start of a line are statements (Fanuc, Haas)
};

/// Whether a text starts with a statement of Fanuc's macros.
bool starts_macro_statement(std::string_view text);

class BlockReader {
 public:
  BlockReader(std::string_view text, BlockReaderOptions options, Diagnostics& diagnostics);

  /// Reads the next line into `block`; false at the end of the text.
  bool next(Block& block);
  /// The next line's text, which next() would read; empty at the text's end and for an empty line.
  std::string_view peek();
  /// Skips the line returned by peek().
  void skip();
  /// Bytes of the text already read: the start of the next line.
  std::size_t position() const { return position_; }
  /// Continues at the start of a line, given by an earlier position() after `lines` lines.
  void seek(std::size_t position, std::uint32_t lines);
  std::uint32_t lines() const { return line_; }
  std::string_view text() const { return text_; }
  /// The text after the program's end need not be G-code: faults of its lines are no longer reported.
  void note_program_end() { ended_ = true; }

 private:
  std::size_t line_end();
  void go_after(std::size_t end);
  void find_line_end();
  void read_line(Block& block);
  bool read_prefix(Block& block);
  bool is_realtime_command() const;
  bool is_command() const;
  bool is_flag(const Block& block) const;
  bool read_item(Block& block);
  bool read_word(Block& block);
  bool read_computed_value(Block& block, Word& word);
  bool read_assignment(Block& block);
  bool read_o_word(Block& block);
  bool keep_o_word(Block& block);
  void read_comment(Block& block);
  const char* comment_end(const Block& block);
  void skip_space();
  std::uint32_t column_of(const char* at) const { return static_cast<std::uint32_t>(at - line_start_) + 1; }
  bool fault(Block& block, Code code, const char* at, std::string message, std::string_view hint = {});
  void unusual(const Block& block, Code code, const char* at, std::string message);

  std::string_view text_;
  BlockReaderOptions options_;
  Diagnostics& diagnostics_;
  std::size_t position_ = 0;
  std::size_t next_line_feed_ = 0;  // first '\n' at or after position_, found once
  std::size_t next_return_ = 0;     // first '\r' before that, otherwise the same
  bool has_returns_ = false;
  bool ended_ = false;  // note_program_end()
  std::uint32_t line_ = 0;
  bool unbalanced_ = false;  // a comment of this line opens more parentheses than it closes
  const char* line_start_ = nullptr;
  const char* p_ = nullptr;  // the next character of the line
  const char* end_ = nullptr;
};

}  // namespace kerf::gcode
