// Job files and options as jobs.
#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <set>
#include <tuple>

#include "base/codes/op.h"
#include "base/guess.h"
#include "base/names.h"
#include "base/number.h"
#include "base/split.h"
#include "base/toml.h"
#include "front/cut/formulas.h"
#include "front/cut/shapes.h"

#include "kerf/base/limits.h"
#include "kerf/drawing/svg.h"

namespace kerf {
namespace {

using namespace cut_detail;

constexpr std::size_t kMaxOperations = 10'000;

/// "pocket 2": the default name of the second operation.
std::string usual_name(const CutOperation& operation, std::size_t index) {
  return fmt::format("{} {}", operation.row->name, index + 1);
}

/// Whether the feed of an operation is to be chosen, with the material and the machine of the defaults where
/// it names none; without a feed and without a material it is an error.
bool chooses_feed(CutOperation& operation, const std::set<std::string>& given, const CutDefaults& defaults,
                  const Origin& where, Diagnostics& diagnostics) {
  if (given.contains("feed") || operation.row->laser) return false;
  if (operation.material.empty()) operation.material = defaults.material;
  if (operation.machine.empty() && !operation.material.empty()) operation.machine = defaults.machine;
  if (!operation.material.empty()) return true;
  diagnostics
      .error(codes::cut_job_key, where,
             fmt::format("{}feed is missing", operation.name.empty() ? "" : operation.name + ": "))
      .hint = "feed = 900, or for a feed by the chip load material = \"MDF\"";
  return false;
}

bool is_missing(const CutKey& key, const std::set<std::string>& given) {
  if (given.contains(std::string(key.name)) || (key.name == "depth" && given.contains("through")))
    return false;
  return key.required;
}

/// What is chosen by the material, and that nothing is stated twice.
void complete(CutOperation& operation, const std::set<std::string>& given, const CutDefaults& defaults,
              const std::function<Origin(std::string_view key)>& where, Diagnostics& diagnostics) {
  operation.choose_feed = chooses_feed(operation, given, defaults, where("feed"), diagnostics);
  operation.choose_depths = !given.contains("stepdown");
  operation.choose_plunge = !given.contains("plunge");
  if (operation.through && given.contains("depth"))
    diagnostics.error(codes::cut_job_key, where("through"),
                      fmt::format("{}depth and through both state the depth",
                                  operation.name.empty() ? "" : operation.name + ": "));
  for (const CutKey& key : operation.row->keys)
    if (!key.needs.empty() && given.contains(std::string(key.name)) &&
        !given.contains(std::string(key.needs)))
      diagnostics.warning(codes::cut_job_key, where(key.name),
                          fmt::format("{} has no effect without {}", key.name, key.needs));
}

const CutOption* option_named(std::string_view name) {
  for (const CutOption& option : cut_options())
    if (option.key->name == name) return &option;
  return nullptr;
}

/// The key and value of a row: `depth = "through 0.5mm"` states `through`, as in Python's jobs.
std::pair<std::string_view, CutValue> as_stated(const CutRow& row, std::string_view name,
                                                const CutValue& value) {
  constexpr std::string_view kThrough = "through";
  const auto* text = std::get_if<std::string>(&value);
  if (name != "depth" || text == nullptr || row.key(kThrough) == nullptr) return {name, value};
  std::string_view rest = trim(*text);
  if (!rest.starts_with(kThrough)) return {name, value};
  rest.remove_prefix(kThrough.size());
  if (!rest.empty() && rest.front() != ' ') return {name, value};
  return {kThrough, rest.empty() ? CutValue(0.0) : CutValue(std::string(trim(rest)))};
}

std::string layout_names() {
  std::vector<std::string> names;
  for (const CutLayoutKey& key : cut_layout_keys()) names.emplace_back(key.name);
  return joined(names, ", ");
}

/// The message about an operation that is missing, or that does not exist.
std::string about_operation(std::string_view name) {
  if (name.empty()) return "the operation is missing";
  return fmt::format("there is no operation \"{}\"{}", name.substr(0, 60),
                     guess_at_end(name, cut_operation_names()));
}

/// Keys whose values are texts, whatever they say.
bool is_prose(std::string_view key) {
  constexpr std::string_view kKeys[] = {"text", "font", "name", "layer", "file", "picture", "pixels"};
  return std::find(std::begin(kKeys), std::end(kKeys), key) != std::end(kKeys);
}

/// Puts the stock into the texts of a shape, the mesh or a key of the layout.
void put_stock(toml::node& node, const Box3& stock) {
  if (toml::value<std::string>* text = node.as_string())
    text->get() = with_stock(text->get(), stock);
  else if (toml::array* list = node.as_array())
    for (toml::node& entry : *list) put_stock(entry, stock);
  else if (toml::table* table = node.as_table())
    for (auto&& [key, entry] : *table)
      if (!is_prose(key.str())) put_stock(entry, stock);
}

using StockOf = std::function<std::optional<Box3>(const std::string& stock)>;

class JobReader {
 public:
  JobReader(const std::string& file, const StockOf& stock_of, const CutDefaults& usual,
            Diagnostics& diagnostics)
      : file_(file), stock_of_(stock_of), usual_(usual), diagnostics_(diagnostics) {}

  std::optional<CutJob> read(std::string_view text) {
    if (text.size() > limits::kMaxProfileBytes) {
      error(codes::cut_job_syntax, TextLocation{file_, 0, 0}, "a job file is limited to 1 MB");
      return std::nullopt;
    }
    toml::parse_result parsed = toml::parse(text, std::string_view(file_));
    if (!parsed) {
      error(codes::cut_job_syntax, location(parsed.error().source()),
            std::string(parsed.error().description()));
      return std::nullopt;
    }
    put_stock(parsed.table());
    const toml::table& root = parsed.table();
    job_.layout.spoilboard = usual_.spoilboard;
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
  /// Operations keep their formulas: a stock that the layout makes is known later.
  void put_stock(toml::table& root) const {
    const auto text = root["stock"].value_exact<std::string>();
    const auto stock = text && stock_of_ ? stock_of_(*text) : std::nullopt;
    if (!stock) return;
    const auto is_layout = [](std::string_view name) {
      const auto& keys = cut_layout_keys();
      return std::any_of(keys.begin(), keys.end(), [&](const CutLayoutKey& k) { return k.name == name; });
    };
    for (auto&& [key, node] : root)
      if (key == "shape" || key == "surface" || is_layout(key.str())) kerf::put_stock(node, *stock);
  }
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
    } else if (name == "texts") {
      job_.drawing_texts = text_of(key, node);
    } else if (name == "tools") {
      tools(node);
    } else if (name == "shape" && node.is_array()) {
      shapes(*node.as_array());
    } else if (name == "surface" && node.is_table()) {
      job_.surface = read_surface(*node.as_table(), file_, diagnostics_);
      failed_ = failed_ || !job_.surface;
    } else if (layout(key, node)) {
    } else if (name == "defaults" ? !node.is_table() : name == "operation" ? !node.is_array() : true) {
      error(codes::cut_job_key, location(key.source()),
            name == "defaults" || name == "operation" || name == "shape" || name == "surface"
                ? fmt::format("{} has the wrong form", name)
                : fmt::format("unknown key \"{}\"", name.substr(0, 60)))
          .hint = "keys of a job: art, unit, strokes, texts, stock, " + layout_names() +
                  ", [surface], [tools], [[shape]], [defaults], [[operation]]";
    }
  }
  /// Whether it is a key of the layout.
  bool layout(const toml::key& key, const toml::node& node) {
    const auto& keys = cut_layout_keys();
    const auto known =
        std::find_if(keys.begin(), keys.end(), [&](const CutLayoutKey& k) { return k.name == key.str(); });
    if (known == keys.end()) return false;
    const auto value = value_of(node);
    if (!value || !known->set(job_.layout, *value))
      error(
          codes::cut_job_key, location(node.source()),
          fmt::format("{} must be {}{}", key.str(), rule_of(*known), value ? fault_of(*known, *value) : ""));
    return true;
  }
  void unit(const toml::key& key, const toml::node& node) {
    const std::string name = text_of(key, node);
    job_.unit = drawing_unit(name);
    if (!job_.unit && !name.empty())
      error(codes::cut_job_key, location(node.source()), "unit must be \"mm\", \"inch\", \"px\" or \"pt\"");
  }
  /// What strokes are, or the layers whose strokes are areas.
  void strokes(const toml::key& key, const toml::node& node) {
    if (const toml::array* layers = node.as_array()) {
      for (const toml::node& layer : *layers)
        if (std::string name = text_of(key, layer); !name.empty())
          job_.stroke_layers.push_back(std::move(name));
      return;
    }
    const std::string name = text_of(key, node);
    if (const auto strokes = stroke_shapes_of(name))
      job_.strokes = *strokes;
    else if (!name.empty())
      error(codes::cut_job_key, location(node.source()),
            "strokes must be \"lines\", \"areas\", or a list of the layers whose strokes are areas");
  }
  bool needs_shapes() const {
    const bool has_none = job_.art.empty() && job_.shapes.empty() && job_.texts.empty() &&
                          job_.pictures.empty() && !job_.surface;
    const auto needs_some = [](const CutOperation& o) { return o.row->needs_shapes(); };
    return has_none && std::any_of(job_.operations.begin(), job_.operations.end(), needs_some);
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

  /// Unknown keys; those without effect on the operation are warnings.
  void check_keys(const toml::table& table, const CutRow* row) {
    for (const auto& [key, node] : table) {
      const std::string_view name = key.str();
      if (row != nullptr && (name == "op" || row->key(name) != nullptr)) continue;
      std::vector<std::string> known, own;
      for (const CutOption& option : cut_options()) known.emplace_back(option.key->name);
      if (row != nullptr)
        for (const CutKey& k : row->keys) own.emplace_back(k.name);
      const bool exists = option_named(name) != nullptr;
      if (exists && row != nullptr)
        diagnostics_.warning(codes::cut_job_key, location(key.source()),
                             fmt::format("{} has no effect on the operation {}", name, row->name));
      if (exists) continue;
      error(codes::cut_job_key, location(key.source()),
            fmt::format("unknown key \"{}\"{}", name.substr(0, 60), guess_at_end(name, known)))
          .hint = row != nullptr ? fmt::format("keys of a {}: op, {}", row->name, joined(own, ", "))
                                 : "keys of operations: " + joined(known, ", ");
    }
  }

  void set_keys(const toml::table& table, CutOperation& operation, std::set<std::string>& given) {
    for (const auto& [key, node] : table) {
      auto value = value_of(node);
      std::string_view name = key.str();
      if (value) std::tie(name, value) = as_stated(*operation.row, name, *value);
      const CutOption* option = option_named(name);
      if (option == nullptr) continue;
      const CutKey* own = operation.row->key(name);
      // A value that has no effect is checked as well, on an operation that it has an effect on.
      CutOperation other = option->row->operation();
      const auto fault = !value           ? std::optional(std::string())
                         : own != nullptr ? store(*own, *value, operation, location(node.source()))
                                          : refused(*option->key, *value, other);
      if (fault)
        error(codes::cut_job_key, location(node.source()),
              fmt::format("{} must be {}{}", name, rule_of(own != nullptr ? *own : *option->key), *fault));
      given.insert(std::string(name));
      if (name != key.str() && table.contains(name)) given.insert(std::string(key.str()));  // both are stated
    }
  }

  /// Sets the value of a key, if that does not depend on the stock. What is wrong with it, if it is refused.
  static std::optional<std::string> refused(const CutKey& key, const CutValue& value,
                                            CutOperation& operation) {
    std::string fault = needs_stock(key, value) ? stock_fault(key, value) : fault_of(key, value);
    const bool good = needs_stock(key, value) ? fault.empty() : key.set(operation, value);
    return good ? std::nullopt : std::optional(std::move(fault));
  }
  /// Likewise; a formula is kept. It replaces that of [defaults].
  std::optional<std::string> store(const CutKey& key, const CutValue& value, CutOperation& operation,
                                   const Origin& where) {
    const std::size_t index = job_.operations.size();
    std::erase_if(job_.formulas, [&](const CutFormula& f) { return f.operation == index && f.key == &key; });
    auto fault = refused(key, value, operation);
    if (!fault && needs_stock(key, value))
      job_.formulas.push_back({index, &key, std::get<std::string>(value), where});
    return fault;
  }

  void operation(const toml::node& node, const toml::table* defaults, std::size_t index) {
    const toml::table* table = node.as_table();
    const auto op = table != nullptr ? (*table)["op"].value_exact<std::string>() : std::nullopt;
    const CutRow* row = op ? cut_row(*op) : nullptr;
    if (row == nullptr) {
      error(codes::cut_job_key, location(node.source()), op ? about_operation(*op) : "an operation has no op")
          .hint = "op is one of: " + joined(cut_operation_names(), ", ");
      return;
    }
    CutOperation made = row->operation();
    made.where = location(node.source());
    std::set<std::string> given;
    if (defaults != nullptr) set_keys(*defaults, made, given);
    check_keys(*table, row);
    if (table->contains("depth") || table->contains("through")) {  // either replaces both of [defaults]
      made.through.reset();
      given.erase("through");
      given.erase("depth");
    }
    set_keys(*table, made, given);
    if (made.name.empty()) made.name = usual_name(made, index);
    for (const CutKey& key : row->keys)
      if (is_missing(key, given))
        error(codes::cut_job_key, made.where, fmt::format("{}: {} is missing", made.name, key.name)).hint =
            fmt::format("{} = {}", key.name, key.example);
    const std::size_t errors = diagnostics_.errors();
    complete(
        made, given, usual_, [&](std::string_view) { return made.where; }, diagnostics_);
    failed_ = failed_ || diagnostics_.errors() > errors;
    job_.operations.push_back(std::move(made));
  }

  std::string file_;
  const StockOf& stock_of_;
  const CutDefaults& usual_;
  Diagnostics& diagnostics_;
  CutJob job_;
  bool failed_ = false;
};

/// A value of the command line or of Python, as the key has it.
CutValue value_of(const CutKeyText& key, const CutValue& given) {
  const auto* text = std::get_if<std::string>(&given);
  if (text == nullptr) return given;
  if (key.type != CutKeyText::Type::list) return given;
  return CutValue(words_of_list(*text));
}

bool has_value(const CutValues& values, std::string_view name) {
  return std::any_of(values.begin(), values.end(), [&](const auto& value) { return value.first == name; });
}

/// Stores the values for keys of a shape or the layout; false, with errors, if one is invalid.
template <class Shape>
bool set_shape_keys(const CutValues& values, const std::vector<CutKeyOf<Shape>>& keys, Shape& shape,
                    Diagnostics& diagnostics) {
  bool good = true;
  for (const auto& [name, given] : values)
    for (const CutKeyOf<Shape>& key : keys) {
      if (key.name != name) continue;
      if (key.set(shape, value_of(key, given))) continue;
      good = false;
      diagnostics.error(codes::cut_job_key, CallLocation{"", 0, "--" + name},
                        fmt::format("{} is not {}{}", text_of(given), rule_of(key), fault_of(key, given)));
    }
  return good;
}

/// Refuses keys that neither operations, texts, pictures nor the layout have.
void check_names(const CutValues& values, Diagnostics& diagnostics) {
  std::vector<std::string> known{"op"};
  for (const CutOption& option : cut_options()) known.emplace_back(option.key->name);
  for (const CutTextKey& key : cut_text_keys()) known.emplace_back(key.name);
  for (const CutPictureKey& key : cut_picture_keys()) known.emplace_back(key.name);
  for (const CutLayoutKey& key : cut_layout_keys()) known.emplace_back(key.name);
  for (const auto& [name, value] : values)
    if (std::find(known.begin(), known.end(), name) == known.end())
      diagnostics.error(codes::cut_job_key, CallLocation{"", 0, "--" + name},
                        fmt::format("unknown key \"{}\"{}", clipped(name, 60), guess_at_end(name, known)));
}

/// The picture of the command line, if it has one; false, with errors, if it is invalid.
bool read_picture(const CutValues& values, CutJob& job, Diagnostics& diagnostics) {
  if (!has_value(values, "picture") && !has_value(values, "pixels")) return true;
  PictureShape shape;
  shape.where = CallLocation{"", 0, "--picture"};
  if (!set_shape_keys(values, cut_picture_keys(), shape, diagnostics)) return false;
  job.pictures.push_back(std::move(shape));
  return true;
}

/// The text of the command line, if it has one; false, with errors, if it is invalid.
bool read_texts(const CutValues& values, CutJob& job, Diagnostics& diagnostics) {
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

bool read_text_keys(const CutValues& values, TextShape& shape, Diagnostics& diagnostics) {
  if (!set_shape_keys(values, cut_text_keys(), shape, diagnostics)) return false;
  if (!shape.text.empty() && shape.options.height > Length{}) return true;
  const bool has_text = !shape.text.empty();
  diagnostics.error(codes::cut_job_key, CallLocation{"", 0, has_text ? "--height" : "--text"},
                    has_text ? "a height above 0 mm is required" : "a text is required");
  return false;
}

std::optional<CutJob> read_cut_job(std::string_view text, const std::string& file_name,
                                   Diagnostics& diagnostics, const StockOf& stock_of,
                                   const CutDefaults& defaults) {
  return JobReader(file_name, stock_of, defaults, diagnostics).read(text);
}

std::optional<CutJob> cut_job_of(const CutValues& given_values, Diagnostics& diagnostics,
                                 const std::optional<Box3>& stock, const CutDefaults& defaults) {
  CutValues values = given_values;
  for (auto& [name, value] : values)
    if (auto* text = std::get_if<std::string>(&value); text != nullptr && stock && !is_prose(name))
      *text = with_stock(std::move(*text), *stock);
  const auto where = [](std::string_view key) { return CallLocation{"", 0, "--" + std::string(key)}; };
  std::string_view op;
  for (const auto& [key, value] : values)
    if (const auto* text = std::get_if<std::string>(&value); key == "op" && text != nullptr) op = *text;
  const CutRow* row = cut_row(op);
  if (row == nullptr) {
    diagnostics.error(codes::cut_job_key, where("op"), about_operation(op)).hint =
        "one of: " + joined(cut_operation_names(), ", ");
    return std::nullopt;
  }
  CutOperation operation = row->operation();
  operation.tool = 1;
  operation.where = where("op");
  CutJob job;
  job.layout.spoilboard = defaults.spoilboard;
  const std::size_t errors = diagnostics.errors();
  check_names(values, diagnostics);
  set_shape_keys(values, cut_layout_keys(), job.layout, diagnostics);
  read_picture(values, job, diagnostics);
  read_texts(values, job, diagnostics);
  std::set<std::string> given{"tool"};
  for (const auto& [option, value] : values) {
    const auto [name, text] = as_stated(*row, option, value);
    given.insert(std::string(name));
    if (name != option && has_value(values, name)) given.insert(option);  // both are stated
    const CutKey* key = row->key(name);
    if (key == nullptr && option_named(name) != nullptr)
      diagnostics.warning(codes::cut_job_key, where(name),
                          fmt::format("no effect on the operation {}", row->name));
    if (key == nullptr) continue;
    const std::string fault = needs_stock(*key, text) ? stock_fault(*key, text) : fault_of(*key, text);
    const bool by_stock = needs_stock(*key, text);
    if (by_stock && fault.empty())
      job.formulas.push_back({0, key, std::get<std::string>(text), where(name)});
    else if (by_stock || !key->set(operation, value_of(*key, text)))
      diagnostics.error(codes::cut_job_key, where(name),
                        fmt::format("{} is not {}{}", text_of(text), rule_of(*key), fault));
  }
  for (const CutKey& key : row->keys)
    if (is_missing(key, given))
      diagnostics.error(codes::cut_job_key, where(key.name), fmt::format("{} is missing", key.name)).hint =
          fmt::format("--{} {}", key.name, key.example);
  complete(operation, given, defaults, where, diagnostics);
  if (diagnostics.errors() > errors) return std::nullopt;
  if (operation.name.empty()) operation.name = row->name;
  job.operations.push_back(std::move(operation));
  return job;
}

}  // namespace kerf
