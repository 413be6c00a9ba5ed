// Tool databases of Vectric's programs (.vtdb): SQLite databases with the tables tool_geometry, tool_entity,
// tool_cutting_data, tool_tree_entry, material and machine. Without SQLite an error says so.
#include <fmt/format.h>

#include "base/codes/tools.h"
#include "formats/library.h"

#ifdef KERF_SQLITE

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <sqlite3.h>

#include "base/names.h"
#include "base/number.h"

#include "kerf/base/limits.h"
#include "kerf/base/units.h"

namespace kerf::detail {
namespace {

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
struct FinishStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;
using Statement = std::unique_ptr<sqlite3_stmt, FinishStatement>;

// Of a hostile database: bytes of a value, instructions of all queries, rows of a table.
constexpr int kLongestValue = 1 << 20;
constexpr int kInstructionsPerCall = 1 << 20, kMaxCalls = 400;
constexpr std::size_t kMaxRows = 200'000;

// Values of the column tool_type that two independent readers of such files agree on.
enum class VectricType : std::uint8_t { ball = 0, end_mill, radiused, vee, engraving, tapered_ball, drill };
constexpr int kMetric = 0, kInches = 1;  // of the column units

constexpr std::array<std::string_view, 4> kNeededTables{"tool_geometry", "tool_tree_entry", "tool_entity",
                                                        "tool_cutting_data"};

Statement prepare(sqlite3* database, std::string_view sql) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database, sql.data(), static_cast<int>(sql.size()), &statement, nullptr) !=
      SQLITE_OK)
    statement = nullptr;
  return Statement(statement);
}

int count_call(void* calls) { return ++*static_cast<int*>(calls) > kMaxCalls ? 1 : 0; }

/// A row by the names of its columns; a column that the file lacks is empty, as in older versions.
class Row {
 public:
  explicit Row(sqlite3_stmt* statement) : statement_(statement) {}
  double number(std::string_view name) const {
    const int at = column(name);
    if (at < 0) return 0.0;
    const int type = sqlite3_column_type(statement_, at);
    const double value =
        type == SQLITE_INTEGER || type == SQLITE_FLOAT ? sqlite3_column_double(statement_, at) : 0.0;
    return std::isfinite(value) ? value : 0.0;
  }
  bool has(std::string_view name) const {
    const int at = column(name);
    return at >= 0 && sqlite3_column_type(statement_, at) != SQLITE_NULL;
  }
  std::string text(std::string_view name) const {
    const int at = column(name);
    if (at < 0) return {};
    const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement_, at));
    if (bytes == nullptr) return {};
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, at));
    return std::string(trim({bytes, size}));
  }

 private:
  int column(std::string_view name) const {
    for (int i = 0; i < sqlite3_column_count(statement_); ++i)
      if (name == sqlite3_column_name(statement_, i)) return i;
    return -1;
  }
  sqlite3_stmt* statement_;
};

/// Reads a database in memory.
class VectricReader {
 public:
  explicit VectricReader(LibraryWriter& out) : out_(out) {}
  void read(std::string_view bytes);

 private:
  bool open(std::string_view bytes);
  bool has_tables();
  /// Calls visit(row) for each row of a table; false, with an error, if it cannot be read to its end.
  template <class Visit>
  bool each(std::string_view table, Visit&& visit);
  void fail(std::string message);
  void add(const Row& row);
  std::string name_of_tool(const Row& row, const LibraryTool& tool) const;

  LibraryWriter& out_;
  std::string image_;  // that the database works on
  Database database_;
  int calls_ = 0;
  std::map<std::string, std::string> names_;    // of the tree, by the tool's geometry
  std::map<std::string, std::string> cutting_;  // the cutting data of a geometry
  std::map<std::string, int> numbers_;          // by cutting data
};

void VectricReader::fail(std::string message) {
  out_.diagnostics().error(codes::tool_database_damaged, out_.location(0), std::move(message)).hint =
      "expected: a tool database of VCarve or Aspire, with the tables tool_geometry, tool_tree_entry, "
      "tool_entity and tool_cutting_data";
}

bool VectricReader::open(std::string_view bytes) {
  image_ = bytes;
  // A file in the mode with a separate log (2) cannot be opened in memory; its pages are the same as of
  // mode 1.
  constexpr std::size_t kWriteVersion = 18, kReadVersion = 19;
  if (image_.size() > kReadVersion)
    for (const std::size_t at : {kWriteVersion, kReadVersion})
      if (image_[at] == 2) image_[at] = 1;
  sqlite3* database = nullptr;
  const int opened =
      sqlite3_open_v2(":memory:", &database, SQLITE_OPEN_READWRITE | SQLITE_OPEN_MEMORY, nullptr);
  database_.reset(database);
  if (opened != SQLITE_OK) return false;
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH, kLongestValue);
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_progress_handler(database, kInstructionsPerCall, count_call, &calls_);
  return sqlite3_deserialize(database, "main", reinterpret_cast<unsigned char*>(image_.data()),
                             static_cast<sqlite3_int64>(image_.size()),
                             static_cast<sqlite3_int64>(image_.size()),
                             SQLITE_DESERIALIZE_READONLY) == SQLITE_OK;
}

/// Tables alone, no views, which may compute anything.
bool VectricReader::has_tables() {
  const Statement names = prepare(database_.get(), "SELECT name, type FROM sqlite_master");
  if (!names) {
    fail(fmt::format("the database is damaged: {}", sqlite3_errmsg(database_.get())));
    return false;
  }
  std::vector<std::string> found;
  int step = SQLITE_ROW;
  while ((step = sqlite3_step(names.get())) == SQLITE_ROW && found.size() < kMaxRows)
    if (Row(names.get()).text("type") == "table") found.push_back(Row(names.get()).text("name"));
  if (step != SQLITE_DONE) {
    fail(fmt::format("the database is damaged: {}", sqlite3_errmsg(database_.get())));
    return false;
  }
  for (const std::string_view table : kNeededTables)
    if (std::find(found.begin(), found.end(), table) == found.end()) {
      fail(fmt::format("the database has no table {}: it is not one of Vectric's tool databases", table));
      return false;
    }
  return true;
}

template <class Visit>
bool VectricReader::each(std::string_view table, Visit&& visit) {
  const Statement rows = prepare(database_.get(), fmt::format("SELECT * FROM {}", table));
  int step = rows ? SQLITE_ROW : SQLITE_ERROR;
  for (std::size_t i = 0; step == SQLITE_ROW && i <= kMaxRows; ++i)
    if ((step = sqlite3_step(rows.get())) == SQLITE_ROW) visit(Row(rows.get()));
  if (step == SQLITE_DONE) return true;
  fail(fmt::format("the table {} cannot be read: {}", table,
                   step == SQLITE_ROW ? "it has too many rows" : sqlite3_errmsg(database_.get())));
  return false;
}

/// The text of the tree, or the format of the name with its placeholders filled.
std::string VectricReader::name_of_tool(const Row& row, const LibraryTool& tool) const {
  const auto found = names_.find(row.text("id"));
  std::string text = found == names_.end() || found->second.empty() ? row.text("name_format") : found->second;
  const bool inches = row.number("units") == kInches;
  const double unit = inches ? kMmPerInch : 1.0;
  constexpr int kDecimals = 4;
  const std::array<std::pair<std::string_view, std::string>, 5> placeholders{
      {{"{Tool Type}", tool.shape},
       {"{Diameter}", number_text(tool.diameter / unit, kDecimals)},
       {"{Diameter|F}", number_text(tool.diameter / unit, kDecimals)},
       {"{Flat Diameter}", number_text(tool.tip_diameter / unit, kDecimals)},
       {"{Units Short}", inches ? "in" : "mm"}}};
  for (const auto& [name, value] : placeholders)
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + value.size()))
      text.replace(at, name.size(), value);
  return text.substr(0, limits::kMaxNameBytes);
}

void VectricReader::add(const Row& row) {
  LibraryTool tool;
  tool.where = out_.location(0);
  const double scale = row.number("units") == kInches ? kMmPerInch : 1.0;
  const double type = row.has("tool_type") ? row.number("tool_type") : -1.0;
  tool.diameter = scale * row.number("diameter");
  tool.flute = scale * row.number("flute_length");
  tool.teeth = static_cast<int>(std::clamp(row.number("num_flutes"), 0.0, 1000.0));
  if (tool.teeth > 100) tool.teeth = 0;
  const double tip_radius = scale * row.number("tip_radius"), angle = row.number("included_angle");
  constexpr std::array<std::string_view, 7> kShapes{"ball", "square",       "bull nose", "V",
                                                    "V",    "tapered ball", "drill"};
  const bool known = type >= 0.0 && type < static_cast<double>(kShapes.size()) && type == std::floor(type);
  tool.shape = known ? std::string(kShapes[static_cast<std::size_t>(type)]) : "";
  switch (known ? static_cast<VectricType>(static_cast<int>(type)) : VectricType::end_mill) {
    case VectricType::radiused: tool.corner_radius = tip_radius; break;
    case VectricType::vee:
    case VectricType::engraving:
      tool.angle = angle;
      tool.tip_diameter = scale * row.number("flat_diameter");
      break;
    case VectricType::tapered_ball:
      tool.angle = angle;
      tool.tip_diameter = 2.0 * tip_radius;
      break;
    case VectricType::drill: tool.angle = angle; break;
    case VectricType::ball:
    case VectricType::end_mill: break;
  }
  tool.description = name_of_tool(row, tool);
  if (!known)
    return out_.skip(
        tool.where, tool.description,
        fmt::format("tool_type {} is not a mill or drill that Kerf knows", number_text(type, 2)));
  const auto cutting = cutting_.find(row.text("id"));
  if (cutting != cutting_.end() && numbers_.count(cutting->second) != 0)
    tool.number = numbers_.at(cutting->second);
  out_.add(tool);
}

void VectricReader::read(std::string_view bytes) {
  if (!open(bytes)) return fail("the database cannot be opened: it is damaged");
  if (!has_tables()) return;
  const bool tree = each("tool_tree_entry", [&](const Row& row) {
    if (row.has("tool_geometry_id")) names_[row.text("tool_geometry_id")] = row.text("name");
  });
  if (!tree) return;
  // Numbers are those of the first material and machine for which a tool has one.
  const bool numbered =
      each("tool_cutting_data",
           [&](const Row& row) {
             const double number = row.number("tool_number");
             if (number >= 1.0 && number <= limits::kMaxTableToolNumber && number == std::floor(number))
               numbers_[row.text("id")] = static_cast<int>(number);
           }) &&
      each("tool_entity", [&](const Row& row) {
        const std::string data = row.text("tool_cutting_data_id");
        if (numbers_.count(data) != 0) cutting_.emplace(row.text("tool_geometry_id"), data);
      });
  if (numbered) each("tool_geometry", [&](const Row& row) { add(row); });
}

// ---- writing

constexpr std::string_view kSchema = R"(
CREATE TABLE version (version INTEGER NOT NULL UNIQUE, PRIMARY KEY(version));
CREATE TABLE machine (id TEXT NOT NULL UNIQUE, name TEXT NOT NULL UNIQUE, make TEXT, model TEXT,
  controller_type TEXT, dimensions_units INTEGER, max_width REAL, max_height REAL, support_rotary INTEGER,
  support_tool_change INTEGER, has_laser_head INTEGER, PRIMARY KEY(id));
CREATE TABLE material (id TEXT NOT NULL UNIQUE, name TEXT NOT NULL UNIQUE, PRIMARY KEY(id));
CREATE TABLE tool_geometry (id TEXT NOT NULL UNIQUE, name_format TEXT NOT NULL, notes TEXT,
  tool_type INTEGER NOT NULL, units INTEGER NOT NULL, diameter REAL, included_angle REAL, flat_diameter REAL,
  num_flutes INTEGER, flute_length REAL, thread_pitch REAL, outline BLOB, tip_radius REAL, laser_watt INTEGER,
  custom_attributes TEXT, tooth_size REAL, tooth_offset REAL, neck_length REAL, tooth_height REAL,
  threaded_length REAL, PRIMARY KEY(id));
CREATE TABLE tool_cutting_data (id TEXT NOT NULL UNIQUE, rate_units INTEGER NOT NULL, feed_rate REAL,
  plunge_rate REAL, spindle_speed INTEGER, spindle_dir INTEGER, stepdown REAL, stepover REAL,
  clear_stepover REAL, thread_depth REAL, thread_step_in REAL, laser_power REAL, laser_passes INTEGER,
  laser_burn_rate REAL, line_width REAL, length_units INTEGER NOT NULL DEFAULT 0, tool_number INTEGER,
  laser_kerf INTEGER, notes TEXT, PRIMARY KEY(id));
CREATE TABLE tool_entity (id TEXT NOT NULL UNIQUE, material_id TEXT, machine_id TEXT, tool_geometry_id TEXT,
  tool_cutting_data_id TEXT NOT NULL, PRIMARY KEY(tool_geometry_id, material_id, machine_id),
  FOREIGN KEY(material_id) REFERENCES material(id), FOREIGN KEY(machine_id) REFERENCES machine(id),
  FOREIGN KEY(tool_geometry_id) REFERENCES tool_geometry(id),
  FOREIGN KEY(tool_cutting_data_id) REFERENCES tool_cutting_data(id));
CREATE TABLE tool_tree_entry (id TEXT NOT NULL UNIQUE, parent_group_id TEXT, sibling_order INTEGER NOT NULL,
  tool_geometry_id TEXT UNIQUE, name TEXT, notes TEXT, expanded INTEGER,
  PRIMARY KEY(id, parent_group_id, sibling_order), FOREIGN KEY(tool_geometry_id) REFERENCES tool_geometry(id),
  FOREIGN KEY(parent_group_id) REFERENCES tool_tree_entry(id));
CREATE TABLE tool_name_format (id TEXT NOT NULL, tool_type INTEGER NOT NULL UNIQUE, format TEXT NOT NULL,
  PRIMARY KEY(id, tool_type));
INSERT INTO version VALUES (1);
INSERT INTO tool_tree_entry VALUES ('00000000-0000-4000-8000-000000000000', NULL, 0, NULL, 'Kerf', '', 1);
)";
constexpr int kMmPerMinute = 1;  // of the column rate_units

/// An identifier that is the same in every run.
std::string id_of(int number, int kind) { return fmt::format("{:08x}-0000-4000-8000-{:012x}", number, kind); }

/// Values of one row, bound in order.
class Insert {
 public:
  Insert(sqlite3* database, std::string_view sql) : statement_(prepare(database, sql)) {}
  Insert& text(const std::string& value) {
    bound_ = statement_ && bound_ &&
             sqlite3_bind_text(statement_.get(), ++at_, value.c_str(), static_cast<int>(value.size()),
                               SQLITE_TRANSIENT) == SQLITE_OK;
    return *this;
  }
  Insert& number(double value) {
    bound_ = statement_ && bound_ && sqlite3_bind_double(statement_.get(), ++at_, value) == SQLITE_OK;
    return *this;
  }
  Insert& whole(int value) {
    bound_ = statement_ && bound_ && sqlite3_bind_int(statement_.get(), ++at_, value) == SQLITE_OK;
    return *this;
  }
  bool run() { return statement_ && bound_ && sqlite3_step(statement_.get()) == SQLITE_DONE; }

 private:
  Statement statement_;
  int at_ = 0;
  bool bound_ = true;
};

std::optional<VectricType> vectric_type(const LibraryTool& tool) {
  if (tool.shape == "ball") return VectricType::ball;
  if (tool.shape == "square") return VectricType::end_mill;
  if (tool.shape == "bull nose") return VectricType::radiused;
  if (tool.shape == "V") return tool.tip_diameter > 0.0 ? VectricType::engraving : VectricType::vee;
  if (tool.shape == "tapered ball") return VectricType::tapered_ball;
  if (tool.shape == "drill") return VectricType::drill;
  return std::nullopt;
}

bool insert_tool(sqlite3* database, const LibraryTool& tool, VectricType type, int order) {
  constexpr int kGeometry = 1, kCutting = 2, kEntity = 3, kEntry = 4;
  const int number = tool.number.value_or(0);
  const std::string geometry = id_of(number, kGeometry), cutting = id_of(number, kCutting);
  const double tip_radius = type == VectricType::radiused       ? tool.corner_radius
                            : type == VectricType::tapered_ball ? 0.5 * tool.tip_diameter
                                                                : 0.0;
  const std::string name = title_of(tool);
  return Insert(database,
                "INSERT INTO tool_geometry (id, name_format, tool_type, units, diameter, included_angle, "
                "flat_diameter, num_flutes, flute_length, tip_radius) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
             .text(geometry)
             .text(name)
             .whole(static_cast<int>(type))
             .whole(kMetric)
             .number(tool.diameter)
             .number(tool.angle)
             .number(type == VectricType::engraving ? tool.tip_diameter : 0.0)
             .whole(tool.teeth)
             .number(tool.flute)
             .number(tip_radius)
             .run() &&
         Insert(
             database,
             "INSERT INTO tool_cutting_data (id, rate_units, length_units, tool_number) VALUES (?, ?, ?, ?)")
             .text(cutting)
             .whole(kMmPerMinute)
             .whole(kMetric)
             .whole(number)
             .run() &&
         Insert(database,
                "INSERT INTO tool_entity (id, tool_geometry_id, tool_cutting_data_id) VALUES (?, ?, ?)")
             .text(id_of(number, kEntity))
             .text(geometry)
             .text(cutting)
             .run() &&
         Insert(database,
                "INSERT INTO tool_tree_entry (id, parent_group_id, sibling_order, tool_geometry_id, name, "
                "notes) "
                "VALUES (?, '00000000-0000-4000-8000-000000000000', ?, ?, '', '')")
             .text(id_of(number, kEntry))
             .whole(order)
             .text(geometry)
             .run();
}

}  // namespace

void read_vectric_database(std::string_view bytes, LibraryWriter& out) { VectricReader(out).read(bytes); }

std::optional<std::string> vectric_database(const LibraryTools& tools, Diagnostics& diagnostics) {
  sqlite3* opened = nullptr;
  bool good =
      sqlite3_open_v2(":memory:", &opened, SQLITE_OPEN_READWRITE | SQLITE_OPEN_MEMORY, nullptr) == SQLITE_OK;
  const Database database(opened);
  good = good && sqlite3_exec(opened, std::string(kSchema).c_str(), nullptr, nullptr, nullptr) == SQLITE_OK;
  int order = 0;
  for (const LibraryTool& tool : tools)
    if (const auto type = vectric_type(tool)) good = good && insert_tool(opened, tool, *type, order++);
  sqlite3_int64 size = 0;
  const std::unique_ptr<unsigned char, void (*)(void*)> bytes(
      good ? sqlite3_serialize(opened, "main", &size, 0) : nullptr, sqlite3_free);
  if (bytes) return std::string(reinterpret_cast<const char*>(bytes.get()), static_cast<std::size_t>(size));
  diagnostics.error(codes::tool_not_written, {}, "the tool database cannot be made; memory is full");
  return std::nullopt;
}

}  // namespace kerf::detail

#else

namespace kerf::detail {
namespace {

void report_missing(const Origin& where, Diagnostics& diagnostics) {
  diagnostics
      .error(codes::tool_database_missing, where,
             "this Kerf is built without SQLite, which tool databases (.vtdb) need")
      .hint =
      "export the tools in another form, or use a Kerf that was built where libsqlite3-dev is installed";
}

}  // namespace

void read_vectric_database(std::string_view, LibraryWriter& out) {
  report_missing(out.location(0), out.diagnostics());
}

std::optional<std::string> vectric_database(const LibraryTools&, Diagnostics& diagnostics) {
  report_missing({}, diagnostics);
  return std::nullopt;
}

}  // namespace kerf::detail

#endif
