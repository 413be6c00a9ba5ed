// Shape and body of a tool from keys and values, by the table of the shape's parameters.
#include "formats/settings.h"

#include <array>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/tools.h"
#include "base/guess.h"
#include "base/names.h"
#include "base/number.h"

#include "kerf/formats/workshop_files.h"

namespace kerf::detail {
namespace {

constexpr double kUsualShankLength = 20.0;  // mm: that of most built-in tools

struct BodyKey {
  std::string_view name;
  Length ToolBody::*member;
};
constexpr std::array kBodyKeys{
    BodyKey{"neck_diameter", &ToolBody::neck_diameter},
    BodyKey{"neck_length", &ToolBody::neck_length},
    BodyKey{"shank_diameter", &ToolBody::shank_diameter},
    BodyKey{"shank_length", &ToolBody::shank_length},
    BodyKey{"holder_diameter", &ToolBody::holder_diameter},
    BodyKey{"holder_length", &ToolBody::holder_length},
};

struct ShortKey {
  std::string_view shorter, key;
};
constexpr std::array kShortKeys{
    ShortKey{"d", "diameter"},
    ShortKey{"dia", "diameter"},
    ShortKey{"r", "corner_radius"},
    ShortKey{"r", "radius"},
    ShortKey{"r", "tip_radius"},
    ShortKey{"a", "angle"},
    ShortKey{"tip", "tip_diameter"},
    ShortKey{"neck", "neck_diameter"},
    ShortKey{"shank", "shank_diameter"},
    ShortKey{"shaft", "shank_diameter"},
    ShortKey{"holder", "holder_diameter"},
    ShortKey{"pitch", "cut_height"},
    ShortKey{"included_angle", "angle"},
    ShortKey{"point_angle", "angle"},
    ShortKey{"side_angle", "angle"},
};
constexpr std::array<std::string_view, 3> kTextKeys{"name", "description", "transition"};

/// The full name of a key: "d" is the diameter, "r" the radius of the shape.
std::string_view full_key(std::string_view key, const ToolShape& shape) {
  if (has_measure(shape, key)) return key;
  std::string_view last;
  for (const ShortKey& known : kShortKeys) {
    if (known.shorter != key) continue;
    if (has_measure(shape, known.key)) return known.key;
    last = known.key;
  }
  return last.empty() ? key : last;
}

class SettingReader {
 public:
  SettingReader(const ToolShape& blank, double scale, const Origin& where, Diagnostics& diagnostics)
      : shape_(blank), scale_(scale), where_(where), diagnostics_(diagnostics) {}

  void read(const Setting& setting);
  std::optional<Tool> make();

 private:
  bool read_shape(const Setting& setting);
  bool read_body(const Setting& setting);
  bool read_rest(const Setting& setting);
  void unknown(const Setting& setting);
  void wrong(const Setting& setting, std::string_view expected) {
    fine_ = false;
    diagnostics_.error(codes::tool_value_type, setting.where,
                       fmt::format("{} must be {}", setting.key, expected));
  }
  /// A length in mm or an angle in degrees; nothing after an error.
  std::optional<double> number(const Setting& setting, ShapeParameter::Kind kind);

  ToolShape shape_;
  ToolBody body_;
  double scale_;
  const Origin& where_;
  Diagnostics& diagnostics_;
  std::vector<std::string> names_;
  std::string description_;
  std::optional<int> teeth_;
  std::optional<bool> plunges_;
  std::vector<std::string> seen_;
  bool fine_ = true;
};

std::optional<double> SettingReader::number(const Setting& setting, ShapeParameter::Kind kind) {
  const bool is_length = kind == ShapeParameter::Kind::length;
  if (const auto* value = std::get_if<double>(&setting.value)) return is_length ? scale_ * *value : *value;
  if (const auto* text = std::get_if<std::string>(&setting.value)) {
    std::string_view angle = trim(*text);
    if (angle.size() > 3 && angle.substr(angle.size() - 3) == "deg")
      angle = trim(angle.substr(0, angle.size() - 3));
    const auto value = is_length ? parse_length(*text, scale_) : parse_number(angle);
    if (value) return value;
  }
  wrong(setting, is_length ? "a length, such as 6.35 or \"0.25in\"" : "an angle in degrees");
  return std::nullopt;
}

bool SettingReader::read_shape(const Setting& setting) {
  for (const ShapeParameter& parameter : parameters_of(shape_)) {
    if (parameter.name != setting.key) continue;
    const auto value = number(setting, parameter.kind);
    if (value && *value == 0.0 && setting.key == "flute")
      wrong(setting, "above 0; if it is not given, a usual value for the diameter is assumed");
    else if (value)
      parameter.set(shape_, *value);
    return true;
  }
  auto* drawn = std::get_if<shape::Drawn>(&shape_);
  if (drawn == nullptr || setting.key != "profile") return false;
  if (const auto* profile = std::get_if<Profile>(&setting.value)) {
    drawn->cutting = *profile;
    for (Knot& knot : drawn->cutting.knots) knot = {scale_ * knot.r, scale_ * knot.z, knot.bulge};
  } else {
    wrong(setting, "a list of points [r, z] or [r, z, bulge]");
  }
  return true;
}

bool SettingReader::read_body(const Setting& setting) {
  for (const BodyKey& key : kBodyKeys) {
    if (key.name != setting.key) continue;
    if (const auto value = number(setting, ShapeParameter::Kind::length)) body_.*key.member = mm(*value);
    return true;
  }
  return false;
}

bool SettingReader::read_rest(const Setting& setting) {
  if (setting.key == "teeth") {
    const auto value = number(setting, ShapeParameter::Kind::angle);
    const bool count = value && *value >= 1.0 && *value <= 100.0 && *value == std::floor(*value);
    if (count) teeth_ = static_cast<int>(*value);
    if (value && !count) wrong(setting, "a whole number from 1 to 100");
    return true;
  }
  const auto* text = std::get_if<std::string>(&setting.value);
  if (setting.key == "plunges") {
    if (const auto* value = std::get_if<bool>(&setting.value))
      plunges_ = *value;
    else if (text != nullptr && (*text == "true" || *text == "false"))
      plunges_ = *text == "true";
    else
      wrong(setting, "true or false");
    return true;
  }
  bool known = false;
  for (const std::string_view key : kTextKeys) known = known || key == setting.key;
  if (!known) return false;
  if (text == nullptr) {
    wrong(setting, "a text in quotes");
  } else if (setting.key == "name") {
    names_.push_back(*text);
  } else if (setting.key == "description") {
    description_ = *text;
  } else if (*text == "cone" || *text == "step") {
    body_.transition = *text == "cone" ? Transition::cone : Transition::step;
  } else {
    wrong(setting, "\"step\" or \"cone\"");
  }
  return true;
}

void SettingReader::unknown(const Setting& setting) {
  fine_ = false;
  std::vector<std::string> known;
  for (const ShapeParameter& parameter : parameters_of(shape_)) known.emplace_back(parameter.name);
  if (std::holds_alternative<shape::Drawn>(shape_)) known.emplace_back("profile");
  std::string dimensions;
  for (const std::string& name : known) dimensions += (dimensions.empty() ? "" : ", ") + name;
  for (const ToolKey& key : tool_keys()) known.emplace_back(key.name);
  Diagnostic& error =
      diagnostics_.error(codes::tool_key_unknown, setting.where,
                         fmt::format("a {} tool has no \"{}\"", name_of(shape_), setting.key.substr(0, 40)));
  error.hint =
      guess(setting.key, known, fmt::format("its dimensions: {}; all keys: kerf tools shapes", dimensions));
}

void SettingReader::read(const Setting& given) {
  Setting setting = given;
  setting.key = full_key(given.key, shape_);
  for (const std::string& seen : seen_) {
    if (seen == setting.key && seen != "name") return wrong(setting, "given only once");
  }
  seen_.push_back(setting.key);
  if (!read_shape(setting) && !read_body(setting) && !read_rest(setting)) unknown(given);
}

std::optional<Tool> SettingReader::make() {
  if (!fine_) return std::nullopt;
  if (body_.shank_diameter.mm() != 0.0 && body_.shank_length.mm() == 0.0)
    body_.shank_length = mm(kUsualShankLength);
  std::optional<Tool> tool = make_tool(0, shape_, body_, where_, diagnostics_);
  if (!tool) return std::nullopt;
  tool->names = std::move(names_);
  tool->description = std::move(description_);
  tool->teeth = teeth_.value_or(tool->teeth);
  tool->teeth_assumed = !teeth_;
  tool->plunges = plunges_.value_or(tool->plunges);
  return tool;
}

}  // namespace

bool has_measure(const ToolShape& shape, std::string_view key) {
  for (const ShapeParameter& parameter : parameters_of(shape))
    if (parameter.name == key) return true;
  return false;
}

std::optional<ToolShape> blank_shape(std::string_view name, const Origin& where, Diagnostics& diagnostics) {
  if (auto shape = shape_named(name)) return shape;
  Diagnostic& error = diagnostics.error(codes::tool_shape_unknown, where,
                                        fmt::format("unknown tool shape \"{}\"", name.substr(0, 40)));
  error.hint = guess(name, shape_names(), "shapes: " + list_text(shape_names()));
  return std::nullopt;
}

std::optional<Tool> tool_of(const ToolShape& blank, const std::vector<Setting>& settings, double scale,
                            const Origin& where, Diagnostics& diagnostics) {
  SettingReader reader(blank, scale, where, diagnostics);
  for (const Setting& setting : settings) reader.read(setting);
  return reader.make();
}

}  // namespace kerf::detail

namespace kerf {

const std::vector<ToolKey>& tool_keys() {
  static const std::vector<ToolKey> keys{
      {"neck_diameter", "diameter of a neck above the flutes that does not cut"},
      {"neck_length", "length of that neck"},
      {"shank_diameter", "diameter of the shank above it"},
      {"shank_length", "from the neck or the flute; 20 mm if only the diameter is given"},
      {"holder_diameter", "diameter of the holder above the shank"},
      {"holder_length", "length of the holder"},
      {"transition", "step or cone (45 degrees): the lower end of a shank wider than the part below it"},
      {"teeth", "1 to 100; default 2"},
      {"plunges", "true or false: whether it cuts at its centre; each shape has its own default"},
      {"number", "the tool's number"},
      {"numbers", "in files: several numbers of one tool"},
      {"name", "a name, such as the vendor's"},
      {"names", "in files: several names"},
      {"description", "any text"},
      {"shape", "in files: the shape"},
      {"unit", "in files: mm or inch"},
  };
  return keys;
}

std::vector<std::string_view> short_names_of(std::string_view key, const ToolShape& shape) {
  std::vector<std::string_view> names;
  for (const detail::ShortKey& known : detail::kShortKeys)
    if (known.key == key && detail::full_key(known.shorter, shape) == key) names.push_back(known.shorter);
  return names;
}

}  // namespace kerf
