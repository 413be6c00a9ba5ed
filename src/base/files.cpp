// Files: mapping of inputs, and outputs that are renamed to their targets together.
#include "base/codes/files.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <utility>

#include "base/file_names.h"
#include "base/native_path.h"
#include "base/system.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace kerf {

/// Either a mapping or owned bytes.
struct InputFile::Body {
  void* mapping = nullptr;
  std::size_t size = 0;
  std::string own;

  Body() = default;
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;
  ~Body() {
#if defined(__unix__) || defined(__APPLE__)
    if (mapping != nullptr) munmap(mapping, size);
#endif
  }
};

namespace {

constexpr std::size_t kChunk = std::size_t{1} << 16;  // bytes per read of a stream

/// Files up to this size, bytes, are read, not mapped: an editor that saves over a mapped file shortens it
/// first, and reading what is missing ends the process with SIGBUS.
constexpr std::size_t kLargestRead = std::size_t{1} << 30;

Diagnostic& too_large(const std::string& path, std::size_t limit, Diagnostics& diagnostics) {
  return diagnostics.error(codes::file_too_large, TextLocation{path, 0, 0},
                           fmt::format("the file is larger than the limit of {} bytes", limit));
}

void unreadable(const std::string& path, std::string_view why, Diagnostics& diagnostics) {
  diagnostics.error(codes::file_unreadable, TextLocation{path, 0, 0},
                    fmt::format("cannot read the file: {}", why));
}

/// Reads what has an unknown length to its end, by `read` of up to so many bytes, below 0 for an error.
/// Nothing, with an error, if that fails, exceeds `limit` bytes, or is stopped.
template <class Read>
std::optional<std::string> read_to_end(Read&& read, const std::string& path, std::size_t limit,
                                       Diagnostics& diagnostics, Progress* progress) {
  std::string bytes, chunk(kChunk, '\0');
  for (;;) {
    const auto got = static_cast<std::ptrdiff_t>(read(chunk.data(), kChunk));
    if (stop_requested(progress)) {
      diagnostics.error(codes::stopped, TextLocation{path, 0, 0}, "interrupted while reading");
      return std::nullopt;
    }
    if (got < 0) return unreadable(path, std::strerror(errno), diagnostics), std::nullopt;
    if (got == 0) return bytes;
    bytes.append(chunk, 0, static_cast<std::size_t>(got));
    if (bytes.size() <= limit) continue;
    Diagnostic& refused = too_large(path, limit, diagnostics);
    if (limit == limits::kMaxStreamBytes) refused.hint = "larger inputs must be regular files";
    return std::nullopt;
  }
}

std::optional<std::string> read_stream(std::FILE* stream, const std::string& path, std::size_t limit,
                                       Diagnostics& diagnostics, Progress* progress) {
  const auto read = [&](char* to, std::size_t size) {
    const std::size_t got = std::fread(to, 1, size, stream);
    return got == 0 && std::ferror(stream) != 0 ? -1 : static_cast<std::ptrdiff_t>(got);
  };
  return read_to_end(read, path, limit, diagnostics, progress);
}

#if defined(__unix__) || defined(__APPLE__)
/// A regular file of `size` bytes; of one that is shortened meanwhile, what it still has.
std::optional<std::string> read_regular(int handle, std::size_t size, const std::string& path,
                                        Diagnostics& diagnostics, Progress* progress) {
  constexpr std::size_t kPiece = std::size_t{16} << 20;  // bytes between questions whether to stop
  std::string bytes(size, '\0');
  std::size_t have = 0;
  while (have < size) {
    const ssize_t got = ::read(handle, bytes.data() + have, std::min(kPiece, size - have));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return unreadable(path, std::strerror(errno), diagnostics), std::nullopt;
    if (got == 0) break;
    have += static_cast<std::size_t>(got);
    if (!stop_requested(progress)) continue;
    diagnostics.error(codes::stopped, TextLocation{path, 0, 0}, "interrupted while reading");
    return std::nullopt;
  }
  bytes.resize(have);
  return bytes;
}

constexpr int kLook = 50;  // ms between questions whether to stop

/// A named pipe, opened without blocking: waits for a writer and for what it writes, until stopped.
std::optional<std::string> read_pipe(int handle, const std::string& path, std::size_t limit,
                                     Diagnostics& diagnostics, Progress* progress) {
  const auto read = [&](char* to, std::size_t size) -> std::ptrdiff_t {
    pollfd ready{handle, POLLIN, 0};
    while (::poll(&ready, 1, kLook) == 0 || (ready.revents & (POLLIN | POLLHUP)) == 0)
      if (stop_requested(progress)) return 0;
    return ::read(handle, to, size);
  };
  return read_to_end(read, path, limit, diagnostics, progress);
}
#endif

}  // namespace

InputFile::InputFile(std::string path, std::unique_ptr<Body> body)
    : path_(std::move(path)), body_(std::move(body)) {}
InputFile::InputFile(InputFile&&) noexcept = default;
InputFile& InputFile::operator=(InputFile&&) noexcept = default;
InputFile::~InputFile() = default;

InputFile InputFile::of_text(std::string path, std::string text) {
  auto body = std::make_unique<Body>();
  body->own = std::move(text);
  body->size = body->own.size();
  return {std::move(path), std::move(body)};
}

std::string_view InputFile::bytes() const {
  if (body_->mapping != nullptr) return {static_cast<const char*>(body_->mapping), body_->size};
  return body_->own;
}

std::optional<InputFile> InputFile::open(const std::string& path, Diagnostics& diagnostics,
                                         std::size_t limit_bytes, Progress* progress) {
  auto body = std::make_unique<Body>();
  const std::size_t stream_limit = std::min(limit_bytes, limits::kMaxStreamBytes);
  const auto take_stream = [&](std::FILE* stream, const std::string& name,
                               std::size_t limit) -> std::optional<InputFile> {
    auto bytes = read_stream(stream, name, limit, diagnostics, progress);
    if (!bytes) return std::nullopt;
    body->own = std::move(*bytes);
    return InputFile(name, std::move(body));
  };
  if (path == "-") return take_stream(stdin, "<stdin>", stream_limit);
#if defined(__unix__) || defined(__APPLE__)
  const int handle = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat status {};
  if (handle < 0 || fstat(handle, &status) != 0) {
    unreadable(path, std::strerror(errno), diagnostics);
    if (handle >= 0) ::close(handle);
    return std::nullopt;
  }
  if (S_ISDIR(status.st_mode)) {
    ::close(handle);
    return unreadable(path, "it is a folder", diagnostics), std::nullopt;
  }
  if (S_ISFIFO(status.st_mode)) {
    auto bytes = read_pipe(handle, path, stream_limit, diagnostics, progress);
    ::close(handle);
    if (!bytes) return std::nullopt;
    body->own = std::move(*bytes);
    return InputFile(path, std::move(body));
  }
  if (S_ISREG(status.st_mode) && static_cast<std::size_t>(status.st_size) > limit_bytes) {
    ::close(handle);
    return too_large(path, limit_bytes, diagnostics), std::nullopt;
  }
  const auto size = S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 0;
  if (size > kLargestRead) {
    void* mapping = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, handle, 0);
    if (mapping != MAP_FAILED) {
      body->mapping = mapping;
      body->size = size;
      ::close(handle);
      return InputFile(path, std::move(body));
    }
  }
  if (size > 0) {
    auto bytes = read_regular(handle, size, path, diagnostics, progress);
    ::close(handle);
    if (!bytes) return std::nullopt;
    body->own = std::move(*bytes);
    return InputFile(path, std::move(body));
  }
  ::close(handle);
#endif
  if (is_folder(path)) return unreadable(path, "it is a folder", diagnostics), std::nullopt;
  std::error_code ignored;
  const bool has_size = std::filesystem::file_size(path_of(path), ignored) > 0 && !ignored;
  std::FILE* stream = open_stream(path, "rb");
  if (stream == nullptr) return unreadable(path, std::strerror(errno), diagnostics), std::nullopt;
  std::optional<InputFile> file = take_stream(stream, path, has_size ? limit_bytes : stream_limit);
  std::fclose(stream);
  return file;
}

// ---- outputs

namespace {

/// The target of a symbolic link, which need not exist: the link stays, and its target is replaced.
std::string followed(const std::string& path) {
  constexpr int kMaxLinks = 40;  // as Linux follows them
  std::filesystem::path at = path_of(path);
  std::error_code failed;
  for (int i = 0; i < kMaxLinks && std::filesystem::is_symlink(at, failed); ++i)
    at = at.parent_path() / std::filesystem::read_symlink(at, failed);
  return utf8_of(at);
}

/// Pipes and devices are written directly: a file must not replace them. The same holds for paths such as
/// /dev/stdout, even if they refer to a regular file.
bool can_be_replaced(const std::string& path) {
  for (const std::string_view folder : {"/dev/std", "/dev/fd/", "/proc/"})
    if (path.compare(0, folder.size(), folder) == 0) return false;
  std::error_code failed;
  return !std::filesystem::is_other(std::filesystem::status(path_of(path), failed));
}

#if defined(_WIN32)
constexpr const char* kNewFile = "wb";  // msvcrt.dll refuses the x of C11
#else
constexpr const char* kNewFile = "wbx";
#endif

std::string part_name(const std::string& target) {
  static std::atomic<unsigned> counter{0};
  return fmt::format("{}.{}-{}.part", target, process_number(), ++counter);
}

}  // namespace

namespace {

/// Permissions of a file that an output replaces; nothing if there is none.
std::optional<std::filesystem::perms> permissions_of(const std::string& target) {
  std::error_code failed;
  const auto status = std::filesystem::status(path_of(target), failed);
  if (failed || !std::filesystem::is_regular_file(status)) return std::nullopt;
  return status.permissions();
}

/// Renaming replaces files that cannot be written: that they are protected is tested here.
bool is_protected(const std::string& target, std::filesystem::perms permissions) {
  using std::filesystem::perms;
  constexpr perms kWrite = perms::owner_write | perms::group_write | perms::others_write;
  if ((permissions & kWrite) == perms::none) return true;
  return !is_writable(target);
}

}  // namespace

struct OutputFile::Body {
  std::string path;                                   // as given by the user
  std::string target;                                 // links followed
  std::string temporary;                              // empty if the target is written directly
  std::optional<std::filesystem::perms> permissions;  // of the replaced file
  std::FILE* stream = nullptr;
  bool good = true;

  Body() = default;
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;
  ~Body() {
    if (stream != nullptr) std::fclose(stream);
    if (!temporary.empty()) remove_file(temporary);
  }
  /// Reports the first failure.
  bool fail(std::string_view what, std::string_view why, Diagnostics& diagnostics) {
    if (good)
      diagnostics.error(codes::file_unwritable, TextLocation{path, 0, 0}, fmt::format("{}: {}", what, why));
    return good = false;
  }
};

OutputFile::OutputFile(std::unique_ptr<Body> body) : body_(std::move(body)) {}
OutputFile::OutputFile(OutputFile&&) noexcept = default;
OutputFile& OutputFile::operator=(OutputFile&&) noexcept = default;
OutputFile::~OutputFile() = default;

std::optional<OutputFile> OutputFile::create(const std::string& path, Diagnostics& diagnostics) {
  auto body = std::make_unique<Body>();
  body->path = path;
  const bool replaces = can_be_replaced(path);
  body->target = replaces ? followed(path) : path;
  if (replaces) body->permissions = permissions_of(body->target);
  if (body->permissions && is_protected(body->target, *body->permissions)) {
    body->fail("cannot write the file", "it is write-protected", diagnostics);
    return std::nullopt;
  }
  const std::string name = replaces ? part_name(body->target) : path;
  body->stream = open_stream(name, replaces ? kNewFile : "wb");
  if (body->stream == nullptr) {
    body->fail("cannot write the file", std::strerror(errno), diagnostics);
    return std::nullopt;
  }
  if (replaces) body->temporary = name;
  return OutputFile(std::move(body));
}

bool OutputFile::write(std::string_view bytes, Diagnostics& diagnostics) {
  if (bytes.empty()) return body_->good;
  if (!body_->good || body_->stream == nullptr) return false;
  if (std::fwrite(bytes.data(), 1, bytes.size(), body_->stream) == bytes.size()) return true;
  return body_->fail("cannot write the file", std::strerror(errno), diagnostics);
}

bool OutputFile::close(Diagnostics& diagnostics) {
  if (body_->stream == nullptr) return body_->good;
  const bool closed = std::fclose(std::exchange(body_->stream, nullptr)) == 0;
  return closed ? body_->good : body_->fail("cannot write the file", std::strerror(errno), diagnostics);
}

bool OutputFile::commit(Diagnostics& diagnostics) {
  if (!close(diagnostics)) return false;
  if (body_->temporary.empty()) return true;
  const std::filesystem::path written = path_of(body_->temporary);
  std::error_code error;
  if (body_->permissions) std::filesystem::permissions(written, *body_->permissions, error);
  std::filesystem::rename(written, path_of(body_->target), error);
  if (error) return body_->fail("cannot rename the file to its target", error.message(), diagnostics);
  body_->temporary.clear();
  return true;
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  if (std::filesystem::equivalent(path_of(a), path_of(b), ignored)) return true;
  return normal_path(a) == normal_path(b);
}

bool OutputSet::write(const std::string& path, std::string_view bytes, Diagnostics& diagnostics) {
  const auto is_path = [&path](const std::string& other) { return is_same_file(other, path); };
  const bool is_input = std::any_of(inputs_.begin(), inputs_.end(), is_path);
  if (can_be_replaced(path) &&
      (is_input || std::any_of(pending_.begin(), pending_.end(),
                               [&is_path](const Pending& other) { return is_path(other.path); }))) {
    diagnostics.error(codes::output_is_input, TextLocation{path, 0, 0},
                      is_input ? "the output would replace an input" : "two outputs have the same name");
    return false;
  }
  if (!can_be_replaced(path)) {
    pending_.push_back({std::nullopt, path, std::string(bytes)});
    return true;
  }
  auto file = OutputFile::create(path, diagnostics);
  if (!file || !file->write(bytes, diagnostics) || !file->close(diagnostics)) return false;
  pending_.push_back({std::move(file), path, {}});
  return true;
}

bool OutputSet::rename_to_target(Pending& pending, Diagnostics& diagnostics) {
  if (!pending.file) pending.file = OutputFile::create(pending.path, diagnostics);
  return pending.file && pending.file->write(pending.bytes, diagnostics) && pending.file->commit(diagnostics);
}

bool OutputSet::commit(Diagnostics& diagnostics) {
  // Targets that a rename cannot replace are found before the first rename, so that all files appear or none.
  for (const Pending& file : pending_) {
    if (!is_folder(file.path)) continue;
    diagnostics.error(codes::file_unwritable, TextLocation{file.path, 0, 0}, "a folder has this name");
    return false;
  }
  bool good = true;
  for (Pending& pending : pending_) good = good && rename_to_target(pending, diagnostics);
  pending_.clear();
  return good;
}

}  // namespace kerf
