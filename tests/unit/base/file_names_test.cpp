// Names of files with letters beyond ASCII: their parts, and files that are made, listed, read and removed.
#include "base/file_names.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>

#include "base/system.h"

#include "kerf/base/files.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

/// A name in UTF-8 as code writes it, and the same as the standard library defines it on every system.
struct Name {
  std::string text;
  std::u8string standard;
};
const Name kNames[] = {{"\xc3\xa4.nc", u8"\u00e4.nc"},
                       {"\xe6\x97\xa5\xe6\x9c\xac.nc", u8"\u65e5\u672c.nc"},
                       {"\xf0\x9f\x94\xa9 1.nc", u8"\U0001f529 1.nc"},
                       {"plain.nc", u8"plain.nc"}};
const std::string kJapan = "\xe6\x97\xa5\xe6\x9c\xac";

class FileNames : public ::testing::Test {
 protected:
  std::string path(std::string_view name) const { return path_in(folder_.path(), name); }
  bool write(const std::string& path, std::string_view bytes) {
    OutputSet files;
    return files.write(path, bytes, diagnostics_) && files.commit(diagnostics_);
  }
  std::string content(const std::string& path) {
    const auto file = InputFile::open(path, diagnostics_);
    return file ? std::string(file->bytes()) : "unreadable";
  }

  TemporaryFolder folder_ = TemporaryFolder("kerf-names");
  Diagnostics diagnostics_;
};

TEST_F(FileNames, PartsAreThoseOfTheText) {
  EXPECT_EQ(file_name_of("jobs/\xc3\xa4.b.nc"), "\xc3\xa4.b.nc");
  EXPECT_EQ(stem_of("jobs/\xc3\xa4.b.nc"), "\xc3\xa4.b");
  EXPECT_EQ(extension_of("jobs/\xc3\xa4.b.NC"), ".NC");
  EXPECT_EQ(extension_of("jobs/.nc"), "");
  EXPECT_EQ(with_extension("jobs/" + kJapan + ".scad", ".glb"), "jobs/" + kJapan + ".glb");
  EXPECT_EQ(parent_of("jobs/" + kJapan + "/a.nc"), "jobs/" + kJapan);
  EXPECT_EQ(parent_of("a.nc"), "");
  EXPECT_EQ(file_name_of(normal_path("jobs/../" + kJapan)), kJapan);
  EXPECT_EQ(parent_of(normal_path("jobs/../" + kJapan)), "");
}

TEST_F(FileNames, NamesAreJoinedUnlessTheyAreAbsolute) {
  EXPECT_EQ(path_in("", kJapan), kJapan);
  EXPECT_EQ(path_in("jobs/", kJapan), "jobs/" + kJapan);
  EXPECT_EQ(parent_of(path_in("jobs", kJapan)), "jobs");
  EXPECT_EQ(file_name_of(path_in("jobs", kJapan)), kJapan);
  EXPECT_EQ(path_in("jobs", "/" + kJapan), "/" + kJapan);
  EXPECT_TRUE(is_absolute("/a"));
  EXPECT_FALSE(is_absolute("a/b"));
  EXPECT_FALSE(is_absolute(""));
}

TEST_F(FileNames, BackslashesEndFoldersOnEverySystem) {
  EXPECT_EQ(folder_of("a\\b/\xc3\xa4.nc"), "a\\b/");
  EXPECT_EQ(folder_of("C:\\parts\\\xc3\xa4.nc"), "C:\\parts\\");
  EXPECT_EQ(name_in_folder("C:\\parts\\\xc3\xa4.nc"), "\xc3\xa4.nc");
  EXPECT_EQ(folder_of("\xc3\xa4.nc"), "");
  EXPECT_EQ(name_in_folder("\xc3\xa4.nc"), "\xc3\xa4.nc");
  EXPECT_EQ(path_beside("jobs/a.toml", kJapan), "jobs/" + kJapan);
  EXPECT_EQ(path_beside("a.toml", kJapan), kJapan);
  EXPECT_EQ(path_beside("jobs/a.toml", "/" + kJapan), "/" + kJapan);
}

TEST_F(FileNames, AFileIsBelowItsFoldersOnly) {
  EXPECT_TRUE(is_below("/a", "/a/b"));
  EXPECT_TRUE(is_below("/a", "/a/b/c"));
  EXPECT_TRUE(is_below("/", "/a"));
  EXPECT_FALSE(is_below("/a", "/ab"));
  EXPECT_FALSE(is_below("/a", "/a"));
  EXPECT_FALSE(is_below("/a/b", "/a"));
}

/// The names on the disk are compared with what the standard library reads there.
TEST_F(FileNames, FilesAreMadeListedReplacedAndRead) {
  std::vector<std::string> texts;
  for (const Name& name : kNames) {
    const std::string file = path(name.text);
    ASSERT_TRUE(write(file, "first"));
    ASSERT_TRUE(write(file, "second of " + name.text));
    const fs::path standard = fs::path(std::u8string(folder_.path().begin(), folder_.path().end()));
    EXPECT_TRUE(fs::is_regular_file(standard / name.standard));
    EXPECT_EQ(content(file), "second of " + name.text);
    EXPECT_TRUE(exists(file) && is_regular_file(file));
    EXPECT_FALSE(is_folder(file) || is_device(file));
    EXPECT_EQ(file_stamp(file).size, 10 + name.text.size());
    EXPECT_TRUE(is_writable(file));
    EXPECT_TRUE(is_same_file(file, path_in(path("."), name.text)));
    texts.push_back(name.text);
  }
  auto names = names_in(folder_.path());
  ASSERT_TRUE(names);
  std::sort(names->begin(), names->end());
  std::sort(texts.begin(), texts.end());
  EXPECT_EQ(*names, texts);
  EXPECT_EQ(names_in(folder_.path(), 2)->size(), 2u);
  for (const std::string& text : texts) remove_file(path(text));
  EXPECT_EQ(names_in(folder_.path())->size(), 0u);
  EXPECT_TRUE(diagnostics_.list().empty());
}

TEST_F(FileNames, FilesOfTheStandardLibraryAreFound) {
  const fs::path standard = fs::path(std::u8string(folder_.path().begin(), folder_.path().end()));
  for (const Name& name : kNames) {
    std::ofstream(standard / name.standard) << "M2";
    EXPECT_EQ(content(path(name.text)), "M2");
  }
}

TEST_F(FileNames, FoldersHaveSuchNamesToo) {
  const std::string folder = path_in(path(kJapan), "\xc3\xa4");
  EXPECT_FALSE(is_folder(folder));
  EXPECT_FALSE(names_in(folder));
  EXPECT_FALSE(canonical_path(folder));
  make_folders(folder);
  EXPECT_TRUE(is_folder(folder));
  EXPECT_FALSE(make_private_folder(folder));
  const std::string file = path_in(folder, "a.nc");
  ASSERT_TRUE(write(file, "M2"));
  const auto whole = canonical_path(path_in(folder, "../\xc3\xa4/./a.nc"));
  ASSERT_TRUE(whole);
  EXPECT_EQ(*whole, canonical_path(file));
  EXPECT_EQ(*whole, resolved_path(file));
  EXPECT_EQ(file_name_of(parent_of(parent_of(*whole))), kJapan);
  EXPECT_EQ(file_name_of(resolved_path(path_in(folder, "missing"))), "missing");
  EXPECT_EQ(absolute_path(file), file);
  EXPECT_EQ(file_name_of(absolute_path(kJapan)), kJapan);
  EXPECT_TRUE(is_absolute(absolute_path(kJapan)));
}

TEST_F(FileNames, NoNameIsNoFile) {
  EXPECT_FALSE(exists("") || is_folder("") || is_regular_file("") || is_device(""));
  EXPECT_FALSE(canonical_path(""));
  EXPECT_EQ(absolute_path(""), "");
  EXPECT_EQ(file_name_of(""), "");
  remove_file("");
}

TEST_F(FileNames, DevicesAreKnown) {
  if (!fs::exists("/dev/null")) GTEST_SKIP() << "no /dev/null here";
  EXPECT_TRUE(is_device("/dev/null"));
  EXPECT_FALSE(is_regular_file("/dev/null"));
}

/// On POSIX a name may be any bytes; Windows' names are UTF-16, and no file has such a name.
TEST_F(FileNames, NamesNeedNotBeUtf8) {
  const std::string odd = "\xff\xc3.nc", file = path(odd);
  EXPECT_EQ(extension_of(file), ".nc");
#if defined(_WIN32)
  EXPECT_FALSE(exists(file));
#else
  EXPECT_EQ(file_name_of(file), odd);
  ASSERT_TRUE(write(file, "M2"));
  EXPECT_EQ(content(file), "M2");
  EXPECT_EQ(names_in(folder_.path()), std::vector<std::string>{odd});
#endif
}

}  // namespace
}  // namespace kerf
