// Machine files of both kinds, material files: values, and every fault with its location.
#include <gtest/gtest.h>

#include "base/codes/files.h"

#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

std::vector<Code> codes_of(std::string_view text) {
  Diagnostics diagnostics;
  read_machine_file(text, "m", diagnostics);
  std::vector<Code> codes;
  for (const Diagnostic& d : diagnostics.list()) codes.push_back(d.code);
  return codes;
}
using Codes = std::vector<Code>;

constexpr const char* kAnswer =
    "Grbl 1.1h ['$' for help]\n$1=25\n$11=0.020\n$12=0.003 (arc tolerance, mm)\n$20=1\n$30=24000\n$32=1\n"
    "$100=80\n$101=80.5\n$102=400\n$110=5000.000 (x max rate)\r\n$111=4000\n$112=800\n$120=300\n$121=250\n"
    "$122=60\n$130=800\n$131=400\n$132=80\nok\n";

TEST(MachineFile, GrblsSettings) {
  Diagnostics diagnostics;
  const auto machine = read_machine_file(kAnswer, "grbl.txt", diagnostics);
  ASSERT_TRUE(machine);
  EXPECT_TRUE(diagnostics.list().empty());
  EXPECT_EQ(machine->controller, Controller::grbl);
  EXPECT_DOUBLE_EQ(machine->rates[1].mm_per_min(), 4000);
  EXPECT_DOUBLE_EQ(in_mm_per_s2(machine->accelerations[2]), 60);
  EXPECT_DOUBLE_EQ(machine->junction_deviation.mm(), 0.02);
  EXPECT_DOUBLE_EQ(machine->arc_tolerance.mm(), 0.003);
  EXPECT_DOUBLE_EQ(machine->steps_per_mm[1], 80.5);
  EXPECT_DOUBLE_EQ(machine->stop_time.seconds(), 0.025);
  EXPECT_EQ(machine->laser, LaserDrive::follows);
  ASSERT_TRUE(machine->travel[0]);
  EXPECT_DOUBLE_EQ(machine->travel[0]->length(), 800);
  EXPECT_EQ(machine->fastest_spindle, rpm(24000));
}

/// Rates of X, Y, Z in mm/min, in the layouts in which senders and terminals store the answer to $$.
TEST(MachineFile, GrblsSettingsInAnyLayout) {
  for (const char* text :
       {"$110=500 $111=600 $112=70", "[12:01:02] $110=500\n[12:01:02] $111=600\n[12:01:03] $112=70\n",
        "< $110=500\n< $111=600\n>>> $112=70\n", "$110\t500\n$111\t=\t600\n\t$112=70\n",
        "\"$110\",\"500\"\r\n\"$111\",\"600\"\r\n\"$112\",\"70\"\r\n", "$110=500\r$111=600\r$112=70\r",
        "2026-01-02 08:00:01.250 RX: $110=500 (x max rate, was $110=300)\n$111=600 ; was $111=1\n"
        "log #3: $112=70 # $112=5\n# $110=1\n; $110=2\n",
        "$110=500;$111=600;$112=70", "| $110 | 500 |\n| $111 | 600 |\n| $112 | 70 |\n",
        "{\"$110\":\"500\", \"$111\": 600, \"$112\":\"70.000\"}",
        "[{\"setting\":\"$110\",\"value\":\"500\"},{\"value\":600,\"setting\":\"$111\"},{\"id\":\"$112\","
        "\"value\":70}]",
        "\xef\xbb\xbf{\"grbl\": {\"settings\": {\"110\": 500, \"111\": {\"value\": 600, \"units\": "
        "\"mm/min\"}, \"$112\": 70}}}",
        "[\"$110=500\", \"$111=600 (y max rate)\", \"$112=70\"]",
        "{\"dump\":\"$110=500\\n$111=600\\n$112=70\"}"}) {
    Diagnostics diagnostics;
    const auto machine = read_machine_file(text, "m", diagnostics);
    ASSERT_TRUE(machine) << text << to_string(diagnostics.list()[0]);
    EXPECT_EQ(machine->rates[0], mm_per_min(500)) << text;
    EXPECT_EQ(machine->rates[1], mm_per_min(600)) << text;
    EXPECT_EQ(machine->rates[2], mm_per_min(70)) << text;
    ASSERT_EQ(diagnostics.list().size(), 1u) << text;
    EXPECT_EQ(diagnostics.list()[0].code, codes::machine_incomplete);
  }
}

TEST(MachineFile, SettingsThatCannotBeReadAreErrorsWithTheirLine) {
  const struct {
    const char* text;
    Code code;
    std::uint32_t line, column;
  } kBad[] = {{"ok\r\n$110=500\r\n$11=0,010\r\n", codes::machine_value, 3, 1},
              {"$110=500 $111=fast", codes::machine_value, 1, 10},
              {"\"$110\",\"X rate\",500\n", codes::machine_value, 1, 2},
              {"{\n \"$110\": null}", codes::machine_value, 2, 3},
              {"{\"$110\": \"500\"\n \"$111\": 5}", codes::machine_file, 2, 0},
              {"{\"name\": \"mill\"}", codes::machine_file, 0, 0},
              {"$20=on\n", codes::machine_value, 1, 1}};
  for (const auto& bad : kBad) {
    Diagnostics diagnostics;
    EXPECT_FALSE(read_machine_file(bad.text, "m", diagnostics)) << bad.text;
    ASSERT_EQ(diagnostics.list().size(), 1u) << bad.text;
    EXPECT_EQ(diagnostics.list()[0].code, bad.code) << bad.text;
    const auto where = std::get<TextLocation>(diagnostics.list()[0].where);
    EXPECT_EQ(where.line, bad.line) << bad.text;
    if (bad.column != 0) {
      EXPECT_EQ(where.column, bad.column) << bad.text;
    }
  }
}

TEST(MachineFile, TwoValuesOfASettingAreReported) {
  Diagnostics diagnostics;
  const auto machine = read_machine_file("$110=500\n$110=700\n", "m", diagnostics);
  ASSERT_TRUE(machine);
  EXPECT_EQ(machine->rates[0], mm_per_min(700));
  EXPECT_EQ(diagnostics.list()[0].code, codes::machine_value);
  EXPECT_EQ(diagnostics.list()[0].severity, Severity::warning);
}

TEST(MachineFile, ATextInAProfileIsNoSetting) {
  Diagnostics diagnostics;
  const auto machine = read_machine_file("# $110=500\nname = \"as $110=500\"\n", "m.toml", diagnostics);
  ASSERT_TRUE(machine);
  EXPECT_EQ(machine->controller, Controller::other);
}

TEST(MachineFile, FactoryDefaultsAreIgnored) {
  Diagnostics diagnostics;
  const auto machine = read_machine_file("$1=255\n$20=0\n$30=1000\n$130=200\n$110=500\n", "g", diagnostics);
  ASSERT_TRUE(machine);
  EXPECT_FALSE(machine->travel[0]);
  EXPECT_FALSE(machine->fastest_spindle);
  EXPECT_EQ(machine->stop_time, Duration{});
}

TEST(MachineFile, SettingsThatAreMissingAreNamed) {
  Diagnostics diagnostics;
  ASSERT_TRUE(read_machine_file("$110=500\n$11=0.01\n", "g", diagnostics));
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::machine_incomplete);
  EXPECT_NE(diagnostics.list()[0].message.find("$12, $111, $112, $120"), std::string::npos);
}

TEST(MachineFile, BadGrblValues) {
  for (const char* text : {"$110=0\n", "$110=nan\n", "$110=1e999\n", "$110=\n", "$122=-5\n", "$12=0\n"})
    EXPECT_EQ(codes_of(text), Codes{codes::machine_value}) << text;
}

TEST(MachineFile, Profile) {
  Diagnostics diagnostics;
  const auto machine = read_machine_file(
      "name = \"mill\"\ncontroller = \"other\"\nlaser = \"stops\"\nrate = [100, 200, 300.5]\n"
      "acceleration = [1, 2, 3]\nlook_ahead = 100\nspindle = [9000, 100]\nwork_zero = [1, 2, -3]\n"
      "travel_z = [0, -60]\nstop_time = 0.5\nslowest_feed = 2\nsteps_per_mm = [0, 10, 20]\n"
      "junction_deviation = 0.05\narc_tolerance = 0.01\n",
      "m.toml", diagnostics);
  ASSERT_TRUE(machine) << to_string(diagnostics.list()[0]);
  EXPECT_EQ(machine->name, "mill");
  EXPECT_EQ(machine->controller, Controller::other);
  EXPECT_DOUBLE_EQ(machine->rates[2].mm_per_min(), 300.5);
  EXPECT_EQ(machine->look_ahead, 100);
  EXPECT_EQ(machine->slowest_spindle, rpm(100));
  EXPECT_DOUBLE_EQ(machine->travel[2]->low, -60);
  EXPECT_EQ(machine->work_zero, (Point3{1, 2, -3}));
}

TEST(MachineFile, FaultsOfProfilesHaveTheirLocation) {
  Diagnostics diagnostics;
  EXPECT_FALSE(read_machine_file("name = \"x\"\nrates = [1, 2, 3]\nlook_ahead = 0\n", "m", diagnostics));
  ASSERT_EQ(diagnostics.list().size(), 2u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::machine_value);
  EXPECT_EQ(diagnostics.list()[1].code, codes::machine_key_unknown);
  EXPECT_NE(diagnostics.list()[1].hint.find("rate"), std::string::npos);
  EXPECT_EQ(to_string(diagnostics.list()[1].where), "m:2:1");
}

TEST(MachineFile, OtherFilesAreRefused) {
  EXPECT_EQ(codes_of(""), Codes{codes::machine_file});
  EXPECT_EQ(codes_of("hello\n"), Codes{codes::machine_file});
  EXPECT_EQ(codes_of(std::string(2 << 20, ' ')), Codes{codes::machine_file});
  for (const char* text : {"rate = 5\n", "rate = [1, 2]\n", "rate = [1, 2, nan]\n", "rate = [1, 2, \"x\"]\n",
                           "name = 5\n", "controller = \"mach\"\n", "laser = 1\n", "look_ahead = 1e9\n"})
    EXPECT_EQ(codes_of(text), Codes{codes::machine_value}) << text;
}

TEST(MaterialFile, BuiltInOnesAreFoundByName) {
  EXPECT_GE(built_in_materials().size(), 8u);
  Diagnostics diagnostics;
  const auto oak = material_named("Oak", diagnostics);
  ASSERT_TRUE(oak);
  EXPECT_EQ(oak->name, "hardwood");
}

TEST(MaterialFile, AnUnknownOneHasAHint) {
  Diagnostics diagnostics;
  EXPECT_FALSE(material_named("plywod", diagnostics));
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::material_unknown);
  EXPECT_NE(diagnostics.list()[0].hint.find("plywood"), std::string::npos);
}

TEST(MaterialFile, Faults) {
  const auto codes = [](std::string_view text) {
    Diagnostics diagnostics;
    read_material_file(text, "m", diagnostics);
    return diagnostics.list().empty() ? Code{} : diagnostics.list()[0].code;
  };
  EXPECT_EQ(codes("[["), codes::material_file);
  EXPECT_EQ(codes("x = 1\n"), codes::machine_key_unknown);
  EXPECT_EQ(codes("[[material]]\nname = \"a\"\n"), codes::machine_value);
  EXPECT_EQ(codes("[[material]]\nname = \"a\"\nchip_loads = [[2, 1], [1, 1]]\n"), codes::machine_value);
  EXPECT_EQ(codes("[[material]]\nname = \"a\"\nchip_loads = [[2, nan]]\n"), codes::machine_value);
}

}  // namespace
}  // namespace kerf
