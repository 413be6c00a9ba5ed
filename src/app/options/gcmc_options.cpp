// The options of `kerf gcmc`.
#include "app/options/gcmc_options.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <iterator>
#include <optional>
#include <utility>

#include "base/number.h"

#include "kerf/base/units.h"

namespace kerf::app {
namespace {

constexpr double kLargestOffset = 1e6;
constexpr double kBytesPerMegabyte = 1 << 20;
constexpr double kMaxOutput = 1e9;       // MB; their number of bytes fits 64 bits
constexpr double kMaxStepsOption = 1e6;  // millions, the limit of all steps
constexpr double kDegreesPerRadian = 57.29577951308232;

enum class Id : std::uint8_t {
  offset,
  brief,
  check,
  compat,
  debug,
  define,
  degrees,
  dxf,
  epilogue,
  explain,
  function,
  gcode,
  help,
  hex_handles,
  imperial,
  include,
  json,
  max_output,
  max_steps,
  no_flip,
  no_grid,
  no_m2,
  no_moves,
  opacity,
  output,
  pedantic,
  plane,
  precision,
  prologue,
  quiet,
  relative,
  svg,
  tool_width,
  uvw,
  version,
  warnings,
};

struct Option {
  char letter;  // '\0': none
  std::string_view name;
  std::string_view value;  // its name in the help; empty: takes none
  Id id;
  std::string_view help;
};

constexpr Option kOptions[] = {
    {'a', "offset-a", "ofs", Id::offset, "Offset of the A axis (degrees); likewise b, c, x, y, z, u, v, w"},
    {'b', "offset-b", "ofs", Id::offset, ""},
    {'c', "offset-c", "ofs", Id::offset, ""},
    {'x', "offset-x", "ofs", Id::offset, ""},
    {'y', "offset-y", "ofs", Id::offset, ""},
    {'z', "offset-z", "ofs", Id::offset, ""},
    {'u', "offset-u", "ofs", Id::offset, ""},
    {'v', "offset-v", "ofs", Id::offset, ""},
    {'w', "offset-w", "ofs", Id::offset, ""},
    {'d', "debug", "", Id::debug, "Accepted for compatibility"},
    {'D', "define", "stmt", Id::define, "Statement that runs first, such as depth=5mm (may be repeated)"},
    {'\0', "degrees", "", Id::degrees, "Angles of A, B and C without unit are degrees, in any version"},
    {'\0', "dxf", "", Id::dxf, "Write a DXF drawing"},
    {'\0', "svg", "", Id::svg, "Write an SVG drawing"},
    {'\0', "gcode", "", Id::gcode, "Write G-code (default)"},
    {'G', "prologue", "file", Id::prologue, "Write this file instead of the default prologue"},
    {'g', "epilogue", "file", Id::epilogue, "Write this file instead of the default epilogue"},
    {'\0', "gcode-function", "fn", Id::function, "Write an O-word subroutine of this name"},
    {'\0', "gcode-nom2", "", Id::no_m2, "No M2 after the subroutine"},
    {'h', "help", "", Id::help, "This message"},
    {'I', "include", "path", Id::include, "Folder to search for included files (may be repeated)"},
    {'i', "imperial", "", Id::imperial, "Inches instead of mm"},
    {'o', "output", "file", Id::output, "Write this file instead of standard output, -"},
    {'\0', "pedantic", "", Id::pedantic, "Accepted for compatibility"},
    {'P', "precision", "n", Id::precision, "Decimals, 1 to 15 (default 8)"},
    {'p', "plane", "p", Id::plane, "Initial plane: 0, 1, 2 or XY, XZ, YZ"},
    {'q', "bare", "", Id::quiet, "No prologue and no epilogue"},
    {'r', "relative", "", Id::relative, "Relative coordinates (G91)"},
    {'\0', "svg-no-flip", "", Id::no_flip, "Do not mirror Y"},
    {'\0', "svg-no-movelayer", "", Id::no_moves, "Do not draw rapids"},
    {'\0', "svg-no-grid", "", Id::no_grid, "No grid"},
    {'\0', "svg-toolwidth", "w", Id::tool_width, "Width of the strokes (default 3.0mm or 0.125in)"},
    {'\0', "svg-opacity", "o", Id::opacity, "Opacity of the strokes, 0 to 1 (default 0.1)"},
    {'U', "uvw", "", Id::uvw, "Write U, V and W words"},
    {'V', "version", "", Id::version, "Print the version"},
    {'W', "error", "", Id::warnings, "Warnings are errors"},
    {'\0', "brief", "", Id::brief, "Omit words that repeat a modal value (Kerf)"},
    {'\0', "compat", "version", Id::compat,
     "The version of gcmc, 1.8 or 1.9, whose arcs and angles the program expects (Kerf)"},
    {'\0', "check", "", Id::check, "Run without output, and report errors and warnings (Kerf)"},
    {'\0', "json", "", Id::json, "With --check: print the diagnostics as JSON (Kerf)"},
    {'\0', "explain", "", Id::explain, "Print source line, hint and calls of each message (Kerf)"},
    {'\0', "max-output", "MB", Id::max_output, "Maximum output in MB (Kerf, default 2048)"},
    {'\0', "max-steps", "MILLIONS", Id::max_steps,
     "Maximum of loop steps without output, in millions (Kerf, default 500: some 10 s)"},
    {'\0', "hex-handles", "", Id::hex_handles, "DXF entities with handles, as AutoCAD requires (Kerf)"},
};

/// A number with an optional unit: an offset or a width.
struct Quantity {
  double value = 0.0;
  std::string unit;
};
std::optional<Quantity> parse_quantity(const std::string& text) {
  const std::size_t end = std::min(text.find_first_not_of("0123456789+-.eE"), text.size());
  const auto number = parse_number(std::string_view(text).substr(0, end));
  if (!number) return std::nullopt;
  Quantity q{*number, text.substr(end)};
  for (const char* unit : {"", "mm", "in", "mil", "deg", "rad"})
    if (q.unit == unit) return q;
  return std::nullopt;
}

std::optional<double> as_length(const Quantity& q, bool imperial) {
  const double mm = q.unit == "mm"   ? q.value
                    : q.unit == "in" ? q.value * kMmPerInch
                                     : q.value * kMmPerInch / 1000.0;
  if (q.unit.empty()) return q.value;
  if (q.unit == "deg" || q.unit == "rad") return std::nullopt;
  return imperial ? mm / kMmPerInch : mm;
}

std::optional<double> as_angle(const Quantity& q) {
  if (q.unit == "rad") return q.value * kDegreesPerRadian;
  return q.unit.empty() || q.unit == "deg" ? std::optional<double>(q.value) : std::nullopt;
}

class Reader {
 public:
  GcmcCommandLine run(const std::vector<std::string>& arguments) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      const std::string& word = arguments[i];
      const auto next = [&]() -> std::optional<std::string> {
        return i + 1 < arguments.size() ? std::optional<std::string>(arguments[++i]) : std::nullopt;
      };
      if (word == "--") {
        for (++i; i < arguments.size(); ++i) file(arguments[i]);
      } else if (word.size() > 2 && word.compare(0, 2, "--") == 0) {
        long_option(word, next);
      } else if (word.size() > 1 && word[0] == '-') {
        cluster(word, next);
      } else {
        file(word);
      }
    }
    finish();
    return std::move(out_);
  }

 private:
  void file(const std::string& name) {
    if (std::exchange(has_file_, true))
      error(fmt::format("more than one program: '{}' and '{}'", out_.input, name));
    else
      out_.input = name;
  }

  template <class Next>
  void long_option(const std::string& word, Next next) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(2, equals == std::string::npos ? std::string::npos : equals - 2);
    std::vector<const Option*> found;
    for (const Option& o : kOptions) {
      if (o.name == name) {
        found = {&o};
        break;
      }
      if (o.name.substr(0, name.size()) == name) found.push_back(&o);
    }
    if (found.size() != 1) {
      error(fmt::format("{} option '{}'", found.empty() ? "unrecognized" : "ambiguous", word));
      return;
    }
    const Option& o = *found.front();
    if (o.value.empty()) {
      if (equals != std::string::npos)
        error(fmt::format("option '--{}' doesn't allow an argument", o.name));
      else
        apply(o, {});
      return;
    }
    const auto value =
        equals != std::string::npos ? std::optional<std::string>(word.substr(equals + 1)) : next();
    if (value)
      apply(o, *value);
    else
      error(fmt::format("option '--{}' requires an argument", o.name));
  }

  template <class Next>
  void cluster(const std::string& word, Next next) {
    for (std::size_t k = 1; k < word.size(); ++k) {
      const auto* o = std::find_if(std::begin(kOptions), std::end(kOptions),
                                   [&](const Option& each) { return each.letter == word[k]; });
      if (o == std::end(kOptions)) {
        error(fmt::format("invalid option -- '{}'", word[k]));
        continue;
      }
      if (o->value.empty()) {
        apply(*o, {});
        continue;
      }
      const auto value = k + 1 < word.size() ? std::optional<std::string>(word.substr(k + 1)) : next();
      if (value)
        apply(*o, *value);
      else
        error(fmt::format("option requires an argument -- '{}'", word[k]));
      return;
    }
  }

  void error(std::string text) { out_.errors.push_back(std::move(text)); }

  void apply(const Option& o, const std::string& value) {
    GcmcOptions& run = out_.run;
    GcmcDrawingOptions& drawing = out_.drawing;
    switch (o.id) {
      case Id::offset: offsets_.emplace_back(o.letter, value); break;
      case Id::brief: run.brief = true; break;
      case Id::check: out_.check = true; break;
      case Id::compat: compat(value); break;
      case Id::debug:
      case Id::pedantic: break;
      case Id::define: run.defines.push_back(value); break;
      case Id::degrees: run.degrees = true; break;
      case Id::dxf: target(GcmcTarget::dxf); break;
      case Id::svg: target(GcmcTarget::svg); break;
      case Id::gcode: target(GcmcTarget::gcode); break;
      case Id::prologue: out_.prologue_file = value; break;
      case Id::epilogue: out_.epilogue_file = value; break;
      case Id::explain: out_.explain = true; break;
      case Id::function: function(value); break;
      case Id::help: out_.help = true; break;
      case Id::hex_handles: drawing.hex_handles = true; break;
      case Id::imperial: run.imperial = drawing.imperial = true; break;
      case Id::include: run.include_paths.push_back(value); break;
      case Id::json: out_.json = true; break;
      case Id::max_output: max_output(value); break;
      case Id::max_steps: max_steps(value); break;
      case Id::no_flip: drawing.flip = false; break;
      case Id::no_grid: drawing.show_grid = false; break;
      case Id::no_m2: run.subroutine_ends_program = false; break;
      case Id::no_moves: drawing.show_moves = false; break;
      case Id::opacity: opacity(value); break;
      case Id::output: out_.output = value == "-" ? "" : value; break;
      case Id::plane: plane(value); break;
      case Id::precision: precision(value); break;
      case Id::quiet: quiet_ = true; break;
      case Id::relative: run.relative = true; break;
      case Id::tool_width: tool_width_ = value; break;
      case Id::uvw: run.uvw = true; break;
      case Id::version: out_.version = true; break;
      case Id::warnings: out_.warnings_are_errors = true; break;
    }
  }

  void target(GcmcTarget target) {
    if (has_target_) error("Only one output format specifier allowed");
    has_target_ = true;
    out_.run.target = target;
  }

  void function(const std::string& name) {
    const bool good = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
    if (!good) error("G-code function name may only contain [a-z0-9_-]");
    out_.run.subroutine = name;
    out_.run.frame = GcmcFrame::subroutine;
  }

  void compat(const std::string& text) {
    if (const auto version = gcmc_version_named(text))
      out_.run.version = *version;
    else
      error(fmt::format("Unknown version '{}' of gcmc, expected 1.8 or 1.9", text));
  }

  void plane(const std::string& text) {
    static constexpr std::string_view kNames[] = {"XY", "XZ", "YZ"};
    for (int i = 0; i < 3; ++i)
      if (text == kNames[i] || text == std::to_string(i)) {
        out_.run.plane = static_cast<Plane>(i);
        return;
      }
    error("Active plane must be one of 0, 1, 2, XY, XZ or YZ");
  }

  void precision(const std::string& text) {
    const auto n = parse_number(text);
    if (!n || *n != std::floor(*n)) return error("Invalid number of decimals");
    if (*n < 1 || *n > 15) return error("Number of decimals out of range (1..15)");
    out_.run.precision = static_cast<int>(*n);
  }

  void max_output(const std::string& text) {
    const auto megabytes = parse_number(text);
    if (!megabytes || *megabytes <= 0.0 || *megabytes > kMaxOutput)
      return error(fmt::format("Output limit must be a number of MB above 0 and up to {}", kMaxOutput));
    out_.run.max_output = static_cast<std::uint64_t>(*megabytes * kBytesPerMegabyte);
  }
  void max_steps(const std::string& text) {
    const auto millions = parse_number(text);
    if (!millions || *millions <= 0.0 || *millions > kMaxStepsOption)
      return error(
          fmt::format("Step limit must be a number of millions above 0 and up to {}", kMaxStepsOption));
    out_.run.max_quiet_steps = static_cast<std::uint64_t>(*millions * 1e6);
  }

  void opacity(const std::string& text) {
    const auto n = parse_number(text);
    if (!n || *n < 0.0 || *n > 1.0) return error("SVG opacity out of range (0.0..1.0)");
    out_.drawing.opacity = *n;
  }

  /// Evaluates the options that depend on others, wherever those are on the command line.
  void finish() {
    static constexpr std::string_view kAxes = "xyzabcuvw";
    GcmcOptions& run = out_.run;
    for (const auto& [letter, text] : offsets_) {
      const std::size_t axis = kAxes.find(letter);
      const char name = static_cast<char>(letter - 'a' + 'A');
      const auto q = parse_quantity(text);
      if (!q) {
        error(fmt::format("Invalid global {}-offset '{}'", name, text));
        continue;
      }
      const auto value = axis >= 3 && axis <= 5 ? as_angle(*q) : as_length(*q, run.imperial);
      if (!value)
        error(fmt::format("Invalid units for global {}-offset", name));
      else if (std::fabs(*value) > kLargestOffset)
        error(fmt::format("Global {}-offset out of range", name));
      else
        run.offsets[axis] = *value;
    }
    if (run.relative &&
        std::any_of(run.offsets.begin(), run.offsets.end(), [](double v) { return v != 0.0; }))
      error("Offsets must be zero when using relative addressing");
    if (!tool_width_.empty()) {
      const auto q = parse_quantity(tool_width_);
      const auto value = q ? as_length(*q, run.imperial) : std::nullopt;
      if (!value || *value <= 0.0)
        error("Invalid SVG toolwidth");
      else
        out_.drawing.tool_width = *value;
    }
    if (quiet_ && run.frame == GcmcFrame::usual) run.frame = GcmcFrame::bare;
    if (run.target == GcmcTarget::gcode) return;
    if (quiet_ || !out_.prologue_file.empty() || !out_.epilogue_file.empty())
      error("Prologue and epilogue options are only allowed with G-code output");
  }

  GcmcCommandLine out_;
  std::vector<std::pair<char, std::string>> offsets_;
  std::string tool_width_;
  bool has_file_ = false, has_target_ = false, quiet_ = false;
};

}  // namespace

GcmcCommandLine parse_gcmc_options(const std::vector<std::string>& arguments) {
  return Reader().run(arguments);
}

std::vector<OptionDescription> gcmc_option_descriptions() {
  std::vector<OptionDescription> out;
  for (const Option& o : kOptions) {
    if (o.help.empty()) continue;
    OptionDescription& described = out.emplace_back();
    if (o.letter != '\0') described.names.push_back(fmt::format("-{}", o.letter));
    described.names.push_back(fmt::format("--{}", o.name));
    described.value = o.value;
    described.summary = o.help;
  }
  return out;
}

std::string gcmc_usage() {
  std::string text = "Usage: kerf gcmc [options] [file]\n";
  for (const Option& o : kOptions) {
    if (o.help.empty()) continue;
    std::string left = o.letter == '\0' ? "     " : fmt::format("  -{}|", o.letter);
    left += fmt::format("--{}", o.name);
    if (!o.value.empty()) left += fmt::format(" {}", o.value);
    text += fmt::format("{:<30} {}\n", left, o.help);
  }
  return text;
}

}  // namespace kerf::app
