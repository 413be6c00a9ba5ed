// Job files and options as jobs.
#include <algorithm>
#include <fmt/format.h>
#include <set>

#include "base/codes/op.h"
#include "base/names.h"
#include "base/number.h"
#include "base/toml.h"
#include "front/cut/keys.h"
#include "front/cut/shapes.h"

#include "kerf/base/limits.h"
#include "kerf/drawing/svg.h"

namespace kerf {
namespace {

using namespace cut_detail;

constexpr std::size_t kMaxOperations = 10'000;
constexpr double kSurfaceStepover = 0.1;  // of the diameter: what a ball leaves between lines is low

/// "pocket 2": the default name of the second operation.
std::string usual_name(const CutOperation& operation, std::size_t index) {
  return fmt::format("{} {}", cut_kind_names()[static_cast<std::size_t>(operation.kind)], index + 1);
}

std::string rule_of(const CutKey& key) {
  if (key.type == CutKey::Type::list) return "a list of texts";
  if (key.type == CutKey::Type::number)
    return key.unit.empty() ? std::string("a number") : fmt::format("a number in {}", key.unit);
  return key.unit.empty() ? std::string("a text") : fmt::format("one of: {}", key.unit);
}

/// Whether the feed of an operation is to be chosen; without one and without a material it is an error.
bool chooses_feed(const CutOperation& operation, const std::set<std::string>& given, const Origin& where,
                  Diagnostics& diagnostics) {
  if (given.contains("feed") || is_laser(operation.kind)) return false;
  if (!operation.material.empty()) return true;
  diagnostics
      .error(codes::cut_job_key, where,
             fmt::format("{}feed is missing", operation.name.empty() ? "" : operation.name + ": "))
      .hint = "feed = 900, or for a feed by the chip load material = \"MDF\"";
  return false;
}

/// Sets the defaults that depend on the kind, before keys are read.
CutOperation blank(CutKind kind) {
  CutOperation operation;
  operation.kind = kind;
  if (kind == CutKind::contour || kind == CutKind::engrave || kind == CutKind::vcarve)
    operation.cut.entry.kind = EntryKind::ramp;
  if (kind == CutKind::raster) operation.stepover = kSurfaceStepover;
  if (kind == CutKind::thread) operation.side = ContourSide::inside;
  if (kind == CutKind::laser_frame) operation.beam.laser.power = 0.0;
  return operation;
}

class JobReader {
 public:
  JobReader(const std::string& file, Diagnostics& diagnostics) : file_(file), diagnostics_(diagnostics) {}

  std::optional<CutJob> read(std::string_view text) {
    if (text.size() > limits::kMaxProfileBytes) {
      error(codes::cut_job_syntax, TextLocation{file_, 0, 0}, "a job file is limited to 1 MB");
      return std::nullopt;
    }
    const toml::parse_result parsed = toml::parse(text, std::string_view(file_));
    if (!parsed) {
      error(codes::cut_job_syntax, location(parsed.error().source()),
            std::string(parsed.error().description()));
      return std::nullopt;
    }
    const toml::table& root = parsed.table();
    for (const auto& [key, node] : root) top_key(key, node);
    const toml::table* defaults = root["defaults"].as_table();
    if (defaults != nullptr) check_keys(*defaults, nullptr);
    const toml::array* list = root["operation"].as_array();
    if (list == nullptr || list->empty())
      error(codes::cut_job_key, TextLocation{file_, 0, 0}, "the job has no [[operation]]");
    for (std::size_t i = 0; list != nullptr && i < std::min(list->size(), kMaxOperations); ++i)
      operation((*list)[i], defaults, i);
    if (list != nullptr && list->size() > kMaxOperations)
      error(codes::cut_job_key, location(list->source()),
            fmt::format("more than {} operations", kMaxOperations));
    if (needs_shapes() && !failed_)
      error(codes::cut_job_key, TextLocation{file_, 0, 0},
            "the job has no shapes: neither art, a file with outlines, nor [[shape]]")
          .hint = "art = \"part.dxf\"";
    if (failed_) return std::nullopt;
    return std::move(job_);
  }

 private:
  Origin location(const toml::source_region& at) const {
    return TextLocation{file_, at.begin.line, at.begin.column};
  }
  Diagnostic& error(Code code, const Origin& where, std::string message) {
    failed_ = true;
    return diagnostics_.error(code, where, std::move(message));
  }
  std::string text_of(const toml::key& key, const toml::node& node) {
    if (const auto text = node.value_exact<std::string>()) return *text;
    error(codes::cut_job_key, location(node.source()), fmt::format("{} must be a text", key.str()));
    return {};
  }

  void top_key(const toml::key& key, const toml::node& node) {
    const std::string_view name = key.str();
    if (name == "art") {
      job_.art = text_of(key, node);
    } else if (name == "stock") {
      job_.stock = text_of(key, node);
    } else if (name == "unit") {
      unit(key, node);
    } else if (name == "strokes") {
      strokes(key, node);
    } else if (name == "tools") {
      tools(node);
    } else if (name == "shape" && node.is_array()) {
      shapes(*node.as_array());
    } else if (name == "surface" && node.is_table()) {
      job_.surface = read_surface(*node.as_table(), file_, diagnostics_);
      failed_ = failed_ || !job_.surface;
    } else if (name == "defaults" ? !node.is_table() : name == "operation" ? !node.is_array() : true) {
      error(codes::cut_job_key, location(key.source()),
            name == "defaults" || name == "operation" || name == "shape" || name == "surface"
                ? fmt::format("{} has the wrong form", name)
                : fmt::format("unknown key \"{}\"", name.substr(0, 60)))
          .hint =
          "keys of a job: art, unit, strokes, stock, [surface], [tools], [[shape]], [defaults], "
          "[[operation]]";
    }
  }
  void unit(const toml::key& key, const toml::node& node) {
    const std::string name = text_of(key, node);
    job_.unit = drawing_unit(name);
    if (!job_.unit && !name.empty())
      error(codes::cut_job_key, location(node.source()), "unit must be \"mm\", \"inch\", \"px\" or \"pt\"");
  }
  void strokes(const toml::key& key, const toml::node& node) {
    const std::string name = text_of(key, node);
    if (const auto strokes = stroke_shapes_of(name))
      job_.strokes = *strokes;
    else if (!name.empty())
      error(codes::cut_job_key, location(node.source()), "strokes must be \"lines\" or \"areas\"");
  }
  bool needs_shapes() const {
    const bool has_none = job_.art.empty() && job_.shapes.empty() && job_.texts.empty() &&
                          job_.pictures.empty() && !job_.surface;
    const auto is_test = [](const CutOperation& o) { return o.kind == CutKind::laser_test; };
    return has_none && !std::all_of(job_.operations.begin(), job_.operations.end(), is_test);
  }
  void shapes(const toml::array& list) {
    for (const toml::node& node : list) {
      if (is_picture_shape(node)) {
        auto picture = read_picture_shape(node, file_, diagnostics_);
        if (picture)
          job_.pictures.push_back(std::move(*picture));
        else
          failed_ = true;
        continue;
      }
      if (is_text_shape(node)) {
        auto text = read_text_shape(node, file_, diagnostics_);
        if (text)
          job_.texts.push_back(std::move(*text));
        else
          failed_ = true;
        continue;
      }
      auto shape = read_shape(node, file_, diagnostics_);
      if (shape)
        job_.shapes.push_back(std::move(*shape));
      else
        failed_ = true;
    }
  }
  void tools(const toml::node& node) {
    const toml::table* table = node.as_table();
    if (table == nullptr) {
      error(codes::cut_job_key, location(node.source()),
            "expected [tools] with lines such as 1 = \"square d=6\"");
      return;
    }
    for (const auto& [key, value] : *table) {
      const auto number = parse_number(key.str());
      const bool good = number && *number >= 0 && *number <= limits::kMaxToolNumber &&
                        *number == static_cast<double>(static_cast<int>(*number));
      if (!good) {
        error(codes::cut_job_key, location(key.source()), "the key of a tool is its number");
        continue;
      }
      job_.tools[static_cast<int>(*number)] = text_of(key, value);
    }
  }

  /// Unknown keys; those without effect on the kind are warnings.
  void check_keys(const toml::table& table, const CutOperation* operation) {
    for (const auto& [key, node] : table) {
      const std::string_view name = key.str();
      if (operation != nullptr && name == "op") continue;
      if (key_named(name) == nullptr) {
        std::vector<std::string> names;
        for (const CutKey& k : cut_keys()) names.emplace_back(k.name);
        error(codes::cut_job_key, location(key.source()),
              fmt::format("unknown key \"{}\"", name.substr(0, 60)))
            .hint = "keys of an operation: op, " + joined(names, ", ");
      } else if (operation != nullptr && !applies(operation->kind, name)) {
        diagnostics_.warning(codes::cut_job_key, location(key.source()),
                             fmt::format("{} has no effect on a {}", name,
                                         cut_kind_names()[static_cast<std::size_t>(operation->kind)]));
      }
    }
  }

  static std::optional<CutValue> value_of(const toml::node& node) {
    if (const auto n = node.value_exact<double>()) return CutValue(*n);
    if (const auto n = node.value_exact<std::int64_t>()) return CutValue(static_cast<double>(*n));
    if (const auto text = node.value_exact<std::string>()) return CutValue(*text);
    const toml::array* list = node.as_array();
    if (list == nullptr) return std::nullopt;
    std::vector<std::string> texts;
    for (const toml::node& entry : *list) {
      const auto text = entry.value_exact<std::string>();
      if (!text) return std::nullopt;
      texts.push_back(*text);
    }
    return CutValue(texts);
  }

  void set_keys(const toml::table& table, CutOperation& operation, std::set<std::string>& given) {
    for (const auto& [key, node] : table) {
      const CutKey* known = key_named(key.str());
      if (known == nullptr) continue;
      const auto value = value_of(node);
      if (!value || !known->set(operation, *value))
        error(codes::cut_job_key, location(node.source()),
              fmt::format("{} must be {}", key.str(), rule_of(*known)));
      given.insert(std::string(key.str()));
    }
  }

  void operation(const toml::node& node, const toml::table* defaults, std::size_t index) {
    const toml::table* table = node.as_table();
    const auto op = table != nullptr ? (*table)["op"].value_exact<std::string>() : std::nullopt;
    const auto kind = op ? kind_named(*op) : std::nullopt;
    if (!kind) {
      error(codes::cut_job_key, location(node.source()),
            op ? fmt::format("there is no operation \"{}\"", op->substr(0, 60)) : "an operation has no op")
          .hint = "op is one of: " + joined(cut_kind_names(), ", ");
      return;
    }
    CutOperation made = blank(*kind);
    made.cut.where = location(node.source());
    std::set<std::string> given;
    if (defaults != nullptr) set_keys(*defaults, made, given);
    check_keys(*table, &made);
    set_keys(*table, made, given);
    if (made.name.empty()) made.name = usual_name(made, index);
    made.cut.name = made.name;
    for (const CutKey& key : cut_keys())
      if (is_required(*kind, key.name) && !given.contains(std::string(key.name)))
        error(codes::cut_job_key, made.cut.where, fmt::format("{}: {} is missing", made.name, key.name))
            .hint = fmt::format("{} = {}", key.name, key.example);
    const std::size_t errors = diagnostics_.errors();
    made.choose_feed = chooses_feed(made, given, made.cut.where, diagnostics_);
    failed_ = failed_ || diagnostics_.errors() > errors;
    job_.operations.push_back(std::move(made));
  }

  std::string file_;
  Diagnostics& diagnostics_;
  CutJob job_;
  bool failed_ = false;
};

/// The value of a text in the command line.
std::optional<CutValue> value_of(const CutKey& key, const std::string& text) {
  if (key.type == CutKey::Type::text) return CutValue(text);
  if (key.type == CutKey::Type::number) {
    const auto number = parse_number(text);
    return number ? std::optional(CutValue(*number)) : std::nullopt;
  }
  std::vector<std::string> texts;
  std::size_t start = 0;
  while (start <= text.size()) {
    const std::size_t end = std::min(text.find(',', start), text.size());
    texts.emplace_back(trim(std::string_view(text).substr(start, end - start)));
    start = end + 1;
  }
  return CutValue(texts);
}

using Values = std::vector<std::pair<std::string, std::string>>;

bool has_value(const Values& values, std::string_view name) {
  return std::any_of(values.begin(), values.end(), [&](const auto& value) { return value.first == name; });
}

/// Stores the values for keys of a shape; false, with errors, if one is invalid.
template <class Shape>
bool set_shape_keys(const Values& values, const std::vector<CutShapeKey<Shape>>& keys, Shape& shape,
                    Diagnostics& diagnostics) {
  bool good = true;
  for (const auto& [name, text] : values)
    for (const CutShapeKey<Shape>& key : keys) {
      if (key.name != name) continue;
      const auto value = value_of({key.name, key.type, key.unit, key.meaning, key.example, nullptr}, text);
      if (value && key.set(shape, *value)) continue;
      good = false;
      diagnostics.error(
          codes::cut_job_key, CallLocation{"", 0, "--" + name},
          fmt::format("expected a value such as {}, not \"{}\"", key.example, text.substr(0, 60)));
    }
  return good;
}

/// The picture of the command line, if it has one; false, with errors, if it is invalid.
bool read_picture(const Values& values, CutJob& job, Diagnostics& diagnostics) {
  if (!has_value(values, "picture") && !has_value(values, "pixels")) return true;
  PictureShape shape;
  shape.where = CallLocation{"", 0, "--picture"};
  if (!set_shape_keys(values, cut_picture_keys(), shape, diagnostics)) return false;
  job.pictures.push_back(std::move(shape));
  return true;
}

/// The text of the command line, if it has one; false, with errors, if it is invalid.
bool read_texts(const Values& values, CutJob& job, Diagnostics& diagnostics) {
  const auto& keys = cut_text_keys();
  // `at` is a picture's, too.
  if (std::none_of(keys.begin(), keys.end(), [&](const CutTextKey& key) {
        return has_value(values, key.name) && (key.name != "at" || job.pictures.empty());
      }))
    return true;
  TextShape shape;
  shape.options.where = CallLocation{"", 0, "--text"};
  if (!read_text_keys(values, shape, diagnostics)) return false;
  job.texts.push_back(std::move(shape));
  return true;
}

}  // namespace

bool read_text_keys(const Values& values, TextShape& shape, Diagnostics& diagnostics) {
  if (!set_shape_keys(values, cut_text_keys(), shape, diagnostics)) return false;
  if (!shape.text.empty() && shape.options.height > Length{}) return true;
  const bool has_text = !shape.text.empty();
  diagnostics.error(codes::cut_job_key, CallLocation{"", 0, has_text ? "--height" : "--text"},
                    has_text ? "a height above 0 mm is required" : "a text is required");
  return false;
}

std::optional<CutJob> read_cut_job(std::string_view text, const std::string& file_name,
                                   Diagnostics& diagnostics) {
  return JobReader(file_name, diagnostics).read(text);
}

std::optional<CutJob> cut_job_of(const Values& values, Diagnostics& diagnostics) {
  const auto where = [](std::string_view key) { return CallLocation{"", 0, "--" + std::string(key)}; };
  std::optional<CutKind> kind;
  for (const auto& [key, text] : values)
    if (key == "op") kind = kind_named(text);
  if (!kind) {
    diagnostics.error(codes::cut_job_key, where("op"), "the operation is missing or unknown").hint =
        "one of: " + joined(cut_kind_names(), ", ");
    return std::nullopt;
  }
  CutOperation operation = blank(*kind);
  operation.tool = 1;
  CutJob job;
  bool good = read_picture(values, job, diagnostics);
  good = read_texts(values, job, diagnostics) && good;
  std::set<std::string> given{"tool"};
  for (const auto& [name, text] : values) {
    const CutKey* key = key_named(name);
    if (key == nullptr || name == "tool") continue;
    const auto value = value_of(*key, text);
    if (!value || !key->set(operation, *value)) {
      diagnostics.error(codes::cut_job_key, where(name),
                        fmt::format("\"{}\" is not {}", text.substr(0, 60), rule_of(*key)));
      good = false;
    } else if (!applies(*kind, name)) {
      diagnostics.warning(
          codes::cut_job_key, where(name),
          fmt::format("no effect on a {}", cut_kind_names()[static_cast<std::size_t>(*kind)]));
    }
    given.insert(name);
  }
  for (const CutKey& key : cut_keys())
    if (is_required(*kind, key.name) && !given.contains(std::string(key.name))) {
      diagnostics.error(codes::cut_job_key, where(key.name), fmt::format("{} is missing", key.name)).hint =
          fmt::format("--{} {}", key.name, key.example);
      good = false;
    }
  const std::size_t errors = diagnostics.errors();
  operation.choose_feed = chooses_feed(operation, given, where("feed"), diagnostics);
  if (!good || diagnostics.errors() > errors) return std::nullopt;
  if (operation.name.empty()) operation.name = cut_kind_names()[static_cast<std::size_t>(*kind)];
  operation.cut.name = operation.name;
  operation.cut.where = where("op");
  job.operations.push_back(std::move(operation));
  return job;
}

}  // namespace kerf
