// Manual pages in the macros of man(7).
#include <algorithm>
#include <fmt/format.h>
#include <string_view>

#include "app/help/help_texts.h"

namespace kerf::app {
namespace {

/// Text as roff prints it: backslashes and hyphens escaped, no line that starts with a dot or an apostrophe.
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool at_start = out.empty() || out.back() == '\n';
    if (at_start && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

/// "kerf-tools-show"
std::string page_name(const std::string& command) {
  std::string name = command.empty() ? "kerf" : "kerf-" + command;
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string full_command(const std::string& command) { return command.empty() ? "kerf" : "kerf " + command; }

std::string synopsis(const CommandDescription& command) {
  std::string text = fmt::format("\\fB{}\\fR", roff(full_command(command.name)));
  if (!command.commands.empty()) return text + " \\fICOMMAND\\fR ...\n";
  text += " [\\fIOPTION\\fR]...";
  for (const OptionDescription& option : command.options) {
    if (!option.positional) continue;
    const std::string name =
        fmt::format("\\fI{}\\fR{}", roff(option.names.front()), option.repeated ? "..." : "");
    text += option.required ? " " + name : " [" + name + "]";
  }
  return text + "\n";
}

std::string option_entry(const OptionDescription& option) {
  std::string names;
  for (const std::string& name : option.names)
    names +=
        fmt::format("{}\\f{}{}\\fR", names.empty() ? "" : ", ", option.positional ? 'I' : 'B', roff(name));
  if (!option.value.empty()) names += fmt::format(" \\fI{}\\fR", roff(option.value));
  std::string summary = option.summary;
  const bool listed = !option.choices.empty() && summary.find(option.choices.front()) != std::string::npos;
  if (!option.choices.empty() && !listed) {
    summary += ": ";
    for (const std::string& choice : option.choices)
      summary += (choice == option.choices.front() ? "" : ", ") + choice;
  }
  return fmt::format(".TP\n{}\n{}\n", names, roff(summary));
}

/// The footer: indented lines as they are, the others as running text; "Examples:" is a heading.
std::string footer_text(std::string_view footer) {
  std::string out;
  bool as_is = false;
  const auto set_as_is = [&](bool wanted) {
    if (wanted != as_is) out += wanted ? ".PP\n.nf\n" : ".fi\n.PP\n";
    as_is = wanted;
  };
  while (!footer.empty()) {
    const std::size_t end = std::min(footer.find('\n'), footer.size());
    const std::string_view line = footer.substr(0, end);
    footer.remove_prefix(std::min(end + 1, footer.size()));
    if (line.empty()) {
      set_as_is(false);
      if (!out.empty() && !out.ends_with(".PP\n")) out += ".PP\n";
    } else if (line == "Examples:") {
      set_as_is(false);
      if (out.ends_with(".PP\n")) out.resize(out.size() - 4);
      out += ".SH EXAMPLES\n";
    } else {
      set_as_is(line.front() == ' ');
      out += roff(line) + "\n";
    }
  }
  set_as_is(false);
  while (out.ends_with(".PP\n")) out.resize(out.size() - 4);
  return out;
}

/// A title per page, so that each text has one.
std::string notes(const std::string& footer) {
  const std::string text = footer_text(footer);
  if (text.empty()) return text;
  return text.starts_with(".SH") || text.starts_with(".PP\n.SH") ? text : ".SH NOTES\n" + text;
}

std::string page(const CommandDescription& root, const CommandDescription& command,
                 const std::string& version) {
  std::string title = page_name(command.name);
  std::string text =
      fmt::format(".\\\" Made by kerf man.\n.TH {} 1 \"\" \"Kerf {}\" \"Kerf\"\n", roff(title), version);
  text += fmt::format(".SH NAME\n{} \\- {}\n", roff(title), roff(command.summary));
  text += ".SH SYNOPSIS\n" + synopsis(command);
  std::string arguments, options, commands;
  for (const OptionDescription& option : command.options)
    (option.positional ? arguments : options) += option_entry(option);
  for (const CommandDescription& below : command.commands)
    commands += fmt::format(".TP\n\\fB{}\\fR\n{}; see \\fB{}\\fR(1)\n", roff(full_command(below.name)),
                            roff(below.summary), roff(page_name(below.name)));
  if (!commands.empty()) text += ".SH COMMANDS\n" + commands;
  if (!arguments.empty()) text += ".SH ARGUMENTS\n" + arguments;
  if (!options.empty()) text += ".SH OPTIONS\n" + options;
  text += notes(command.footer);
  text += ".SH \"SEE ALSO\"\n";
  if (!command.name.empty()) text += "\\fBkerf\\fR(1)";
  for (const CommandDescription& other : root.commands)
    if (command.name.empty())
      text += fmt::format("{}\\fB{}\\fR(1)", &other == root.commands.data() ? "" : ",\n",
                          roff(page_name(other.name)));
  return text + ".\n.PP\nThe manual is in the folder docs/manual of Kerf's documents.\n";
}

void add_pages(const CommandDescription& root, const CommandDescription& command, const std::string& version,
               std::vector<std::pair<std::string, std::string>>& pages) {
  pages.emplace_back(page_name(command.name) + ".1", page(root, command, version));
  for (const CommandDescription& below : command.commands) add_pages(root, below, version, pages);
}

void add_commands(const CommandDescription& command, std::vector<const CommandDescription*>& out) {
  out.push_back(&command);
  for (const CommandDescription& below : command.commands) add_commands(below, out);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> manual_pages(const CommandDescription& root,
                                                              const std::string& version) {
  std::vector<std::pair<std::string, std::string>> pages;
  add_pages(root, root, version, pages);
  return pages;
}

std::vector<const CommandDescription*> all_commands(const CommandDescription& root) {
  std::vector<const CommandDescription*> out;
  add_commands(root, out);
  return out;
}

std::string last_word(const std::string& name) {
  const std::size_t blank = name.rfind(' ');
  return blank == std::string::npos ? name : name.substr(blank + 1);
}

}  // namespace kerf::app
