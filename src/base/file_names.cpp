// Names of files: std::filesystem with texts in UTF-8 and without exceptions.
#include "base/file_names.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "base/native_path.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

/// The length of a name's folder, its slash included.
std::size_t folder_size(std::string_view path) {
  const std::size_t slash = path.find_last_of("/\\");
  return slash == std::string_view::npos ? 0 : slash + 1;
}

/// The name that `make` returns for a path; nothing on failure.
template <class Make>
std::optional<std::string> made_path(std::string_view path, Make&& make) {
  std::error_code failed;
  const fs::path made = make(path_of(path), failed);
  if (failed) return std::nullopt;
  return utf8_of(made);
}

fs::file_status status_of(std::string_view path) {
  std::error_code ignored;
  return fs::status(path_of(path), ignored);
}

}  // namespace

std::string file_name_of(std::string_view path) { return utf8_of(path_of(path).filename()); }
std::string stem_of(std::string_view path) { return utf8_of(path_of(path).stem()); }
std::string extension_of(std::string_view path) { return utf8_of(path_of(path).extension()); }
std::string with_extension(std::string_view path, std::string_view extension) {
  return utf8_of(path_of(path).replace_extension(path_of(extension)));
}
std::string parent_of(std::string_view path) { return utf8_of(path_of(path).parent_path()); }
std::string path_in(std::string_view folder, std::string_view name) {
  return utf8_of(path_of(folder) / path_of(name));
}
bool is_absolute(std::string_view path) { return path_of(path).has_root_directory(); }
std::string normal_path(std::string_view path) { return utf8_of(path_of(path).lexically_normal()); }

bool is_below(std::string_view folder, std::string_view path) {
  const fs::path above = path_of(folder), below = path_of(path);
  const auto [rest, name] = std::mismatch(above.begin(), above.end(), below.begin(), below.end());
  return rest == above.end() && name != below.end();
}

std::string folder_of(std::string_view path) { return std::string(path.substr(0, folder_size(path))); }
std::string name_in_folder(std::string_view path) { return std::string(path.substr(folder_size(path))); }

std::string path_beside(std::string_view file, std::string_view name) {
  return is_absolute(name) ? std::string(name) : folder_of(file).append(name);
}

std::string absolute_path(std::string_view path) {
  return made_path(path, [](const fs::path& p, std::error_code& failed) { return fs::absolute(p, failed); })
      .value_or(std::string(path));
}

std::optional<std::string> canonical_path(std::string_view path) {
  return made_path(path, [](const fs::path& p, std::error_code& failed) { return fs::canonical(p, failed); });
}

std::string resolved_path(std::string_view path) {
  const auto resolve = [](const fs::path& p, std::error_code& failed) {
    return fs::weakly_canonical(p, failed);
  };
  return made_path(path, resolve).value_or(std::string(path));
}

bool exists(std::string_view path) { return fs::exists(status_of(path)); }
bool is_folder(std::string_view path) { return fs::is_directory(status_of(path)); }
bool is_regular_file(std::string_view path) { return fs::is_regular_file(status_of(path)); }
bool is_device(std::string_view path) {
  const fs::file_status status = status_of(path);
  return fs::is_character_file(status) || fs::is_block_file(status);
}

std::optional<std::vector<std::string>> names_in(std::string_view folder, std::size_t limit) {
  std::error_code failed;
  fs::directory_iterator entry(path_of(folder), failed);
  if (failed) return std::nullopt;
  std::vector<std::string> names;
  for (; !failed && entry != fs::directory_iterator() && names.size() < limit; entry.increment(failed))
    names.push_back(utf8_of(entry->path().filename()));
  return names;
}

void make_folders(std::string_view path) {
  std::error_code ignored;
  fs::create_directories(path_of(path), ignored);
}

void enter_folder(std::string_view path) {
  std::error_code ignored;
  fs::current_path(path_of(path), ignored);
}

void remove_file(std::string_view path) {
  std::error_code ignored;
  fs::remove(path_of(path), ignored);
}

}  // namespace kerf
