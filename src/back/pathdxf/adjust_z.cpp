// Formulas in the text of a program, replaced by numbers.
#include "back/pathdxf/adjust_z.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>

#include "base/codes/pathdxf.h"
#include "base/formula.h"
#include "base/number.h"

namespace kerf {
namespace {

constexpr Bilingual kUnexpected{"unexpected symbol at column {}", "Unerwartetes Zeichen in Spalte {}"};
constexpr Bilingual kBracket{"'{1}' expected at column {0}", "'{1}' erwartet in Spalte {0}"};
constexpr Bilingual kEnd{"end expected at column {}", "Ende erwartet in Spalte {}"};
constexpr Bilingual kUnknown{"no value for {1} at column {0}", "Kein Wert für {1} in Spalte {0}"};
constexpr Bilingual kNoNumber{"the formula at column {} has no finite value",
                              "Die Formel in Spalte {} hat keinen endlichen Wert"};
constexpr Bilingual kDeep{"the formula is nested too deep at column {}",
                          "Die Formel ist in Spalte {} zu tief geschachtelt"};
constexpr Bilingual kSecond{"only the first formula of this line is evaluated",
                            "Nur die erste Formel dieser Zeile wird ausgewertet"};

const Bilingual& message_of(FormulaFault::Kind kind) {
  switch (kind) {
    case FormulaFault::Kind::unexpected: return kUnexpected;
    case FormulaFault::Kind::bracket_missing: return kBracket;
    case FormulaFault::Kind::unknown_unit:  // has none
    case FormulaFault::Kind::rest: return kEnd;
    case FormulaFault::Kind::unknown_variable: return kUnknown;
    case FormulaFault::Kind::not_finite: return kNoNumber;
    case FormulaFault::Kind::too_deep: break;
  }
  return kDeep;
}

constexpr Bilingual kLong{"the line is too long", "Die Zeile ist zu lang"};
constexpr std::size_t kMaxLine = 10'000;  // bytes, of a line with a formula

bool is_of_number(char c) { return (c >= '0' && c <= '9') || c == '.'; }

/// A number with its formula: [start, open) is the number, [open + 2, close) the formula.
struct Formula {
  std::size_t start = 0, open = 0, close = 0;
};

std::optional<Formula> find_formula(std::string_view line, std::size_t from) {
  for (std::size_t open = line.find("(=", from); open != std::string_view::npos;
       open = line.find("(=", open + 1)) {
    Formula f{open, open, 0};
    while (f.start > from && is_of_number(line[f.start - 1])) --f.start;
    if (f.start == open || line.substr(open + 2, 1) == "=") continue;
    if (f.start > from && line[f.start - 1] == '-') --f.start;
    int depth = 1;
    std::size_t at = open + 1;
    for (; at < line.size() && depth > 0; ++at) depth += line[at] == '(' ? 1 : line[at] == ')' ? -1 : 0;
    if (depth > 0) continue;
    f.close = at - 1;
    return f;
  }
  return std::nullopt;
}

class Adjuster {
 public:
  Adjuster(const std::string& file, const std::map<int, double>& values, Language language,
           Diagnostics& diagnostics)
      : file_(file), values_(values), language_(language), diagnostics_(diagnostics) {}

  std::string run(std::string_view program) {
    for (std::size_t i = 0; i < program.size();) {
      const std::size_t end = std::min(program.find('\n', i), program.size());
      std::string_view line = program.substr(i, end - i);
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      ++line_;
      take(line);
      i = end + 1;
    }
    return std::move(out_);
  }

 private:
  TextLocation at(std::size_t offset) const {
    return {file_, static_cast<std::uint32_t>(line_), static_cast<std::uint32_t>(offset + 1)};
  }
  void take(std::string_view line) {
    const bool is_long = line.size() > kMaxLine;
    if (is_long && line.find("(=") != std::string_view::npos)
      diagnostics_.error(codes::heights_formula, at(0), std::string(kLong.in(language_)));
    const auto f = is_long ? std::nullopt : find_formula(line, 0);
    if (!f) {
      out_ += line;
      out_ += '\n';
      return;
    }
    const std::string_view formula = line.substr(f->open + 2, f->close - f->open - 2);
    FormulaFault fault;
    const auto value = evaluate_formula(
        formula,
        [this](int variable) {
          const auto known = values_.find(variable);
          return known == values_.end() ? std::nullopt : std::optional(known->second);
        },
        fault);
    if (!value)
      diagnostics_.error(
          codes::heights_formula, at(f->open + 2 + fault.offset),
          fmt::format(fmt::runtime(message_of(fault.kind).in(language_)), fault.offset + 1, fault.symbol));
    if (find_formula(line, f->close))
      diagnostics_.warning(codes::heights_formula, at(f->close), std::string(kSecond.in(language_)));
    out_ += line.substr(0, f->start);
    append_fixed(out_, value.value_or(0.0), 3, MinusZero::keep);
    out_ += fmt::format("(=={}){}\n", formula, line.substr(f->close + 1));
  }

  const std::string& file_;
  const std::map<int, double>& values_;
  Language language_;
  Diagnostics& diagnostics_;
  std::size_t line_ = 0;
  std::string out_;
};

/// The number after a letter in a line of G-code without comments, e.g. of X.
std::optional<double> word_of(std::string_view line, char letter) {
  const std::size_t at = line.find(letter);
  if (at == std::string_view::npos) return std::nullopt;
  std::size_t end = at + 1;
  while (end < line.size() && (is_of_number(line[end]) || line[end] == '-')) ++end;
  return parse_number(line.substr(at + 1, end - at - 1));
}

}  // namespace

std::optional<std::string> adjust_z(std::string_view program, const std::string& file,
                                    const std::map<int, double>& values, Language language,
                                    Diagnostics& diagnostics) {
  const std::size_t errors = diagnostics.errors();
  std::string text = Adjuster(file, values, language, diagnostics).run(program);
  return diagnostics.errors() == errors ? std::optional(std::move(text)) : std::nullopt;
}

std::map<int, double> expected_heights(std::string_view program) {
  std::map<int, double> heights;
  for (std::size_t at = program.find("[#"); at != std::string_view::npos; at = program.find("[#", at + 2)) {
    int variable = 0;
    const char* last = program.data() + program.size();
    const auto [end, error] = std::from_chars(program.data() + at + 2, last, variable);
    if (error != std::errc() || end == last || *end != '-') continue;
    const std::size_t start = static_cast<std::size_t>(end - program.data()) + 1;
    const std::size_t close = program.find(']', start);
    if (close == std::string_view::npos) break;
    if (close - start > 40) continue;
    if (const auto height = parse_number(program.substr(start, close - start)))
      heights.try_emplace(variable, *height);
  }
  return heights;
}

std::vector<std::array<double, 2>> probed_positions(std::string_view program) {
  std::vector<std::array<double, 2>> positions;
  std::array<double, 2> at{};
  for (std::size_t i = 0; i < program.size();) {
    const std::size_t end = std::min(program.find('\n', i), program.size());
    std::string_view line = program.substr(i, end - i);
    i = end + 1;
    line = line.substr(0, line.find_first_of("(;"));
    if (const auto x = word_of(line, 'X')) at[0] = *x;
    if (const auto y = word_of(line, 'Y')) at[1] = *y;
    if (line.find("G38.") != std::string_view::npos) positions.push_back(at);
  }
  return positions;
}

}  // namespace kerf
