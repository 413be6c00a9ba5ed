// Post files: TOML to profiles, errors with line and column; the built-in profiles. One table of keys is used
// for reading and for messages.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <fmt/format.h>
#include <functional>

#include "base/codes/gcode.h"
#include "base/guess.h"
#include "base/names.h"
#include "base/number.h"
#include "base/toml.h"
#include "embedded_post_files.h"

#include "kerf/base/limits.h"
#include "kerf/program/post.h"

namespace kerf {
namespace {

constexpr int kVariableDecimals = 6;

/// Sets a value; false if it has the wrong type or is out of range.
using Take = std::function<bool(const toml::node&, PostProfile&)>;

struct Key {
  std::string_view section;  // empty: the root
  std::string_view name;
  std::string_view expected;
  Take take;
};

std::optional<double> number_of(const toml::node& node) {
  const auto value = node.is_number() ? node.value<double>() : std::nullopt;
  return value && std::isfinite(*value) ? value : std::nullopt;
}

Take text(std::string PostProfile::*member) {
  return [member](const toml::node& node, PostProfile& profile) {
    const auto value = node.value_exact<std::string>();
    if (value) profile.*member = *value;
    return value.has_value();
  };
}

/// The struct of a member: the profile itself, or a part of it.
PostProfile& part_of(PostProfile& profile, const PostProfile*) { return profile; }
ExtruderWords& part_of(PostProfile& profile, const ExtruderWords*) { return profile.extruder; }
Decimals& part_of(PostProfile& profile, const Decimals*) { return profile.decimals; }
DriveWords& part_of(PostProfile& profile, const DriveWords*) { return profile.drive; }
ProgramForm& part_of(PostProfile& profile, const ProgramForm*) { return profile.form; }

template <class Part>
Take truth(bool Part::*member) {
  return [member](const toml::node& node, PostProfile& profile) {
    const auto value = node.value_exact<bool>();
    if (value) part_of(profile, static_cast<const Part*>(nullptr)).*member = *value;
    return value.has_value();
  };
}

template <class Integer, class Part>
Take whole(Integer Part::*member, std::int64_t low, std::int64_t high) {
  return [=](const toml::node& node, PostProfile& profile) {
    const auto value = node.value_exact<std::int64_t>();
    if (!value || *value < low || *value > high) return false;
    part_of(profile, static_cast<const Part*>(nullptr)).*member = static_cast<Integer>(*value);
    return true;
  };
}

template <class Quantity, class Part>
Take quantity(Quantity Part::*member, Quantity (*make)(double), double low, double high) {
  return [=](const toml::node& node, PostProfile& profile) {
    const auto value = number_of(node);
    if (!value || *value < low || *value > high) return false;
    part_of(profile, static_cast<const Part*>(nullptr)).*member = make(*value);
    return true;
  };
}

template <class Enum>
using Names = std::vector<std::pair<std::string_view, Enum>>;

template <class Enum, class Part>
Take choice(Enum Part::*member, Names<Enum> names) {
  return [member, names](const toml::node& node, PostProfile& profile) {
    const auto value = node.value_exact<std::string_view>();
    for (const auto& [name, meaning] : names) {
      if (!value || *value != name) continue;
      part_of(profile, static_cast<const Part*>(nullptr)).*member = meaning;
      return true;
    }
    return false;
  };
}

Take codes(std::vector<int> PostProfile::*member) {
  return [member](const toml::node& node, PostProfile& profile) {
    const toml::array* list = node.as_array();
    if (list == nullptr) return false;
    std::vector<int> tenths;
    for (const toml::node& element : *list) {
      const auto value = number_of(element);
      if (!value || *value < 0 || *value >= 1000) return false;
      tenths.push_back(static_cast<int>(std::lround(*value * 10.0)));
    }
    profile.*member = std::move(tenths);
    return true;
  };
}

Take lines(std::vector<std::string> PostProfile::*member) {
  return [member](const toml::node& node, PostProfile& profile) {
    const toml::array* list = node.as_array();
    if (list == nullptr || list->size() > limits::kMaxTemplateLines) return false;
    std::vector<std::string> texts;
    for (const toml::node& element : *list) {
      auto value = element.value_exact<std::string>();
      if (!value || value->find_first_of("\r\n") != std::string::npos) return false;
      texts.push_back(std::move(*value));
    }
    profile.*member = std::move(texts);
    return true;
  };
}

bool take_planes(const toml::node& node, PostProfile& profile) {
  const toml::array* list = node.as_array();
  if (list == nullptr) return false;
  profile.arc_planes.clear();
  for (const toml::node& element : *list) {
    const auto name = element.value_exact<std::string_view>();
    if (!name || (*name != "XY" && *name != "XZ" && *name != "YZ")) return false;
    profile.arc_planes.push_back(*name == "XY" ? Plane::xy : *name == "XZ" ? Plane::xz : Plane::yz);
  }
  return true;
}

bool take_letters(const toml::node& node, PostProfile& profile) {
  const auto value = node.value_exact<std::string>();
  const auto is_letter = [](char c) { return c >= 'A' && c <= 'Z'; };
  if (!value || !std::all_of(value->begin(), value->end(), is_letter)) return false;
  profile.letters = *value;
  return true;
}

using P = PostProfile;

std::vector<Key> keys_of_words() {
  return {
      {"", "name", "a text", text(&P::name)},
      {"", "title", "a text", text(&P::title)},
      {"", "dialect", "a text", text(&P::dialect)},
      {"", "file_ending", "a text such as \".nc\"", text(&P::file_ending)},
      {"words", "letters", "capital letters in one text", take_letters},
      {"words", "g", "a list of numbers", codes(&P::g_codes)},
      {"words", "m", "a list of numbers", codes(&P::m_codes)},
      {"words", "homing", "the number of a G code",
       [](const toml::node& node, PostProfile& profile) {
         const auto value = number_of(node);
         const bool valid = value && *value > 0.0 && *value < 100.0;
         if (valid) profile.homing = static_cast<int>(std::lround(*value * 10.0));
         return valid;
       }},
      {"words", "full_speed", "rpm from 1 to 1000000",
       quantity<SpindleSpeed>(&DriveWords::full_speed, rpm, 1, 1e6)},
      {"words", "surface_limit", "true or false", truth(&DriveWords::surface_limit)},
      {"words", "drives", "\"spindle\" or \"beam\"",
       choice(&DriveWords::kind, Names<Drive>{{"spindle", Drive::spindle}, {"beam", Drive::beam}})},
      {"words", "highest_tool", "an integer", whole(&P::highest_tool, 0, 99'999'999)},
      {"words", "highest_line_number", "an integer", whole(&P::highest_line_number, 0, 999'999'999)},
      {"words", "percent_lines", "true or false", truth(&ProgramForm::percent_lines)},
      {"words", "blend_tolerance", "true or false", truth(&ProgramForm::blend_tolerance)},
      {"words", "program_numbers", "true or false", truth(&ProgramForm::program_numbers)},
      {"words", "parameters", "true or false", truth(&ProgramForm::parameters)},
      {"words", "commands", "a list of words", lines(&P::commands)},
      {"line", "longest", "an integer from 20", whole(&P::longest_line, 20, 1'000'000)},
      {"line", "syntax", "\"words\" or \"commands\"",
       choice(&P::syntax,
              Names<LineSyntax>{{"words", LineSyntax::words}, {"commands", LineSyntax::commands}})},
      {"line", "measure", "\"bytes\" or \"significant\"",
       choice(&P::line_measure,
              Names<LineMeasure>{{"bytes", LineMeasure::bytes}, {"significant", LineMeasure::significant}})},
      {"line", "comments", "\"brackets\", \"semicolon\" or \"none\"",
       choice(&P::comments, Names<CommentStyle>{{"brackets", CommentStyle::brackets},
                                                {"semicolon", CommentStyle::semicolon},
                                                {"none", CommentStyle::none}})},
      {"line", "capitals", "true or false", truth(&ProgramForm::capitals)},
      {"line", "comment_forbidden", "a text", text(&P::comment_forbidden)},
      {"line", "end", "\"lf\" or \"crlf\"",
       choice(&P::line_end, Names<LineEnd>{{"lf", LineEnd::lf}, {"crlf", LineEnd::crlf}})},
      {"line", "number_step", "an integer, 0 for no line numbers", whole(&P::line_number_step, 0, 1000)},
      {"line", "spacing", "\"blank\" or \"none\"",
       choice(&P::spacing, Names<WordSpacing>{{"blank", WordSpacing::blank}, {"none", WordSpacing::none}})},
  };
}

std::vector<Key> keys_of_numbers() {
  const Names<Repeat> repeats{{"when_changed", Repeat::when_changed}, {"always", Repeat::always}};
  return {
      {"numbers", "unit", "\"mm\" or \"inch\"",
       choice(&P::unit, Names<LengthUnit>{{"mm", LengthUnit::mm}, {"inch", LengthUnit::inch}})},
      {"numbers", "mm", "decimals from 3 to 6", whole(&Decimals::mm, 3, 6)},
      {"numbers", "inch", "decimals from 4 to 7", whole(&Decimals::inch, 4, 7)},
      {"numbers", "degrees", "decimals from 2 to 6", whole(&Decimals::degrees, 2, 6)},
      {"numbers", "feed", "decimals from 0 to 6", whole(&Decimals::feed, 0, 6)},
      {"numbers", "speed", "decimals from 0 to 6", whole(&Decimals::speed, 0, 6)},
      {"numbers", "turning_feed", "\"per_minute\" or \"inverse_time\"",
       choice(&ProgramForm::turning_feed, Names<TurningFeed>{{"per_minute", TurningFeed::per_minute},
                                                             {"inverse_time", TurningFeed::inverse_time}})},
      {"numbers", "zeros", "\"dropped\", \"kept\" or \"point\"",
       choice(&P::zeros,
              Names<Zeros>{{"dropped", Zeros::dropped}, {"kept", Zeros::kept}, {"point", Zeros::point}})},
      {"repeat", "motion", "\"when_changed\" or \"always\"", choice(&P::motion, repeats)},
      {"repeat", "axes", "\"when_changed\" or \"always\"", choice(&P::axes, repeats)},
      {"repeat", "feed", "\"when_changed\" or \"always\"", choice(&P::feed, repeats)},
      {"arcs", "policy", "\"centre\" or \"chords\"",
       choice(&P::arcs, Names<ArcPolicy>{{"centre", ArcPolicy::centre}, {"chords", ArcPolicy::chords}})},
      {"arcs", "planes", "a list of \"XY\", \"XZ\" and \"YZ\"", take_planes},
      {"arcs", "largest_radius", "mm from 1", quantity<Length>(&P::largest_radius, mm, 1, 1e7)},
      {"arcs", "shortest", "mm from 0.001 to 10", quantity<Length>(&P::shortest_arc, mm, 0.001, 10)},
      {"arcs", "chord", "mm from 0.0001 to 1", quantity<Length>(&P::chord, mm, 0.0001, 1)},
  };
}

std::vector<Key> keys_of_policies() {
  return {
      {"tool_change", "policy", "\"command\", \"pause\", \"files\" or \"ignore\"",
       choice(&P::tool_change, Names<ToolChangePolicy>{{"command", ToolChangePolicy::command},
                                                       {"pause", ToolChangePolicy::pause},
                                                       {"files", ToolChangePolicy::files},
                                                       {"ignore", ToolChangePolicy::ignore}})},
      {"tool_change", "command", "a list of lines", lines(&P::change_lines)},
      {"tool_change", "length", "a list of lines", lines(&P::length_lines)},
      {"tool_change", "pause", "a list of lines", lines(&P::pause_lines)},
      {"tool_change", "extruder", "a list of lines", lines(&P::extruder_lines)},
      {"dwell", "unit", "\"seconds\" or \"milliseconds\"",
       choice(&P::dwell_unit,
              Names<DwellUnit>{{"seconds", DwellUnit::seconds}, {"milliseconds", DwellUnit::milliseconds}})},
      {"dwell", "after_spindle_start", "seconds up to 60",
       quantity<Duration>(&P::spindle_dwell, seconds, 0, 60)},
      {"printer", "filament", "mm from 0.1 to 10", quantity<Length>(&P::filament, mm, 0.1, 10)},
      {"printer", "extruder", "\"relative\" or \"absolute\"",
       choice(&ExtruderWords::mode, Names<ExtruderMode>{{"relative", ExtruderMode::relative},
                                                        {"absolute", ExtruderMode::absolute}})},
      {"printer", "extruder_unit", "\"length\" or \"volume\"",
       choice(&ExtruderWords::unit,
              Names<ExtruderUnit>{{"length", ExtruderUnit::length}, {"volume", ExtruderUnit::volume}})},
      {"printer", "retraction", "\"firmware\" or \"extruder\"",
       choice(&ExtruderWords::retraction, Names<RetractionPolicy>{{"firmware", RetractionPolicy::firmware},
                                                                  {"extruder", RetractionPolicy::extruder}})},
      {"printer", "retract", "mm from 0 to 100", quantity<Length>(&ExtruderWords::retract, mm, 0, 100)},
      {"printer", "retract_speed", "mm/min from 1 to 100000",
       quantity<Feed>(&ExtruderWords::retract_speed, mm_per_min, 1, 1e5)},
      {"printer", "fan_full", "a number from 1",
       [](const toml::node& node, PostProfile& profile) {
         const auto value = number_of(node);
         if (value && *value >= 1.0 && *value <= 1e5) profile.fan_full = *value;
         return value && *value >= 1.0 && *value <= 1e5;
       }},
      {"printer", "bead_comments", "\"none\" or \"slicer\"",
       choice(&P::bead_comments,
              Names<BeadComments>{{"none", BeadComments::none}, {"slicer", BeadComments::slicer}})},
      {"printer", "limits", "\"none\", \"marlin\", \"reprap\" or \"klipper\"",
       choice(&P::limits, Names<LimitCommands>{{"none", LimitCommands::none},
                                               {"marlin", LimitCommands::marlin},
                                               {"reprap", LimitCommands::reprap},
                                               {"klipper", LimitCommands::klipper}})},
      {"templates", "header", "a list of lines", lines(&P::header)},
      {"templates", "section", "a list of lines", lines(&P::section)},
      {"templates", "footer", "a list of lines", lines(&P::footer)},
  };
}

const std::vector<Key>& all_keys() {
  static const std::vector<Key> keys = [] {
    std::vector<Key> all = keys_of_words();
    for (auto&& more : {keys_of_numbers(), keys_of_policies()})
      all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return keys;
}

/// A post by its name, as the base of another; null if there is none.
using FindPost = std::function<const PostProfile*(std::string_view)>;

class ProfileReader {
 public:
  ProfileReader(std::string_view file_name, Diagnostics& diagnostics)
      : file_(file_name), diagnostics_(diagnostics) {}

  std::optional<PostProfile> read(std::string_view text, const FindPost& find);

 private:
  Origin location(const toml::source_position& at) const { return TextLocation{file_, at.line, at.column}; }
  Origin location(const toml::node& node) const { return location(node.source().begin); }
  void read_table(std::string_view section, const toml::table& table);
  void read_variables(const toml::table& table);
  void read_key(std::string_view section, const toml::key& key, const toml::node& node);
  bool inherit(const toml::node& base, const FindPost& find);

  std::string file_;
  Diagnostics& diagnostics_;
  PostProfile profile_;
};

void ProfileReader::read_key(std::string_view section, const toml::key& key, const toml::node& node) {
  std::vector<std::string> known;
  for (const Key& k : all_keys()) {
    if (k.section != section) continue;
    known.emplace_back(k.name);
    if (k.name != key.str()) continue;
    if (!k.take(node, profile_))
      diagnostics_.error(codes::post_value_bad, location(node),
                         fmt::format("{} must be {}", std::string(k.name), std::string(k.expected)));
    return;
  }
  Diagnostic& d =
      diagnostics_.error(codes::post_key_unknown, location(key.source().begin),
                         fmt::format("unknown key \"{}\" of a post", std::string(key.str().substr(0, 60))));
  d.hint = guess(key.str(), known);
}

void ProfileReader::read_table(std::string_view section, const toml::table& table) {
  for (const auto& [key, node] : table) {
    const toml::table* inner = node.as_table();
    const auto belongs = [&k = key](const Key& known) { return known.section == k.str(); };
    if (section.empty() && inner != nullptr && key.str() == "variables")
      read_variables(*inner);
    else if (section.empty() && inner != nullptr &&
             std::any_of(all_keys().begin(), all_keys().end(), belongs))
      read_table(key.str(), *inner);
    else if (!section.empty() || key.str() != "base")
      read_key(section, key, node);
  }
}

/// Variables of templates: texts, numbers or truth values under any name.
void ProfileReader::read_variables(const toml::table& table) {
  for (const auto& [key, node] : table) {
    const auto number = number_of(node);
    const auto truth = node.value_exact<bool>();
    auto value = node.value_exact<std::string>();
    if (number) value = number_text(*number, kVariableDecimals);
    if (truth) value = *truth ? "true" : "false";
    if (!value || profile_.variables.size() >= limits::kMaxTemplateLines)
      diagnostics_.error(
          codes::post_value_bad, location(node),
          fmt::format("the variable {} must be a text, a number, true or false", clipped(key.str(), 60)));
    else
      profile_.variables[std::string(key.str())] = *value;
  }
}

bool ProfileReader::inherit(const toml::node& base, const FindPost& find) {
  const auto name = base.value_exact<std::string_view>();
  const PostProfile* profile = name ? find(*name) : nullptr;
  if (profile == nullptr) {
    diagnostics_.error(codes::post_unknown, location(base), "base must be the name of a built-in post");
    return false;
  }
  profile_ = *profile;
  if (profile_.dialect.empty()) profile_.dialect = profile_.name;
  return true;
}

std::optional<PostProfile> ProfileReader::read(std::string_view text, const FindPost& find) {
  const std::size_t errors_before = diagnostics_.errors();
  if (text.size() > limits::kMaxProfileBytes) {
    diagnostics_.error(codes::post_file_syntax, TextLocation{file_, 0, 0},
                       fmt::format("a post file is limited to {} bytes", limits::kMaxProfileBytes));
    return std::nullopt;
  }
  const toml::parse_result parsed = toml::parse(text, file_);
  if (!parsed) {
    diagnostics_.error(codes::post_file_syntax, location(parsed.error().source().begin),
                       std::string(parsed.error().description()));
    return std::nullopt;
  }
  const toml::table& root = parsed.table();
  if (const toml::node* base = root.get("base"))
    if (!inherit(*base, find)) return std::nullopt;
  read_table("", root);
  if (profile_.name.empty() && diagnostics_.errors() == errors_before)
    diagnostics_.error(codes::post_value_bad, TextLocation{file_, 0, 0},
                       "a post needs a name, such as name = \"mill\"");
  if (diagnostics_.errors() != errors_before) return std::nullopt;
  return std::move(profile_);
}

}  // namespace

bool PostProfile::has_g(int tenths) const {
  return std::find(g_codes.begin(), g_codes.end(), tenths) != g_codes.end();
}

bool PostProfile::has_m(int tenths) const {
  return std::find(m_codes.begin(), m_codes.end(), tenths) != m_codes.end();
}

namespace {

const PostProfile* find_in(const std::vector<PostProfile>& posts, std::string_view name) {
  const std::string folded = fold_name(name);
  for (const PostProfile& profile : posts)
    if (fold_name(profile.name) == folded) return &profile;
  return nullptr;
}

/// Built-in posts whose base is not in `posts` yet stay in `files`.
void read_built_in_posts(std::vector<const embedded::File*>& files, std::vector<PostProfile>& posts) {
  const std::size_t before = posts.size();
  std::vector<const embedded::File*> left;
  for (const embedded::File* file : files) {
    Diagnostics diagnostics;
    auto profile = ProfileReader(file->name, diagnostics).read(file->bytes, [&posts](std::string_view name) {
      return find_in(posts, name);
    });
    if (profile)
      posts.push_back(std::move(*profile));
    else
      left.push_back(file);
  }
  files = std::move(left);
  assert(posts.size() > before && "a built-in post is faulty");
}

}  // namespace

const std::vector<PostProfile>& built_in_posts() {
  static const std::vector<PostProfile> posts = [] {
    std::vector<const embedded::File*> files;
    for (std::size_t i = 0; i < embedded::post_files_count; ++i) files.push_back(&embedded::post_files[i]);
    std::vector<PostProfile> all;
    while (!files.empty()) read_built_in_posts(files, all);
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    return all;
  }();
  return posts;
}

const PostProfile* find_post(std::string_view name) { return find_in(built_in_posts(), name); }

std::optional<PostProfile> read_post_profile(std::string_view text, std::string_view file_name,
                                             Diagnostics& diagnostics) {
  return ProfileReader(file_name, diagnostics).read(text, find_post);
}

}  // namespace kerf
