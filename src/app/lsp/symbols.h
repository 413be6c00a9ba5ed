// Definitions, uses and the outline of a text, by its words: comments and texts in quotes are left out.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/lsp/text_positions.h"

namespace kerf::app::lsp {

enum class Script : std::uint8_t { gcode, gcmc, scad, job, other };
/// By the ending of a file's name.
Script script_of(std::string_view path);

/// Kinds of symbols, with the numbers of the protocol.
enum class SymbolKind : std::uint8_t { module = 2, function = 12, variable = 13, object = 19, event = 24 };

struct Symbol {
  std::string name;
  SymbolKind kind = SymbolKind::variable;
  Span at;                // of the name
  std::size_t last_line;  // of what it names
};

/// What a text defines, in its order: functions, modules and variables of gcmc and OpenSCAD outside of
/// blocks, subroutines and tool changes of G-code, operations and tables of jobs.
std::vector<Symbol> outline_of(Script script, std::string_view text);

/// The word at a location: "depth", "#<depth>", "O100", "P100" after M98; empty where there is none.
std::string word_at(Script script, std::string_view line, std::size_t byte);

/// Files that a text includes, as it names them.
std::vector<std::string> includes_of(Script script, std::string_view text);

struct Definition {
  std::string file;
  Span at;
};
/// Where the word at a location is defined: in the text, in what it includes (read by `read_file`, nothing if
/// there is no such file), or, of G-code, in the file of a subroutine beside it.
std::optional<Definition> definition_of(
    Script script, const std::string& path, std::string_view text, std::size_t line, std::size_t byte,
    const std::function<std::optional<std::string>(const std::string&)>& read_file);

}  // namespace kerf::app::lsp
