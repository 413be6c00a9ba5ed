// Restrictions of sub-paths.
#include "front/pathdxf/text/restriction.h"

#include "base/codes/pathdxf.h"

namespace kerf::pathdxf {
namespace {

constexpr Bilingual kForm{"{}: '{}' must have the form PARENT:CHILD",
                          "{}: '{}' muss die Form PFAD:UNTERPFAD haben"};
constexpr Bilingual kInvalid{"Invalid expression for {}: {}", "Ungültiger Ausdruck für {}: {}"};

}  // namespace

std::optional<Restriction> Restriction::parse(const std::string& text, std::string_view option,
                                              const Origin& where, Report& report) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) {
    report.error(codes::pathdxf_restriction, where, kForm, option, text);
    return std::nullopt;
  }
  std::string problem;
  auto parent = Pattern::compile(text.substr(0, colon), LetterCase::distinct, problem);
  auto child =
      parent ? Pattern::compile(text.substr(colon + 1), LetterCase::distinct, problem) : std::nullopt;
  if (child) return Restriction(std::move(*parent), std::move(*child), text);
  report.error(codes::pathdxf_pattern, where, kInvalid, option, problem);
  return std::nullopt;
}

std::optional<std::vector<Restriction>> restrictions_of(const PathdxfOptions& options, Report& report) {
  std::vector<Restriction> list;
  for (const std::string& text : options.restrictions)
    if (auto restriction = Restriction::parse(text, "/e", {}, report))
      list.push_back(std::move(*restriction));
  return list.size() == options.restrictions.size() ? std::optional(std::move(list)) : std::nullopt;
}

}  // namespace kerf::pathdxf
