// Rows of operations: one for each operation of `kerf cut`, beside the operation itself (mill/rows.cpp,
// mesh/rows.cpp, laser/rows.cpp). From them come the keys of job files, the options and the help of the
// command, the schema, the functions of Python's `kerf.op`, and the tables of docs/manual/operations.md.
//
// A row states what an operation cuts, its keys and an example, and runs it on options of its own type. The
// default of a key is the value in a default-constructed one.
#pragma once

#include <any>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kerf/geom/region.h"
#include "kerf/op/operation.h"

namespace kerf {

struct SurfaceMesh;    // op/surface.h
struct PlacedPicture;  // op/laser.h

/// A number in the unit of its key, a text, which may be a number with a unit or a formula ("1/4in"), or a
/// list of texts or numbers, such as a point in mm.
using CutValue = std::variant<double, std::string, std::vector<std::string>, std::vector<double>>;
/// A value in messages.
std::string text_of(const CutValue& value);

/// What the number of a key may be.
struct CutRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool above = false;  ///< `low` is not part of it
};

/// What is stated of a key.
struct CutKeyText {
  std::string_view name{};
  std::string_view meaning{};  ///< one line
  std::string_view example{};  ///< a value as in a job file; of a choice empty: its default
  CutRange range{};
  bool required = false;
  std::string_view otherwise{};  ///< what holds where it is not given, if that is no value of its own
  bool as_comment = false;       ///< in examples: it would select what the example does not have
  enum class Type : std::uint8_t { number, whole, tool, text, choice, list, point } type = Type::number;
  std::string_view unit{};                  ///< "mm"; empty: none
  std::string_view needs{};                 ///< a key without which it has no effect
  std::vector<std::string_view> choices{};  ///< of a choice

  bool is_number() const { return type == Type::number || type == Type::whole || type == Type::tool; }
};
/// "a number in mm above 0": what a value of a key must be.
std::string rule_of(const CutKeyText& key);
/// What is wrong with a text as the number of a key, as an addition to its rule: "; unknown unit inh at ...".
std::string fault_of(const CutKeyText& key, const CutValue& value);

/// A key of a `Target`.
template <class Target>
struct CutKeyOf : CutKeyText {
  /// Stores a value; false if it is none of the allowed ones.
  std::function<bool(Target& target, const CutValue& value)> set;
  /// Nothing: it has no value.
  std::function<std::optional<CutValue>(const Target& target)> get;
};

struct CutRow;

enum class CutCoolant : std::uint8_t { none, mist, flood };

/// An operation with the values of its keys.
struct CutOperation {
  const CutRow* row = nullptr;
  std::string name;                           ///< "pocket 1" unless given
  std::vector<std::string> layers, outlines;  ///< both empty: all shapes
  Combining combining = Combining::drawn;     ///< of overlapping shapes
  int tool = 0;
  SpindleSpeed speed{};  ///< 0: no spindle word
  CutCoolant coolant = CutCoolant::none;
  bool choose_feed = false;    ///< none is given: it is chosen by the chip load in `material`
  bool choose_depths = false;  ///< no stepdown is given: likewise
  bool choose_plunge = false;
  std::optional<Length> through{};  ///< below the stock: with it instead of a depth
  std::string material;
  std::string machine;            ///< file of the machine whose limits a chosen feed keeps; empty: none
  std::optional<double> retract;  ///< Z; nothing: 5 mm above the highest surface
  std::size_t max_steps = limits::kMaxGeneratedSteps;
  Origin where{};
  std::any options;  ///< those of the row
};
using CutKey = CutKeyOf<CutOperation>;

/// What an operation is run on.
struct CutWork {
  const CutOperation& operation;
  std::span<const CutOperation> job;  ///< all operations
  const std::map<int, Tool>& tools;
  const Tool* tool = nullptr;  ///< null: that of a laser
  double retract_plane = 0.0;
  std::optional<Region> region{};  ///< of the closed outlines, where the operation cuts a region
  std::vector<Outline> closed{}, open{};
  std::vector<Circle> circles{};
  std::vector<Point2> points{};
  std::vector<std::shared_ptr<const PlacedPicture>> pictures{};
  const SurfaceMesh* mesh = nullptr;
  Box3 mesh_box{};
  Progress* progress = nullptr;

  /// Closed outlines and open ones.
  std::vector<Outline> outlines() const;
  /// The tool of a number; null, with an error, if it has no shape.
  const Tool* tool_of(int number, Diagnostics& diagnostics) const;
};

/// What an operation cuts, and takes from the shapes that are selected.
enum class CutInput : std::uint8_t {
  region,
  region_or_stock,  ///< the top of the stock where no closed outline is selected
  outlines,
  circles,
  points,
  mesh,
  mesh_in_region,  ///< the whole mesh where no shape is selected
  mesh_along_outlines,
  picture,
  shapes,  ///< all of them
  nothing
};

/// A job that shows an operation, but for the operation itself.
struct CutExample {
  std::string_view shapes{};             ///< [[shape]] and [surface]
  std::string_view tool = "square d=6";  /// number 1
  std::string_view second_tool{};        ///< number 2; empty: none
  std::string_view before{};             ///< operations that precede it
  std::string_view stock{};              ///< empty: none
};

struct CutRow {
  std::string_view name{};      ///< "laser-cut"
  std::string_view sentence{};  ///< what it does
  std::string_view cuts{};      ///< what its shapes are: "what is cut out"
  CutInput input = CutInput::region;
  CutExample example{};
  int order = 0;  ///< among neighbouring operations of lasers: what is cut out moves
  bool laser = false;
  bool cuts_out = false;  ///< its closed outlines become loose where it goes through the stock
  std::vector<CutKey> keys{};
  std::any (*options)() = nullptr;  ///< with the default of each key
  std::function<std::optional<Operation>(const CutWork& work, Diagnostics& diagnostics)> run{};

  bool cuts_region() const { return input == CutInput::region || input == CutInput::region_or_stock; }
  bool needs_shapes() const { return input != CutInput::nothing && input != CutInput::region_or_stock; }
  bool cuts_mesh() const { return input >= CutInput::mesh && input <= CutInput::mesh_along_outlines; }
  const CutKey* key(std::string_view name) const;
  /// An operation with the defaults.
  CutOperation operation() const;
};

/// The number that a key of an operation has; nothing if there is no such key, or it has none.
std::optional<double> number_of(const CutOperation& operation, std::string_view key);
/// Sets the number of a key, if there is such a key.
void set_number(CutOperation& operation, std::string_view key, double value);

}  // namespace kerf
