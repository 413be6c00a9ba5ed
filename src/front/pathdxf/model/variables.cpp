// The values of a path's variables.
#include "base/codes/pathdxf.h"
#include "front/pathdxf/model/library.h"

namespace kerf::pathdxf {
namespace {

constexpr Bilingual kMissingValues{"Missing values for variables {}", "Fehlende Werte für Variablen {}"};
constexpr Bilingual kMissingDefinitions{"Missing definitions for variables {}",
                                        "Fehlende Definitionen für Variablen {}"};
constexpr Bilingual kNotPermitted{"Value '{}' of variable {} does not match definition '{}'",
                                  "Wert '{}' der Variablen {} entspricht nicht der Definition '{}'"};
constexpr Bilingual kBadDefinition{
    "Definition '{}' of variable {} must be a comma-separated list, or characters after ?, or a range "
    "from~to",
    "Definition '{}' der Variablen {} muss eine Liste mit Kommas, Zeichen nach ? oder ein Bereich von~bis "
    "sein"};
constexpr Bilingual kForm{"'{}' must have the form X=VALUE, with a variable X of one character",
                          "'{}' muss die Form X=WERT haben, mit einer Variablen X aus einem Zeichen"};
constexpr Bilingual kExample{
    "Path {} is not embedded; its variables have values of their definitions: {}",
    "Pfad {} ist nicht eingebettet; seine Variablen haben Werte aus ihren Definitionen: {}"};
constexpr Bilingual kExampleHint{"specify others with --define X=VALUE",
                                 "Andere Werte mit --define X=WERT angeben"};

std::vector<Parameter> definitions_of(const Library::Found& found) {
  const ParameterText* text = found.drawing->text_of(*found.path->start);
  return text == nullptr ? std::vector<Parameter>() : text->variables;
}

/// The values that the options give; invalid ones are reported.
Variables values_of_options(const PathdxfOptions& options, const Origin& where, Report& report) {
  Variables values;
  for (const std::string& text : options.variables) {
    const std::size_t name = first_character(text);
    if (name >= text.size() || text[name] != '=' || text[0] == '=')
      report.error(codes::pathdxf_variable, where, kForm, text);
    else
      values[text.substr(0, name)] = text.substr(name + 1);
  }
  return values;
}

}  // namespace

void check_values(const Variables& values, const Library::Found& found, const Origin& where, Report& report) {
  std::string missing, undefined;
  Variables definitions;
  for (const Parameter& p : definitions_of(found)) definitions[p.key] = p.value;
  for (const auto& [name, definition] : definitions) {
    const auto parsed = VariableDefinition::parse(definition);
    const auto value = values.find(name);
    if (!parsed)
      report.error(codes::pathdxf_variable, found.drawing->text_of(*found.path->start)->where, kBadDefinition,
                   definition, name);
    else if (value == values.end())
      missing += name;
    else if (!parsed->permits(value->second))
      report.error(codes::pathdxf_variable, where, kNotPermitted, value->second, name, definition);
  }
  for (const auto& [name, value] : values)
    if (definitions.find(name) == definitions.end()) undefined += name;
  if (!missing.empty()) report.error(codes::pathdxf_variable, where, kMissingValues, missing);
  if (!undefined.empty()) report.error(codes::pathdxf_variable, where, kMissingDefinitions, undefined);
}

Variables example_values(const Library::Found& found) {
  Variables values;
  std::size_t k = 0;
  for (const Parameter& p : definitions_of(found)) {
    if (const auto definition = VariableDefinition::parse(p.value)) values[p.key] = definition->example(k);
    ++k;
  }
  return values;
}

Variables main_values(const Library::Found& found, const PathdxfOptions& options, Report& report) {
  const Origin where = found.drawing->origin(*found.path->start);
  Variables values = values_of_options(options, where, report);
  std::vector<std::string> chosen;
  if (options.free_variables == FreeVariables::example)
    for (const auto& [name, value] : example_values(found))
      if (values.try_emplace(name, value).second) chosen.push_back(name + "=" + value);
  if (!values.empty()) check_values(values, found, where, report);
  if (!chosen.empty()) {
    report.note(codes::pathdxf_assumed, where, kExample, found.path->name, joined(chosen, ", "));
    report.hint(kExampleHint);
  }
  return values;
}

}  // namespace kerf::pathdxf
