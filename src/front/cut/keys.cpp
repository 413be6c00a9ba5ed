// The table of keys of an operation.
#include "front/cut/keys.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/names.h"
#include "front/cut/values.h"

#include "kerf/base/limits.h"

namespace kerf {

const std::vector<std::string>& cut_kind_names() {
  static const std::vector<std::string> names{
      "pocket",       "contour",       "engrave",         "face",       "drill",       "bore",
      "keyhole",      "slot",          "trochoidal-slot", "thread",     "countersink", "vcarve",
      "vcarve-floor", "raster",        "waterline",       "project",    "laser",       "laser-cut",
      "laser-fill",   "laser-picture", "laser-test",      "laser-frame"};
  return names;
}

namespace {

using namespace cut_detail;
using Operation = CutOperation;
using Type = CutKey::Type;

constexpr Names<CutDirection, 2> kDirections{
    {{{"climb", CutDirection::climb}, {"conventional", CutDirection::conventional}}}};
constexpr Names<EntryKind, 3> kEntries{
    {{{"helix", EntryKind::helix}, {"ramp", EntryKind::ramp}, {"plunge", EntryKind::plunge}}}};
constexpr Names<PocketPattern, 4> kPatterns{{{{"offset", PocketPattern::offset},
                                              {"spiral", PocketPattern::spiral},
                                              {"zigzag", PocketPattern::zigzag},
                                              {"adaptive", PocketPattern::adaptive}}}};
constexpr Names<Combining, 3> kCombinings{
    {{{"drawn", Combining::drawn}, {"nested", Combining::nested}, {"united", Combining::united}}}};
constexpr Names<ContourSide, 2> kSides{
    {{{"outside", ContourSide::outside}, {"inside", ContourSide::inside}}}};
constexpr Names<InlayPart, 2> kParts{{{{"pocket", InlayPart::pocket}, {"plug", InlayPart::plug}}}};
constexpr Names<ThreadHand, 2> kHands{{{{"right", ThreadHand::right}, {"left", ThreadHand::left}}}};
constexpr Names<LeadKind, 2> kLeads{{{{"arc", LeadKind::arc}, {"line", LeadKind::line}}}};
constexpr Names<TabShape, 2> kTabs{
    {{{"rectangular", TabShape::rectangular}, {"triangular", TabShape::triangular}}}};
constexpr Names<LaserMode, 2> kBeams{{{{"dynamic", LaserMode::dynamic}, {"constant", LaserMode::constant}}}};
constexpr Names<PictureTones, 2> kTones{{{{"grey", PictureTones::grey}, {"dither", PictureTones::dither}}}};
constexpr Names<bool, 2> kScans{{{{"both", false}, {"one-way", true}}}};
constexpr Names<bool, 2> kYesNo{{{{"no", false}, {"yes", true}}}};
constexpr Names<DrillKind, 6> kCycles{{{{"plain", DrillKind::plain},
                                        {"dwell", DrillKind::dwell},
                                        {"peck", DrillKind::peck},
                                        {"chip-break", DrillKind::chip_break},
                                        {"bore", DrillKind::bore},
                                        {"dwell-bore", DrillKind::dwell_bore}}}};

bool set_tool(int& target, const CutValue& value) {
  const auto given = number(value);
  if (!given || *given < 0 || *given > limits::kMaxToolNumber || *given != std::floor(*given)) return false;
  target = static_cast<int>(*given);
  return true;
}
bool set_count(int& target, const CutValue& value, int maximum) {
  const auto given = number(value);
  if (!given || !(*given >= 1) || *given > maximum || *given != std::floor(*given)) return false;
  target = static_cast<int>(*given);
  return true;
}
bool set_speed(Operation& o, const CutValue& value) {
  const auto given = number(value);
  if (!given || !(*given >= 0.0) || *given > limits::kMaxSpeed) return false;
  o.speed = rpm(*given);
  return true;
}
bool set_dwell(Operation& o, const CutValue& value) {
  const auto given = number(value);
  if (!given || !(*given >= 0.0) || *given > limits::kMaxDwellSeconds) return false;
  o.dwell = seconds(*given);
  return true;
}

double plain(double v) { return v; }
double percent(double v) { return v / 100.0; }

/// Functions that store a number made by `make`, and a value of a table of names.
#define KERF_NUMBER(expression, make)       \
  [](Operation& o, const CutValue& v) {     \
    const auto given = number(v);           \
    if (given) o.expression = make(*given); \
    return given.has_value();               \
  }
#define KERF_NAMED(names, expression) \
  [](Operation& o, const CutValue& v) { return set_named(names, o.expression, v); }

/// What is cut, how deep, and how fast.
std::vector<CutKey> frame_keys() {
  return {
      {"name", Type::text, "", "name of the operation, in messages and in the program", "\"left pocket\"",
       [](Operation& o, const CutValue& v) { return set_text(o.name, v); }},
      {"layers", Type::list, "", "layers of the drawing whose shapes are used; none: all", "[\"CUT\"]",
       [](Operation& o, const CutValue& v) { return set_list(o.layers, v); }},
      {"outlines", Type::list, "", "names of the outlines that are used, as kerf outline reports them",
       "[\"CUT.1\"]", [](Operation& o, const CutValue& v) { return set_list(o.outlines, v); }},
      {"tool", Type::number, "", "number of the tool", "1",
       [](Operation& o, const CutValue& v) { return set_tool(o.tool, v); }},
      {"rpm", Type::number, "rpm", "spindle speed, clockwise", "16000", set_speed},
      {"top", Type::number, "mm", "Z of the surface of the material", "0",
       [](Operation& o, const CutValue& v) {
         o.top_given = true;
         return set_number(o.cut.top, v, plain);
       }},
      {"depth", Type::number, "mm", "below the surface", "6", KERF_NUMBER(cut.depth, mm)},
      {"stepdown", Type::number, "mm", "maximum depth of a pass; 0: one pass", "2",
       KERF_NUMBER(cut.stepdown, mm)},
      {"stepover", Type::number, "", "distance of paths as a fraction of the diameter of the tool", "0.4",
       KERF_NUMBER(stepover, plain)},
      {"feed", Type::number, "mm/min", "feed of cuts; without it, it is chosen by the chip load in material",
       "900", KERF_NUMBER(cut.feed, mm_per_min)},
      {"material", Type::text, "", "for a feed that is not given: MDF, plywood, softwood, aluminium ...",
       "\"MDF\"", [](Operation& o, const CutValue& v) { return set_text(o.material, v); }},
      {"machine", Type::text, "", "file of the machine whose limits a chosen feed keeps", "\"router.toml\"",
       [](Operation& o, const CutValue& v) { return set_text(o.machine, v); }},
      {"plunge", Type::number, "mm/min", "maximum feed downwards; 0: half of feed", "300",
       KERF_NUMBER(cut.plunge, mm_per_min)},
      {"retract", Type::number, "mm", "Z of rapids between cuts", "5", KERF_NUMBER(retract, plain)},
      {"clearance", Type::number, "mm", "above material, where rapids downwards end", "0.5",
       KERF_NUMBER(cut.clearance, mm)},
      {"allowance", Type::number, "mm", "left on walls for a finishing pass", "0",
       KERF_NUMBER(cut.allowance, mm)},
  };
}

/// Directions, entries and patterns.
std::vector<CutKey> way_keys() {
  return {
      {"direction", Type::text, "climb, conventional", "direction along walls, of a clockwise spindle",
       "\"climb\"", KERF_NAMED(kDirections, cut.direction)},
      {"entry", Type::text, "helix, ramp, plunge", "how the tool enters the material", "\"helix\"",
       KERF_NAMED(kEntries, cut.entry.kind)},
      {"entry-angle", Type::number, "degrees", "maximum descent of a ramp or helix", "3",
       KERF_NUMBER(cut.entry.angle, degrees)},
      {"helix-radius", Type::number, "mm",
       "radius of a helix, of the tool's axis; 0: 0.45 times the diameter", "0",
       KERF_NUMBER(cut.entry.radius, mm)},
      {"pattern", Type::text, "offset, spiral, zigzag, adaptive", "paths of a pocket", "\"offset\"",
       KERF_NAMED(kPatterns, pattern)},
      {"combine", Type::text, "drawn, nested, united",
       "overlapping shapes: as the drawing fills them, those inside others as holes, or all united",
       "\"drawn\"", KERF_NAMED(kCombinings, combining)},
      {"engagement", Type::number, "degrees",
       "maximum engagement angle of an adaptive pocket or trochoidal slot", "60",
       KERF_NUMBER(engagement, degrees)},
      {"angle", Type::number, "degrees", "direction of the lines of a zigzag or of facing, from +X", "0",
       KERF_NUMBER(angle, degrees)},
      {"side", Type::text, "outside, inside", "side of the outlines that a contour is cut on", "\"outside\"",
       KERF_NAMED(kSides, side)},
  };
}

/// Of walls: finishing passes, leads, tabs.
std::vector<CutKey> wall_keys() {
  return {
      {"finish", Type::number, "mm", "left on walls, and removed by a last pass at the full depth", "0",
       KERF_NUMBER(finish, mm)},
      {"lead", Type::number, "mm", "radius or length of the lead-in and lead-out of a contour; 0: none", "0",
       KERF_NUMBER(lead, mm)},
      {"lead-out", Type::number, "mm", "size of the lead-out, where it differs", "0",
       KERF_NUMBER(lead_out, mm)},
      {"lead-kind", Type::text, "arc, line", "arcs tangent to the wall, or lines square to it", "\"arc\"",
       KERF_NAMED(kLeads, lead_kind)},
      {"overlap", Type::number, "mm", "how far a contour continues beyond its start", "0",
       KERF_NUMBER(overlap, mm)},
      {"tab-height", Type::number, "mm", "height of tabs above the bottom; 0: no tabs", "0",
       KERF_NUMBER(tabs.height, mm)},
      {"tab-length", Type::number, "mm", "length of tabs; 0: the diameter of the tool", "6",
       KERF_NUMBER(tabs.length, mm)},
      {"tabs", Type::number, "", "number of tabs on each contour", "4",
       [](Operation& o, const CutValue& v) { return set_count(o.tabs.count, v, 1000); }},
      {"tab-spacing", Type::number, "mm", "distance of tabs; 0: by their number", "0",
       KERF_NUMBER(tabs.spacing, mm)},
      {"tab-shape", Type::text, "rectangular, triangular", "shape of tabs", "\"rectangular\"",
       KERF_NAMED(kTabs, tabs.shape)},
  };
}

/// Of holes, slots and threads.
std::vector<CutKey> hole_keys() {
  return {
      {"length", Type::number, "mm", "length of a keyhole, from its entry in the direction of angle", "12",
       KERF_NUMBER(length, mm)},
      {"slot-clearance", Type::number, "mm", "by which a keyhole is wider than its tool", "0.2",
       KERF_NUMBER(slot_clearance, mm)},
      {"width", Type::number, "mm",
       "width of a slot where the tool is widest, 0: the diameter; of a trochoidal slot", "0",
       KERF_NUMBER(width, mm)},
      {"pitch", Type::number, "mm", "pitch of a thread", "1.25", KERF_NUMBER(thread.pitch, mm)},
      {"hand", Type::text, "right, left", "hand of a thread", "\"right\"", KERF_NAMED(kHands, thread.hand)},
      {"thread-passes", Type::number, "", "number of passes of a thread, deeper each time", "1",
       [](Operation& o, const CutValue& v) { return set_count(o.thread.passes, v, 100); }},
      {"thread-teeth", Type::number, "", "number of teeth of the thread mill, one pitch apart", "1",
       [](Operation& o, const CutValue& v) { return set_count(o.thread.teeth, v, 1000); }},
      {"cone-angle", Type::number, "degrees", "angle of a countersink between its sides", "90",
       KERF_NUMBER(cone, degrees)},
      {"cycle", Type::text, "plain, dwell, peck, chip-break, bore, dwell-bore", "cycle of drilled holes",
       "\"peck\"", KERF_NAMED(kCycles, cycle)},
      {"peck", Type::number, "mm", "depth of a peck", "2", KERF_NUMBER(peck, mm)},
      {"dwell", Type::number, "s", "at the bottom of a drilled hole", "0", set_dwell},
  };
}

/// Of V-carving and inlays.
std::vector<CutKey> carving_keys() {
  return {
      {"part", Type::text, "pocket, plug", "part of an inlay: what is carved, or what fits into it, mirrored",
       "\"pocket\"", KERF_NAMED(kParts, part)},
      {"glue-gap", Type::number, "mm", "between the face of a plug and the floor of its pocket", "0.3",
       KERF_NUMBER(glue_gap, mm)},
      {"base-gap", Type::number, "mm", "between the surfaces around a plug and around its pocket", "0.5",
       KERF_NUMBER(base_gap, mm)},
      {"margin", Type::number, "mm", "width of the floor around a plug; 0: twice the diameter", "0",
       KERF_NUMBER(margin, mm)},
      {"rest-tool", Type::number, "",
       "number of the tool of the same operation before: only what it left is cut", "2",
       [](Operation& o, const CutValue& v) {
         int tool = 0;
         if (!set_tool(tool, v)) return false;
         o.rest_tool = tool;
         return true;
       }},
      {"carve-tool", Type::number, "", "number of the tool that carves the walls of a floor", "2",
       [](Operation& o, const CutValue& v) { return set_tool(o.carve_tool, v); }},
  };
}

/// Of lasers.
std::vector<CutKey> laser_keys() {
  return {
      {"power", Type::number, "%", "power of the laser", "80", KERF_NUMBER(beam.laser.power, percent)},
      {"max-s", Type::number, "S", "the S of full power, $30 in GRBL", "1000",
       KERF_NUMBER(beam.laser.full_s, plain)},
      {"beam", Type::text, "dynamic, constant", "M4, whose power follows the speed, or M3", "\"dynamic\"",
       KERF_NAMED(kBeams, beam.laser.mode)},
      {"passes", Type::number, "", "number of passes", "1",
       [](Operation& o, const CutValue& v) { return set_count(o.beam.laser.passes, v, 1000); }},
      {"kerf", Type::number, "mm", "width of the slot that the beam leaves", "0.15",
       KERF_NUMBER(beam.kerf, mm)},
      {"interval", Type::number, "mm", "distance of scan lines, and size of a picture's pixels", "0.1",
       KERF_NUMBER(beam.scan.interval, mm)},
      {"overscan", Type::number, "mm", "length of scan lines beyond both ends, with power 0", "2",
       KERF_NUMBER(beam.scan.overscan, mm)},
      {"scan", Type::text, "both, one-way", "directions of scan lines", "\"both\"",
       KERF_NAMED(kScans, beam.scan.one_way)},
      {"tones", Type::text, "grey, dither", "tones of a picture: power per pixel, or points at full power",
       "\"grey\"", KERF_NAMED(kTones, beam.tones)},
      {"min-power", Type::number, "%", "power of the lightest tone of a picture that is not white", "0",
       KERF_NUMBER(beam.min_power, percent)},
      {"gamma", Type::number, "", "exponent of the darkness of a picture", "1",
       KERF_NUMBER(beam.gamma, plain)},
      {"negative", Type::text, "no, yes", "picture in negative: white is burnt instead of black", "\"no\"",
       KERF_NAMED(kYesNo, beam.negative)},
  };
}

/// Of test grids.
std::vector<CutKey> test_keys() {
  return {
      {"rows", Type::number, "", "rows of a test grid, from feed at the top to feed-to", "5",
       [](Operation& o, const CutValue& v) { return set_count(o.beam.rows, v, 1000); }},
      {"feed-to", Type::number, "mm/min", "feed of the last row of a test grid; 0: as feed", "400",
       KERF_NUMBER(beam.feed_to, mm_per_min)},
      {"columns", Type::number, "", "columns of a test grid, from power on the left to power-to", "5",
       [](Operation& o, const CutValue& v) { return set_count(o.beam.columns, v, 1000); }},
      {"power-to", Type::number, "%", "power of the last column of a test grid", "20",
       [](Operation& o, const CutValue& v) {
         return set_number(o.beam.power_to, v, percent) && o.beam.power_to >= 0.0;
       }},
      {"cell-width", Type::number, "mm", "width of a cell of a test grid", "10",
       KERF_NUMBER(beam.cell_width, mm)},
      {"cell-height", Type::number, "mm", "height of a cell of a test grid; 0: a cell is one line", "10",
       KERF_NUMBER(beam.cell_height, mm)},
      {"gap", Type::number, "mm", "between the cells of a test grid", "4", KERF_NUMBER(beam.gap, mm)},
      {"label-height", Type::number, "mm", "height of the feeds and powers beside a test grid; 0: none", "3",
       KERF_NUMBER(beam.label_height, mm)},
  };
}

/// Of meshes.
std::vector<CutKey> surface_keys() {
  return {
      {"line-distance", Type::number, "mm", "distance of the lines of a raster; 0: by stepover", "0",
       KERF_NUMBER(line_distance, mm)},
      {"overhang", Type::number, "mm", "how far the axis goes beyond the mesh where no area is selected", "0",
       KERF_NUMBER(overhang, mm)},
      {"rest-thickness", Type::number, "mm", "thickness of what rest-tool left: what is thinner is not cut",
       "0.1", KERF_NUMBER(rest_thickness, mm)},
      {"tolerance", Type::number, "mm", "how far above a mesh the path may be", "0.01",
       KERF_NUMBER(surface_tolerance, mm)},
  };
}

}  // namespace

const std::vector<CutKey>& cut_keys() {
  static const std::vector<CutKey> keys = [] {
    std::vector<CutKey> all;
    for (const auto& part : {frame_keys(), way_keys(), wall_keys(), hole_keys(), carving_keys(),
                             surface_keys(), laser_keys(), test_keys()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return keys;
}

bool cuts_mesh(CutKind kind) {
  return kind == CutKind::raster || kind == CutKind::waterline || kind == CutKind::project;
}

namespace cut_detail {

std::optional<CutKind> kind_named(std::string_view name) {
  const auto& names = cut_kind_names();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (fold_name(names[i]) == fold_name(name)) return static_cast<CutKind>(i);
  return std::nullopt;
}

const CutKey* key_named(std::string_view name) {
  for (const CutKey& key : cut_keys())
    if (key.name == name) return &key;
  return nullptr;
}

bool is_required(CutKind kind, std::string_view key) {
  if (is_laser(kind)) return key == "feed" || (key == "power" && kind != CutKind::laser_frame);
  if (key == "depth") return kind != CutKind::vcarve && kind != CutKind::raster && kind != CutKind::waterline;
  if (key == "carve-tool") return kind == CutKind::vcarve_floor;
  if (key == "width") return kind == CutKind::trochoidal_slot;
  return key == "tool";
}

namespace {

bool any_of(const std::vector<CutKey>& keys, std::string_view name) {
  return std::any_of(keys.begin(), keys.end(), [&](const CutKey& key) { return key.name == name; });
}

bool applies_to_laser(CutKind kind, std::string_view key) {
  using enum CutKind;
  if (key == "name" || key == "feed" || key == "power" || key == "max-s" || key == "beam" || key == "passes")
    return true;
  if (key == "layers" || key == "outlines") return kind != laser_test;
  if (key == "side" || key == "kerf" || key == "overlap" || key.starts_with("lead")) return kind == laser_cut;
  if (key == "angle") return kind == laser_fill;
  if (key == "interval" || key == "overscan" || key == "scan")
    return kind == laser_fill || kind == laser_picture || kind == laser_test;
  if (key == "tones" || key == "min-power" || key == "gamma" || key == "negative")
    return kind == laser_picture;
  return kind == laser_test && any_of(test_keys(), key);
}

}  // namespace

bool applies(CutKind kind, std::string_view key) {
  if (key == "material" || key == "machine") return !is_laser(kind);
  if (is_laser(kind)) return applies_to_laser(kind, key);
  if (any_of(laser_keys(), key) || any_of(test_keys(), key)) return false;
  const auto any = [&](std::initializer_list<CutKind> kinds) {
    for (const CutKind k : kinds)
      if (k == kind) return true;
    return false;
  };
  using enum CutKind;
  if (key == "line-distance" || key == "overhang") return kind == raster;
  if (key == "tolerance") return cuts_mesh(kind);
  if (key == "pattern") return any({pocket, vcarve_floor});
  if (key == "combine") return any({pocket, contour, face, vcarve, vcarve_floor, raster});
  if (key == "engagement") return any({pocket, vcarve_floor, trochoidal_slot});
  if (key == "rest-tool") return any({pocket, vcarve_floor, raster, waterline});
  if (key == "rest-thickness") return any({raster, waterline});
  if (key == "carve-tool") return any({vcarve_floor});
  if (key == "part" || key == "glue-gap" || key == "base-gap" || key == "margin")
    return any({vcarve, vcarve_floor});
  if (key == "length" || key == "slot-clearance") return any({keyhole});
  if (key == "width") return any({slot, trochoidal_slot});
  if (key == "cone-angle") return any({countersink});
  if (key == "pitch" || key == "hand" || key.starts_with("thread")) return any({thread});
  if (key == "side") return any({contour, thread});
  if (key == "overlap" || key.starts_with("lead") || key.starts_with("tab")) return any({contour});
  if (key == "finish") return any({contour, pocket, vcarve_floor});
  if (key == "cycle" || key == "peck" || key == "dwell") return any({drill});
  if (key == "stepover") return any({pocket, face, bore, slot, trochoidal_slot, vcarve_floor, raster});
  if (key == "angle") return any({pocket, face, keyhole, vcarve_floor, raster});
  if (key == "allowance") return any({pocket, contour, bore, vcarve_floor, raster, waterline});
  if (key == "direction")
    return kind != drill && kind != engrave && kind != face && kind != raster && kind != project;
  if (key == "plunge") return kind != drill;
  if (key == "entry-angle" && cuts_mesh(kind)) return false;
  if (key == "stepdown" || key == "entry-angle")
    return kind != drill && kind != keyhole && kind != slot && kind != thread && kind != countersink;
  if (key == "entry" || key == "helix-radius")
    return any({pocket, contour, engrave, face, vcarve, vcarve_floor});
  return true;
}

}  // namespace cut_detail

bool cut_key_applies(std::string_view kind, std::string_view key) {
  const auto known = cut_detail::kind_named(kind);
  return known && cut_detail::applies(*known, key);
}

bool cut_key_is_required(std::string_view kind, std::string_view key) {
  const auto known = cut_detail::kind_named(kind);
  return known && cut_detail::is_required(*known, key);
}

}  // namespace kerf
