// Which changes of files are noticed, and which files are taken as not written yet.
#include "app/view/watch.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace kerf::app::view {
namespace {

class Watch : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path() + "/" + name; }
  void write(const std::string& name, std::size_t size) const {
    std::ofstream(path(name), std::ios::trunc) << std::string(size, 'x');
  }

  const TemporaryFolder folder_{"kerf-watch-"};
  FileWatch watch_;
};

TEST_F(Watch, NoticesChangesUntilTheyAreTaken) {
  write("a", 10);
  watch_.set({path("a"), path("later")});
  EXPECT_FALSE(watch_.has_changed());
  const auto before = watch_.changed_at();
  watch_.take();
  EXPECT_EQ(watch_.changed_at(), before);
  for (const char* name : {"a", "later"}) {
    write(name, 11);
    EXPECT_TRUE(watch_.has_changed()) << name;
    const auto now = FileWatch::Clock::now();
    watch_.take();
    EXPECT_FALSE(watch_.has_changed()) << name;
    EXPECT_GE(watch_.changed_at(), now) << name;
  }
}

TEST_F(Watch, FilesThatLostMostOfTheirTextAreCutShort) {
  write("a", 100);
  write("b", 1);
  watch_.set({path("a"), path("b"), path("missing")});
  const auto is_cut_short = [&] {
    watch_.take();
    return watch_.is_cut_short();
  };
  EXPECT_FALSE(is_cut_short());
  for (const std::size_t size : {99u, 50u, 1000u}) {
    write("a", size);
    EXPECT_FALSE(is_cut_short()) << size;
  }
  for (const std::size_t size : {49u, 0u}) {
    write("a", size);
    EXPECT_TRUE(is_cut_short()) << size;
  }
  write("a", 100);
  EXPECT_FALSE(is_cut_short());
  write("b", 0);
  EXPECT_TRUE(is_cut_short());
  watch_.take_as_read();  // from then on that is its size
  EXPECT_FALSE(is_cut_short());
  std::filesystem::remove(path("a"));
  EXPECT_TRUE(is_cut_short());
}

}  // namespace
}  // namespace kerf::app::view
