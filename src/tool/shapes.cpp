// Names and parameters of the shapes: one table for readers, writers, checks and messages.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/names.h"

#include "kerf/tool/tool.h"

namespace kerf {
namespace {

using Kind = ShapeParameter::Kind;
using Need = ShapeParameter::Need;
using Parameters = std::vector<ShapeParameter>;

template <class S>
Length measure_of(Length S::*);
template <class S>
Angle measure_of(Angle S::*);
template <class S, class T>
S shape_of(T S::*);

/// A parameter that reads and writes the given member of its shape.
template <auto member>
ShapeParameter parameter(std::string_view name, Need need = Need::required) {
  using Shape = decltype(shape_of(member));
  if constexpr (std::is_same_v<decltype(measure_of(member)), Angle>) {
    return {name, Kind::angle, need, [](const ToolShape& s) { return (std::get<Shape>(s).*member).deg(); },
            [](ToolShape& s, double value) { std::get<Shape>(s).*member = degrees(value); }};
  } else {
    return {name, Kind::length, need, [](const ToolShape& s) { return (std::get<Shape>(s).*member).mm(); },
            [](ToolShape& s, double value) { std::get<Shape>(s).*member = mm(value); }};
  }
}

constexpr Need kOptional = Need::optional;

template <class S>
Parameters corner_mill_parameters() {
  return {parameter<&S::diameter>("diameter"), parameter<&S::flute>("flute", kOptional),
          parameter<&S::corner_radius>("corner_radius")};
}

template <class S>
Parameters round_mill_parameters() {
  return {parameter<&S::diameter>("diameter"), parameter<&S::flute>("flute", kOptional)};
}

using shape::CentreDrill;
using shape::Chamfer;
using shape::CornerRounding;
using shape::Dovetail;
using shape::Drill;
using shape::FlatGroove;
using shape::Keyhole;
using shape::Lollipop;
using shape::Roundover;
using shape::TaperedBall;
using shape::ThreadMill;
using shape::TSlot;
using shape::Vee;

struct Entry {
  std::string_view name;
  ToolShape shape;
  Parameters parameters;
};

std::vector<Entry> plain_entries() {
  return {
      {"square", shape::Square{}, round_mill_parameters<shape::Square>()},
      {"ball", shape::Ball{}, round_mill_parameters<shape::Ball>()},
      {"bull nose", shape::BullNose{}, corner_mill_parameters<shape::BullNose>()},
      {"bowl", shape::Bowl{}, corner_mill_parameters<shape::Bowl>()},
      {"V",
       Vee{},
       {parameter<&Vee::diameter>("diameter"), parameter<&Vee::flute>("flute", kOptional),
        parameter<&Vee::included_angle>("angle"), parameter<&Vee::tip_diameter>("tip_diameter", kOptional),
        parameter<&Vee::tip_radius>("tip_radius", kOptional)}},
      {"tapered ball",
       TaperedBall{},
       {parameter<&TaperedBall::diameter>("diameter"), parameter<&TaperedBall::flute>("flute", kOptional),
        parameter<&TaperedBall::included_angle>("angle", kOptional),
        parameter<&TaperedBall::tip_diameter>("tip_diameter")}},
      {"drill",
       Drill{},
       {parameter<&Drill::diameter>("diameter"), parameter<&Drill::flute>("flute", kOptional),
        parameter<&Drill::point_angle>("angle", kOptional)}},
      {"centre drill",
       CentreDrill{},
       {parameter<&CentreDrill::pilot_diameter>("pilot_diameter"),
        parameter<&CentreDrill::pilot_length>("pilot_length"),
        parameter<&CentreDrill::pilot_angle>("pilot_angle"), parameter<&CentreDrill::diameter>("diameter"),
        parameter<&CentreDrill::flute>("flute", kOptional), parameter<&CentreDrill::body_angle>("angle")}},
      {"flat groove",
       FlatGroove{},
       {parameter<&FlatGroove::diameter>("diameter"), parameter<&FlatGroove::flute>("flute"),
        parameter<&FlatGroove::tip_diameter>("tip_diameter")}},
      {"chamfer",
       Chamfer{},
       {parameter<&Chamfer::diameter>("diameter"), parameter<&Chamfer::flute>("flute", kOptional),
        parameter<&Chamfer::included_angle>("angle"),
        parameter<&Chamfer::tip_diameter>("tip_diameter", kOptional)}},
  };
}

std::vector<Entry> undercut_entries() {
  return {
      {"keyhole",
       Keyhole{},
       {parameter<&Keyhole::diameter>("diameter"), parameter<&Keyhole::head>("head"),
        parameter<&Keyhole::neck_diameter>("neck_diameter"), parameter<&Keyhole::flute>("flute", kOptional)}},
      {"dovetail",
       Dovetail{},
       {parameter<&Dovetail::diameter>("diameter"), parameter<&Dovetail::flute>("flute"),
        parameter<&Dovetail::side_angle>("angle")}},
      {"roundover",
       Roundover{},
       {parameter<&Roundover::tip_diameter>("tip_diameter", kOptional),
        parameter<&Roundover::radius>("radius"), parameter<&Roundover::flute>("flute", kOptional)}},
      {"thread mill",
       ThreadMill{},
       {parameter<&ThreadMill::minor_diameter>("minor_diameter"),
        parameter<&ThreadMill::major_diameter>("major_diameter"),
        parameter<&ThreadMill::cut_height>("cut_height"),
        parameter<&ThreadMill::length>("length", kOptional)}},
      {"lollipop",
       Lollipop{},
       {parameter<&Lollipop::diameter>("diameter"), parameter<&Lollipop::neck_diameter>("neck_diameter"),
        parameter<&Lollipop::flute>("flute", kOptional)}},
      {"T-slot",
       TSlot{},
       {parameter<&TSlot::diameter>("diameter"), parameter<&TSlot::thickness>("thickness"),
        parameter<&TSlot::neck_diameter>("neck_diameter"), parameter<&TSlot::flute>("flute", kOptional)}},
      {"corner rounding",
       CornerRounding{},
       {parameter<&CornerRounding::tip_diameter>("tip_diameter", kOptional),
        parameter<&CornerRounding::diameter>("diameter"), parameter<&CornerRounding::radius>("radius"),
        parameter<&CornerRounding::height>("height", kOptional),
        parameter<&CornerRounding::flute>("flute", kOptional)}},
      {"drawn", shape::Drawn{}, {}},
  };
}

/// By the variant's index.
const std::vector<Entry>& entries() {
  static const std::vector<Entry> table = [] {
    std::vector<Entry> all = plain_entries();
    for (Entry& entry : undercut_entries()) all.push_back(std::move(entry));
    std::sort(all.begin(), all.end(),
              [](const Entry& a, const Entry& b) { return a.shape.index() < b.shape.index(); });
    return all;
  }();
  return table;
}

struct OtherName {
  std::string_view other, name;  // folded
};
constexpr std::array kOtherNames{
    OtherName{"flat", "square"},
    OtherName{"endmill", "square"},
    OtherName{"flatendmill", "square"},
    OtherName{"squareendmill", "square"},
    OtherName{"oflute", "square"},
    OtherName{"ballnose", "ball"},
    OtherName{"ballendmill", "ball"},
    OtherName{"bull", "bullnose"},
    OtherName{"bullnoseendmill", "bullnose"},
    OtherName{"bowlandtray", "bowl"},
    OtherName{"vee", "v"},
    OtherName{"vbit", "v"},
    OtherName{"vgroove", "v"},
    OtherName{"taperedballnose", "taperedball"},
    OtherName{"taperball", "taperedball"},
    OtherName{"cove", "roundover"},
    OtherName{"threadmilling", "threadmill"},
    OtherName{"spotdrill", "drill"},
    OtherName{"flatv", "flatgroove"},
    OtherName{"flatvgroove", "flatgroove"},
    OtherName{"chamfermill", "chamfer"},
    OtherName{"cornerround", "cornerrounding"},
    OtherName{"profile", "drawn"},
};

/// Flutes of common router bits: diameter and flute in mm.
constexpr std::array<std::array<double, 2>, 4> kUsualFlutes{
    {{0.79375, 1.5875}, {1.5875, 6.35}, {3.175, 12.7}, {6.35, 19.05}}};
constexpr double kPrintedDiameter = 0.02;  // mm: "3.17" and "0.80" are the 1/8" and the 1/32" mill

}  // namespace

std::string_view name_of(const ToolShape& shape) { return entries()[shape.index()].name; }

const std::vector<ShapeParameter>& parameters_of(const ToolShape& shape) {
  return entries()[shape.index()].parameters;
}

std::optional<ToolShape> shape_named(std::string_view name) {
  std::string folded = fold_name(name);
  for (const OtherName& other : kOtherNames) {
    if (folded == other.other) folded = other.name;
  }
  for (const Entry& entry : entries()) {
    if (folded == fold_name(entry.name)) return entry.shape;
  }
  return std::nullopt;
}

const std::vector<std::string>& shape_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Entry& entry : entries()) all.emplace_back(entry.name);
    return all;
  }();
  return names;
}

Length usual_flute(Length diameter) {
  for (const auto& [usual, flute] : kUsualFlutes) {
    if (std::abs(diameter.mm() - usual) <= kPrintedDiameter) return mm(flute);
  }
  return 3.0 * diameter;
}

}  // namespace kerf
