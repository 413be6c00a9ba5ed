// Files of printers and filaments: the built-in ones, the choice by name, writing, and bad input.
#include <cmath>
#include <gtest/gtest.h>

#include "kerf/formats/printer_files.h"

namespace kerf {
namespace {

std::optional<PrinterChoice> chosen(std::string_view name) {
  Diagnostics diagnostics;
  return printer_named(name, {}, diagnostics);
}

TEST(PrinterFile, BuiltInPrintersAreFoundByTheirNames) {
  for (const char* name : {"generic", "ultimaker2plus", "prusa_i3", "ender_3", "cr_10", "bambulab_x1",
                           "toolchanger_T0", "Ender-3", "prusa i3 mk3"})
    EXPECT_TRUE(chosen(name)) << name;
  const auto prusa = chosen("prusa_i3:petg");
  ASSERT_TRUE(prusa);
  EXPECT_EQ(prusa->filament.name, "PETG");
  const PrinterLimits limits = limits_of(*prusa);
  EXPECT_EQ(limits.min_celsius, 215.0);
  EXPECT_DOUBLE_EQ(in_mm3_per_s(limits.max_flow), 10.0);  // of the filament, below that of the hot end
  EXPECT_EQ(limits.bed->high, (Point3{250, 210, 210}));
  EXPECT_EQ(limits.bed->low.z, -INFINITY);
  EXPECT_FALSE(limits_of(*chosen("generic")).bed);
  EXPECT_EQ(limits_of(*chosen("generic")).max_flow, VolumeFlow{});
}

TEST(PrinterFile, UnknownNamesAreErrors) {
  for (const char* name : {"ender_4", "ender_3:PLO", ":PLA", ""}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(printer_named(name, {}, diagnostics)) << name;
    EXPECT_TRUE(diagnostics.has_errors());
  }
}

TEST(PrinterFile, WhatIsWrittenIsReadBack) {
  for (const PrinterProfile& printer : built_in_printers().printers)
    for (const FilamentProfile& filament : built_in_printers().filaments) {
      PrinterChoice choice{printer, filament};
      choice.printer.start = {"M104 S{nozzle}", "M117 \"a\\b\"\t\x01"};
      choice.printer.end = {"M84"};
      Diagnostics diagnostics;
      const PrinterTable table = read_printer_file(write_printer_file(choice), "p.toml", diagnostics);
      ASSERT_FALSE(diagnostics.has_errors()) << to_string(diagnostics.list().front());
      ASSERT_EQ(table.printers.size(), 1u);
      const PrinterProfile& read = table.printers.front();
      EXPECT_EQ(read.start, choice.printer.start);
      EXPECT_EQ(read.end, choice.printer.end);
      EXPECT_EQ(read.firmware, printer.firmware);
      EXPECT_EQ(read.bed.has_value(), printer.bed.has_value());
      if (read.bed) {
        EXPECT_EQ(*read.bed, *printer.bed);
      }
      EXPECT_EQ(read.planner.jerk, printer.planner.jerk);
      EXPECT_EQ(read.has_planner, printer.has_planner);
      EXPECT_DOUBLE_EQ(read.max_flow.raw(), printer.max_flow.raw());
      EXPECT_DOUBLE_EQ(table.filaments.front().min_nozzle, filament.min_nozzle);
    }
}

TEST(PrinterFile, BadFilesAreErrors) {
  const auto refused = [](const std::string& text) {
    Diagnostics diagnostics;
    read_printer_file("[[printer]]\nname = \"a\"\n" + text, "p.toml", diagnostics);
    return diagnostics.has_errors();
  };
  EXPECT_FALSE(refused(""));
  EXPECT_TRUE(refused("[[printer"));
  EXPECT_TRUE(refused("size = 3"));
  EXPECT_TRUE(refused("firmware = \"sailfish\""));
  EXPECT_TRUE(refused("firmware = 3"));
  EXPECT_TRUE(refused("bed = [0, 0, 220]"));
  EXPECT_TRUE(refused("bed = 220"));
  EXPECT_TRUE(refused("bed = [0, 0, nan, 220]"));
  EXPECT_TRUE(refused("max_flow = -1"));
  EXPECT_TRUE(refused("max_flow = inf"));
  EXPECT_TRUE(refused("filament = 0"));
  EXPECT_TRUE(refused("jerk = [1, 2, 3, \"4\"]"));
  EXPECT_TRUE(refused("start = \"G28\""));
  EXPECT_TRUE(refused("start = [\"G28\\nG1 X1\"]"));
  EXPECT_TRUE(refused("[[printer]]\nfirmware = \"plain\""));  // without a name
  EXPECT_TRUE(refused("[other]"));
}

TEST(PrinterFile, APostHasTheFirmwareTheTemperaturesAndTheLines) {
  auto choice = *chosen("ender_3:PLA");
  choice.printer.start = {"G28", "M109 S{nozzle}"};
  EXPECT_EQ(
      post_of(choice),
      "base = \"marlin\"\nname = \"ender_3\"\n[printer]\nfilament = 1.75\n[variables]\nnozzle = 210\n"
      "bed = 60\n[templates]\nheader = [\n  \"G28\",\n  \"M109 S{nozzle}\",\n  \"{units}\",\n  \"G90\",\n"
      "  \"{extruder}\",\n  \"{extruder_zero}\",\n]\n");
}

}  // namespace
}  // namespace kerf
