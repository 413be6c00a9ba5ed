// Names of files and folders as all rooms have them, texts in UTF-8: their parts, and what the file system
// has under them. On POSIX names are bytes, which need not be UTF-8. No function throws.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

// ---- parts of the text alone

/// The last part: "part.nc" of "jobs/part.nc".
std::string file_name_of(std::string_view path);
/// The last part without its extension: "part".
std::string stem_of(std::string_view path);
/// From the last dot of the last part on, as written: ".nc"; empty for ".nc" alone. See also ending_of().
std::string extension_of(std::string_view path);
std::string with_extension(std::string_view path, std::string_view extension);
/// The folder without a slash at its end: "jobs"; empty if the name has none.
std::string parent_of(std::string_view path);
/// `name` in `folder`; `name` itself if it is absolute or `folder` is empty.
std::string path_in(std::string_view folder, std::string_view name);
/// Whether the name starts at the root of a file system.
bool is_absolute(std::string_view path);
/// Without "." and "NAME/..".
std::string normal_path(std::string_view path);
/// Whether the name is below that of the folder. Both are canonical.
bool is_below(std::string_view folder, std::string_view path);

/// The name up to its last slash, included; empty if there is none. A backslash counts as a slash on every
/// system: names in programs may come from Windows.
std::string folder_of(std::string_view path);
/// What follows folder_of().
std::string name_in_folder(std::string_view path);
/// `name` as seen from the folder of `file`; `name` itself if it is absolute.
std::string path_beside(std::string_view file, std::string_view name);

// ---- names that depend on the file system

/// From the root, seen from the current folder. The name itself if there is none.
std::string absolute_path(std::string_view path);
/// The same without "..", "." and links; nothing if there is no such file.
std::optional<std::string> canonical_path(std::string_view path);
/// The same for a name whose last parts need not exist. The name itself on failure.
std::string resolved_path(std::string_view path);

// ---- the file system; size and times are those of file_stamp(). What cannot be found out is false.

bool exists(std::string_view path);
bool is_folder(std::string_view path);
bool is_regular_file(std::string_view path);
/// Whether reading may not end: a device of characters or blocks.
bool is_device(std::string_view path);
/// The names in a folder, not sorted, at most `limit`; nothing if it cannot be read.
std::optional<std::vector<std::string>> names_in(std::string_view folder,
                                                 std::size_t limit = std::numeric_limits<std::size_t>::max());
/// Makes the folder and those above it. Failure shows when a file is written there.
void make_folders(std::string_view path);
/// Makes a folder the current one, if possible.
void enter_folder(std::string_view path);
/// Removes the file, if there is one.
void remove_file(std::string_view path);

}  // namespace kerf
