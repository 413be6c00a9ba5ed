// Post files: what is read, what is refused, and that the built-in ones are complete.
#include <gtest/gtest.h>
#include <string_view>

#include "base/codes/gcode.h"

#include "kerf/program/post.h"

namespace kerf {
namespace {

Code first_code(std::string_view text) {
  Diagnostics diagnostics;
  EXPECT_FALSE(read_post_profile(text, "post.toml", diagnostics));
  return diagnostics.list().empty() ? Code{} : diagnostics.list().front().code;
}

TEST(Profile, the_built_in_ones_are_there) {
  for (const char* name : {"grbl", "grblhal", "linuxcnc", "mach3", "carbide", "marlin", "klipper", "laser"}) {
    const PostProfile* profile = find_post(name);
    ASSERT_NE(profile, nullptr) << name;
    EXPECT_FALSE(profile->title.empty()) << name;
    EXPECT_TRUE(profile->has_g(0) && profile->has_g(10) && profile->has_g(900)) << name;
    EXPECT_GE(profile->decimals.mm, 3) << name;
    EXPECT_GE(profile->decimals.inch, 4) << name;
  }
  EXPECT_EQ(find_post("no such post"), nullptr);
  EXPECT_EQ(find_post("LinuxCNC"), find_post("linuxcnc"));
}

TEST(Profile, starts_from_a_base) {
  Diagnostics diagnostics;
  const auto profile = read_post_profile("base = \"grbl\"\nname = \"mine\"\n[line]\nend = \"crlf\"\n",
                                         "post.toml", diagnostics);
  ASSERT_TRUE(profile);
  EXPECT_EQ(profile->name, "mine");
  EXPECT_EQ(profile->line_end, LineEnd::crlf);
  EXPECT_EQ(profile->longest_line, 79u);
}

TEST(Profile, faults_are_reported) {
  EXPECT_EQ(first_code("name = "), codes::post_file_syntax);
  EXPECT_EQ(first_code("nmae = \"x\""), codes::post_key_unknown);
  EXPECT_EQ(first_code("name = \"x\"\n[arcs]\npolicy = \"round\""), codes::post_value_bad);
  EXPECT_EQ(first_code("name = \"x\"\n[numbers]\nmm = 2"), codes::post_value_bad);
  EXPECT_EQ(first_code("base = \"nothing\""), codes::post_unknown);
  EXPECT_EQ(first_code(""), codes::post_value_bad);
}

}  // namespace
}  // namespace kerf
